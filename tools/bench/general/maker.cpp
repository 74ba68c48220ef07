#include "tools/bench/general/maker.h"

#include <algorithm>
#include <numbers>

namespace lockstone::bench {

using namespace general;

std::uint64_t SceneRandom::bits() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double SceneRandom::between(double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(bits() >> 11), -53);
}

double SceneRandom::log_between(double low, double high) {
  return low * std::exp(between(0, std::log(high / low)));
}

int SceneRandom::count(int low, int high) {
  return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
}

SceneMaker::SceneMaker(std::string_view family, std::uint64_t seed, int cap)
    : random(seed), cap_(cap) {
  scene.family = family;
  scene.seed = seed;
}

int SceneMaker::count(int low, int high) {
  return std::min(random.count(low, high), std::max(low, cap_));
}

Triple SceneMaker::direction() {
  const double y = random.between(-1, 1), angle = random.between(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

Triple SceneMaker::jitter(double size) {
  const double x = random.between(-size, size), y = random.between(-size, size);
  return {x, y, random.between(-size, size)};
}

Turn SceneMaker::any_turn() {
  const Triple axis = direction();
  return turn_about(axis, random.between(0, std::numbers::pi));
}

int SceneMaker::add(GeneralBody body) {
  scene.bodies.push_back(std::move(body));
  return static_cast<int>(scene.bodies.size()) - 1;
}

int SceneMaker::box(const Triple& half_extents, const Triple& at, double density) {
  GeneralBody body;
  body.size = half_extents;
  body.position = at;
  body.density = density;
  return add(body);
}

int SceneMaker::ball(double radius, const Triple& at, double density) {
  const int index = box({radius, radius, radius}, at, density);
  body(index).form = Form::sphere;
  return index;
}

int SceneMaker::capsule(double radius, double half_core, const Triple& at, double density) {
  const int index = box({radius, half_core, 0}, at, density);
  body(index).form = Form::capsule;
  return index;
}

int SceneMaker::hull(std::vector<Triple> points, const Triple& at, double density) {
  const int index = box({0, 0, 0}, at, density);
  body(index).form = Form::hull;
  body(index).points = std::move(points);
  return index;
}

int SceneMaker::ground() {
  const int index = box({100, 1, 100}, {0, -1, 0});
  fix(index);
  return index;
}

int SceneMaker::anchor(const Triple& at) {
  const int index = ball(0.05, at);
  fix(index);
  body(index).collides = false;
  return index;
}

void SceneMaker::set_friction(double friction) {
  for (GeneralBody& body : scene.bodies)
    body.friction = friction;
}

// As far as its density goes: a world has no more than 8.3e6 kg/m³.
void SceneMaker::set_mass(int index, double mass) {
  constexpr double k_most_density = 8.3e6;
  double& density = body(index).density;
  density = std::min(density * (mass / mass_of(body(index))), k_most_density);
}

GeneralJoint& SceneMaker::join(Link link, int a, int b, const Triple& at, const Triple& axis) {
  GeneralJoint joint;
  joint.link = link;
  joint.a = a;
  joint.b = b;
  const Turn frame = turn_from_x((1 / norm(axis)) * axis);
  const Turn from_a = inverse(body(a).orientation), from_b = inverse(body(b).orientation);
  joint.anchor_a = turned(from_a, at - body(a).position);
  joint.anchor_b = turned(from_b, at - body(b).position);
  joint.frame_a = from_a * frame;
  joint.frame_b = from_b * frame;
  return scene.joints.emplace_back(joint);
}

GeneralJoint& SceneMaker::rod(int a, int b, const Triple& at_a, const Triple& at_b) {
  GeneralJoint& joint = join(Link::rod, a, b, at_a);
  joint.anchor_b = turned(inverse(body(b).orientation), at_b - body(b).position);
  joint.target = norm(at_b - at_a);
  return joint;
}

void SceneMaker::judge(Judge judge, double bound, double seconds) {
  scene.judge = judge;
  scene.bound = bound;
  scene.ticks = static_cast<int>(std::lround(60 * seconds));
}

int any_body(SceneMaker& m, double size, const Triple& at, double density) {
  const auto part = [&] { return size * m.random.between(0.3, 1); };
  const int kind = m.random.count(0, 2);
  if (kind == 0) return m.ball(part(), at, density);
  if (kind == 1) {
    const double radius = 0.5 * part();
    return m.capsule(radius, part(), at, density);
  }
  const double x = part(), y = part();
  return m.box({x, y, part()}, at, density);
}

Triple cell(int i, int side, double pitch) {
  const int layer = i / (side * side), place = i % (side * side);
  const double middle = 0.5 * (side - 1);
  return {pitch * (place % side - middle), pitch * (layer + 0.5), pitch * (place / side - middle)};
}

GeneralPart slab(const Triple& half, const Triple& at, const Turn& turn) {
  GeneralPart part;
  part.size = half;
  part.position = at;
  part.orientation = turn;
  return part;
}

void pen(SceneMaker& m, double half, double high) {
  for (const double side : {-1.0, 1.0}) {
    m.fix(m.box({0.5, high, half + 1}, {side * (half + 0.5), high, 0}));
    m.fix(m.box({half + 1, high, 0.5}, {0, high, side * (half + 0.5)}));
  }
}

void heap(SceneMaker& m, double seconds) {
  m.scene.may_sleep = m.scene.must_rest = true;
  m.judge(Judge::awake, 0, seconds);
}

}  // namespace lockstone::bench
