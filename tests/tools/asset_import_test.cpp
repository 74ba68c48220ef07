// Importing files: decimals, polygons, OBJ text, and PNG files that are damaged in every way.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/decimal.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>

#include "core/math/int128.h"
#include "tests/support/random.h"
#include "tools/assets/import.h"
#include "tools/assets/png_reader.h"
#include "tools/assets/polygon.h"

namespace lockstone::assets {
namespace {

using namespace literals;

std::optional<Length> length_of(std::string_view text, std::string_view scale = "1") {
  const auto value = read_scientific(text);
  const auto factor = read_scientific(scale, k_max_scale_digits);
  EXPECT_TRUE(value && factor) << text << " " << scale;
  return scaled_length(*value, *factor);
}

TEST(ScientificDecimal, ReadsTheNotationsOfModellers) {
  for (const char* text : {"1.5", "+1.5", "1.50", "15e-1", ".15e1", "0.015E+2", "0001.5000"})
    EXPECT_EQ(length_of(text), 1.5_m) << text;
  EXPECT_EQ(length_of("-3."), -3_m);
  EXPECT_EQ(length_of("-0"), 0_m);
  EXPECT_EQ(length_of("1e-99"), 0_m);
  EXPECT_EQ(length_of("0e99"), 0_m);
}

TEST(ScientificDecimal, RefusesOtherText) {
  for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "1e100", "1e0000", "nan", "inf", "1,5",
                           "0x10", "1.5f", "--1", "1.2.3", "1234567890123456789"})
    EXPECT_FALSE(read_scientific(text)) << text;
  EXPECT_FALSE(read_scientific("1234567891", 9));
  EXPECT_TRUE(read_scientific("00123456789000", 9));  // zeros at the ends do not count
}

TEST(ScientificDecimal, RoundsToNearestTiesAway) {
  EXPECT_EQ(length_of("0.000000476837158203125"), Length::from_raw(1));  // 2^-21
  EXPECT_EQ(length_of("-0.000000476837158203125"), Length::from_raw(-1));
  EXPECT_EQ(length_of("0.000000476837158203124"), Length{});
  EXPECT_EQ(length_of("39.37007874015748", "0.0254"), 1_m);
  EXPECT_EQ(length_of("-2", "-0.5"), 1_m);
}

TEST(ScientificDecimal, KeepsWithinTheRange) {
  EXPECT_EQ(length_of("512"), 512_m);
  EXPECT_EQ(length_of("-51200", "0.01"), -512_m);
  EXPECT_EQ(length_of("512.0000001"), 512_m);
  for (const char* text : {"512.000001", "2048", "1e99", "999999999999999999e80"})
    EXPECT_EQ(length_of(text), std::nullopt) << text;
}

// The core's parser, written otherwise, is the reference; a scale of 10^k moves the point.
TEST(ScientificDecimal, AgreesWithTheCoresParser) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 20000; ++run) {
    std::string text = random.between(0, 1) == 0 ? "" : "-";
    text += std::to_string(random.between(0, 511)) + ".";
    for (std::int64_t digit = random.between(1, 15); digit > 0; --digit)
      text += static_cast<char>('0' + random.between(0, 9));
    const Length expected = parse_decimal<Length>(text).value();
    EXPECT_EQ(length_of(text), expected) << text;
    const std::int64_t places = random.between(-20, 20);
    EXPECT_EQ(length_of(text + "e" + std::to_string(places), "1e" + std::to_string(-places)),
              expected)
        << text;
  }
}

// |raw · D − N · 2^20| ≤ D / 2 for value · scale = N / D.
TEST(ScientificDecimal, RoundsProductsOnce) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 20000; ++run) {
    const ScientificDecimal value{false, static_cast<std::uint64_t>(random.between(0, 999999999)),
                                  -8};
    const ScientificDecimal scale{false, static_cast<std::uint64_t>(random.between(1, 999999)), -5};
    const auto length = scaled_length(value, scale);
    constexpr std::uint64_t k_denominator = 10'000'000'000'000;  // 10^13
    const UInt128 exact = multiply_wide(value.digits * scale.digits, std::uint64_t{1} << 20);
    const auto rounded = static_cast<std::int64_t>(round_divide(exact, k_denominator));
    ASSERT_TRUE(length.has_value());
    EXPECT_EQ(length->raw, rounded);
  }
}

// ---------------------------------------------------------------------------------------------

using Polygon = std::vector<Vec3<Length>>;

/// z component of twice the area; coordinates within 2^30.
std::int64_t doubled_area(const Polygon& p, const CornerTriple& t) {
  const auto& [a, b, c] = std::array{p[t[0]], p[t[1]], p[t[2]]};
  return std::int64_t{(b.x - a.x).raw} * (c.y - a.y).raw -
         std::int64_t{(b.y - a.y).raw} * (c.x - a.x).raw;
}

