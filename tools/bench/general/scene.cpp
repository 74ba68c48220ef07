#include "tools/bench/general/scene.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {

using namespace general;

namespace {

// Another machine's sine and logarithm differ by far less than this.
double settled(double x) {
  return std::ldexp(std::round(std::ldexp(x, 26)), -26);
}
template <std::size_t N>
void settle(std::array<double, N>& values) {
  for (double& x : values)
    x = settled(x);
}

void settle(GeneralScene& scene) {
  for (GeneralBody& body : scene.bodies) {
    settle(body.size);
    settle(body.position);
    settle(body.orientation);
    settle(body.velocity);
    settle(body.angular_velocity);
    settle(body.surface);
    body.density = settled(body.density);
    body.friction = settled(body.friction);
    body.restitution = settled(body.restitution);
    for (Triple& point : body.points)
      settle(point);
    for (GeneralPart& part : body.parts) {
      settle(part.size);
      settle(part.position);
      settle(part.orientation);
    }
  }
  for (GeneralJoint& joint : scene.joints) {
    settle(joint.anchor_a);
    settle(joint.anchor_b);
    settle(joint.frame_a);
    settle(joint.frame_b);
    for (double* x : {&joint.lower, &joint.upper, &joint.speed, &joint.effort, &joint.target,
                      &joint.hertz, &joint.damping})
      *x = settled(*x);
    settle(joint.turn);
  }
  for (GeneralMove& move : scene.moves) {
    settle(move.velocity);
    settle(move.angular_velocity);
  }
  for (GeneralPull& pull : scene.pulls)
    settle(pull.gravity);
}

void watch_all(GeneralScene& scene) {
  if (!scene.watched.empty()) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].moves()) scene.watched.push_back(static_cast<int>(i));
}

class Bytes {
 public:
  void add(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (int i = 0; i < 8; ++i)
      bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& values) {
    for (const T x : values)
      add(x);
  }
  template <class T>
  requires(std::is_integral_v<T> || std::is_enum_v<T>) void add(T x) {
    add(static_cast<double>(x));
  }
  template <class... T>
  void all(const T&... values) {
    (add(values), ...);
  }
  std::vector<std::uint8_t> bytes;
};

}  // namespace

const std::vector<Family>& families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> list;
    add_loop_families(list);
    add_drive_families(list);
    add_stack_families(list);
    add_wall_families(list);
    add_friction_families(list);
    add_impact_families(list);
    add_handling_families(list);
    add_motion_families(list);
    add_rest_families(list);
    add_machine_families(list);
    add_furniture_families(list);
    add_jumble_families(list);
    add_event_families(list);
    add_driven_families(list);
    add_strike_families(list);
    add_shape_families(list);
    return list;
  }();
  return all;
}

const Family* find_family(std::string_view name) {
  for (const std::vector<Family>* all : {&families(), &single_islands()}) {
    const auto found = std::ranges::find(*all, name, &Family::name);
    if (found != all->end()) return &*found;
  }
  return nullptr;
}

GeneralScene make_scene(const Family& family, std::uint64_t seed, int cap) {
  SceneMaker maker(family.name, seed, cap);
  family.fill(maker);
  settle(maker.scene);
  watch_all(maker.scene);
  return std::move(maker.scene);
}

std::vector<GeneralChange> changes_of(const GeneralScene& scene) {
  std::vector<GeneralChange> changes(static_cast<std::size_t>(scene.ticks) + 1);
  const auto at = [&](int tick) { return &changes[static_cast<std::size_t>(tick)]; };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const GeneralBody& body = scene.bodies[i];
    if (body.from <= scene.ticks) at(body.from)->come.push_back(static_cast<int>(i));
    if (body.until <= scene.ticks) at(body.until)->gone.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const GeneralJoint& joint = scene.joints[i];
    const int from = std::max(scene.bodies[static_cast<std::size_t>(joint.a)].from,
                              scene.bodies[static_cast<std::size_t>(joint.b)].from);
    if (from <= scene.ticks) at(from)->joints.push_back(static_cast<int>(i));
  }
  return changes;
}

