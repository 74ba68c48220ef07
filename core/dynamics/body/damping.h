// The exact decay of a velocity under linear damping, v' = a − c·v, over one tick.
#pragma once

#include <cstdint>

#include <lockstone/units.h>

#include "core/dynamics/state/time_step.h"

namespace lockstone {

/// With z = c·dt: v ← keep·v + ease·a·dt, x ← x + (ease·v + mean·a·dt)·dt. Q30, within 2^-29 of
/// keep = e^-z, ease = (1 − keep)/z, mean = (1 − ease)/z; 1, 1 and ½ without damping.
struct Damping {
  std::int32_t keep = 1 << 30;
  std::int32_t ease = 1 << 30;
  std::int32_t mean = 1 << 29;

  [[nodiscard]] static Damping of(Rate rate, const TimeStep& step);
};

}  // namespace lockstone
