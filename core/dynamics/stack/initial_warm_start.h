// The initial warm start: impulses for the contacts of bodies that were just put on each other.
//
// A contact starts with its impulses of the last tick. In a new stack there are none, each
// iteration propagates a load by about one contact, and a wall of a hundred rows sinks by metres
// before its lowest contacts carry the weight. Here loads are propagated from the top down instead,
// to each body after all bodies that rest on it. Its supports, as if they stood still, take the
// velocity that gravity, forces and the bodies on top of it give it, and propagate the impulses of
// that in turn. Levels of a contact graph as in E. Guendelman, R. Bridson, R. Fedkiw, "Nonconvex
// rigid bodies with stacking", 2003; but downwards, and both sides of a contact feel it, so that
// momentum is kept.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/stack/support_graph.h"
#include "core/dynamics/state/contact_record.h"

namespace lockstone {

class InitialWarmStart {
 public:
  /// No functions but this and `make_room` allocate.
  explicit InitialWarmStart(std::size_t contact_capacity) {
    mean_impulses_.reserve(contact_capacity);
  }
  void make_room(std::uint32_t workers);

  void clear() { mean_impulses_.clear(); }

  /// Of bodies that stand, over others, on something immovable: normal impulses of their supports,
  /// given to the blocks, and the velocities that they give to bodies, added to `warm`. Bodies
  /// faster than 1/4 m/s are left out. `order` has the contacts, and finds the bodies that stand.
  void find(SupportGraph& order, const ContactRun& run, std::span<lanes::BodyVelocity> warm,
            Parallel& parallel);

  /// To the records of new contacts, with the order of `find`.
  void store(const SupportGraph& order, std::span<ContactRecord> records) const;

 private:
  static constexpr std::int32_t k_no_impulse = -1;

  // A contact on which a body rests.
  struct Support {
    ContactRows contact;
    std::uint32_t link = 0;
    bool takes_mean = false;
    bool is_b = false;  // the body that rests
    std::int64_t share = 0;
    std::array<std::int64_t, lanes::k_block_points> own{};      // response of the body, Q30
    std::array<std::int64_t, lanes::k_block_points> impulse{};  // m/s, Q32
    RawVec3 turn{}, response{};                                 // of all points at once
    std::int64_t common = 0;                                    // response to them, Q30

    // Of a point, on the side of the body that rests.
    [[nodiscard]] const RawVec3& turn_of(std::size_t i) const {
      return is_b ? contact.points[i].angular_b : contact.points[i].angular_a;
    }
    [[nodiscard]] const RawVec3& response_of(std::size_t i) const {
      return is_b ? contact.points[i].response_b : contact.points[i].response_a;
    }
  };

  // Of one body.
  using Supports = std::vector<Support>;

  static void support_body(const SolverBody& body, const lanes::BodyVelocity& warm,
                           Supports& supports);
  [[nodiscard]] static bool tips(const lanes::BodyVelocity& row, const SolverBody& body,
                                 const Supports& supports);
  static void gather(const SupportGraph& order, const ContactRun& run, std::uint32_t body,
                     Supports& supports);
  static void fill(const ContactRun& run, Support& support);
  [[nodiscard]] static std::int64_t push_together(Support& support, lanes::BodyVelocity& body);
  [[nodiscard]] static std::int64_t push_points(Support& support, lanes::BodyVelocity& body);
  void propagate(const ContactRun& run, const Support& support, RowPush& to_a, RowPush& to_b);

  std::vector<Supports> supports_;  // by worker
  // By link, of a new contact: the impulse of a point, mean of all, for its record, m/s, Q20; else
  // k_no_impulse.
  std::vector<std::int32_t> mean_impulses_;
};

}  // namespace lockstone
