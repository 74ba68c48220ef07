#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/assert.h>
#include <lockstone/thread_pool.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/state/sync_test.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/options.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/render/svg.h"
#include "tools/scenes/play.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct RunOptions {
  std::string scene;
  std::uint64_t ticks = 0;
  std::uint64_t seed = 1;
  std::uint64_t hash_every = 10;
  std::string svg;
  BroadPhaseKind broad_phase = BroadPhaseKind::tree;
  std::uint32_t threads = 1;
  int frames = 1;
  bool json = false;
  bool heavy = false;
  bool overlay = false;
  bool validate = false;
  bool force = false;
  std::string forget;
};

struct ChainEntry {
  std::uint64_t tick;
  std::uint64_t hash;
};

render::Picture picture_of(const RunOptions& options, scenes::ScenePlay& play) {
  render::Picture picture;
  if (options.frames > 1) {
    picture.width = 640;
    picture.height = 440;
  }
  picture.caption =
      fmt::format("{}   tick {}   {} bodies   {}", options.scene, play.simulation().tick(),
                  play.world().body_count(), hash_text(play.simulation().hash()));
  if (options.scene == "arena") picture.style = render::arena_look;
  picture.overlay = options.overlay;
  return picture;
}

void print_json(const RunOptions& options, const std::vector<ChainEntry>& chain,
                std::uint64_t final_hash) {
  nlohmann::ordered_json json{
      {"scene", options.scene}, {"seed", options.seed}, {"ticks", options.ticks}};
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const ChainEntry& entry : chain) {
    entries.push_back({{"tick", entry.tick}, {"hash", hash_text(entry.hash)}});
  }
  json["chain"] = std::move(entries);
  json["final_hash"] = hash_text(final_hash);
  write_json(json);
}

void print_text(const std::vector<ChainEntry>& chain, std::uint64_t final_hash) {
  for (const ChainEntry& entry : chain)
    fmt::print("{:>6} {}\n", entry.tick, hash_text(entry.hash));
  fmt::print(" final {}\n", hash_text(final_hash));
}

/// A run of one scene.
class Run {
 public:
  Run(const Games& games, const RunOptions& options, std::unique_ptr<scenes::ScenePlay> play)
      : options_(options), play_(std::move(play)), pool_(options.threads) {
    if (options.threads > 1) play_->set_task_runner(&pool_, TaskPieces::worthwhile);
    if (!options.heavy && options.forget.empty()) return;
    Match copy = games.start({.scene = options.scene, .seed = options.seed}).value();
    twin_.emplace(*copy.game, play_->simulation(), std::move(copy.simulation), options.forget);
  }

  int operator()() {
    for (std::uint64_t tick = 1; tick <= options_.ticks; ++tick) {
      if (!step(tick)) return k_different;
    }
    progress_.clear();
    if (!options_.forget.empty() && twin_->forgotten() == 0) {
      complain(fmt::format("no field {} that is not zero", options_.forget));
      return k_usage;
    }
    const std::uint64_t final_hash = play_->simulation().hash();
    options_.json ? print_json(options_, chain_, final_hash) : print_text(chain_, final_hash);
    return write_picture() ? k_ok : k_unavailable;
  }

 private:
  [[nodiscard]] bool step(std::uint64_t tick) {
    progress_.show(options_.scene, tick, options_.ticks);
    if (!step_worlds(tick) || !is_valid(tick)) return false;
    if (options_.hash_every > 0 && tick % options_.hash_every == 0) {
      chain_.push_back({tick, play_->simulation().hash()});
    }
    const auto frames = static_cast<std::uint64_t>(options_.frames);
    const std::uint64_t due = (moments_.size() + 1) * options_.ticks / frames;
    if (!options_.svg.empty() && tick == due) {
      keep_moment();
    }
    return true;
  }

  [[nodiscard]] bool step_worlds(std::uint64_t tick) {
    if (!twin_) {
      play_->step();
      return true;
    }
    const std::string difference = twin_->step(play_->next_inputs());
    if (difference.empty()) return true;
    progress_.clear();
    complain(fmt::format("{}, tick {}: a saved and loaded copy went another way: {}",
                         options_.scene, tick, difference));
    return false;
  }

