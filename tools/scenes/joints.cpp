// Scenes of joints.
#include <vector>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr Quat k_x_to_z = {{}, Unit::from_raw(-759250125), {}, Unit::from_raw(759250125)};

void join(World& world, const JointDef& def) {
  order(world, CreateJoint{def});
}

// Links, the last of them many times as heavy, swing from the horizontal.
void build_chain(World& world, std::uint64_t, const SceneValues& values) {
  const int links = values[0], times_heavier = values[1];
  BodyHandle last = add(world, fixed_box({{}, 11_m, {}}, {0.1_m, 0.1_m, 0.1_m}));
  for (int i = 0; i < links; ++i) {
    const bool is_end = i == links - 1;
    BodyDef link = loose(is_end ? Shape::sphere(0.5_m) : Shape::box(0.4_m, 0.08_m, 0.08_m),
                         {millimetres(500 + i * 1000), 11_m, {}});
    if (is_end) link.material.density = Density::from_integer(39 * times_heavier);
    JointDef joint = JointDef::of(JointKind::ball, last, add(world, link));
    if (i > 0) joint.frame_a.position.x = 0.5_m;
    joint.frame_b.position.x = -0.5_m;
    join(world, joint);
    last = joint.body_b;
  }
}

WorldDef net_world() {
  WorldDef def = small_world();
  def.body_capacity = 1024;
  def.joint_capacity = 2048;
  return def;
}

// Plates and balls by turns, held to their neighbours, fall over a post.
void build_net(World& world, std::uint64_t, const SceneValues& values) {
  const int side = values[0];
  add(world, fixed_box({{}, 2_m, {}}, {0.5_m, 2_m, 0.5_m}));
  add_ground(world, 40_m);
  std::vector<BodyHandle> net;
  for (int i = 0; i < side * side; ++i) {
    const int x = i % side, z = i / side;
    const Shape shape = (x + z) % 2 == 0 ? Shape::box(0.2_m, 0.05_m, 0.2_m) : Shape::sphere(0.15_m);
    net.push_back(add(world, loose(shape, {millimetres(500 * x - 250 * (side - 1)), 5_m,
                                           millimetres(500 * z - 250 * (side - 1))})));
    const auto hold = [&](int other, Length to_x, Length to_z) {
      JointDef joint =
          JointDef::of(JointKind::ball, net[static_cast<std::size_t>(other)], net.back());
      joint.frame_a.position = {to_x, {}, to_z};
      joint.frame_b.position = {-to_x, {}, -to_z};
      join(world, joint);
    };
    if (x > 0) hold(i - 1, 0.25_m, {});
    if (z > 0) hold(i - side, {}, 0.25_m);
  }
}

// A pendulum, a double one, and a rod on a spring.
void build_pendulums(World& world, std::uint64_t) {
  const auto hang = [&](BodyHandle from, std::int32_t x_mm, std::int32_t z_mm) {
    JointDef joint = JointDef::of(
        JointKind::ball, from,
        add(world, loose(Shape::sphere(0.2_m), {millimetres(x_mm), 3_m, millimetres(z_mm)})));
    joint.frame_b.position.x = -1_m;
    join(world, joint);
    return joint.body_b;
  };
  const auto pivot = [&](std::int32_t z_mm) {
    return add(world, fixed_box({{}, 3_m, millimetres(z_mm)}, {0.05_m, 0.05_m, 0.05_m}));
  };
  hang(pivot(-1500), 1000, -1500);
  hang(hang(pivot(0), 1000, 0), 2000, 0);
  const BodyHandle rod = add(world, loose(Shape::box(0.5_m, 0.1_m, 0.1_m), {0.5_m, 3_m, 1.5_m}));
  JointDef hinge = JointDef::of(JointKind::hinge, pivot(1500), rod);
  hinge.frame_a.orientation = hinge.frame_b.orientation = k_x_to_z;
  hinge.frame_b.position.x = -0.5_m;
  hinge.angular[0].hertz = 2_r;
  hinge.angular[0].damping_ratio = 0.2_r;
  join(world, hinge);
}

