// Small convex polyhedra made by brute force, random pairs of them, and the same pairs in long
// double: distance by features, overlap by all separating axes.
#pragma once

#include <map>
#include <memory>
#include <set>

#include "core/geometry/convex/polytope.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/math/predicates.h"
#include "core/math/roots.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {

/// Owns the data of a view. Not for many points: every triple is tried.
class TestPolytope {
 public:
  TestPolytope(const TestPolytope&) = delete;
  TestPolytope& operator=(const TestPolytope&) = delete;

  /// The convex hull of points that do not lie in one plane.
  explicit TestPolytope(const std::vector<Vec3<Length>>& points) {
    add_hull_faces(points);
    finish(points);
  }

  /// A polygon of two faces; face 0 is counter-clockwise.
  static std::unique_ptr<TestPolytope> flat(const std::vector<Vec3<Length>>& loop,
                                            bool one_sided = false) {
    std::unique_ptr<TestPolytope> result(new TestPolytope);
    std::vector<std::uint16_t> front(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i)
      front[i] = static_cast<std::uint16_t>(i);
    result->loops_.push_back(front);
    result->loops_.emplace_back(front.rbegin(), front.rend());
    result->finish(loop);
    result->view_.one_sided = one_sided;
    return result;
  }

  [[nodiscard]] const geometry::Polytope& view() const { return view_; }

 private:
  TestPolytope() = default;

  void add_hull_faces(const std::vector<Vec3<Length>>& points) {
    std::set<std::vector<std::uint16_t>> seen;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k) {
          if (j <= i) continue;
          for (const auto& [b, c] : {std::pair{j, k}, std::pair{k, j}})
            add_face_through(points, i, b, c, seen);
        }
  }

  static LatticePoint lattice(const Vec3<Length>& p) { return {p.x.raw, p.y.raw, p.z.raw}; }

  void add_face_through(const std::vector<Vec3<Length>>& points, std::size_t a, std::size_t b,
                        std::size_t c, std::set<std::vector<std::uint16_t>>& seen) {
    const RealVec normal = cross(real(points[b] - points[a]), real(points[c] - points[a]));
    if (norm(normal) == 0) return;
    std::vector<std::uint16_t> loop;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int side =
          orient3d(lattice(points[a]), lattice(points[b]), lattice(points[c]), lattice(points[i]));
      if (side > 0) return;
      if (side == 0) loop.push_back(static_cast<std::uint16_t>(i));
    }
    if (!seen.insert(loop).second) return;
    loops_.push_back(corners_in_order(points, loop, normal));
  }

  /// Gift wrapping in the plane: only true corners, counter-clockwise.
  static std::vector<std::uint16_t> corners_in_order(const std::vector<Vec3<Length>>& points,
                                                     const std::vector<std::uint16_t>& all,
                                                     const RealVec& normal) {
    const auto turn = [&](std::uint16_t o, std::uint16_t p, std::uint16_t q) {
      return dot(cross(real(points[p] - points[o]), real(points[q] - points[o])), normal);
    };
    const auto far = [&](std::uint16_t o, std::uint16_t p) {
      return norm(real(points[p] - points[o]));
    };
    std::uint16_t start = all[0];
    const RealVec sweep = cross(normal, {0.3L, 0.5L, 0.7L});
    for (const std::uint16_t i : all)
      if (dot(real(points[i] - points[start]), sweep) < 0) start = i;
    std::vector<std::uint16_t> loop;
    std::uint16_t at = start;
    do {
      loop.push_back(at);
      std::uint16_t next = at == all[0] ? all[1] : all[0];
      for (const std::uint16_t i : all) {
        if (i == at || i == next) continue;
        const Real side = turn(at, next, i);
        if (side < 0 || (side == 0 && far(at, i) > far(at, next))) next = i;
      }
      at = next;
    } while (at != start && loop.size() <= all.size());
    return loop;
  }

  void finish(const std::vector<Vec3<Length>>& points) {
    std::map<std::uint16_t, std::uint16_t> kept;
    for (auto& loop : loops_)
      for (std::uint16_t& v : loop) {
        const auto [at, fresh] = kept.emplace(v, static_cast<std::uint16_t>(vertices_.size()));
        if (fresh) vertices_.push_back(points[v]);
        v = at->second;
      }
    for (const auto& loop : loops_)
      add_face(loop);
    for (auto& edge : edges_)
      edge.twin = twin_of(static_cast<std::uint16_t>(&edge - edges_.data()));
    RealVec sum;
    for (const auto& v : vertices_)
      sum = sum + real(v) * (Real{1} / static_cast<Real>(vertices_.size()));
    view_ = {
        vertices_,
        faces_,
        edges_,
        metres(static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)),
        &geometry::polytope_kernels(),
        false};
    view_.least_mean_normal = geometry::least_mean_normal_of(faces_, edges_);
  }

  void add_face(const std::vector<std::uint16_t>& loop) {
    RealVec normal;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      normal = normal + cross(real(vertices_[loop[i]] - vertices_[loop[0]]),
                              real(vertices_[loop[i + 1]] - vertices_[loop[0]]));
    normal = normal * (1 / norm(normal));
    geometry::PolytopeFace face;
    face.normal = {unit(static_cast<double>(normal.x)), unit(static_cast<double>(normal.y)),
                   unit(static_cast<double>(normal.z))};
    face.offset = std::numeric_limits<geometry::Fine>::min();
    for (const auto& v : vertices_)
      face.offset = std::max(face.offset, lockstone::dot(v, face.normal).raw);
    face.first_edge = static_cast<std::uint16_t>(edges_.size());
    face.edge_count = static_cast<std::uint16_t>(loop.size());
    for (const std::uint16_t v : loop)
      edges_.push_back({v, 0, static_cast<std::uint16_t>(faces_.size())});
    faces_.push_back(face);
  }

  [[nodiscard]] std::uint16_t end_of(std::uint16_t edge) const {
    const auto& face = faces_[edges_[edge].face];
    const int next = edge + 1 == face.first_edge + face.edge_count ? face.first_edge : edge + 1;
    return edges_[static_cast<std::size_t>(next)].origin;
  }

  [[nodiscard]] std::uint16_t twin_of(std::uint16_t edge) const {
    for (std::uint16_t t = 0; t < edges_.size(); ++t)
      if (edges_[t].origin == end_of(edge) && end_of(t) == edges_[edge].origin) return t;
    ADD_FAILURE() << "the faces do not close";
    return 0;
  }

  std::vector<std::vector<std::uint16_t>> loops_;
  std::vector<Vec3<Length>> vertices_;
  std::vector<geometry::PolytopeFace> faces_;
  std::vector<geometry::HalfEdge> edges_;
  geometry::Polytope view_;
};

