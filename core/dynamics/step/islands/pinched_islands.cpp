#include "core/dynamics/step/islands/pinched_islands.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {

PinchedIslands::PinchedIslands(std::size_t contact_capacity) {
  moving_.reserve(contact_capacity);
}

void PinchedIslands::add_moving(const ImmovablePush& push) {
  LKS_ASSERT(push.island != 0 && is_reserved(moving_, moving_.size() + 1));
  moving_.push_back(push);
}

void PinchedIslands::sort() {
  std::ranges::sort(moving_, {}, &ImmovablePush::key);
  moving_.erase(std::unique(moving_.begin(), moving_.end()), moving_.end());
}

bool PinchedIslands::is_pinched(const ImmovablePush& push) const {
  constexpr std::int64_t k_against = -(std::int64_t{1} << 57);  // cosine of −1/8, Q60
  LKS_ASSERT(std::ranges::is_sorted(moving_, {}, &ImmovablePush::key));
  auto moving = std::ranges::lower_bound(moving_, push.island, {}, &ImmovablePush::island);
  for (; moving != moving_.end() && moving->island == push.island; ++moving)
    if (moving->body != push.body && dot(push.normal, moving->normal).raw < k_against) return true;
  return false;
}

}  // namespace lockstone
