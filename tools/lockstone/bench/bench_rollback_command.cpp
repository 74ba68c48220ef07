// The cost of rolling back: bytes of a native snapshot, times to save and load, ticks simulated
// again.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench/speed/speed_scene.h"
#include "tools/lockstone/bench/bench_rollback_guesses.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

struct RollbackOptions {
  std::uint32_t bodies = 800;
  int ticks = 8;
  int repeats = 30;
  int settle = 120;
  int guess_repeats = 5;
  bool json = false;
};

struct Figures {
  std::uint32_t bodies = 0;
  std::size_t contacts = 0;
  std::size_t bytes = 0;
  std::size_t header_bytes = 0;
  double body_bytes = 0;
  double contact_bytes = 0;
  double save_us = 0;
  double load_us = 0;
  double resimulate_us = 0;
  std::size_t tick_delta_bytes = 0;  // one tick after the base, and
  std::size_t delta_bytes = 0;       // as many as are simulated again
  double save_delta_us = 0;
  double load_delta_us = 0;
  std::uint64_t hash = 0;
  bool repeated = true;  // each repeat came to the same hash
};

constexpr std::uint32_t k_goal_bodies = 800;
constexpr int k_goal_ticks = 8;

// The times are those of a certain scene.
std::vector<Goal> goals_of(const RollbackOptions& options, const Figures& f) {
  std::vector<Goal> goals{{"snapshot", f.body_bytes, 256, "bytes a body"},
                          {"snapshot", f.contact_bytes, 96, "bytes a touching pair"}};
  if (options.bodies != k_goal_bodies) return goals;
  goals.push_back({"save", f.save_us, 100, "us"});
  goals.push_back({"load", f.load_us, 100, "us"});
  if (options.ticks == k_goal_ticks)
    goals.push_back({"ticks again", f.resimulate_us, 16'000, "us"});
  return goals;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class F>
double microseconds(F&& f) {
  const Stopwatch watch;
  f();
  return watch.seconds() * 1e6;
}

// Boxes dropped into a square pit of four walls, in layers.
World make_pit(std::uint32_t boxes) {
  WorldDef def =
      bench::speed_def(BroadPhaseKind::tree, boxes + 8, 16 * (boxes + 8), 8 * (boxes + 8));
  World world = bench::make_speed_world(def);
  const auto fixed = [&](int x, int y, int z, int sx, int sy, int sz) {
    BodyDef body;
    body.motion = MotionType::static_body;
    body.shape =
        Shape::box(Length::from_integer(sx), Length::from_integer(sy), Length::from_integer(sz));
    body.position = {Position::from_integer(x), Position::from_integer(y),
                     Position::from_integer(z)};
    static_cast<void>(world.create_body(body));
  };
  fixed(0, -1, 0, 20, 1, 20);
  fixed(-7, 10, 0, 1, 10, 8);
  fixed(7, 10, 0, 1, 10, 8);
  fixed(0, 10, -7, 8, 10, 1);
  fixed(0, 10, 7, 8, 10, 1);
  for (std::uint32_t i = 0; i < boxes; ++i) {
    const auto column = static_cast<int>(i % 100), layer = static_cast<int>(i / 100);
    BodyDef body;
    constexpr Length half = Length::from_ratio(1, 2);
    body.shape = Shape::box(half, half, half);
    body.position = {Position::from_ratio(11 * (column % 10) - 50, 10),
                     Position::from_ratio(12 * layer + 6, 10),
                     Position::from_ratio(11 * (column / 10) - 50, 10)};
    static_cast<void>(world.create_body(body));
  }
  return world;
}

std::vector<std::byte> native_snapshot(const World& world) {
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::native));
  bytes.resize(world.save(SnapshotKind::native, bytes));
  return bytes;
}

// The size of one record of each store, found from two worlds that differ in bodies alone.
void measure_bytes(World& world, Figures& figures) {
  figures.bytes = native_snapshot(world).size();
  const World one = make_pit(1), two = make_pit(2);
  figures.body_bytes =
      static_cast<double>(native_snapshot(two).size() - native_snapshot(one).size());
  const World none = make_pit(0);
  figures.header_bytes = native_snapshot(none).size() -
                         static_cast<std::size_t>(figures.body_bytes * none.body_limit());
  const double rest = static_cast<double>(figures.bytes - figures.header_bytes) -
                      figures.body_bytes * world.body_limit();
  figures.contact_bytes = figures.contacts == 0 ? 0 : rest / static_cast<double>(figures.contacts);
}

// Goes back to the snapshot and simulates again, over and over.
void measure_returns(World& world, const RollbackOptions& options, ByteView snapshot,
                     Figures& figures) {
  std::vector<std::byte> scratch(world.snapshot_bytes_max(SnapshotKind::native));
  std::vector<double> saves, loads, steps;
  for (int i = 0; i < options.repeats; ++i) {
    loads.push_back(
        microseconds([&] { static_cast<void>(world.load(SnapshotKind::native, snapshot)); }));
    steps.push_back(microseconds([&] {
      for (int tick = 0; tick < options.ticks; ++tick)
        world.step();
    }));
    saves.push_back(
        microseconds([&] { static_cast<void>(world.save(SnapshotKind::native, scratch)); }));
    const std::uint64_t hash = world.hash().total;
    figures.repeated = figures.repeated && (i == 0 || hash == figures.hash);
    figures.hash = hash;
  }
  figures.save_us = median(saves);
  figures.load_us = median(loads);
  figures.resimulate_us = median(steps);
}

// The world stands where the ticks simulated again have led; the delta's base is where they began.
void measure_deltas(World& world, const RollbackOptions& options, ByteView base, Figures& figures) {
  std::vector<std::byte> delta(world.delta_bytes_max());
  std::vector<double> saves, loads;
  for (int i = 0; i < options.repeats; ++i) {
    saves.push_back(microseconds([&] { figures.delta_bytes = world.save_delta(base, delta); }));
    static_cast<void>(world.load(SnapshotKind::native, base));
    loads.push_back(microseconds([&] {
      static_cast<void>(world.load_delta(base, ByteView(delta).first(figures.delta_bytes)));
    }));
    figures.repeated = figures.repeated && world.hash().total == figures.hash;
  }
  figures.save_delta_us = median(saves);
  figures.load_delta_us = median(loads);
  static_cast<void>(world.load(SnapshotKind::native, base));
  world.step();
  figures.tick_delta_bytes = world.save_delta(base, delta);
}

Figures measure(const RollbackOptions& options) {
  World world = make_pit(options.bodies);
  for (int tick = 0; tick < options.settle; ++tick)
    world.step();
  Figures figures;
  figures.bodies = world.body_count();
  figures.contacts = world.record_hashes(StateStore::contacts, {});
  measure_bytes(world, figures);
  const std::vector<std::byte> snapshot = native_snapshot(world);
  measure_returns(world, options, snapshot, figures);
  measure_deltas(world, options, snapshot, figures);
  return figures;
}

nlohmann::ordered_json to_json(const RollbackOptions& options, const Figures& f,
                               const bench::WrongGuessReport& guesses) {
  nlohmann::ordered_json json{{"bodies", f.bodies},
                              {"contacts", f.contacts},
                              {"snapshot_bytes", f.bytes},
                              {"bytes_per_body", f.body_bytes},
                              {"bytes_per_contact", f.contact_bytes},
                              {"save_us", f.save_us},
                              {"load_us", f.load_us},
                              {"ticks", options.ticks},
                              {"resimulate_us", f.resimulate_us},
                              {"tick_delta_bytes", f.tick_delta_bytes},
                              {"delta_bytes", f.delta_bytes},
                              {"save_delta_us", f.save_delta_us},
                              {"load_delta_us", f.load_delta_us},
                              {"final_hash", hash_text(f.hash)}};
  for (const Goal& goal : goals_of(options, f))
    json["goals"].push_back(goal_json(goal));
  if (!guesses.guesses.empty()) json["wrong_guesses"] = guesses_json(guesses);
  return json;
}

void print(const RollbackOptions& options, const Figures& f) {
  fmt::print("{} bodies, {} touching pairs, medians of {}\n", f.bodies, f.contacts,
             options.repeats);
  fmt::print("snapshot     {:>9} bytes: {:.0f} a body, {:.0f} a touching pair, {} for all\n",
             f.bytes, f.body_bytes, f.contact_bytes, f.header_bytes);
  fmt::print("save         {:>9.1f} us\n", f.save_us);
  fmt::print("load         {:>9.1f} us\n", f.load_us);
  fmt::print("{} ticks again {:>9.1f} us\n", options.ticks, f.resimulate_us);
  fmt::print("delta        {:>9} bytes after one tick, {} after {}\n", f.tick_delta_bytes,
             f.delta_bytes, options.ticks);
  fmt::print("save delta   {:>9.1f} us\n", f.save_delta_us);
  fmt::print("load delta   {:>9.1f} us\n", f.load_delta_us);
  fmt::print("final hash   {}\n", hash_text(f.hash));
  print_goals(goals_of(options, f));
}

int run(const RollbackOptions& options) {
  const Figures figures = measure(options);
  bench::WrongGuessReport guesses;
  if (options.guess_repeats > 0)
    guesses = bench::measure_wrong_guesses({options.ticks, options.guess_repeats});
  if (options.json) {
    write_json(to_json(options, figures, guesses));
  } else {
    print(options, figures);
    if (!guesses.guesses.empty()) print_guesses(guesses, options.ticks);
  }
  if (figures.repeated && are_equal(guesses)) return k_ok;
  complain("a tick simulated again came to another hash");
  return k_different;
}

}  // namespace

void add_bench_rollback_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<RollbackOptions>();
  CLI::App* command =
      bench.add_subcommand("rollback",
                           "Native snapshots, and ticks simulated again, with a history "
                           "and without");
  command->add_option("--bodies", options->bodies, "Number of boxes in a pit")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  command->add_option("--ticks", options->ticks, "Ticks to go back")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_option("--repeats", options->repeats, "Timed repeats")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  command->add_option("--settle", options->settle, "Ticks before")->capture_default_str();
  command
      ->add_option("--guess-repeats", options->guess_repeats,
                   "Timed repeats of wrong guesses; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
