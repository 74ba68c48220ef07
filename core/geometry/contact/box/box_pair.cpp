// The separating axes of two boxes (Gottschalk, Lin, Manocha, OBBTree, section 5), in integers.
#include "core/geometry/contact/box/box_pair.h"

#include <bit>

#include <lockstone/assert.h>

#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// The half width of a box with these half extents across a direction given in its axes. Exact.
Fine reach(const Vec3<Length>& half, const Vec3<Unit>& direction) {
  return (half.x * abs(direction.x) + half.y * abs(direction.y) + half.z * abs(direction.z)).raw;
}

Vec3<Unit> row(const BoxPair& pair, int i) {
  return {pair.b_in_a[0][i], pair.b_in_a[1][i], pair.b_in_a[2][i]};
}

using Lanes = std::array<std::int64_t, 3>;

// The axes after another one, around.
constexpr std::array<std::size_t, 3> k_next = {1, 2, 0};
constexpr std::array<std::size_t, 3> k_after_next = {2, 0, 1};

/// Bounds of the nine edge axes.
struct EdgeBounds {
  Lanes centre;                  ///< of B in A's axes, with 20 fraction bits
  Lanes half_a;                  ///< 20 fraction bits
  Lanes half_b;                  ///< 20 fraction bits
  std::array<Lanes, 3> b;        ///< B's axes in A's axes
  std::array<Lanes, 3> b_sizes;  ///< their magnitudes
  std::array<Fine, 9> rough;     ///< by 3i + j: see `rough_separation`

  explicit EdgeBounds(const BoxPair& pair)
      : centre{raw::round_shift(pair.centre_in_a.x, k_fine_per_length),
               raw::round_shift(pair.centre_in_a.y, k_fine_per_length),
               raw::round_shift(pair.centre_in_a.z, k_fine_per_length)},
        half_a{pair.a.shape.size.x.raw, pair.a.shape.size.y.raw, pair.a.shape.size.z.raw},
        half_b{pair.b.shape.size.x.raw, pair.b.shape.size.y.raw, pair.b.shape.size.z.raw} {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3<Unit>& axis = pair.b_in_a[j];
      b[j] = {axis.x.raw, axis.y.raw, axis.z.raw};
      b_sizes[j] = {magnitude_of(b[j][0]), magnitude_of(b[j][1]), magnitude_of(b[j][2])};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        rough[3 * i + j] = rough_separation(i, j);
    }
  }

  /// The separation on a_i × b_j times the length of that product, up to rounding below 2^-18 m.
  [[nodiscard]] Fine rough_separation(std::size_t i, std::size_t j) const {
    const std::size_t i1 = k_next[i], i2 = k_after_next[i];
    const std::size_t j1 = k_next[j], j2 = k_after_next[j];
    const Fine apart = magnitude_of(centre[i2] * b[j][i1] - centre[i1] * b[j][i2]);
    const Fine reach_a = half_a[i1] * b_sizes[j][i2] + half_a[i2] * b_sizes[j][i1];
    const Fine reach_b = half_b[j1] * b_sizes[j2][i] + half_b[j2] * b_sizes[j1][i];
    return apart - reach_a - reach_b;
  }

  /// The axes whose separation may be above the threshold, a bit each.
  [[nodiscard]] unsigned may_exceed(Fine threshold) const {
    // Dividing by a length ≤ 1 moves a negative value down: below the threshold it stays there.
    constexpr Fine wide_slack = Fine{1} << (k_fine_bits - 18);
    const Fine clear = std::min(-wide_slack - 1, threshold - wide_slack);
    unsigned open = 0;
    for (std::size_t k = 0; k < 9; ++k)
      open |= (rough[k] > clear ? 1U : 0U) << k;
    return open == 0 ? 0 : open & ~short_of(threshold, open);
  }

 private:
  /// Which of the axes are nearly parallel edges' that are still certainly not above the threshold.
  [[nodiscard]] unsigned short_of(Fine threshold, unsigned open) const {
    LKS_ASSERT(open >> 9 == 0);
    const Fine below = std::min(threshold, Fine{0});
    const Fine allowance = slack();
    unsigned result = 0;
    for (unsigned left = open; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      // Of nearly parallel edges the product's length is next to nothing, and so is `rough`: the
      // threshold times the length must be compared with it, or times more than the length where
      // the threshold is negative.
      const std::size_t i = k / 3, j = k % 3;
      const std::int64_t width = b_sizes[j][k_next[i]] + b_sizes[j][k_after_next[i]];
      const Fine limit = scaled(below, static_cast<std::int32_t>(width));
      result |= (rough[k] + allowance + width < limit ? 1U : 0U) << k;
    }
    return result;
  }

  /// The rotations are orthonormal within 2^-26, the entries of b and the unit normal round by
  /// 2^-30; all these count times a size or the distance of the centres, together below 2^-23 of
  /// their sum. The centre rounds by 2^-21 m, which counts times a component of b: less than 2^-20
  /// m times the width.
  [[nodiscard]] Fine slack() const {
    std::int64_t sizes = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sizes += magnitude_of(centre[k]) + half_a[k] + half_b[k];
    return sizes * (Fine{1} << (k_fine_per_length - 23));
  }
};

