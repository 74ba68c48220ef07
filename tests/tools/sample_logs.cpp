// Writes logs for the tests of the command: `sample_logs FOLDER`.
//   good.lks      a match of bots
//   altered.lks   the same with one other input bit, checksums right: it must diverge
//   foreign.lks   of another configuration hash
//   open.lks      without an end, as after a kill
//   sumo.lks      of a game that the command does not know
#include <array>
#include <cstdio>
#include <string>

#include <lockstone/replay/recorder.h>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"

namespace {

using namespace lockstone;

constexpr std::uint64_t k_ticks = 700;  // beyond the first keyframe
constexpr arena::ArenaConfig k_config{.seed = 11, .loose_bodies = 40, .players = 2};

struct Sample {
  const char* name;
  bool altered = false;
  bool foreign = false;
  bool open = false;
  bool unknown = false;
};

using Bytes = std::array<std::array<std::byte, arena::k_input_bytes>, 2>;

bool write_tick(const Sample& sample, arena::ArenaSimulation& game, replay::Recorder& recorder) {
  Bytes bytes{};
  for (std::size_t slot = 0; slot < 2; ++slot) {
    arena::bot_input(game.arena(), 1, slot).encode(bytes[slot]);
  }
  const std::array<PlayerInput, 2> played{PlayerInput{bytes[0]}, PlayerInput{bytes[1]}};
  const std::uint64_t tick = game.tick();
  game.step(played);
  if (sample.altered && tick == 300)
    bytes[1][0] ^= std::byte{0x40};  // in the log alone: not played
  return recorder.record_tick(tick, played, game.hash()) == Status::ok &&
         (!recorder.keyframe_due() || recorder.keyframe(game) == Status::ok);
}

bool write_log(const std::string& folder, const Sample& sample) {
  auto sink = replay::FileSink::create(folder + '/' + sample.name);
  if (!sink) return false;
  arena::ArenaSimulation game(k_config);
  replay::Recorder recorder(
      *sink.value(), {.keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical)});
  SimulationInfo info = game.info();
  if (sample.foreign) info.config_hash ^= 1;
  replay::MatchMetadata match{.match_id = 1, .build = "sample_logs", .game = "arena"};
  if (sample.unknown) {
    match.game = "sumo";
    match.game_version = "1.2";
  }
  if (recorder.begin(info, k_config.encode(), match) != Status::ok) {
    return false;
  }
  while (game.tick() < k_ticks) {
    if (!write_tick(sample, game, recorder)) return false;
  }
  return sample.open || recorder.finish("sample") == Status::ok;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  const Sample samples[] = {{.name = "good.lks"},
                            {.name = "altered.lks", .altered = true},
                            {.name = "foreign.lks", .foreign = true},
                            {.name = "open.lks", .open = true},
                            {.name = "sumo.lks", .unknown = true}};
  for (const Sample& sample : samples) {
    if (write_log(argv[1], sample)) continue;
    std::fprintf(stderr, "cannot write %s\n", sample.name);
    return 1;
  }
  return 0;
}
