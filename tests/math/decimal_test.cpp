#include <gtest/gtest.h>

#include <lockstone/decimal.h>
#include <lockstone/literals.h>
#include <lockstone/units.h>

#include "tests/math/reference.h"

namespace lockstone {
namespace {

using namespace literals;
using test::Raws;

// Does `Target value = Literal{};` compile? A lambda carries the literal into a template argument.
template <class Target, auto Literal>
concept FitsInto = requires {
  typename std::bool_constant<(Target(Literal()), true)>;
};

static_assert(FitsInto<Length, [] { return 2047.9_m; }>);
static_assert(FitsInto<Length, [] { return -2048_m; }>);
static_assert(!FitsInto<Length, [] { return 2048_m; }>);
static_assert(!FitsInto<Length, [] { return -2048.01_m; }>);
static_assert(FitsInto<Position, [] { return 2048_m; }>);
static_assert(!FitsInto<Unit, [] { return 2_r; }>);
static_assert(!FitsInto<Length, [] { return 1_kg; }>);
static_assert(!FitsInto<Velocity, [] { return 1_mps2; }>);

static_assert(Length(1.5_m).raw == 3 << 19);
static_assert(Acceleration(-9.81_mps2).raw == -42133629174);  // 9.81 · 2^32 = 42133629173.76
static_assert(Torque(5_Nm).raw == 5 << 20 && AngularImpulse(-0.5_Nms).raw == -(1 << 23));
static_assert(Position(1'000'000.5_m).raw == 4294969443483648);  // 1000000.5 · 2^32

template <class T>
void expect_round_trip(T value) {
  const auto back = parse_decimal<T>(to_decimal(value));
  ASSERT_TRUE(back.ok()) << to_decimal(value);
  ASSERT_EQ(back.value(), value) << to_decimal(value);
}

template <class T>
void expect_round_trips() {
  Raws raws;
  expect_round_trip(T::min());
  expect_round_trip(T::max());
  constexpr int bits = static_cast<int>(sizeof(typename T::Representation)) * 8 - 1;
  for (int i = 0; i < 4000; ++i) {
    expect_round_trip(
        T::from_raw(static_cast<typename T::Representation>(raws.signed_below_bits(bits))));
  }
}

TEST(Decimal, FormatsRoundTripInEveryFormat) {
  expect_round_trips<Position>();
  expect_round_trips<Length>();
  expect_round_trips<Displacement>();
  expect_round_trips<Unit>();
  expect_round_trips<Angle>();
  expect_round_trips<Density>();
  expect_round_trips<Impulse>();
  expect_round_trips<Force>();
}

TEST(Decimal, FormatsTheShortestText) {
  EXPECT_EQ(to_decimal(Length::from_ratio(3, 2)), "1.5");
  EXPECT_EQ(to_decimal(Length::from_integer(-7)), "-7");
  EXPECT_EQ(to_decimal(Length::from_raw(-1)), "-0.000001");
  EXPECT_EQ(to_decimal(Acceleration(-9.81_mps2)), "-9.81");
  EXPECT_EQ(to_decimal(Position::min()), "-2147483648");
}

TEST(Decimal, ParsingRoundsTiesAwayFromZero) {
  EXPECT_EQ(parse_decimal<Density>("0.001953125").value().raw, 1);  // half a last place
  EXPECT_EQ(parse_decimal<Density>("-0.001953125").value().raw, -1);
  EXPECT_EQ(parse_decimal<Density>("0.001953124999").value().raw, 0);
  EXPECT_EQ(parse_decimal<Density>("0.005859375").value().raw, 2);  // 1½
  EXPECT_EQ(parse_decimal<Density>("-0.005859374").value().raw, -1);
}

TEST(Decimal, TellsMalformedTextFromValuesOutOfRange) {
  for (const char* text : {"",
                           "-",
                           ".",
                           "1.",
                           ".5",
                           "1e3",
                           "0x10",
                           "1''0",
                           "1'",
                           "'1",
                           "1'.5",
                           "1.'5",
                           "1.5'",
                           "--1",
                           "1 ",
                           " 1",
                           "1.2.3",
                           "1234567890123456789",
                           "0.1234567890123456789",
                           "+-1",
                           "nan"}) {
    EXPECT_EQ(parse_decimal<Length>(text).status(), Status::malformed) << text;
  }
  for (const char* text : {"2048", "-2048.000001", "999999999999999999", "2047.9999997"}) {
    EXPECT_EQ(parse_decimal<Length>(text).status(), Status::invalid_argument) << text;
  }
  EXPECT_EQ(parse_decimal<Length>("-2048").value(), Length::min());
  EXPECT_EQ(parse_decimal<Length>("+1'0.0'0").value(), Length::from_integer(10));
  EXPECT_EQ(parse_decimal<Position>("-2147483648").value(), Position::min());
  EXPECT_EQ(parse_decimal<Position>("2147483648").status(), Status::invalid_argument);
}

}  // namespace
}  // namespace lockstone
