#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <lockstone/replay/recorder.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/flipping_simulation.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/start_match.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct RecordOptions {
  StartOptions start;
  std::string out;
  std::uint64_t ticks = 600;
  std::optional<std::uint32_t> keyframes;
  bool plain = false;
  std::string key;
  std::optional<std::uint64_t> flip_bit_at;
  std::optional<std::uint64_t> match_id;
  bool force = false;
};

bool prepare(const RecordOptions& options, replay::RecorderOptions& recorder) {
  recorder.compress = !options.plain;
  if (options.keyframes) {
    recorder.keyframe_interval_ticks = *options.keyframes;
    recorder.early_keyframe_interval_ticks = *options.keyframes;
  }
  if (options.key.empty()) return true;
  recorder.signing_key = read_signing_key(options.key);
  return recorder.signing_key.has_value();
}

Status play(const RecordOptions& options, const GameDef& game, Simulation& simulation,
            replay::Recorder& recorder) {
  Progress progress;
  MatchInputs inputs(game, options.start.seed);
  for (std::uint64_t tick = 0; tick < options.ticks; ++tick) {
    progress.show("record", tick, options.ticks);
    const std::span<const PlayerInput> pressed = inputs.next(unwrapped(simulation));
    simulation.step(pressed);
    const Status status = recorder.record_step(simulation, pressed);
    if (status != Status::ok) return status;
  }
  return recorder.finish("recorded");
}

int record(const Games& games, const RecordOptions& options) {
  std::optional<Match> match = start_match(games, options.start);
  if (!match) return k_usage;
  std::unique_ptr<Simulation> made = std::move(match->simulation);
  if (options.flip_bit_at) {
    if (world_of(*match->game, *made) == nullptr) {
      complain("--flip-bit-at: the game shows no world to flip a bit of");
      return k_usage;
    }
    made = make_flipping(*match->game, std::move(made), *options.flip_bit_at);
  }
  Simulation& simulation = *made;
  replay::RecorderOptions recorder_options{
      .keyframe_bytes_max = simulation.snapshot_bytes_max(SnapshotKind::canonical)};
  if (!prepare(options, recorder_options)) return k_usage;
  const std::unique_ptr<replay::FileSink> sink = create_log({options.out, options.force});
  if (sink == nullptr) return k_unavailable;
  replay::Recorder recorder(*sink, recorder_options);
  replay::MatchMetadata metadata{.match_id = options.match_id.value_or(random_match_id()),
                                 .seed = options.start.seed};
  name_game(*match->game, metadata);
  Status status = recorder.begin(simulation.info(), match->config, metadata);
  if (status == Status::ok) status = play(options, *match->game, simulation, recorder);
  if (status == Status::ok) {
    fmt::print("{}: {} ticks, final hash {}\n", options.out, options.ticks,
               hash_text(simulation.hash()));
    return k_ok;
  }
  complain(fmt::format("{}: {}", options.out, to_string(status)));
  return k_unavailable;
}

}  // namespace

void add_record_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand("record", "Play a match of bots into a log");
  command->add_option("out", options->out, "The log to write (.lks)")->required();
  add_start_options(*command, tool.games, options->start);
  command->add_option("--ticks", options->ticks, "Ticks to record")->capture_default_str();
  command->add_option("--keyframes", options->keyframes,
                      "Ticks between keyframes; 0: none [600, at first 150]");
  command->add_flag("--plain", options->plain, "Compress nothing, so that every build can read it");
  command->add_option("--sign", options->key, "Sign with the secret key in this file");
  command->add_option("--flip-bit-at", options->flip_bit_at,
                      "Go wrong by one bit in this tick, for trying out `verify` and `bisect`");
  command->add_option("--match-id", options->match_id,
                      "Number of the match; chosen at random when left out");
  add_force_option(*command, options->force);
  command->callback([options, &tool] { tool.exit_code = record(tool.games, *options); });
}

}  // namespace lockstone::tool
