// Rows 17, 18 and 36: chains and a loop of joints.
#include <algorithm>
#include <cmath>
#include <string>

#include <lockstone/literals.h>

#include "tools/bench/accuracy/joint_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

// Links of 1 kg, spheres of a quarter of their length, and the last one of another mass, that hang
// from the origin and point along x.
BodyHandle add_chain(SceneRun& scene, int links, int length_mm, int end_mass) {
  const double radius = length_mm / 4000.0;
  const double density = 1 / (4.0 / 3 * std::acos(-1.0) * radius * radius * radius);
  const Length half = Length::from_ratio(length_mm, 2000);
  BodyHandle last = scene.add(fixed_point());
  for (int i = 0; i < links; ++i) {
    BodyDef def;
    def.shape = Shape::sphere(Length::from_ratio(length_mm, 4000));
    def.filter.mask = 0;
    def.material.density = Density::from_raw(static_cast<std::int32_t>(
        std::lround(std::ldexp(density * (i + 1 < links ? 1 : end_mass), 8))));
    def.position.x = Position::from_ratio((2 * i + 1) * length_mm, 2000);
    JointDef joint = JointDef::of(JointKind::ball, last, scene.add(def));
    if (i > 0) joint.frame_a.position.x = half;
    joint.frame_b.position.x = -half;
    join(scene.world(), joint);
    last = joint.body_b;
  }
  return last;
}

double worst_gap_over(SceneRun& scene, double seconds) {
  double worst = 0;
  for (int tick = 0; tick < seconds * scene.setting().tick_rate; ++tick) {
    scene.step();
    worst = std::max(worst, worst_gap(scene.world()));
  }
  return worst;
}

// A four-bar linkage in the plane z = 0: ground 2 m, crank ½ m, coupler and rocker 1.8 m and 1.2 m.
struct Linkage {
  static constexpr double k_ground = 2, k_crank = 0.5, k_coupler = 1.8, k_rocker = 1.2;
  BodyHandle crank, coupler, rocker;

  // Where coupler and rocker meet, from the crank's angle.
  [[nodiscard]] static std::array<double, 2> meeting(double angle) {
    const double x = k_crank * std::cos(angle), y = k_crank * std::sin(angle);
    const double dx = k_ground - x, dy = -y, d = std::hypot(dx, dy);
    const double along = (k_coupler * k_coupler - k_rocker * k_rocker + d * d) / (2 * d);
    const double up = std::sqrt(k_coupler * k_coupler - along * along);
    return {x + (along * dx - up * dy) / d, y + (along * dy + up * dx) / d};
  }
};

// A bar from one point to another.
BodyHandle add_bar(SceneRun& scene, std::array<double, 2> from, std::array<double, 2> to) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  const auto metres = [](double x) { return Position::from_raw(std::llround(std::ldexp(x, 32))); };
  BodyDef def;
  def.shape = Shape::box(rounded<Length>(metres(length / 2)), 0.05_m, 0.05_m);
  def.position = {metres((from[0] + to[0]) / 2), metres((from[1] + to[1]) / 2), {}};
  def.orientation = from_axis_angle(
      {{}, {}, 1_r}, Angle::from_raw(static_cast<std::int32_t>(std::lround(
                         std::ldexp(std::atan2(to[1] - from[1], to[0] - from[0]), 27)))));
  def.filter.mask = 0;
  return scene.add(def);
}

JointHandle add_hinge(SceneRun& scene, BodyHandle a, Length at_a, BodyHandle b, Length at_b) {
  JointDef hinge = JointDef::of(JointKind::hinge, a, b);
  hinge.frame_a.orientation = from_axis_angle({{}, 1_r, {}}, -1.570796327_rad);
  hinge.frame_b.orientation = hinge.frame_a.orientation;
  hinge.frame_a.position.x = at_a;
  hinge.frame_b.position.x = at_b;
  return join(scene.world(), hinge);
}

