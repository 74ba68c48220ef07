// The whole state is saved and hashed, and nothing else is.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/world/state/world_header.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

World busy_world(std::uint64_t seed, BroadPhaseKind broad_phase = BroadPhaseKind::tree) {
  World world = test::make_world({.body_capacity = 512, .broad_phase = broad_phase});
  test::fill_with_random_bodies(world, seed, 80);
  test::step(world, 90);
  return world;
}

TEST(Snapshot, LoadedGivesTheSameFuture) {
  for (const SnapshotKind kind : {SnapshotKind::native, SnapshotKind::canonical}) {
    World world = busy_world(test::run_seed());
    World copy = test::make_world();
    ASSERT_EQ(copy.load(kind, test::save(world, kind)), Status::ok);
    for (int tick = 0; tick < 120; ++tick) {
      ASSERT_EQ(copy.hash().total, world.hash().total) << "tick " << tick;
      (void)world.step();
      (void)copy.step();
    }
  }
}

// Steps leave components of an orientation a unit in the last place beyond 1.
TEST(Snapshot, TakesAnOrientationAsStepsLeaveIt) {
  World world = test::make_world();
  ASSERT_TRUE(world.create_body(BodyDef{}).ok());
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::native);
  const std::array<std::int32_t, 4> identity{0, 0, 0, 1 << 30};
  // The native kind is taken as it is.
  const auto fault_with = [&](std::int32_t w) {
    std::vector<std::byte> changed = saved;
    const std::array<std::int32_t, 4> orientation{0, 0, 0, w};
    for (std::size_t i = 0; i + sizeof identity <= saved.size(); ++i)
      if (std::memcmp(saved.data() + i, identity.data(), sizeof identity) == 0)
        std::memcpy(changed.data() + i, orientation.data(), sizeof orientation);
    EXPECT_EQ(world.load(SnapshotKind::native, changed), Status::ok);
    return world.find_fault().what != nullptr;
  };
  EXPECT_FALSE(fault_with((1 << 30) + 1));
  EXPECT_FALSE(fault_with(-(1 << 30) - 1));
  EXPECT_TRUE(fault_with((1 << 30) + (1 << 12)));
}

TEST(Snapshot, SavingAndLoadingEveryTickChangesNothing) {
  World plain = busy_world(test::run_seed() + 1);
  World heavy = test::make_world();
  ASSERT_EQ(heavy.load(SnapshotKind::canonical, test::save(plain, SnapshotKind::canonical)),
            Status::ok);
  for (int tick = 0; tick < 60; ++tick) {
    World fresh = test::make_world();
    ASSERT_EQ(fresh.load(SnapshotKind::canonical, test::save(heavy, SnapshotKind::canonical)),
              Status::ok);
    (void)fresh.step();
    (void)plain.step();
    ASSERT_EQ(fresh.hash().total, plain.hash().total) << "tick " << tick;
    heavy = std::move(fresh);
  }
}

class DropDerived : public ::testing::TestWithParam<BroadPhaseKind> {};

TEST_P(DropDerived, EveryTickChangesNothing) {
  World plain = busy_world(test::run_seed() + 2);
  World heavy = busy_world(test::run_seed() + 2, GetParam());
  for (int tick = 0; tick < 120; ++tick) {
    heavy.drop_derived();
    (void)heavy.step();
    (void)plain.step();
    ASSERT_EQ(heavy.hash().total, plain.hash().total) << "tick " << tick;
  }
}

INSTANTIATE_TEST_SUITE_P(BroadPhases, DropDerived,
                         ::testing::Values(BroadPhaseKind::tree, BroadPhaseKind::sweep_and_prune));

TEST(Snapshot, LoadOverwritesAWorldThatHadMoreBodies) {
  World small = test::make_world();
  test::add_ground(small);
  World large = busy_world(test::run_seed());
  ASSERT_EQ(large.load(SnapshotKind::native, test::save(small, SnapshotKind::native)), Status::ok);
  EXPECT_EQ(large.hash().total, small.hash().total);
  EXPECT_EQ(test::add(large, {}), test::add(small, {}));
  (void)large.step();
  (void)small.step();
  EXPECT_EQ(large.hash().total, small.hash().total);
}

// Flips the lowest bit of each integer of the record at `offset` in turn; calls `check(bytes,
// field)`.
template <class Record, class Check>
void flip_each_field(const std::vector<std::byte>& saved, std::size_t offset, Check&& check) {
  Record record;
  std::memcpy(&record, saved.data() + offset, sizeof(record));
  visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
    const std::string field = std::string(name) + suffix;
    if (field == "shape_kind" || field == "body_limit" || field == "contact_count" ||
        field == "joint_limit" || field == "fluid_limit" || field == "pair_rule_count" ||
        field == "surface_rule_count" || field == "vehicle_count" ||
        field == "terrain_tile_count") {
      return;
    }
    const auto original = integer;
    integer = static_cast<std::remove_reference_t<decltype(integer)>>(integer ^ 1);
    std::vector<std::byte> flipped = saved;
    std::memcpy(flipped.data() + offset, &record, sizeof(record));
    integer = original;
    check(flipped, field);
  });
}

bool is_of_key(std::string_view field) {
  return field == "body_a" || field == "body_b" || field == "part_a" || field == "part_b";
}