  [[nodiscard]] bool is_valid(std::uint64_t tick) {
    const WorldFault fault = options_.validate ? play_->world().find_fault() : WorldFault{};
    if (!fault) return true;
    progress_.clear();
    complain(fmt::format("{}, tick {}: {} does not fit, {}", options_.scene, tick, fault.what,
                         fault.index));
    return false;
  }

  void keep_moment() {
    const Simulation& simulation = play_->simulation();
    std::vector<std::byte> bytes(simulation.snapshot_bytes_max(SnapshotKind::canonical));
    bytes.resize(simulation.save(SnapshotKind::canonical, bytes));
    moments_.push_back(std::move(bytes));
  }

  // One frame for all moments, so that the camera stands still.
  [[nodiscard]] std::vector<std::string> draw_moments() {
    std::optional<render::Frame> frame;
    for (const std::vector<std::byte>& moment : moments_) {
      LKS_CHECK(play_->simulation().load(SnapshotKind::canonical, moment) == Status::ok);
      const render::Frame own = render::framing(play_->world(), picture_of(options_, *play_));
      if (!frame) frame = own;
      frame->include(own);
    }
    std::vector<std::string> pictures;
    for (const std::vector<std::byte>& moment : moments_) {
      LKS_CHECK(play_->simulation().load(SnapshotKind::canonical, moment) == Status::ok);
      pictures.push_back(render::draw(play_->world(), picture_of(options_, *play_), *frame));
    }
    return pictures;
  }

  [[nodiscard]] bool write_picture() {
    if (options_.svg.empty()) return true;
    const std::vector<std::string> pictures = draw_moments();
    const int columns = pictures.size() == 4 ? 2 : std::min<int>(3, options_.frames);
    return write_text_file({options_.svg, options_.force},
                           pictures.size() == 1
                               ? pictures.front()
                               : render::strip(pictures, picture_of(options_, *play_), columns));
  }

  const RunOptions& options_;
  std::unique_ptr<scenes::ScenePlay> play_;
  ThreadPool pool_;
  std::optional<SyncTest> twin_;
  std::vector<ChainEntry> chain_;
  std::vector<std::vector<std::byte>> moments_;  // canonical states to be drawn at the end
  Progress progress_;
};

int run(const Games& games, RunOptions options) {
  if (!may_write({options.svg, options.force})) return k_unavailable;
  Result<std::unique_ptr<scenes::ScenePlay>> play =
      scenes::make_play(options.scene, options.seed, options.broad_phase);
  if (!play) {
    complain(fmt::format("unknown scene {}; `lockstone scenes` lists them", options.scene));
    return k_usage;
  }
  return Run(games, options, std::move(play).value())();
}

}  // namespace

void add_run_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run a scene and print its hashes");
  command->add_option("--scene", options->scene, "Name, see `scenes`")->required();
  command->add_option("--ticks", options->ticks, "Ticks to run")
      ->required()
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  command->add_option("--seed", options->seed, "For scenes with chance in them")
      ->capture_default_str();
  command->add_option("--hash-every", options->hash_every, "Ticks between hashes; 0: only the last")
      ->capture_default_str();
  add_simd_option(*command);
  add_broad_phase_option(*command, options->broad_phase);
  add_threads_option(*command, options->threads);
  CLI::Option* svg = command->add_option("--svg", options->svg, "Draw the end into this file");
  add_force_option(*command, options->force);
  command
      ->add_option("--frames", options->frames,
                   "Draw this many moments, evenly spaced, with one camera")
      ->check(CLI::Range(1, 60))
      ->needs(svg);
  command
      ->add_flag("--overlay", options->overlay,
                 "Draw bounds, centres of mass, contacts and joints too")
      ->needs(svg);
  command->add_flag("--validate", options->validate,
                    "Check the whole world after each tick, and stop at a fault");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--heavy", options->heavy,
                    "Each tick, also step a copy loaded from the saved state, and compare");
  command->add_option("--forget", options->forget,
                      "As --heavy, as if `save` left out this field (body.spin.x): it must differ");
  command->callback([options, &tool] { tool.exit_code = run(tool.games, *options); });
}

}  // namespace lockstone::tool
