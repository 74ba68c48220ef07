// Small convex polyhedra made by brute force, and random ones.
#pragma once

#include <map>
#include <memory>
#include <set>

#include "core/geometry/convex/polytope.h"
#include "core/math/predicates.h"
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

}  // namespace lockstone::test
