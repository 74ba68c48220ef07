// Edits of terrain and their effects on bodies, queries and states.
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/character.h>
#include <lockstone/height_field.h>
#include <lockstone/rollback_history.h>
#include <lockstone/terrain.h>
#include <lockstone/vehicle.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

constexpr std::uint32_t k_side = 21;  // samples; cells of 1 m, from −10 to 10 m

HeightFieldDef grid() {
  HeightFieldDef def;
  def.columns = def.rows = k_side;
  def.origin = {-10_m, {}, -10_m};
  return def;
}

AssetPtr field_of(std::span<const Length> heights, std::span<const std::uint8_t> holes = {}) {
  static const std::array<Surface, 2> surfaces{{{0.9_r, {}}, {0_r, {}}}};
  HeightFieldDef def = grid();
  def.heights = heights;
  def.holes = holes;
  def.surfaces = surfaces;
  return HeightField::build(def).height_field;
}

AssetPtr flat_field() {
  static const std::vector<Length> heights(std::size_t{k_side} * k_side);
  return field_of(heights);
}

WorldDef terrain_def(std::uint32_t tiles = 64) {
  return {.body_capacity = 64, .vehicle_capacity = 2, .terrain_tile_capacity = tiles};
}

World make_world(const WorldDef& def = terrain_def(), const AssetPtr& asset = flat_field()) {
  return test::make_world(def, std::make_shared<AssetSet>(std::vector{asset}));
}

BodyHandle add_terrain(World& world, const Vec3<Position>& at = {}) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = world.assets()->all()[0]->shape();
  def.position = at;
  return test::add(world, def);
}

BodyHandle add_box(World& world, Position x, Position z, Position y = 0.25_m) {
  return test::add(world, test::dynamic_body(Shape::box(0.25_m, 0.25_m, 0.25_m), x, y, z));
}

// A square of samples at one height.
Status set_square(World& world, BodyHandle ground, std::uint32_t column, std::uint32_t row,
                  std::uint32_t side, Length height) {
  const std::vector<Length> heights(std::size_t{side} * side, height);
  return world.apply(SetHeights{.body = ground,
                                .column = column,
                                .row = row,
                                .columns = side,
                                .rows = side,
                                .heights = heights});
}

// The height that a ray from above finds.
double ground_at(const World& world, Position x, Position z) {
  const RayHit hit = world.cast_ray({x, 100_m, z}, {{}, -200_m, {}});
  return hit.body.is_null() ? -1e9 : metres(hit.point.y);
}

TEST(Terrain, WakesBodiesOnTheEditedCellsAndNoOthers) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const BodyHandle over = add_box(world, 0_m, 0_m), aside = add_box(world, 6_m, 6_m);
  test::step(world, 120);
  ASSERT_TRUE(world.body(over).is_asleep && world.body(aside).is_asleep);
  ASSERT_EQ(set_square(world, ground, 8, 8, 5, -2_m), Status::ok);
  EXPECT_FALSE(world.body(over).is_asleep);
  EXPECT_TRUE(world.body(aside).is_asleep);
  EXPECT_FALSE(world.find_fault());
  test::step(world, 120);
  EXPECT_NEAR(metres(world.position(over).y), -1.75, 0.01);
  EXPECT_TRUE(world.body(aside).is_asleep);
  EXPECT_NEAR(metres(world.position(aside).y), 0.25, 0.01);
}

// Awake, and left out of the solver until the ground below changes.
TEST(Terrain, MovesStillBodiesOnTheEditedCells) {
  WorldDef def = terrain_def();
  def.sleep_ms = 0;
  World world = make_world(def);
  const BodyHandle ground = add_terrain(world);
  const BodyHandle box = add_box(world, 0_m, 0_m);
  test::step(world, 60);
  ASSERT_EQ(world.step().still_bodies, 1U);
  ASSERT_EQ(set_square(world, ground, 8, 8, 5, -2_m), Status::ok);
  test::step(world, 10);
  EXPECT_LT(world.body(box).velocity.y, Velocity::from_integer(-1));
}

TEST(Terrain, LiftsBodiesInSmallSteps) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const BodyHandle box = add_box(world, 0_m, 0_m);
  test::step(world, 60);
  for (int i = 1; i <= 50; ++i) {
    ASSERT_EQ(set_square(world, ground, 8, 8, 5, Length::from_ratio(i, 50)), Status::ok);
    test::step(world, 2);
  }
  test::step(world, 60);
  EXPECT_NEAR(metres(world.position(box).y), 1.25, 0.02);
}

