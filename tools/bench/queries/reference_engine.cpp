// Answers in double by asking every body: slow, plain, and the judge of the others.

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

bool is_known(const QueryBody& body) {
  return is_primitive(body.shape.kind);
}

class ReferenceEngine final : public QueryEngine {
 public:
  explicit ReferenceEngine(const QueryScene& scene) {
    for (const QueryBody& body : scene.bodies)
      bodies_.push_back(body_of(body));
  }

  [[nodiscard]] std::string name() const override { return "double"; }

  bool answer(const QueryRow& row, std::span<QueryAnswer> out) override {
    if (row.kind == QueryKind::overlap && row.shape.kind != ShapeKind::sphere) return false;
    for (std::size_t i = 0; i < row.size(); ++i)
      out[i] = answer_one(row, i);
    return true;
  }

 private:
  QueryAnswer answer_one(const QueryRow& row, std::size_t i) const {
    if (row.kind == QueryKind::point) return near(vector(row.rays[i].origin), 0);
    if (row.kind == QueryKind::near_point)
      return nearest(vector(row.rays[i].origin), testing::to_double(row.reach));
    if (row.kind == QueryKind::overlap)
      return near(vector(row.poses[i].position), testing::to_double(row.shape.size.x));
    QueryAnswer answer = along(vector(row.rays[i].origin), vector(row.rays[i].translation));
    if (row.kind != QueryKind::all_rays) answer.count = std::min(answer.count, 1U);
    if (row.kind != QueryKind::closest_ray) answer.body = k_no_body;
    return answer;
  }

  QueryAnswer along(const Vector& origin, const Vector& way) const {
    QueryAnswer answer;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Entry entry = enter(bodies_[i], origin, way);
      if (!entry) continue;
      ++answer.count;
      if (answer.body != k_no_body && *entry >= answer.where) continue;
      answer.body = static_cast<std::uint32_t>(i);
      answer.where = *entry;
    }
    return answer;
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

  std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<QueryEngine> make_reference_engine(const QueryScene& scene) {
  if (!std::ranges::all_of(scene.bodies, is_known)) return nullptr;
  return std::make_unique<ReferenceEngine>(scene);
}

}  // namespace lockstone::bench
