// Impacts within a tick: the energy after them.

#include "core/dynamics/impact/impact_response.h"

#include <gtest/gtest.h>

#include <lockstone/quat.h>

#include "tests/geometry/scene.h"

namespace lockstone {
namespace {

using test::Dice;
using test::metres;

double value(Velocity v) {
  return static_cast<double>(v.raw) / 4294967296.0;
}

double dot(const Vec3<Velocity>& a, const Vec3<Velocity>& b) {
  return value(a.x) * value(b.x) + value(a.y) * value(b.y) + value(a.z) * value(b.z);
}

// Twice the kinetic energy per mass.
double energy_of(const BodyRecord& body, const InverseInertia& inertia) {
  return dot(body.velocity, body.velocity) + dot(body.spin, surface_velocity(inertia, body.spin));
}

Vec3<Velocity> random_velocity(Dice& dice) {
  Vec3<Velocity> result;
  for (int i = 0; i < 3; ++i)
    result[i] = Velocity::from_raw(static_cast<std::int64_t>(dice.uniform(-10, 10) * 4294967296.0));
  return result;
}

BodyRecord random_body(Dice& dice, std::uint8_t locks) {
  BodyRecord body;
  body.motion = static_cast<std::uint8_t>(MotionType::dynamic);
  body.shape_kind = static_cast<std::uint8_t>(ShapeKind::box);
  body.orientation = dice.orientation();
  for (int i = 0; i < 3; ++i)
    body.inertia[i] =
        Unit::from_raw(static_cast<std::int32_t>(dice.uniform(0.02, 0.4) * 1073741824.0));
  body.inverse_mass = 1 << 30;
  body.locks = locks;
  body.velocity = random_velocity(dice);
  body.spin = random_velocity(dice);
  for (int i = 0; i < 3; ++i) {
    if (body.is_locked(i)) body.velocity[i] = {};
    if (body.is_turn_locked(i)) body.spin[i] = {};
  }
  return body;
}

Manifold random_manifold(Dice& dice) {
  Manifold manifold;
  manifold.normal = to_matrix(dice.orientation()).column(1);
  manifold.count = static_cast<int>(dice.between(1, 4));
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis)
      point.anchor_b[axis] = metres(dice.uniform(-1, 1));
  }
  return manifold;
}

// Against immovable bodies, whatever axes are locked.
TEST(ImpactResponse, GainsNoEnergy) {
  Dice dice;
  int bounced = 0;
  for (int round = 0; round < 3000; ++round) {
    BodyRecord wall;
    BodyRecord body = random_body(dice, static_cast<std::uint8_t>(dice.between(0, 63)));
    const InverseInertia inertia = inverse_inertia(body, to_matrix(body.orientation));
    const InverseInertia none{};
    const Manifold manifold = random_manifold(dice);
    const double before = energy_of(body, inertia);
    const Coefficient friction = Coefficient::from_ratio(dice.between(0, 15), 8);
    const Coefficient restitution = Coefficient::from_ratio(dice.between(0, 8), 8);
    const Velocity approach =
        answer_impact({wall, none}, {body, inertia}, {manifold, friction, restitution, Velocity{}});
    ASSERT_LE(energy_of(body, inertia), before * (1 + 1e-3) + 1e-6) << "round " << round;
    if (approach > Velocity{}) ++bounced;
  }
  EXPECT_GT(bounced, 1000);
}

// A bounce that needs no impulse besides restitution's keeps all of it.
TEST(ImpactResponse, ReturnsAFullBounceWhole) {
  BodyRecord wall;
  Dice dice;
  BodyRecord body = random_body(dice, 0);
  body.velocity = {{}, Velocity::from_integer(-5), {}};
  body.spin = {};
  const InverseInertia inertia = inverse_inertia(body, to_matrix(body.orientation));
  Manifold manifold;
  manifold.normal = {{}, Unit::from_integer(1), {}};
  manifold.count = 1;
  manifold.points[0].anchor_b = metres(0, -0.5, 0);
  (void)answer_impact({wall, {}}, {body, inertia},
                      {manifold, Coefficient{}, Coefficient::from_integer(1), Velocity{}});
  EXPECT_NEAR(value(body.velocity.y), 5, 1e-8);
}

}  // namespace
}  // namespace lockstone
