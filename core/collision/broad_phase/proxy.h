// The broad phase's data of a body besides its bounds.
#pragma once

#include <cstdint>

#include <lockstone/collision.h>

#include "core/collision/broad_phase/bounds.h"

namespace lockstone {

struct ProxyTraits {
  CollisionFilter filter{};
  bool moves = false;       ///< kinematic or dynamic
  bool is_dynamic = false;  ///< can be pushed
  bool is_trigger = false;
  bool is_asleep = false;   ///< counts as standing, but stays in the list of moving bodies
  bool is_surface = false;  ///< of triangles

  friend constexpr bool operator==(const ProxyTraits&, const ProxyTraits&) = default;
};

/// Whether the body leads in its pairs. Contacts have triangles on their second side.
[[nodiscard]] constexpr bool leads(const ProxyTraits& body) {
  return body.moves && !body.is_surface;
}

/// Whether two bodies make a pair once their bounds overlap: one is awake, and one can be pushed or
/// senses the other.
[[nodiscard]] constexpr bool can_meet(const ProxyTraits& a, const ProxyTraits& b) {
  const bool can_push = a.is_dynamic || b.is_dynamic;
  const bool senses = a.is_trigger != b.is_trigger;
  const bool awake = (a.moves && !a.is_asleep) || (b.moves && !b.is_asleep);
  return awake && (can_push || senses) && !(a.is_trigger && b.is_trigger) &&
         should_collide(a.filter, b.filter);
}

/// The filters of one body, or of all below a node of a tree: enough to rule out that any pair
/// comes of them.
struct Layers {
  std::uint32_t categories = 0;
  std::uint32_t masks = 0;
  bool has_positive_group = false;

  friend constexpr bool operator==(const Layers&, const Layers&) = default;
};

[[nodiscard]] constexpr Layers layers_of(const CollisionFilter& filter) {
  return {filter.category, filter.mask, filter.group > 0};
}

[[nodiscard]] constexpr Layers united(const Layers& a, const Layers& b) {
  return {a.categories | b.categories, a.masks | b.masks,
          a.has_positive_group || b.has_positive_group};
}

/// False only when should_collide is false for every body of `a` with every body of `b`. A positive
/// group, which overrides categories and masks, needs a member on both sides.
[[nodiscard]] constexpr bool may_collide(const Layers& a, const Layers& b) {
  return ((a.masks & b.categories) != 0 && (b.masks & a.categories) != 0) ||
         (a.has_positive_group && b.has_positive_group);
}

/// A body as the broad phase keeps it. The fat box contains the tight one; while it does, nothing
/// but the tight box changes from tick to tick.
struct Proxy {
  Bounds fat;
  ProxyTraits traits;
  bool present = false;
};

}  // namespace lockstone