Vec3<Unit> along_columns(const Mat3& m, const Vec3<Unit>& v) {
  return rotate_inverse(m, v);
}

/// The separation on a unit world axis, exact for that axis up to the rounding of its coordinates.
Fine separation_on(const BoxPair& pair, const Vec3<Unit>& normal) {
  const Fine apart = magnitude_of(lockstone::dot(normal, pair.offset).raw);
  return apart - reach(pair.a.shape.size, along_columns(pair.a.rotation, normal)) -
         reach(pair.b.shape.size, along_columns(pair.b.rotation, normal));
}

}  // namespace

BoxPair make_box_pair(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                      Length margin) {
  LKS_ASSERT(a.shape.kind == ShapeKind::box && b.shape.kind == ShapeKind::box);
  BoxPair pair{a,
               b,
               offset,
               margin,
               half_extents(a.shape),
               half_extents(b.shape),
               to_local(a.rotation, offset),
               to_local(b.rotation, offset)};
  for (int j = 0; j < 3; ++j) {
    pair.b_in_a[static_cast<std::size_t>(j)] = to_local(a.rotation, b.rotation.column(j));
  }
  return pair;
}

FaceAxis best_face_of_a(const BoxPair& pair) {
  FaceAxis best;
  for (int i = 0; i < 3; ++i) {
    const Fine centre = pair.centre_in_a[i];
    const Fine separation =
        magnitude_of(centre) - pair.half_a[i] - reach(pair.b.shape.size, row(pair, i));
    if (i == 0 || separation > best.separation) best = {i, sign_of(centre), separation};
  }
  return best;
}

FaceAxis best_face_of_b(const BoxPair& pair) {
  FaceAxis best;
  for (int j = 0; j < 3; ++j) {
    const Fine centre = pair.centre_in_b[j];
    const Fine separation = magnitude_of(centre) - pair.half_b[j] -
                            reach(pair.a.shape.size, pair.b_in_a[static_cast<std::size_t>(j)]);
    if (j == 0 || separation > best.separation) best = {j, sign_of(centre), separation};
  }
  return best;
}

EdgeAxis edge_axis(const BoxPair& pair, int axis_a, int axis_b) {
  const RawVec k = cross_of(pair.a.rotation.column(axis_a), pair.b.rotation.column(axis_b));
  EdgeAxis result;
  if (k == RawVec{}) return result;
  const Vec3<Unit> normal = direction_of(k.x, k.y, k.z);
  const Fine apart = lockstone::dot(normal, pair.offset).raw;
  return {true, axis_a, axis_b, signed_axis(normal, sign_of(apart)), separation_on(pair, normal)};
}

EdgeAxis best_edge(const BoxPair& pair, Fine threshold) {
  const EdgeBounds bounds(pair);
  EdgeAxis best;
  for (unsigned left = bounds.may_exceed(threshold); left != 0; left &= left - 1) {
    const int k = std::countr_zero(left);
    const EdgeAxis candidate = edge_axis(pair, k / 3, k % 3);
    if (!candidate.found || candidate.separation <= threshold) continue;
    best = candidate;
    threshold = candidate.separation;
    left &= bounds.may_exceed(threshold) | 1U << k;
  }
  LKS_ASSERT(!best.found || (best.separation == threshold && is_unit(best.normal)));
  return best;
}

}  // namespace lockstone::geometry
