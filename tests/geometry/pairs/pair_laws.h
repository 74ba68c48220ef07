// Laws of pairs of convex shapes that are checked along directions: distance, depth, contacts and
// casts against reaches in long double.
#pragma once

#include <string>

#include "core/geometry/dispatch/raycast.h"
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "tests/geometry/pairs/real_shapes.h"
#include "tests/support/workload.h"

namespace lockstone::test {

struct ReachPair {
  Shape a, b;
  Mat3 rotation_a, rotation_b;
  Vec3<Length> offset;

  [[nodiscard]] PosedShape posed_a() const { return {a, rotation_a}; }
  [[nodiscard]] PosedShape posed_b() const { return {b, rotation_b}; }
  [[nodiscard]] Real separation(const RealVec& n) const {
    return dot(real(offset), n) - reach_of(posed_a(), n) - reach_of(posed_b(), n * -1);
  }
  /// Sets the offset to `least` to `most` of where they touch along the direction.
  void place(Dice& dice, const RealVec& n, double least, double most) {
    const Real touching = reach_of(posed_a(), n) + reach_of(posed_b(), n * -1);
    offset = metres(n * (touching * static_cast<Real>(dice.uniform(least, most))));
  }
  [[nodiscard]] std::string text() const {
    return describe(a) + " R " + describe(rotation_a) + "\n" + describe(b) + " R " +
           describe(rotation_b) + "\n" + std::to_string(offset.x.raw) + "," +
           std::to_string(offset.y.raw) + "," + std::to_string(offset.z.raw) + " radii " +
           std::to_string(a.fourth_size().raw) + "," + std::to_string(b.fourth_size().raw);
  }
};

/// At `least` to `most` of where they touch along a direction.
using RandomPair = ReachPair (*)(Dice& dice, double least, double most);

/// Points on both surfaces are no nearer than the distance, planes separate by no more.
inline void expect_distances_along_normals(RandomPair random_pair, int pairs, double slack) {
  Dice dice;
  for (int i = 0; i < pairs; ++i) {
    const ReachPair pair = random_pair(dice, 0.9, 1.6);
    const ClosestPoints found = distance(pair.posed_a(), pair.posed_b(), pair.offset);
    const ClosestPoints back = distance(pair.posed_b(), pair.posed_a(), -pair.offset);
    ASSERT_EQ(found.distance, back.distance);
    ASSERT_EQ(found.normal, -back.normal);
    ASSERT_EQ(found.point_a, back.point_b);
    if (found.overlapping) continue;
    const double apart = as_double(found.distance);
    ASSERT_NEAR(static_cast<double>(pair.separation(real(found.normal))), apart, slack)
        << pair.text();
    const RealVec between = real(found.point_b) + real(pair.offset) - real(found.point_a);
    ASSERT_NEAR(static_cast<double>(norm(between)), apart, 4e-6) << pair.text();
  }
}

/// No direction separates by more than the one found. At least `deep` pairs overlap by more than
/// their radii.
inline void expect_depths_along_normals(RandomPair random_pair, int pairs, int deep) {
  Dice dice;
  for (int i = 0; i < pairs; ++i) {
    const ReachPair pair = random_pair(dice, 0.0, 1.0);
    const Penetration found = penetration(pair.posed_a(), pair.posed_b(), pair.offset);
    if (!found.overlapping) continue;
    if (distance(pair.posed_a(), pair.posed_b(), pair.offset).cores_overlap) --deep;
    const RealVec normal = real(found.normal);
    const Real along = pair.separation(normal);
    ASSERT_NEAR(static_cast<double>(along), -as_double(found.depth), 5e-6) << pair.text();
    for (int k = 0; k < 60; ++k) {
      // Half of them near the direction found.
      RealVec n = dice.direction();
      if (k % 2 == 0) n = normal + n * 0.05L;
      const Real other = pair.separation(n * (1 / norm(n)));
      ASSERT_LE(other, along + 5 * k_micrometre) << pair.text();
    }
  }
  EXPECT_LT(deep, 0);
}

/// The deepest point is as deep as the shapes along the normal, and no axis separates by much more.
inline void expect_contacts_at_least_separation(RandomPair random_pair, int pairs) {
  Dice dice;
  int contacts = 0;
  for (int i = 0; i < pairs; ++i) {
    const ReachPair pair = random_pair(dice, 0.8, 1.05);
    const Manifold m = collide(pair.posed_a(), pair.posed_b(), pair.offset, metres(0.01));
    const Manifold back = collide(pair.posed_b(), pair.posed_a(), -pair.offset, metres(0.01));
    ASSERT_EQ(m.count, back.count);
    if (m.count == 0) continue;
    ++contacts;
    ASSERT_EQ(m.normal, -back.normal);
    ASSERT_EQ(features_of(m).size(), static_cast<std::size_t>(m.count));
    ASSERT_NEAR(static_cast<double>(deepest(m)),
                static_cast<double>(pair.separation(real(m.normal))), 3e-5)
        << pair.text();
    const Penetration depth = penetration(pair.posed_a(), pair.posed_b(), pair.offset);
    if (depth.overlapping) {
      ASSERT_GE(deepest(m), -real(depth.depth) * 1.12L - 0.0006L) << pair.text();
    }
  }
  EXPECT_GT(contacts, pairs / 4);
}

inline void expect_casts_end_where_shapes_touch(RandomPair random_pair) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const ReachPair pair = random_pair(dice, 1.5, 3);
    const Vec3<Length> way = metres(real(pair.offset) * -1 + dice.direction() * 0.3L);
    const ShapeCastHit hit =
        cast_shape(pair.posed_a(), pair.posed_b(), pair.offset, way, Unit::max());
    if (!hit.hit || hit.overlapping) continue;
    ++hits;
    ReachPair there = pair;
    there.offset = metres(real(pair.offset) + real(way) * real(hit.fraction));
    ASSERT_NEAR(static_cast<double>(there.separation(real(hit.normal))), 0, 6e-6) << pair.text();
  }
  EXPECT_GT(hits, test::share_of(500));
}