/// Checks that the triangles turn forward and cover exactly the polygon.
void expect_cover(const Polygon& polygon, std::size_t triangle_count) {
  const auto triangles = triangulate(polygon);
  ASSERT_TRUE(triangles.has_value());
  EXPECT_EQ(triangles->size(), triangle_count);
  std::int64_t covered = 0, area = 0;
  for (const CornerTriple& t : *triangles) {
    EXPECT_GT(doubled_area(polygon, t), 0);
    covered += doubled_area(polygon, t);
  }
  for (std::uint32_t i = 2; i < polygon.size(); ++i)
    area += doubled_area(polygon, {0, i - 1, i});
  EXPECT_EQ(covered, area);
}

TEST(Triangulate, CutsConcaveAndFlatCorners) {
  expect_cover({{0_m, 0_m, 0_m},
                {2_m, 0_m, 0_m},
                {2_m, 1_m, 0_m},
                {1_m, 1_m, 0_m},
                {1_m, 2_m, 0_m},
                {0_m, 2_m, 0_m}},
               4);
  expect_cover({{0_m, 0_m, 0_m}, {1_m, 0_m, 0_m}, {2_m, 0_m, 0_m}, {0_m, 2_m, 0_m}}, 2);
}

TEST(Triangulate, SeesEveryAxisFromBothSides) {
  const Polygon arrow{{0_m, 0_m, 0_m}, {2_m, 1_m, 0_m}, {0_m, 2_m, 0_m}, {1_m, 1_m, 0_m}};
  for (int axis = 0; axis < 3; ++axis) {
    Polygon turned;
    for (const Vec3<Length>& v : arrow)
      turned.push_back({v[axis % 3], v[(axis + 1) % 3], v[(axis + 2) % 3]});
    const Polygon back(turned.rbegin(), turned.rend());
    EXPECT_EQ(triangulate(turned)->size(), 2U);
    EXPECT_EQ(triangulate(back)->size(), 2U);
  }
}

TEST(Triangulate, RefusesCrossingAndFlatPolygons) {
  EXPECT_FALSE(
      triangulate(Polygon{{0_m, 0_m, 0_m}, {3_m, 3_m, 0_m}, {3_m, 0_m, 0_m}, {0_m, 2_m, 0_m}}));
  EXPECT_FALSE(
      triangulate(Polygon{{0_m, 0_m, 0_m}, {1_m, 0_m, 0_m}, {2_m, 0_m, 0_m}, {3_m, 0_m, 0_m}}));
}

TEST(Triangulate, CoversStarsExactly) {
  test::Random random(test::run_seed());
  constexpr int k_arms = 16;
  for (int run = 0; run < 500; ++run) {
    Polygon star;
    for (int i = 0; i < k_arms; ++i) {  // on the sides of a square, drawn in by some factor
      const int side = i / 4, step = i % 4;
      const int u = side == 0 ? step - 2 : side == 1 ? 2 : side == 2 ? 2 - step : -2;
      const int v = side == 0 ? -2 : side == 1 ? step - 2 : side == 2 ? 2 : 2 - step;
      const auto reach = static_cast<std::int32_t>(random.between(1 << 10, 1 << 27));
      star.push_back({Length::from_raw(u * reach), Length::from_raw(v * reach), {}});
    }
    expect_cover(star, k_arms - 2);
  }
}

// ---------------------------------------------------------------------------------------------

TEST(ObjImport, HullIsThatOfTheSamePoints) {
  Imported imported;
  ObjImport options;
  options.kind = ShapeKind::hull;
  // The corners of a cube, each line with another end.
  std::string text;
  std::vector<Vec3<Length>> points;
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [corner](int axis) { return (corner >> axis & 1) != 0 ? 1 : -1; };
    for (int axis = 0; axis < 3; ++axis)
      text += (axis == 0 ? "v " : " ") + std::to_string(side(axis));
    text += std::array{"\n", "\r\n", "\r"}[static_cast<std::size_t>(corner % 3)];
    points.push_back({Length::from_integer(side(0)), Length::from_integer(side(1)),
                      Length::from_integer(side(2))});
  }
  ASSERT_FALSE(import_obj(text, options, imported));
  EXPECT_EQ(imported.asset->id(), Hull::build(points).hull->id());
}