using TestPolytopePtr = std::unique_ptr<TestPolytope>;

inline std::vector<Vec3<Length>> box_points(double x, double y, double z) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(metres((i & 1) != 0 ? -x : x, (i & 2) != 0 ? -y : y, (i & 4) != 0 ? -z : z));
  return points;
}

inline std::vector<Vec3<Length>> prism_points(int sides, double radius, double half_height) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < sides; ++i)
    for (const double y : {-half_height, half_height}) {
      const double angle = 2 * 3.14159265358979 * i / sides;
      points.push_back(metres(radius * std::cos(angle), y, radius * std::sin(angle)));
    }
  return points;
}

/// Points about an ellipsoid, which may be a thousand times longer than thick.
inline std::vector<Vec3<Length>> cloud(Dice& dice, int count, double x, double y, double z) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < count; ++i) {
    const RealVec d = dice.direction();
    points.push_back(metres(RealVec{d.x * x, d.y * y, d.z * z}));
  }
  return points;
}

inline TestPolytopePtr random_triangle(Dice& dice, double size, bool one_sided = false) {
  std::vector<Vec3<Length>> loop;
  RealVec normal;
  do {
    loop.clear();
    for (int i = 0; i < 3; ++i)
      loop.push_back(metres(dice.direction() * size));
    normal = cross(real(loop[1] - loop[0]), real(loop[2] - loop[0]));
  } while (norm(normal) < 0.01L * size * size);
  return TestPolytope::flat(loop, one_sided);
}

