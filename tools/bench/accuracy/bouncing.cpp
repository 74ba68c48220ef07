// Rows 12, 13, 14, 21, 31, 33 and 37: restitution, momentum and energy.
#include <algorithm>
#include <array>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/fuzz/dice.h"

namespace lockstone::bench {
namespace {

using namespace literals;

BodyDef elastic_ball(double radius, double x, double y, double z, Coefficient restitution) {
  BodyDef def = body_at(Shape::sphere(fixed<Length>(radius)), x, y, z);
  def.material.restitution = restitution;
  return def;
}

// How high a ball will rise from here, or has fallen from: h + v²/2g above its radius.
double height_of(const World& world, BodyHandle ball, double radius) {
  const double v = fuzz::real(world.velocity(ball).y);
  return fuzz::real(world.position(ball).y) - radius + v * v / (2 * k_gravity);
}

// The heights that a ball keeps after each of its bounces, and the times of these, s.
struct Bounces {
  std::vector<double> heights, times;
};

Bounces drop(SceneRun& scene, double radius, double from, Coefficient restitution, double seconds) {
  scene.add(ground());
  const BodyHandle ball = scene.add(elastic_ball(radius, 0, from + radius, 0, restitution));
  Bounces bounces;
  double before = 0;
  const int ticks = static_cast<int>(std::lround(seconds * scene.setting().tick_rate));
  for (int tick = 1; tick <= ticks; ++tick) {
    scene.step();
    const double v = fuzz::real(scene.world().velocity(ball).y);
    if (v > 0 && before <= 0) {
      bounces.heights.push_back(height_of(scene.world(), ball, radius));
      bounces.times.push_back(static_cast<double>(tick) / scene.setting().tick_rate);
    }
    before = v;
  }
  bounces.heights.push_back(height_of(scene.world(), ball, radius));
  return bounces;
}

AccuracyResult apex(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  const Bounces bounces = drop(scene, 0.25, 1, 0.8_r, 0.6);
  return scene.result("first apex", "m", std::abs(bounces.heights.front() - 0.64), 5e-4);
}

AccuracyResult twenty_bounces(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  const Bounces bounces = drop(scene, 0.25, 1, 1_r, 18.2);
  AccuracyResult result = scene.result("energy after 20 bounces", "relative",
                                       std::abs(bounces.heights.back() - 1), 1e-2);
  result.note = std::to_string(bounces.times.size()) + " bounces";
  return result;
}

// When a ball keeps less than a millimetre: at its seventh bounce.
double time_to_rest(SceneRun& scene) {
  scene.add(ground());
  const BodyHandle ball = scene.add(elastic_ball(0.25, 0, 5.25, 0, 0.5_r));
  for (int tick = 1; tick <= 300; ++tick) {
    scene.step();
    if (height_of(scene.world(), ball, 0.25) < 1e-3)
      return static_cast<double>(tick) / scene.setting().tick_rate;
  }
  return 1e9;
}

AccuracyResult rest(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  const double fall = std::sqrt(2 * 5 / k_gravity);
  double expected = fall;
  for (int n = 1; n < 7; ++n)
    expected += 2 * fall * std::ldexp(1.0, -n);
  const double error = std::abs(time_to_rest(scene) - expected) * setting.tick_rate;
  return scene.result("time to rest", "ticks", error, 1);
}

AccuracyResult peaks(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  const Bounces bounces = drop(scene, 0.25, 5, 0.5_r, 3);
  double worst = bounces.heights.size() < 5 ? 1 : 0;
  for (std::size_t n = 0; n < std::min<std::size_t>(bounces.heights.size(), 5); ++n) {
    const double expected = 5 * std::ldexp(1.0, -2 * static_cast<int>(n + 1));
    worst = std::max(worst, std::abs(bounces.heights[n] / expected - 1));
  }
  return scene.result("peaks 1 to 5", "relative", worst, 5e-3);
}

WorldDef weightless(std::uint32_t bodies) {
  WorldDef def = contact_world(bodies);
  def.gravity = {};
  return def;
}

std::vector<AccuracyResult> cradle(const Setting& setting, double away) {
  SceneRun scene(setting, weightless(8));
  std::vector<BodyHandle> balls;
  for (int i = 0; i < 5; ++i) {
    BodyDef def = elastic_ball(0.25, 0.5 * i - (i == 0 ? away : 0), 0, 0, 1_r);
    def.material.friction = {};
    if (i == 0) def.velocity.x = 1_mps;
    balls.push_back(scene.add(def));
  }
  scene.run(2);
  Velocity sum;
  for (const BodyHandle ball : balls)
    sum += scene.world().velocity(ball).x;
  const double last = fuzz::real(scene.world().velocity(balls.back()).x);
  const std::string from = away > 0 ? "from afar" : "touching";
  return {scene.result("last ball, " + from, "1 - v", 1 - last, 0.01),
          scene.result("momentum, " + from, "m/s", std::abs(fuzz::real(sum) - 1), 0)};
}

struct Sums {
  fuzz::Real3 momentum, angular;  // per mass, of equal spheres
  double energy = 0, size = 0;
};

Sums sums_of(const World& world, double radius) {
  Sums sums;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyView body = world.body(world.body_at(i));
    const fuzz::Real3 v = fuzz::real(body.velocity), w = fuzz::real(body.angular_velocity);
    const double inertia = 0.4 * radius * radius;
    sums.momentum = sums.momentum + v;
    sums.angular = sums.angular + fuzz::cross(fuzz::real(body.position), v) + w * inertia;
    sums.energy += (fuzz::dot(v, v) + inertia * fuzz::dot(w, w)) / 2;
    sums.size += fuzz::norm(v);
  }
  return sums;
}

// A cloud of equal spheres that flies together; mirrored: x ↔ −x.
void add_cloud(SceneRun& scene, int edge, double radius, const BodyDef& like, bool mirrored,
               std::uint64_t seed) {
  fuzz::Dice dice(seed, 0);
  for (int i = 0; i < edge * edge * edge; ++i) {
    const auto coordinate = [&](int n) { return (n - (edge - 1) / 2.0) * 4 * radius; };
    BodyDef def = like;
    def.position = fixed<Position>(coordinate(i % edge), coordinate(i / edge % edge),
                                   coordinate(i / edge / edge));
    const fuzz::Real3 swirl = dice.in_cube(1), home = fuzz::real(def.position) * -0.3;
    def.velocity = fixed<Velocity>(home.x + swirl.x, home.y + swirl.y, home.z + swirl.z);
    if (mirrored) {
      def.position.x = -def.position.x;
      def.velocity.x = -def.velocity.x;
    }
    scene.add(def);
  }
}

bool are_mirror_images(const World& a, const World& b) {
  for (std::uint32_t i = 0; i < a.body_limit(); ++i) {
    const BodyView one = a.body(a.body_at(i)), other = b.body(b.body_at(i));
    const Vec3<Position> p{-other.position.x, other.position.y, other.position.z};
    const Vec3<Velocity> v{-other.velocity.x, other.velocity.y, other.velocity.z};
    if (one.position != p || one.velocity != v) return false;
  }
  return true;
}

}  // namespace

