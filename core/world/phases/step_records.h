#pragma once

// Small records that the stages of one tick pass on to each other.

#include <compare>
#include <cstdint>

#include <lockstone/command.h>

#include "core/collision/broad_phase/bounds.h"
#include "core/collision/broad_phase/pair.h"
#include "core/collision/continuous/first_impact.h"

namespace lockstone {

/// A push, and the velocities that it gives a body (force_commands.cpp).
struct Push {
  Vec3<Impulse> impulse{};
  Vec3<AngularImpulse> turn{};
  const Vec3<Length>* point = nullptr;  // null: the centre of mass
  Frame frame{};
};

/// A contact that bounces within the tick; a group of them is named by its least body.
struct BouncingContact {
  std::uint32_t root = 0;
  std::uint32_t contact = 0;

  friend auto operator<=>(const BouncingContact&, const BouncingContact&) = default;
};

/// The contacts of a pair of bodies taken together (contact_events.cpp).
struct PairState {
  Pair bodies;
  bool exists = false, trigger = false, touching = false;  // touching of a trigger: overlapping
  SolverVelocity approach{};
  std::uint32_t contacts = 0, tag_a = 0, tag_b = 0;  // tags of the fastest contact
};

/// The contacts that were found of a pair, in manifold ids and in the list of contacts.
struct FoundContacts {
  std::uint32_t first_id = 0, count = 0, index = 0;
};

/// The origin of a new contact: parts, and its record of the tick before.
struct ContactOrigin {
  static constexpr std::uint32_t k_new = 0xffffffff;

  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;
  std::uint32_t before = k_new;  // in the contacts of the tick before
  std::uint16_t flags = 0;       // ContactFlag of a contact without points
};

}  // namespace lockstone