TEST(ObjImport, NeverCrashesOnDamagedText) {
  const std::string good =
      "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl m\ng x y\ns off\nf 1 2 3\nf 1/1/1 2//2 3 4\n"
      "f -1 -2 -3\nl 1 2\n";
  test::Random random(test::run_seed());
  int accepted = 0;
  for (int run = 0; run < 3000; ++run) {
    std::string text = good;
    for (std::int64_t i = random.between(1, 4); i > 0; --i) {
      const auto at =
          static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(text.size()) - 1));
      text[at] = static_cast<char>(random.between(0, 255));
    }
    Imported imported;
    ObjImport options;
    options.kind = std::array{ShapeKind::mesh, ShapeKind::hull,
                              ShapeKind::compound}[static_cast<std::size_t>(run % 3)];
    const ImportOutcome fault = import_obj(text, options, imported);
    EXPECT_EQ(fault.has_value(), imported.asset == nullptr);
    EXPECT_FALSE(fault && fault->reason.empty());
    accepted += fault ? 0 : 1;
  }
  EXPECT_GT(accepted, 0);
}

// ---------------------------------------------------------------------------------------------

using Bytes = std::vector<std::byte>;

/// 4 by 3 samples of 16-bit grey: sample i is 7919 · i modulo 2^16. Written by Python's zlib.
constexpr std::array<unsigned char, 93> k_png{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x03, 0x10, 0x00, 0x00, 0x00, 0x00, 0xc1, 0x0f, 0x2d,
    0x59, 0x00, 0x00, 0x00, 0x24, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60, 0x60, 0x90, 0x7b,
    0x6f, 0x7b, 0x2f, 0xe6, 0x2c, 0x43, 0xf5, 0x9e, 0x59, 0xab, 0x77, 0xce, 0xba, 0xd1, 0xc9, 0xf0,
    0xbd, 0x42, 0x2c, 0xdd, 0x34, 0x2c, 0xc4, 0x15, 0x00, 0x9c, 0x13, 0x0b, 0x92, 0x9a, 0x75, 0x40,
    0x2e, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

Bytes good_png() {
  Bytes bytes;
  for (const unsigned char byte : k_png)
    bytes.push_back(static_cast<std::byte>(byte));
  return bytes;
}

/// ISO 3309, bit by bit.
std::uint32_t crc_of(ByteView bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0);
  }
  return ~crc;
}

std::uint32_t big_endian_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<std::uint32_t>(bytes[at + i]);
  return value;
}

/// Makes the checksum of every chunk right, as far as the lengths allow.
void seal(Bytes& bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian_at(bytes, at);
    if (length > bytes.size() - at - 12) return;
    const std::uint32_t crc = crc_of(ByteView(bytes).subspan(at + 4, length + 4));
    for (std::size_t i = 0; i < 4; ++i)
      bytes[at + 8 + length + i] = static_cast<std::byte>(crc >> (24 - 8 * i) & 0xff);
    at += length + 12;
  }
}

TEST(PngReader, ReadsEverySampleAsStored) {
  GreyImage image;
  ASSERT_FALSE(read_png(good_png(), image));
  ASSERT_EQ(image.columns * image.rows, 12U);
  EXPECT_EQ(image.columns, 4U);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(image.samples[i], (7919 * i) % 65536);
}

TEST(PngReader, RefusesEveryTruncation) {
  const Bytes bytes = good_png();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    GreyImage image;
    const ImportOutcome fault = read_png(ByteView(bytes).first(size), image);
    ASSERT_TRUE(fault.has_value()) << size;
    EXPECT_FALSE(fault->reason.empty());
  }
}

TEST(PngReader, RefusesEveryFlippedBit) {
  for (std::size_t bit = 0; bit < 8 * k_png.size(); ++bit) {
    Bytes bytes = good_png();
    bytes[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    GreyImage image;
    EXPECT_TRUE(read_png(bytes, image).has_value()) << bit;
  }
}

TEST(PngReader, SurvivesDamageBehindRightChecksums) {
  test::Random random(test::run_seed());
  const auto last = static_cast<std::int64_t>(k_png.size()) - 1;
  for (int run = 0; run < 4000; ++run) {
    Bytes bytes = good_png();
    for (std::int64_t i = random.between(1, 4); i > 0; --i)
      bytes[static_cast<std::size_t>(random.between(8, last))] =
          static_cast<std::byte>(random.between(0, 255));
    seal(bytes);
    GreyImage image;
    const ImportOutcome fault = read_png(bytes, image);
    EXPECT_EQ(fault.has_value(), image.samples.empty());
    EXPECT_EQ(image.samples.size(), std::size_t{image.columns} * image.rows);
  }
}

TEST(PngImport, SpreadsTheSamplesOverTheHeight) {
  Imported imported;
  ASSERT_FALSE(import_png(good_png(), {.cell = 2_m, .height = 100_m, .base = -10_m}, imported));
  EXPECT_EQ(imported.asset->kind(), ShapeKind::height_field);
  EXPECT_EQ(import_png(good_png(), {.cell = 400_m, .height = 1_m, .base = {}}, imported)->reason,
            "coordinate out of range");
}

}  // namespace
}  // namespace lockstone::assets