Linkage add_linkage(SceneRun& scene) {
  const BodyHandle ground = scene.add(fixed_point());
  const std::array<double, 2> meeting = Linkage::meeting(0);
  Linkage linkage;
  linkage.crank = add_bar(scene, {0, 0}, {Linkage::k_crank, 0});
  linkage.coupler = add_bar(scene, {Linkage::k_crank, 0}, meeting);
  linkage.rocker = add_bar(scene, {Linkage::k_ground, 0}, meeting);
  const JointHandle drive = add_hinge(scene, ground, {}, linkage.crank, -0.25_m);
  add_hinge(scene, linkage.crank, 0.25_m, linkage.coupler, -0.9_m);
  add_hinge(scene, linkage.coupler, 0.9_m, linkage.rocker, 0.6_m);
  add_hinge(scene, ground, 2_m, linkage.rocker, -0.6_m);
  AngularAxis motor;
  motor.speed = 3_rps;
  motor.max_effort = Torque::from_integer(10000);
  LKS_CHECK(scene.world().apply(SetAngularAxis{drive, 0, motor}) == Status::ok);
  return linkage;
}

// Where coupler and rocker meet, against the point that follows from the crank.
double meeting_error(const World& world, const Linkage& linkage) {
  const fuzz::Real3 crank = fuzz::real(world.position(linkage.crank));
  const fuzz::Real3 rocker = fuzz::real(world.position(linkage.rocker));
  const std::array<double, 2> expected = Linkage::meeting(std::atan2(crank.y, crank.x));
  return std::hypot(2 * rocker.x - Linkage::k_ground - expected[0], 2 * rocker.y - expected[1]);
}

}  // namespace

double worst_gap(const World& world) {
  double worst = 0;
  for (std::uint32_t i = 0; i < world.joint_limit(); ++i) {
    const Vec3<Length> gap = world.joint(world.joint_at(i)).offset;
    worst = std::max(worst, std::ldexp(std::hypot(gap.x.raw, gap.y.raw, gap.z.raw), -20));
  }
  return worst;
}

std::vector<AccuracyResult> measure_linkage(const AccuracyOptions&) {
  std::vector<AccuracyResult> positions;
  std::vector<AccuracyResult> results = over_substeps([&](const Setting& setting) {
    SceneRun scene(setting, joint_world());
    const Linkage linkage = add_linkage(scene);
    double gap = 0, error = 0;
    for (int tick = 0; tick < 20 * setting.tick_rate; ++tick) {
      scene.step();
      gap = std::max(gap, worst_gap(scene.world()));
      error = std::max(error, meeting_error(scene.world(), linkage));
    }
    positions.push_back(scene.result("place of the rocker", "m", error, 1e-3));
    return scene.result("opening", "m", gap, 1e-3);
  });
  results.insert(results.end(), positions.begin(), positions.end());
  return results;
}

std::vector<AccuracyResult> measure_chain(const AccuracyOptions&) {
  return over_substeps([](const Setting& setting) {
    SceneRun scene(setting, joint_world());
    add_chain(scene, 10, 1000, 100);
    const double gap = worst_gap_over(scene, 20);
    return scene.result("opening", "m", gap, 5e-3);
  });
}

std::vector<AccuracyResult> measure_heavy_chain(const AccuracyOptions&) {
  std::vector<AccuracyResult> results;
  for (const int mass : {1, 10, 100, 1000}) {
    SceneRun scene(k_usual_setting, joint_world());
    const BodyHandle end = add_chain(scene, 20, 250, mass);
    double reach = 0;
    for (int tick = 0; tick < 600; ++tick) {
      scene.step();
      reach = std::max(reach, fuzz::norm(fuzz::real(scene.world().position(end))));
    }
    results.push_back(scene.result("stretch, " + std::to_string(mass) + " : 1", "relative",
                                   std::max(reach / 4.875 - 1, 0.0), 1e-3));
  }
  return results;
}

}  // namespace lockstone::bench
