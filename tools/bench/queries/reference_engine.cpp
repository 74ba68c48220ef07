// Queries in double that ask every body: slow, plain, and the judge of the others.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <lockstone/testing/floating.h>

#include "tools/bench/queries/query_engine.h"

namespace lockstone::bench {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Quantity>
Vector vector(const Vec3<Quantity>& v) {
  return {testing::to_double(v.x), testing::to_double(v.y), testing::to_double(v.z)};
}

struct Body {
  ShapeKind kind;
  Vector size;
  Vector place;
  std::array<Vector, 3> axes;
  double reach;  // of a sphere about the place that holds it
};

// The columns of the quaternion's matrix, divided by its squared norm.
std::array<Vector, 3> axes_of(const Quat& q) {
  const double x = testing::to_double(q.x), y = testing::to_double(q.y);
  const double z = testing::to_double(q.z), w = testing::to_double(q.w);
  const double s = 2 / (x * x + y * y + z * z + w * w);
  return {Vector{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
          Vector{s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
          Vector{s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}};
}

double reach_of(ShapeKind kind, const Vector& size) {
  if (kind == ShapeKind::sphere) return size[0];
  return kind == ShapeKind::capsule ? size[0] + size[1] : std::sqrt(dot(size, size));
}

Body body_of(const QueryBody& body) {
  const Vector size = vector(body.shape.size);
  return {body.shape.kind, size, vector(body.pose.position), axes_of(body.pose.orientation),
          reach_of(body.shape.kind, size)};
}

Vector in_frame(const Body& body, const Vector& v) {
  return {dot(v, body.axes[0]), dot(v, body.axes[1]), dot(v, body.axes[2])};
}

// The fraction at which origin + t·way enters, when it does so on the way.
using Entry = std::optional<double>;

// From |o|² + 2t·(o·w) + t²·|w|² = r², lengths without the y component when `round_y` is false.
Entry enter_round(Vector o, Vector w, double radius, bool round_y) {
  if (!round_y) o[1] = w[1] = 0;
  const double a = dot(w, w), b = dot(o, w), c = dot(o, o) - radius * radius;
  const double root = b * b - a * c;
  if (a == 0 || root < 0) return {};
  const double t = (-b - std::sqrt(root)) / a;
  return t >= 0 && t <= 1 ? Entry(t) : Entry();
}

Entry enter_capsule(const Vector& o, const Vector& w, const Vector& size) {
  const Entry side = enter_round(o, w, size[0], false);
  if (side && std::abs(o[1] + *side * w[1]) <= size[1]) return side;
  Entry first;
  for (const double end : {-size[1], size[1]}) {
    const Entry cap = enter_round({o[0], o[1] - end, o[2]}, w, size[0], true);
    if (cap && (!first || *cap < *first)) first = cap;
  }
  return first;
}

Entry enter_box(const Vector& o, const Vector& w, const Vector& size) {
  double low = 0, high = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (w[i] == 0 && std::abs(o[i]) > size[i]) return {};
    if (w[i] == 0) continue;
    const double a = (-size[i] - o[i]) / w[i], b = (size[i] - o[i]) / w[i];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  return low <= high ? Entry(low) : Entry();
}

Entry enter(const Body& body, const Vector& origin, const Vector& way) {
  const Vector o = in_frame(body, minus(origin, body.place)), w = in_frame(body, way);
  if (body.kind == ShapeKind::sphere) return enter_round(o, w, body.size[0], true);
  if (body.kind == ShapeKind::capsule) return enter_capsule(o, w, body.size);
  return enter_box(o, w, body.size);
}

// From a point to the body; 0 inside.
double distance(const Body& body, const Vector& point) {
  Vector p = in_frame(body, minus(point, body.place));
  if (body.kind == ShapeKind::capsule) p[1] -= std::clamp(p[1], -body.size[1], body.size[1]);
  if (body.kind != ShapeKind::box) return std::max(0.0, std::sqrt(dot(p, p)) - body.size[0]);
  for (std::size_t i = 0; i < 3; ++i)
    p[i] -= std::clamp(p[i], -body.size[i], body.size[i]);
  return std::sqrt(dot(p, p));
}

// Where a ball of that radius first touches the body (1e-13 m), from outside, its centre on
// origin + t·way: forward by the distance left, over and over, which cannot pass the body
// (J. C. Hart, Sphere tracing, 1996).
Entry enter_thick(const Body& body, const Vector& origin, const Vector& way, double radius) {
  constexpr int k_steps = 100'000;  // where it grazes they are many
  const double length = std::sqrt(dot(way, way));
  double t = 0;
  for (int i = 0; i < k_steps && t <= 1; ++i) {
    Vector at = origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] += t * way[axis];
    const double left = distance(body, at) - radius;
    if (left < 1e-13) return t;
    t += left / length;
  }
  return {};
}

struct Triangle {
  Vector corner, first, second;  // a corner and the edges from it, counter-clockwise in front
};

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// From the front (T. Möller, B. Trumbore, Fast, minimum storage ray/triangle intersection, 1997).
Entry enter_triangle(const Triangle& triangle, const Vector& origin, const Vector& way) {
  const Vector p = cross(way, triangle.second);
  const double volume = dot(triangle.first, p);
  if (volume <= 0) return {};
  const Vector o = minus(origin, triangle.corner);
  const double u = dot(o, p) / volume;
  const Vector q = cross(o, triangle.first);
  const double v = dot(way, q) / volume, t = dot(triangle.second, q) / volume;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1 ? Entry(t) : Entry();
}

std::vector<Triangle> triangles_of(const QueryScene& scene) {
  std::vector<Triangle> triangles;
  for (const TriangleIndices& t : scene.terrain) {
    const Vector a = vector(scene.terrain_vertices[t.a]);
    triangles.push_back({a, minus(vector(scene.terrain_vertices[t.b]), a),
                         minus(vector(scene.terrain_vertices[t.c]), a)});
  }
  return triangles;
}

class ReferenceEngine final : public QueryEngine {
 public:
  explicit ReferenceEngine(const QueryScene& scene)
      : knows_hulls_(scene.hulls.empty()), terrain_(triangles_of(scene)) {
    for (const QueryBody& body : scene.bodies) {
      if (is_primitive(body.shape.kind)) bodies_.push_back(body_of(body));
    }
  }

  [[nodiscard]] std::string name() const override { return "double"; }

  bool answer(const QueryRow& row, std::span<QueryAnswer> out) override {
    if (!knows(row)) return false;
    for (std::size_t i = 0; i < row.size(); ++i)
      out[i] = answer_one(row, i);
    return true;
  }

 private:
  // Hulls it does not know at all; of the terrain, rays.
  [[nodiscard]] bool knows(const QueryRow& row) const {
    const bool of_ray = row.kind == QueryKind::closest_ray || row.kind == QueryKind::blocked_ray ||
                        row.kind == QueryKind::all_rays;
    if (!knows_hulls_ || (!terrain_.empty() && !of_ray)) return false;
    return !row.shape_asked() || row.shape.kind == ShapeKind::sphere;
  }

  QueryAnswer answer_one(const QueryRow& row, std::size_t i) const {
    if (row.kind == QueryKind::point) return near(vector(row.rays[i].origin), 0);
    if (row.kind == QueryKind::near_point)
      return nearest(vector(row.rays[i].origin), testing::to_double(row.reach));
    if (row.kind == QueryKind::overlap)
      return near(vector(row.poses[i].position), testing::to_double(row.shape.size.x));
    const Vector origin = vector(row.rays[i].origin), way = vector(row.rays[i].translation);
    const bool is_cast = row.kind == QueryKind::closest_cast;
    const double radius = is_cast ? testing::to_double(row.shape.size.x) : 0;
    QueryAnswer answer = along(origin, way, radius);
    if (row.kind != QueryKind::all_rays) answer.count = std::min(answer.count, 1U);
    if (!row.names_fraction()) answer.body = k_no_body;
    return answer;
  }

  // Every body on the way of a point, or of a ball.
  QueryAnswer along(const Vector& origin, const Vector& way, double radius) const {
    QueryAnswer answer;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (is_aside(bodies_[i], origin, way, radius)) continue;
      meet(radius > 0 ? enter_thick(bodies_[i], origin, way, radius)
                      : enter(bodies_[i], origin, way),
           i, answer);
    }
    Entry ground;
    for (const Triangle& triangle : terrain_) {
      const Entry entry = enter_triangle(triangle, origin, way);
      if (entry && (!ground || *entry < *ground)) ground = entry;
    }
    meet(ground, bodies_.size(), answer);
    return answer;
  }

  // Whether the way keeps clear of a ball about the body.
  static bool is_aside(const Body& body, const Vector& origin, const Vector& way, double radius) {
    const Vector to_body = minus(body.place, origin);
    const double t = std::clamp(dot(to_body, way) / dot(way, way), 0.0, 1.0);
    const Vector off{to_body[0] - t * way[0], to_body[1] - t * way[1], to_body[2] - t * way[2]};
    const double most = body.reach + radius + 1e-6;
    return dot(off, off) > most * most;
  }

  static void meet(const Entry& entry, std::size_t body, QueryAnswer& answer) {
    if (!entry) return;
    ++answer.count;
    if (answer.body != k_no_body && *entry >= answer.where) return;
    answer.body = static_cast<std::uint32_t>(body);
    answer.where = *entry;
  }

  QueryAnswer nearest(const Vector& point, double reach) const {
    QueryAnswer answer;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const double away = distance(bodies_[i], point);
      if (away > reach || (answer.count != 0 && away >= answer.where)) continue;
      answer = {1, static_cast<std::uint32_t>(i), away};
    }
    return answer;
  }

  QueryAnswer near(const Vector& point, double radius) const {
    const auto count = std::ranges::count_if(bodies_, [&](const Body& body) {
      const Vector apart = minus(point, body.place);
      const double most = body.reach + radius;
      return dot(apart, apart) <= most * most && distance(body, point) <= radius;
    });
    return {static_cast<std::uint32_t>(count)};
  }

  bool knows_hulls_;  // there are none
  std::vector<Body> bodies_;
  std::vector<Triangle> terrain_;
};

}  // namespace

std::unique_ptr<QueryEngine> make_reference_engine(const QueryScene& scene) {
  return std::make_unique<ReferenceEngine>(scene);
}

}  // namespace lockstone::bench