inline TestPolytopePtr random_polytope(Dice& dice, double size) {
  const auto part = [&] { return size * dice.uniform(0.2, 1); };
  const double x = part(), y = part(), z = part();
  switch (dice.between(0, 7)) {
    case 0:
      return std::make_unique<TestPolytope>(
          std::vector{metres(x, 0, 0), metres(-x, 0, y), metres(-x, 0, -y), metres(0, z, 0)});
    case 1:
      return std::make_unique<TestPolytope>(std::vector{metres(x, 0, 0), metres(-x, 0, 0),
                                                        metres(0, y, 0), metres(0, -y, 0),
                                                        metres(0, 0, z), metres(0, 0, -z)});
    case 2:
      return std::make_unique<TestPolytope>(std::vector{metres(-x, -y, -z), metres(x, -y, -z),
                                                        metres(-x, -y, z), metres(x, -y, z),
                                                        metres(-x, y, 0), metres(x, y, 0)});
    case 3:
      return std::make_unique<TestPolytope>(
          prism_points(static_cast<int>(dice.between(3, 8)), x, y));
    case 4:
      return std::make_unique<TestPolytope>(box_points(x, y, z));
    case 5:
      return random_triangle(dice, size);
    case 6:  // a sliver
      return std::make_unique<TestPolytope>(
          std::vector{metres(size, 0, 0), metres(-size, size / 1000, 0),
                      metres(-size, -size / 1000, size / 500), metres(-size, 0, -size / 1000)});
    default:
      return std::make_unique<TestPolytope>(
          cloud(dice, static_cast<int>(dice.between(5, 12)), x, y, z));
  }
}

// In long double
// -------------------------------------------------------------------------------------------------

/// A convex core by its features, and a radius about it.
struct RealSolid {
  std::vector<RealVec> vertices;
  std::vector<std::vector<RealVec>> faces;
  std::vector<RealVec> normals;
  std::vector<RealSegment> edges;
  Real radius = 0;

  [[nodiscard]] Real reach(const RealVec& n) const {
    Real most = -1e30L;
    for (const RealVec& v : vertices)
      most = std::max(most, dot(v, n));
    return most + radius;
  }
};

inline RealSolid real_solid(const PosedShape& posed, const RealVec& at);

inline RealSolid real_polytope(const geometry::Polytope& p, const Mat3& rotation,
                               const RealVec& at) {
  RealSolid result;
  const std::array<RealVec, 3> axes{real(rotation.x), real(rotation.y), real(rotation.z)};
  const auto turned_by = [&axes](const RealVec& v) {
    return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
  };
  for (const auto& v : p.vertices)
    result.vertices.push_back(at + turned_by(real(v)));
  for (const auto& face : p.faces) {
    std::vector<RealVec> loop;
    for (int i = 0; i < face.edge_count; ++i) {
      const auto& half = p.edges[static_cast<std::size_t>(face.first_edge + i)];
      loop.push_back(result.vertices[half.origin]);
      const auto& end = p.edges[half.twin];
      if (half.origin < end.origin)
        result.edges.push_back({result.vertices[half.origin], result.vertices[end.origin]});
    }
    RealVec normal;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      normal = normal + cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
    result.normals.push_back(normal * (1 / norm(normal)));
    result.faces.push_back(loop);
  }
  return result;
}

inline RealSolid real_solid(const PosedShape& posed, const RealVec& at) {
  if (posed.polytope != nullptr) return real_polytope(*posed.polytope, posed.rotation, at);
  const Placed placed(posed, at);
  RealSolid result;
  result.radius = placed.radius();
  if (posed.shape.kind == ShapeKind::sphere) {
    result.vertices = {at};
  } else if (posed.shape.kind == ShapeKind::capsule) {
    result.vertices = {placed.end(-1), placed.end(1)};
    result.edges = {{placed.end(-1), placed.end(1)}};
  } else {
    const TestPolytope box(box_points(static_cast<double>(placed.size.x),
                                      static_cast<double>(placed.size.y),
                                      static_cast<double>(placed.size.z)));
    return real_polytope(box.view(), posed.rotation, at);
  }
  return result;
}

inline Real point_to_polygon(const RealVec& p, const std::vector<RealVec>& loop,
                             const RealVec& normal) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const RealVec side = cross(loop[(i + 1) % loop.size()] - loop[i], normal);
    if (dot(side, p - loop[i]) > 0) return 1e30L;
  }
  return std::fabs(dot(p - loop[0], normal));
}

