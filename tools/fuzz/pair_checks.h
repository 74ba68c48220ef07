// Checks that must hold of every pair of shapes.
#pragma once

#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/distance/manifold.h"
#include "tools/fuzz/pair_source.h"
#include "tools/fuzz/verdict.h"

namespace lockstone::fuzz {

inline constexpr double k_micrometre = 1e-6;

/// The kernels' results for a pair, once, for all checks.
struct Answers {
  ClosestPoints closest;
  Penetration deep;
  Manifold manifold;

  explicit Answers(const Pair& pair);
  /// Distance, or depth below zero.
  [[nodiscard]] double signed_distance() const;
  /// The least separation of the manifold's points.
  [[nodiscard]] double least() const;
};

/// How far rims, polygons of 2^15 vertices about axes of 30 bits, may be off their circles.
[[nodiscard]] double rim_slack(const Pair& pair);

/// 2 µm and 13e-9 of the sizes, which are seven steps of the lattice: the error bound of depths.
/// Distances err by at most 2 µm.
[[nodiscard]] double tolerance(const Pair& pair);

/// 16 times how far vertices lie below their merged faces: the difference between solids by faces
/// and by vertices, beside edges too.
[[nodiscard]] double uneven_slack(const Pair& pair);

/// How far collide may differ from the distance: 2^-16 m where faces are preferred, 3.4 µm where
/// the points of a disc stand still, 1/2000 of a capsule's core distance, and how uneven merged
/// faces are.
[[nodiscard]] double choice_slack(const Pair& pair, double distance);

/// How far the other's centre is before the front of a one-sided shape; 1e30 without such.
[[nodiscard]] double height_before_front(const Pair& pair);

/// Whether a unit direction from A to B leans back from the front of a one-sided shape.
[[nodiscard]] bool leans_back(const Pair& pair, const Real3& direction);

void check_flip(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_distance(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_depth(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_turned(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_collide(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_manifold(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_anchors(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_separated(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_overlaps(const Pair& pair, const Answers& answers, Verdict& verdict);
void check_cast(const Pair& pair, Verdict& verdict);
void check_ray(const Pair& pair, Verdict& verdict);

/// All of them.
void check_pair(const Pair& pair, Verdict& verdict);

}  // namespace lockstone::fuzz
