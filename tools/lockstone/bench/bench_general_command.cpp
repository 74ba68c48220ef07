#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/lockstone/bench/print/bench_general_print.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

struct BenchGeneralOptions {
  std::vector<std::string> families;
  std::vector<std::string> peers;
  std::string replay, svg, plot, page, contacts;
  bool force = false;
  std::uint64_t first_seed = 1;
  int seeds = 20;
  int threads = 1;
  int substeps = 4;
  int cap = bench::k_no_cap;
  bool alone = false, json = false, list = false, shrink = false, islands = false;
  bool iterated = false;
};

bench::GeneralMaker ours(const BenchGeneralOptions& options) {
  return options.iterated ? bench::lockstone_iterated() : bench::lockstone_general();
}

std::vector<bench::GeneralMaker> engines_of(const BenchGeneralOptions& options) {
  std::vector<bench::GeneralMaker> engines{ours(options)};
  for (const bench::GeneralMaker& peer : bench::general_peers()) {
    const bool wanted =
        options.peers.empty() ? !options.alone : std::ranges::count(options.peers, peer.name) > 0;
    if (!wanted) continue;
    if (peer.make != nullptr)
      engines.push_back(peer);
    else
      complain(fmt::format("absent: {}, which needs {}", peer.name, peer.absent));
  }
  return engines;
}

void list_families() {
  for (const bench::Family& family : bench::families())
    fmt::print("{:<16} {}\n", family.name, family.text);
}

struct Seed {
  const bench::Family* family = nullptr;
  std::uint64_t seed = 0;
};

// FAMILY:SEED; no family when it is none.
Seed seed_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {};
  const std::string digits = text.substr(colon + 1);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) return {};
  return {bench::find_family(text.substr(0, colon)), std::stoull(digits)};
}

int shrink(const BenchGeneralOptions& options, const Seed& seed) {
  const int cap = bench::shrink_general(ours(options), *seed.family, seed.seed, options.substeps);
  if (cap == bench::k_no_cap) {
    fmt::print("{} does not fail\n", options.replay);
    return k_ok;
  }
  fmt::print("{} bodies still fail: lockstone bench general --replay {} --cap {}\n",
             bench::make_scene(*seed.family, seed.seed, cap).bodies.size(), options.replay, cap);
  return k_different;
}

// Returns whether ours fails.
bool play_scene(const BenchGeneralOptions& options, const bench::GeneralScene& scene) {
  fmt::print("{}:{}: {} bodies, {} joints, {} ticks, bound {:.3g}\n", scene.family, scene.seed,
             scene.bodies.size(), scene.joints.size(), scene.ticks, scene.bound);
  bool failed = false;
  for (const bench::GeneralMaker& engine : engines_of(options)) {
    const auto f = bench::play_general(engine, scene, options.substeps);
    if (!f.has_value()) continue;
    failed = failed || (engine.name == "lockstone" && f->failed);
    fmt::print(
        "{:<9} error {:.3g}, gap {:.3g} m, gain {:.3g}, {:.3g} m/s, rest {:.2f} s, asleep "
        "{:.2f}, {:.3g} us a tick, {}, {}\n",
        engine.name, f->error, f->gap, f->gain, f->speed, f->rest, f->asleep, f->tick_micros,
        hash_text(f->hash), f->failed ? "FAILED" : "as expected");
  }
  return failed;
}

int play_islands(const BenchGeneralOptions& options) {
  bool failed = false;
  for (const bench::Family& island : bench::single_islands())
    failed = play_scene(options, bench::make_scene(island, options.first_seed)) || failed;
  return failed ? k_different : k_ok;
}

int replay(const BenchGeneralOptions& options) {
  const Seed seed = seed_of(options.replay);
  if (options.shrink) return shrink(options, seed);
  const bench::GeneralScene scene = bench::make_scene(*seed.family, seed.seed, options.cap);
  const bool failed = play_scene(options, scene);
  if (!options.svg.empty() &&
      !write_text_file({options.svg, options.force},
                       bench::draw_general(ours(options), scene, options.substeps)))
    return k_unavailable;
  return failed ? k_different : k_ok;
}

// The options that change how our engine goes, where they are not the usual ones.
std::string settings_of(const BenchGeneralOptions& options) {
  std::string settings = options.iterated ? " --iterated" : "";
  if (options.substeps != 4) settings += fmt::format(" --substeps {}", options.substeps);
  return settings;
}

