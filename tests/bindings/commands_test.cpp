// Every command has the same effect through the C interface as in the core.
#include <array>

#include <gtest/gtest.h>

#include "tests/bindings/twin_worlds.h"

namespace lockstone {
namespace {

using namespace lockstone::literals;

constexpr Vec3<Impulse> k_impulse{300_Ns, 200_Ns, -100_Ns};
constexpr Vec3<Force> k_force{500_N, 900_N, 30_N};
constexpr Vec3<Length> k_point{0.25_m, 0.5_m, 0_m};

class CommandsThroughC : public TwinScene {};

TEST_F(CommandsThroughC, PushesGiveTheSameState) {
  const lks_body box = c::id_of(box_);
  const lks_i64x3 impulse = c::raw_of(k_impulse), force = c::raw_of(k_force);
  const lks_i32x3 point = c::raw_of(k_point);
  const Vec3<AngularImpulse> turn{AngularImpulse::from_integer(40), {}, {}};
  const Vec3<Torque> torque{{}, Torque::from_integer(700), {}};
  const lks_i64x3 raw_turn = c::raw_of(turn), raw_torque = c::raw_of(torque);
  for (const Frame frame : {Frame::world, Frame::body}) {
    const auto f = static_cast<std::uint32_t>(frame);
    expect_same(world_->apply(ApplyImpulse{box_, k_impulse, frame}),
                lks_apply_impulse(twin_, box, &impulse, f), "impulse");
    expect_same(world_->apply(ApplyImpulseAt{box_, k_impulse, k_point, frame}),
                lks_apply_impulse_at(twin_, box, &impulse, &point, f), "impulse at");
    expect_same(world_->apply(ApplyAngularImpulse{box_, turn, frame}),
                lks_apply_angular_impulse(twin_, box, &raw_turn, f), "angular impulse");
    expect_same(world_->apply(ApplyForce{box_, k_force, frame}),
                lks_apply_force(twin_, box, &force, f), "force");
    expect_same(world_->apply(ApplyForceAt{box_, k_force, k_point, frame}),
                lks_apply_force_at(twin_, box, &force, &point, f), "force at");
    expect_same(world_->apply(ApplyTorque{box_, torque, frame}),
                lks_apply_torque(twin_, box, &raw_torque, f), "torque");
    step(20);
  }
}

TEST_F(CommandsThroughC, APushFarFromTheBodyIsRefusedAlike) {
  const lks_i64x3 impulse = c::raw_of(k_impulse);
  const lks_i32x3 far{INT32_MAX, 0, 0};
  expect_same(world_->apply(ApplyImpulseAt{box_, k_impulse, {Length::max(), {}, {}}, Frame::world}),
              lks_apply_impulse_at(twin_, c::id_of(box_), &impulse, &far, LKS_FRAME_WORLD),
              "too far");
}

TEST_F(CommandsThroughC, MotionsGiveTheSameState) {
  const lks_body ball = c::id_of(ball_), lift = c::id_of(lift_);
  const Quat turned = from_axis_angle({{}, Unit::from_integer(1), {}}, 30_deg);
  const Vec3<Position> place{2_m, 8_m, 1_m};
  const lks_pose pose{c::raw_of(place), c::raw_of(turned)};
  const Vec3<Velocity> velocity{3_mps, 1_mps, 0_mps};
  const Vec3<AngularVelocity> omega{AngularVelocity::from_integer(2), {}, {}};
  const lks_i64x3 raw_velocity = c::raw_of(velocity), raw_omega = c::raw_of(omega);
  const Vec3<Position> near{20_m, 3.1_m, 0_m};
  const lks_pose near_pose{c::raw_of(near), c::raw_of(Quat{})};
  expect_same(world_->apply(Teleport{ball_, place, turned}), lks_teleport(twin_, ball, &pose),
              "teleport");
  expect_same(world_->apply(SetVelocity{ball_, velocity}),
              lks_set_velocity(twin_, ball, &raw_velocity), "velocity");
  expect_same(world_->apply(SetAngularVelocity{ball_, omega}),
              lks_set_angular_velocity(twin_, ball, &raw_omega), "angular velocity");
  expect_same(world_->apply(MoveKinematic{lift_, near, {}}),
              lks_move_kinematic(twin_, lift, &near_pose), "move");
  expect_same(world_->apply(MoveKinematic{ball_, near, {}}),
              lks_move_kinematic(twin_, ball, &near_pose), "move of a dynamic body");
  step(60);
}

TEST_F(CommandsThroughC, SettingsGiveTheSameState) {
  const lks_body box = c::id_of(box_), lift = c::id_of(lift_);
  const Surface surface{
      0.9_r, 0.25_r, 0.01_r, CombineRule::minimum, CombineRule::average, CombineRule::multiply, 77};
  const lks_surface raw_surface = c::raw_of(surface);
  const SurfaceMotion belt{{2_mps, 0_mps, 0_mps}, {{}, Rate::from_integer(1), {}}};
  const lks_surface_motion raw_belt{c::raw_of(belt.velocity), c::raw_of(belt.turning)};
  const CollisionFilter filter{2, 5, -3};
  const lks_filter raw_filter{2, 5, -3};
  const Number scale = Number::from_ratio(1, 2);
  const Rate slow = Rate::from_ratio(1, 3), slower = Rate::from_ratio(1, 5);
  const SpeedLimit limit{20_mps, AngularVelocity::from_integer(9)};
  expect_same(world_->apply(SetMaterial{box_, surface}), lks_set_material(twin_, box, &raw_surface),
              "material");
  expect_same(world_->apply(SetSurfaceMotion{lift_, belt}),
              lks_set_surface_motion(twin_, lift, &raw_belt), "surface motion");
  expect_same(world_->apply(SetGravityScale{box_, scale}),
              lks_set_gravity_scale(twin_, box, scale.raw), "gravity scale");
  expect_same(world_->apply(SetDamping{box_, slow, slower}),
              lks_set_damping(twin_, box, slow.raw, slower.raw), "damping");
  expect_same(world_->apply(SetAxisLocks{box_, {.move_z = true, .turn_x = true}}),
              lks_set_axis_locks(twin_, box, LKS_LOCK_MOVE_Z | LKS_LOCK_TURN_X), "locks");
  expect_same(world_->apply(SetSpeedLimit{box_, limit}),
              lks_set_speed_limit(twin_, box, limit.linear.raw, limit.angular.raw), "limit");
  expect_same(world_->apply(SetFilter{box_, filter}), lks_set_filter(twin_, box, &raw_filter),
              "filter");
  expect_same(world_->apply(SetEvents{box_, {false, SolverVelocity::from_integer(2)}}),
              lks_set_events(twin_, box, 0, 2 << LKS_SPEED_BITS), "events");
  expect_same(world_->apply(SetUserData{box_, 1234}), lks_set_user_data(twin_, box, 1234), "data");
  expect_same(world_->apply(SetAllowSleep{box_, false}), lks_set_allow_sleep(twin_, box, 0),
              "allow sleep");
  step(20);
}

TEST_F(CommandsThroughC, AViewShowsTheBodyAsTheCoreDoes) {
  const Surface surface{
      0.9_r, 0.25_r, 0.01_r, CombineRule::minimum, CombineRule::average, CombineRule::multiply, 77};
  const lks_surface raw_surface = c::raw_of(surface);
  const lks_body box = c::id_of(box_);
  expect_same(world_->apply(SetMaterial{box_, surface}), lks_set_material(twin_, box, &raw_surface),
              "material");
  expect_same(world_->apply(SetAxisLocks{box_, {.move_z = true, .turn_x = true}}),
              lks_set_axis_locks(twin_, box, LKS_LOCK_MOVE_Z | LKS_LOCK_TURN_X), "locks");
  expect_same(world_->apply(SetEvents{box_, {false, SolverVelocity::from_integer(2), true}}),
              lks_set_events(twin_, box, LKS_BODY_PERSIST_EVENTS, 2 << LKS_SPEED_BITS), "events");
  expect_same(world_->apply(SetUserData{box_, 1234}), lks_set_user_data(twin_, box, 1234), "data");
  expect_same(world_->apply(SetAllowSleep{box_, false}), lks_set_allow_sleep(twin_, box, 0),
              "allow sleep");
  step(20);
  const BodyView view = world_->body(box_);
  lks_body_view raw{};
  raw.size = sizeof raw;
  ASSERT_EQ(lks_body_get(twin_, box, &raw), LKS_OK);
  EXPECT_EQ(c::surface_of(raw.surface, ""), view.surface);
  EXPECT_EQ(c::locks_of(raw.locks, ""), view.locks);
  EXPECT_EQ(c::events_of(raw.events, raw.hit_speed, ""), view.events);
  EXPECT_EQ(c::vec<Position>(raw.centre_of_mass), view.centre_of_mass);
  EXPECT_EQ(c::vec<AngularVelocity>(raw.angular_velocity), view.angular_velocity);
  EXPECT_EQ(raw.flags, 0U);
  EXPECT_EQ(raw.user_data, 1234U);
}

TEST_F(CommandsThroughC, ChangesOfABodyGiveTheSameState) {
  const lks_body box = c::id_of(box_), ball = c::id_of(ball_);
  const Shape small = Shape::box(0.25_m, 0.5_m, 0.25_m);
  const lks_shape raw_small = c::raw_of(small);
  const MomentOfInertia one = MomentOfInertia::from_integer(1);
  const MassData data{9_kg, {one, one, one}};
  const lks_i64x3 inertia = c::raw_of(data.inertia);
  expect_same(world_->apply(SetShape{box_, small, 8_kg}),
              lks_set_shape(twin_, box, &raw_small, Mass(8_kg).raw), "shape");
  expect_same(world_->apply(SetMassData{box_, data}),
              lks_set_mass_data(twin_, box, data.mass.raw, &inertia), "mass data");
  lks_body_view raw{};
  raw.size = sizeof raw;
  ASSERT_EQ(lks_body_get(twin_, box, &raw), LKS_OK);
  EXPECT_EQ(c::vec<MomentOfInertia>(raw.inertia), world_->body(box_).mass.inertia);
  expect_same(world_->apply(SetMassData{box_, {}}), lks_set_mass_data(twin_, box, 0, nullptr),
              "mass data of the solid");
  step(5);
  expect_same(world_->apply(SetEnabled{ball_, false}), lks_set_enabled(twin_, ball, 0), "disable");
  step(5);
  expect_same(world_->apply(SetEnabled{ball_, true}), lks_set_enabled(twin_, ball, 1), "enable");
  expect_same(world_->apply(SetMotionType{ball_, MotionType::static_body, {}}),
              lks_set_motion_type(twin_, ball, LKS_STATIC, 0), "static");
  step(5);
  expect_same(world_->apply(SetMotionType{ball_, MotionType::dynamic, 3_kg}),
              lks_set_motion_type(twin_, ball, LKS_DYNAMIC, Mass(3_kg).raw), "dynamic");
  step(20);
}

TEST_F(CommandsThroughC, RulesGiveTheSameState) {
  const PairSurface ice{.friction = 0.01_r, .restitution = 0.5_r, .rolling_resistance = {}};
  const lks_pair_surface raw{ice.friction.raw, ice.restitution.raw, 0};
  const lks_body ball = c::id_of(ball_), box = c::id_of(box_), lift = c::id_of(lift_);
  expect_same(world_->apply(SetPairRule{ball_, box_, {.collides = false}}),
              lks_set_pair_rule(twin_, ball, box, 0, nullptr), "ignored");
  expect_same(world_->apply(SetPairRule{lift_, box_, {.surface = ice}}),
              lks_set_pair_rule(twin_, lift, box, 1, &raw), "surface of a pair");
  expect_same(world_->apply(SetSurfaceRule{0, 7, ice}), lks_set_surface_rule(twin_, 0, 7, &raw),
              "surface of tags");
  const Vec3<Unit> up{{}, Unit::from_integer(1), {}};
  const lks_unit3 raw_up = c::raw_of(up);
  expect_same(world_->apply(SetOneWay{lift_, {.direction = up, .tolerance = 30}}),
              lks_set_one_way(twin_, lift, &raw_up, 30), "one way");
  expect_same(world_->apply(SetOneWay{box_, {.direction = up}}),
              lks_set_one_way(twin_, box, &raw_up, 60), "a dynamic body");
  step(20);
  lks_pair_surface read{};
  uint32_t collides = 0, has_surface = 0, tolerance = 0;
  ASSERT_EQ(lks_pair_rule_get(twin_, box, lift, &collides, &has_surface, &read), LKS_OK);
  EXPECT_EQ(collides, 1U);
  EXPECT_EQ(has_surface, 1U);
  EXPECT_EQ(read.friction, ice.friction.raw);
  ASSERT_EQ(lks_surface_rule_get(twin_, 7, 0, &has_surface, &read), LKS_OK);
  EXPECT_EQ(read.restitution, ice.restitution.raw);
  lks_unit3 direction{};
  ASSERT_EQ(lks_one_way_get(twin_, lift, &direction, &tolerance), LKS_OK);
  EXPECT_EQ(c::vec<Unit>(direction), up);
  EXPECT_EQ(tolerance, 30U);
}

TEST_F(CommandsThroughC, AVehicleGivesTheSameState) {
  const VehicleDef car = make_car(3_m, 0.8_m, -0.25_m, Torque::from_integer(300));
  lks_vehicle_def raw{};
  ASSERT_EQ(lks_make_car(Length(3_m).raw, Length(0.8_m).raw, Length(-0.25_m).raw,
                         Torque::from_integer(300).raw, &raw, sizeof raw),
            LKS_OK);
  const lks_body box = c::id_of(box_);
  expect_same(world_->apply(SetVehicle{box_, car}), lks_set_vehicle(twin_, box, &raw), "vehicle");
  lks_vehicle_controls controls;
  ASSERT_EQ(lks_vehicle_controls_init(&controls, sizeof controls), LKS_OK);
  controls.throttle = Unit::from_integer(1).raw;
  controls.steer = Unit::from_ratio(1, 3).raw;
  const VehicleControls same{.throttle = Unit::from_integer(1), .steer = Unit::from_ratio(1, 3)};
  expect_same(world_->apply(DriveVehicle{box_, same}), lks_drive_vehicle(twin_, box, &controls),
              "controls");
  expect_same(world_->apply(DriveVehicle{ball_, same}),
              lks_drive_vehicle(twin_, c::id_of(ball_), &controls), "no chassis");
  step(100);
  lks_vehicle_view view{};
  view.size = sizeof view;
  ASSERT_EQ(lks_vehicle_get(twin_, box, &view), LKS_OK);
  EXPECT_EQ(view.wheel_count, 4U);
  EXPECT_EQ(view.engine_speed, vehicle_of(*world_, box_)->engine_speed.raw);
  EXPECT_EQ(view.wheels[3].load, vehicle_of(*world_, box_)->wheels[3].load.raw);
  expect_same(world_->apply(SetVehicle{box_, {}}), lks_set_vehicle(twin_, box, nullptr), "removed");
  EXPECT_EQ(lks_vehicle_get(twin_, box, &view), LKS_INVALID_ARGUMENT);
}

TEST_F(CommandsThroughC, MotorcyclesAndTanksGiveTheSameState) {
  lks_vehicle_def raw{};
  const lks_body box = c::id_of(box_);
  ASSERT_EQ(lks_make_motorcycle(Length(1.5_m).raw, Length(-0.25_m).raw,
                                Torque::from_integer(60).raw, &raw, sizeof raw),
            LKS_OK);
  EXPECT_EQ(raw.kind, static_cast<std::uint32_t>(LKS_VEHICLE_MOTORCYCLE));
  raw.max_lean = Angle(0.6_rad).raw;
  VehicleDef cycle = make_motorcycle(1.5_m, -0.25_m, Torque::from_integer(60));
  cycle.max_lean = 0.6_rad;
  expect_same(world_->apply(SetVehicle{box_, cycle}), lks_set_vehicle(twin_, box, &raw), "cycle");
  step(30);
  lks_vehicle_view view{};
  view.size = sizeof view;
  ASSERT_EQ(lks_vehicle_get(twin_, box, &view), LKS_OK);
  EXPECT_EQ(view.lean, vehicle_of(*world_, box_)->lean.raw);
  ASSERT_EQ(lks_make_tank(Length(3_m).raw, Length(1_m).raw, Length(-0.25_m).raw,
                          Torque::from_integer(900).raw, &raw, sizeof raw),
            LKS_OK);
  const VehicleDef tank = make_tank(3_m, 1_m, -0.25_m, Torque::from_integer(900));
  expect_same(world_->apply(SetVehicle{box_, tank}), lks_set_vehicle(twin_, box, &raw), "tank");
  step(30);
  raw.kind = 3;
  EXPECT_EQ(lks_set_vehicle(twin_, box, &raw), LKS_INVALID_ARGUMENT);
}

TEST_F(CommandsThroughC, GroupsOfMeshesAreSwitchedAlike) {
  const BodyHandle panels = add(MotionType::static_body, {ShapeKind::mesh, {}, panels_}, 20, 0);
  const lks_body raw = c::id_of(panels);
  for (const std::uint32_t group : {0U, 1U, 2U})
    expect_same(world_->apply(SetMeshGroup{panels, group, group == 1}),
                lks_set_mesh_group(twin_, raw, group, group == 1), "group");
  std::uint32_t is_on = 1;
  ASSERT_EQ(lks_mesh_group_get(twin_, raw, 0, &is_on), LKS_OK);
  EXPECT_EQ(is_on, 0U);
  EXPECT_EQ(lks_mesh_group_get(twin_, raw, 2, &is_on), LKS_INVALID_ARGUMENT);
  EXPECT_EQ(lks_set_mesh_group(twin_, c::id_of(box_), 0, 0), LKS_NOT_FOUND);
  EXPECT_EQ(lks_set_mesh_group(twin_, raw, 0, 2), LKS_INVALID_ARGUMENT);
}

TEST_F(CommandsThroughC, TerrainGivesTheSameState) {
  const BodyHandle ground =
      add(MotionType::static_body, {ShapeKind::height_field, {}, field_}, 20, 0);
  const lks_body raw_ground = c::id_of(ground);
  const std::array<Length, 4> heights{1_m, 2_m, 3_m, -1_m};
  std::array<lks_length, 4> raw_heights{};
  for (std::size_t i = 0; i < 4; ++i)
    raw_heights[i] = heights[i].raw;
  const std::array<std::uint8_t, 1> hole{1};
  const lks_height_rectangle corner{1, 0, 2, 2};
  const SetHeights command{
      .body = ground, .column = 1, .columns = 2, .rows = 2, .heights = heights, .holes = hole};
  expect_same(world_->apply(command),
              lks_set_heights(twin_, raw_ground, &corner, raw_heights.data(), hole.data(), nullptr),
              "heights");
  const lks_height_rectangle beyond{2, 0, 2, 0x40000000};
  EXPECT_EQ(lks_set_heights(twin_, raw_ground, &beyond, raw_heights.data(), nullptr, nullptr),
            LKS_INVALID_ARGUMENT);
  EXPECT_EQ(lks_set_heights(twin_, c::id_of(box_), &corner, raw_heights.data(), nullptr, nullptr),
            LKS_NOT_FOUND);
  lks_length height = 0;
  std::uint32_t is_hole = 0, surface = 0, tiles = 0;
  ASSERT_EQ(lks_terrain_sample_get(twin_, raw_ground, 1, 0, &height, &is_hole, &surface), LKS_OK);
  EXPECT_EQ(height, Length(1_m).raw);
  EXPECT_EQ(is_hole, 1U);
  EXPECT_EQ(surface, 255U);
  EXPECT_EQ(lks_terrain_sample_get(twin_, raw_ground, 3, 0, &height, &is_hole, &surface),
            LKS_INVALID_ARGUMENT);
  ASSERT_EQ(lks_terrain_tile_count(twin_, &tiles), LKS_OK);
  EXPECT_EQ(tiles, 1U);
  step(20);
}

TEST_F(CommandsThroughC, AFluidGivesTheSameState) {
  Fluid water{.surface = {1_m, 2_m, 3_m}, .size = {40_m, 9_m, 30_m}};
  water.density = Density::from_integer(1000);
  water.drag = Number::from_ratio(1, 2);
  water.linear_drag = Rate::from_ratio(1, 4);
  water.flow = {1_mps, {}, -1_mps};
  water.mask = 7;
  lks_fluid raw;
  ASSERT_EQ(lks_fluid_init(&raw, sizeof raw), LKS_OK);
  raw.surface = c::raw_of(water.surface);
  raw.extents = c::raw_of(water.size);
  raw.density = water.density.raw;
  raw.drag = water.drag.raw;
  raw.linear_drag = water.linear_drag.raw;
  raw.flow = c::raw_of(water.flow);
  raw.mask = water.mask;
  expect_same(world_->apply(SetFluid{2, water}), lks_set_fluid(twin_, 2, &raw), "fluid");
  lks_fluid read{};
  read.size = sizeof read;
  ASSERT_EQ(lks_fluid_get(twin_, 2, &read), LKS_OK);
  EXPECT_EQ(c::vec<Position>(read.extents), fluid_at(*world_, 2).size);
  EXPECT_EQ(read.mask, 7U);
  step(20);
  expect_same(world_->apply(SetFluid{16, water}), lks_set_fluid(twin_, 16, &raw), "no number");
}

TEST_F(CommandsThroughC, SleepAndGravityGiveTheSameState) {
  const lks_body ball = c::id_of(ball_);
  const Vec3<Acceleration> none{};
  const lks_i64x3 raw_none{};
  expect_same(world_->apply(SleepBody{ball_}), lks_sleep_body(twin_, ball), "sleep");
  step(5);
  expect_same(world_->apply(WakeBody{ball_}), lks_wake_body(twin_, ball), "wake");
  expect_same(world_->apply(SetGravity{none}), lks_set_gravity(twin_, &raw_none), "gravity");
  step(5);
  expect_same(world_->apply(DestroyBody{ball_}), lks_destroy_body(twin_, ball), "destroy");
  step(5);
}

// A definition whose every field has another value than the default, except for those of triggers
// and of static bodies.
BodyDef full_body_def() {
  BodyDef def{.motion = MotionType::dynamic, .shape = Shape::box(0.5_m, 0.5_m, 0.5_m)};
  def.position = {-5_m, 4_m, 0_m};
  def.orientation = from_axis_angle({{}, {}, Unit::from_integer(1)}, 20_deg);
  def.velocity = {1_mps, 2_mps, 3_mps};
  def.angular_velocity.y = AngularVelocity::from_integer(3);
  def.material = {0.3_r,
                  0.6_r,
                  Density::from_integer(700),
                  0.02_r,
                  CombineRule::maximum,
                  CombineRule::multiply,
                  CombineRule::average,
                  5};
  def.filter = {4, 0xff, 9};
  def.gravity_scale = Number::from_ratio(3, 2);
  def.linear_damping = Rate::from_ratio(1, 8);
  def.angular_damping = Rate::from_ratio(1, 4);
  def.fixed_rotation = true;
  def.is_bullet = true;
  def.locks.move_x = true;
  def.speed_limit = {40_mps, AngularVelocity::from_integer(20)};
  def.allow_sleep = false;
  def.user_data = 42;
  return def;
}

// The same for C.
lks_body_def full_raw_def(const BodyDef& def) {
  lks_body_def raw;
  EXPECT_EQ(lks_body_def_init(&raw, sizeof raw), LKS_OK);
  raw.shape = c::raw_of(def.shape);
  raw.position = c::raw_of(def.position);
  raw.orientation = c::raw_of(def.orientation);
  raw.velocity = c::raw_of(def.velocity);
  raw.angular_velocity = c::raw_of(def.angular_velocity);
  raw.surface = c::raw_of(def.material.surface());
  raw.density = def.material.density.raw;
  raw.filter = {4, 0xff, 9};
  raw.gravity_scale = def.gravity_scale.raw;
  raw.linear_damping = def.linear_damping.raw;
  raw.angular_damping = def.angular_damping.raw;
  raw.flags = LKS_BODY_FIXED_ROTATION | LKS_BODY_BULLET;
  raw.locks = LKS_LOCK_MOVE_X;
  raw.speed_limit = def.speed_limit.linear.raw;
  raw.angular_speed_limit = def.speed_limit.angular.raw;
  raw.user_data = 42;
  return raw;
}

TEST_F(CommandsThroughC, ABodyOfEveryFieldIsTheSame) {
  const BodyDef def = full_body_def();
  add(def, full_raw_def(def));
  step(30);
}

TEST_F(CommandsThroughC, AStaticTriggerOfEveryFieldIsTheSame) {
  BodyDef def = full_body_def();
  lks_body_def raw = full_raw_def(def);
  def.motion = MotionType::static_body;
  def.is_trigger = true;
  def.surface_motion.velocity.x = 1_mps;
  raw.motion = LKS_STATIC;
  raw.flags |= LKS_BODY_TRIGGER;
  raw.surface_motion.velocity.x = SolverVelocity(1_mps).raw;
  add(def, raw);
  step(30);
}

}  // namespace
}  // namespace lockstone
