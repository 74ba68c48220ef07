#include "tools/simnet/shrink.h"

#include <algorithm>

namespace lockstone::simnet {
namespace {

Schedule without(const Schedule& schedule, std::size_t begin, std::size_t end) {
  Schedule rest(schedule.begin(), schedule.begin() + static_cast<std::ptrdiff_t>(begin));
  rest.insert(rest.end(), schedule.begin() + static_cast<std::ptrdiff_t>(end), schedule.end());
  return rest;
}

}  // namespace

Schedule shrink(Schedule schedule, const std::function<bool(const Schedule&)>& fails) {
  std::size_t pieces = 2;
  while (!schedule.empty()) {
    pieces = std::min(pieces, schedule.size());
    bool shorter = false;
    for (std::size_t i = 0; i < pieces && !shorter; ++i) {
      const Schedule rest =
          without(schedule, i * schedule.size() / pieces, (i + 1) * schedule.size() / pieces);
      if (!fails(rest)) continue;
      schedule = rest;
      shorter = true;
    }
    if (shorter) {
      pieces = std::max<std::size_t>(2, pieces - 1);
    } else if (pieces == schedule.size()) {
      break;
    } else {
      pieces *= 2;
    }
  }
  return schedule;
}

}  // namespace lockstone::simnet
