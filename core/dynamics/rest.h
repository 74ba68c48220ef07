// When a body counts as resting.
//
// A body rests as long as no point of it is farther than a given distance from where it was when it
// began to rest. What goes farther begins anew where it is. So what trembles about one place rests,
// however fast; what creeps or swings does not, however slow it is at the moment; and a rounding
// here or there decides nothing.
#pragma once

#include <cstdint>

#include "core/dynamics/body_record.h"

namespace lockstone {

/// What a world calls rest.
struct RestRules {
  std::uint32_t ticks = 0;  ///< so long, then a body is ready to sleep; 0: never
  Length distance{};        ///< (0, 1 m]

  /// So long a body must rest that is still pushed out of another.
  [[nodiscard]] std::uint32_t long_ticks() const { return 8 * ticks; }

  [[nodiscard]] static RestRules of(std::uint32_t tick_rate, std::uint32_t milliseconds,
                                    Length distance);
};

/// Only what can fall asleep by resting is watched.
[[nodiscard]] inline bool is_watched(const BodyRecord& body, const RestRules& rules) {
  return rules.ticks != 0 && body.is_dynamic() && body.may_sleep() && !body.is_asleep();
}

/// Begins anew, here; of a body that is not watched, clears what was noted. One that is pushed
/// begins when the tick ends its pushes.
void begin_rest(BodyRecord& body, const RestRules& rules);

/// Forgets what forces gave a body, and begins its rest.
void end_pushes(BodyRecord& body, const RestRules& rules);

/// Counts a tick of a watched body. Answers whether it is ready to sleep.
bool count_rest(BodyRecord& body, const RestRules& rules);

}  // namespace lockstone
