// Worlds whose bodies change by chance, the same in each tick: saved and loaded, and rolled back.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include <lockstone/rollback_history.h>

#include "tests/world/world_fixture.h"

namespace lockstone::test {

/// Saved at any tick and loaded elsewhere: the same future. `Shaken` has a `world` and
/// `shake(tick)`.
template <class Shaken>
void expect_goes_on_from_snapshots() {
  Shaken one, other;
  for (int tick = 0; tick < 120; ++tick) {
    one.shake(tick);
    const SnapshotKind kind = tick % 2 == 0 ? SnapshotKind::native : SnapshotKind::canonical;
    ASSERT_EQ(other.world.load(kind, save(one.world, kind)), Status::ok) << tick;
    ASSERT_FALSE(other.world.find_fault());
    (void)one.world.step();
    (void)other.world.step();
    ASSERT_EQ(one.world.hash().total, other.world.hash().total) << tick;
  }
}

/// Four ticks back in every ninth, with another switch of group 2 first, by `set(group, is_on)`.
template <class Shaken>
void expect_is_rolled_back() {
  Shaken plain, rolled;
  RollbackHistory history(rolled.world, 8);
  std::vector<std::vector<std::byte>> saved;
  for (int tick = 0; tick < 120; ++tick) {
    plain.shake(tick);
    (void)plain.world.step();
    saved.push_back(save(rolled.world, SnapshotKind::native));
    rolled.shake(tick);
    (void)history.step();
    if (tick % 9 == 8) {
      const std::vector<std::byte>& back = saved[saved.size() - 4];
      ASSERT_EQ(rolled.world.load(SnapshotKind::native, back), Status::ok);
      ASSERT_EQ(rolled.set(2, tick % 2 == 0), Status::ok);
      for (int again = 0; again < 4; ++again)
        (void)history.step();
      ASSERT_EQ(rolled.world.load(SnapshotKind::native, back), Status::ok);
      for (int again = tick - 3; again <= tick; ++again) {
        rolled.shake(again);
        (void)history.step();
      }
    }
    ASSERT_EQ(plain.world.hash().total, rolled.world.hash().total) << tick;
  }
}

}  // namespace lockstone::test
