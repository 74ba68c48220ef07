#include "tools/lockstone/bench/print/bench_front.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <CLI/App.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "tools/bench/charts/page.h"
#include "tools/bench/neutral/scene_json.h"
#include "tools/bench/peers/scene_peers.h"
#include "tools/bench/support/machine.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

using bench::EngineRuns;
using bench::NeutralMaker;
using bench::NeutralScene;
using bench::Played;

constexpr const char* k_ours_under_node = "lockstone wasm";
constexpr double k_quick_size = 1000;  // bodies times seconds

std::vector<NeutralScene> scenes_of(const FrontOptions& options) {
  std::vector<NeutralScene> scenes;
  for (const NeutralScene& scene : bench::neutral_scenes()) {
    const bool named = std::ranges::count(options.scenes, scene.name) > 0;
    const bool small = static_cast<double>(scene.bodies.size()) * scene.seconds < k_quick_size;
    if (options.scenes.empty() ? small || !options.quick : named) scenes.push_back(scene);
  }
  return scenes;
}

// All native engines with a scene at a setting: their results, then the times in turns.
void measure_point(const std::vector<NeutralMaker>& makers, std::vector<EngineRuns>& engines,
                   const NeutralScene& scene, int setting, int repeats) {
  std::vector<std::optional<Played>> plays;
  for (const NeutralMaker& maker : makers)
    plays.push_back(bench::play(maker, scene, setting));
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < makers.size(); ++i) {
      if (plays[i]) bench::time_again(makers[i], scene, *plays[i]);
    }
  }
  for (std::size_t i = 0; i < makers.size(); ++i) {
    if (plays[i]) engines[i].runs.push_back(std::move(*plays[i]));
  }
}

void measure_native(const FrontOptions& options, Progress& progress, MeasuredFront& measured) {
  std::vector<NeutralMaker> makers{bench::lockstone_maker()};
  if (!options.alone)
    makers.insert(makers.end(), bench::scene_peers().begin(), bench::scene_peers().end());
  std::vector<EngineRuns> engines;
  for (const NeutralMaker& maker : makers)
    engines.push_back({std::string(maker.name), "native", std::string(maker.knob), {}});
  // By way of JSON: the same text drives the other processes and these.
  const std::string json = bench::scenes_to_json(scenes_of(options));
  for (const NeutralScene& scene : bench::scenes_from_json(json)) {
    for (const int setting : options.settings) {
      progress.show(fmt::format("{} at {}", scene.name, setting));
      measure_point(makers, engines, scene, setting, options.repeats);
    }
  }
  for (EngineRuns& engine : engines) {
    if (engine.runs.empty())
      measured.absent.push_back(engine.name + ", not in this build or not able to do the scenes");
    else
      measured.engines.push_back(std::move(engine));
  }
}

// A file that is there while this lives.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / fmt::format("lockstone-{}.json", getpid())) {
    written_ = write_text_file({path_.string(), true}, text);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] bool written() const { return written_; }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
  bool written_ = false;
};

std::string settings_text(const FrontOptions& options) {
  return fmt::format("{}", fmt::join(options.settings, " "));
}

// The output of another process, a line a point.
void measure_by(const std::string& command, std::string name, std::string knob, Progress& progress,
                MeasuredFront& measured) {
  EngineRuns engine{std::move(name), "node", std::move(knob), {}};
  const int code = bench::for_lines_of(command, [&](std::string&& line) {
    Played played;
    if (!bench::played_from_json(line, played)) return;
    progress.show(fmt::format("{}: {} at {}", engine.name, played.scene, played.setting));
    engine.runs.push_back(std::move(played));
  });
  if (code != 0) complain(fmt::format("{}: ended with {}", engine.name, code));
  if (engine.runs.empty())
    measured.absent.push_back(engine.name + ", which needs Node and its package (tools/bench.sh)");
  else
    measured.engines.push_back(std::move(engine));
}

const EngineRuns* find_engine(const MeasuredFront& measured, std::string_view name) {
  const auto found = std::ranges::find(measured.engines, name, &EngineRuns::name);
  return found == measured.engines.end() ? nullptr : &*found;
}

// Ours comes to one state, whatever it was compiled for.
void compare_states(MeasuredFront& measured) {
  const EngineRuns* here = find_engine(measured, bench::k_ours);
  const EngineRuns* there = find_engine(measured, k_ours_under_node);
  if (here == nullptr || there == nullptr) return;
  for (const Played& played : there->runs) {
    const auto twin = std::ranges::find_if(here->runs, [&](const Played& other) {
      return other.scene == played.scene && other.setting == played.setting;
    });
    if (twin != here->runs.end() && twin->hash == played.hash)
      ++measured.same_states;
    else
      measured.other_states.push_back(fmt::format("{} at {}", played.scene, played.setting));
  }
}

