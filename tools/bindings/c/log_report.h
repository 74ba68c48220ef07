// Verification of a log, for built-in games and for one's own.
#pragma once

#include <lockstone/replay/source.h>
#include <lockstone/simulation.h>

#include "tools/bindings/c/call.h"

namespace lockstone::c {

/// Writes the verdict; throws where `report.size` is wrong.
void verify(replay::Source& source, const SimulationFactory& make, lks_log_report& report);

}  // namespace lockstone::c