TEST(Terrain, LeavesTheAssetAndItsOtherBodies) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world), other = add_terrain(world, {30_m, {}, {}});
  ASSERT_EQ(set_square(world, ground, 8, 8, 5, 2_m), Status::ok);
  EXPECT_NEAR(ground_at(world, 0_m, 0_m), 2, 1e-5);
  EXPECT_NEAR(ground_at(world, 30_m, 0_m), 0, 1e-5);
  EXPECT_EQ(terrain_sample_of(world, other, 10, 10)->height, Length{});
  EXPECT_EQ(terrain_sample_of(world, ground, 10, 10)->height, Length(2_m));
  ASSERT_EQ(set_square(world, other, 0, 0, 2, 1_m), Status::ok);
  EXPECT_NEAR(ground_at(world, 20_m, -10_m), 1, 1e-5);
  EXPECT_NEAR(ground_at(world, 0_m, 0_m), 2, 1e-5);
  EXPECT_FALSE(world.find_fault());
}

TEST(Terrain, IsSeenByRaysCastsAndClosestPoints) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  ASSERT_EQ(set_square(world, ground, 8, 8, 5, 300_m), Status::ok);  // beyond the asset's bounds
  EXPECT_NEAR(ground_at(world, 0_m, 0_m), -1e9, 1);                  // the ray begins below
  const RayHit ray = world.cast_ray({{}, 400_m, {}}, {{}, -200_m, {}});
  EXPECT_NEAR(metres(ray.point.y), 300, 1e-4);
  const ShapeHit cast =
      world.cast_shape({Shape::sphere(0.5_m), {{0_m, 310_m, 0_m}, {}}, {{}, -20_m, {}}});
  EXPECT_EQ(cast.body, ground);
  EXPECT_NEAR(metres(cast.point.y), 300, 1e-3);
  const ClosestHit closest = world.closest_point({0_m, 301_m, 0_m}, 2_m);
  EXPECT_EQ(closest.body, ground);
  EXPECT_NEAR(metres(closest.point.y), 300, 1e-4);
}

TEST(Terrain, OpensAndClosesHoles) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const BodyHandle box = add_box(world, 0_m, 0_m);
  test::step(world, 120);
  const std::vector<std::uint8_t> open(16, 1), closed(16, 0);
  SetHeights command{.body = ground, .column = 8, .row = 8, .columns = 5, .rows = 5, .holes = open};
  ASSERT_EQ(world.apply(command), Status::ok);
  EXPECT_TRUE(terrain_sample_of(world, ground, 9, 9)->is_hole);
  EXPECT_NEAR(ground_at(world, 0.5_m, 0.5_m), -1e9, 1);
  test::step(world, 60);
  EXPECT_LT(metres(world.position(box).y), -2);
  command.holes = closed;
  ASSERT_EQ(world.apply(command), Status::ok);
  EXPECT_NEAR(ground_at(world, 0.5_m, 0.5_m), 0, 1e-5);
  EXPECT_EQ(terrain_tile_count(world), 0U);
}

TEST(Terrain, ChangesTheSurfacesOfCells) {
  double gone[2] = {};
  for (std::uint8_t kind = 0; kind < 2; ++kind) {
    World world = make_world();
    const BodyHandle ground = add_terrain(world);
    const std::vector<std::uint8_t> surfaces(400, kind);
    ASSERT_EQ(world.apply(
                  SetHeights{.body = ground, .columns = 21, .rows = 21, .cell_surfaces = surfaces}),
              Status::ok);
    EXPECT_EQ(terrain_sample_of(world, ground, 3, 4)->surface, kind);
    const BodyHandle box = add_box(world, -5_m, 0_m);
    test::step(world, 10);
    ASSERT_EQ(world.apply(SetVelocity{box, {4_mps, {}, {}}}), Status::ok);
    test::step(world, 60);
    gone[kind] = metres(world.position(box).x) + 5;
  }
  EXPECT_LT(gone[0], 2);    // rough
  EXPECT_GT(gone[1], 3.9);  // ice
}

