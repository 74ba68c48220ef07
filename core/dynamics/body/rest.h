// When a body counts as resting.
//
// A body rests as long as no point of it is farther than a given distance from where it was when it
// began to rest. A body that goes farther begins again at its present pose. So a body that trembles
// about one place rests, however fast; one that creeps or swings does not, however slow it is at
// the moment; and a single rounding decides nothing.
//
// Nothing stops a ball that creeps, rolls or spins in a pocket of a pile. So a slow body that keeps
// others awake which rest is braked, as weakly as a slope that would not keep it from resting.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/dynamics/state/body_record.h"

namespace lockstone {

/// A world's conditions for rest.
struct RestRules {
  std::uint16_t ticks = 0;  ///< so long, then a body is ready to sleep; 0: never
  Length distance{};        ///< (0, 1 m]

  /// So long a body must rest that is still pushed out of another.
  [[nodiscard]] std::uint16_t long_ticks() const {
    return static_cast<std::uint16_t>(std::min(2 * ticks, 0xffff));
  }

  /// A body at rest that gains more than this in each tick does not stay at rest: 2·distance /
  /// ticks² a tick.
  [[nodiscard]] Velocity brake(std::uint32_t tick_rate) const;

  [[nodiscard]] static RestRules of(std::uint32_t tick_rate, std::uint32_t milliseconds,
                                    Length distance);
};

/// Whether the body can fall asleep by resting. Only such bodies are watched.
[[nodiscard]] inline bool is_watched(const BodyRecord& body, const RestRules& rules) {
  return rules.ticks != 0 && body.is_dynamic() && body.may_sleep() && !body.is_asleep();
}

/// Begins the rest again at the present pose. Clears the noted pose of a body that is not watched.
/// A pushed body begins when the tick ends its pushes.
void begin_rest(BodyRecord& body, const RestRules& rules);

/// Clears the velocities that forces gave a body in this tick, and begins its rest.
void end_pushes(BodyRecord& body, const RestRules& rules);

/// Counts a tick of a watched body. Returns whether it is ready to sleep.
bool count_rest(BodyRecord& body, const RestRules& rules);

/// Takes so much off the body's speed, turning included; does nothing above 1/4 m/s. Returns
/// whether it did.
bool slow_down(BodyRecord& body, const Mat3& rotation, Velocity brake);

}  // namespace lockstone
