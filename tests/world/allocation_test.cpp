// No allocation after creation: every way to ask for memory is counted here.

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>
#include <lockstone/predicted_events.h>
#include <lockstone/radial_impulse.h>
#include <lockstone/rollback_history.h>
#include <lockstone/thread_pool.h>

#include "core/geometry/assets/asset_frame.h"
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
  std::array<BodyContact, 8> contacts{};
  std::array<JointHandle, 8> joints{};
  std::array<ApplyImpulse, 8> pushes{};
  PredictedEvents heard;
  const std::size_t before = g_allocations;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    ASSERT_EQ(world.apply(SetEvents{world.body_at(i), {true, SolverVelocity::from_ratio(1, 2)}}),
              Status::ok);
  std::size_t hits = 0;
  for (int tick = 0; tick < 120; ++tick) {
    (void)world.step();
    hits += hit_events(world).size();
    heard.begin_tick(world.tick());
    for (const HitEvent& hit : hit_events(world))
      (void)heard.add(name_of(hit));
    (void)heard.end_tick();
    heard.confirm(world.tick());
    (void)contacts_of(world, world.body_at(1), contacts);
    (void)joints_of(world, world.body_at(1), joints);
    (void)radial_impulse(world, {}, pushes);
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
  EXPECT_GT(hits, 10U);
}

TEST(RollbackHistory, AllocatesNothingAfterCreation) {
  World world =
      test::make_world({.body_capacity = 512, .pair_capacity = 8192, .contact_capacity = 4096});
  test::fill_with_random_bodies(world, 1, 150);
  RollbackHistory history(world, 4);
  std::vector<std::byte> start(world.snapshot_bytes_max(SnapshotKind::native));
  const std::size_t before = g_allocations;
  std::uint64_t recalled = 0;
  for (std::uint32_t round = 0; round < 60; ++round) {
    const std::size_t size = world.save(SnapshotKind::native, start);
    for (int tick = 0; tick < 4; ++tick)
      (void)history.step();
    ASSERT_EQ(world.load(SnapshotKind::native, ByteView(start).first(size)), Status::ok);
    (void)world.apply(SetVelocity{world.body_at(1 + round), {{}, 3_mps, {}}});
    for (int tick = 0; tick < 2; ++tick)
      recalled += history.step().recalled_islands;
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_GT(recalled, 0U);
}

TEST(World, AllocatesNothingAfterCreation) {
  expect_no_allocation(BroadPhaseKind::tree);
  expect_no_allocation(BroadPhaseKind::sweep_and_prune);
}

TEST(World, AllocatesNothingOnThreads) {
  ThreadPool pool(4);
  expect_no_allocation(BroadPhaseKind::tree, &pool);
}

// Bytes that end behind the counts say how many records would follow.
void expect_truncated_without_allocation(World& world, SnapshotKind kind, std::size_t size) {
  const std::vector<std::byte> whole = test::save(world, kind);
  ASSERT_LT(size, whole.size());
  const std::size_t before = g_allocations;
  EXPECT_EQ(world.load(kind, ByteView(whole).first(size)), Status::truncated);
  EXPECT_EQ(g_allocations, before) << to_string(kind);
}

TEST(World, AllocatesNothingForTinySnapshotsThatClaimMuch) {
  World world = test::make_world();
  const std::size_t empty = test::save(world, SnapshotKind::native).size();
  const std::size_t empty_canonical = test::save(world, SnapshotKind::canonical).size();
  test::fill_with_random_bodies(world, 1, 100);
  expect_truncated_without_allocation(world, SnapshotKind::native, empty);
  expect_truncated_without_allocation(world, SnapshotKind::canonical, empty_canonical);
}

// A head that claims as much as its kind may hold, and nothing behind it.
class TinyAsset {
 public:
  TinyAsset(ShapeKind kind, std::uint16_t version) {
    geometry::put_asset_header(writer_, kind, version);
  }
  template <class... T>
  Status load_with(T... counts) {
    (writer_.put(counts), ...);
    const std::size_t before = g_allocations;
    const Status status = load_asset(writer_.written()).status();
    EXPECT_EQ(g_allocations, before);
    return status;
  }

 private:
  std::array<std::byte, 64> bytes_{};
  ByteWriter writer_{bytes_};
};

TEST(LoadAsset, AllocatesNothingForTinyFilesThatClaimMuch) {
  using U8 = std::uint8_t;
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  constexpr auto side = static_cast<U16>(k_max_height_field_samples);
  EXPECT_EQ(TinyAsset(ShapeKind::hull, 1).load_with(U32{0}, U16{k_max_hull_vertices}),
            Status::truncated);
  EXPECT_EQ(
      TinyAsset(ShapeKind::mesh, 2)
          .load_with(U32{0}, k_max_mesh_vertices, k_max_mesh_triangles, U16{k_max_surfaces}, U8{1}),
      Status::truncated);
  EXPECT_EQ(TinyAsset(ShapeKind::height_field, 2)
                .load_with(U32{0}, U32{0}, U32{0}, U32{0}, U32{0}, side, side, U16{k_max_surfaces},
                           U8{3}),
            Status::truncated);
  EXPECT_EQ(TinyAsset(ShapeKind::compound, 2).load_with(U32{k_max_compound_children}),
            Status::truncated);
}

TEST(AllocationCounter, CountsAnAllocation) {
  const std::size_t before = g_allocations;
  ::operator delete(::operator new(1));
  EXPECT_GT(g_allocations, before);
}

}  // namespace
}  // namespace lockstone
