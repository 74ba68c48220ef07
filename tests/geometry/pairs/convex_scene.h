// Random pairs of convex shapes with polytopes among them, and certificates of their distance in
// long double.
#pragma once

#include <vector>

#include "tests/geometry/scene.h"

namespace lockstone::test {

/// A shape of any convex kind in a pose, owning the data of a polytope's view. Vertices alone: that
/// is all GJK and EPA look at; interior points among them are harmless.
struct Convex {
  Shape shape{};
  Mat3 rotation{};
  std::vector<Vec3<Length>> vertices;
  geometry::Polytope polytope{};

  [[nodiscard]] PosedShape posed() {
    if (vertices.empty()) return {shape, rotation};
    polytope.vertices = vertices;
    return {shape, rotation, &polytope};
  }
  [[nodiscard]] Real radius() const {
    return !vertices.empty() || shape.kind == ShapeKind::box ? 0 : real(shape.size.x);
  }
  /// The core's vertices, from the centre, in world axes.
  [[nodiscard]] std::vector<RealVec> points() const {
    const std::array<RealVec, 3> axes{real(rotation.x), real(rotation.y), real(rotation.z)};
    const auto turn = [&axes](const RealVec& v) {
      return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
    };
    std::vector<RealVec> list;
    if (!vertices.empty()) {
      for (const Vec3<Length>& v : vertices)
        list.push_back(turn(real(v)));
      return list;
    }
    const RealVec size = real(shape.size);
    if (shape.kind == ShapeKind::sphere) return {{}};
    if (shape.kind == ShapeKind::capsule) return {turn({0, -size.y, 0}), turn({0, size.y, 0})};
    for (int i = 0; i < 8; ++i) {
      list.push_back(turn({(i & 1) != 0 ? size.x : -size.x, (i & 2) != 0 ? size.y : -size.y,
                           (i & 4) != 0 ? size.z : -size.z}));
    }
    return list;
  }
};

inline double real_size(Dice& dice, double low, double high) {
  return std::exp(dice.uniform(std::log(low), std::log(high)));
}

inline Convex convex(const Shape& shape, const Mat3& rotation = {}) {
  return {shape, rotation, {}, {}};
}

inline Convex convex(std::vector<Vec3<Length>> vertices, const Mat3& rotation = {}) {
  return {Shape{ShapeKind::hull, {}, {}}, rotation, std::move(vertices), {}};
}

/// `count` points in a box of random proportions; sometimes flat, thin, or on a sphere.
inline std::vector<Vec3<Length>> random_vertices(Dice& dice, int count, double low, double high) {
  const double x = real_size(dice, low, high);
  const double y = dice.chance(8) ? 0.0 : real_size(dice, low, high);
  const double z = dice.chance(8) ? x * 1e-4 : real_size(dice, low, high);
  const bool round = dice.chance(2);
  std::vector<Vec3<Length>> vertices;
  for (int i = 0; i < count; ++i) {
    RealVec p{dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(-1, 1)};
    if (round) p = dice.direction();
    vertices.push_back(metres(x * static_cast<double>(p.x), y * static_cast<double>(p.y),
                              z * static_cast<double>(p.z)));
  }
  return vertices;
}

struct ConvexPair {
  Convex a;
  Convex b;
  Vec3<Length> offset;

  [[nodiscard]] Real radii() const { return a.radius() + b.radius(); }
};

inline std::string describe(const Convex& c) {
  std::string text = describe(c.shape) + " R " + describe(c.rotation);
  for (const Vec3<Length>& v : c.vertices) {
    text += " (" + std::to_string(v.x.raw) + "," + std::to_string(v.y.raw) + "," +
            std::to_string(v.z.raw) + ")";
  }
  return text;
}

inline std::string describe(const ConvexPair& p) {
  return "a " + describe(p.a) + "\nb " + describe(p.b) + "\noffset " +
         std::to_string(p.offset.x.raw) + "," + std::to_string(p.offset.y.raw) + "," +
         std::to_string(p.offset.z.raw);
}

/// Sphere, capsule, box, triangle, tetrahedron, hull of 8 … 32 points.
inline constexpr int k_convex_kinds = 6;

inline Convex random_convex(Dice& dice, int kind, double low, double high) {
  const Mat3 rotation = to_matrix(dice.orientation());
  if (kind < 3) return convex(dice.shape(static_cast<ShapeKind>(kind), low, high), rotation);
  const int count = kind == 3 ? 3 : kind == 4 ? 4 : static_cast<int>(dice.between(8, 32));
  return convex(random_vertices(dice, count, low, high), rotation);
}

inline Real reach_along(const std::vector<RealVec>& points, const RealVec& n) {
  Real most = -1e30L;
  for (const RealVec& p : points)
    most = std::max(most, dot(p, n));
  return most;
}

/// The offset lies along a random direction, at `least` to `most` of where the shapes touch along
/// it.
inline ConvexPair random_pair(Dice& dice, int kind_a, int kind_b, double low, double high,
                              double least = 0.2, double most = 1.3) {
  ConvexPair pair{
      random_convex(dice, kind_a, low, high), random_convex(dice, kind_b, low, high), {}};
  if (dice.chance(8)) pair.b.rotation = pair.a.rotation;
  const RealVec n = dice.direction();
  const Real reach =
      reach_along(pair.a.points(), n) + reach_along(pair.b.points(), n * -1) + pair.radii();
  const RealVec d = n * std::min<Real>(reach * dice.uniform(least, most), 1990);
  pair.offset =
      metres(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z));
  return pair;
}

