// One tick of a system by one of the methods.
#pragma once

#include <map>

#include "tools/bench/baselines/solvers/methods.h"

namespace lockstone::bench::trial {

inline constexpr double k_tick = 1.0 / 60;  // s

class Stepper {
 public:
  Stepper(System& system, const Options& options) : system_(system), options_(options) {}
  void tick();
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] double seconds() const { return seconds_; }  // in the solver alone

 private:
  void solve(Problem& problem);
  void round_poses(const Problem& problem);

  System& system_;
  Options options_;
  Counts counts_;
  std::map<std::vector<int>, BlockFactor> factors_, last_factors_;
  double seconds_ = 0;
};

}  // namespace lockstone::bench::trial
