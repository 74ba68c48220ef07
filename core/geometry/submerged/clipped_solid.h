// Volume, moment and section of a polyhedron below a plane, face by face.
//
// Each face, clipped at the plane, is a fan of triangles; with a point of the plane each gives a
// tetrahedron. The section itself gives none, so it never has to be found.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/submerged/submerged.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

/// A point or vector in units of the solid's scale, 28 fraction bits.
using ScaledPoint = std::array<std::int64_t, 3>;
inline constexpr int k_scaled_bits = 28;

class ClippedSolid {
 public:
  /// n · x ≤ offset, 30 fraction bits.
  ClippedSolid(const Vec3<Unit>& normal, std::int64_t offset);

  /// A face, counter-clockwise seen from outside.
  void add_face(std::span<const ScaledPoint> vertices);

  /// About the origin of the points.
  void finish(SubmergedPart& part) const;

 private:
  [[nodiscard]] std::int64_t height_of(const ScaledPoint& point) const;
  void add_corner(const ScaledPoint& point);

  Vec3<Unit> normal_;
  std::int64_t offset_;
  ScaledPoint apex_;  // a point of the plane, to which the sums are relative

  Int128 volume_{};                 // 6 times, 84 fraction bits
  std::array<Int128, 3> moment_{};  // 24 times, 76 fraction bits
  ScaledPoint section_{};           // twice its area, along its normal, 56 fraction bits

  int corners_ = 0;  // of the face at hand
  ScaledPoint first_{}, last_{};
};

[[nodiscard]] constexpr ScaledPoint cross(const ScaledPoint& a, const ScaledPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace lockstone::geometry
