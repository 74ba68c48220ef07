// The text for people where two states differ: names of bodies, and quantities in their units.

#include <string>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

// A floor and a crate on it, which hangs on a joint too.
struct Yard {
  World world = test::make_world();
  BodyHandle floor = test::add_ground(world);
  BodyHandle crate =
      test::add(world, {.shape = Shape::box(0.5_m, 0.5_m, 0.5_m), .position = {{}, 0.5_m, {}}});
  JointHandle joint = world.create_joint(JointDef::of(JointKind::ball, floor, crate)).value();
};

Bytes canonical(const World& world) {
  return test::save(world, SnapshotKind::canonical);
}

std::string line_after_flip(Yard& yard, const char* store, std::uint64_t object,
                            const char* field) {
  const Bytes native = test::save(yard.world, SnapshotKind::native);
  const Bytes here = canonical(yard.world);
  EXPECT_TRUE(yard.world.flip_bit(store, object, field, 0)) << field;
  const Bytes there = canonical(yard.world);
  EXPECT_EQ(yard.world.load(SnapshotKind::native, native), Status::ok);
  return yard.world.describe_difference(here, there).to_line();
}

// Of the first of a store.
std::string name_in_line(Yard& yard, const char* store, const char* field) {
  const std::string line = line_after_flip(yard, store, 0, field);
  const std::size_t first = line.find('"') + 1;
  return line.substr(first, line.find('"', first) - first);
}

TEST(BodyName, StandsInTheLineOfADifference) {
  Yard yard;
  ASSERT_EQ(yard.world.set_name(yard.crate, "crate"), Status::ok);
  ASSERT_EQ(yard.world.apply(SetVelocity{yard.crate, {{}, 0.227_mps, {}}}), Status::ok);
  EXPECT_EQ(line_after_flip(yard, "body", 1, "velocity.y"),
            "body 1 \"crate\", velocity.y: 0x000000003a1cac08 (0.227 m/s) here, "
            "0x000000003a1cac09 (0.2270000002 m/s) there");
}

TEST(BodyName, StandsInTheLinesOfItsContactsAndJoints) {
  Yard yard;
  const BodyHandle other = test::add(
      yard.world, {.shape = Shape::box(0.5_m, 0.5_m, 0.5_m), .position = {1.5_m, 0.49_m, {}}});
  (void)yard.world.step();
  EXPECT_EQ(name_in_line(yard, "joint", "user_data"), "0-1");
  EXPECT_EQ(name_in_line(yard, "contact", "mean_impulse"), "2-0");
  ASSERT_EQ(yard.world.set_name(other, "barrel"), Status::ok);
  EXPECT_EQ(name_in_line(yard, "contact", "mean_impulse"), "2 barrel-0");
  ASSERT_EQ(yard.world.set_name(yard.crate, "crate"), Status::ok);
  EXPECT_EQ(name_in_line(yard, "joint", "user_data"), "0-1 crate");
  ASSERT_EQ(yard.world.set_name(yard.floor, "floor"), Status::ok);
  EXPECT_EQ(name_in_line(yard, "joint", "user_data"), "0 floor-1 crate");
}

TEST(BodyName, IsNoState) {
  Yard named, plain;
  ASSERT_EQ(named.world.set_name(named.crate, "crate"), Status::ok);
  EXPECT_EQ(canonical(named.world), canonical(plain.world));
  EXPECT_EQ(test::save(named.world, SnapshotKind::native),
            test::save(plain.world, SnapshotKind::native));
  EXPECT_EQ(named.world.hash128(), plain.world.hash128());
}

TEST(BodyName, GoesWithItsBodyAndNotToTheNextInTheSlot) {
  Yard yard;
  ASSERT_EQ(yard.world.set_name(yard.crate, "crate"), Status::ok);
  ASSERT_EQ(yard.world.apply(DestroyBody{yard.crate}), Status::ok);
  EXPECT_EQ(yard.world.name(yard.crate), "");
  EXPECT_EQ(yard.world.set_name(yard.crate, "gone"), Status::stale_handle);
  const BodyHandle next = test::add(yard.world, {});
  ASSERT_EQ(next.index, yard.crate.index);
  EXPECT_EQ(yard.world.name(next), "");
}