// A world whose asset was built with the heights, and one that edits a flat one to them.
TEST(Terrain, IsAsIfTheAssetHadBeenBuiltSo) {
  test::Random random(7);
  std::vector<Length> heights;
  for (std::uint32_t i = 0; i < k_side * k_side; ++i)
    heights.push_back(Length::from_ratio(random.between(-700, 700), 1000));
  std::vector<std::uint8_t> holes(400);
  for (std::uint8_t& hole : holes)
    hole = random.below(12) == 0 ? 1 : 0;
  World built = make_world(terrain_def(), field_of(heights, holes)), edited = make_world();
  add_terrain(built);
  const BodyHandle ground = add_terrain(edited);
  ASSERT_EQ(
      edited.apply(SetHeights{
          .body = ground, .columns = k_side, .rows = k_side, .heights = heights, .holes = holes}),
      Status::ok);
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{Position::from_ratio(random.between(-9900, 9900), 1000), 5_m,
                   Position::from_ratio(random.between(-9900, 9900), 1000)},
                  {Length::from_ratio(random.between(-3000, 3000), 1000), -9_m, 1_m}};
    const RayHit a = built.cast_ray(ray.origin, ray.translation),
                 b = edited.cast_ray(ray.origin, ray.translation);
    ASSERT_EQ(a.fraction, b.fraction);
    ASSERT_EQ(a.part, b.part);
    ASSERT_EQ(a.normal, b.normal);
  }
  for (int i = 0; i < 25; ++i) {
    const Position x = Position::from_integer(i % 5 * 3 - 6),
                   z = Position::from_integer(i / 5 * 3 - 6);
    add_box(built, x, z, 2_m);
    add_box(edited, x, z, 2_m);
  }
  for (int tick = 0; tick < 240; ++tick) {
    test::step(built, 1);
    test::step(edited, 1);
    for (std::uint32_t i = 1; i < built.body_limit(); ++i) {
      const BodyHandle body = built.body_at(i);
      ASSERT_EQ(built.position(body), edited.position(body)) << tick << ' ' << i;
    }
  }
}

TEST(Terrain, GivesTilesBackThatAreAsInTheAsset) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const StateHash before = world.hash();
  ASSERT_EQ(set_square(world, ground, 3, 3, 2, 1_m), Status::ok);  // the corner of four tiles
  EXPECT_EQ(terrain_tile_count(world), 4U);
  EXPECT_NE(world.hash().total, before.total);
  ASSERT_EQ(set_square(world, ground, 3, 3, 2, {}), Status::ok);
  EXPECT_EQ(terrain_tile_count(world), 0U);
  EXPECT_EQ(world.hash().total, before.total);
  EXPECT_EQ(world.hash128().total, world.hash128().total);
}

TEST(Terrain, IsBoundedByItsCapacity) {
  World world = make_world(terrain_def(4));
  const BodyHandle ground = add_terrain(world);
  ASSERT_EQ(set_square(world, ground, 3, 3, 2, 1_m), Status::ok);
  const std::uint64_t before = world.hash().total;
  EXPECT_EQ(set_square(world, ground, 8, 8, 1, 1_m), Status::capacity_exhausted);
  EXPECT_EQ(world.hash().total, before);
  const std::array<Length, 1> height{1_m};
  const Refusal refusal =
      world.explain(SetHeights{.body = ground, .column = 8, .row = 8, .heights = height});
  EXPECT_NE(refusal.to_line().find("terrain_tile_capacity, 4"), std::string::npos)
      << refusal.to_line();
  EXPECT_EQ(set_square(world, ground, 4, 4, 1, 2_m), Status::ok);  // a tile that there is
  World none = make_world(terrain_def(0));
  EXPECT_EQ(set_square(none, add_terrain(none), 1, 1, 1, 1_m), Status::capacity_exhausted);
}

TEST(Terrain, RefusesArgumentsOutOfRangeAndChangesNothing) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world), box = add_box(world, 0_m, 0_m);
  const std::array<Length, 4> heights{1_m, 1_m, 1_m, 1_m}, high{1_m, 1_m, 1_m, 513_m};
  const std::array<std::uint8_t, 2> wrong{1, 1};
  const std::array<std::uint8_t, 1> surface{2};
  const SetHeights good{.body = ground, .columns = 2, .rows = 2, .heights = heights};
  std::vector<SetHeights> bad(9, good);
  bad[0].column = 20;
  bad[1].row = 0xffffffff;
  bad[2].columns = 0;
  bad[3].rows = 0xffffffff;
  bad[4].heights = std::span(heights).first(3);
  bad[5].heights = high;
  bad[6].holes = wrong;
  bad[7].cell_surfaces = surface;
  bad[8].heights = {};
  const std::uint64_t before = world.hash().total;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(world.apply(bad[i]), Status::invalid_argument) << i;
    EXPECT_TRUE(static_cast<bool>(world.explain(bad[i]))) << i;
  }
  SetHeights of_box = good;
  of_box.body = box;
  EXPECT_EQ(world.apply(of_box), Status::not_found);
  EXPECT_TRUE(static_cast<bool>(world.explain(of_box)));
  of_box.body = {};
  EXPECT_EQ(world.apply(of_box), Status::stale_handle);
  EXPECT_EQ(world.hash().total, before);
  EXPECT_FALSE(static_cast<bool>(world.explain(good)));
  EXPECT_FALSE(terrain_sample_of(world, box, 0, 0));
  EXPECT_FALSE(terrain_sample_of(world, ground, 21, 0));
}

