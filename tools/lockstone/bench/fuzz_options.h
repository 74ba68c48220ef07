// The options that all fuzzers have.
#pragma once

#include <algorithm>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

namespace lockstone::tool {

/// Adds --count, --seed, --first, --threads and --json. `run` has members of the first four names;
/// `cases`: the name of the cases in the plural: "worlds", say.
template <class Run>
void add_fuzz_options(CLI::App& command, Run& run, bool& json, const std::string& cases) {
  run.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("--count", run.count, "Number of " + cases)->capture_default_str();
  command.add_option("--seed", run.seed, "Seed of the " + cases)->capture_default_str();
  command.add_option("--first", run.first, "Index to begin with")->capture_default_str();
  command.add_option("--threads", run.threads, "The result does not depend on them")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--json", json, "Print JSON");
}

}  // namespace lockstone::tool
