// Rows 41 to 43: figures that follow poses, drags, beads on paths and ratchets.
#include <algorithm>
#include <array>
#include <utility>

#include <lockstone/drag.h>
#include <lockstone/game_math.h>
#include <lockstone/path.h>
#include <lockstone/ragdoll.h>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/bench/accuracy/joint_scene.h"
#include "tools/bench/accuracy/reference_pendulum.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr Vec3<Unit> k_x{Unit::from_integer(1), {}, {}}, k_down{{}, Unit::from_integer(-1), {}},
    k_z{{}, {}, Unit::from_integer(1)};
constexpr std::size_t k_limbs = 5;
using Limbs = std::array<Bone, k_limbs>;

// Hips, and two legs of a thigh on a ball and a shin on a hinge.
Limbs legs() {
  Limbs bones;
  bones[0].shape = Shape::box(0.2_m, 0.12_m, 0.12_m);
  for (std::uint32_t i = 1; i < k_limbs; ++i) {
    const bool is_thigh = i % 2 == 1;
    Bone& bone = bones[i];
    bone.parent = is_thigh ? 0 : i - 1;
    bone.shape = Shape::capsule(0.15_m, 0.06_m);
    bone.joint = is_thigh ? JointKind::ball : JointKind::hinge;
    const double x = i < 3 ? -0.12 : 0.12, top = is_thigh ? -0.12 : -0.56;
    bone.pose.position = fixed<Position>(x, top - 0.22, 0);
    bone.joint_frame = {fixed<Position>(x, top, 0), from_directions(k_x, is_thigh ? k_down : k_z)};
  }
  return bones;
}

struct Legs {
  SceneRun scene;
  Limbs bones = legs();
  RagdollDef def{.bones = bones, .filter = {.group = -1}};
  Ragdoll ragdoll;
  std::array<BoneDrive, k_limbs> drives{};

  Legs(const Setting& setting, const RagdollPose& pose) : scene(setting, joint_world()) {
    ragdoll = create_ragdoll(scene.world(), def, pose).value();
    drives[0].mode = BoneMode::kinematic;
  }
  void play(const RagdollPose& from, const RagdollPose& to) {
    LKS_CHECK(drive_ragdoll(scene.world(), def, ragdoll, from, to, drives) == Status::ok);
    scene.step();
  }
  [[nodiscard]] fuzz::Real3 place(std::size_t bone) {
    return fuzz::real(scene.world().position(ragdoll.bodies[bone]));
  }
};

Angle swing(double time, double hertz, double most) {
  return fixed<Angle>(most * std::sin(2 * std::numbers::pi * hertz * time));
}

// The hips sway; the legs swing by up to 0.7 rad.
RagdollPose stride(double time) {
  RagdollPose pose;
  pose.root = {fixed<Position>(0.1 * std::sin(time), 2, 0), {}};
  for (std::size_t i = 1; i < k_limbs; ++i) {
    const double side = i < 3 ? 1 : -1;
    pose.turns[i] = i % 2 == 1 ? from_axis_angle(k_z, swing(time, 1, 0.7 * side))
                               : from_axis_angle(k_x, swing(time, 1.3, 0.5 * side));
  }
  return pose;
}

// Forward kinematics says where the bones are.
AccuracyResult posed(const Setting& setting) {
  Legs figure(setting, stride(0));
  const double rate = setting.tick_rate;
  double worst = 0;
  for (int tick = 0; tick < 5 * setting.tick_rate; ++tick) {
    const RagdollPose to = stride((tick + 1) / rate);
    figure.play(stride(tick / rate), to);
    std::array<Transform, k_limbs> poses;
    bone_poses(figure.def, to, poses);
    for (std::size_t i = 0; i < k_limbs; ++i)
      worst = std::max(worst, fuzz::norm(figure.place(i) - fuzz::real(poses[i].position)));
  }
  return figure.scene.result("a pose is followed", "m", worst, 1e-4);
}

// Limp legs swing for four seconds; others play the poses in which these stood.
AccuracyResult recorded(const Setting& setting) {
  const int ticks = 4 * setting.tick_rate;
  RagdollPose start = stride(0.2);
  Legs limp(setting, start);
  std::vector<RagdollPose> poses;
  std::vector<std::array<fuzz::Real3, k_limbs>> places;
  for (std::size_t i = 1; i < k_limbs; ++i)
    limp.drives[i].mode = BoneMode::limp;
  for (int tick = 0; tick <= ticks; ++tick) {
    poses.push_back(pose_of(limp.scene.world(), limp.def, limp.ragdoll));
    for (std::size_t i = 0; i < k_limbs; ++i)
      places.resize(poses.size()), places.back()[i] = limp.place(i);
    limp.play(start, start);
  }
  Legs player(setting, start);
  double worst = 0;
  for (std::size_t tick = 0; tick + 1 < poses.size(); ++tick) {
    player.play(poses[tick], poses[tick + 1]);
    for (std::size_t i = 0; i < k_limbs; ++i)
      worst = std::max(worst, fuzz::norm(player.place(i) - places[tick + 1][i]));
  }
  return player.scene.result("recorded poses are played", "m", worst, 1e-3);
}

