// Springs of joints about several axes at once, to any target.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::number;
using testing::to_double;

constexpr double k_pi = 3.14159265358979;

// A body that a spring of 2 Hz turns against the world, without gravity.
struct Turner {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  JointDef def;
  JointHandle joint;

  Turner(JointKind kind, const Shape& shape, const Quat& orientation, const Vec3<Angle>& target,
         Number damping_ratio) {
    def = JointDef::of(kind, test::add_fixed(world), {});
    BodyDef body = test::dynamic_body(shape, {}, {}, {});
    body.orientation = orientation;
    def.body_b = test::add(world, body);
    for (std::size_t i = 0; i < 3; ++i) {
      if (kind != JointKind::ball) def.linear[i].mode = AxisMode::locked;
      def.angular[i].target = target[static_cast<int>(i)];
      def.angular[i].hertz = 2_r;
      def.angular[i].damping_ratio = damping_ratio;
    }
    joint = test::join(world, def);
  }
  // The rotation vector that is left, rad.
  [[nodiscard]] double left() const {
    RotationVectorD off = off_target();
    return std::sqrt(off.x * off.x + off.y * off.y + off.z * off.z);
  }
  struct RotationVectorD {
    double x, y, z;
  };
  [[nodiscard]] RotationVectorD off_target() const {
    double t[3], length = 0;
    for (int i = 0; i < 3; ++i) {
      t[i] = to_double(def.angular[static_cast<std::size_t>(i)].target);
      length += t[i] * t[i];
    }
    length = std::sqrt(length);
    const double s = length > 0 ? std::sin(length / 2) / length : 0, c = std::cos(length / 2);
    const double a[] = {-s * t[0], -s * t[1], -s * t[2], c};  // of its inverse
    const Quat q = world.body(def.body_b).orientation;
    const double b[] = {to_double(q.x), to_double(q.y), to_double(q.z), to_double(q.w)};
    double v[3];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      v[i] = a[3] * b[i] + a[i] * b[3] + a[j] * b[k] - a[k] * b[j];
    }
    const double w = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    const double sine = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (sine == 0) return {0, 0, 0};
    const double part = 2 * std::atan2(sine, std::abs(w)) / sine * (w < 0 ? -1 : 1);
    return {part * v[0], part * v[1], part * v[2]};
  }
  [[nodiscard]] double spin() const {
    const auto& w = world.body(def.body_b).angular_velocity;
    return std::hypot(to_double(w.x), to_double(w.y), to_double(w.z));
  }
  // Of a cube, in parts of its moment: kinetic energy, and that of the spring.
  [[nodiscard]] double energy() const {
    const double omega = 2 * k_pi * 2;
    return (spin() * spin() + std::pow(omega * left(), 2)) / 2;
  }
};

// A rotation vector of any direction, its length up to π.
Vec3<Angle> any_turn(test::Random& random) {
  for (;;) {
    const auto part = [&] { return random.between(-3141, 3141); };
    const std::int64_t x = part(), y = part(), z = part();
    if (x * x + y * y + z * z <= 3141 * 3141)
      return {Angle::from_ratio(x, 1000), Angle::from_ratio(y, 1000), Angle::from_ratio(z, 1000)};
  }
}

Quat any_orientation(test::Random& random) {
  const auto part = [&] { return Unit::from_ratio(random.between(-1000, 1000), 1000); };
  const Quat q{part(), part(), part(), part()};
  return q == Quat{{}, {}, {}, {}} ? Quat{} : normalized(q);
}

TEST(TurnSprings, SettleOnAnyTargetFromAnyPose) {
  test::Random random(1);
  constexpr JointKind k_kinds[] = {JointKind::ball, JointKind::six_axis, JointKind::motor};
  const Shape shapes[] = {Shape::sphere(0.2_m), Shape::box(0.3_m, 0.1_m, 0.2_m),
                          Shape::capsule(0.4_m, 0.05_m)};
  for (int i = 0; i < test::share_of(300); ++i) {
    const Quat from = any_orientation(random);
    const Vec3<Angle> to = any_turn(random);
    Turner turner(k_kinds[i % 3], shapes[i / 3 % 3], from, to, 0.7_r);
    test::step(turner.world, 240);
    EXPECT_LT(turner.left(), 1e-3) << "case " << i;
    EXPECT_LT(turner.spin(), 1e-2) << "case " << i;
  }
}

