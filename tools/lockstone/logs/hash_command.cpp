// hash: writes one machine's hashes of all scenes, or of a log.
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/hash.h>
#include <lockstone/replay/seek.h>
#include <lockstone/replay/snapshot_file.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/logs/state/flipping_simulation.h"
#include "tools/lockstone/logs/state/hash_file.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/options.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;

struct HashOptions {
  std::string suite = "golden";
  std::string log;
  std::string name;
  std::string out;
  std::string states;
  std::uint64_t parts_every = 64;
  std::optional<std::uint64_t> flip_bit_at;
  bool force = false;
  bool json = false;  ///< always: here for symmetry with other commands
};

constexpr std::size_t k_most_quoted_config_bytes = 64U << 10;

// All hashes on the way of a golden scene.
ordered_json chain_of(const Games& games, const SceneDef& scene) {
  ordered_json chain = ordered_json::array();
  const Result<Match> match = games.start({.scene = scene.name});
  if (!match) return chain;
  MatchInputs inputs(*match.value().game, 1);
  Simulation& simulation = *match.value().simulation;
  for (std::uint32_t tick = 1; tick <= scene.ticks; ++tick) {
    simulation.step(inputs.next(simulation));
    if (tick % 10 == 0 || tick == scene.ticks) chain.push_back(hash_text(simulation.hash()));
  }
  return chain;
}

int emit(const HashOptions& options, const ordered_json& json) {
  if (options.out.empty()) {
    write_json(json, 1);
    return k_ok;
  }
  const std::string text = json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
  return write_text_file({options.out, options.force}, text) ? k_ok : k_unavailable;
}

int hash_scenes(const Games& games, const HashOptions& options) {
  ordered_json json = machine_json(k_scene_hashes_format, options.name);
  json["suite"] = options.suite;
  json["scenes"] = ordered_json::object();
  Progress progress;
  for (const GameDef& game : games.list()) {
    for (const SceneDef& scene : game.scenes) {
      progress.show(scene.name, json["scenes"].size(), 0);
      json["scenes"][scene.name] = chain_of(games, scene);
    }
  }
  progress.clear();
  return emit(options, json);
}

std::string hexadecimal_text(ByteView bytes) {
  std::string text;
  for (const std::byte byte : bytes)
    text += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  return text;
}

/// This build's run of one log.
class LogRun {
 public:
  LogRun(const HashOptions& options, replay::SeekResult& found)
      : options_(options), simulation_(*found.simulation), ticks_(*found.ticks) {}

  /// Not k_ok, with a complaint, when a state cannot be written or the log is damaged.
  [[nodiscard]] int run(ordered_json& json) {
    ordered_json chain = ordered_json::array();
    Progress progress;
    while (ticks_.next()) {
      progress.show("hash", chain.size(), 0);
      take_inputs(ticks_.inputs());
      step_tick(simulation_, ticks_.inputs(), ticks_.commands());
      chain.push_back({simulation_.tick(), hash_text(simulation_.hash())});
      const bool due = options_.parts_every > 0 && simulation_.tick() % options_.parts_every == 0;
      if (due && !keep()) return k_unavailable;
    }
    progress.clear();
    if (!keep()) return k_unavailable;
    json["chain"] = std::move(chain);
    if (!parts_.empty()) json["parts"] = std::move(parts_);
    if (!options_.states.empty()) json["states"] = options_.states;
    json["match"] = json.value("match", "") + ' ' + hash_text(inputs_hash_);
    const replay::Damage& damage = ticks_.reader().damage();
    if (damage.status == Status::ok) return k_ok;
    complain(fmt::format("{}, byte {}: {}", options_.log, damage.offset, damage.what));
    return k_corrupt;
  }

 private:
  void take_inputs(std::span<const PlayerInput> inputs) {
    for (const PlayerInput& input : inputs)
      inputs_hash_ = hash64(input.bytes, inputs_hash_ + static_cast<std::uint64_t>(input.origin));
  }