// A ball of 10 kg at the origin that a drag pulls, without gravity.
struct Dragged {
  SceneRun scene;
  Drag drag;

  Dragged(const Setting& setting, double hertz, double damping_ratio, double force, double target)
      : scene(setting, weightless()) {
    BodyDef ball = body_at(Shape::sphere(0.2_m), 0, 0, 0);
    ball.mass.mass = Mass::from_integer(10);
    drag = {.ground = scene.add(fixed_point()),
            .body = scene.add(ball),
            .hertz = fixed<Number>(hertz),
            .damping_ratio = fixed<Number>(damping_ratio),
            .max_force = fixed<Force>(force)};
    join(scene.world(), drag_joint(scene.world(), drag, fixed<Position>(target, 0, 0)));
  }
  static WorldDef weightless() {
    WorldDef def = joint_world();
    def.gravity = {};
    def.sleep_ms = 0;
    return def;
  }
  [[nodiscard]] double x() { return fuzz::real(scene.world().position(drag.body).x); }
};

// x = 1 − e^{−ζωt}·(cos ω't + ζω/ω'·sin ω't), ω' = ω·√(1 − ζ²); its limit for ζ = 1.
double step_response(double omega, double damping, double t) {
  const double decay = std::exp(-damping * omega * t);
  if (damping >= 1) return 1 - decay * (1 + omega * t);
  const double swung = omega * std::sqrt(1 - damping * damping);
  return 1 - decay * (std::cos(swung * t) + damping * omega / swung * std::sin(swung * t));
}

AccuracyResult dragged(const Setting& setting, double damping, const char* name, double goal) {
  constexpr double k_hertz = 1, k_target = 0.5;
  Dragged ball(setting, k_hertz, damping, 0, k_target);
  double worst = 0;
  for (int tick = 1; tick <= 4 * setting.tick_rate; ++tick) {
    ball.scene.step();
    const double t = static_cast<double>(tick) / setting.tick_rate;
    const double expected = k_target * step_response(2 * std::numbers::pi * k_hertz, damping, t);
    worst = std::max(worst, std::abs(ball.x() - expected));
  }
  return ball.scene.result(name, "m", worst, goal);
}

// F·t²/2m while the target is far.
AccuracyResult dragged_by_force(const Setting& setting) {
  Dragged ball(setting, 5, 0, 20, 100);
  ball.scene.run(2);
  return ball.scene.result("way in 2 s by 20 N", "relative", std::abs(ball.x() / 4 - 1), 0.01);
}

AssetPtr upright_circle(double radius) {
  std::vector<PathPoint> points;
  constexpr int k_points = 96;
  for (int i = 0; i < k_points; ++i) {
    const double a = 2 * std::numbers::pi * i / k_points;
    points.push_back({fixed<Length>(radius * std::sin(a), -radius * std::cos(a), 0), k_z});
  }
  return Path::build(points, true).path;
}

struct Bead {
  AssetPtr path;
  SceneRun scene;
  BodyHandle body;
  double radius;

  // From an angle above the lowest point.
  Bead(const Setting& setting, double circle_radius, double angle, double speed)
      : path(upright_circle(circle_radius)),
        scene(setting, Dragged::weightless(), std::make_shared<const AssetSet>(std::vector{path})),
        radius(circle_radius) {
    (void)scene.world().apply(SetGravity{fixed<Acceleration>(0, -k_gravity, 0)});
    BodyDef bead =
        body_at(Shape::sphere(0.1_m), radius * std::sin(angle), -radius * std::cos(angle), 0);
    bead.velocity = fixed<Velocity>(speed * std::cos(angle), speed * std::sin(angle), 0);
    body = scene.add(bead);
    JointDef joint = JointDef::of(JointKind::path, scene.add(fixed_point()), body);
    joint.path = path->id();
    join(scene.world(), joint);
  }
  [[nodiscard]] fuzz::Real3 place() { return fuzz::real(scene.world().position(body)); }
  // Over m·g·r, from the centre.
  [[nodiscard]] double energy() {
    const double v = fuzz::norm(fuzz::real(scene.world().velocity(body)));
    return (v * v / 2 / k_gravity + place().y) / radius;
  }
};