std::string states_text(const MeasuredFront& measured) {
  const std::size_t all =
      static_cast<std::size_t>(measured.same_states) + measured.other_states.size();
  if (all == 0) return {};
  return fmt::format("{} ends {} of {} runs in the same state, by its hash, as natively",
                     k_ours_under_node, measured.same_states, all);
}

void measure_node(const FrontOptions& options, Progress& progress, MeasuredFront& measured) {
  const TemporaryFile file(bench::scenes_to_json(scenes_of(options)));
  if (!file.written()) return;
  const auto arguments =
      fmt::format("{} {} {}", bench::quoted(file.path()), options.repeats, settings_text(options));
  const auto runner = [&](std::string_view engine) {
    return fmt::format("node {} {} {}", bench::quoted(options.node + "/run.mjs"), engine,
                       arguments);
  };
  if (!options.wasm.empty()) {
    measure_by(fmt::format("node {} {}", bench::quoted(options.wasm), arguments), k_ours_under_node,
               "substeps", progress, measured);
  } else {
    measured.absent.push_back(
        "lockstone wasm, which needs Emscripten (tools/bench.sh): native times beside peers under "
        "Node are not fair, so these are judged by error alone");
  }
  measure_by(runner("rapier"), "Rapier", "solver iterations", progress, measured);
  measure_by(runner("jolt"), "Jolt", "collision steps", progress, measured);
}

bool write_all(const std::filesystem::path& folder, bool force,
               const std::vector<bench::Front>& fronts, const bench::PageFacts& facts) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  bool written = true;
  const auto write = [&](const std::string& name, const std::string& text) {
    if (!write_text_file({(folder / name).string(), force}, text)) written = false;
  };
  for (const bench::Front& front : fronts)
    write(fmt::format("{}.svg", front.error->name), bench::svg_of(bench::chart_of(front)));
  write("front.md", bench::front_page(fronts, facts, true));
  write("front.csv", bench::front_csv(fronts, facts));
  return written;
}

}  // namespace

void add_front_options(CLI::App& command, FrontOptions& options) {
  std::vector<std::string> names;
  for (const NeutralScene& scene : bench::neutral_scenes())
    names.push_back(scene.name);
  command.add_option("--scenes", options.scenes, "Names of neutral scenes; all when left out")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command.add_option("--settings", options.settings, "Substeps, or a peer's own knob")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_option("--repeats", options.repeats, "A time is the median of this many")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_flag("--quick", options.quick, "Run small scenes only, with settings 1 to 16");
  command.add_flag("--alone", options.alone, "Leave out the native peers");
  command.add_option("--node", options.node, "Folder of run.mjs, for peers under Node");
  command.add_option("--wasm", options.wasm, "lockstone_scene_player, ours under Node");
}

MeasuredFront measure_front(FrontOptions options) {
  if (options.quick) {
    options.settings = {1, 2, 4, 8, 16};
  }
  MeasuredFront measured;
  Progress progress;
  measure_native(options, progress, measured);
  if (options.node.empty())
    measured.absent.push_back("Rapier and Jolt, which need --node");
  else
    measure_node(options, progress, measured);
  compare_states(measured);
  return measured;
}

bool may_write_front(const Output& output) {
  if (output.path.ends_with(".svg")) return may_write(output);
  return may_write({(std::filesystem::path(output.path) / "front.md").string(), output.force});
}

bool write_front(const MeasuredFront& measured, const Output& output, const std::string& command) {
  const std::vector<bench::Front> fronts = bench::fronts_of(measured.engines);
  const bench::PageFacts facts{bench::machine_text(), bench::compiler_text(),
                               bench::commit_text(),  command,
                               measured.absent,       states_text(measured)};
  fmt::print("{}", bench::outcome_table(fronts));
  if (!facts.states.empty()) fmt::print("{}\n", facts.states);
  for (const std::string& other : measured.other_states)
    complain(fmt::format("{}: another state in WebAssembly", other));
  for (const std::string& absent : measured.absent)
    fmt::print("absent: {}\n", absent);
  if (!output.path.ends_with(".svg")) return write_all(output.path, output.force, fronts, facts);
  constexpr int k_columns = 3;
  std::vector<bench::Chart> charts;
  for (const bench::Front& front : fronts)
    charts.push_back(bench::chart_of(front));
  return write_text_file(output, bench::svg_sheet(charts, k_columns));
}

}  // namespace lockstone::tool
