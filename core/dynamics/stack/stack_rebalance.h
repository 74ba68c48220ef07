// The stack rebalance: impulses, friction included, that keep a stack at rest, computed afresh.
//
// Iterations correct the bending of a stack as slowly as they spread its load: with warm starting,
// a contact is a spring of about m/h², and a wall of forty rows lies beyond the buckling load of
// such springs. So from time to time each body, from the top down, takes from its supports the
// impulses that stop it, with the least change in the sum of squares, and propagates them as the
// initial warm start does. The motion until then is stopped.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/stack/motion_balance.h"
#include "core/dynamics/stack/support_graph.h"

namespace lockstone {

class StackRebalance {
 public:
  /// No function but this allocates.
  void make_room(std::uint32_t workers);

  /// Computes the impulses of the supports of all bodies that stand firm. Gives them to the blocks,
  /// adds the velocities that they give to bodies to `warm`, and clears the bodies' motion in
  /// `run`. A body stands firm if it is slower than an eighth of the speed that gravity gives in a
  /// substep, and rests by three points or more on the ground or on bodies that stand firm, with
  /// friction of an eighth of the push to spare: enough to stop it in a substep.
  void find(SupportGraph& order, const ContactRun& run, std::span<lanes::BodyVelocity> warm,
            Parallel& parallel);

 private:
  // A contact on which a body rests, and the changes of its impulses, Q32.
  struct Support {
    ContactPair pair;
    std::uint32_t link = 0;
    bool has_friction_rows = false;  // friction takes part
    std::array<std::int64_t, lanes::k_block_points> points{};
    std::array<std::int64_t, 2> friction{};  // along t and b
  };

  // Of one body.
  struct Scratch {
    std::vector<Support> supports;
    std::vector<Motion6> columns;  // of the rows of these
  };

  static void gather(const SupportGraph& order, const ContactRun& run, std::uint32_t body,
                     Scratch& scratch);
  static void add_columns(const ContactRun& run, const Support& support, bool is_b,
                          std::vector<Motion6>& columns);
  [[nodiscard]] static bool balance(const ContactRun& run, const Motion6& change, Scratch& scratch);
  [[nodiscard]] static bool holds(const ContactRun& run, const Support& support);
  static void push(const ContactRun& run, const Support& support, RowPush& to_a, RowPush& to_b);

  std::vector<Scratch> scratch_;  // by worker
};

}  // namespace lockstone
