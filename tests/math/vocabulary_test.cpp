// Quantities and vectors as a game programmer writes them.
#include <sstream>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/vector_math.h>

#include "core/math/int128.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using namespace literals;
using test::Raws;

// A quantity is passed and stored as its integer is.
static_assert(std::is_trivially_copyable_v<Length> && std::is_standard_layout_v<Length>);
static_assert(sizeof(Length) == 4 && sizeof(Position) == 8 && sizeof(Vec3<Position>) == 24);

// Formats convert by themselves exactly where no value can be lost.
static_assert(std::is_convertible_v<Length, Position>);
static_assert(std::is_convertible_v<Displacement, Position>);
static_assert(std::is_convertible_v<SolverVelocity, Velocity>);
static_assert(std::is_convertible_v<Vec3<Length>, Vec3<Position>>);
static_assert(!std::is_convertible_v<Position, Length>);
static_assert(!std::is_convertible_v<Displacement, Length>);
static_assert(!std::is_convertible_v<Length, Displacement>);
static_assert(!std::is_convertible_v<Length, Velocity>);
static_assert(!std::is_convertible_v<int, Length> && !std::is_constructible_v<Length, int>);

TEST(Quantity, ScalesByWholeNumbersAndPlainNumbers) {
  const Velocity v = 1.5_mps;
  EXPECT_EQ(v * 2, Velocity(3_mps));
  EXPECT_EQ(2 * v, Velocity(3_mps));
  EXPECT_EQ(v / -3, Velocity(-0.5_mps));
  EXPECT_EQ(v * 0.5_r, Velocity(0.75_mps));
  EXPECT_EQ(v * Number(-2_r), Velocity(-3_mps));
  EXPECT_EQ(scaled(Length(3_m), Number(0.5_r)), Length(1.5_m));
  Length l = 1_m;
  l *= 3;
  l /= 2;
  EXPECT_EQ(l, Length(1.5_m));
  EXPECT_EQ(clamp(l, -1_m, 1_m), Length(1_m));
  EXPECT_EQ(max(l, 2_m), Length(2_m));
}

TEST(Quantity, MixesFormatsOfOneUnit) {
  const Position p = 5_m;
  const Length l = 0.25_m;
  EXPECT_EQ(p + l, Position(5.25_m));
  EXPECT_EQ(l - p, Position(-4.75_m));
  EXPECT_TRUE(l < p);
}

TEST(Quantity, DividesByNegativeNumbersAsByPositive) {
  for (const int raw : {1, -1, 5, -5, 7, 2147483647}) {
    for (const int divisor : {1, 2, 3, 10, 2147483647}) {
      const Length x = Length::from_raw(raw);
      EXPECT_EQ((x / -divisor).raw, -(x / divisor).raw) << raw << ' ' << divisor;
    }
  }
}

TEST(Quantity, ChoosesBetweenLiterals) {
  for (const bool b : {true, false}) {
    const Length l = b ? 0.5_m : 700.25_m;
    EXPECT_EQ(l, b ? Length(0.5_m) : Length(700.25_m));
    const Velocity v = b ? 1_mps : -1_mps;
    EXPECT_EQ(v.raw, b ? std::int64_t{1} << 32 : -(std::int64_t{1} << 32));
  }
}

TEST(Quantity, ReadsDegrees) {
  EXPECT_EQ(Angle(180_deg).raw, 421657428);   // π in Q27
  EXPECT_EQ(Angle(-90_deg).raw, -210828714);  // −π/2
  EXPECT_EQ(Angle(0.5_deg).raw, 1171271);
}

TEST(Quantity, PrintsAsADecimal) {
  std::ostringstream out;
  out << Length(-0.25_m) << ' ' << Vec3<Position>{1_m, {}, -2.5_m};
  EXPECT_EQ(out.str(), "-0.25 (1, 0, -2.5)");
}

TEST(Quantity, TriesWhereDataMayNotFit) {
  EXPECT_EQ(Length::try_from_integer(2047), Length::from_integer(2047));
  EXPECT_EQ(Length::try_from_integer(-2048), Length::min());
  EXPECT_EQ(Length::try_from_integer(2048), std::nullopt);
  EXPECT_EQ(Length::try_from_integer(~std::uint64_t{0}), std::nullopt);
  EXPECT_EQ(Length::try_from_ratio(1, 0), std::nullopt);
  EXPECT_EQ(Length::try_from_ratio(5000, 1), std::nullopt);
  EXPECT_EQ(Length::try_from_ratio(1, -3), Length::from_raw(-349525));
  EXPECT_EQ(try_rounded<Length>(Position(3000_m)), std::nullopt);
  EXPECT_EQ(try_rounded<Length>(Position(-3_m)), Length(-3_m));
  EXPECT_EQ(try_rounded<Unit>(Number(2_r)), std::nullopt);
  EXPECT_EQ(saturated<Unit>(Number(-5_r)), Unit::min());
  EXPECT_EQ(saturated<Displacement>(Length(200_m)), Displacement::max());
}

