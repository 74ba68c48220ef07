// Rows 19, 20, 32 and 34: stacks, mass ratios, piles and overhangs; row 38: far away.
#include <algorithm>
#include <array>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/fuzz/dice.h"

namespace lockstone::bench {
namespace {

using namespace literals;

std::vector<BodyHandle> add_stack(SceneRun& scene, int count) {
  scene.add(ground());
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(scene.add(body_at(unit_box(), 0, 0.5 + i, 0)));
  return boxes;
}

std::array<AccuracyResult, 2> stack(const Setting& setting, int count) {
  SceneRun scene(setting, contact_world(64));
  const std::vector<BodyHandle> boxes = add_stack(scene, count);
  scene.run(60);
  const fuzz::Real3 top = fuzz::real(scene.world().position(boxes.back()));
  const std::string name = std::to_string(count) + " boxes, 60 s: ";
  return {scene.result(name + "drift", "m", std::hypot(top.x, top.z), 1e-4),
          scene.result(name + "height lost", "m", std::abs(top.y - (count - 0.5)), 1e-3)};
}

AccuracyResult heavy_on_light(const Setting& setting, int ratio, double goal) {
  SceneRun scene(setting, contact_world());
  scene.add(ground());
  BodyDef light = body_at(unit_box(), 0, 0.5, 0), heavy = body_at(unit_box(), 0, 1.5, 0);
  light.material.density = 100_kgpm3;
  heavy.material.density = Density::from_integer(100 * ratio);
  scene.add(light);
  const BodyHandle top = scene.add(heavy);
  double sunk = 0;
  for (int tick = 0; tick < 10 * setting.tick_rate; ++tick) {
    scene.step();
    sunk = std::max(sunk, 1.5 - fuzz::real(scene.world().position(top).y));
  }
  return scene.result(std::to_string(ratio) + " : 1", "m", sunk, goal);
}

AccuracyResult heap(const Setting& setting, std::uint64_t seed) {
  constexpr double k_radius = 0.2;
  SceneRun scene(setting, contact_world(256));
  scene.add(ground());
  fuzz::Dice dice(seed, 0);
  std::vector<BodyHandle> balls;
  for (int i = 0; i < 216; ++i) {
    const fuzz::Real3 off = dice.in_cube(0.02);
    balls.push_back(
        scene.add(body_at(Shape::sphere(fixed<Length>(k_radius)), (i % 6) * 0.41 + off.x,
                          0.5 + (i / 36) * 0.41, (i / 6 % 6) * 0.41 + off.z)));
  }
  double sum = 0;
  std::uint64_t count = 0;
  for (int tenth = 0; tenth < 100; ++tenth) {
    scene.run(0.1);
    std::vector<fuzz::Real3> at;
    for (const BodyHandle ball : balls)
      at.push_back(fuzz::real(scene.world().position(ball)));
    const auto add = [&](double depth) {
      sum += std::max(depth, 0.0);
      count += depth > 0 ? 1 : 0;
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
      add(k_radius - at[i].y);
      for (std::size_t j = 0; j < i; ++j)
        add(2 * k_radius - fuzz::norm(at[i] - at[j]));
    }
  }
  const double mean = count == 0 ? 0 : sum / static_cast<double>(count);
  return scene.result("216 spheres: mean overlap", "radii", mean / k_radius, 1e-3);
}

// Four blocks of one metre, each as far out as the ideal of `share`; 10 s.
bool overhang_stands(SceneRun& scene, double share) {
  scene = SceneRun(scene.setting(), contact_world());
  BodyDef table = body_at(Shape::box(1_m, 0.5_m, 1_m), -1, -0.5, 0);
  table.motion = MotionType::static_body;
  scene.add(table);
  double x = -0.5;
  BodyHandle top;
  for (int i = 0; i < 4; ++i) {
    x += share / (2.0 * (4 - i));
    top = scene.add(body_at(Shape::box(0.5_m, 0.125_m, 0.25_m), x, 0.125 + 0.25 * i, 0));
  }
  scene.run(10);
  return fuzz::real(scene.world().position(top).y) > 0.8;
}

// Whether a block twice as high as wide falls in 5 s, after two of turning gravity.
bool tips(SceneRun& scene, double angle) {
  WorldDef def = contact_world();
  def.gravity = tilted_gravity(20 * k_degree);
  scene = SceneRun(scene.setting(), def);
  scene.add(ground(1.5_r));
  BodyDef block = body_at(Shape::box(0.5_m, 1_m, 0.5_m), 0, 1, 0);
  block.material.friction = 1.5_r;
  const BodyHandle body = scene.add(block);
  scene.run(1);
  tilt(scene, 20 * k_degree, angle, 2);
  scene.run(5);
  return fuzz::real(scene.world().position(body).y) < 0.9;
}

AccuracyResult tipping(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  double stands = 25 * k_degree, falls = 28 * k_degree;
  for (int i = 0; i < 10; ++i) {
    const double middle = (stands + falls) / 2;
    (tips(scene, middle) ? falls : stands) = middle;
  }
  const double error = (stands + falls) / 2 - std::atan(0.5);
  return scene.result("tipping angle", "degrees", std::abs(error) / k_degree, 0.05);
}

// A ball and boxes that fall, slide and bounce; every word relative to the place.
std::vector<std::int64_t> mixed_scene(SceneRun& scene, Position away) {
  const Vec3<Position> place{away, {}, -away};
  const auto add = [&](BodyDef def) {
    def.position = def.position + place;
    return scene.add(def);
  };
  add(ground());
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 8; ++i) {
    const Shape shape = i % 2 == 0 ? Shape::sphere(0.4_m) : Shape::box(0.3_m, 0.4_m, 0.5_m);
    BodyDef def = body_at(shape, 0.3 * i - 1, 0.5 + 0.9 * i, 0.1 * i);
    def.velocity.x = Velocity::from_integer(2 - i % 5);
    def.material.restitution = 0.5_r;
    bodies.push_back(add(def));
  }
  scene.run(5);
  std::vector<std::int64_t> words;
  for (const BodyHandle body : bodies) {
    const Vec3<Position> p = scene.world().position(body) - place;
    const Vec3<Velocity> v = scene.world().velocity(body);
    words.insert(words.end(), {p.x.raw, p.y.raw, p.z.raw, v.x.raw, v.y.raw, v.z.raw});
  }
  return words;
}

}  // namespace

