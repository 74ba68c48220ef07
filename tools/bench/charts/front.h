// Time against error of one figure for all engines: whose line lies below and left of the others.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/charts/chart.h"
#include "tools/bench/neutral/judge.h"

namespace lockstone::bench {

/// Engines of one process family: only their times can be put beside each other.
struct EngineRuns {
  std::string name;
  std::string family;  ///< "native" or "node"
  std::string knob;
  std::vector<Played> runs;
};

inline constexpr std::string_view k_ours = "lockstone";

struct FrontPoint {
  int setting = 0;
  double seconds = 0;  ///< of CPU time, a simulated second
  double error = 0;
};

struct FrontLine {
  const EngineRuns* engine = nullptr;
  std::vector<FrontPoint> points;  ///< ascending by setting
};

struct Front {
  const JudgedError* error = nullptr;
  std::vector<FrontLine> lines;  ///< ours first; engines that cannot do the scene have none
};

[[nodiscard]] std::vector<Front> fronts_of(const std::vector<EngineRuns>& engines);

/// Wins are the first two, losses the others.
enum class Outcome {
  ahead,           ///< at every point of the peer we err no more in no more time
  ahead_at_best,   ///< at its least error, but not at every faster point
  behind_at_best,  ///< not at its least error, but at another of its points
  behind,          ///< at none
};
inline constexpr std::size_t k_outcomes = 4;

/// Ours against a peer.
struct Verdict {
  const FrontLine* peer = nullptr;
  Outcome outcome = Outcome::behind;
  int better = 0;
  int points = 0;
  FrontPoint best;    ///< the peer's least error
  FrontPoint ours;    ///< our least error in no more time; seconds 0: we have none so fast
  bool timed = true;  ///< false: no line of ours in the peer's family, errors at any time
};

[[nodiscard]] std::vector<Verdict> verdicts_of(const Front& front);

[[nodiscard]] Chart chart_of(const Front& front);

/// "ahead", "ahead at its best" …
[[nodiscard]] std::string_view name_of(Outcome outcome);

}  // namespace lockstone::bench
