// Row 39: homogeneous convex bodies that rest in one way only. A gömböc with one unstable
// equilibrium too (G. Domokos, P. Várkonyi, 2006) is within a ten-thousandth of a sphere's evenness
// and out of reach of hulls of a few dozen corners. With one stable equilibrium and several
// unstable ones, on which nothing stays, there is the obliquely truncated spiral prism (J. Conway,
// R. Guy, "Stability of polyhedra", 1969): here with 23 sides for their 17, so that it tips by 1.6
// degrees more than it must from each side to the next.
#include <algorithm>
#include <array>

#include <lockstone/compound.h>
#include <lockstone/hull.h>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/fuzz/dice.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr int k_half_sides = 12;     // sides at 0, ±15, … ±165 degrees from the lowest
constexpr double k_ratio = 0.95852;  // of the distances of sides from the centre; below cos 15°
constexpr double k_length = 13;      // in distances of the lowest side
constexpr double k_size = 0.1;       // metres, of that

struct Flat {
  double x = 0, y = 0;
};

// The corners where neighbouring sides meet. Side i is cos⁻¹ … as far: k_ratio^-|i|.
std::vector<Flat> cross_section() {
  const double step = std::numbers::pi / k_half_sides;
  const auto distance = [](int side) { return std::pow(k_ratio, -std::abs(side)); };
  std::vector<Flat> corners;
  for (int side = 1 - k_half_sides; side < k_half_sides; ++side) {
    const int next = side + 1 < k_half_sides ? side + 1 : 1 - k_half_sides;
    const Flat n{std::sin(side * step), -std::cos(side * step)};
    const Flat m{std::sin(next * step), -std::cos(next * step)};
    const double cross = n.x * m.y - n.y * m.x;
    corners.push_back({(distance(side) * m.y - distance(next) * n.y) / cross,
                       (distance(next) * n.x - distance(side) * m.x) / cross});
  }
  return corners;
}

// How much shorter the prism gets with height, so that its centre of mass is at y = 0: where S is
// the first and I the second moment of the section about y = 0, S − 2tI = 0.
double slant_of(const std::vector<Flat>& section) {
  double first = 0, second = 0;
  for (std::size_t i = 0; i < section.size(); ++i) {
    const Flat a = section[i], b = section[(i + 1) % section.size()];
    const double cross = a.x * b.y - b.x * a.y;
    first += cross * (a.y + b.y) / 6;
    second += cross * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
  }
  return first / (2 * second);
}

AssetPtr make_body() {
  const std::vector<Flat> section = cross_section();
  const double slant = slant_of(section);
  std::vector<Vec3<Length>> points;
  for (const Flat& at : section) {
    const double half = k_length / 2 * (1 - 2 * slant * at.y);
    for (const double z : {-half, half})
      points.push_back(fixed<Length>(at.x * k_size, at.y * k_size, z * k_size));
  }
  return Hull::build(points).hull;
}

// A sphere with a ball of lead low in it: one stable and one unstable equilibrium, not homogeneous.
AssetPtr make_tumbler() {
  std::array<CompoundChild, 2> parts;
  parts[0].shape = Shape::sphere(0.2_m);
  parts[1].shape = Shape::sphere(0.05_m);
  parts[1].position.y = -0.1_m;
  parts[1].density = Number::from_integer(40);
  return Compound::build(parts).compound;
}

// Degrees between the body's own downward direction and the world's, once it rests.
double leaning(SceneRun& scene, const AssetPtr& asset, const fuzz::Real3& random, double turn) {
  scene.add(ground());
  BodyDef def = body_at(asset->shape(), 0, 1, 0);
  def.orientation = normalized(fuzz::to_quat(random, turn));
  def.linear_damping = def.angular_damping = fixed<Rate>(0.7);
  const BodyHandle body = scene.add(def);
  scene.run(40);
  const Vec3<Unit> up = to_matrix(scene.world().body(body).orientation).y;
  return std::acos(std::clamp(std::ldexp(up.y.raw, -30), -1.0, 1.0)) / k_degree;
}

AccuracyResult rests(const Setting& setting, const AssetPtr& asset, const char* name,
                     std::uint64_t seed) {
  constexpr int k_tries = 100;
  const auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{asset});
  SceneRun scene(setting, contact_world(), assets);
  fuzz::Dice dice(seed, 39);
  int wrong = 0;
  double worst = 0;
  for (int i = 0; i < k_tries; ++i) {
    scene = SceneRun(setting, contact_world(), assets);
    const fuzz::Real3 axis = dice.in_cube(1);
    const double turn = dice.in_cube(1).x;
    const double off = leaning(scene, asset, axis, turn);
    wrong += off > 1 ? 1 : 0;
    worst = std::max(worst, off);
  }
  AccuracyResult result = scene.result(name, "wrong", wrong, 0);
  result.tries = k_tries;
  result.note = "worst leans by " + std::to_string(worst) + " degrees";
  return result;
}

}  // namespace

std::vector<AccuracyResult> measure_monostable(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](const AssetPtr& asset, const char* name) {
    for (AccuracyResult& result : at_settings(options, [&](const Setting& setting) {
           return rests(setting, asset, name, options.seed);
         }))
      results.push_back(std::move(result));
  };
  add(make_body(), "Conway and Guy's prism, 25 faces, homogeneous");
  add(make_tumbler(), "a ball with lead in it");
  return results;
}

}  // namespace lockstone::bench
