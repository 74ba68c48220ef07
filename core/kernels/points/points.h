// Many points against one direction, and many planes against one point: with these, separating axes
// of polyhedra are found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::lanes {

/// The number of points is a multiple of this: this many words have the widest lanes.
inline constexpr std::size_t k_point_step = 8;

/// Points or directions by coordinates.
struct PointColumns {
  const std::int32_t* x = nullptr;
  const std::int32_t* y = nullptr;
  const std::int32_t* z = nullptr;
  std::size_t count = 0;  ///< a multiple of k_point_step
};

using Direction32 = std::array<std::int32_t, 3>;

struct Farthest {
  std::size_t index = 0;
  std::int64_t product = 0;

  friend constexpr bool operator==(const Farthest&, const Farthest&) = default;
};

/// The point p with the greatest p · n, the first of equals. There is at least one. Sums wrap.
[[nodiscard]] Farthest farthest_point(const PointColumns& points, const Direction32& n);

/// The least and the greatest of p · n.
struct Extent {
  std::int64_t least = 0;
  std::int64_t greatest = 0;

  friend constexpr bool operator==(const Extent&, const Extent&) = default;
};

/// Of all points; there is at least one. Sums wrap.
[[nodiscard]] Extent extent_along(const PointColumns& points, const Direction32& n);

/// heights[i] = n_i · p − offsets[i]; returns the greatest, the first of equals. Sums wrap.
Farthest heights_above(const PointColumns& normals, const std::int64_t* offsets,
                       const Direction32& p, std::int64_t* heights);

/// Sets bit i % 64 of marks[i / 64] where heights[i] ≥ bound and clears the others, in as many
/// words as it takes. The number of heights is a multiple of k_point_step.
void mark_at_least(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                   std::uint64_t* marks);

/// The same, one at a time.
[[nodiscard]] Farthest farthest_point_scalar(const PointColumns& points, const Direction32& n);
[[nodiscard]] Extent extent_along_scalar(const PointColumns& points, const Direction32& n);
Farthest heights_above_scalar(const PointColumns& normals, const std::int64_t* offsets,
                              const Direction32& p, std::int64_t* heights);
void mark_at_least_scalar(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                          std::uint64_t* marks);

}  // namespace lockstone::lanes
