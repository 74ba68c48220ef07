// Structures that stand by friction: cards that lean on each other and carry a board.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

BodyDef card(Position x, Position y, Angle lean, Coefficient friction) {
  BodyDef def = test::dynamic_body(Shape::box(0.0025_m, 0.15_m, 0.1_m), x, y, {});
  def.orientation = from_axis_angle({{}, {}, 1_r}, lean);
  def.material.density = 800_kgpm3;
  def.material.friction = friction;
  return def;
}

// The edge of the second card meets the face of the first, 2 degrees off its own lean.
void add_pair(World& world, Position x, Position floor, Coefficient friction) {
  test::add(world, card(x, floor + 0.132405_m, -0.5061455_rad, friction));
  test::add(world, card(x + 0.151404_m, floor + 0.129863_m, 0.5410521_rad, friction));
}

// Two pairs, a board that lies on the first card of each, and a pair on it. Tells how far the
// last card has gone after a second.
double distance_gone(Coefficient friction) {
  World world = test::make_world({.body_capacity = 16, .sleep_ms = 0});
  BodyDef table;
  table.motion = MotionType::static_body;
  table.shape = Shape::half_space();
  table.material.friction = friction;
  test::add(world, table);
  const Position left = -0.230702_m, floor = 0.26981_m;
  add_pair(world, left, {}, friction);
  add_pair(world, left + 0.31_m, {}, friction);
  BodyDef board = card(left + 0.225535_m, floor - 0.0025_m, 1.5707963_rad, friction);
  board.shape = Shape::box(0.0025_m, 0.215_m, 0.1_m);
  board.material.density = 4000_kgpm3;  // loads the cards below by several times their weight
  test::add(world, board);
  add_pair(world, -0.075702_m, floor, friction);
  const BodyHandle last = world.body_at(world.body_limit() - 1);
  const Vec3<Position> start = world.position(last);
  test::step(world, 60);
  const auto gone = world.position(last) - start;
  return std::hypot(test::metres(gone.x), test::metres(gone.y), test::metres(gone.z));
}

TEST(Leaning, HouseOfCardsStandsByFriction) {
  EXPECT_LT(distance_gone(0.8_r), 1e-4);
}

TEST(Leaning, SmoothCardsFall) {
  EXPECT_GT(distance_gone(0.3_r), 0.05);
}

}  // namespace
}  // namespace lockstone
