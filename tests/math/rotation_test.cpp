// Rotations and vectors for the game's own rules, against MPFR.
#include <array>
#include <cstdio>

#include <gtest/gtest.h>

#include <lockstone/game_math.h>
#include <lockstone/hash.h>

#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using namespace literals;
using test::Raws;
using test::Real;
using test::worst_of;

using Reals3 = std::array<Real, 3>;
using Reals4 = std::array<Real, 4>;

template <class T>
Reals3 reals(const Vec3<T>& v) {
  constexpr int bits = T::frac_bits;
  return {Real(v.x.raw, bits), Real(v.y.raw, bits), Real(v.z.raw, bits)};
}

Reals4 reals(const Quat& q) {
  return {Real(q.x.raw, 30), Real(q.y.raw, 30), Real(q.z.raw, 30), Real(q.w.raw, 30)};
}

template <std::size_t N>
Real dot(const std::array<Real, N>& a, const std::array<Real, N>& b) {
  Real sum;
  for (std::size_t i = 0; i < N; ++i)
    sum = sum + a[i] * b[i];
  return sum;
}

template <std::size_t N>
std::array<Real, N> unit(std::array<Real, N> v) {
  const Real length = sqrt(dot(v, v));
  for (Real& part : v)
    part = part / length;
  return v;
}

Reals3 cross(const Reals3& a, const Reals3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// q·v·q* / |q|²
Reals3 rotated(const Quat& q, const Reals3& v) {
  const Reals4 u = unit(reals(q));
  const Reals3 axis{u[0], u[1], u[2]};
  const Reals3 once = cross(axis, v), twice = cross(axis, once);
  Reals3 result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = v[i] + Real(2) * (u[3] * once[i] + twice[i]);
  return result;
}

/// The angle between unit vectors, exact for near ones too.
template <std::size_t N>
Real angle(const std::array<Real, N>& a, const std::array<Real, N>& b) {
  std::array<Real, N> difference, sum;
  for (std::size_t i = 0; i < N; ++i) {
    difference[i] = a[i] - b[i];
    sum[i] = a[i] + b[i];
  }
  return Real(2) * atan2(sqrt(dot(difference, difference)), sqrt(dot(sum, sum)));
}

double worst_component(const Quat& q, const Reals4& expected) {
  double worst = expected[0].error_of(q.x.raw, 30);
  worst = worst_of(worst, expected[1].error_of(q.y.raw, 30));
  worst = worst_of(worst, expected[2].error_of(q.z.raw, 30));
  return worst_of(worst, expected[3].error_of(q.w.raw, 30));
}

/// Directions and orientations of all kinds, and others at every small distance to them.
struct Source {
  Raws raws;

  Vec3<Unit> direction() {
    for (;;) {
      const auto part = [&] { return Position::from_raw(raws.signed_below_bits(40)); };
      const Position x = part(), y = part(), z = part();
      if (x.raw != 0 || y.raw != 0 || z.raw != 0) return normalized(Vec3<Position>{x, y, z});
    }
  }
  Quat orientation() {
    const auto part = [&] { return Unit::from_raw(raws.any32() / 2); };
    const Unit x = part(), y = part(), z = part(), w = part();
    return normalized(Quat{x, y, z, w});
  }
  Quat near(const Quat& q) {
    const int bits = static_cast<int>(raws.bits64() % 30);
    const auto part = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(raws.signed_below_bits(bits)));
    };
    const Unit x = part(), y = part(), z = part(), w = part();
    return normalized(Quat{q.x + x, q.y + y, q.z + z, q.w + w});
  }
  Vec3<Unit> near(const Vec3<Unit>& v) {
    const int bits = static_cast<int>(raws.bits64() % 30);
    const auto part = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(raws.signed_below_bits(bits)));
    };
    const Unit x = part(), y = part(), z = part();
    return normalized(Vec3<Unit>{v.x + x, v.y + y, v.z + z});
  }
};

void report(const char* name, double worst) {
  std::printf("%s: %.3f last places\n", name, worst);
}

/// Shoemake's formula over the unit quaternions of a and ±b.
Reals4 exact_slerp(const Quat& a, const Quat& b, const Real& part_of_arc, bool is_longer) {
  const Reals4 from = unit(reals(a));
  Reals4 to = unit(reals(b));
  if (is_longer) {
    for (Real& part : to)
      part = Real() - part;
  }
  const Real arc = angle(from, to);
  const Real part = part_of_arc * arc, rest = arc - part;
  Reals4 result;
  for (std::size_t i = 0; i < 4; ++i)
    result[i] = (from[i] * sin(rest) + to[i] * sin(part)) / sin(arc);
  return result;
}

