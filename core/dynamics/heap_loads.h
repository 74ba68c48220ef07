// What contacts of a heap carry, found anew: impulses, friction included, that keep it at rest.
//
// Sweeps hand on what a heap bends by as slowly as its load: one that starts warm is a spring of
// about m/h² a contact, and a wall of forty rows lies beyond the buckling load of such springs. So
// from time to time each body, from the top downwards, asks of its supports what it takes to stand
// still, the least change in the sum of squares, and hands that down, as first loads are. What
// moved until then is stopped.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/motion_balance.h"
#include "core/dynamics/support_order.h"

namespace lockstone {

class HeapLoads {
 public:
  /// No function but this allocates.
  void make_room(std::uint32_t workers);

  /// Of bodies that stand firm: what their supports push with, given to the blocks, and what that
  /// does to bodies, added to `warm`; their own motion in `run` is taken away. Firm is what is
  /// slower than an eighth of what gravity gives in a substep, and rests by three points or more on
  /// the ground, or on what stands firm, with friction of an eighth of the push to spare: enough to
  /// stop, in a substep, all that stands there.
  void find(SupportOrder& order, const ContactRun& run, std::span<lanes::RowBody> warm,
            Parallel& parallel);

 private:
  // A contact on which a body rests, and what it has to push more, Q32.
  struct Support {
    ContactPair pair;
    std::uint32_t link = 0;
    bool is_tied = false;  // friction takes part
    std::array<std::int64_t, lanes::k_block_points> points{};
    std::array<std::int64_t, 2> ties{};  // along t and b
  };

  // Of one body.
  struct Scratch {
    std::vector<Support> supports;
    std::vector<Motion6> columns;  // of the rows of these
  };

  static void gather(const SupportOrder& order, const ContactRun& run, std::uint32_t body,
                     Scratch& scratch);
  static void add_columns(const ContactRun& run, const Support& support, bool is_b,
                          std::vector<Motion6>& columns);
  [[nodiscard]] static bool balance(const ContactRun& run, const Motion6& change, Scratch& scratch);
  [[nodiscard]] static bool holds(const ContactRun& run, const Support& support);
  static void push(const ContactRun& run, const Support& support, RowPush& to_a, RowPush& to_b);

  std::vector<Scratch> scratch_;  // by worker
};

}  // namespace lockstone