/// Runs `check(dice, pair)` over all pairs of kinds and several ranges of sizes.
template <class Check>
void for_convex_pairs(int rounds, Check check) {
  Dice dice;
  const std::array<std::array<double, 2>, 4> ranges{
      {{0.2, 2.0}, {0.001, 0.05}, {0.001, 500.0}, {50.0, 500.0}}};
  for (int kinds = 0; kinds < k_convex_kinds * k_convex_kinds; ++kinds) {
    for (int i = 0; i < rounds; ++i) {
      const auto& range = ranges[static_cast<std::size_t>(i) % ranges.size()];
      ConvexPair pair =
          random_pair(dice, kinds / k_convex_kinds, kinds % k_convex_kinds, range[0], range[1]);
      check(dice, pair);
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << describe(pair);
        return;
      }
    }
  }
}

/// The cores' vertices in real numbers, B's moved by the offset.
struct RealPair {
  std::vector<RealVec> a;
  std::vector<RealVec> b;
  Real radii = 0;
  Real size = 0;  ///< that errors scale with

  explicit RealPair(const ConvexPair& pair)
      : a(pair.a.points()), b(pair.b.points()), radii(pair.radii()) {
    for (RealVec& p : b)
      p = p + real(pair.offset);
    for (const RealVec& p : a)
      size = std::max(size, norm(p));
    for (const RealVec& p : b)
      size = std::max(size, norm(p));
    size += radii;
  }
  /// How far B is beyond A along a unit vector: at most the distance, for every direction.
  [[nodiscard]] Real separation(const RealVec& n) const {
    return -reach_along(b, n * -1) - reach_along(a, n) - radii;
  }
};

/// The error by rounding of inputs, rotations and results.
inline Real tolerance(const RealPair& pair) {
  return 2 * k_micrometre + 4e-9L * pair.size;
}

/// How many rounded terms a core's vertex is the sum of: generators, or one listed vertex.
inline int rounded_terms(const Convex& c) {
  if (!c.vertices.empty()) return 1;
  return c.shape.kind == ShapeKind::box ? 3 : c.shape.kind == ShapeKind::capsule ? 1 : 0;
}

/// A step of the lattice at most: 2^-29 of the farthest corner of the bounds of B − A, world axes.
inline Real greatest_lattice_step(const RealPair& pair) {
  RealVec reach;
  for (const RealVec& p : pair.a) {
    for (const RealVec& q : pair.b) {
      for (int k = 0; k < 3; ++k)
        reach[k] = std::max(reach[k], std::fabs(q[k] - p[k]));
    }
  }
  return std::ldexp(norm(reach), -29);
}

/// How far the depth may be from the overlap along its normal n. The depth is that of the plane
/// of a face's exact vertices, and EPA proves on the lattice that no vertex is beyond it:
///
///   √3 steps a term  between two vertices of B − A each rounded term differs at most twice, by
///                    half a step in each of three lanes
///   1 step           that a vertex may lie beyond the plane on the lattice (`is_supported`)
///   2√3 steps        the direction asked along is cut to 31 bits, below 2^-30 of it a lane, and
///                    two vertices are at most 2^31 steps apart
///   √3/2 steps       n is rounded by 2^-31 a lane, and vertices are at most 2^30 steps away
///
/// and 2 µm for points and radii, as `distance` has. At most 16 steps: 30e-9 of the sizes.
inline Real depth_tolerance(const ConvexPair& pair) {
  const Real root = std::sqrt(Real{3});
  const int terms = rounded_terms(pair.a) + rounded_terms(pair.b);
  const Real steps = root * terms + 1 + 2 * root + root / 2;
  return 2 * k_micrometre + steps * greatest_lattice_step(RealPair(pair));
}

/// Distance of a point from the triangle abc (which may be a point or a segment).
inline Real point_to_triangle(const RealVec& p, const RealVec& a, const RealVec& b,
                              const RealVec& c) {
  const auto to_segment = [&p](const RealVec& s, const RealVec& e) {
    return norm(e - s) > 0 ? point_to_segment(p, s, e) : norm(p - s);
  };
  const Real rim = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const RealVec n = cross(b - a, c - a);
  const Real nn = dot(n, n);
  if (nn == 0) return rim;
  const Real at_a = dot(cross(b - p, c - p), n);
  const Real at_b = dot(cross(c - p, a - p), n);
  const Real at_c = dot(cross(a - p, b - p), n);
  if (at_a < 0 || at_b < 0 || at_c < 0) return rim;
  return std::fabs(dot(p - a, n)) / std::sqrt(nn);
}

/// Distance of the hulls of at most four points each, apart, by all pairs of features.
inline Real apart_simplices(const std::vector<RealVec>& a, const std::vector<RealVec>& b) {
  Real best = 1e30L;
  const auto points_to_faces = [&best](const auto& points, const auto& faces) {
    for (const RealVec& p : points) {
      for (const RealVec& u : faces) {
        for (const RealVec& v : faces) {
          for (const RealVec& w : faces)
            best = std::min(best, point_to_triangle(p, u, v, w));
        }
      }
    }
  };
  points_to_faces(a, b);
  points_to_faces(b, a);
  for (std::size_t i = 0; i < a.size() * a.size(); ++i) {
    for (std::size_t k = 0; k < b.size() * b.size(); ++k) {
      const RealVec &p = a[i / a.size()], &q = a[i % a.size()];
      const RealVec &r = b[k / b.size()], &s = b[k % b.size()];
      if (norm(p - q) > 0 && norm(r - s) > 0) best = std::min(best, segment_to_segment(p, q, r, s));
    }
  }
  return best;
}

}  // namespace lockstone::test
