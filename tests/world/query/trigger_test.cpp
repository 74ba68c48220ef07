// Triggers of every shape see dynamic, kinematic and static bodies of every kind once each.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

AssetPtr cube_hull() {
  std::vector<Vec3<Length>> points;
  for (const Length x : {Length(0.5_m), Length(-0.5_m)}) {
    for (const Length y : {Length(0.5_m), Length(-0.5_m)}) {
      for (const Length z : {Length(0.5_m), Length(-0.5_m)})
        points.push_back({x, y, z});
    }
  }
  return Hull::build(points).hull;
}

// Two spheres with a gap between them, through which the passing body goes.
AssetPtr pair_of_balls() {
  std::array<CompoundChild, 2> children;
  for (CompoundChild& child : children)
    child.shape = Shape::sphere(0.5_m);
  children[0].position.z = 0.3_m;
  children[1].position.z = -0.3_m;
  return Compound::build(children).compound;
}

// A square of 8 m in the plane y = 0, its front upwards.
AssetPtr square_mesh() {
  const std::array<Vec3<Length>, 4> vertices{
      {{-4_m, {}, -4_m}, {-4_m, {}, 4_m}, {4_m, {}, 4_m}, {4_m, {}, -4_m}}};
  const std::array<TriangleIndices, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

AssetPtr square_field() {
  const std::array<Length, 4> heights{};
  HeightFieldDef def;
  def.columns = def.rows = 2;
  def.origin = {-4_m, {}, -4_m};
  def.cell_x = def.cell_z = 8_m;
  def.heights = heights;
  return HeightField::build(def).height_field;
}

struct Named {
  std::string name;
  Shape shape;
};

class Triggers : public ::testing::Test {
 protected:
  Triggers() {
    const std::vector<AssetPtr> list{cube_hull(), pair_of_balls(), square_mesh(), square_field()};
    bounded_ = {{"sphere", Shape::sphere(0.5_m)},
                {"capsule", Shape::capsule(0.3_m, 0.4_m)},
                {"box", Shape::box(0.5_m, 0.5_m, 0.5_m)},
                {"hull", list[0]->shape()},
                {"compound", list[1]->shape()}};
    surfaces_ = {{"half-space", Shape::half_space()},
                 {"mesh", list[2]->shape()},
                 {"height field", list[3]->shape()}};
    assets_ = std::make_shared<const AssetSet>(list);
  }

  [[nodiscard]] World make_world() const {
    WorldDef def;
    def.body_capacity = 16;
    def.gravity = {};
    return test::make_world(def, assets_);
  }

  std::vector<Named> bounded_, surfaces_;
  std::shared_ptr<const AssetSet> assets_;
};

BodyDef body_of(const Shape& shape, MotionType motion, bool is_trigger) {
  BodyDef def;
  def.shape = shape;
  def.motion = motion;
  def.is_trigger = is_trigger;
  return def;
}

/// Events of a run, and how they came one after the other.
struct TriggerCounts {
  int enter = 0, stay = 0, exit = 0, others = 0, out_of_order = 0;
};

TriggerCounts run(World& world, int ticks) {
  TriggerCounts counts;
  bool inside = false;
  for (int tick = 0; tick < ticks; ++tick) {
    (void)world.step();
    for (const ContactEvent& event : world.events()) {
      const bool enters = event.kind == EventKind::trigger_enter;
      const bool stays = event.kind == EventKind::trigger_stay;
      const bool exits = event.kind == EventKind::trigger_exit;
      counts.enter += enters ? 1 : 0;
      counts.stay += stays ? 1 : 0;
      counts.exit += exits ? 1 : 0;
      const bool others = event.kind < EventKind::trigger_enter || event.kind == EventKind::impact;
      counts.others += others ? 1 : 0;
      if (enters || stays || exits) counts.out_of_order += enters == inside ? 1 : 0;
      if (enters || stays || exits) inside = !exits;
    }
  }
  return counts;
}

// At 6 m/s a ball of 0.25 m passes 1 m (0.8 m the capsule) of trigger: inside for 1.3 … 1.5 m.
void expect_one_passage(const TriggerCounts& counts, const std::string& who) {
  EXPECT_EQ(counts.enter, 1) << who;
  EXPECT_EQ(counts.exit, 1) << who;
  EXPECT_EQ(counts.out_of_order, 0) << who;
  EXPECT_EQ(counts.others, 0) << who;
  EXPECT_GE(counts.stay, 11) << who;
  EXPECT_LE(counts.stay, 15) << who;
}

constexpr std::array k_moving{MotionType::kinematic, MotionType::dynamic};
constexpr std::array k_all{MotionType::static_body, MotionType::kinematic, MotionType::dynamic};

TEST_F(Triggers, OfEveryBoundedShapeSeeAPassingBodyOnce) {
  for (const Named& zone : bounded_) {
    for (const MotionType zone_motion : k_all) {
      for (const MotionType motion : k_moving) {
        World world = make_world();
        test::add(world, body_of(zone.shape, zone_motion, true));
        BodyDef ball = body_of(Shape::sphere(0.25_m), motion, false);
        ball.position.x = -3_m;
        ball.velocity.x = 6_mps;
        test::add(world, ball);
        expect_one_passage(run(world, 60), zone.name);
      }
    }
  }
}

// The ball passes through each kind of body as a trigger, as it is passed by one.
TEST_F(Triggers, SeeEveryBoundedShapePassOnce) {
  for (const Named& passing : bounded_) {
    for (const MotionType motion : k_moving) {
      World world = make_world();
      test::add(world, body_of(Shape::sphere(0.25_m), MotionType::static_body, true));
      BodyDef def = body_of(passing.shape, motion, false);
      def.position.x = -3_m;
      def.velocity.x = 6_mps;
      test::add(world, def);
      expect_one_passage(run(world, 60), passing.name);
    }
  }
}

// Moving triggers meet bodies that stand still, the surface included; static ones do not.
TEST_F(Triggers, ThatMoveSeeStaticSurfaces) {
  for (const Named& zone : bounded_) {
    for (const Named& surface : surfaces_) {
      for (const MotionType motion : k_all) {
        World world = make_world();
        test::add(world, body_of(surface.shape, MotionType::static_body, false));
        BodyDef def = body_of(zone.shape, motion, true);
        def.position.y = 0.3_m;
        def.allow_sleep = false;
        const BodyHandle trigger = test::add(world, def);
        TriggerCounts counts = run(world, 10);
        const std::string who = zone.name + " over " + surface.name;
        const bool moves = motion != MotionType::static_body;
        EXPECT_EQ(counts.enter, moves ? 1 : 0) << who;
        EXPECT_EQ(counts.stay, moves ? 9 : 0) << who;
        EXPECT_EQ(counts.others, 0) << who;
        if (!moves) continue;
        ASSERT_EQ(world.apply(SetVelocity{trigger, {{}, 6_mps, {}}}), Status::ok);
        counts = run(world, 20);
        EXPECT_EQ(counts.enter, 0) << who;
        EXPECT_EQ(counts.exit, 1) << who;
      }
    }
  }
}

// Surfaces as triggers: dynamic and kinematic bodies of every shape fall onto them, through them
// and out again. A half-space is entered for good.
TEST_F(Triggers, ThatAreSurfacesSeeEveryBoundedShapePass) {
  for (const Named& surface : surfaces_) {
    for (const Named& passing : bounded_) {
      for (const MotionType motion : k_moving) {
        World world = make_world();
        test::add(world, body_of(surface.shape, MotionType::static_body, true));
        BodyDef def = body_of(passing.shape, motion, false);
        def.position = {0.7_m, 2_m, 0.4_m};
        def.velocity.y = -4_mps;
        test::add(world, def);
        const TriggerCounts counts = run(world, 60);
        const std::string who = passing.name + " through " + surface.name;
        EXPECT_EQ(counts.enter, 1) << who;
        EXPECT_EQ(counts.exit, surface.shape.kind == ShapeKind::half_space ? 0 : 1) << who;
        EXPECT_EQ(counts.others, 0) << who;
        EXPECT_EQ(world.body(world.body_at(1)).velocity.y, Velocity(-4_mps)) << who;
      }
    }
  }
}

TEST_F(Triggers, DoNotSeeEachOtherTwiceNorPush) {
  for (const Named& zone : bounded_) {
    World world = make_world();
    BodyDef def = body_of(zone.shape, MotionType::dynamic, true);
    test::add(world, def);
    def.position.x = 0.2_m;
    const BodyHandle second = test::add(world, def);
    const TriggerCounts counts = run(world, 5);
    EXPECT_LE(counts.enter, 1) << zone.name;
    EXPECT_EQ(counts.others, 0) << zone.name;
    EXPECT_EQ(world.position(second).x, Position(0.2_m)) << zone.name;
  }
}

}  // namespace
}  // namespace lockstone
