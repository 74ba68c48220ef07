// The contacts that a full world leaves out do not depend on threads.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/thread_pool.h>

#include "tests/support/shuffled_runner.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

// Two boxes side by side, so that a body has up to two contacts with each other.
AssetPtr make_pair_of_boxes() {
  CompoundChild children[2];
  children[0].shape = children[1].shape = Shape::box(0.4_m, 0.4_m, 0.4_m);
  children[0].position = {-0.4_m, {}, {}};
  children[1].position = {0.4_m, {}, {}};
  return Compound::build(children).compound;
}

// A pile of plain and compound bodies, far more than there is room for contacts.
World make_crowd(std::uint32_t pair_capacity, std::uint32_t contact_capacity) {
  const AssetPtr compound = make_pair_of_boxes();
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{compound});
  const WorldDef def{
      .body_capacity = 256, .pair_capacity = pair_capacity, .contact_capacity = contact_capacity};
  World world = std::move(World::create(def, std::move(assets))).value();
  test::add_ground(world);
  for (int i = 0; i < 120; ++i) {
    const Shape shape = i % 2 == 0 ? Shape::box(0.5_m, 0.5_m, 0.5_m) : compound->shape();
    const auto place = [](int steps) { return Position::from_ratio(7 * steps, 10); };
    test::add(world, test::dynamic_body(shape, place(i % 5), place(1 + i / 25), place(i / 5 % 5)));
  }
  return world;
}

// Balls beside the corners of tiles: four contacts each, of which one is left once seams are
// removed.
World make_balls_beside_corners(std::uint32_t contact_capacity) {
  constexpr int k_tiles = 8;
  const WorldDef def{
      .body_capacity = 256, .pair_capacity = 1024, .contact_capacity = contact_capacity};
  World world = World::create(def).value();
  for (int i = 0; i < k_tiles * k_tiles; ++i) {
    BodyDef tile =
        test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), Position::from_integer(i % k_tiles), {},
                           Position::from_integer(i / k_tiles));
    tile.motion = MotionType::static_body;
    test::add(world, tile);
  }
  const auto beside = [](int tile) { return Position::from_ratio(100 * tile + 47, 100); };
  for (int i = 0; i < (k_tiles - 1) * (k_tiles - 1); ++i)
    test::add(world, test::dynamic_body(Shape::sphere(0.1_m), beside(i % (k_tiles - 1)),
                                        Position::from_ratio(6, 10), beside(i / (k_tiles - 1))));
  return world;
}

void expect_same(World alone, World shared, TaskRunner& runner) {
  shared.set_task_runner(&runner, TaskPieces::smallest);
  bool exhausted = false;
  for (int tick = 0; tick < test::share_of(20); ++tick) {
    const StepReport report = alone.step();
    exhausted = exhausted || report.status == Status::capacity_exhausted;
    ASSERT_EQ(shared.step(), report) << "at tick " << tick;
    ASSERT_EQ(shared.hash().total, alone.hash().total) << "after tick " << tick;
  }
  EXPECT_TRUE(exhausted);
}

TEST(WorldOnThreads, LeavesOutTheSameContacts) {
  for (const std::uint32_t capacity : {1U, 150U, 333U}) {
    ThreadPool pool(4);
    expect_same(make_crowd(4096, capacity), make_crowd(4096, capacity), pool);
    test::ShuffledRunner shuffled(7);
    expect_same(make_crowd(4096, capacity), make_crowd(4096, capacity), shuffled);
  }
}

TEST(WorldOnThreads, LeavesOutTheSamePairs) {
  for (const std::uint32_t capacity : {1U, 400U}) {
    ThreadPool pool(3);
    expect_same(make_crowd(capacity, 4096), make_crowd(capacity, 4096), pool);
    test::ShuffledRunner shuffled(64);
    expect_same(make_crowd(capacity, 4096), make_crowd(capacity, 4096), shuffled);
  }
}

TEST(WorldOnThreads, LeavesOutTheSameContactsWhereRoomIsShortUntilSeamsAreRemoved) {
  ThreadPool pool(4);
  expect_same(make_balls_beside_corners(60), make_balls_beside_corners(60), pool);
}

}  // namespace
}  // namespace lockstone
