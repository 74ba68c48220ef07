#include "tools/bench/baselines/solvers/system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstone::bench::trial {
namespace {

Length length_of(double metres) {
  return Length::from_raw(static_cast<std::int32_t>(std::lround(metres * (1 << 20))));
}

Vec3 metres(const lockstone::Vec3<Length>& v) {
  constexpr double k_step = 1.0 / (1 << 20);
  return {v.x.raw * k_step, v.y.raw * k_step, v.z.raw * k_step};
}

Mat3 diagonal(double x, double y, double z) {
  return {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
}

// Integrals of 1, x and x xᵀ over a polyhedron, by tetrahedra from the origin.
struct Moments {
  double volume = 0;
  Vec3 first;
  Mat3 second{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double v = dot(a, cross(b, c)) / 6;
    const Vec3 sum = a + b + c;
    volume += v;
    first = first + (v / 4) * sum;
    for (const Vec3& p : {a, b, c, sum}) {
      second.x = second.x + (v / 20 * p.x) * p;
      second.y = second.y + (v / 20 * p.y) * p;
      second.z = second.z + (v / 20 * p.z) * p;
    }
  }
};

Moments moments(const Hull& hull) {
  Moments sum;
  for (int face = 0; face < hull.face_count(); ++face) {
    const std::vector<int> loop = hull.face_vertices(face);
    for (std::size_t i = 2; i < loop.size(); ++i)
      sum.add(metres(hull.vertices()[loop[0]]), metres(hull.vertices()[loop[i - 1]]),
              metres(hull.vertices()[loop[i]]));
  }
  return sum;
}

std::shared_ptr<const Hull> hull_of(const std::vector<Vec3>& points) {
  std::vector<lockstone::Vec3<Length>> places;
  for (const Vec3& p : points)
    places.push_back({length_of(p.x), length_of(p.y), length_of(p.z)});
  return Hull::build(places).hull;
}

int add(System& system, Body& body, const Vec3& position, const Quat& rotation) {
  body.position = position;
  body.rotation = normalized(rotation);
  update(body);
  system.bodies.push_back(std::move(body));
  return static_cast<int>(system.bodies.size()) - 1;
}

}  // namespace

void update(Body& body) {
  body.axes = matrix(body.rotation);
  if (body.fixed()) {
    body.inverse_inertia = diagonal(0, 0, 0);
    return;
  }
  body.inertia = body.axes * body.local_inertia * transposed(body.axes);
  body.inverse_inertia = inverse(body.inertia);
}

int System::add_box(const Vec3& half, const Vec3& position, double density, const Quat& rotation) {
  Body body;
  body.shape = Shape::box(length_of(half.x), length_of(half.y), length_of(half.z));
  body.mass = 8 * half.x * half.y * half.z * density;
  const double xx = half.x * half.x, yy = half.y * half.y, zz = half.z * half.z, m = body.mass / 3;
  body.local_inertia = diagonal(m * (yy + zz), m * (zz + xx), m * (xx + yy));
  body.radius = length(half);
  return add(*this, body, position, rotation);
}

int System::add_sphere(double radius, const Vec3& position, double density) {
  Body body;
  body.shape = Shape::sphere(length_of(radius));
  body.mass = 4 * std::numbers::pi / 3 * radius * radius * radius * density;
  const double moment = 0.4 * body.mass * radius * radius;
  body.local_inertia = diagonal(moment, moment, moment);
  body.radius = radius;
  return add(*this, body, position, {});
}

int System::add_capsule(double half_height, double radius, const Vec3& position, double density,
                        const Quat& rotation) {
  Body body;
  body.shape = Shape::capsule(length_of(half_height), length_of(radius));
  const double rr = radius * radius, hh = 4 * half_height * half_height;
  const double rod = 2 * std::numbers::pi * rr * half_height * density;
  const double ball = 4 * std::numbers::pi / 3 * rr * radius * density;
  body.mass = rod + ball;
  const double along = rr * (rod / 2 + ball * 0.4);
  const double across =
      rod * (hh / 12 + rr / 4) + ball * (0.4 * rr + hh / 4 + 0.75 * radius * half_height);
  body.local_inertia = diagonal(across, along, across);
  body.radius = half_height + radius;
  return add(*this, body, position, rotation);
}

// Points are moved so that the centre of mass is the origin.
int System::add_hull(const std::vector<Vec3>& points, const Vec3& position, double density,
                     const Quat& rotation) {
  const Moments raw = moments(*hull_of(points));
  std::vector<Vec3> centred = points;
  for (Vec3& p : centred)
    p = p - (1 / raw.volume) * raw.first;
  Body body;
  body.hull = hull_of(centred);
  body.shape = Shape{ShapeKind::hull, {}, AssetId{1}};
  const Moments m = moments(*body.hull);
  body.mass = m.volume * density;
  const double trace = m.second.x.x + m.second.y.y + m.second.z.z;
  body.local_inertia = {density * (Vec3{trace, 0, 0} - m.second.x),
                        density * (Vec3{0, trace, 0} - m.second.y),
                        density * (Vec3{0, 0, trace} - m.second.z)};
  for (const Vec3& p : centred)
    body.radius = std::max(body.radius, length(p));
  return add(*this, body, position, rotation);
}

int System::add_ground() {
  return add_box({100, 1, 100}, {0, -1, 0}, 0);
}

void System::set_mass(int index, double mass) {
  Body& body = bodies[index];
  const double ratio = mass / body.mass;
  Mat3& moment = body.local_inertia;
  moment = {ratio * moment.x, ratio * moment.y, ratio * moment.z};
  body.mass = mass;
  update(body);
}

int System::add_joint(JointKind kind, int a, int b, const Vec3& at, const Vec3& axis) {
  Joint joint;
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  const Mat3 frame = frame_along(axis);
  joint.anchor_a = bodies[a].to_local(at - bodies[a].position);
  joint.anchor_b = bodies[b].to_local(at - bodies[b].position);
  joint.frame_a = transposed(bodies[a].axes) * frame;
  joint.frame_b = transposed(bodies[b].axes) * frame;
  joints.push_back(joint);
  return static_cast<int>(joints.size()) - 1;
}

double System::kinetic_energy() const {
  double sum = 0;
  for (const Body& b : bodies)
    if (!b.fixed())
      sum += (b.mass * dot(b.velocity, b.velocity) + dot(b.spin, b.inertia * b.spin)) / 2;
  return sum;
}

double System::energy() const {
  double sum = kinetic_energy();
  for (const Body& b : bodies)
    sum -= b.mass * dot(gravity, b.position);
  return sum;
}

double separation(const System& system, const Contact& c) {
  const Body &a = system.bodies[c.a], &b = system.bodies[c.b];
  const Vec3 apart = b.position - a.position + b.to_world(c.anchor_b) - a.to_world(c.anchor_a);
  return dot(apart, c.normal) + c.rest_separation;
}

void move(Body& body, double h) {
  if (body.fixed()) return;
  const Vec3 momentum = body.inertia * body.spin;
  const double before = dot(momentum, body.spin);
  body.position = body.position + h * body.velocity;
  const Mat3 axes = matrix(normalized(rotation((h / 2) * body.spin) * body.rotation));
  Vec3 middle = axes * (inverse(body.local_inertia) * (transposed(axes) * momentum));
  const double fastest = 2 * length(body.spin), fast = length(middle);
  if (fast > fastest) middle = (fastest / fast) * middle;
  body.rotation = normalized(rotation(h * middle) * body.rotation);
  update(body);
  body.spin = body.inverse_inertia * momentum;
  const double after = dot(momentum, body.spin);
  if (after > before) body.spin = std::sqrt(before / after) * body.spin;
}

}  // namespace lockstone::bench::trial
