// Long chains, loops that are fastened more than once, joints that contradict each other.
#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "tools/bench/stability/stability_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

WorldDef large_joint_world() {
  WorldDef def = joint_world();
  def.body_capacity = def.joint_capacity = 256;
  def.pair_capacity = def.contact_capacity = 2048;
  def.sleep_ms = 0;
  return def;
}

JointHandle hold(SceneRun& scene, JointKind kind, BodyHandle a, const Vec3<Length>& on_a,
                 BodyHandle b, const Vec3<Length>& on_b) {
  JointDef joint = JointDef::of(kind, a, b);
  joint.frame_a.position = on_a;
  joint.frame_b.position = on_b;
  return join(scene.world(), joint);
}

// Swung from horizontal.
StabilityResult chain(double seconds) {
  SceneRun scene(k_usual_setting, large_joint_world());
  BodyHandle last = scene.add(fixed_point());
  for (int i = 0; i < 100; ++i) {
    BodyDef link = body_at(Shape::capsule(0.1_m, 0.1_m), 0.5 * i + 0.25, 0, 0);
    link.filter.mask = 0;
    const BodyHandle next = scene.add(link);
    hold(scene, JointKind::ball, last, {i == 0 ? Length{} : Length(0.25_m), {}, {}}, next,
         {-0.25_m, {}, {}});
    last = next;
  }
  const auto [gap, speed] = worst_of(scene, seconds, worst_gap, greatest_speed);
  return stability_of(scene,
                      {{"worst gap", "m", gap, 0.005}, {"greatest speed", "m/s", speed, 150}});
}

// A door on five hinges, each a little off, and a frame of bars with every corner welded twice.
StabilityResult loops(double seconds) {
  SceneRun scene(k_usual_setting, large_joint_world());
  const BodyHandle post = scene.add(fixed_point());
  BodyDef leaf = body_at(Shape::box(0.5_m, 1_m, 0.03_m), 0.5, 0, 0);
  leaf.filter.mask = 0;
  leaf.angular_velocity.y = 1_rps;
  const BodyHandle door = scene.add(leaf);
  for (int i = 0; i < 5; ++i) {
    const Length y = Length::from_ratio(2 * i - 4, 5);
    JointDef hinge = JointDef::of(JointKind::hinge, post, door);
    hinge.frame_a.position = {Length::from_ratio(i % 2, 2000), y, {}};
    hinge.frame_b.position = {-0.5_m, y, {}};
    const Quat about_y = from_axis_angle({{}, {}, 1_r}, Angle::from_ratio(11, 7));
    hinge.frame_a.orientation = hinge.frame_b.orientation = about_y;
    join(scene.world(), hinge);
  }
  BodyHandle bars[4];
  for (int i = 0; i < 4; ++i) {
    const bool across = i % 2 == 0;
    const double side = i < 2 ? 1 : -1;
    BodyDef bar =
        body_at(across ? Shape::box(1_m, 0.05_m, 0.05_m) : Shape::box(0.05_m, 1_m, 0.05_m),
                across ? 0 : side, across ? side : 0, 3);
    bar.filter.mask = 0;
    bars[i] = scene.add(bar);
  }
  for (int i = 0; i < 8; ++i) {
    const int a = i % 4, b = (i + 1) % 4;
    const Vec3<Position> corner_from_a =
        scene.world().position(bars[b]) - scene.world().position(bars[a]);
    const bool across = a % 2 == 0;
    Vec3<Length> on_a, on_b;
    on_a[across ? 0 : 1] = saturated<Length>(corner_from_a[across ? 0 : 1]);
    on_b[across ? 1 : 0] = -saturated<Length>(corner_from_a[across ? 1 : 0]);
    hold(scene, JointKind::weld, bars[a], on_a, bars[b], on_b);
  }
  hold(scene, JointKind::ball, post, {{}, 1_m, 3_m}, bars[0], {});
  const auto [gap, speed] = worst_of(scene, seconds, worst_gap, greatest_speed);
  return stability_of(scene, {{"worst gap", "m", gap, 0.005}, {"greatest speed", "m/s", speed, 5}});
}

// A motor of any strength against limits that leave it no way, and two welds that want two places.
StabilityResult contradictions(double seconds) {
  SceneRun scene(k_usual_setting, large_joint_world());
  const BodyHandle post = scene.add(fixed_point());
  BodyDef arm = body_at(unit_box(), 1, 0, 0);
  arm.filter.mask = 0;
  JointDef hinge = JointDef::of(JointKind::hinge, post, scene.add(arm));
  hinge.frame_b.position.x = -1_m;
  hinge.angular[0].mode = AxisMode::limited;
  hinge.angular[0].lower = 0.5_rad;
  hinge.angular[0].upper = 0.5_rad;
  hinge.angular[0].speed = 20_rps;
  hinge.angular[0].max_effort = Torque::from_integer(1'000'000'000);
  join(scene.world(), hinge);
  BodyDef torn = body_at(unit_box(), 0, 5, 0);
  torn.filter.mask = 0;
  const BodyHandle body = scene.add(torn);
  hold(scene, JointKind::weld, post, {-0.5_m, 5_m, {}}, body, {});
  hold(scene, JointKind::weld, post, {0.5_m, 5_m, {}}, body, {});
  const auto [speed] = worst_of(scene, seconds, greatest_speed);
  const double middle =
      fuzz::norm(fuzz::real(scene.world().position(body) - fixed<Position>(0, 5, 0)));
  return stability_of(scene, {{"greatest speed", "m/s", speed, 50},
                              {"the torn body, off the middle", "m", middle, 0.51}});
}

constexpr StabilityRow k_rows[] = {
    {"chain-100", "a hundred links swing from horizontal", 600, chain},
    {"loops", "a door on five hinges, a frame welded twice at each corner", 600, loops},
    {"contradictions", "a motor against its limits, welds in two places", 600, contradictions},
};

}  // namespace

std::span<const StabilityRow> joint_rows() {
  return k_rows;
}

}  // namespace lockstone::bench