std::vector<AccuracyResult> measure_apex(const AccuracyOptions& options) {
  return at_settings(options, apex);
}

std::vector<AccuracyResult> measure_bounces(const AccuracyOptions& options) {
  return at_settings(options, twenty_bounces);
}

std::vector<AccuracyResult> measure_cradle(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  for (const double away : {0.0, 0.5}) {
    for (std::size_t which = 0; which < 2; ++which) {
      for (AccuracyResult& result : at_settings(
               options, [&](const Setting& setting) { return cradle(setting, away)[which]; }))
        results.push_back(std::move(result));
    }
  }
  return results;
}

std::vector<AccuracyResult> measure_momentum(const AccuracyOptions& options) {
  return at_settings(options, [&](const Setting& setting) {
    SceneRun scene(setting, weightless(1000));
    add_cloud(scene, 10, 0.25, elastic_ball(0.25, 0, 0, 0, 0.5_r), false, options.seed);
    const Sums before = sums_of(scene.world(), 0.25);
    scene.run(60);
    const Sums after = sums_of(scene.world(), 0.25);
    return scene.result("1,000 spheres, 60 s", "relative",
                        fuzz::norm(after.momentum - before.momentum) / before.size, 1e-6);
  });
}

std::vector<AccuracyResult> measure_bouncing_grid(const AccuracyOptions& options) {
  return at_settings(options, [](const Setting& setting) {
    SceneRun scene(setting, contact_world());
    scene.add(ground());
    std::vector<BodyHandle> balls;
    for (int i = 0; i < 49; ++i)
      balls.push_back(scene.add(elastic_ball(0.1, i % 7 - 3, 5.1, i / 7 - 3, 1_r)));
    double worst = 0;
    for (int second = 0; second < 20; ++second) {
      scene.run(1);
      double energy = 0;
      for (const BodyHandle ball : balls)
        energy += height_of(scene.world(), ball, 0.1) / (5 * 49);
      worst = std::max(worst, std::abs(energy - 1));
    }
    return scene.result("49 spheres, 20 s: energy", "relative", worst, 1e-3);
  });
}

std::vector<AccuracyResult> measure_rest(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results = at_settings(options, rest);
  for (AccuracyResult& result : at_settings(options, peaks))
    results.push_back(std::move(result));
  return results;
}

std::vector<AccuracyResult> measure_elastic_cloud(const AccuracyOptions& options) {
  constexpr double k_radius = 0.25;
  BodyDef like = elastic_ball(k_radius, 0, 0, 0, 1_r);
  like.material.friction = {};
  SceneRun scene(k_usual_setting, weightless(128)), mirror(k_usual_setting, weightless(128));
  add_cloud(scene, 5, k_radius, like, false, options.seed);
  add_cloud(mirror, 5, k_radius, like, true, options.seed);
  const Sums before = sums_of(scene.world(), k_radius);
  scene.run(10);
  mirror.run(10);
  const Sums after = sums_of(scene.world(), k_radius);
  const double scale = before.size;  // times metres
  return {scene.result("momentum", "m/s", fuzz::norm(after.momentum - before.momentum), 0),
          scene.result("angular momentum", "relative",
                       fuzz::norm(after.angular - before.angular) / scale, 1e-9),
          scene.result("energy", "relative", std::abs(after.energy / before.energy - 1), 5e-3),
          scene.result("mirrored", "wrong",
                       are_mirror_images(scene.world(), mirror.world()) ? 0 : 1, 0)};
}

}  // namespace lockstone::bench