TEST(Terrain, GoesWithItsBodyAndItsShape) {
  World world = make_world();
  const BodyHandle a = add_terrain(world), b = add_terrain(world, {40_m, {}, {}});
  ASSERT_EQ(set_square(world, a, 8, 8, 3, 1_m), Status::ok);
  ASSERT_EQ(set_square(world, b, 8, 8, 3, 2_m), Status::ok);
  ASSERT_EQ(world.apply(DestroyBody{a}), Status::ok);
  EXPECT_NEAR(ground_at(world, 39_m, -1_m), 2, 1e-5);
  EXPECT_FALSE(world.find_fault());
  ASSERT_EQ(world.apply(SetShape{b, world.assets()->all()[0]->shape()}), Status::ok);
  EXPECT_EQ(terrain_tile_count(world), 0U);
  EXPECT_NEAR(ground_at(world, 39_m, -1_m), 0, 1e-5);
  EXPECT_FALSE(world.find_fault());
}

TEST(Terrain, CarriesCharactersAndVehicles) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const CharacterDef character{.shape = Shape::capsule(0.5_m, 0.3_m)};
  const auto lands = [&] {
    CharacterMove move = move_character(world, character, {5_m, 3_m, 5_m}, {{}, -5_m, {}});
    EXPECT_TRUE(move.grounded);
    return metres(move.position.y);
  };
  const double flat = lands();
  BodyDef chassis = test::dynamic_body(Shape::box(1.5_m, 0.3_m, 0.7_m), -4_m, 0.8_m, -4_m);
  chassis.mass.mass = Mass::from_integer(1000);
  const BodyHandle car = test::add(world, chassis);
  ASSERT_EQ(world.apply(SetVehicle{car, make_car(2_m, 0.6_m, -0.1_m, Torque::from_integer(200))}),
            Status::ok);
  test::step(world, 120);
  const double stood = metres(world.position(car).y);
  ASSERT_EQ(set_square(world, ground, 0, 0, 20, -1_m), Status::ok);
  EXPECT_NEAR(lands(), flat - 1, 0.01);
  test::step(world, 180);
  EXPECT_NEAR(metres(world.position(car).y), stood - 1, 0.01);
}

// A world of boxes whose ground is edited at random.
class Edited {
 public:
  explicit Edited(const WorldDef& def = terrain_def(12)) : world(make_world(def)) {
    grounds_ = {add_terrain(world), add_terrain(world, {25_m, {}, {}})};
    for (int i = 0; i < 16; ++i)
      add_box(world, Position::from_integer(i % 4 * 3 - 5), Position::from_integer(i / 4 * 3 - 5),
              1_m);
  }

  void edit(test::Random& random) {
    SetHeights command{.body = grounds_[random.below(2)]};
    command.column = static_cast<std::uint32_t>(random.below(k_side));
    command.row = static_cast<std::uint32_t>(random.below(k_side));
    command.columns = static_cast<std::uint32_t>(random.between(1, 6));
    command.rows = static_cast<std::uint32_t>(random.between(1, 6));
    const std::vector<Length> heights(std::size_t{command.columns} * command.rows,
                                      Length::from_ratio(random.between(-2, 2), 4));
    const std::vector<std::uint8_t> holes(std::size_t{command.columns - 1} * (command.rows - 1),
                                          random.below(3) == 0 ? 1 : 0);
    if (random.below(4) != 0) command.heights = heights;
    if (random.below(3) == 0 && !holes.empty()) command.holes = holes;
    (void)world.apply(command);
  }

  World world;

 private:
  std::array<BodyHandle, 2> grounds_{};
};

