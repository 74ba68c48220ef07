// The contacts of a tick's solver: which record, manifold and bodies each has.
//
// Contacts of triggers, and those that bounce by themselves, are left out. The rest keep the order
// of their records, by `ContactId`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"

namespace lockstone {

/// A contact's record and manifold, as the scene numbers them, and its bodies.
struct ContactRef {
  std::uint32_t record = 0;
  std::uint32_t manifold = 0;
  BodyRef a, b;

  /// Between a body that can move and one that stands still.
  [[nodiscard]] bool has_standing() const { return a.is_standing() || b.is_standing(); }
};

class ContactList {
 public:
  /// No function but this allocates.
  [[gnu::cold]] explicit ContactList(std::size_t contact_capacity);

  /// Lists the contacts of a scene, and gathers their bodies. A contact is bearing if the mean
  /// impulse of all its points exceeds `bearing_impulse`, m/s, Q20.
  void gather(const ContactScene& scene, std::int64_t bearing_impulse, SolverBodies& bodies,
              Parallel& parallel);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(refs_.size()); }
  [[nodiscard]] const ContactRef& operator[](ContactId contact) const {
    LKS_ASSERT(contact.value < refs_.size());
    return refs_[contact.value];
  }

  /// Calls `visit(id, ref)` for each contact, in their order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::uint32_t i = 0; i < refs_.size(); ++i)
      visit(ContactId{i}, refs_[i]);
  }

  /// Between two dynamic bodies, and not there in the tick before.
  [[nodiscard]] bool is_new(const ContactRef& ref) const {
    return sides_[ref.record].a.is_marked();
  }
  [[nodiscard]] bool is_bearing(const ContactRef& ref) const {
    return sides_[ref.record].b.is_marked();
  }

 private:
  // The bodies of a record; none where it is left out. A mark on side A: a new contact of two
  // dynamic bodies; on side B: a bearing contact.
  struct Sides {
    BodySide a, b;
  };

  void find_sides(const ContactScene& scene, std::int64_t bearing_impulse, std::size_t first,
                  std::size_t end);

  std::vector<Sides> sides_;  // by record
  std::vector<ContactRef> refs_;
};

}  // namespace lockstone