// Planks on two ropes of ball joints; boxes fall on it.
void build_bridge(World& world, std::uint64_t, const SceneValues& values) {
  const int planks = values[0], boxes = values[1];
  BodyHandle last =
      add(world, fixed_box({millimetres(-500 * (planks + 1)), 3_m, {}}, {0.5_m, 0.1_m, 1_m}));
  const auto tie = [&](BodyHandle to) {
    for (const int side : {-1, 1}) {
      JointDef joint = JointDef::of(JointKind::ball, last, to);
      joint.frame_a.position = {0.5_m, {}, millimetres_long(side * 900)};
      joint.frame_b.position = {-0.5_m, {}, millimetres_long(side * 900)};
      join(world, joint);
    }
    last = to;
  };
  for (int i = 0; i < planks; ++i) {
    BodyDef plank = loose(Shape::box(0.48_m, 0.06_m, 1_m),
                          {millimetres(i * 1000 - 500 * (planks - 1)), 3_m, {}});
    plank.material.density = Density::from_integer(600);
    tie(add(world, plank));
  }
  tie(add(world, fixed_box({millimetres(500 * (planks + 1)), 3_m, {}}, {0.5_m, 0.1_m, 1_m})));
  for (int i = 0; i < boxes; ++i)
    add(world, loose(Shape::box(0.3_m, 0.3_m, 0.3_m),
                     {millimetres(i * 1500 - 2200 - 750 * (boxes - 4)), 4.5_m, {}}));
}

}  // namespace

void add_ragdoll(World& world, const Vec3<Position>& at, std::uint64_t user_data) {
  const auto part = [&](const Shape& shape, std::int32_t x_mm, std::int32_t y_mm) {
    BodyDef def = loose(shape, at + Vec3<Position>{millimetres(x_mm), millimetres(y_mm), {}});
    def.user_data = user_data;
    return add(world, def);
  };
  const auto tie = [&](BodyHandle a, const Vec3<Length>& on_a, BodyHandle b,
                       const Vec3<Length>& on_b, Angle swing) {
    JointDef joint = JointDef::of(JointKind::ball, a, b);
    joint.frame_a.position = on_a;
    joint.frame_b.position = on_b;
    joint.angular[1].mode = AxisMode::limited;
    joint.angular[1].upper = swing;
    joint.angular[0].mode = AxisMode::limited;
    joint.angular[0].lower = -0.4_rad;
    joint.angular[0].upper = 0.4_rad;
    join(world, joint);
  };
  const BodyHandle torso = part(Shape::box(0.2_m, 0.3_m, 0.12_m), 0, 0);
  tie(torso, {{}, 0.35_m, {}}, part(Shape::sphere(0.14_m), 0, 500), {{}, -0.15_m, {}}, 0.5_rad);
  for (const int side : {-1, 1}) {
    const Length out = millimetres_long(side * 240), hip = millimetres_long(side * 120);
    const BodyHandle arm = part(Shape::box(0.06_m, 0.15_m, 0.06_m), side * 300, 100);
    tie(torso, {out, 0.25_m, {}}, arm, {millimetres_long(side * -60), 0.15_m, {}}, 1.2_rad);
    const BodyHandle hand = part(Shape::box(0.05_m, 0.15_m, 0.05_m), side * 300, -220);
    tie(arm, {{}, -0.16_m, {}}, hand, {{}, 0.16_m, {}}, 1_rad);
    const BodyHandle thigh = part(Shape::box(0.08_m, 0.2_m, 0.08_m), side * 120, -520);
    tie(torso, {hip, -0.31_m, {}}, thigh, {{}, 0.21_m, {}}, 1_rad);
    const BodyHandle shin = part(Shape::box(0.07_m, 0.2_m, 0.07_m), side * 120, -940);
    tie(thigh, {{}, -0.21_m, {}}, shin, {{}, 0.21_m, {}}, 0.8_rad);
  }
}

