// When shapes in motion come near.
#include "core/geometry/distance/motion/time_of_impact.h"

#include "core/geometry/distance/epa/epa.h"
#include "tests/geometry/pairs/convex_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

Position position(Real x) {
  return Position::from_raw(
      static_cast<std::int64_t>(std::llround(std::ldexp(x, Position::frac_bits))));
}
Vec3<Position> positions(const RealVec& v) {
  return {position(v.x), position(v.y), position(v.z)};
}
RotationVector rotation_by(const RealVec& v) {
  const auto lane = [](Real x) {
    return RotationComponent::from_raw(static_cast<std::int64_t>(std::llround(std::ldexp(x, 32))));
  };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

/// A body on its way.
struct Mover {
  Convex shape;
  Sweep sweep{};
  Vec3<Length> origin{};

  [[nodiscard]] SweptShape swept() {
    if (!shape.vertices.empty()) shape.polytope.vertices = shape.vertices;
    return {shape.shape, sweep, shape.vertices.empty() ? nullptr : &shape.polytope, origin};
  }
  [[nodiscard]] Real radius() const {
    Real most = 0;
    for (const RealVec& p : shape.points())
      most = std::max(most, norm(p));
    return most + norm(real(origin)) + shape.radius();
  }
};

/// Distance at a fraction, minus the depth where they overlap.
Real distance_at(Mover& a, Mover& b, Unit fraction) {
  const Transform at_a = pose_at(a.sweep, fraction);
  const Transform at_b = pose_at(b.sweep, fraction);
  a.shape.rotation = to_matrix(at_a.orientation);
  b.shape.rotation = to_matrix(at_b.orientation);
  const Vec3<Position> between = apply(at_b, b.origin) - apply(at_a, a.origin);
  const Vec3<Length> offset = rounded<Length>(between);
  const ClosestPoints points = distance(a.shape.posed(), b.shape.posed(), offset);
  if (!points.overlapping) return real(points.distance);
  return -real(penetration(a.shape.posed(), b.shape.posed(), offset).depth);
}

Real slack_of(const Mover& a, const Mover& b) {
  return 3e-6L + 1e-8L * (a.radius() + b.radius() + norm(real(b.sweep.start.position)) +
                          norm(real(a.sweep.translation)) + norm(real(b.sweep.translation)));
}

const Real k_target = real(TimeOfImpactLimits{}.target);
const Real k_tolerance = real(TimeOfImpactLimits{}.tolerance);

/// The laws that every answer obeys: nothing below the target before the fraction, and at a hit
/// the distance that was asked for.
void expect_lawful(Mover& a, Mover& b, const TimeOfImpact& found, int samples) {
  const Real slack = slack_of(a, b);
  const Real at_start = distance_at(a, b, {});
  if (at_start <= k_target + k_tolerance - slack) {
    EXPECT_EQ(found.fraction, Unit{});
    return;
  }
  for (int i = 0; i < samples; ++i) {
    const Unit before =
        Unit::from_raw(static_cast<std::int32_t>(std::int64_t{found.fraction.raw} * i / samples));
    EXPECT_GT(static_cast<double>(distance_at(a, b, before)),
              static_cast<double>(k_target - slack));
  }
  const Real at_end = distance_at(a, b, found.fraction);
  EXPECT_GT(static_cast<double>(at_end), static_cast<double>(k_target - slack));
  EXPECT_EQ(found.fraction == unit(1), found.state == TimeOfImpactState::separated);
  if (found.state != TimeOfImpactState::hit) return;
  EXPECT_LE(static_cast<double>(at_end), static_cast<double>(k_target + k_tolerance + slack));
  EXPECT_NEAR(static_cast<double>(at_end), static_cast<double>(real(found.distance)),
              static_cast<double>(slack));
}

Mover random_mover(Dice& dice, int kind, double low, double high, double turn) {
  Mover mover;
  mover.shape = random_convex(dice, kind, low, high);
  mover.sweep.start.orientation = dice.orientation();
  mover.shape.rotation = to_matrix(mover.sweep.start.orientation);
  mover.sweep.rotation = rotation_by(dice.direction() * static_cast<Real>(dice.uniform(0, turn)));
  const RealVec d = dice.direction() * static_cast<Real>(low);
  if (dice.chance(3)) mover.origin = metres(static_cast<double>(d.x), static_cast<double>(d.y), 0);
  return mover;
}

TEST(TimeOfImpact, KeepsTheTargetOnRandomSweeps) {
  Dice dice;
  std::array<int, 4> states{};
  for (int i = 0; i < test::share_of(1500); ++i) {
    const bool small = dice.chance(3);
    const double low = small ? 0.01 : 0.1;
    const double high = small ? 0.1 : 3.0;
    const auto kind = [&dice] { return static_cast<int>(dice.between(0, k_convex_kinds - 1)); };
    Mover a = random_mover(dice, kind(), low, high, dice.chance(2) ? 0.3 : 6);
    Mover b = random_mover(dice, kind(), low, high, dice.chance(2) ? 0.3 : 6);
    const Real reach = a.radius() + b.radius();
    const RealVec from = dice.direction() * (reach * static_cast<Real>(dice.uniform(0.5, 3)));
    const RealVec to = dice.direction() * (reach * static_cast<Real>(dice.uniform(0, 1)));
    a.sweep.start.position = positions({1000, -500, 20});
    b.sweep.start.position = a.sweep.start.position + positions(from);
    b.sweep.translation = positions((to - from) * static_cast<Real>(dice.uniform(0, 2)));
    if (dice.chance(2)) a.sweep.translation = positions(dice.direction() * reach);
    const TimeOfImpact found = time_of_impact(a.swept(), b.swept());
    ++states[static_cast<std::size_t>(found.state)];
    expect_lawful(a, b, found, 24);
    if (HasFailure()) {
      ADD_FAILURE() << i << "\n" << describe(a.shape) << "\n" << describe(b.shape);
      return;
    }
  }
  EXPECT_GT(states[static_cast<std::size_t>(TimeOfImpactState::hit)], test::share_of(300));
  EXPECT_GT(states[static_cast<std::size_t>(TimeOfImpactState::separated)], test::share_of(100));
  EXPECT_LT(states[static_cast<std::size_t>(TimeOfImpactState::unfinished)], 3);
}

// A small body close above a face of a wall that moves and turns, carried along but for a little.
TEST(TimeOfImpact, FollowsBodiesThatAFaceCarriesAlong) {
  Dice dice;
  int separated = 0, hits = 0, at_once = 0;
  for (int i = 0; i < test::share_of(1000); ++i) {
    Mover wall = random_mover(dice, 2, 1, 3, 0.2);
    wall.shape = convex(Shape::box(metres(dice.uniform(1, 3)), metres(0.5), metres(2)));
    wall.shape.rotation = to_matrix(wall.sweep.start.orientation);
    wall.origin = {};
    wall.sweep.translation = positions(dice.direction() * 0.1L);
    Mover body = random_mover(dice, static_cast<int>(dice.between(0, 2)), 0.05, 0.2, 0);
    const Real above = 0.5L + body.radius() + static_cast<Real>(dice.uniform(0, 0.05));
    const RealVec at{static_cast<Real>(dice.uniform(-0.9, 0.9)), above, 0};
    body.sweep.start.position =
        wall.sweep.start.position + rotate(wall.shape.rotation, positions(at));
    const Transform end = carried(body.sweep.start, wall.sweep);
    const RealVec aside = dice.direction() * static_cast<Real>(dice.uniform(0, 0.05));
    body.sweep.translation = end.position - body.sweep.start.position + positions(aside);
    body.sweep.rotation = wall.sweep.rotation;
    const bool first = dice.chance(2);
    const TimeOfImpact found = first ? time_of_impact(wall.swept(), body.swept())
                                     : time_of_impact(body.swept(), wall.swept());
    expect_lawful(wall, body, found, 24);
    ASSERT_FALSE(HasFailure()) << i;
    const bool is_separated = found.state == TimeOfImpactState::separated;
    separated += is_separated ? 1 : 0;
    hits += found.state == TimeOfImpactState::hit ? 1 : 0;
    at_once += is_separated && found.iterations == 1 ? 1 : 0;
  }
  EXPECT_GT(separated, test::share_of(400));
  EXPECT_GT(at_once, separated / 2);
  EXPECT_GT(hits, test::share_of(20));
}

TEST(TimeOfImpact, StopsBulletsBeforeThinWalls) {
  Dice dice;
  for (int i = 0; i < test::share_of(500); ++i) {
    Mover wall;
    wall.shape = convex(Shape::box(metres(0.005), metres(5), metres(5)));
    Mover bullet;
    bullet.shape = dice.chance(2) ? convex(Shape::sphere(metres(0.004)))
                                  : convex(Shape::capsule(metres(0.01), metres(0.003)));
    const Real start = static_cast<Real>(dice.uniform(0.1, 4));
    bullet.sweep.start.position = positions({-start, static_cast<Real>(dice.uniform(-1, 1)), 0});
    bullet.sweep.translation = positions({500.0L / 60, 0, 0});
    bullet.sweep.rotation = rotation_by(dice.direction() * static_cast<Real>(dice.uniform(0, 50)));
    const TimeOfImpact found = time_of_impact(wall.swept(), bullet.swept());
    ASSERT_EQ(found.state, TimeOfImpactState::hit);
    expect_lawful(wall, bullet, found, 50);
    EXPECT_LT(real(bullet.sweep.start.position.x) + real(found.fraction) * 500 / 60, -0.005L);
  }
}

TEST(TimeOfImpact, StopsSpinningRodsBeforeBodiesInTheirPath) {
  Dice dice;
  for (int i = 0; i < 300; ++i) {
    Mover rod;
    rod.shape = dice.chance(2) ? convex(Shape::capsule(metres(5), metres(0.01)))
                               : convex(Shape::box(metres(0.01), metres(5), metres(0.01)));
    // About z, several turns; the post stands somewhere in the disc.
    rod.sweep.rotation = rotation_by({0, 0, static_cast<Real>(dice.uniform(3.3, 40))});
    Mover post;
    post.shape = convex(Shape::capsule(metres(1), metres(0.005)));
    const Real angle = static_cast<Real>(dice.uniform(0.1, 3.0));
    const Real radius = static_cast<Real>(dice.uniform(0.2, 4.9));
    post.sweep.start.position = positions({-radius * std::sin(angle), radius * std::cos(angle), 0});
    post.sweep.start.orientation = quat(1, 0, 0, 1);
    const TimeOfImpact found = time_of_impact(rod.swept(), post.swept());
    ASSERT_EQ(found.state, TimeOfImpactState::hit) << radius << " " << angle;
    expect_lawful(rod, post, found, 100);
    // The first pass, not a later turn.
    EXPECT_LT(real(found.fraction) * real(rod.sweep.rotation.z), angle);
    EXPECT_GT(real(found.fraction) * real(rod.sweep.rotation.z), angle - 0.2L);
  }
}

TEST(TimeOfImpact, SpinningSpheresAreSpheresAtRest) {
  Mover a;
  a.shape = convex(Shape::sphere(metres(1)));
  Mover b = a;
  b.sweep.start.position = positions({5, 0, 0});
  b.sweep.translation = positions({-4, 0, 0});
  const TimeOfImpact still = time_of_impact(a.swept(), b.swept());
  b.sweep.rotation = rotation_by({0, 0, 3000});
  const TimeOfImpact spinning = time_of_impact(a.swept(), b.swept());
  EXPECT_EQ(still.state, TimeOfImpactState::hit);
  EXPECT_EQ(still.fraction, spinning.fraction);
  EXPECT_EQ(still.iterations, spinning.iterations);
}

TEST(TimeOfImpact, SwappingTheBodiesMirrorsTheResultBitForBit) {
  Dice dice;
  for (int i = 0; i < 400; ++i) {
    Mover a = random_mover(dice, i % k_convex_kinds, 0.1, 1, 3);
    Mover b = random_mover(dice, i / k_convex_kinds % k_convex_kinds, 0.1, 1, 3);
    b.sweep.start.position = positions(dice.direction() * 3);
    b.sweep.translation = positions(real(b.sweep.start.position) * -1);
    const TimeOfImpact one = time_of_impact(a.swept(), b.swept());
    const TimeOfImpact two = time_of_impact(b.swept(), a.swept());
    EXPECT_EQ(one.state, two.state);
    EXPECT_EQ(one.fraction, two.fraction);
    EXPECT_EQ(one.normal, -two.normal);
  }
}

TEST(TimeOfImpact, AnswersTheLastSafeTimeWhenIterationsRunOut) {
  Mover rod;
  rod.shape = convex(Shape::box(metres(0.01), metres(5), metres(0.01)));
  rod.sweep.rotation = rotation_by({0, 0, 1.5L});
  Mover post;
  post.shape = convex(Shape::sphere(metres(0.005)));
  post.sweep.start.position = positions({-4, 0.5L, 0});
  TimeOfImpactLimits limits;
  limits.max_iterations = 2;
  const TimeOfImpact found = time_of_impact(rod.swept(), post.swept(), limits);
  EXPECT_EQ(found.state, TimeOfImpactState::unfinished);
  EXPECT_GT(found.fraction, Unit{});
  expect_lawful(rod, post, found, 100);
}

TEST(TimeOfImpact, ReturnsZeroForOverlapsAtTheStart) {
  Mover a;
  a.shape = convex(Shape::box(metres(1), metres(1), metres(1)));
  Mover b = a;
  b.sweep.start.position = positions({1, 0, 0});
  const TimeOfImpact found = time_of_impact(a.swept(), b.swept());
  EXPECT_EQ(found.state, TimeOfImpactState::overlapping);
  EXPECT_EQ(found.fraction, Unit{});
}

}  // namespace
}  // namespace lockstone::test