std::vector<std::uint8_t> bytes_of(const GeneralScene& scene) {
  Bytes out;
  out.all(scene.seed, scene.ticks, scene.gravity, scene.may_sleep, scene.passive, scene.must_rest,
          scene.judge, scene.bound, scene.expected, scene.bodies.size(), scene.joints.size());
  for (const int body : scene.watched)
    out.add(body);
  for (const GeneralBody& b : scene.bodies) {
    out.all(b.form, b.motion, b.from, b.until, b.size, b.position, b.orientation, b.velocity,
            b.angular_velocity, b.surface, b.density, b.friction, b.restitution, b.collides,
            b.trigger, b.bullet);
    for (const Triple& point : b.points)
      out.add(point);
    for (const auto& triangle : b.triangles)
      out.add(triangle);
    for (const GeneralPart& part : b.parts)
      out.all(part.form, part.size, part.position, part.orientation);
  }
  for (const GeneralJoint& j : scene.joints)
    out.all(j.link, j.a, j.b, j.anchor_a, j.anchor_b, j.frame_a, j.frame_b, j.limited, j.lower,
            j.upper, j.cone, j.speed, j.effort, j.target, j.hertz, j.damping, j.turn);
  for (const GeneralMove& m : scene.moves)
    out.all(m.tick, m.body, m.velocity, m.angular_velocity);
  for (const GeneralPull& p : scene.pulls)
    out.all(p.tick, p.gravity);
  return std::move(out.bytes);
}

namespace {

Triple extent_of(const GeneralShape& body) {
  Triple low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Triple& point : body.points) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  }
  return 0.5 * (high - low);
}

double volume_of_shape(const GeneralShape& body) {
  constexpr double pi = std::numbers::pi;
  const Triple& s = body.size;
  switch (body.form) {
    case Form::sphere:
      return 4 * pi / 3 * s[0] * s[0] * s[0];
    case Form::capsule:
      return pi * s[0] * s[0] * (4 * s[0] / 3 + 2 * s[1]);
    case Form::box:
      return 8 * s[0] * s[1] * s[2];
    case Form::hull:
    case Form::mesh:
    case Form::compound:
      break;
  }
  const Triple half = extent_of(body);
  return 4 * half[0] * half[1] * half[2];  // about half of the box
}

}  // namespace

double volume_of(const GeneralBody& body) {
  if (body.form != Form::compound) return volume_of_shape(body);
  double sum = 0;
  for (const GeneralPart& part : body.parts)
    sum += volume_of_shape(part);
  return sum;
}

double mass_of(const GeneralBody& body) {
  return body.density * volume_of(body);
}

Triple moments_of(const GeneralBody& body) {
  const double m = mass_of(body);
  Triple s = body.size;
  if (body.form == Form::sphere)
    return {0.4 * m * s[0] * s[0], 0.4 * m * s[0] * s[0], 0.4 * m * s[0] * s[0]};
  if (body.form == Form::capsule) {
    const double r = s[0], h = s[1], balls = m * (4 * r / 3) / (4 * r / 3 + 2 * h), rod = m - balls;
    const double along = rod * r * r / 2 + balls * 0.4 * r * r;
    const double across =
        rod * (r * r / 4 + h * h / 3) + balls * (0.4 * r * r + h * h + 0.75 * h * r);
    return {across, along, across};
  }
  if (body.form == Form::hull) s = 0.8 * extent_of(body);
  return {m / 3 * (s[1] * s[1] + s[2] * s[2]), m / 3 * (s[2] * s[2] + s[0] * s[0]),
          m / 3 * (s[0] * s[0] + s[1] * s[1])};
}

}  // namespace lockstone::bench