/// Calls `check(a, b, whether the way from a to b is the longer one)` for pairs of orientations
/// near and far, but not for two ways of half a turn.
template <class Check>
void for_pairs(Source& source, Check&& check) {
  for (int i = 0; i < test::share_of(40000); ++i) {
    const Quat a = source.orientation();
    const Quat b = i % 2 == 0 ? source.orientation() : source.near(a);
    const Real cosine = dot(reals(a), reals(b));
    if (a == b || cosine.error_of(0, 20) < 1) continue;
    check(a, b, cosine < Real());
  }
}

TEST(Slerp, ErrsLessThanTwoLastPlaces) {
  Source source;
  double worst = 0;
  for_pairs(source, [&](const Quat& a, const Quat& b, bool is_longer) {
    const Unit t = Unit::from_raw(static_cast<std::int32_t>(source.raws.bits64() >> 34));
    const Reals4 expected = exact_slerp(a, b, Real(t.raw, 30), is_longer);
    worst = worst_of(worst, worst_component(slerp(a, b, t), expected));
  });
  report("slerp", worst);
  EXPECT_LT(worst, 1.5);
}

TEST(Slerp, MeetsItsEndsAndGoesTheShorterWay) {
  Source source;
  const Unit one = Unit::from_integer(1);
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Quat a = source.orientation(), b = source.orientation();
    ASSERT_EQ(slerp(a, b, Unit{}), a);
    ASSERT_EQ(slerp(a, b, one), b);
    ASSERT_EQ(slerp(a, b, -0.5_r), a);
    ASSERT_EQ(slerp(a, b, 1.5_r), b);
    const Quat half = slerp(a, b, 0.5_r);
    ASSERT_LE(angle_between(a, half), Angle(90.001_deg));
    ASSERT_EQ(slerp(a, {-b.x, -b.y, -b.z, -b.w}, 0.5_r), half);
  }
  const Vec3<Unit> up{{}, 1_r, {}};
  const Quat turned = slerp({}, from_axis_angle(up, 90_deg), 0.5_r);
  EXPECT_LE(angle_between(turned, from_axis_angle(up, 45_deg)).raw, 8);
}

TEST(RotateToward, TurnsByTheAngleAndArrives) {
  Source source;
  double worst = 0;
  for_pairs(source, [&](const Quat& a, const Quat& b, bool is_longer) {
    const Reals4 from = unit(reals(a)), to = unit(reals(b));
    const Real whole = angle(from, is_longer ? unit(reals({-b.x, -b.y, -b.z, -b.w})) : to);
    const Angle most = Angle::from_raw(static_cast<std::int32_t>(
        source.raws.below_bits(1 + static_cast<int>(source.raws.bits64() % 30))));
    const Real part = Real(most.raw, 28) / whole;  // most is twice an angle of quaternions
    const Quat q = rotate_toward(a, b, most);
    if (q == b || most.raw == 0) return;
    worst = worst_of(worst, worst_component(q, exact_slerp(a, b, part, is_longer)));
  });
  report("rotate_toward", worst);
  EXPECT_LT(worst, 1.5);

  const Quat goal = from_axis_angle({{}, 1_r, {}}, 100_deg);
  Quat q;
  for (int step = 0; step < 10; ++step)
    q = rotate_toward(q, goal, 10.01_deg);
  EXPECT_EQ(q, goal);
  EXPECT_EQ(rotate_toward(goal, {}, 0_deg), goal);
  EXPECT_EQ(rotate_toward(goal, {}, -5_deg), goal);
}

TEST(AngleBetween, ErrsLessThanTwoLastPlaces) {
  Source source;
  double worst = 0, worst_turn = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const Vec3<Unit> a = source.direction();
    const Vec3<Unit> b = i % 3 == 0 ? source.direction() : source.near(i % 3 == 1 ? a : -a);
    worst = worst_of(worst,
                     angle(unit(reals(a)), unit(reals(b))).error_of(angle_between(a, b).raw, 27));
    const Quat p = source.orientation();
    const Quat q = i % 2 == 0 ? source.orientation() : source.near(p);
    Reals4 to = unit(reals(q));
    if (dot(reals(p), reals(q)) < Real()) to = unit(reals({-q.x, -q.y, -q.z, -q.w}));
    const Real turn = Real(2) * angle(unit(reals(p)), to);
    worst_turn = worst_of(worst_turn, turn.error_of(angle_between(p, q).raw, 27));
  }
  report("angle_between vectors", worst);
  report("angle_between orientations", worst_turn);
  EXPECT_LT(worst, 0.7);
  EXPECT_LT(worst_turn, 0.6);
  EXPECT_EQ(angle_between(Vec3<Unit>{}, Vec3<Unit>{1_r, {}, {}}), Angle{});
}

