// A triangle's plane and sides, to measure points against.
#pragma once

#include "core/geometry/mesh_contact/triangle_polytope.h"
#include "core/geometry/numeric/q50.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

/// All in the triangle's frame. Triangle and normal must outlive it.
class FacePlane {
 public:
  FacePlane(const TriangleVertices& triangle, const Vec3<Unit>& normal)
      : triangle_(triangle), normal_(normal) {}

  /// Error < 2^-48 m, plus the effect of the norm's error.
  [[nodiscard]] Fine height(const RawVec& point) const {
    return dot(point - fine(triangle_[0]), normal_);
  }

  /// Whether the face lies straight below or above the point; up to 18 µm outside counts, so that
  /// no point falls between two triangles.
  [[nodiscard]] bool has_beside(const RawVec& point) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (is_outside(point, triangle_[i], triangle_[(i + 1) % 3] - triangle_[i])) return false;
    return true;
  }

 private:
  /// Beyond the side by 18 µm at least; from 31 µm surely.
  [[nodiscard]] bool is_outside(const RawVec& point, const Vec3<Length>& start,
                                const Vec3<Length>& side) const {
    constexpr int beside_bits = k_fine_bits - 15 + Unit::frac_bits;  // 31 µm, times a normal
    const auto outward = cross(side, normal_);
    const RawVec way = point - fine(start);
    const Int128 beyond = multiply_wide(outward.x.raw, way.x) +
                          multiply_wide(outward.y.raw, way.y) + multiply_wide(outward.z.raw, way.z);
    const Length longest = max(max(abs(side.x), abs(side.y)), abs(side.z));
    return beyond > Int128::from(longest.raw) << beside_bits;
  }

  const TriangleVertices& triangle_;
  const Vec3<Unit>& normal_;
};

}  // namespace lockstone::geometry
