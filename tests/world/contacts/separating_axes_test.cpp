// Pairs that are apart keep the axis that parted them, and nothing depends on it.

#include "core/world/phases/narrow/separating_axes.h"

#include <gtest/gtest.h>

#include <lockstone/hull.h>
#include <lockstone/profile.h>

#include "core/collision/narrow_phase/collide_bodies.h"
#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

const Vec3<Unit> k_x{Unit::from_integer(1), {}, {}};
const Vec3<Unit> k_y{{}, Unit::from_integer(1), {}};

TEST(SeparatingAxes, AreFoundByTheirPairsATickLater) {
  SeparatingAxes axes;
  axes.reserve(4);
  axes.begin(3);
  axes.note(1, {1, 5}, {});
  axes.note(0, {1, 2}, k_x);
  axes.note(2, {4, 5}, k_y);
  axes.begin(0);
  SeparatingAxes::Reader reader = axes.read_from({0, 9});
  EXPECT_EQ(reader.axis_of({0, 9}), Vec3<Unit>{});
  EXPECT_EQ(reader.axis_of({1, 2}), k_x);
  EXPECT_EQ(reader.axis_of({1, 5}), Vec3<Unit>{});
  EXPECT_EQ(reader.axis_of({4, 5}), k_y);
  EXPECT_EQ(reader.axis_of({4, 6}), Vec3<Unit>{});
  EXPECT_EQ(axes.read_from({2, 0}).axis_of({4, 5}), k_y);
}

TEST(SeparatingAxes, AreForgottenAtOnce) {
  SeparatingAxes axes;
  axes.begin(1);
  axes.note(0, {1, 2}, k_x);
  axes.forget();
  axes.begin(0);
  EXPECT_EQ(axes.read_from({}).axis_of({1, 2}), Vec3<Unit>{});
}

PlacedShape placed_at(const Shape& shape, Position x) {
  PlacedShape placed;
  placed.shape = shape;
  placed.rotation = to_matrix(Quat{});
  placed.origin = placed.centre = {x, {}, {}};
  return placed;
}

TEST(SeparatingAxes, AreBelievedOnlyWhereTheyPart) {
  const PlacedShape box = placed_at(Shape::box(1_m, 1_m, 1_m), {});
  const PlacedShape apart = placed_at(Shape::capsule(1_m, 1_m), Position::from_integer(3));
  EXPECT_TRUE(separated_along(box, apart, 0.5_m, k_x));
  EXPECT_FALSE(separated_along(box, apart, 0.5_m, -k_x));
  EXPECT_FALSE(separated_along(box, apart, 0.5_m, k_y));
  EXPECT_FALSE(separated_along(box, apart, 1_m, k_x));
  EXPECT_FALSE(separated_along(box, box, {}, k_x));
}

AssetPtr random_rock(test::Random& random) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < 16; ++i) {
    const auto x = static_cast<std::int32_t>(random.between(-600, 600));
    const auto y = static_cast<std::int32_t>(random.between(-600, 600));
    const auto z = static_cast<std::int32_t>(random.between(-600, 600));
    points.push_back(
        {Length::from_ratio(x, 1000), Length::from_ratio(y, 1000), Length::from_ratio(z, 1000)});
  }
  const HullResult rock = Hull::build(points);
  EXPECT_TRUE(rock.ok());
  return rock.hull;
}

// Rocks, boxes and capsules that come down close beside each other.
World crowd() {
  test::Random random(test::run_seed());
  const AssetPtr rock = random_rock(random);
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{rock});
  World world = test::make_world({.body_capacity = 128}, std::move(assets));
  test::add_ground(world);
  const Shape shapes[] = {rock->shape(), Shape::box(0.4_m, 0.4_m, 0.4_m), rock->shape(),
                          Shape::capsule(0.3_m, 0.2_m)};
  for (int i = 0; i < 64; ++i) {
    BodyDef def = test::dynamic_body(shapes[i % 4], Position::from_ratio(11 * (i % 4), 10),
                                     Position::from_ratio(10 + 12 * (i / 16), 10),
                                     Position::from_ratio(11 * (i / 4 % 4), 10));
    def.angular_velocity.y = AngularVelocity::from_integer(static_cast<int>(random.between(-3, 3)));
    test::add(world, def);
  }
  return world;
}

struct Outcome {
  std::vector<std::uint64_t> hashes;
  std::uint64_t apart = 0;   // pairs without contact
  std::uint64_t parted = 0;  // of these, by last tick's axis
};

// The world's derived data is dropped every this many ticks; 0: never.
Outcome run_crowd(int drop_every) {
  World world = crowd();
  world.set_clock(test::counting_clock, ProfileDetail::pairs);
  Outcome outcome;
  for (int tick = 0; tick < 90; ++tick) {
    if (drop_every != 0 && tick % drop_every == 0) world.drop_derived();
    (void)world.step();
    outcome.hashes.push_back(world.hash().total);
  }
  for (const auto& row : world.profile().pair_kinds) {
    for (const PairProfile& pairs : row) {
      outcome.apart += pairs.pairs - pairs.in_contact;
      outcome.parted += pairs.parted;
    }
  }
  return outcome;
}

TEST(SeparatingAxes, ChangeNoResultAndSaveMostSearches) {
  const Outcome kept = run_crowd(0), without = run_crowd(1), now_and_then = run_crowd(3);
  EXPECT_EQ(kept.hashes, without.hashes);
  EXPECT_EQ(kept.hashes, now_and_then.hashes);
  EXPECT_EQ(kept.apart, without.apart);
  EXPECT_GT(kept.apart, 1000U);
  EXPECT_EQ(without.parted, 0U);
  EXPECT_GT(now_and_then.parted, 0U);
  EXPECT_LT(now_and_then.parted, kept.parted);
  EXPECT_GT(2 * kept.parted, kept.apart);
  std::printf("  %llu of %llu pairs without contact by last tick's axis\n",
              static_cast<unsigned long long>(kept.parted),
              static_cast<unsigned long long>(kept.apart));
}

}  // namespace
}  // namespace lockstone