// The definition in 128 bits, with numerators and denominators of any size.
TEST(FromRatio, RoundsOnceForAllNumeratorsAndDenominators) {
  Raws raws;
  for (int i = 0; i < test::share_of(200000); ++i) {
    const std::int64_t n = raws.signed_below_bits(1 + static_cast<int>(raws.bits64() % 63));
    std::int64_t d = raws.signed_below_bits(1 + static_cast<int>(raws.bits64() % 63));
    if (d == 0) d = 1;
    const std::int64_t size = d < 0 ? -d : d;
    const Int128 shifted = multiply_wide(d < 0 ? -n : n, std::int64_t{1} << 32);
    const std::optional<Position> found = Position::try_from_ratio(n, d);
    const bool fits = (n < 0 ? -(n / size) : n / size) < std::int64_t{1} << 30;
    if (!fits) continue;
    ASSERT_EQ(found.value().raw, round_divide(shifted, size)) << n << ' ' << d;
  }
  EXPECT_EQ(Position::from_ratio(3'000'000'000, 1000), Position(3'000'000_m));
  EXPECT_EQ(Position::try_from_ratio(std::numeric_limits<std::int64_t>::min(), -1), std::nullopt);
}

TEST(QuantityDeathTest, StopsWhereAConstantWouldNotCompile) {
  volatile int far = 5000, zero = 0;
  EXPECT_DEATH((void)Length::from_integer(far), "from_integer: out of range");
  EXPECT_DEATH((void)Length::from_ratio(far, 1), "from_ratio: out of range");
  EXPECT_DEATH((void)Length::from_ratio(1, zero), "from_ratio: the denominator is 0");
  EXPECT_DEATH((void)(Length::from_integer(1) / zero), "divided by 0");
}

TEST(Vector, ScalesAndMixes) {
  const Vec3<Velocity> v{1_mps, -2_mps, 0.5_mps};
  EXPECT_EQ(v * 2, (Vec3<Velocity>{2_mps, -4_mps, 1_mps}));
  EXPECT_EQ(2 * v / 2, v);
  EXPECT_EQ(v * 0.5_r, (Vec3<Velocity>{0.5_mps, -1_mps, 0.25_mps}));
  EXPECT_EQ(v * Number(2_r), v * 2);
  const Vec3<Unit> up{{}, 1_r, {}};
  EXPECT_EQ(up * Force(400_N), (Vec3<Force>{{}, 400_N, {}}));
  Vec3<Position> p{1_m, 2_m, 3_m};
  p += Vec3<Length>{0.5_m, {}, -1_m};
  EXPECT_EQ(p, (Vec3<Position>{1.5_m, 2_m, 2_m}));
}

TEST(Vector, HasLengthDistanceAndDirection) {
  const Vec3<Position> a{3_m, 4_m, 12_m}, b{{}, {}, {}};
  EXPECT_EQ(length(a), Position(13_m));
  EXPECT_EQ(distance(a, b), Position(13_m));
  EXPECT_EQ(length(Vec3<Length>{2000_m, 2000_m, {}}), Length::max());
  EXPECT_EQ(normalized(Vec3<Position>{{}, -7_m, {}}), (Vec3<Unit>{{}, -1_r, {}}));
  EXPECT_EQ(normalized(b), Vec3<Unit>{});
}

TEST(Vector, MultipliesPlacesBothWays) {
  const Vec3<Position> far{1000000_m, {}, -1000000_m}, near{999999_m, 2_m, -1000000_m};
  EXPECT_EQ(to_decimal(dot(far - near, far - near)), "5");
  EXPECT_EQ(to_decimal(dot(far, far)), "2000000000000");
  EXPECT_EQ(dot(far, Vec3<Unit>{0.5_r, {}, {}}), Position(500000_m));
  const Vec3<Unit> x{1_r, {}, {}}, y{{}, 1_r, {}};
  EXPECT_EQ(cross(Vec3<Position>{5_m, {}, {}}, y), (Vec3<Position>{{}, {}, 5_m}));
  EXPECT_EQ(cross(y, Vec3<Position>{5_m, {}, {}}), (Vec3<Position>{{}, {}, -5_m}));
  EXPECT_EQ(to_decimal(cross(far, near).y), "1000000");
  EXPECT_EQ(dot(x, y).raw, 0);
}

TEST(Vector, InterpolatesAndMeetsItsEnds) {
  Raws raws;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const auto place = [&] { return Position::from_raw(raws.signed_below_bits(50)); };
    const Position ax = place(), bx = place();
    const Vec3<Position> a{ax, {}, bx}, b{bx, ax, {}};
    ASSERT_EQ(lerp(a, b, Unit{}), a);
    ASSERT_EQ(lerp(a, b, Unit::from_integer(1)), b);
  }
  EXPECT_EQ(lerp(Length(1_m), Length(2_m), 0.25_r), Length(1.25_m));
}

}  // namespace
}  // namespace lockstone