inline Real distance_by_features(const RealSolid& a, const RealSolid& b) {
  Real best = 1e30L;
  for (const RealVec& v : a.vertices) {
    for (std::size_t i = 0; i < b.faces.size(); ++i)
      best = std::min(best, point_to_polygon(v, b.faces[i], b.normals[i]));
    for (const RealSegment& e : b.edges)
      best = std::min(best, point_to_segment(v, e.from, e.to));
  }
  for (const RealVec& v : b.vertices) {
    for (std::size_t i = 0; i < a.faces.size(); ++i)
      best = std::min(best, point_to_polygon(v, a.faces[i], a.normals[i]));
    for (const RealSegment& e : a.edges)
      best = std::min(best, point_to_segment(v, e.from, e.to));
  }
  for (const RealSegment& e : a.edges)
    for (const RealSegment& f : b.edges)
      best = std::min(best, segment_to_segment(e.from, e.to, f.from, f.to));
  return best;
}

/// Of the cores: the greatest over the normals of both and all products of edges.
inline Real separation_by_axes(const RealSolid& a, const RealSolid& b) {
  Real best = -1e30L;
  const auto look_at = [&](const RealVec& n) {
    best = std::max(best, -b.reach(n * -1) + b.radius - a.reach(n) + a.radius);
  };
  for (const RealVec& n : a.normals)
    look_at(n);
  for (const RealVec& n : b.normals)
    look_at(n * -1);
  for (const RealSegment& e : a.edges)
    for (const RealSegment& f : b.edges) {
      const RealVec k = cross(e.to - e.from, f.to - f.from);
      const Real length = norm(k);
      if (length < 1e-9L * norm(e.to - e.from) * norm(f.to - f.from)) continue;
      look_at(k * (1 / length));
      look_at(k * (-1 / length));
    }
  return best;
}

/// Distance when apart; minus the least overlap of cores and the radii otherwise.
inline Real signed_distance(const RealSolid& a, const RealSolid& b) {
  const Real axes = separation_by_axes(a, b);
  return (axes > 0 ? distance_by_features(a, b) : axes) - a.radius - b.radius;
}

/// How far a point is from the surface, outside or inside.
inline Real surface_distance(const RealSolid& solid, const RealVec& p) {
  RealSolid point;
  point.vertices = {p};
  Real inside = -1e30L;
  for (std::size_t i = 0; i < solid.normals.size(); ++i)
    inside = std::max(inside, dot(p - solid.faces[i][0], solid.normals[i]));
  if (solid.faces.size() > 2 && inside <= 0) return std::fabs(inside);
  if (solid.vertices.size() == 1) return std::fabs(norm(p - solid.vertices[0]) - solid.radius);
  return std::fabs(distance_by_features(solid, point) - solid.radius);
}

/// How far the point of a ball around an end of a capsule's core may be within its side.
inline Real lean_slack(const RealSolid& solid, const RealVec& normal) {
  if (solid.vertices.size() != 2) return 0;
  const RealVec core = solid.vertices[1] - solid.vertices[0];
  return end_within_side(solid.radius, dot(core, normal) / norm(core));
}

/// A shape with its rotation, by value.
struct Body {
  Shape shape;
  Mat3 rotation;
  const geometry::Polytope* polytope = nullptr;

  [[nodiscard]] PosedShape posed() const { return {shape, rotation, polytope}; }
};

/// A pair of which one at least is a polytope.
struct PolytopeScene {
  TestPolytopePtr polytope_a;
  TestPolytopePtr polytope_b;
  Shape a;
  Shape b;
  Mat3 rotation_a;
  Mat3 rotation_b;
  Vec3<Length> offset;
  Length margin;

