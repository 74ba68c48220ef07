// No allocation after creation: every way to ask for memory is counted here.

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <lockstone/thread_pool.h>

#include "tests/world/world_fixture.h"

namespace {

std::atomic<std::size_t> g_allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace lockstone {
namespace {

using namespace literals;

void expect_no_allocation(BroadPhaseKind broad_phase, TaskRunner* runner = nullptr) {
  World world = test::make_world({.body_capacity = 512,
                                  .pair_capacity = 8192,
                                  .contact_capacity = 4096,
                                  .broad_phase = broad_phase});
  test::fill_with_random_bodies(world, 1, 150);
  world.set_task_runner(runner, TaskPieces::smallest);
  std::vector<std::byte> native(world.snapshot_bytes_max(SnapshotKind::native));
  std::vector<std::byte> canonical(world.snapshot_bytes_max(SnapshotKind::canonical));
  std::array<BodyHandle, 8> found{};
  const std::size_t before = g_allocations;
  for (int tick = 0; tick < 120; ++tick) {
    (void)world.step();
    (void)world.hash();
    const std::size_t size = world.save(SnapshotKind::native, native);
    const std::size_t canonical_size = world.save(SnapshotKind::canonical, canonical);
    ASSERT_EQ(world.load(SnapshotKind::canonical, ByteView(canonical).first(canonical_size)),
              Status::ok);
    ASSERT_EQ(world.load(SnapshotKind::native, ByteView(native).first(size)), Status::ok);
    (void)world.cast_ray({{}, 5_m, {}}, {{}, -10_m, {}});
    (void)world.overlap_sphere({}, 3_m, found);
    const BodyHandle extra = world.create_body({}).value();
    ASSERT_EQ(world.set_name(extra, "extra"), Status::ok);
    ASSERT_EQ(world.apply(DestroyBody{extra}), Status::ok);
    DebugDraw nothing;
    world.draw(nothing, {true, true, true, true, true});
    ASSERT_FALSE(world.find_fault());
  }
  EXPECT_EQ(g_allocations, before);
}

TEST(World, AllocatesNothingAfterCreation) {
  expect_no_allocation(BroadPhaseKind::tree);
  expect_no_allocation(BroadPhaseKind::sweep_and_prune);
}

TEST(World, AllocatesNothingOnThreads) {
  ThreadPool pool(4);
  expect_no_allocation(BroadPhaseKind::tree, &pool);
}

TEST(AllocationCounter, CountsAnAllocation) {
  const std::size_t before = g_allocations;
  ::operator delete(::operator new(1));
  EXPECT_GT(g_allocations, before);
}

}  // namespace
}  // namespace lockstone
