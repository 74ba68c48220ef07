// Two boxes with their relative rotation, centres and separating axes.
#pragma once

#include <array>

#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

struct BoxPair {
  const PosedShape& a;
  const PosedShape& b;
  const Vec3<Length>& offset;
  Length margin;
  RawVec half_a;
  RawVec half_b;
  RawVec centre_in_a;                  ///< of B, in A's axes
  RawVec centre_in_b;                  ///< of B seen from A, in B's axes
  std::array<Vec3<Unit>, 3> b_in_a{};  ///< B's axes in A's axes: [j][i] = a_i · b_j
};

[[nodiscard]] BoxPair make_box_pair(const PosedShape& a, const PosedShape& b,
                                    const Vec3<Length>& offset, Length margin);

/// A face normal that separates most, of one box.
struct FaceAxis {
  int axis = 0;
  int sign = 1;  ///< the normal ±axis points from A to B
  Fine separation = 0;
};

/// The best of A's faces; the first of equals.
[[nodiscard]] FaceAxis best_face_of_a(const BoxPair& pair);
[[nodiscard]] FaceAxis best_face_of_b(const BoxPair& pair);

/// The cross product of two edges that separates most.
struct EdgeAxis {
  bool found = false;
  int axis_a = 0;
  int axis_b = 0;
  Vec3<Unit> normal;  ///< world axes, from A to B
  Fine separation = 0;
};

/// The cross product of two edges, by the axes of A and B that they lie along.
[[nodiscard]] EdgeAxis edge_axis(const BoxPair& pair, int axis_a, int axis_b);

/// The best edge axis with a separation above `threshold`, if there is one; the first of equals.
[[nodiscard]] EdgeAxis best_edge(const BoxPair& pair, Fine threshold);

}  // namespace lockstone::geometry
