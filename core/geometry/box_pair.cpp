// The separating axes of two boxes (Gottschalk, Lin, Manocha, OBBTree, section 5), in integers.
#include "core/geometry/box_pair.h"

#include "core/geometry/segment.h"
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

/// An upper bound, up to rounding below 2^-18 m, of the separation on a_i × b_j times the length of
/// that product. The centre enters with 20 fraction bits.
Fine rough_edge_separation(const BoxPair& pair, const RawVec& centre, int i, int j) {
  const int i1 = (i + 1) % 3;
  const int i2 = (i + 2) % 3;
  const Vec3<Unit>& b = pair.b_in_a[static_cast<std::size_t>(j)];
  const Vec3<Unit>& b1 = pair.b_in_a[static_cast<std::size_t>((j + 1) % 3)];
  const Vec3<Unit>& b2 = pair.b_in_a[static_cast<std::size_t>((j + 2) % 3)];
  const Vec3<Length>& half_a = pair.a.shape.size;
  const Vec3<Length>& half_b = pair.b.shape.size;
  const Fine apart = magnitude_of(centre[i2] * b[i1].raw - centre[i1] * b[i2].raw);
  const Fine reach_a = (half_a[i1] * abs(b[i2]) + half_a[i2] * abs(b[i1])).raw;
  const Fine reach_b = (half_b[(j + 1) % 3] * abs(b2[i]) + half_b[(j + 2) % 3] * abs(b1[i])).raw;
  return apart - reach_a - reach_b;
}

Vec3<Unit> along_columns(const Mat3& m, const Vec3<Unit>& v) {
  return rotate_inverse(m, v);
}

/// The separation on a unit world axis, exact for that axis up to the rounding of its coordinates.
Fine separation_on(const BoxPair& pair, const Vec3<Unit>& normal) {
  const Fine apart = magnitude_of(lockstone::dot(normal, pair.offset).raw);
  return apart - reach(pair.a.shape.size, along_columns(pair.a.rotation, normal)) -
         reach(pair.b.shape.size, along_columns(pair.b.rotation, normal));
}

EdgeAxis edge_axis(const BoxPair& pair, int i, int j) {
  const RawVec k = cross_of(pair.a.rotation.column(i), pair.b.rotation.column(j));
  EdgeAxis result;
  if (k == RawVec{}) return result;
  const Vec3<Unit> normal = direction_of(k.x, k.y, k.z);
  const Fine apart = lockstone::dot(normal, pair.offset).raw;
  return {true, i, j, signed_axis(normal, sign_of(apart)), separation_on(pair, normal)};
}

}  // namespace

BoxPair make_box_pair(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                      Length margin) {
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

EdgeAxis best_edge(const BoxPair& pair, Fine threshold) {
  constexpr Fine slack = Fine{1} << (k_fine_bits - 18);
  const RawVec centre{raw::round_shift(pair.centre_in_a.x, k_fine_per_length),
                      raw::round_shift(pair.centre_in_a.y, k_fine_per_length),
                      raw::round_shift(pair.centre_in_a.z, k_fine_per_length)};
  EdgeAxis best;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // Dividing by a length ≤ 1 moves a negative value down: below the threshold it stays there.
      const Fine rough = rough_edge_separation(pair, centre, i, j);
      if (rough < -slack && rough + slack <= threshold) continue;
      const EdgeAxis candidate = edge_axis(pair, i, j);
      if (!candidate.found || candidate.separation <= threshold) continue;
      best = candidate;
      threshold = candidate.separation;
    }
  }
  return best;
}

}  // namespace lockstone::geometry
