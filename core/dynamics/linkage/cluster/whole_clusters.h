// Clusters one by one, for islands that are solved whole: which of them such an island can have,
// and the stages of one.
#pragma once

#include <cstdint>

#include "core/dynamics/linkage/cluster/cluster_stages.h"
#include "core/dynamics/linkage/cluster/energy_account.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class WholeClusters {
 public:
  WholeClusters(JointSystem& system, ClusterStages& stages, EnergyAccount& account)
      : system_(system), stages_(stages), account_(account) {}

  [[nodiscard]] std::uint32_t joint_count(std::uint32_t cluster) const {
    return system_.clusters[cluster].joint_count;
  }
  /// A body that it pushes, by its number in the solver.
  [[nodiscard]] std::uint32_t body_of(std::uint32_t cluster) const;
  /// Whether none of its joints has a body that moves by itself, which other clusters may share.
  [[nodiscard]] bool is_apart(std::uint32_t cluster) const;

  /// From here on only the functions below work at it, and move its bodies.
  void take(std::uint32_t cluster);

  /// The stages of `ClusterStages`, and the moves of its bodies between the last two. `relax`
  /// settles the account of energy, too.
  void warm_start(const JointRun& run, std::uint32_t cluster);
  void solve(const JointRun& run, std::uint32_t cluster);
  void move(const JointRun& run, std::uint32_t cluster);
  void relax(const JointRun& run, std::uint32_t cluster);

 private:
  JointSystem& system_;
  ClusterStages& stages_;
  EnergyAccount& account_;
};

}  // namespace lockstone