using RandomShape = Shape (*)(Dice& dice, double low, double high);

/// Rays end on the surface, before it they are outside, and the shape lies below the plane at the
/// normal. `Truth` is the shape in long double.
template <class Truth>
void expect_rays_end_at_surfaces(RandomShape random_shape) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < share_of(6000); ++i) {
    const Shape shape = random_shape(dice, 0.05, 20);
    const Truth truth(shape);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real size = real(bounding_radius(shape));
    const RealVec from = dice.direction() * (size * static_cast<Real>(dice.uniform(0.1, 4)));
    const RealVec to = dice.direction() * (size * static_cast<Real>(dice.uniform(0, 1)));
    const Vec3<Length> origin = metres(from), way = metres((to - from) * 2);
    const ShapeRayHit hit = cast_ray(shape, rotation, origin, way);
    const RealVec start = in_frame(rotation, real(origin));
    const RealVec step = in_frame(rotation, real(way));
    const Real slack = 2 * k_micrometre + size * 1e-8L;
    const Real last = hit.hit ? real(hit.fraction) : 1;
    if (hit.hit && hit.fraction == Unit{}) {
      ASSERT_LE(truth.outside(start), slack);
      continue;
    }
    for (int k = 0; k <= 24 && (!hit.hit || k < 24); ++k)
      ASSERT_GT(truth.outside(start + step * (last * k / 24)), -slack) << describe(shape);
    if (!hit.hit) continue;
    ++hits;
    const Real at = truth.outside(start + step * last);
    ASSERT_LE(std::fabs(at), slack + norm(step) * 2e-9L) << describe(shape);
    const RealVec normal = in_frame(rotation, real(hit.normal));
    ASSERT_LE(truth.reach(normal) - dot(normal, start + step * last), slack * 20)
        << describe(shape);
  }
  EXPECT_GT(hits, share_of(1500));
}

}  // namespace lockstone::test
