// Contacts of two bodies, part by part.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/units.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/geometry/distance/manifold.h"
#include "core/geometry/mesh_contact/mesh_contacts.h"

namespace lockstone {

/// One manifold of a pair of bodies. Anchors are relative to the centres of mass.
struct PartContact {
  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;
  const Surface* surface_a = nullptr;  ///< null: the body's own
  const Surface* surface_b = nullptr;
  Manifold manifold;
};

/// Manifolds of one pair of bodies, ascending by parts. Manifolds that do not fit are left out, the
/// last first, and `overflowed` says so.
struct PartContacts {
  static constexpr int k_capacity = 64;

  PartContacts() {}  // tens of kilobytes: not filled with zeros

  union {
    std::array<PartContact, k_capacity> contacts;  // the first `count`
  };
  int count = 0;
  bool overflowed = false;
  Vec3<Unit> separating_axis{};  ///< of two single shapes without contacts: zero when none is known

  [[nodiscard]] const PartContact* begin() const { return contacts.data(); }
  [[nodiscard]] const PartContact* end() const { return contacts.data() + count; }

  void clear() {
    count = 0;
    overflowed = false;
    separating_axis = {};
  }
  void add(const PartContact& contact) {
    overflowed = overflowed || count == k_capacity;
    if (count < k_capacity) contacts[static_cast<std::size_t>(count++)] = contact;
  }
};

/// Scratch memory for colliding with triangles; only worlds that know such assets have it.
struct TriangleScratch {
  geometry::TriangleContacts contacts;
  geometry::MeshManifolds manifolds;
};

/// All contacts between two placed shapes; `out` is filled again. Each pair of convex parts gives a
/// manifold, as `collide` finds it; triangles give one for each plane and surface, whose key stands
/// for the part. Of half-spaces and assets with triangles only B may be one. `scratch` may be null
/// when B has no triangles. `held`: as in `collide`, of two single shapes.
void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin,
                    TriangleScratch* scratch, PartContacts& out, const HeldFeatures& held = {});

/// The same with scratch memory on the stack, tens of kilobytes where B has triangles.
void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin, PartContacts& out);

/// Whether the unit axis, from A to B, shows that `collide_bodies` finds nothing (see
/// `separated_along` of posed shapes). Only single shapes, neither a half-space, are looked at.
[[nodiscard]] bool separated_along(const PlacedShape& a, const PlacedShape& b, Length margin,
                                   const Vec3<Unit>& axis);

/// Whether the two touch or overlap.
[[nodiscard]] bool bodies_overlap(const PlacedShape& a, const PlacedShape& b);

}  // namespace lockstone