namespace {

void build_ragdoll(World& world, std::uint64_t, const SceneValues& values) {
  add_ground(world, 8_m);
  add(world, fixed_box({0.5_m, 0.5_m, {}}, {0.5_m, 0.5_m, 2_m}));
  for (int i = 0; i < values[0]; ++i)
    add_ragdoll(world, {millimetres(i % 2 == 0 ? -500 : 600), millimetres(3500 + 2000 * i),
                        millimetres(i % 2 * 500)});
}

// Four wheels on suspensions; the hind ones drive, the front ones steer.
void build_vehicle(World& world, std::uint64_t) {
  add_ground(world, 40_m);
  BodyDef ramp = fixed_box({{}, {}, -12_m}, {4_m, 0.2_m, 3_m});
  ramp.orientation = from_axis_angle(k_x_axis, 0.15_rad);
  add(world, ramp);
  BodyDef chassis = loose(Shape::box(0.9_m, 0.3_m, 2_m), {{}, 1.1_m, {}});
  chassis.material.density = Density::from_integer(250);
  const BodyHandle car = add(world, chassis);
  for (int i = 0; i < 4; ++i) {
    const bool is_front = i < 2;
    const std::int32_t x = i % 2 == 0 ? -1100 : 1100, z = is_front ? -1400 : 1400;
    BodyDef wheel = loose(Shape::sphere(0.4_m), {millimetres(x), 0.6_m, millimetres(z)});
    wheel.material.friction = 1_r;
    JointDef joint = JointDef::of(JointKind::wheel, car, add(world, wheel));
    joint.frame_a.position = {millimetres_long(x), -0.5_m, millimetres_long(z)};
    joint.linear[1] = {.mode = AxisMode::limited,
                       .lower = -0.25_m,
                       .upper = 0.25_m,
                       .hertz = 4_r,
                       .damping_ratio = 0.7_r};
    if (is_front) {
      joint.angular[1] = {.mode = AxisMode::limited,
                          .lower = -0.5_rad,
                          .upper = 0.5_rad,
                          .target = 0.01_rad,
                          .hertz = 10_r};
    } else {
      joint.angular[0].speed = -25_rps;
      joint.angular[0].max_effort = Torque::from_integer(1500);
    }
    join(world, joint);
  }
}

}  // namespace

constinit const Scene k_chain{
    .name = "chain",
    .description = "ten links with 100 : 1 at the end swing",
    .golden_ticks = 240,
    .define = small_world,
    .builder = build_chain,
    .own_parameters = {{{"links", 10, 2, 60}, {"times heavier", 100, 1, 1000}}}};
constinit const Scene k_net{.name = "net",
                            .description = "a net of 289 plates and balls falls over a post",
                            .golden_ticks = 90,
                            .define = net_world,
                            .builder = build_net,
                            .own_parameters = {{{"side", 17, 2, 30}}}};
constinit const Scene k_pendulum{"pendulum", "a pendulum, a double one, a rod on a spring", 240,
                                 small_world, build_pendulums};
constinit const Scene k_bridge{.name = "bridge",
                               .description = "boxes fall on a hanging bridge",
                               .golden_ticks = 240,
                               .define = small_world,
                               .builder = build_bridge,
                               .own_parameters = {{{"planks", 12, 2, 60}, {"boxes", 4, 0, 30}}}};
constinit const Scene k_ragdoll{.name = "ragdoll",
                                .description = "two ragdolls fall on a block",
                                .golden_ticks = 200,
                                .define = small_world,
                                .builder = build_ragdoll,
                                .own_parameters = {{{"ragdolls", 2, 1, 40}}}};
constinit const Scene k_vehicle{"vehicle", "a car with suspension drives over a ramp", 240,
                                small_world, build_vehicle};

}  // namespace lockstone::scenes