std::vector<AccuracyResult> measure_stacks(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  for (const int count : {20, 40}) {
    for (std::size_t which = 0; which < 2; ++which) {
      for (AccuracyResult& result : at_settings(
               options, [&](const Setting& setting) { return stack(setting, count)[which]; }))
        results.push_back(std::move(result));
    }
  }
  return results;
}

std::vector<AccuracyResult> measure_mass_ratios(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  constexpr std::array<std::pair<int, double>, 4> k_goals{
      {{10, 1e-4}, {100, 1e-3}, {1000, 2e-3}, {10000, 5e-3}}};
  for (const std::pair<int, double>& aim : k_goals) {
    const auto run = [&](const Setting& setting) {
      return heavy_on_light(setting, aim.first, aim.second);
    };
    for (AccuracyResult& result : at_settings(options, run))
      results.push_back(std::move(result));
  }
  return results;
}

std::vector<AccuracyResult> measure_heap(const AccuracyOptions& options) {
  return at_settings(options, [&](const Setting& setting) { return heap(setting, options.seed); });
}

std::vector<AccuracyResult> measure_overhang(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results = at_settings(options, [](const Setting& setting) {
    SceneRun scene(setting, contact_world());
    const bool stands = overhang_stands(scene, 0.99), falls = !overhang_stands(scene, 1.01);
    AccuracyResult result =
        scene.result("overhang of 4 blocks", "wrong", (stands ? 0 : 1) + (falls ? 0 : 1), 0);
    result.note = std::string(stands ? "stands" : "falls") + " at 0.99, " +
                  (falls ? "falls" : "stands") + " at 1.01";
    return result;
  });
  for (AccuracyResult& result : at_settings(options, tipping))
    results.push_back(std::move(result));
  return results;
}

std::vector<AccuracyResult> measure_far_away(const AccuracyOptions&) {
  SceneRun home(k_usual_setting, contact_world());
  const std::vector<std::int64_t> expected = mixed_scene(home, {});
  std::vector<AccuracyResult> results;
  for (const std::int64_t metres : {1'000, 10'000, 100'000, 1'000'000}) {
    SceneRun scene(k_usual_setting, contact_world());
    const bool same = mixed_scene(scene, Position::from_integer(metres)) == expected;
    results.push_back(scene.result(std::to_string(metres) + " m away", "wrong", same ? 0 : 1, 0));
  }
  return results;
}

}  // namespace lockstone::bench