  // The hashes of the parts, and the state itself if it is wanted.
  [[nodiscard]] bool keep() {
    if (simulation_.tick() == kept_) return true;
    kept_ = simulation_.tick();
    std::array<PartHash, k_max_state_parts> parts{};
    const std::size_t count = simulation_.part_hashes(parts);
    ordered_json entry{{"tick", simulation_.tick()}};
    for (std::size_t i = 0; i < count; ++i) {
      entry[std::string(parts[i].name)] =
          hash_text(parts[i].hash.high) + hash_text(parts[i].hash.low);
    }
    if (count > 0) parts_.push_back(std::move(entry));
    if (options_.states.empty()) return true;
    const std::vector<std::byte> bytes = replay::pack_snapshot(canonical_bytes(simulation_));
    return write_text_file({state_file(options_.states, simulation_.tick()), options_.force},
                           std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

  const HashOptions& options_;
  Simulation& simulation_;
  replay::TickReader& ticks_;
  ordered_json parts_ = ordered_json::array();
  std::uint64_t inputs_hash_ = 0;
  std::uint64_t kept_ = ~std::uint64_t{0};
};

// Names the match, with the inputs that follow, so that hashes of two matches are never compared.
std::string match_text(const replay::LogHeader& header) {
  return fmt::format("{} {} {}", hash_text(header.match.match_id),
                     hash_text(header.info.config_hash), header.match.start_tick);
}

int hash_log(const Games& games, const HashOptions& options) {
  const GameLog log = open_game_log(games, options.log);
  if (log.source == nullptr) return log.exit_code;
  if (!options.states.empty()) {
    std::error_code error;
    std::filesystem::create_directories(options.states, error);
    if (error) {
      complain(fmt::format("{}: {}", options.states, error.message()));
      return k_unavailable;
    }
  }
  replay::SeekResult found =
      replay::seek(*log.source, log.game->make, log.match.start_tick, replay::SeekFrom::beginning);
  if (found.status != Status::ok) {
    complain(fmt::format("{}: {}", options.log, found.what));
    return exit_code_of(found.status);
  }
  if (options.flip_bit_at) {
    found.simulation = make_flipping(*log.game, std::move(found.simulation), *options.flip_bit_at);
  }
  ordered_json json = machine_json(k_log_hashes_format, options.name);
  json["game"] = log.game->name;
  json["game_version"] = log.game->version;
  json["match"] = match_text(found.ticks->reader().header());
  const ByteView config = found.ticks->config();
  if (config.size() <= k_most_quoted_config_bytes) json["config"] = hexadecimal_text(config);
  const int code = LogRun(options, found).run(json);
  return code == k_ok ? emit(options, json) : code;
}

}  // namespace

void add_hash_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<HashOptions>();
  CLI::App* command = app.add_subcommand(
      "hash", "Print, as JSON, the hashes that this machine computes, for `compare-hashes`");
  CLI::Option* suite = command->add_option("--suite", options->suite, "Which scenes: golden")
                           ->capture_default_str()
                           ->check(CLI::IsMember({"golden"}));
  CLI::Option* log =
      command->add_option("--log", options->log, "Hash the ticks of this log")->excludes(suite);
  command->add_option("--name", options->name, "Name of the machine, for the table");
  command->add_option("--out", options->out, "Write to this file");
  command
      ->add_option("--parts-every", options->parts_every,
                   "Ticks between hashes of the parts of the state; 0: only at the end")
      ->capture_default_str()
      ->needs(log);
  command
      ->add_option(
          "--states", options->states,
          "Keep the state of these ticks in this folder, so that `compare-hashes` can name "
          "the field; keep the folder beside the file")
      ->needs(log);
  command
      ->add_option("--flip-bit-at", options->flip_bit_at,
                   "Go wrong by one bit in this tick, for trying out `compare-hashes`")
      ->needs(log);
  command->add_flag("--json", options->json, "Nothing else is printed")->group("");
  add_force_option(*command, options->force);
  add_simd_option(*command);
  command->callback([options, &tool] {
    tool.exit_code =
        options->log.empty() ? hash_scenes(tool.games, *options) : hash_log(tool.games, *options);
  });
}

}  // namespace lockstone::tool
