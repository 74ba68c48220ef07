// The kernels of points.h for the target at hand.
#if defined(LKS_WIDE_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_POINTS_INL_H
#undef LKS_WIDE_POINTS_INL_H
#else
#define LKS_WIDE_POINTS_INL_H
#endif

#include "core/kernels/points/points.h"
#include "core/math/wide/lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

static_assert(k_point_step % k_lanes == 0);

/// This many coordinates, each in a word of its own.
HWY_INLINE HWY_ATTR Lanes load_operands(const std::int32_t* from) {
  return hn::PromoteTo(k_words, hn::LoadU(hn::Rebind<std::int32_t, Words>(), from));
}

HWY_INLINE HWY_ATTR Lanes products_at(const PointColumns& points, std::size_t i, Lanes x, Lanes y,
                                      Lanes z) {
  const Lanes sum =
      multiply_add(multiply(load_operands(points.x + i), x), load_operands(points.y + i), y);
  return multiply_add(sum, load_operands(points.z + i), z);
}

/// Of the best of each lane, the greatest: the first of equals. `starts`: the index of lane 0 when
/// that was found.
HWY_INLINE HWY_ATTR Farthest first_of_greatest(Lanes best, Lanes starts) {
#if HWY_ARCH_X86
  const Lanes most = hn::MaxOfLanes(k_words, best);
  const Lanes at = add(starts, hn::Iota(k_words, 0));
  const Lanes none = broadcast(INT64_MAX);
  const Lanes first = hn::MinOfLanes(k_words, hn::IfThenElse(hn::Eq(best, most), at, none));
  return {static_cast<std::size_t>(hn::GetLane(first)), hn::GetLane(most)};
#else
  std::int64_t products[k_lanes], indices[k_lanes];
  store(best, products);
  store(starts, indices);
  Farthest farthest{static_cast<std::size_t>(indices[0]), products[0]};
  for (std::size_t lane = 1; lane < k_lanes; ++lane) {
    const std::size_t index = static_cast<std::size_t>(indices[lane]) + lane;
    const bool first = products[lane] == farthest.product && index < farthest.index;
    if (products[lane] > farthest.product || first) farthest = {index, products[lane]};
  }
  return farthest;
#endif
}

HWY_ATTR Farthest farthest_point(const PointColumns& points, const Direction32& n) {
  const Lanes x = broadcast(n[0]), y = broadcast(n[1]), z = broadcast(n[2]);
  Lanes best = products_at(points, 0, x, y, z);
  Lanes best_at = broadcast(0);  // where the best of each lane began
  for (std::size_t i = k_lanes; i < points.count; i += k_lanes) {
    const Lanes reach = products_at(points, i, x, y, z);
    best_at = select_less(best, reach, broadcast(static_cast<std::int64_t>(i)), best_at);
    best = select_less(best, reach, reach, best);
  }
  return first_of_greatest(best, best_at);
}

HWY_ATTR Extent extent_along(const PointColumns& points, const Direction32& n) {
  const Lanes x = broadcast(n[0]), y = broadcast(n[1]), z = broadcast(n[2]);
  Lanes least = products_at(points, 0, x, y, z), greatest = least;
  for (std::size_t i = k_lanes; i < points.count; i += k_lanes) {
    const Lanes reach = products_at(points, i, x, y, z);
    least = select_less(reach, least, reach, least);
    greatest = select_less(greatest, reach, reach, greatest);
  }
  std::int64_t low[k_lanes], high[k_lanes];
  store(least, low);
  store(greatest, high);
  Extent extent{low[0], high[0]};
  for (std::size_t lane = 1; lane < k_lanes; ++lane)
    extent = {std::min(extent.least, low[lane]), std::max(extent.greatest, high[lane])};
  return extent;
}

HWY_ATTR Farthest heights_above(const PointColumns& normals, const std::int64_t* offsets,
                                const Direction32& p, std::int64_t* heights) {
  const Lanes x = broadcast(p[0]), y = broadcast(p[1]), z = broadcast(p[2]);
  Lanes best = subtract(products_at(normals, 0, x, y, z), load(offsets));
  Lanes best_at = broadcast(0);
  store(best, heights);
  for (std::size_t i = k_lanes; i < normals.count; i += k_lanes) {
    const Lanes height = subtract(products_at(normals, i, x, y, z), load(offsets + i));
    store(height, heights + i);
    best_at = select_less(best, height, broadcast(static_cast<std::int64_t>(i)), best_at);
    best = select_less(best, height, height, best);
  }
  return first_of_greatest(best, best_at);
}

HWY_ATTR void mark_at_least(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                            std::uint64_t* marks) {
#if HWY_ARCH_X86
  const Lanes least = broadcast(bound);
  constexpr unsigned k_all = (1U << k_lanes) - 1;
  for (std::size_t first = 0; first < count; first += 64) {
    std::uint64_t word = 0;
    for (std::size_t i = first; i < count && i < first + 64; i += k_lanes) {
      std::uint8_t below[8];
      (void)hn::StoreMaskBits(k_words, hn::Lt(load(heights + i), least), below);
      word |= std::uint64_t{~unsigned{below[0]} & k_all} << (i - first);
    }
    marks[first / 64] = word;
  }
#else
  mark_at_least_scalar(heights, count, bound, marks);
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
