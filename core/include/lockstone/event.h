// Events of a step. Arrays in canonical order, never callbacks.
#pragma once

#include <cstdint>
#include <string_view>

#include <lockstone/body.h>

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
};
[[nodiscard]] std::string_view to_string(EventKind kind);

/// A body that passes a trigger within a tick enters and exits in that tick, in this order.
/// Contacts and triggers come first, by pair; then impacts; then sleep and wake, by body.
/// Destroying or teleporting a body drops its contacts without an event. While neither body of a
/// pair is awake it has no events: trigger_stay goes on once one of them wakes.
struct ContactEvent {
  EventKind kind{};
  BodyHandle a{};
  BodyHandle b{};
  Velocity approach_speed{};  ///< contact_begin, impact: speed along the normal before, ≥ 0
  std::uint32_t tag_a = 0;    ///< Surface::tag where they meet; of an end those of the bodies
  std::uint32_t tag_b = 0;
};

}  // namespace lockstone