TEST(FromDirections, TakesTheOneOntoTheOther) {
  Source source;
  double worst = 0, worst_turn = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const Vec3<Unit> a = source.direction();
    const Vec3<Unit> b = i % 3 == 0 ? source.direction() : source.near(i % 3 == 1 ? a : -a);
    const Quat q = from_directions(a, b);
    const Reals3 from = unit(reals(a)), to = unit(reals(b));
    worst = worst_of(worst, angle(rotated(q, from), to).error_of(0, 30));
    // It is the shortest: the quaternion's angle is half that between the directions.
    const Real turn = angle(unit(reals(q)), Reals4{Real(), Real(), Real(), Real(1)});
    worst_turn = worst_of(worst_turn, (Real(2) * turn - angle(from, to)).error_of(0, 30));
  }
  report("from_directions", worst);
  report("from_directions, angle", worst_turn);
  EXPECT_LT(worst, 4.0);
  EXPECT_LT(worst_turn, 4.0);
}

TEST(FromDirections, KnowsEqualOppositeAndZeroVectors) {
  const Vec3<Unit> x{1_r, {}, {}}, y{{}, 1_r, {}};
  EXPECT_EQ(from_directions(x, x), Quat{});
  EXPECT_EQ(from_directions(Vec3<Unit>{}, x), Quat{});
  EXPECT_EQ(from_directions(x, Vec3<Unit>{}), Quat{});
  EXPECT_EQ(rotate(from_directions(x, -x), x), -x);
  EXPECT_EQ(rotate(from_directions(-y, y), y), -y);
  const Vec3<Position> far{3000_m, {}, {}};
  EXPECT_EQ(from_directions(far, Vec3<Velocity>{{}, 2_mps, {}}), from_directions(x, y));
}

TEST(LookRotation, PointsForwardAndUp) {
  Source source;
  double worst = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const Vec3<Unit> forward = source.direction();
    const Vec3<Unit> up = i % 3 == 0   ? source.direction()
                          : i % 3 == 1 ? source.near(forward)
                                       : source.near(-forward);
    const Quat q = look_rotation(forward, up);
    const Reals3 z = unit(reals(forward));
    const Reals3 side = cross(unit(reals(up)), z);
    worst = worst_of(worst, angle(rotated(q, {Real(), Real(), Real(1)}), z).error_of(0, 30));
    // Where `up` is near to `forward`, its own rounding turns the side.
    const Real size = sqrt(dot(side, side));
    if (size < Real(1, 20)) continue;
    const Real error = angle(rotated(q, {Real(1), Real(), Real()}), unit(side));
    worst = worst_of(worst, (error * size).error_of(0, 30));
  }
  report("look_rotation", worst);
  EXPECT_LT(worst, 5.0);
}

TEST(LookRotation, AlongUpAndOfZeroIsSomeRotation) {
  const Vec3<Unit> y{{}, 1_r, {}}, z{{}, {}, 1_r};
  EXPECT_EQ(look_rotation(z), Quat{});
  EXPECT_EQ(look_rotation(Vec3<Length>{}), Quat{});
  EXPECT_EQ(rotate(look_rotation(y), z), y);
  EXPECT_EQ(rotate(look_rotation(-y), z), -y);
  EXPECT_EQ(rotate(look_rotation(z, Vec3<Unit>{}), z), z);
}

TEST(Rotate, TurnsVectorsOfEveryFormat) {
  Source source;
  double worst = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const Quat q = source.orientation();
    const auto part = [&] { return Velocity::from_raw(source.raws.signed_below_bits(42)); };
    const Velocity x = part(), y = part(), z = part();
    const Vec3<Velocity> v{x, y, z};
    const Reals3 expected = rotated(q, reals(v));
    const Vec3<Velocity> turned = rotate(q, v);
    const Real size = sqrt(dot(reals(v), reals(v)));
    for (int axis = 0; axis < 3; ++axis) {
      const double error = expected[static_cast<std::size_t>(axis)].error_of(turned[axis].raw, 32);
      worst = worst_of(worst, (error - 0.5) / (size.to_double() * 0x1p32 * 0x1p-30 + 1e-9));
    }
    const Vec3<Velocity> back = rotate_inverse(q, turned) - v;
    ASSERT_LE(length(back).raw, 4 + (length(v).raw >> 27));
  }
  report("rotate, of 2^-30 of the length", worst);
  EXPECT_LT(worst, 4.0);
  const Quat quarter = from_axis_angle({{}, 1_r, {}}, 90_deg);
  EXPECT_EQ(rotate(quarter, Vec3<Length>{1_m, {}, {}}), (Vec3<Length>{{}, {}, -1_m}));
}

