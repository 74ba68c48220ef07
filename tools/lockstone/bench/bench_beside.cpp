#include "tools/lockstone/bench/bench_beside.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/bench/beside/many_islands.h"
#include "tools/bench/beside/scene_of_world.h"
#include "tools/lockstone/bench/print/bench_beside_print.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

constexpr int k_fewest_bodies = 100;

// Jolt collides again in each substep, and its users let it do so once a tick: both are shown.
void add_engine(std::vector<bench::BesideEngine>& engines, const bench::GeneralMaker& maker) {
  engines.push_back({maker, std::string(maker.name)});
  if (maker.name != "Jolt") return;
  engines.back().name = "Jolt, 4";
  engines.push_back({maker, "Jolt, 1", 1});
}

bench::BesideOptions options_of(const BesideRequest& request) {
  bench::BesideOptions options;
  add_engine(options.engines,
             request.iterated ? bench::lockstone_iterated() : bench::lockstone_general());
  for (const bench::GeneralMaker& peer : bench::general_peers()) {
    if (!request.peers.empty() && std::ranges::count(request.peers, peer.name) == 0) continue;
    if (peer.make != nullptr)
      add_engine(options.engines, peer);
    else
      complain(fmt::format("absent: {}, which needs {}", peer.name, peer.absent));
  }
  options.repeats = request.repeats;
  options.clock = request.cpu ? bench::thread_nanoseconds : bench::now_nanoseconds;
  return options;
}

bench::BesideRun play_scene(const BesideRequest& request, const bench::SpeedScene& scene,
                            const bench::BesideOptions& options) {
  const std::uint32_t ticks = request.ticks != 0 ? request.ticks : scene.ticks;
  const bench::SceneOfWorld plain = bench::scene_of_world(scene, static_cast<int>(ticks));
  if (plain.lacking.empty()) return bench::play_beside(plain.scene, options);
  bench::BesideRun run;
  run.scene = scene.name;
  run.lacking = "plain numbers have no place for " + plain.lacking;
  return run;
}

// As soon as it is known.
bench::BesideRun shown(const BesideRequest& request, Progress& progress, bench::BesideRun run) {
  progress.clear();
  if (!request.json) fmt::print("{}", beside_lines(run));
  std::fflush(stdout);
  return run;
}

IslandRuns play_islands(const BesideRequest& request, const bench::IslandKind& kind,
                        const bench::BesideOptions& options, Progress& progress) {
  IslandRuns islands{std::string(kind.name), std::string(kind.text), {}};
  for (int bodies = k_fewest_bodies; bodies <= request.most; bodies *= 10) {
    progress.show(fmt::format("{}, {} bodies", kind.name, bodies));
    bench::GeneralScene scene = bench::make_islands(kind, bodies);
    if (request.ticks != 0) scene.ticks = static_cast<int>(request.ticks);
    islands.runs.push_back(shown(request, progress, bench::play_beside(scene, options)));
  }
  return islands;
}

// That makes the same page again, in the place of this one.
std::string command_of(const BesideRequest& request) {
  std::string command = "lockstone bench speed";
  if (!request.only.empty()) command += fmt::format(" --scene {}", fmt::join(request.only, " "));
  if (request.ticks != 0) command += fmt::format(" --ticks {}", request.ticks);
  command += fmt::format(" --repeats {}", request.repeats);
  if (request.cpu) command += " --cpu";
  if (!request.vectors.empty()) command += fmt::format(" --vectors {}", request.vectors);
  if (request.scenes) command += " --peers";
  if (!request.peers.empty()) command += fmt::format(" {}", fmt::join(request.peers, ","));
  if (request.islands) command += " --islands";
  if (!request.kinds.empty()) command += fmt::format(" {}", fmt::join(request.kinds, ","));
  if (request.islands) command += fmt::format(" --most {}", request.most);
  if (request.iterated) command += " --iterated";
  if (!request.chart.empty()) command += fmt::format(" --chart {}", request.chart);
  return command + fmt::format(" --page {} --force", request.page);
}

