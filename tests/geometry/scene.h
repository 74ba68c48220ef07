// Random shapes, rotations and pairs for the collision tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/dispatch/collide.h"
#include "tests/geometry/reference.h"
#include "tests/support/random.h"

namespace lockstone::test {

inline constexpr Mat3 k_identity{};
inline constexpr Real k_micrometre = 1e-6L;

inline Length metres(double x) {
  return Length::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(x, Length::frac_bits))));
}
inline Vec3<Length> metres(double x, double y, double z) {
  return {metres(x), metres(y), metres(z)};
}
inline Vec3<Length> metres(const RealVec& v) {
  return metres(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}
inline Unit unit(double x) {
  return Unit::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(x, Unit::frac_bits))));
}

inline Quat quat(double x, double y, double z, double w) {
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  return {unit(x / length), unit(y / length), unit(z / length), unit(w / length)};
}

inline Mat3 turned(double x, double y, double z, double angle) {
  const double length = std::sqrt(x * x + y * y + z * z);
  const double s = std::sin(angle / 2) / length;
  return to_matrix(quat(x * s, y * s, z * s, std::cos(angle / 2)));
}

/// The least separation of a manifold's points.
inline Real deepest(const Manifold& m) {
  Real least = 1e30L;
  for (int i = 0; i < m.count; ++i)
    least = std::min(least, real(m.points[static_cast<std::size_t>(i)].separation));
  return least;
}

/// How far the point of a ball around an end of a capsule's core may be within its side, where the
/// core leans towards the normal.
inline Real end_within_side(Real radius, Real lean) {
  return radius * (1 - std::sqrt(std::max<Real>(1 - lean * lean, 0)));
}

/// Contacts of shapes that are apart by `truth`, with slack: none beyond the margin, else as far.
inline void expect_contacts_of_gap(const Manifold& m, Real truth, Real margin, Real slack) {
  if (truth > margin + slack) {
    EXPECT_EQ(m.count, 0);
  }
  if (truth > margin - slack) return;
  ASSERT_GT(m.count, 0) << static_cast<double>(truth);
  if (truth > 127) return;
  EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(truth),
              static_cast<double>(slack));
}

/// Contacts of shapes that overlap, by `truth` below 0 at least: hardly deeper. Edges and faces are
/// preferred by k_edge_margin and k_face_margin, a tenth and 1/32.
inline void expect_contacts_of_overlap(const Manifold& m, Real truth, Real slack) {
  ASSERT_GT(m.count, 0);
  const Real found = std::max<Real>(deepest(m), -128);
  EXPECT_LE(found, 0);
  const Real more = slack + 0.00074L + std::fabs(truth) * 0.15L;
  EXPECT_GE(static_cast<double>(found), static_cast<double>(truth - more));
}

inline std::set<std::uint32_t> features_of(const Manifold& m) {
  std::set<std::uint32_t> features;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    features.insert(m.points[i].feature);
  return features;
}

class Dice : public Random {
 public:
  using Random::Random;

  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(next() >> 11), -53);
  }
  bool chance(int one_in) { return between(1, one_in) == 1; }

  Quat orientation() {
    if (chance(8)) return {};
    if (chance(6)) return quat(0, uniform(-1, 1), 0, uniform(-1, 1));
    if (chance(6)) return quat(uniform(-1e-6, 1e-6), uniform(-1e-6, 1e-6), uniform(-1e-6, 1e-6), 1);
    double q[4];
    double square = 0;
    do {
      square = 0;
      for (double& c : q) {
        c = uniform(-1, 1);
        square += c * c;
      }
    } while (square > 1 || square < 1e-2);
    return quat(q[0], q[1], q[2], q[3]);
  }

  /// Log-uniform in [low, high].
  Length size(double low, double high) {
    const Length x = metres(std::exp(uniform(std::log(low), std::log(high))));
    return clamp(x, k_min_shape_size, k_max_shape_size);
  }

  Shape shape(ShapeKind kind, double low, double high) {
    if (kind == ShapeKind::sphere) return Shape::sphere(size(low, high));
    if (kind == ShapeKind::capsule) return Shape::capsule(size(low, high), size(low, high));
    return Shape::box(size(low, high), size(low, high), size(low, high));
  }

  RealVec direction() {
    RealVec v;
    do {
      v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    } while (norm(v) > 1 || norm(v) < 1e-3L);
    return v * (1 / norm(v));
  }
};

inline bool is_round(const Shape& shape) {
  return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule;
}

/// How far the common anchor of overlapping shapes is from A's surface, as a share of the overlap.
inline Real share_of_a(const Shape& a, const Shape& b) {
  if (is_round(a) == is_round(b)) return 0.5L;
  return is_round(a) ? 0 : 1;
}

/// Two shapes that may meet.
struct Scene {
  Shape a;
  Shape b;
  Mat3 rotation_a;
  Mat3 rotation_b;
  Vec3<Length> offset;
  Length margin;

