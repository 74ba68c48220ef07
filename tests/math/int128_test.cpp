#include "core/math/int128.h"

#include <gtest/gtest.h>

#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::k_max;
using test::k_min;

#if defined(__SIZEOF_INT128__)
__extension__ typedef unsigned __int128 Word;
__extension__ typedef __int128 SignedWord;

Word word(UInt128 x) {
  return (Word{x.high} << 64) | x.low;
}
SignedWord word(Int128 x) {
  return static_cast<SignedWord>(word(x.bits()));
}

TEST(Int128, PortableProductAndQuotientEqualTheCompilers) {
  test::Raws raws;
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const std::uint64_t a = raws.below_bits(64);
    const std::uint64_t b = raws.below_bits(64);
    ASSERT_EQ(portable::multiply_wide(a, b), native::multiply_wide(a, b)) << a << ' ' << b;
    const std::uint64_t d = raws.below_bits(64) | 1;
    const UInt128 n{a % d, b};
    const Quotient64 ours = portable::divide(n, d);
    ASSERT_EQ(ours.quotient, native::divide(n, d).quotient) << n.high << ' ' << n.low << ' ' << d;
    ASSERT_EQ(ours.remainder, native::divide(n, d).remainder);
  }
}

TEST(Int128, SumsShiftsAndOrderEqualTheCompilers) {
  test::Raws raws;
  for (int i = 0; i < test::share_of(500000); ++i) {
    const Int128 a = Int128::from_bits({raws.below_bits(64), raws.bits64()});
    const Int128 b = Int128::from_bits({raws.below_bits(64), raws.bits64()});
    const int shift = static_cast<int>(raws.bits64() % 128);
    ASSERT_EQ(word((a + b).bits()), word(a.bits()) + word(b.bits()));
    ASSERT_EQ(word((a - b).bits()), word(a.bits()) - word(b.bits()));
    ASSERT_EQ(word(a >> shift), word(a) >> shift);
    ASSERT_EQ(word(a.bits() >> shift), word(a.bits()) >> shift);
    ASSERT_EQ(word(a.bits() << shift), word(a.bits()) << shift);
    ASSERT_EQ(a < b, word(a) < word(b));
    ASSERT_EQ(a.bits() < b.bits(), word(a.bits()) < word(b.bits()));
  }
}

TEST(Int128, SignedProductIsExact) {
  test::Raws raws;
  for (int i = 0; i < test::share_of(500000); ++i) {
    const std::int64_t a = i % 97 == 0 ? k_min : raws.signed_below_bits(63);
    const std::int64_t b = i % 89 == 0 ? k_min : raws.signed_below_bits(63);
    ASSERT_EQ(word(multiply_wide(a, b)), SignedWord{a} * b) << a << ' ' << b;
  }
}
#endif

TEST(Int128, RoundsTiesAwayFromZero) {
  EXPECT_EQ(round_divide(Int128::from(5), 2), 3);
  EXPECT_EQ(round_divide(Int128::from(-5), 2), -3);
  EXPECT_EQ(round_divide(Int128::from(k_min + 1), k_max), -1);
  EXPECT_EQ(round_shift(Int128::from(3), 1), Int128::from(2));
  EXPECT_EQ(round_shift(Int128::from(-3), 1), Int128::from(-2));
  EXPECT_EQ(round_shift(Int128::from(-1), 2), Int128::from(0));
  EXPECT_EQ(round_shift(Int128::from(k_min), 64), Int128::from(-1));
  EXPECT_EQ(round_shift(Int128::from(k_min), 65), Int128::from(0));
}

TEST(Int128, SaturatesAtTheBoundsOfInt64) {
  EXPECT_EQ(saturate_to_int64(Int128::from(k_max)), k_max);
  EXPECT_EQ(saturate_to_int64(Int128::from(k_max) + Int128::from(1)), k_max);
  EXPECT_EQ(saturate_to_int64(Int128::from(k_min)), k_min);
  EXPECT_EQ(saturate_to_int64(Int128::from(k_min) - Int128::from(1)), k_min);
}

static_assert(multiply_wide(std::uint64_t{1} << 63, 6).high == 3);
static_assert(magnitude(k_min) == std::uint64_t{1} << 63);

}  // namespace
}  // namespace lockstone
