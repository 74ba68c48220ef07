// The output of `lockstone bench speed`.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/speed/speed_run.h"

namespace lockstone::tool {

struct SpeedReport {
  std::vector<bench::SpeedResult> results;
  bool detail = false;
  std::string clock_name;
  double clock_nanoseconds = 0;  ///< the time that a call of the clock adds to an interval
};

void print_speed_tables(const SpeedReport& report);
void print_speed_json(const SpeedReport& report);

/// One line a tick: times, stages and counters.
[[nodiscard]] std::string speed_csv(const SpeedReport& report);

}  // namespace lockstone::tool
