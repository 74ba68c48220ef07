// The contacts that a tick found. The narrow phase fills them; the later stages of the tick read
// and complete them, until they replace the contacts of the state.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/contact/contact_prepare.h"
#include "core/dynamics/state/contact_record.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// Records are numbered by key; a manifold has an id of its own, because workers find manifolds in
/// no order.
struct TickContacts {
  explicit TickContacts(std::uint32_t contact_capacity) {
    records.reserve(contact_capacity);
    manifold_ids.reserve(contact_capacity);
    approach_speeds.reserve(contact_capacity);
  }

  /// After the records and the ids of their manifolds were counted.
  void resize(std::uint32_t count) {
    records.resize(count);
    manifold_ids.resize(count);
    approach_speeds.resize(count);
  }

  [[nodiscard]] const Manifold& manifold_of(std::size_t contact) const {
    return manifolds[manifold_ids[contact]];
  }
  [[nodiscard]] Manifold& manifold_of(std::size_t contact) {
    return manifolds[manifold_ids[contact]];
  }
  [[nodiscard]] const ContactSurface& surface_of(std::size_t contact) const {
    return surfaces[manifold_ids[contact]];
  }
  [[nodiscard]] ContactSurface& surface_of(std::size_t contact) {
    return surfaces[manifold_ids[contact]];
  }

  std::vector<ContactRecord> records;           // by key
  std::vector<std::uint32_t> manifold_ids;      // by record
  std::vector<SolverVelocity> approach_speeds;  // by record
  std::vector<Manifold> manifolds;              // by manifold id
  std::vector<ContactSurface> surfaces;         // by manifold id
  bool has_elastic = false;                     // a contact with restitution
};

}  // namespace lockstone
