// Two polytopes, each seen from the frame of the other, and the faces that separate them.
#pragma once

#include <array>

#include "core/geometry/convex/polytope.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// A fine vector in two parts, so that its product with a unit vector stays within 64 bits.
struct SplitVec {
  RawVec coarse;     ///< 20 fraction bits
  RawVec remainder;  ///< fine, components within ±2^29
};

[[nodiscard]] SplitVec split(const RawVec& v);

/// Rounded once. |v| < 2^13 m.
[[nodiscard]] constexpr Fine dot(const SplitVec& v, const Vec3<Unit>& n) {
  const Fine coarse = v.coarse.x * n.x.raw + v.coarse.y * n.y.raw + v.coarse.z * n.z.raw;
  const Fine remainder =
      v.remainder.x * n.x.raw + v.remainder.y * n.y.raw + v.remainder.z * n.z.raw;
  return coarse + raw::round_shift(remainder, k_fine_per_length);
}

/// Own axes to others, exact: |v| < 2^13 m.
[[nodiscard]] constexpr RawVec turned(const Mat3& m, const Vec3<Length>& v) {
  const std::int64_t x = v.x.raw, y = v.y.raw, z = v.z.raw;
  return {m.x.x.raw * x + m.y.x.raw * y + m.z.x.raw * z,
          m.x.y.raw * x + m.y.y.raw * y + m.z.y.raw * z,
          m.x.z.raw * x + m.y.z.raw * y + m.z.z.raw * z};
}

/// One polytope and, in its frame, the other.
struct PolytopeView {
  const Polytope& own;
  const Polytope& other;
  const Mat3& rotation;  ///< own frame to world
  Mat3 axes{};           ///< of the other, in the own frame
  SplitVec origin{};     ///< of the other, in the own frame

  [[nodiscard]] Vec3<Unit> to_other(const Vec3<Unit>& v) const { return rotate_inverse(axes, v); }
  /// A vertex of the other, fine.
  [[nodiscard]] RawVec to_own(const Vec3<Length>& v) const;
  /// Likewise with 20 fraction bits: each lane errs by at most 1.
  [[nodiscard]] RawVec to_own_coarse(const Vec3<Length>& v) const;
};

struct PolytopePair {
  const Mat3& rotation_a;
  const Mat3& rotation_b;
  const Vec3<Length>& offset;
  Length margin;
  PolytopeView from_a;
  PolytopeView from_b;
};

[[nodiscard]] PolytopePair make_polytope_pair(const Polytope& a, const Mat3& rotation_a,
                                              const Polytope& b, const Mat3& rotation_b,
                                              const Vec3<Length>& offset, Length margin);

/// Separation along a unit axis of A's frame, from A to B.
[[nodiscard]] Fine separation_on(const PolytopePair& pair, const Vec3<Unit>& normal_in_a);

/// The face whose plane separates most.
struct FaceSupport {
  int face = -1;    ///< none when no face was allowed
  int support = 0;  ///< vertex of the other that is deepest below it
  Fine separation = 0;
};

/// Points of the other polytope in the own frame, 20 fraction bits: the separation of a plane is at
/// most the height of any of them. The first stands in for those that are missing.
struct Witness {
  std::array<RawVec, 4> points{};
  int count = 0;
  int next = 0;

  void add(const RawVec& point);
};

/// The error bound of the heights of witnesses: 3.8 µm.
inline constexpr Fine k_witness_slack = Fine{1} << (k_fine_bits - 18);

/// Only faces with n · direction ≤ limit are allowed.
struct Facing {
  Vec3<Unit> direction{};
  Fine limit = 0;  ///< 60 fraction bits

  [[nodiscard]] bool allows(const Vec3<Unit>& n) const {
    return lockstone::dot(n, direction).raw <= limit;
  }
};

/// The best of the own faces, the first of equals; any above `enough` will do. Exact, and yet few
/// faces are looked at closely: a plane above any witness cannot be better than that.
[[nodiscard]] FaceSupport best_face(const PolytopeView& view, const Facing& facing, Fine enough,
                                    Witness& witness);

/// A normal whose product with the front is below this (−2^-10, in 60 bits) points to the back of a
/// one-sided polytope.
inline constexpr Fine k_backward = -(Fine{1} << 50);

}  // namespace lockstone::geometry
