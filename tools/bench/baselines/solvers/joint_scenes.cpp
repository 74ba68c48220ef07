#include <cmath>
#include <numbers>

#include "tools/bench/baselines/solvers/scenes.h"

namespace lockstone::bench::trial {
namespace {

int fixed_body(System& s) {
  const int body = s.add_box({0.1, 0.1, 0.1}, {0, 50, 0}, 0);
  s.bodies[body].touches_others = false;
  return body;
}

int link(System& s, const Vec3& half, const Vec3& at, double mass, const Quat& turn = {}) {
  const int body = s.add_box(half, at, 1000, turn);
  s.set_mass(body, mass);
  s.bodies[body].touches_others = false;
  return body;
}

void span(Scene& scene, Random&, double count) {
  System& s = scene.system;
  int last = fixed_body(s);
  for (int i = 0; i < count; ++i) {
    const int plank = link(s, {0.19, 0.04, 0.2}, {0.4 * i + 0.2, 0, 0}, 7.3);
    s.add_joint(JointKind::ball, last, plank, {0.4 * i, 0, 0});
    last = plank;
  }
  s.add_joint(JointKind::ball, last, 0, {0.4 * count, 0, 0});
}

void ring(Scene& scene, Random& r, double count) {
  System& s = scene.system;
  const int anchor = fixed_body(s);
  const double radius = count * 0.2 / (2 * std::numbers::pi);
  std::vector<int> links;
  const auto at = [&](double i, double far) {
    const double angle = std::numbers::pi * (0.5 + 2 * i / count);
    return Vec3{far * std::cos(angle), far * std::sin(angle), 0};
  };
  for (int i = 0; i < count; ++i)
    links.push_back(link(s, {0.03, 0.09, 0.03}, at(i, radius), 0.65,
                         rotation({0, 0, std::numbers::pi * (0.5 + 2 * i / count)})));
  for (int i = 0; i < count; ++i)
    s.add_joint(JointKind::hinge, links[i], links[(i + 1) % links.size()],
                at(i + 0.5, radius / std::cos(std::numbers::pi / count)));
  s.add_joint(JointKind::ball, anchor, links[0], {0, radius, 0});
  s.gravity.x = r(.1, .5);
}

void net(Scene& scene, double size, JointKind kind) {
  System& s = scene.system;
  const int anchor = fixed_body(s), n = static_cast<int>(size);
  for (int i = 0; i < n * n; ++i)
    link(s, {0.12, 0.02, 0.12}, {0.3 * (i % n), 0, 0.3 * (i / n)}, 1.4);
  const auto plate = [&](int x, int z) { return anchor + 1 + z * n + x; };
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) {
      if (x + 1 < n) s.add_joint(kind, plate(x, z), plate(x + 1, z), {0.3 * x + 0.15, 0, 0.3 * z});
      if (z + 1 < n)
        s.add_joint(kind, plate(x, z), plate(x, z + 1), {0.3 * x, 0, 0.3 * z + 0.15}, {1, 0, 0});
    }
  s.add_joint(JointKind::ball, anchor, plate(0, 0), {-.12, 0, -.12});
  s.add_joint(JointKind::ball, anchor, plate(n - 1, 0), {0.3 * (n - 1) + .12, 0, -.12});
}

void ball_net(Scene& scene, Random&, double size) {
  net(scene, size, JointKind::ball);
}
void hinge_net(Scene& scene, Random&, double size) {
  net(scene, size, JointKind::hinge);
}

void chain(Scene& scene, double count, double ratio) {
  System& s = scene.system;
  int last = fixed_body(s);
  for (int i = 0; i < count; ++i) {
    const int next = link(s, {0.5, 0.05, 0.05}, {i + 0.5, 0, 0}, i + 1 < count ? 1 : ratio);
    s.add_joint(JointKind::ball, last, next, {1.0 * i, 0, 0});
    last = next;
  }
}

void chain_100(Scene& scene, Random&, double count) {
  chain(scene, count, 100);
}
void chain_5000(Scene& scene, Random&, double count) {
  chain(scene, count, 5000);
}

void pendulum(Scene& scene, Random&, double count) {
  System& s = scene.system;
  int last = fixed_body(s);
  for (int i = 0; i < count; ++i) {
    const int next = link(s, {0.5, 0.05, 0.05}, {i + 0.5, 0, 0}, 1);
    s.add_joint(JointKind::hinge, last, next, {1.0 * i, 0, 0});
    last = next;
  }
}

void crank(Scene& scene, Random&, double speed) {
  System& s = scene.system;
  const int anchor = fixed_body(s);
  const int arm = link(s, {0.1, 0.025, 0.025}, {.1, 0, 0}, 1);
  const int rod = link(s, {0.35, 0.025, 0.025}, {.55, 0, 0}, 1);
  const int block = link(s, {0.075, 0.075, 0.075}, {.9, 0, 0}, 2);
  scene.motor = s.add_joint(JointKind::hinge, anchor, arm, {});
  s.joints[scene.motor].motor = true;
  s.joints[scene.motor].speed = speed;
  s.add_joint(JointKind::hinge, arm, rod, {.2, 0, 0});
  s.add_joint(JointKind::hinge, rod, block, {.9, 0, 0});
  s.add_joint(JointKind::slider, anchor, block, {.9, 0, 0}, {1, 0, 0});
  scene.powered = true;
}

void bridge(Scene& scene, Random& r, double count) {
  System& s = scene.system;
  s.add_ground();
  const int anchor = fixed_body(s);
  int last = anchor;
  for (int i = 0; i < count; ++i) {
    const int plank = s.add_box({0.19, 0.04, 0.4}, {0.4 * i + 0.2, 3, 0}, 600);
    s.add_joint(JointKind::hinge, last, plank, {0.4 * i, 3, 0});
    last = plank;
  }
  s.add_joint(JointKind::hinge, last, anchor, {0.4 * count, 3, 0});
  for (int i = 0; i < count / 2; ++i)
    s.add_box({0.15, 0.15, 0.15}, {0.8 * i + 0.4 + r(-.1, .1), 3.3, r(-.1, .1)}, 600,
              rotation({0, r(-1, 1), 0}));
}

void set_limits(Joint& joint, double lower, double upper) {
  joint.limited = true;
  joint.lower = lower;
  joint.upper = upper;
}

// Trunk, head, and two arms and legs of two parts each.
void ragdoll(System& s, const Vec3& at, const Quat& turn) {
  const auto part = [&](const Vec3& p, double half, double radius) {
    return s.add_capsule(half, radius, at + matrix(turn) * p, 1000, turn);
  };
  const auto joint = [&](JointKind kind, int a, int b, const Vec3& p) {
    const int j = s.add_joint(kind, a, b, at + matrix(turn) * p, matrix(turn) * Vec3{0, 0, 1});
    if (kind == JointKind::hinge) set_limits(s.joints[j], -2, 0.1);
  };
  const int trunk = s.add_box({0.15, 0.25, 0.1}, at, 1000, turn);
  const int head = s.add_sphere(0.1, at + matrix(turn) * Vec3{0, 0.38, 0}, 1000);
  joint(JointKind::ball, trunk, head, {0, 0.27, 0});
  for (const double side : {-1.0, 1.0}) {
    const int arm = part({side * 0.21, 0.08, 0}, 0.1, 0.04);
    const int hand = part({side * 0.21, -0.2, 0}, 0.1, 0.035);
    const int thigh = part({side * 0.09, -0.45, 0}, 0.13, 0.06);
    const int shin = part({side * 0.09, -0.82, 0}, 0.13, 0.05);
    joint(JointKind::ball, trunk, arm, {side * 0.21, 0.2, 0});
    joint(JointKind::hinge, arm, hand, {side * 0.21, -0.06, 0});
    joint(JointKind::ball, trunk, thigh, {side * 0.09, -0.27, 0});
    joint(JointKind::hinge, thigh, shin, {side * 0.09, -0.64, 0});
  }
}

void ragdolls(Scene& scene, Random& r, double count) {
  System& s = scene.system;
  s.add_ground();
  for (int i = 0; i < count; ++i)
    ragdoll(s, {0.3 * (i % 2) + r(-.05, .05), 1.3 + 1.1 * i, r(-.05, .05)},
            rotation({r(-2, 2), r(-2, 2), r(-2, 2)}));
  scene.stands = false;
}

void jointed_heap(Scene& scene, Random& r, double count) {
  System& s = scene.system;
  s.add_ground();
  for (int i = 0; i < count; ++i) {
    const Vec3 at{0.7 * (i % 4), 0.3 + 0.4 * (i / 16), 0.5 * (i / 4 % 4)};
    const int a = s.add_box({0.12, 0.1, 0.1}, at + Vec3{-.13, 0, r(-.02, .02)}, 1000);
    const int b = s.add_box({0.12, 0.1, 0.1}, at + Vec3{.13, 0, r(-.02, .02)}, 1000);
    const JointKind kinds[] = {JointKind::ball, JointKind::hinge, JointKind::slider,
                               JointKind::weld};
    const int j = s.add_joint(kinds[i % 4], a, b, at,
                              kinds[i % 4] == JointKind::slider ? Vec3{1, 0, 0} : Vec3{0, 0, 1});
    if (kinds[i % 4] == JointKind::slider) set_limits(s.joints[j], 0, 0.1);
  }
  scene.stands = false;
}

// A light pair of wheels under a heavy box, on hinges, at rest.
void uneven_pair(Scene& scene, Random& r, double ratio) {
  System& s = scene.system;
  s.add_ground();
  const int load = s.add_box({0.5, 0.2, 0.3}, {0, 0.75, 0}, 1000);
  for (const double x : {-.4, .4}) {
    const int leg = s.add_box({0.05, 0.25, 0.25}, {x, 0.25, 0}, 1000);
    s.set_mass(leg, s.bodies[load].mass / ratio);
    const int j = s.add_joint(JointKind::hinge, load, leg, {x, 0.5, 0});
    s.joints[j].spring_rate = 40 + r(0, 20);
    s.joints[j].spring_damping = 1;
  }
}

}  // namespace

const std::vector<Family>& joint_families() {
  static const std::vector<Family> list{
      {"span", span, {2, 10, 20}},    {"ring", ring, {4, 8, 16, 24}},
      {"ball-net", ball_net, {3, 5}}, {"hinge-net", hinge_net, {3, 5}},
      {"chain-100", chain_100, {10}}, {"chain-5000", chain_5000, {5, 30}},
      {"pendulum", pendulum, {1, 2}}, {"crank", crank, {2, 6}},
  };
  return list;
}

const std::vector<Family>& mixed_families() {
  static const std::vector<Family> list{
      {"bridge", bridge, {6, 12, 40}},
      {"ragdolls", ragdolls, {1, 4, 12}},
      {"jointed-heap", jointed_heap, {8, 32}},
      {"uneven-pair", uneven_pair, {10, 1000}},
  };
  return list;
}

}  // namespace lockstone::bench::trial
