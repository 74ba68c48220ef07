// Events of a step. Arrays in canonical order, never callbacks.
#pragma once

#include <cstdint>
#include <string_view>

#include <lockstone/body.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

enum class EventKind : std::uint8_t {
  contact_begin = 0,  ///< the two bodies touch, and did not a tick ago
  contact_end = 1,
  trigger_enter = 2,  ///< one of the two is a trigger and they overlap, and did not a tick ago
  trigger_stay = 3,
  trigger_exit = 4,
  impact = 5,  ///< `a` was stopped on its way by `b` within the tick and may have left it again
  sleep = 6,   ///< dynamic body `a` fell asleep; `b` is null
  wake = 7,    ///< dynamic body `a` woke in this step or by a command before it; `b` is null
  contact_persist = 8,  ///< the two touch, as a tick ago; of bodies that ask for it (EventSettings)
};
[[nodiscard]] std::string_view to_string(EventKind kind);

/// A body that passes a trigger within a tick enters and exits in that tick, in this order.
/// Contacts and triggers come first, by pair; then impacts; then sleep and wake, by body.
/// Destroying or teleporting a body drops its contacts without an event. While neither body of a
/// pair is awake it has no events: trigger_stay and contact_persist go on once one of them wakes.
struct ContactEvent {
  EventKind kind{};
  BodyHandle a{};
  BodyHandle b{};
  Velocity approach_speed{};  ///< contact_begin, impact: speed along the normal before, ≥ 0
  std::uint32_t tag_a = 0;    ///< Surface::tag where they meet; of an end those of the bodies
  std::uint32_t tag_b = 0;
};

/// Two bodies came together faster than the hit speed of one of them (EventSettings), and pushed
/// each other: for sounds, sparks and damage. At most one for each contact and tick, by pair and
/// part; then those of bodies that were stopped on their way, as of `impact`. A contact that
/// persists hits again where another corner comes down. Contacts have at most twice as many hits in
/// a tick as the world has room for bodies; the last ones are left out.
///
/// The approach of a contact at rest is up to gravity's gain in a tick (0.16 m/s at 60 Hz): a hit
/// speed should be above it.
struct HitEvent {
  BodyHandle a{};
  BodyHandle b{};
  Vec3<Position> point{};    ///< m: mean of the contact's points, weighted by their impulses
  Vec3<Unit> normal{};       ///< from a to b, unit
  Impulse normal_impulse{};  ///< N·s = kg·m/s: the tick's, of all points, > 0
  Vec3<Impulse> friction_impulse{};  ///< N·s, on b, across the normal: the tick's
  Velocity approach_speed{};         ///< m/s, along the normal before: of the fastest point, > 0
  std::uint32_t part_a = 0;          ///< triangle, cell or child where they meet, as RayHit::part
  std::uint32_t part_b = 0;
  std::uint32_t tag_a = 0;  ///< Surface::tag where they meet
  std::uint32_t tag_b = 0;
  bool was_stopped = false;  ///< `a` was stopped on its way by `b`, as of `impact`

  friend bool operator==(const HitEvent&, const HitEvent&) = default;
};

}  // namespace lockstone