// That makes the same page again, in the place of this one.
std::string command_of(const BenchGeneralOptions& options) {
  std::string command = "lockstone bench general";
  if (!options.families.empty())
    command += fmt::format(" --family {}", fmt::join(options.families, ","));
  if (options.alone) command += " --alone";
  if (!options.peers.empty()) command += fmt::format(" --peers {}", fmt::join(options.peers, ","));
  command += settings_of(options);
  command += fmt::format(" --first-seed {} --seeds {} --page {}", options.first_seed, options.seeds,
                         options.page);
  if (!options.contacts.empty()) command += fmt::format(" --contacts {}", options.contacts);
  return command + " --force";
}

void show(int done, int total) {
  static Progress progress;
  if (done == total)
    progress.clear();
  else
    progress.show("seeds", static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(total));
}

int measure(const BenchGeneralOptions& options) {
  bench::GeneralOptions run;
  for (const bench::Family& family : bench::families()) {
    if (options.families.empty() || std::ranges::count(options.families, family.name) > 0)
      run.families.push_back(&family);
  }
  run.engines = engines_of(options);
  run.first_seed = options.first_seed;
  run.seeds = options.seeds;
  run.threads = options.threads;
  run.substeps = options.substeps;
  const std::vector<bench::FamilyRun> runs = bench::run_general(run, show);
  if (options.json) {
    print_general_json(runs, options.first_seed);
  } else {
    fmt::print("{}{}", general_table(runs),
               general_failures(runs, options.first_seed, settings_of(options)));
  }
  const std::string contacts_file = std::filesystem::path(options.contacts).filename().string();
  bool written = options.page.empty() ||
                 write_text_file({options.page, options.force},
                                 general_page(runs, command_of(options), contacts_file));
  if (!options.contacts.empty())
    written = write_text_file({options.contacts, options.force}, contacts_sheet(runs)) && written;
  if (!options.plot.empty()) written = plot_general(runs, {options.plot, options.force}) && written;
  if (!written) return k_unavailable;
  const bool failed = std::ranges::any_of(runs, [](const bench::FamilyRun& family) {
    return family.engine == "lockstone" && family.failures() > 0;
  });
  return failed ? k_different : k_ok;
}

int run(const BenchGeneralOptions& options) {
  if (options.list) {
    list_families();
    return k_ok;
  }
  if (options.islands) return play_islands(options);
  return options.replay.empty() ? measure(options) : replay(options);
}

std::string check_family(const std::string& name) {
  return bench::find_family(name) != nullptr ? std::string() : "no family: " + name;
}
std::string check_seed(const std::string& text) {
  return seed_of(text).family != nullptr ? std::string() : "not FAMILY:SEED: " + text;
}

void add_replay_options(CLI::App& command, BenchGeneralOptions& options) {
  CLI::Option* replay =
      command.add_option("--replay", options.replay, "Run one seed alone, given as FAMILY:SEED")
          ->check(CLI::Validator(check_seed, "SEED"));
  command.add_option("--svg", options.svg, "Draw it through its time into a file")->needs(replay);
  command.add_flag("--shrink", options.shrink, "Find smaller counts that still fail")
      ->needs(replay);
  command.add_option("--cap", options.cap, "The greatest value of any count in the scene")
      ->needs(replay)
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_bench_general_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchGeneralOptions>();
  options->threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  CLI::App* command =
      bench.add_subcommand("general", "Random scenes of each family, their worst and their median");
  command->add_option("--family", options->families, "Names; all when left out")
      ->delimiter(',')
      ->check(CLI::Validator(check_family, "FAMILY"));
  command->add_option("--seeds", options->seeds, "Number of seeds for each family")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--first-seed", options->first_seed, "First seed of each family")
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Seeds to run at the same time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_option("--substeps", options->substeps, "Substeps of each engine")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command->add_flag("--iterated", options->iterated,
                    "Only iterate our contacts, as with 0 converged_contacts");
  command->add_option("--peers", options->peers, "Names; all in this build when left out")
      ->delimiter(',');
  command->add_flag("--alone", options->alone, "Leave out the other engines");
  command->add_flag("--islands", options->islands, "Play single islands with fixed numbers");
  command->add_flag("--list", options->list, "Names of families");
  command->add_flag("--json", options->json, "Print every seed's figures as JSON");
  command->add_option("--plot", options->plot, "Also draw a chart a family into a folder");
  command->add_option("--contacts", options->contacts,
                      "Also draw the worst error over the number of contacts into a file *.svg");
  command->add_option("--page", options->page, "Also write the table into a file *.md");
  add_replay_options(*command, *options);
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
