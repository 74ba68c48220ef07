// Pendulums: bodies that touch nothing and hang on one point of a body at rest. The pivot
// integrator moves them (pivot_integrator.h); the solver leaves out their joints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/joint/pivot_integrator.h"
#include "core/dynamics/state/joint_record.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

class Pendulums {
 public:
  /// No function but this allocates. Both outlive this.
  Pendulums(WorldData& world, const TickContacts& found);

  /// Finds the pendulums of this tick, after its contacts.
  void find();
  [[nodiscard]] bool has(std::uint32_t body) const { return place_of_[body] != 0; }
  /// Moves a pendulum to the end of the tick. Returns the number of turns about an axis.
  std::uint32_t run(std::uint32_t body);

  /// The joints of all other bodies that are awake: those that the solver gets.
  [[nodiscard]] std::span<const JointLink> joints_to_solve() const;
  /// Of these, only those for which `test` holds from here on.
  template <class Test>
  void keep_joints(Test test) {
    const std::span<const JointLink> all = joints_to_solve();
    if (!has_list_) solved_joints_.assign(all.begin(), all.end());
    std::erase_if(solved_joints_, [&](const JointLink& link) { return !test(link); });
    has_list_ = true;
  }

 private:
  struct Pendulum {
    std::uint32_t joint = 0;
    std::uint32_t body = 0;
    bool is_first = false;  // of the joint's bodies
  };
  void look_for(const JointLink& link);
  [[nodiscard]] Pivot pivot_of(const Pendulum& pendulum) const;

  WorldData& world_;
  const TickContacts& found_;
  std::vector<Pendulum> pendulums_;
  std::vector<std::uint32_t> place_of_;   // by body: in `pendulums_`, + 1
  std::vector<std::uint8_t> touches_;     // by body
  std::vector<JointLink> solved_joints_;  // the others, where these are not all
  bool has_list_ = false;                 // `solved_joints_` is not all
};

}  // namespace lockstone
