// The random generator: published vectors, golden draws, and statistics of fixed seeds.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/hash.h>
#include <lockstone/literals.h>
#include <lockstone/random.h>
#include <lockstone/vector_math.h>

namespace lockstone {
namespace {

using namespace literals;
using random_detail::Block;
using random_detail::philox;

// The authors' vectors: Random123 1.14, kat_vectors, "philox4x32 10".
static_assert(philox({}, 0) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
static_assert(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, ~std::uint64_t{0}) ==
              Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
static_assert(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822) ==
              Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});

// A draw is the first words of a block whose counter is the number of the draw.
static_assert(Random(0).bits64() == 0xe169c58d6627e8d5);
static_assert(Random(0).bits32() == 0x6627e8d5);
static_assert(sizeof(Random) == 16 && std::is_trivially_copyable_v<Random>);

TEST(Random, DrawsTheSameEverywhere) {
  Random random = Random(2026).stream(3).stream(7);
  std::uint64_t hash = 0;
  const auto add = [&](const auto& value) {
    hash = hash64(std::as_bytes(std::span(&value, 1)), hash);
  };
  std::array<std::uint8_t, 52> cards{};
  std::iota(cards.begin(), cards.end(), std::uint8_t{0});
  for (int i = 0; i < 1000; ++i) {
    add(random.bits64());
    add(random.bits32());
    add(random.below(1 + i));
    add(random.below(~std::uint64_t{0} / 3 * 2));
    add(random.between(-i, i));
    add(random.between<Position>(-1000_m, 1000_m));
    add(random.fraction());
    add(random.direction());
    random.shuffle(cards);
    add(cards);
  }
  add(random.key);
  add(random.drawn);
  EXPECT_EQ(hash, 0xde2869b62daedc44U) << std::hex << hash;
}

TEST(Random, GoesOnFromItsSavedFields) {
  Random random(5);
  for (int i = 0; i < 10; ++i)
    (void)random.direction();
  std::vector<std::uint64_t> saved;
  std::vector<std::string_view> names;
  const Random& state = random;
  visit_fields(state, [&](std::string_view name, const std::uint64_t& field) {
    names.push_back(name);
    saved.push_back(field);
  });
  EXPECT_EQ(names, (std::vector<std::string_view>{"key", "drawn"}));
  Random loaded;
  std::size_t next = 0;
  visit_fields(loaded, [&](std::string_view, std::uint64_t& field) { field = saved[next++]; });
  EXPECT_EQ(loaded, random);
  EXPECT_EQ(loaded.bits64(), random.bits64());
}

TEST(Random, StreamsDependOnTheirNumbersAlone) {
  Random match(9);
  const Random before = match.stream(1);
  (void)match.bits64();
  EXPECT_EQ(match.stream(1), before);
  EXPECT_NE(match.stream(2), before);
  EXPECT_NE(match.stream(1).stream(2), match.stream(2).stream(1));
  EXPECT_NE(Random(10).stream(1), before);
}

TEST(Random, StaysWithinItsBounds) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    ASSERT_EQ(random.below(1), 0);
    ASSERT_LT(random.below(std::uint8_t{200}), 200);
    const int die = random.between(1, 6);
    ASSERT_TRUE(die >= 1 && die <= 6);
    ASSERT_EQ(random.between(7, 7), 7);
    const Length width = random.between<Length>(-0.5_m, 2_m);
    ASSERT_TRUE(width >= -0.5_m && width <= 2_m);
    const Unit fraction = random.fraction();
    ASSERT_TRUE(fraction >= Unit{} && fraction < Unit(1_r));
    const Number number = random.fraction<Number>();
    ASSERT_TRUE(number >= Number{} && number < Number(1_r));
    const auto any = random.between<std::int64_t>(std::numeric_limits<std::int64_t>::min(),
                                                  std::numeric_limits<std::int64_t>::max());
    ASSERT_NE(any, 0);
    ASSERT_NEAR(length(random.direction()).raw, 1 << 30, 2);
  }
}

// --- statistics: each figure is χ² of a fixed seed, below a bound that one run in 10^5 exceeds

/// The bound: mean n, variance 2n, by Wilson and Hilferty's approximation for 10^-5.
double bound(std::size_t degrees) {
  const double n = static_cast<double>(degrees), v = 2 / (9 * n);
  return n * std::pow(1 - v + 4.265 * std::sqrt(v), 3);
}