TEST(TurnSprings, SettleFromOppositeTheTarget) {
  for (int i = 0; i < 3; ++i) {
    Vec3<Angle> target;
    target[i] = Angle::from_ratio(3141592654, 1000000000);
    Turner turner(JointKind::ball, Shape::box(0.3_m, 0.1_m, 0.2_m), {}, target, 1_r);
    test::step(turner.world, 240);
    EXPECT_LT(turner.left(), 1e-3) << "axis " << i;
    EXPECT_LT(turner.spin(), 1e-2) << "axis " << i;
  }
}

TEST(TurnSprings, LoseEnergyAllTheWay) {
  test::Random random(2);
  for (int i = 0; i < 60; ++i) {
    const Quat from = any_orientation(random);
    const Vec3<Angle> to = any_turn(random);
    Turner turner(JointKind::ball, Shape::box(0.2_m, 0.2_m, 0.2_m), from, to, 0.3_r);
    if (i % 2 == 1) {
      const auto part = [&] { return AngularVelocity::from_integer(random.between(-12, 12)); };
      const Vec3<AngularVelocity> spin{part(), part(), part()};
      ASSERT_EQ(turner.world.apply(SetAngularVelocity{turner.def.body_b, spin}), Status::ok);
    }
    const double first = turner.energy();
    double before = first;
    for (int tick = 0; tick < 180; ++tick) {
      (void)turner.world.step();
      ASSERT_LT(turner.energy(), before + 0.01 * first) << "case " << i << ", tick " << tick;
      before = turner.energy();
    }
    EXPECT_LT(before, 1e-4 * first) << "case " << i;
  }
}

TEST(TurnSprings, KeepTheirEnergyUndamped) {
  test::Random random(3);
  for (int i = 0; i < 40; ++i) {
    const Quat from = any_orientation(random);
    Turner turner(JointKind::ball, Shape::box(0.2_m, 0.2_m, 0.2_m), from, any_turn(random), {});
    const double first = turner.energy();
    for (int tick = 0; tick < 600; ++tick) {
      (void)turner.world.step();
      ASSERT_NEAR(turner.energy(), first, 0.02 * first) << "case " << i << ", tick " << tick;
    }
  }
}

// The axis points where it should; the twist about it is free.
TEST(TurnSprings, TiltsPointAnAxisAnywhere) {
  test::Random random(4);
  for (int i = 0; i < 60; ++i) {
    Turner turner(JointKind::ball, Shape::box(0.3_m, 0.1_m, 0.2_m), any_orientation(random), {},
                  0.7_r);
    const Vec3<Angle> turn = any_turn(random);
    AngularAxis tilt = turner.def.angular[1];
    tilt.target = turn.y;
    ASSERT_EQ(turner.world.apply(SetAngularAxis{turner.joint, 1, tilt}), Status::ok);
    tilt.target = turn.z;
    ASSERT_EQ(turner.world.apply(SetAngularAxis{turner.joint, 2, tilt}), Status::ok);
    ASSERT_EQ(turner.world.apply(SetAngularAxis{turner.joint, 0, {}}), Status::ok);
    test::step(turner.world, 300);
    const double y = to_double(turn.y), z = to_double(turn.z), length = std::hypot(y, z);
    const double s = length > 0 ? std::sin(length) / length : 1;
    const Vec3<Unit> axis = to_matrix(turner.world.body(turner.def.body_b).orientation).x;
    EXPECT_NEAR(to_double(axis.x), std::cos(length), 1e-3) << "case " << i;
    EXPECT_NEAR(to_double(axis.y), s * z, 1e-3) << "case " << i;
    EXPECT_NEAR(to_double(axis.z), -s * y, 1e-3) << "case " << i;
  }
}

// At rest against a load, the joint's torque is the load.
TEST(TurnSprings, ReportTheirTorque) {
  Turner turner(JointKind::ball, Shape::box(0.2_m, 0.2_m, 0.2_m), {}, {1.2_rad, -1.1_rad, 1.9_rad},
                1_r);
  const Vec3<Torque> load{3_Nm, -2_Nm, 5_Nm};
  for (int tick = 0; tick < 300; ++tick) {
    (void)turner.world.apply(ApplyTorque{turner.def.body_b, load});
    (void)turner.world.step();
  }
  const JointView view = turner.world.joint(turner.joint);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(to_double(view.torque[i]), -to_double(load[i]), 0.01) << "axis " << i;
}

}  // namespace
}  // namespace lockstone
