// Makes a failing schedule of faults short.
#pragma once

#include <functional>

#include "tools/simnet/schedule.h"

namespace lockstone::simnet {

/// A subset of `schedule` for which `fails` is true, too, and no event of which can be left out.
/// `fails(schedule)` is true. Delta debugging (Andreas Zeller, Ralf Hildebrandt, "Simplifying and
/// Isolating Failure-Inducing Input", 2002).
[[nodiscard]] Schedule shrink(Schedule schedule, const std::function<bool(const Schedule&)>& fails);

}  // namespace lockstone::simnet