TEST(Trigonometry, IsPublic) {
  EXPECT_EQ(sin(90_deg), Unit(1_r));
  EXPECT_EQ(cos(0_deg), Unit(1_r));
  EXPECT_EQ(tan(0_deg), Number{});
  EXPECT_EQ(asin(1_r), Angle(90_deg));
  EXPECT_EQ(acos(1_r), Angle{});
  EXPECT_EQ(atan2(Position(1_m), Position(1_m)), Angle(45_deg));
  EXPECT_EQ(sqrt(Number(2.25_r)), Number(1.5_r));
  const Vec3<Length> v{3_m, 4_m, {}};
  EXPECT_EQ(sqrt<Length>(dot(v, v)), Length(5_m));
}

TEST(Vector, HasTheFunctionsOfScalars) {
  const Vec3<Length> v{-3_m, 4_m, {}}, w{1_m, 5_m, -1_m};
  EXPECT_EQ(abs(v), (Vec3<Length>{3_m, 4_m, {}}));
  EXPECT_EQ(min(v, w), (Vec3<Length>{-3_m, 4_m, -1_m}));
  EXPECT_EQ(max(v, w), (Vec3<Length>{1_m, 5_m, {}}));
  EXPECT_EQ(clamp(w, -abs(v), abs(v)), (Vec3<Length>{1_m, 4_m, {}}));
  EXPECT_EQ(clamp_length(v, 5_m), v);
  EXPECT_EQ(clamp_length(v, 2.5_m), (Vec3<Length>{-1.5_m, 2_m, {}}));
  EXPECT_EQ(clamp_length(Vec3<Velocity>{}, 0_mps), Vec3<Velocity>{});
}

TEST(MoveToward, MovesByTheDistanceAndArrives) {
  EXPECT_EQ(move_toward(Velocity(3_mps), 0_mps, 0.5_mps), Velocity(2.5_mps));
  EXPECT_EQ(move_toward(Velocity(-3_mps), 0_mps, 0.5_mps), Velocity(-2.5_mps));
  EXPECT_EQ(move_toward(Velocity(0.25_mps), 0_mps, 0.5_mps), Velocity{});
  const Vec3<Position> from{1_m, 1_m, {}}, to{4_m, 5_m, {}};
  EXPECT_LE(distance(move_toward(from, to, 2.5_m), {2.5_m, 3_m, {}}).raw, 5);
  EXPECT_EQ(move_toward(from, to, 5_m), to);
  EXPECT_EQ(move_toward(from, from, 0_m), from);

  Source source;
  double worst = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const auto part = [&] { return Length::from_raw(source.raws.any32() / 4); };
    const Length x = part(), y = part(), z = part();
    const Vec3<Length> goal{x, y, z};
    const Length most = abs(part());
    const Vec3<Length> moved = move_toward(Vec3<Length>{}, goal, most);
    if (moved == goal) continue;
    const Reals3 exact = unit(reals(goal));
    for (int axis = 0; axis < 3; ++axis) {
      const Real expected = exact[static_cast<std::size_t>(axis)] * Real(most.raw, 20);
      worst = worst_of(worst, expected.error_of(moved[axis].raw, 20));
    }
  }
  report("move_toward", worst);
  EXPECT_LT(worst, 1.0);
}

// One hash over results of every function: other machines compute the same bits.
TEST(GameMath, ComputesTheSameBitsEverywhere) {
  Random random(1);
  std::uint64_t hash = 0;
  const auto add = [&](const auto& value) {
    hash = hash64(std::as_bytes(std::span(&value, 1)), hash);
  };
  for (int i = 0; i < 2000; ++i) {
    const Vec3<Unit> a = random.direction(), b = random.direction();
    const Unit t = random.fraction();
    const Angle angle = random.between<Angle>(-4_rad, 4_rad);
    const Quat p = from_directions(a, b), q = look_rotation(b, a);
    add(p);
    add(q);
    add(slerp(p, q, t));
    add(rotate_toward(p, q, angle));
    add(angle_between(p, q));
    add(angle_between(a, b));
    add(rotate(p, Vec3<Position>{{}, 1000_m, 1_m}));
    add(move_toward(Vec3<Velocity>{}, a * Velocity(10_mps), 3_mps));
    add(sin(angle));
    add(sqrt(t));
  }
  EXPECT_EQ(hash, 0x4119718e7179edc4U) << std::hex << hash;
}

}  // namespace
}  // namespace lockstone