// Fewer contacts than there are cost less.
int verdict_of(const bench::BesideRun& run) {
  int code = k_ok;
  for (const bench::BesideFigures& engine : run.figures) {
    if (engine.had_room) continue;
    complain(fmt::format("{}: {} had no room for all contacts", run.scene, engine.engine));
    code = k_different;
  }
  return code;
}

bool write_files(const BesideRequest& request, const BesideReport& report) {
  const std::string chart = std::filesystem::path(request.chart).filename().string();
  const bool page =
      request.page.empty() || write_text_file({request.page, request.force},
                                              beside_page(report, command_of(request), chart));
  return (request.chart.empty() ||
          write_text_file({request.chart, request.force}, islands_sheet(report.islands))) &&
         page;
}

}  // namespace

void add_beside_options(CLI::App& command, BesideRequest& request) {
  constexpr int k_most_names = 16;
  CLI::Option* peers =
      command
          .add_option("--peers", request.peers,
                      "Instead: the scenes beside other engines, all in this build or those named")
          ->expected(0, k_most_names)
          ->delimiter(',');
  CLI::Option* islands =
      command
          .add_option("--islands", request.kinds,
                      "Instead: worlds of many small islands beside other engines, of all kinds "
                      "or those named: stacks, piles, ragdolls")
          ->expected(0, k_most_names)
          ->delimiter(',');
  command.parse_complete_callback([&request, peers, islands] {
    request.scenes = peers->count() > 0;
    request.islands = islands->count() > 0;
    for (std::vector<std::string>* names : {&request.peers, &request.kinds})
      std::erase_if(*names, [](const std::string& name) { return name.empty() || name == "{}"; });
  });
  command.add_option("--most", request.most, "Bodies of the largest such world: a power of ten")
      ->check(CLI::Range(k_fewest_bodies, 1'000'000))
      ->capture_default_str();
  command.add_flag("--iterated", request.iterated,
                   "Only iterate our contacts, as with 0 converged_contacts");
  command.add_option("--page", request.page, "Also write the comparison into a file *.md");
  command.add_option("--chart", request.chart,
                     "Also draw the ratios of islands over their number into a file *.svg");
}

namespace {

// Whether all names are among those of `known`; says which is not.
bool knows_all(const std::vector<std::string>& names, const auto& known, std::string_view what) {
  for (const std::string& name : names) {
    if (std::ranges::any_of(known, [&](const auto& each) { return each.name == name; })) continue;
    complain(fmt::format("no {} is named {}", what, name));
    return false;
  }
  return true;
}

}  // namespace

int bench_beside(const BesideRequest& request, std::span<const bench::SpeedScene* const> scenes) {
  if (!knows_all(request.peers, bench::general_peers(), "engine") ||
      !knows_all(request.kinds, bench::island_kinds(), "kind of islands"))
    return k_usage;
  if (!may_write({request.page, request.force}) || !may_write({request.chart, request.force}))
    return k_unavailable;
  const bench::BesideOptions options = options_of(request);
  BesideReport report{request.cpu ? "thread" : "steady", {}, {}};
  if (!request.json) fmt::print("{}", beside_head(report.clock_name));
  Progress progress;
  if (request.scenes) {
    for (const bench::SpeedScene* scene : scenes) {
      progress.show(std::string(scene->name));
      report.scenes.push_back(shown(request, progress, play_scene(request, *scene, options)));
    }
  }
  if (request.islands) {
    for (const bench::IslandKind& kind : bench::island_kinds())
      if (request.kinds.empty() || std::ranges::count(request.kinds, kind.name) > 0)
        report.islands.push_back(play_islands(request, kind, options, progress));
  }
  if (request.json) print_beside_json(report);
  if (!write_files(request, report)) return k_unavailable;
  int code = k_ok;
  for (const bench::BesideRun& run : report.scenes)
    code = std::max(code, verdict_of(run));
  for (const IslandRuns& islands : report.islands)
    for (const bench::BesideRun& run : islands.runs)
      code = std::max(code, verdict_of(run));
  return code;
}

}  // namespace lockstone::tool