// Saved at any tick, loaded elsewhere, with and without derived data: the same future.
TEST(Terrain, GoesOnFromASnapshot) {
  test::Random random(3), same(3);
  Edited one, other;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 5 == 0) one.edit(random);
    if (tick % 7 == 3) {
      const SnapshotKind kind = tick % 2 == 0 ? SnapshotKind::native : SnapshotKind::canonical;
      ASSERT_EQ(other.world.load(kind, test::save(one.world, kind)), Status::ok) << tick;
      same = random;
    } else if (tick % 5 == 0) {
      other.edit(same);
    }
    ASSERT_EQ(one.world.hash().total, other.world.hash().total) << tick;
    ASSERT_FALSE(one.world.find_fault()) << one.world.find_fault().what;
    ASSERT_FALSE(other.world.find_fault()) << other.world.find_fault().what;
    test::step(one.world, 1);
    test::step(other.world, 1);
    if (tick % 3 == 0) other.world.drop_derived();
  }
  EXPECT_GT(terrain_tile_count(one.world), 0U);
}

TEST(Terrain, GoesBackToAStateBeforeIt) {
  World world = make_world();
  const BodyHandle ground = add_terrain(world);
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::native);
  ASSERT_EQ(set_square(world, ground, 8, 8, 5, 4_m), Status::ok);
  ASSERT_EQ(world.load(SnapshotKind::native, saved), Status::ok);
  EXPECT_NEAR(ground_at(world, 0_m, 0_m), 0, 1e-5);
  EXPECT_FALSE(world.find_fault());
}

TEST(Terrain, RollsBackAsItWas) {
  test::Random random(11), same(11);
  Edited rolled, plain;
  RollbackHistory history(rolled.world, 16);
  for (int round = 0; round < 20; ++round) {
    const std::vector<std::byte> saved = test::save(rolled.world, SnapshotKind::native);
    for (int j = 0; j < 6; ++j) {  // a wrong guess, with edits or without
      if (round % 3 != 0 && j == 2) rolled.edit(random);
      (void)history.step();
    }
    ASSERT_EQ(rolled.world.load(SnapshotKind::native, saved), Status::ok);
    random = same;
    for (int j = 0; j < 6; ++j) {
      if (round % 2 == 0 && j == 1) {
        rolled.edit(random);
        plain.edit(same);
      }
      (void)history.step();
      test::step(plain.world, 1);
      ASSERT_EQ(rolled.world.hash().total, plain.world.hash().total) << round << ' ' << j;
      ASSERT_FALSE(rolled.world.find_fault()) << rolled.world.find_fault().what;
    }
  }
}

TEST(Terrain, IsNamedWhereTwoStatesDiffer) {
  Edited one, other;
  ASSERT_EQ(set_square(one.world, one.world.body_at(0), 8, 4, 1, 1_m), Status::ok);
  ASSERT_EQ(set_square(other.world, other.world.body_at(0), 8, 4, 1, 2_m), Status::ok);
  const StateDifference found =
      one.world.describe_difference(test::save(one.world, SnapshotKind::canonical),
                                    test::save(other.world, SnapshotKind::canonical));
  EXPECT_TRUE(found.differs);
  EXPECT_EQ(found.store, "terrain_tile");
  EXPECT_EQ(found.field, "height[0]");
  EXPECT_EQ(found.name, "0, samples from 8, 4");
}

// A flipped bit of any field is refused, or gives another state.
TEST(Terrain, RefusesTilesThatNoCommandMakes) {
  for (const char* field :
       {"body", "row", "column", "height[0]", "height[3]", "surface[2]", "holes", "reserved"}) {
    for (const unsigned bit : {0U, 5U, 7U}) {
      World world = make_world();
      const BodyHandle ground = add_terrain(world);
      ASSERT_EQ(set_square(world, ground, 20, 20, 1, 1_m), Status::ok);  // the tile has one sample
      const std::uint64_t before = world.hash().total;
      ASSERT_TRUE(world.flip_bit("terrain_tile", 0, field, bit));
      const std::vector<std::byte> bytes = test::save(world, SnapshotKind::canonical);
      EXPECT_NE(world.hash().total, before) << field;
      World other = make_world();
      add_terrain(other);
      const Status status = other.load(SnapshotKind::canonical, bytes);
      const std::string_view name = field;
      const bool is_valid = name == "height[0]";
      const bool may_be = name == "row" || name == "column";  // another tile of the field
      if (!may_be) {
        EXPECT_EQ(status, is_valid ? Status::ok : Status::malformed) << field << ' ' << bit;
      }
      EXPECT_FALSE(other.find_fault()) << other.find_fault().what;
    }
  }
}

}  // namespace
}  // namespace lockstone
