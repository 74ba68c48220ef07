// No allocation after creation: a program of its own, whose operator new counts.
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tests/tools/arena/arena_match.h"

namespace {

bool g_counting = false;
int g_allocations = 0;

void* allocate(std::size_t bytes) {
  if (g_counting) ++g_allocations;
  void* memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) std::abort();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocate(bytes);
}
void* operator new[](std::size_t bytes) {
  return allocate(bytes);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace lockstone::arena::test {
namespace {

TEST(ArenaMemory, IsNotAllocatedAfterCreation) {
  ArenaSimulation simulation({.seed = 1, .loose_bodies = 216, .players = 8});
  std::vector<std::byte> native(simulation.snapshot_bytes_max(SnapshotKind::native));
  std::vector<std::byte> canonical(simulation.snapshot_bytes_max(SnapshotKind::canonical));
  std::uint64_t hashes = 0;
  g_counting = true;
  for (int tick = 0; tick < 300; ++tick) {
    step_with_bots(simulation);
    hashes ^= simulation.hash();
    const std::size_t native_bytes = simulation.save(SnapshotKind::native, native);
    const std::size_t canonical_bytes = simulation.save(SnapshotKind::canonical, canonical);
    if (simulation.load(SnapshotKind::native, ByteView(native).first(native_bytes)) != Status::ok ||
        simulation.load(SnapshotKind::canonical, ByteView(canonical).first(canonical_bytes)) !=
            Status::ok) {
      break;
    }
  }
  g_counting = false;
  EXPECT_EQ(g_allocations, 0);
  EXPECT_EQ(simulation.tick(), 300U);
  EXPECT_NE(hashes, 0U);
}

TEST(ArenaMemory, CountsAreCounted) {
  g_allocations = 0;
  g_counting = true;
  std::vector<int> numbers(10);
  g_counting = false;
  EXPECT_EQ(g_allocations, 1);
  EXPECT_EQ(numbers.size(), 10U);
}

}  // namespace
}  // namespace lockstone::arena::test
