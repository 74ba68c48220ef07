#include "core/dynamics/step/islands/pinched_islands.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {

PinchedIslands::PinchedIslands(std::size_t contact_capacity) {
  pressing_.reserve(contact_capacity);
}

void PinchedIslands::add_pressing(const ImmovablePush& push) {
  LKS_ASSERT(push.island != 0 && is_reserved(pressing_, pressing_.size() + 1));
  pressing_.push_back(push);
}

void PinchedIslands::sort() {
  std::ranges::sort(pressing_, {}, &ImmovablePush::key);
  pressing_.erase(std::unique(pressing_.begin(), pressing_.end()), pressing_.end());
}

bool PinchedIslands::is_pinched(const ImmovablePush& push) const {
  constexpr std::int64_t k_against = -(std::int64_t{1} << 57);  // cosine of −1/8, Q60
  LKS_ASSERT(std::ranges::is_sorted(pressing_, {}, &ImmovablePush::key));
  auto pressing = std::ranges::lower_bound(pressing_, push.island, {}, &ImmovablePush::island);
  for (; pressing != pressing_.end() && pressing->island == push.island; ++pressing)
    if (pressing->body != push.body && dot(push.normal, pressing->normal).raw < k_against)
      return true;
  return false;
}

}  // namespace lockstone