TEST(Hash, ChangesWithEveryFieldOfState) {
  const World world = busy_world(test::run_seed());
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::native);
  const std::vector<std::byte> here = test::save(world, SnapshotKind::canonical);
  const std::uint64_t expected = world.hash().total;
  World other = test::make_world();
  int checked = 0;
  const auto check = [&](const std::vector<std::byte>& flipped, const std::string& field) {
    ASSERT_EQ(other.load(SnapshotKind::native, flipped), Status::ok);
    ASSERT_NE(other.hash().total, expected) << field;
    const StateDifference found =
        world.describe_difference(here, test::save(other, SnapshotKind::canonical));
    // Another key changes the order of the records: the first that differs may do so elsewhere in
    // it.
    ASSERT_TRUE(found.field == field || (is_of_key(field) && is_of_key(found.field)))
        << found.field << " for " << field;
    ++checked;
  };
  flip_each_field<WorldHeader>(saved, 0, check);
  for (std::uint32_t i = 0; i < world.body_limit(); i += 7) {
    flip_each_field<BodyRecord>(saved, sizeof(WorldHeader) + i * sizeof(BodyRecord), check);
  }
  const std::size_t contacts = sizeof(WorldHeader) + world.body_limit() * sizeof(BodyRecord);
  ASSERT_GT(saved.size(), contacts + 20 * sizeof(ContactRecord));
  for (std::size_t i = 0; i < 20; ++i) {
    flip_each_field<ContactRecord>(saved, contacts + i * sizeof(ContactRecord), check);
  }
  EXPECT_GT(checked, 800);
}

TEST(CanonicalSnapshot, RefusesEveryTruncation) {
  World world = test::make_world();
  test::add_ground(world);
  test::add(world, {});
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  const std::uint64_t before = world.hash().total;
  for (std::size_t size = 0; size < saved.size(); ++size) {
    EXPECT_EQ(world.load(SnapshotKind::canonical, ByteView(saved).first(size)), Status::truncated);
  }
  EXPECT_EQ(world.hash().total, before);
}

TEST(CanonicalSnapshot, RefusesEveryFlippedBit) {
  World world = test::make_world();
  test::add_ground(world);
  test::add(world, {});
  (void)world.step();
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  const std::uint64_t before = world.hash().total;
  for (std::size_t bit = 0; bit < saved.size() * 8; ++bit) {
    std::vector<std::byte> damaged = saved;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    ASSERT_NE(world.load(SnapshotKind::canonical, damaged), Status::ok) << "bit " << bit;
  }
  EXPECT_EQ(world.hash().total, before);
}

TEST(CanonicalSnapshot, RefusesAnotherConfiguration) {
  World world = test::make_world();
  WorldDef def = world.def();
  def.substeps = 8;
  World other = test::make_world(def);
  EXPECT_EQ(other.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::incompatible);
}

TEST(CanonicalSnapshot, WithARightChecksumButImpossibleValuesIsRefused) {
  // Overwrites every byte in turn (with sanitizers one of three: the first, middle and last bytes
  // of fields take turns) with 0xff and checksums again; an accepted state must be steppable.
  constexpr std::size_t k_stride = LKS_SANITIZED ? 3 : 1;
  World world = test::make_world();
  test::add_ground(world);
  test::add(world, {});
  (void)world.step();
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 8 < saved.size(); at += k_stride) {
    std::vector<std::byte> forged = saved;
    forged[at] = std::byte{0xff};
    const std::uint64_t hash = hash64(ByteView(forged).first(forged.size() - 8));
    for (std::size_t i = 0; i < 8; ++i)
      forged[forged.size() - 8 + i] = static_cast<std::byte>(hash >> (8 * i));
    World target = test::make_world();
    if (target.load(SnapshotKind::canonical, forged) == Status::ok) {
      test::step(target, 2);
    } else {
      ++refused;
      EXPECT_EQ(target.body_count(), 0U);
    }
  }
  EXPECT_GT(refused, 100 / k_stride);
}

TEST(DescribeDifference, NamesTheBodyAndTheFieldOfOneFlippedBit) {
  const World world = busy_world(test::run_seed());
  const std::vector<std::byte> native = test::save(world, SnapshotKind::native);
  const std::vector<std::byte> here = test::save(world, SnapshotKind::canonical);
  World other = test::make_world();
  constexpr std::size_t k_header = sizeof(WorldHeader);
  const auto flipped_at = [&](std::size_t offset) {
    std::vector<std::byte> flipped = native;
    flipped[offset] ^= std::byte{1};
    EXPECT_EQ(other.load(SnapshotKind::native, flipped), Status::ok);
    return world.describe_difference(here, test::save(other, SnapshotKind::canonical));
  };
  const StateDifference velocity =
      flipped_at(k_header + 17 * sizeof(BodyRecord) + offsetof(BodyRecord, velocity) + 8);
  EXPECT_EQ(velocity.store, "body");
  EXPECT_EQ(velocity.object, 17U);
  EXPECT_EQ(velocity.field, "velocity.y");
  const std::size_t contacts = k_header + world.body_limit() * sizeof(BodyRecord);
  const StateDifference impulse =
      flipped_at(contacts + 3 * sizeof(ContactRecord) + offsetof(ContactRecord, points) + 4);
  EXPECT_EQ(impulse.store, "contact");
  EXPECT_EQ(impulse.object, 3U);
  EXPECT_EQ(impulse.field, "point[0].normal_impulse");
  EXPECT_FALSE(world.describe_difference(here, here).differs);
  EXPECT_EQ(world.describe_difference(here, here).to_line(), "no difference");
}

TEST(NativeSnapshot, IsAsSmallAsPromised) {
  EXPECT_LE(sizeof(BodyRecord), 256U);
  EXPECT_LE(sizeof(ContactRecord), 96U);
}

TEST(Canary, IsTheSameTwice) {
  EXPECT_EQ(canary_hash(), canary_hash());
}

}  // namespace
}  // namespace lockstone