double chi_squared(const std::vector<std::uint32_t>& counts) {
  const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
  const double expected = total / static_cast<double>(counts.size());
  double sum = 0;
  for (const std::uint32_t count : counts)
    sum += (count - expected) * (count - expected) / expected;
  return sum;
}

/// `draw` gives the cell of each try.
template <class Draw>
void expect_uniform(std::size_t cells, std::size_t tries, Draw&& draw) {
  std::vector<std::uint32_t> counts(cells);
  for (std::size_t i = 0; i < tries; ++i)
    ++counts[static_cast<std::size_t>(draw(i))];
  EXPECT_LT(chi_squared(counts), bound(cells - 1));
}

TEST(RandomStatistics, EveryByteOfEveryWordIsUniform) {
  for (int shift = 0; shift < 64; shift += 8) {
    Random random(static_cast<std::uint64_t>(shift));
    expect_uniform(256, 100000, [&](std::size_t) { return (random.bits64() >> shift) & 0xff; });
  }
}

TEST(RandomStatistics, NumbersBelowABoundAreUniform) {
  Random random(11);
  for (const std::size_t cells : {2U, 3U, 6U, 10U, 52U, 1000U})
    expect_uniform(cells, 200 * cells, [&](std::size_t) { return random.below(cells); });
  // Two thirds of 2^64: a remainder would fall into the lower half twice as often.
  constexpr std::uint64_t k_bound = ~std::uint64_t{0} / 3 * 2;
  expect_uniform(2, 100000,
                 [&](std::size_t) { return random.below(k_bound) < k_bound / 2 ? 0 : 1; });
}

TEST(RandomStatistics, PairsOfOneStreamAndOfNeighboursAreIndependent) {
  Random random(12);
  expect_uniform(64 * 64, 400000, [&](std::size_t) {
    const std::uint64_t first = random.below(64U);
    return first * 64 + random.below(64U);
  });
  const Random match(13);
  expect_uniform(64 * 64, 400000, [&](std::size_t i) {
    const std::uint64_t here = match.stream(i).bits64() >> 58;
    return here * 64 + (match.stream(i + 1).bits64() >> 58);
  });
  expect_uniform(64 * 64, 400000, [&](std::size_t i) {  // seeds that follow each other
    return (Random(i).bits64() >> 58) * 64 + (Random(i + 1).bits64() >> 58);
  });
}

TEST(RandomStatistics, OneBitOfTheSeedFlipsHalfOfTheBits) {
  std::uint32_t flipped = 0;
  for (int bit = 0; bit < 64; ++bit) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const std::uint64_t other = seed ^ std::uint64_t{1} << bit;
      flipped +=
          static_cast<std::uint32_t>(std::popcount(Random(seed).bits64() ^ Random(other).bits64()));
    }
  }
  EXPECT_NEAR(flipped / 6400.0, 32, 0.3);  // 6 standard deviations: 4 / √6400 · 6
}

// Archimedes: each coordinate of a point on the sphere is uniform; so is the angle about an axis.
TEST(RandomStatistics, DirectionsAreUniform) {
  for (int axis = 0; axis < 3; ++axis) {
    Random random(static_cast<std::uint64_t>(20 + axis));
    expect_uniform(100, 100000, [&](std::size_t) {
      const std::int64_t raw = random.direction()[axis].raw + (std::int64_t{1} << 30);
      return std::min<std::size_t>(99, static_cast<std::size_t>(raw * 50 >> 30));
    });
    expect_uniform(8, 100000, [&](std::size_t) {
      const Vec3<Unit> v = random.direction();
      return (v.x.raw < 0 ? 1U : 0U) + (v.y.raw < 0 ? 2U : 0U) + (v.z.raw < 0 ? 4U : 0U);
    });
  }
}

TEST(RandomStatistics, ShufflesGiveEveryOrder) {
  Random random(30);
  expect_uniform(24, 24000, [&](std::size_t) {
    std::array<std::size_t, 4> items{0, 1, 2, 3};
    random.shuffle(items);
    std::size_t rank = 0;  // in the order of the dictionary
    for (std::size_t i = 0; i < 4; ++i) {
      const auto rest = std::span(items).subspan(i);
      const auto smaller = std::ranges::count_if(rest, [&](std::size_t x) { return x < items[i]; });
      rank = rank * (4 - i) + static_cast<std::size_t>(smaller);
    }
    return rank;
  });
}

}  // namespace
}  // namespace lockstone
