// Contacts of the comparison's bodies, by the core's narrow phase.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <lockstone/testing/floating.h>

#include "core/geometry/distance/manifold.h"
#include "tools/bench/baselines/solvers/system.h"

namespace lockstone::bench::trial {
namespace {

using testing::to_double;

Unit unit_of(double x) {
  return Unit::from_raw(static_cast<std::int32_t>(std::lround(x * (1 << 30))));
}

lockstone::Vec3<Unit> units(const Vec3& v) {
  return {unit_of(v.x), unit_of(v.y), unit_of(v.z)};
}

lockstone::Vec3<Length> lengths(const Vec3& v) {
  const auto one = [](double x) {
    return Length::from_raw(static_cast<std::int32_t>(std::lround(x * (1 << 20))));
  };
  return {one(v.x), one(v.y), one(v.z)};
}

template <class Fixed>
Vec3 real(const lockstone::Vec3<Fixed>& v) {
  return {to_double(v.x), to_double(v.y), to_double(v.z)};
}

// Bounds are around a sphere, except a box's.
struct Bounds {
  Vec3 low, high;
  int body = 0;
};

Bounds bounds_of(const System& system, int index) {
  const Body& body = system.bodies[index];
  const double m = system.margin;
  Vec3 reach{body.radius + m, body.radius + m, body.radius + m};
  if (body.shape.kind == ShapeKind::box) {
    const Vec3 half = real(body.shape.size);
    const Mat3& r = body.axes;
    const auto along = [&](double x, double y, double z) {
      return half.x * std::fabs(x) + half.y * std::fabs(y) + half.z * std::fabs(z) + m;
    };
    reach = {along(r.x.x, r.y.x, r.z.x), along(r.x.y, r.y.y, r.z.y), along(r.x.z, r.y.z, r.z.z)};
  }
  return {body.position - reach, body.position + reach, index};
}

bool meet(const Bounds& a, const Bounds& b) {
  return a.low.y <= b.high.y && b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
}

bool joined(const System& system, int a, int b) {
  return std::ranges::any_of(system.joints, [&](const Joint& j) {
    return (j.a == a && j.b == b) || (j.a == b && j.b == a);
  });
}

class Finder {
 public:
  explicit Finder(System& system) : system_(system), old_(std::move(system.contacts)) {
    system_.contacts.clear();
    for (const Body& body : system_.bodies)
      axes_.push_back({units(body.axes.x), units(body.axes.y), units(body.axes.z)});
  }

  void pair(int a, int b) {
    if (a > b) std::swap(a, b);
    const Body &first = system_.bodies[a], &second = system_.bodies[b];
    if (first.fixed() && second.fixed()) return;
    if (!first.touches_others || !second.touches_others || joined(system_, a, b)) return;
    const Manifold manifold =
        lockstone::collide(posed(a), posed(b), lengths(second.position - first.position),
                           lengths({system_.margin, 0, 0}).x);
    for (int i = 0; i < manifold.count; ++i)
      add(a, b, manifold, manifold.points[i]);
  }

 private:
  PosedShape posed(int body) const {
    const Body& b = system_.bodies[body];
    return {b.shape, axes_[body], b.hull ? b.hull->geometry().polytope() : nullptr};
  }

  void add(int a, int b, const Manifold& manifold, const ManifoldPoint& point) {
    Contact c;
    c.a = a;
    c.b = b;
    c.feature = point.feature;
    c.normal = normalized(real(manifold.normal));
    c.frame = frame_along(c.normal);
    c.separation = to_double(point.separation);
    c.arm_a = real(point.anchor_a);
    c.arm_b = real(point.anchor_b);
    const Body &first = system_.bodies[a], &second = system_.bodies[b];
    c.anchor_a = first.to_local(c.arm_a);
    c.anchor_b = second.to_local(c.arm_b);
    c.rest_separation =
        c.separation - dot(second.position - first.position + c.arm_b - c.arm_a, c.normal);
    c.friction = system_.friction;
    c.restitution = system_.restitution;
    const Vec3 motion =
        second.velocity + cross(second.spin, c.arm_b) - first.velocity - cross(first.spin, c.arm_a);
    c.approach = dot(motion, c.normal);
    inherit(c);
    system_.contacts.push_back(c);
  }

  // Old contacts ascend by pair and feature, too.
  void inherit(Contact& c) const {
    const auto key = [](const Contact& x) { return std::tuple(x.a, x.b, x.feature); };
    const auto found = std::ranges::lower_bound(old_, key(c), {}, key);
    if (found == old_.end() || key(*found) != key(c)) return;
    c.impulse[0] = found->impulse[0];
    c.stiffness = found->stiffness;
    const Vec3 slide = found->impulse[1] * found->frame.y + found->impulse[2] * found->frame.z;
    c.impulse[1] = dot(slide, c.frame.y);
    c.impulse[2] = dot(slide, c.frame.z);
  }

  System& system_;
  std::vector<Contact> old_;
  std::vector<lockstone::Mat3> axes_;
};

}  // namespace

void collide(System& system) {
  Finder finder(system);
  std::vector<Bounds> bounds;
  for (int i = 0; i < static_cast<int>(system.bodies.size()); ++i)
    bounds.push_back(bounds_of(system, i));
  std::ranges::sort(bounds, {}, [](const Bounds& b) { return std::pair(b.low.x, b.body); });
  for (std::size_t i = 0; i < bounds.size(); ++i)
    for (std::size_t k = i + 1; k < bounds.size() && bounds[k].low.x <= bounds[i].high.x; ++k)
      if (meet(bounds[i], bounds[k])) finder.pair(bounds[i].body, bounds[k].body);
  std::ranges::sort(system.contacts, {},
                    [](const Contact& c) { return std::tuple(c.a, c.b, c.feature); });
}

}  // namespace lockstone::bench::trial
