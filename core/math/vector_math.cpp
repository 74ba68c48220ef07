#include <algorithm>
#include <limits>

#include <lockstone/vector_math.h>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::vector_detail {
namespace {

// Of any 64-bit numbers; sums of unshifted products could leave 128 bits.
std::int64_t product(std::int64_t a, std::int64_t b, int shift) {
  return saturated_product(a, b, shift);
}

}  // namespace

std::int64_t length(const Words& v) {
  const std::uint64_t size = norm(v.x.raw, v.y.raw, v.z.raw);
  return static_cast<std::int64_t>(std::min(size, std::uint64_t{0x7fffffffffffffff}));
}

Vec3<Unit> direction(const Words& v) {
  return direction_of(v.x.raw, v.y.raw, v.z.raw);
}

std::int64_t dot(const Words& a, const Words& b, int shift) {
  const std::int64_t xy =
      raw::saturating_add(product(a.x.raw, b.x.raw, shift), product(a.y.raw, b.y.raw, shift));
  return raw::saturating_add(xy, product(a.z.raw, b.z.raw, shift));
}

std::int64_t minor_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d, int shift) {
  const std::int64_t second =
      std::max(product(c, d, shift), -std::numeric_limits<std::int64_t>::max());
  return raw::saturating_add(product(a, b, shift), -second);
}

}  // namespace lockstone::vector_detail