  [[nodiscard]] PosedShape posed_a() const {
    return {a, rotation_a, polytope_a ? &polytope_a->view() : nullptr};
  }
  [[nodiscard]] PosedShape posed_b() const {
    return {b, rotation_b, polytope_b ? &polytope_b->view() : nullptr};
  }
  [[nodiscard]] RealSolid real_a() const { return real_solid(posed_a(), {}); }
  [[nodiscard]] RealSolid real_b() const { return real_solid(posed_b(), real(offset)); }
  [[nodiscard]] Manifold collide() const {
    return lockstone::collide(posed_a(), posed_b(), offset, margin);
  }
  [[nodiscard]] bool has(ShapeKind kind) const { return a.kind == kind || b.kind == kind; }
  /// Of the capsule, else 0.
  [[nodiscard]] Real capsule_radius() const {
    return a.kind == ShapeKind::capsule   ? real(a.size.x)
           : b.kind == ShapeKind::capsule ? real(b.size.x)
                                          : 0;
  }
  /// A length that errors scale with.
  [[nodiscard]] Real scale() const {
    Real size = norm(real(offset));
    const RealSolid solid_a = real_a();
    const RealSolid solid_b = real_b();
    for (const RealVec& v : solid_a.vertices)
      size = std::max(size, norm(v) + solid_a.radius);
    for (const RealVec& v : solid_b.vertices)
      size = std::max(size, norm(v - real(offset)) + solid_b.radius);
    return 2 * size;
  }
};

inline std::string describe(const PolytopeScene& s) {
  std::string text = "a " + describe(s.a) + " b " + describe(s.b) + " Ra " +
                     describe(s.rotation_a) + " Rb " + describe(s.rotation_b) + " offset " +
                     std::to_string(s.offset.x.raw) + "," + std::to_string(s.offset.y.raw) + "," +
                     std::to_string(s.offset.z.raw) + " margin " + std::to_string(s.margin.raw);
  for (const TestPolytope* p : {s.polytope_a.get(), s.polytope_b.get()}) {
    if (p == nullptr) continue;
    text += "\n  vertices";
    for (const auto& v : p->view().vertices)
      text += " (" + std::to_string(v.x.raw) + "," + std::to_string(v.y.raw) + "," +
              std::to_string(v.z.raw) + ")";
  }
  return text;
}

inline void place(Dice& dice, PolytopeScene& scene, double high) {
  scene.rotation_a = to_matrix(dice.orientation());
  scene.rotation_b = dice.chance(8) ? scene.rotation_a : to_matrix(dice.orientation());
  const RealVec n = dice.direction();
  scene.offset = {};
  const Real reach = scene.real_a().reach(n) + scene.real_b().reach(n * -1);
  scene.offset = metres(n * std::min<Real>(reach * dice.uniform(0.2, 1.25), 1990));
  scene.margin = metres(dice.chance(4) ? 0 : std::min(64.0, high * dice.uniform(0, 0.5)));
}

inline PolytopeScene random_polytope_scene(Dice& dice, ShapeKind other, double low, double high) {
  PolytopeScene scene;
  const auto size = [&] { return std::exp(dice.uniform(std::log(low), std::log(high))); };
  const bool polytope_first = dice.chance(2);
  scene.polytope_a = random_polytope(dice, size());
  scene.a = {ShapeKind::hull, {}, {7}};
  if (other == ShapeKind::hull) {
    do
      scene.polytope_b = random_polytope(dice, size());
    while (geometry::is_flat(scene.polytope_a->view()) &&
           geometry::is_flat(scene.polytope_b->view()));
    scene.b = {ShapeKind::hull, {}, {static_cast<std::uint64_t>(polytope_first ? 6 : 8)}};
  } else {
    scene.b = dice.shape(other, low, high);
  }
  if (!polytope_first) {
    std::swap(scene.polytope_a, scene.polytope_b);
    std::swap(scene.a, scene.b);
  }
  place(dice, scene, high);
  return scene;
}

inline const std::array<ShapeKind, 4> k_kinds_beside_hulls{ShapeKind::sphere, ShapeKind::capsule,
                                                           ShapeKind::box, ShapeKind::hull};

/// Runs `check(dice, scene)` over polytopes and all kinds they meet, in several ranges of sizes.
template <class Check>
void for_random_polytope_scenes(int rounds, Check check) {
  Dice dice;
  const std::array<std::array<double, 2>, 4> ranges{
      {{0.2, 2.0}, {0.002, 0.05}, {0.002, 500.0}, {50.0, 500.0}}};
  for (const ShapeKind other : k_kinds_beside_hulls) {
    for (int i = 0; i < rounds; ++i) {
      const auto& range = ranges[static_cast<std::size_t>(i) % ranges.size()];
      const PolytopeScene scene = random_polytope_scene(dice, other, range[0], range[1]);
      check(dice, scene);
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << describe(scene);
        return;
      }
    }
  }
}

}  // namespace lockstone::test