TEST(BodyName, ComesBackWithTheBodyThatARollbackBringsBack) {
  Yard yard;
  ASSERT_EQ(yard.world.set_name(yard.crate, "crate"), Status::ok);
  const Bytes before = test::save(yard.world, SnapshotKind::native);
  ASSERT_EQ(yard.world.apply(DestroyBody{yard.crate}), Status::ok);
  const BodyHandle next = test::add(yard.world, {});
  ASSERT_EQ(yard.world.load(SnapshotKind::native, before), Status::ok);
  yard.world.drop_derived();
  EXPECT_EQ(yard.world.name(yard.crate), "crate");
  EXPECT_FALSE(yard.world.exists(next));
}

TEST(BodyName, OfATimelineThatWasRolledBackIsForgotten) {
  World world = test::make_world();
  const Bytes before = test::save(world, SnapshotKind::native);
  ASSERT_EQ(world.set_name(test::add(world, {}), "predicted"), Status::ok);
  ASSERT_EQ(world.load(SnapshotKind::native, before), Status::ok);
  EXPECT_EQ(world.name(test::add(world, {})), "");
}

TEST(BodyName, IsCutBetweenCharactersAndKeepsToItsLine) {
  Yard yard;
  const auto named = [&](std::string_view name) {
    EXPECT_EQ(yard.world.set_name(yard.crate, name), Status::ok);
    return std::string(yard.world.name(yard.crate));
  };
  EXPECT_EQ(named(std::string(100, 'x')), std::string(k_max_body_name, 'x'));
  const std::string before(k_max_body_name - 1, 'x');
  EXPECT_EQ(named(before + "é"), before);
  EXPECT_EQ(named("a\nb\"c"), "a?b?c");
  EXPECT_EQ(named("crate"), "crate");
  EXPECT_EQ(named(yard.world.name(yard.crate)), "crate");
}

TEST(Difference, ShowsQuantitiesInTheirUnits) {
  Yard yard;
  const auto value = [&](const char* store, std::uint64_t object, const char* field) {
    const std::string line = line_after_flip(yard, store, object, field);
    return line.substr(line.find(": ") + 2, line.find(" here") - line.find(": ") - 2);
  };
  EXPECT_EQ(value("world", 0, "gravity.x"), "0x0000000000000000 (0 m/s^2)");
  EXPECT_EQ(value("body", 1, "position.y"), "0x0000000080000000 (0.5 m)");
  EXPECT_EQ(value("body", 1, "velocity.y"), "0x0000000000000000 (0 m/s)");
  EXPECT_EQ(value("body", 1, "orientation.w"), "0x40000000 (1)");
  EXPECT_EQ(value("body", 1, "size.x"), "0x00080000 (0.5 m)");
  EXPECT_EQ(value("body", 1, "angular_damping"), "0x00000000 (0 1/s)");
  EXPECT_EQ(value("body", 1, "user_data"), "0x0000000000000000");
  EXPECT_EQ(value("joint", 0, "linear[0].upper"), "0x00000000 (0 m)");
  EXPECT_EQ(value("joint", 0, "linear[0].speed"), "0x00000000 (0 m/s)");
  EXPECT_EQ(value("joint", 0, "linear[0].max_effort"), "0x0000000000000000 (0 N)");
  EXPECT_EQ(value("joint", 0, "angular[1].upper"), "0x00000000 (0 rad)");
  EXPECT_EQ(value("joint", 0, "angular[1].speed"), "0x00000000 (0 rad/s)");
  EXPECT_EQ(value("joint", 0, "angular[1].max_effort"), "0x0000000000000000 (0 N m)");
  EXPECT_EQ(value("joint", 0, "angular[1].hertz"), "0x00000000 (0 Hz)");
}

TEST(Difference, ShowsBitsThatMeanSomethingElseWithoutAUnit) {
  Yard yard;
  for (const char* field : {"union_a.x", "union_b.y", "union_c", "recycling_place.z"})
    EXPECT_EQ(line_after_flip(yard, "body", 1, field).find('('), std::string::npos) << field;
}

}  // namespace
}  // namespace lockstone