// A bead from 90°, as a pendulum of the circle's radius.
std::vector<AccuracyResult> swung(const Setting& setting) {
  constexpr double k_radius = 2;
  Bead bead(setting, k_radius, std::numbers::pi / 2, 0);
  const double period = 4 * elliptic_k(std::sqrt(0.5)) * std::sqrt(k_radius / k_gravity);
  double first = 0, last = 0, before = 1, gained = -1, aside = 0;
  const double start = bead.energy();
  int crossings = -1;
  for (int tick = 1; tick <= 60 * setting.tick_rate; ++tick) {
    bead.scene.step();
    const fuzz::Real3 at = bead.place(), v = fuzz::real(bead.scene.world().velocity(bead.body));
    aside = std::max(aside, std::abs(std::hypot(at.x, at.y) - k_radius) + std::abs(at.z));
    gained = std::max(gained, bead.energy() - start);
    const double angle = std::atan2(at.x, -at.y);
    if ((before > 0) != (angle > 0) && at.y < 0) {
      last = static_cast<double>(tick) / setting.tick_rate - at.x / v.x;
      if (++crossings == 0) first = last;
    }
    before = angle;
  }
  const double measured = 2 * (last - first) / crossings;
  return {bead.scene.result("period from 90 degrees", "relative", std::abs(measured / period - 1),
                            1e-4),
          bead.scene.result("from the circle", "m", aside, 1e-4),
          bead.scene.result("energy gained in 60 s", "of mgr", gained, 1e-3)};
}

// A ratchet of 12 teeth is turned to and fro by a torque for ten seconds: ten turns of whole teeth.
AccuracyResult ratchet(const Setting& setting) {
  SceneRun scene(setting, Dragged::weightless());
  JointDef joint = JointDef::of(JointKind::ratchet, scene.add(fixed_point()),
                                scene.add(body_at(unit_box(), 0, 0, 0)));
  const JointHandle made = join(scene.world(), joint);
  double worst = 0;
  for (int second = 0; second < 10; ++second) {
    (void)scene.world().apply(
        SetAngularVelocity{joint.body_b, {AngularVelocity::from_integer(second + 1), {}, {}}});
    scene.run(0.5);
    (void)scene.world().apply(SetAngularVelocity{joint.body_b, {}});
    const double tooth = std::numbers::pi / 6;
    const double reached = fuzz::real(scene.world().joint(made).angle.x);
    for (int tick = 0; tick < setting.tick_rate * 2; ++tick) {
      (void)scene.world().apply(ApplyTorque{joint.body_b, {Torque::from_integer(-200), {}, {}}});
      scene.step();
    }
    const double back = reached - fuzz::real(scene.world().joint(made).angle.x);
    const double expected = reached - tooth * std::floor(reached / tooth);
    worst = std::max(worst, std::abs(std::remainder(back - expected, 2 * std::numbers::pi)));
  }
  return scene.result("a ratchet holds its tooth", "rad", worst, 1e-3);
}

}  // namespace

std::vector<AccuracyResult> measure_figures(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results = at_settings(options, posed);
  const std::vector<AccuracyResult> more = at_settings(options, recorded);
  results.insert(results.end(), more.begin(), more.end());
  return results;
}

std::vector<AccuracyResult> measure_drags(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](const std::function<AccuracyResult(const Setting&)>& measure) {
    const std::vector<AccuracyResult> more = at_settings(options, measure);
    results.insert(results.end(), more.begin(), more.end());
  };
  add([](const Setting& s) { return dragged(s, 0, "1 Hz without damping, 4 s", 1e-3); });
  add([](const Setting& s) { return dragged(s, 0.3, "step response, damping ratio 0.3", 5e-3); });
  add([](const Setting& s) { return dragged(s, 1, "step response, damping ratio 1", 5e-3); });
  add(dragged_by_force);
  return results;
}

std::vector<AccuracyResult> measure_paths(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](std::size_t i) {
    const std::vector<AccuracyResult> more =
        at_settings(options, [i](const Setting& setting) { return swung(setting)[i]; });
    results.insert(results.end(), more.begin(), more.end());
  };
  for (std::size_t i = 0; i < 3; ++i)
    add(i);
  const std::vector<AccuracyResult> more = at_settings(options, ratchet);
  results.insert(results.end(), more.begin(), more.end());
  return results;
}

}  // namespace lockstone::bench
