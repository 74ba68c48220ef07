// `lockstone bench speed --peers` and `--islands`: our ticks beside those of other engines.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "tools/bench/speed/speed_scene.h"

namespace lockstone::tool {

struct BesideRequest {
  std::vector<std::string> peers;  ///< names; none: all in this build
  bool scenes = false;
  bool islands = false;
  std::vector<std::string> kinds;  ///< of islands; none: all
  int most = 10'000;               ///< bodies of the largest world of islands
  bool iterated = false;           ///< our contacts, as with 0 `converged_contacts`
  std::string page, chart;

  // Of the command itself, when it runs.
  std::vector<std::string> only;  ///< scenes, for the command that the page names
  std::uint32_t ticks = 0;        ///< 0: as many as the scene says
  int repeats = 1;
  bool cpu = false, json = false, force = false;
  std::string vectors;

  [[nodiscard]] bool wanted() const { return scenes || islands; }
};

void add_beside_options(CLI::App& command, BesideRequest& request);

/// The exit code.
int bench_beside(const BesideRequest& request, std::span<const bench::SpeedScene* const> scenes);

}  // namespace lockstone::tool
