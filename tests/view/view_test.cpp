// Shown poses: between ticks, over corrections, teleports, new and removed bodies.
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/quat.h>
#include <lockstone/view.h>

namespace lockstone {
namespace {

using namespace literals;

constexpr double k_tick = 1.0 / 60;
const Vec3<Unit> k_up{{}, 1_r, {}};

TickPose at_x(Position x, Velocity speed = {}) {
  return {{x, {}, {}}, {}, {speed, {}, {}}};
}

TickPose turned(Angle angle) {
  return {{}, from_axis_angle(k_up, angle), {}};
}

double x_of(const PoseTrack& track, double fraction) {
  return track.at<double>(fraction).position[0];
}

/// About the y axis, radians.
double angle_of(const PoseTrack& track, double fraction) {
  const auto q = track.at<double>(fraction).orientation;
  return 2 * std::atan2(q[1], q[3]);
}

TEST(PoseTrack, InterpolatesBetweenTicks) {
  PoseTrack track;
  track.advance(at_x(1_m), k_tick);
  EXPECT_EQ(x_of(track, 0), 1);
  EXPECT_EQ(x_of(track, 1), 1);
  track.advance(at_x(2_m), k_tick);
  EXPECT_EQ(x_of(track, 0), 1);
  EXPECT_EQ(x_of(track, 0.25), 1.25);
  EXPECT_EQ(x_of(track, 1), 2);
  EXPECT_EQ(x_of(track, -1), 1);  // beyond, as at the ends
  EXPECT_EQ(x_of(track, 7), 2);
}

TEST(PoseTrack, TurnsAtConstantSpeedTheShorterWay) {
  PoseTrack track;
  track.restart(turned(170_deg));
  track.advance(turned(-170_deg), k_tick);  // 20 degrees further
  for (int i = 0; i <= 10; ++i) {
    const double expected = (170 + 2 * i) * std::numbers::pi / 180;
    const double shown =
        std::fmod(angle_of(track, i / 10.0) + 2 * std::numbers::pi, 2 * std::numbers::pi);
    EXPECT_NEAR(shown, expected, 1e-7);
  }
}

TEST(PoseTrack, GivesFloatsAsSteadyFarOutAsAtTheOrigin) {
  PoseTrack track;
  const Vec3<Position> camera{1000000_m, {}, -1000000_m};
  track.restart({{1000000.001_m, {}, -1000000.25_m}, {}, {}});
  const ViewPose<float> pose = track.at<float>(1, camera);
  EXPECT_NEAR(pose.position[0], 0.001, 1e-8);
  EXPECT_NEAR(pose.position[2], -0.25, 1e-8);
}

TEST(PoseTrack, ShowsATeleportAtOnce) {
  PoseTrack track;
  track.restart(at_x(0_m));
  track.advance(at_x(3_m), k_tick);  // no speed explains it
  EXPECT_EQ(x_of(track, 0), 3);
  track.advance(at_x(10_m, 420_mps), k_tick);  // 7 m in a tick, by its speed
  EXPECT_EQ(x_of(track, 0), 3);
  EXPECT_EQ(x_of(track, 0.5), 6.5);
  track.advance(at_x(11_m), k_tick);
  track.cut();  // too short to be recognised
  EXPECT_EQ(x_of(track, 0), 11);
}

TEST(PoseTrack, StaysWhereItIsWhenATickIsComputedAgain) {
  PoseTrack track;
  track.restart(at_x(0_m));
  track.advance(at_x(1_m), k_tick);
  const double before = x_of(track, 0.5);
  track.correct(at_x(1.5_m));
  EXPECT_EQ(x_of(track, 0.5), before);
  EXPECT_EQ(x_of(track, 1), 1);
  track.correct(at_x(1.75_m));
  track.correct(at_x(1.75_m));
  EXPECT_EQ(x_of(track, 1), 1);
}

TEST(PoseTrack, LosesACorrectionByTheTimeConstant) {
  const ViewSettings settings{.time_constant = 0.2};
  PoseTrack track;
  track.restart(at_x(0_m));
  track.correct(at_x(1_m), settings);
  for (int tick = 1; tick <= 60; ++tick) {
    const double start = x_of(track, 1);
    track.advance(at_x(1_m), k_tick, settings);
    EXPECT_EQ(x_of(track, 0), start);  // no jump from tick to tick
    EXPECT_NEAR(x_of(track, 1), 1 - std::exp(-tick * k_tick / 0.2), 1e-12);
  }
  // Several ticks at once are as many one by one.
  PoseTrack slow;
  slow.restart(at_x(0_m));
  slow.correct(at_x(1_m), settings);
  slow.advance(at_x(1_m), 60 * k_tick, settings);
  EXPECT_NEAR(x_of(slow, 1), x_of(track, 1), 1e-12);
}

TEST(PoseTrack, TurnsBackByTheTimeConstant) {
  PoseTrack track;
  track.restart(turned(0_deg));
  track.correct(turned(60_deg));
  EXPECT_NEAR(angle_of(track, 1), 0, 1e-8);
  double angle = 60 * std::numbers::pi / 180;
  for (int tick = 1; tick <= 30; ++tick) {
    track.advance(turned(60_deg), k_tick);
    EXPECT_NEAR(angle_of(track, 1), angle * (1 - std::exp(-tick * k_tick / 0.1)), 1e-7);
  }
}

TEST(PoseTrack, ShowsGreatCorrectionsAtOnce) {
  PoseTrack track;
  track.restart(at_x(0_m));
  track.correct(at_x(1.5_m));
  EXPECT_EQ(x_of(track, 1), 0);
  track.correct(at_x(2.5_m));
  EXPECT_EQ(x_of(track, 0), 2.5);

  track.restart(turned(0_deg));
  track.correct(turned(80_deg));
  EXPECT_NEAR(angle_of(track, 1), 0, 1e-8);
  track.correct(turned(100_deg));
  EXPECT_NEAR(angle_of(track, 0), 100 * std::numbers::pi / 180, 1e-7);

  const ViewSettings unsmoothed{.time_constant = 0};
  track.restart(at_x(0_m));
  track.correct(at_x(0.5_m), unsmoothed);
  EXPECT_EQ(x_of(track, 0), 0.5);
}

// --- View

World small_world() {
  return World::create({.body_capacity = 4, .gravity = {}}).value();
}

BodyHandle flying(World& world, Velocity speed) {
  return world.create_body({.velocity = {speed, {}, {}}}).value();
}

double x_of(const View& view, BodyHandle body, double fraction) {
  return view.pose<double>(body, fraction).value().position[0];
}

TEST(View, ShowsBodiesBetweenTicks) {
  World world = small_world();
  const BodyHandle ball = flying(world, 6_mps);
  View view;
  EXPECT_FALSE(view.shows(ball));
  EXPECT_FALSE(view.pose(ball, 0).has_value());
  view.update(world);
  EXPECT_EQ(x_of(view, ball, 1), 0);
  (void)world.step();
  view.update(world);
  view.update(world);  // does no harm
  EXPECT_EQ(view.tick(), 1U);
  EXPECT_EQ(x_of(view, ball, 0), 0);
  EXPECT_NEAR(x_of(view, ball, 0.5), 0.05, 1e-9);
  EXPECT_NEAR(x_of(view, ball, 1), 0.1, 1e-9);
  const auto pose = view.pose(ball, 1);
  static_assert(std::is_same_v<decltype(pose)::value_type, ViewPose<float>>);
  EXPECT_FALSE(view.pose(BodyHandle{}, 1).has_value());
}

TEST(View, DoesNotGlideBetweenBodiesOfOneSlot) {
  World world = small_world();
  const BodyHandle first = flying(world, 6_mps);
  View view;
  view.update(world);
  (void)world.apply(DestroyBody{first});
  const BodyHandle second = world.create_body({.position = {1_m, {}, {}}}).value();
  ASSERT_EQ(second.index, first.index);
  (void)world.step();
  view.update(world);
  EXPECT_FALSE(view.shows(first));
  EXPECT_EQ(x_of(view, second, 0), 1);
  (void)world.apply(DestroyBody{second});
  (void)world.step();
  view.update(world);
  EXPECT_FALSE(view.shows(second));
}

TEST(View, ShowsTeleportsAtOnceAndShortOnesAfterACut) {
  World world = small_world();
  const BodyHandle ball = flying(world, 6_mps);
  View view;
  view.update(world);
  (void)world.apply(Teleport{ball, {50_m, {}, {}}, {}});
  (void)world.step();
  view.update(world);
  EXPECT_NEAR(x_of(view, ball, 0), 50.1, 1e-9);
  (void)world.apply(Teleport{ball, {51_m, {}, {}}, {}});
  (void)world.step();
  view.update(world);
  EXPECT_NEAR(x_of(view, ball, 0), 50.1, 1e-9);  // glides
  view.cut(ball);
  EXPECT_NEAR(x_of(view, ball, 0), 51.1, 1e-9);
  view.cut({});  // no body: nothing
}

TEST(View, SmoothsARollback) {
  World world = small_world();
  const BodyHandle ball = flying(world, 6_mps);
  std::vector<std::byte> saved(world.snapshot_bytes_max(SnapshotKind::native));
  View view;
  const auto tick = [&] {
    (void)world.step();
    view.update(world);
  };
  for (int i = 0; i < 10; ++i) {
    if (i == 5) saved.resize(world.save(SnapshotKind::native, saved));
    tick();
  }
  const double shown = x_of(view, ball, 0.75);
  ASSERT_EQ(world.load(SnapshotKind::native, saved), Status::ok);
  view.update(world);
  EXPECT_EQ(x_of(view, ball, 0.75), shown);  // the past is not shown
  (void)world.apply(SetVelocity{ball, {12_mps, {}, {}}});
  for (int i = 5; i < 10; ++i)
    tick();
  EXPECT_NEAR(x_of(view, ball, 0.75), shown, 1e-12);  // half a metre off, unseen
  double last = x_of(view, ball, 1);
  for (int i = 0; i < 60; ++i) {
    tick();
    EXPECT_NEAR(x_of(view, ball, 0), last, 1e-12);
    last = x_of(view, ball, 1);
    EXPECT_LT(last - x_of(view, ball, 0), 0.2 + 0.5 * (1 - std::exp(-k_tick / 0.1)) + 1e-9);
  }
  const double truth = static_cast<double>(world.position(ball).x.raw) * 0x1p-32;
  EXPECT_NEAR(last, truth, 0.5 * std::exp(-1 / 0.1) + 1e-9);
}

TEST(View, ForgetsEverythingOnReset) {
  World world = small_world();
  const BodyHandle ball = flying(world, 6_mps);
  (void)world.step();
  View view;
  view.update(world);
  World other = small_world();
  const BodyHandle same = other.create_body({.position = {1_m, {}, {}}}).value();
  ASSERT_EQ(same, ball);
  view.update(other);  // an earlier tick: taken for the past
  EXPECT_NEAR(x_of(view, ball, 1), 0.1, 1e-9);
  view.reset();
  EXPECT_FALSE(view.shows(ball));
  view.update(other);
  EXPECT_EQ(x_of(view, ball, 0), 1);
}

// --- TickClock

TEST(TickClock, RunsEvenlyWhereTicksAreSeenOnceAFrame) {
  TickClock clock(60);
  double shown = 0, widest = 0;
  for (int frame = 0; frame < 1440; ++frame) {  // 144 frames a second
    const std::int64_t now_us = std::int64_t{frame} * 1'000'000 / 144;
    const std::uint64_t tick = 1 + static_cast<std::uint64_t>(now_us * 60 / 1'000'000);
    clock.update(tick, now_us);
    const double next = static_cast<double>(tick) + clock.fraction();
    if (frame > 720) widest = std::max(widest, std::abs(next - shown - 60.0 / 144));
    shown = next;
  }
  EXPECT_LT(widest, 0.04);  // of a tick
}

TEST(TickClock, HoldsWhileATickIsLateAndGoesOn) {
  TickClock clock(60);
  clock.update(1, 0);
  EXPECT_EQ(clock.fraction(), 0);
  clock.update(1, 8'333);
  EXPECT_NEAR(clock.fraction(), 0.5, 1e-3);
  clock.update(1, 50'000);
  EXPECT_EQ(clock.fraction(), 1);
  clock.update(2, 50'000);
  EXPECT_EQ(clock.fraction(), 0);
  clock.update(3, 50'000);  // two ticks of one frame
  EXPECT_EQ(clock.fraction(), 0);
  clock.update(0, 60'000);  // another match
  EXPECT_EQ(clock.fraction(), 0);
}

}  // namespace
}  // namespace lockstone
