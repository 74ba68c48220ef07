// Flips single bits of the state and looks whether they are found, and named rightly.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/logs/state/canonical_fields.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/start_match.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct FlipOptions {
  StartOptions start;
  std::uint64_t ticks = 200;
  std::uint64_t count = 1000;
  bool json = false;
};

struct Tally {
  std::uint64_t flips = 0;
  std::uint64_t hashed = 0;   // the state's hash is another one at that tick
  std::uint64_t named = 0;    // the description names store, object and field
  std::uint64_t refused = 0;  // of all: no world would load such a state
  std::map<std::string, std::uint64_t> stores;

  [[nodiscard]] bool good() const { return named == flips && hashed == flips; }
};

// SplitMix64: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014.
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

class Flips {
 public:
  Flips(const FlipOptions& options, const GameDef& game, Simulation& simulation, Simulation& other)
      : options_(options),
        game_(game),
        simulation_(simulation),
        other_(other),
        inputs_(game, options.start.seed),
        random_(options.start.seed) {}

  Tally run() {
    std::vector<std::uint64_t> ticks(options_.count);
    for (std::uint64_t& tick : ticks)
      tick = next_random(random_) % options_.ticks;
    std::sort(ticks.begin(), ticks.end());
    for (const std::uint64_t tick : ticks) {
      while (simulation_.tick() < tick)
        simulation_.step(inputs_.next(simulation_));
      world_of(game_, simulation_) == nullptr ? flip_bytes() : flip();
      progress_.show("flips", tally_.flips, options_.count);
    }
    return std::move(tally_);
  }

 private:
  void flip() {
    const Simulation& simulation = simulation_;
    const std::vector<std::byte> good = canonical_bytes(simulation);
    std::vector<std::byte> bytes = good;
    const std::span<std::byte> world = world_part(*world_of(game_, simulation_), bytes);
    if (world.empty()) return flip_bytes();
    const std::vector<FieldPlace> places = fields_of_world(world);
    const std::size_t front = places.front().offset;
    const std::size_t end = places.back().offset + places.back().bytes;
    const std::size_t offset = front + next_random(random_) % (end - front);
    const auto bit = static_cast<unsigned>(next_random(random_) % 8);
    world[offset] ^= static_cast<std::byte>(1U << bit);
    reseal(world);
    const FieldPlace& place = place_of(places, offset);
    ++tally_.flips;
    ++tally_.stores[place.store];
    const bool hashed = is_hashed(place, static_cast<unsigned>(8 * (offset - place.offset)) + bit);
    const StateDifference found = simulation.describe(good, bytes);
    const bool named =
        found.store == place.store && found.object == place.object && found.field == place.field;
    tally_.hashed += hashed ? 1U : 0U;
    tally_.named += found.differs && named ? 1U : 0U;
    tally_.refused += other_.load(SnapshotKind::canonical, bytes) != Status::ok ? 1U : 0U;
    if (hashed && found.differs && named) return;
    complain(fmt::format("tick {}: flipped {} {}, {}; {}, found: {}", simulation.tick(),
                         place.store, place.object, place.field,
                         hashed ? "another hash" : "the same hash", found.to_line()));
  }

  // Of a game that shows no world: the bit of the snapshot is refused, or changes the hash, and the
  // game describes a difference.
  void flip_bytes() {
    const std::vector<std::byte> good = canonical_bytes(simulation_);
    std::vector<std::byte> bytes = good;
    const std::size_t offset = next_random(random_) % bytes.size();
    bytes[offset] ^= static_cast<std::byte>(1U << (next_random(random_) % 8));
    ++tally_.flips;
    ++tally_.stores["snapshot"];
    const bool refused = other_.load(SnapshotKind::canonical, bytes) != Status::ok;
    const bool hashed = refused || other_.hash() != simulation_.hash();
    const bool named = refused || simulation_.describe(good, bytes).differs;
    tally_.refused += refused ? 1U : 0U;
    tally_.hashed += hashed ? 1U : 0U;
    tally_.named += named ? 1U : 0U;
    if (hashed && named) return;
    complain(fmt::format("tick {}: flipped a bit of byte {} of the snapshot; {}, {}",
                         simulation_.tick(), offset, hashed ? "another hash" : "the same hash",
                         named ? "described" : "not described"));
  }

  static const FieldPlace& place_of(const std::vector<FieldPlace>& places, std::size_t offset) {
    return *std::prev(std::upper_bound(
        places.begin(), places.end(), offset,
        [](std::size_t wanted, const FieldPlace& place) { return wanted < place.offset; }));
  }

  // Flips the bit in the memory of a second peer that holds the same state.
  bool is_hashed(const FieldPlace& place, unsigned bit) {
    const Simulation& simulation = simulation_;
    native_.resize(simulation.snapshot_bytes_max(SnapshotKind::native));
    const std::size_t size = simulation.save(SnapshotKind::native, native_);
    const std::uint64_t hash = simulation.hash();
    if (other_.load(SnapshotKind::native, std::span(native_).first(size)) != Status::ok ||
        other_.hash() != hash) {
      return false;
    }
    const bool flipped =
        world_of(game_, other_)->flip_bit(place.store, place.object, place.field, bit);
    return flipped && other_.hash() != hash;
  }

  const FlipOptions& options_;
  const GameDef& game_;
  Simulation& simulation_;
  Simulation& other_;
  MatchInputs inputs_;
  std::uint64_t random_;
  std::vector<std::byte> native_;
  Tally tally_;
  Progress progress_;
};

void print(const FlipOptions& options, const std::string& game, const Tally& tally) {
  const std::string& scene = options.start.scene.empty() ? game : options.start.scene;
  if (options.json) {
    nlohmann::ordered_json json{{"scene", scene},
                                {"flips", tally.flips},
                                {"hashed", tally.hashed},
                                {"named", tally.named},
                                {"refused", tally.refused}};
    for (const auto& [store, count] : tally.stores)
      json["stores"][store] = count;
    write_json(json);
    return;
  }
  fmt::print("{} flips in {} ticks of {}: {} gave another hash at that tick,\n", tally.flips,
             options.ticks, scene, tally.hashed);
  fmt::print("{} were named by store, object and field ({} no world would load)\n", tally.named,
             tally.refused);
  for (const auto& [store, count] : tally.stores)
    fmt::print("  {:<8} {:>6}\n", store, count);
}

int flips(const Games& games, const FlipOptions& options) {
  const std::optional<Match> match = start_match(games, options.start);
  if (!match) return k_usage;
  const Result<std::unique_ptr<Simulation>> other = match->game->make(match->config);
  if (!other) return k_usage;
  const Tally tally = Flips(options, *match->game, *match->simulation, *other.value()).run();
  print(options, match->game->name, tally);
  return tally.good() ? k_ok : k_different;
}

}  // namespace

void add_flips_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<FlipOptions>();
  CLI::App* command = app.add_subcommand(
      "flips", "Flip random bits of the state: each must be found at its tick and named");
  add_start_options(*command, tool.games, options->start);
  command->add_option("--ticks", options->ticks, "Flip within this many ticks")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--count", options->count, "Flips")->capture_default_str();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &tool] { tool.exit_code = flips(tool.games, *options); });
}

}  // namespace lockstone::tool