  [[nodiscard]] PosedShape posed_a() const { return {a, rotation_a}; }
  [[nodiscard]] PosedShape posed_b() const { return {b, rotation_b}; }
  [[nodiscard]] Placed placed_a() const { return {posed_a(), {}}; }
  [[nodiscard]] Placed placed_b() const { return {posed_b(), real(offset)}; }
  [[nodiscard]] Manifold collide() const {
    return lockstone::collide(posed_a(), posed_b(), offset, margin);
  }
  /// A length that errors scale with.
  [[nodiscard]] Real scale() const {
    return std::max(real(bounding_radius(a)) + real(bounding_radius(b)), norm(real(offset)));
  }
};

inline void expect_flipped(const Manifold& m, const Manifold& f) {
  ASSERT_EQ(m.count, f.count);
  EXPECT_EQ(m.normal, -f.normal);
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    EXPECT_EQ(m.points[i].anchor_a, f.points[i].anchor_b);
    EXPECT_EQ(m.points[i].anchor_b, f.points[i].anchor_a);
    EXPECT_EQ(m.points[i].separation, f.points[i].separation);
    EXPECT_EQ(m.points[i].feature, f.points[i].feature);
  }
}

/// The features that a pair with this manifold holds a tick later.
inline HeldFeatures held_by(const Manifold& manifold) {
  HeldFeatures held;
  held.count = static_cast<std::uint16_t>(manifold.count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
    held.features[i] = manifold.points[i].feature;
  return held;
}

/// Of the deepest point, m; negative where shapes overlap.
inline double depth_of(const Manifold& manifold) {
  return std::ldexp(static_cast<double>(geometry::deepest_of(manifold)), -geometry::k_fine_bits);
}

inline void tremble(Dice& dice, double metres_most, Vec3<Length>& offset) {
  for (int axis = 0; axis < 3; ++axis)
    offset[axis] += metres(dice.uniform(-metres_most, metres_most));
}

inline std::string describe(const Mat3& m) {
  std::string text;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      text += std::to_string(m.column(column)[row].raw) + ",";
  }
  return text;
}

inline std::string describe(const Shape& s) {
  return std::to_string(static_cast<int>(s.kind)) + ":" + std::to_string(s.size.x.raw) + "," +
         std::to_string(s.size.y.raw) + "," + std::to_string(s.size.z.raw);
}

inline std::string describe(const Scene& s) {
  return "a " + describe(s.a) + " b " + describe(s.b) + " Ra " + describe(s.rotation_a) + " Rb " +
         describe(s.rotation_b) + " offset " + std::to_string(s.offset.x.raw) + "," +
         std::to_string(s.offset.y.raw) + "," + std::to_string(s.offset.z.raw) + " margin " +
         std::to_string(s.margin.raw);
}

/// A pair placed so that it often just touches: the centres are moved along a random direction to a
/// random part of the sum of the extents.
inline Scene random_scene(Dice& dice, ShapeKind kind_a, ShapeKind kind_b, double low, double high) {
  Scene scene;
  scene.a = dice.shape(kind_a, low, high);
  scene.b = dice.shape(kind_b, low, high);
  scene.rotation_a = to_matrix(dice.orientation());
  scene.rotation_b = dice.chance(8) ? scene.rotation_a : to_matrix(dice.orientation());
  const RealVec n = dice.direction();
  const Real reach = scene.placed_a().reach(n) + scene.placed_b().reach(n);
  const RealVec d = n * std::min<Real>(reach * dice.uniform(0.2, 1.25), 1990);
  scene.offset =
      metres(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z));
  scene.margin = metres(dice.chance(4) ? 0 : std::min(64.0, high * dice.uniform(0, 0.5)));
  return scene;
}

inline const std::array<ShapeKind, 3> k_all_kinds{ShapeKind::sphere, ShapeKind::capsule,
                                                  ShapeKind::box};

/// Runs `check(dice, scene)` over all ordered pairs of kinds and several ranges of sizes.
template <class Check>
void for_random_scenes(int rounds, Check check) {
  Dice dice;
  const std::array<std::array<double, 2>, 4> ranges{
      {{0.2, 2.0}, {0.001, 0.05}, {0.001, 512.0}, {50.0, 512.0}}};
  for (const ShapeKind kind_a : k_all_kinds) {
    for (const ShapeKind kind_b : k_all_kinds) {
      for (int i = 0; i < rounds; ++i) {
        const auto& range = ranges[static_cast<std::size_t>(i) % ranges.size()];
        const Scene scene = random_scene(dice, kind_a, kind_b, range[0], range[1]);
        check(dice, scene);
        if (::testing::Test::HasFailure()) {
          ADD_FAILURE() << describe(scene);
          return;
        }
      }
    }
  }
}

}  // namespace lockstone::test
