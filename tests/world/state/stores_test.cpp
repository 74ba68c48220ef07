// One list of stores and fields: nothing of the state can be left out of snapshots, hashes,
// comparison or validation.

#include "core/world/state/stores.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "core/world/state/delta.h"
#include "core/world/state/record_fields.h"
#include "core/world/state/snapshot_format.h"
#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

// A record as it was, with one more field: this is all that is done for it.
struct GrownRecord {
  Vec3<Position> position{};
  std::uint32_t generation = 0;
  std::uint32_t added = 0;

  [[nodiscard]] std::uint32_t key() const { return generation; }
  friend bool operator==(const GrownRecord&, const GrownRecord&) = default;
};

template <class F>
constexpr void visit_fields(GrownRecord& record, F&& f) {
  visit_value("position", "", record.position, f);
  visit_value("generation", "", record.generation, f);
  visit_value("added", "", record.added, f);
}
static_assert(visited_bytes<GrownRecord>() == sizeof(GrownRecord), "a field is missing");

struct GrownStore {
  using Record = GrownRecord;
  static constexpr const char* k_name = "grown";
  static constexpr auto k_count = &WorldHeader::body_limit;
  static constexpr auto k_capacity = &WorldDef::body_capacity;
  static constexpr std::uint64_t k_domain = 9;
  static constexpr bool k_has_key = false;
};
struct KeyedStore : GrownStore {
  static constexpr auto k_count = &WorldHeader::contact_count;
  static constexpr auto k_capacity = &WorldDef::contact_capacity;
  static constexpr bool k_has_key = true;
};
using GrownStores = StoreList<GrownStore, KeyedStore>;

struct GrownState {
  WorldDef def;
  WorldHeader header{.body_limit = 3, .contact_count = 3};
  std::vector<GrownRecord> records{{{}, 1, 7}, {{}, 2, 7}, {{}, 3, 7}};
  std::vector<GrownRecord> keyed = records;

  template <class F>
  void visit(GrownStore, F&& f) const {
    f(std::span(records));
  }
  template <class F>
  void visit(KeyedStore, F&& f) const {
    f(std::span(keyed));
  }
};

Bytes native_of(const GrownState& state) {
  Bytes bytes(1000);
  bytes.resize(write_native<GrownStores>(state, bytes));
  return bytes;
}

Bytes canonical_of(const GrownState& state) {
  Bytes bytes(1000);
  ByteWriter writer(bytes);
  write_canonical<GrownStores>(state, writer);
  bytes.resize(writer.size());
  return bytes;
}

class AddedField : public ::testing::Test {
 protected:
  AddedField() {
    changed.records[1].added = 8;
    changed.keyed[1].added = 9;
  }
  GrownState state, changed;
};

TEST_F(AddedField, IsInNativeSnapshots) {
  EXPECT_NE(native_of(state), native_of(changed));
  const Bytes bytes = native_of(changed);
  const auto read = NativeState<GrownStores>::open(bytes, state.def);
  ASSERT_TRUE(read.ok());
  GrownRecord record;
  read.value().read<GrownStore>(1, record);
  EXPECT_EQ(record, changed.records[1]);
}

TEST_F(AddedField, IsInDeltas) {
  const Bytes base = native_of(state);
  Bytes delta(1000);
  delta.resize(write_delta<GrownStores>(changed, base, delta));
  EXPECT_EQ(delta.size(), sizeof(WorldHeader) + 2 * (1 + sizeof(GrownRecord)) + 4);
  auto read = DeltaState<GrownStores>::open(base, delta, state.def);
  ASSERT_TRUE(read.ok());
  GrownRecord record;
  for (std::uint32_t i = 0; i < 3; ++i) {
    read.value().read<GrownStore>(i, record);
    EXPECT_EQ(record, changed.records[i]);
    read.value().read<KeyedStore>(i, record);
    EXPECT_EQ(record, changed.keyed[i]);
  }
}

TEST_F(AddedField, IsInCanonicalSnapshots) {
  const Bytes bytes = canonical_of(changed);
  EXPECT_NE(canonical_of(state), bytes);
  const StoredRecords<GrownStores> records(changed.header,
                                           ByteView(bytes).subspan(sizeof(WorldHeader)));
  EXPECT_EQ(records.decoded<GrownStore>(1), changed.records[1]);
  EXPECT_EQ(records.decoded<KeyedStore>(1), changed.keyed[1]);
}

TEST_F(AddedField, IsHashed) {
  const GrownRecord &a = state.records[1], &b = changed.records[1];
  EXPECT_NE(hash_record(a, 1), hash_record(b, 1));
  EXPECT_NE(hash_record128(a, 1), hash_record128(b, 1));
}

TEST_F(AddedField, IsComparedAndNamed) {
  const StateDifference found = compare("grown", 1, state.records[1], changed.records[1]);
  EXPECT_EQ(found.to_line(), "grown 1, added: 0x00000007 here, 0x00000008 there");
}

TEST_F(AddedField, CanBeFlipped) {
  EXPECT_TRUE(flip_in(state.records[1], "added", 3));
  EXPECT_EQ(state.records[1].added, 15U);
  EXPECT_FALSE(flip_in(state.records[1], "added", 32));
  EXPECT_FALSE(flip_in(state.records[1], "add", 0));
}

// Bodies that move, bodies that sleep, contacts of both, joints.
World full_world() {
  World world = test::make_world(
      {.body_capacity = 64, .pair_capacity = 512, .contact_capacity = 256, .joint_capacity = 4});
  test::fill_with_random_bodies(world, 7, 20);
  test::step(world, 400);
  for (int i = 0; i < 3; ++i)
    test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 10_m, Position::from_integer(i), {}));
  const JointDef joint = JointDef::of(JointKind::ball, world.body_at(21), world.body_at(22));
  EXPECT_TRUE(world.create_joint(joint).ok());
  test::step(world, 30);
  return world;
}

// Calls `f(store, object, field, bits)` for every field of some records of each store.
template <class F>
void for_each_field(const World& world, F&& f) {
  const auto visit = [&](const char* store, std::uint32_t object, auto record) {
    visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
      f(store, object, std::string(name) + suffix, 8 * sizeof(integer));
    });
  };
  visit("world", 0, WorldHeader{});
  const std::uint32_t contacts =
      static_cast<std::uint32_t>(world.record_hashes(StateStore::contacts, {}));
  EXPECT_GT(contacts, 20U);
  for (const std::uint32_t body : {0U, 9U, 22U})
    visit("body", body, BodyRecord{});
  for (const std::uint32_t contact : {0U, contacts / 2, contacts - 1})
    visit("contact", contact, ContactRecord{});
  visit("joint", 0, JointRecord{});
}

bool is_count(const std::string& field) {
  return field.ends_with("_limit") || field.ends_with("_count");
}

// A contact with another key stands elsewhere.
bool is_key(const std::string& field) {
  return field == "body_a" || field == "body_b" || field == "part_a" || field == "part_b";
}

// Flips the lowest and the highest bit of every field, one at a time, and calls `check(world,
// store, object, field)` with the spoiled world, which is loaded again afterwards.
template <class Check>
void for_each_flip(const Check& check) {
  const World world = full_world();
  const Bytes native = test::save(world, SnapshotKind::native);
  World other = full_world();
  int flips = 0;
  for_each_field(world, [&](const char* store, std::uint32_t object, const std::string& field,
                            std::size_t bits) {
    for (const unsigned bit : {0U, static_cast<unsigned>(bits - 1)}) {
      SCOPED_TRACE(store + (' ' + std::to_string(object)) + ' ' + field);
      ASSERT_TRUE(other.flip_bit(store, object, field, bit));
      check(other, store, object, field);
      ASSERT_EQ(other.load(SnapshotKind::native, native), Status::ok);
      ++flips;
    }
  });
  EXPECT_GT(flips, 500);
}

TEST(FlippedBit, ChangesTheHash) {
  const World world = full_world();
  for_each_flip([&](const World& other, const char*, std::uint32_t, const std::string& field) {
    EXPECT_NE(other.hash().total, world.hash().total);
    if (!is_count(field)) {
      EXPECT_NE(other.hash128().total, world.hash128().total);
    }
  });
}

TEST(FlippedBit, IsSavedAndNamed) {
  const World world = full_world();
  const Bytes good = test::save(world, SnapshotKind::canonical);
  for_each_flip(
      [&](const World& other, const char* store, std::uint32_t object, const std::string& field) {
        if (is_count(field) || is_key(field)) return;
        const StateDifference found =
            world.describe_difference(good, test::save(other, SnapshotKind::canonical));
        EXPECT_EQ(found.store, store);
        EXPECT_EQ(found.field, field);
        EXPECT_EQ(found.object, object);
      });
}

TEST(FlippedBit, IsGoneAfterALoad) {
  World plain = full_world(), other = full_world();
  const Bytes native = test::save(plain, SnapshotKind::native);
  for_each_field(
      plain, [&](const char* store, std::uint32_t object, const std::string& field, std::size_t) {
        ASSERT_TRUE(other.flip_bit(store, object, field, 0));
        ASSERT_EQ(other.load(SnapshotKind::native, native), Status::ok);
        ASSERT_EQ(other.hash().total, plain.hash().total) << store << ' ' << field;
      });
  test::step(other, 30);
  test::step(plain, 30);
  EXPECT_EQ(other.hash().total, plain.hash().total);
}

TEST(FlippedBit, NeedsAPlaceThatIsThere) {
  World world = full_world();
  EXPECT_FALSE(world.flip_bit("body", 1000, "position.x", 0));
  EXPECT_FALSE(world.flip_bit("body", 0, "position", 0));
  EXPECT_FALSE(world.flip_bit("body", 0, "position.x", 64));
  EXPECT_FALSE(world.flip_bit("contact", 1U << 20, "mean_impulse", 0));
  EXPECT_FALSE(world.flip_bit("wheel", 0, "position.x", 0));
}

// Any value will do: they are the user's, or mean nothing by themselves.
bool is_free(const std::string& field) {
  // clang-format off
  static const std::set<std::string> k_free{
      "tick", "user_data", "category", "mask", "group", "tag", "rest_ticks", "still_ticks", "loose_time", "union_a", "union_b", "union_c"};
  // clang-format on
  return k_free.contains(field.substr(0, field.find('.')));
}

// The field's bytes in canonical form begin at `offset`.
bool is_ever_refused(World& world, const Bytes& good, std::size_t offset, std::size_t bytes) {
  for (const int value : {0x00, 0x7f, 0x80, 0xff}) {
    Bytes forged = good;
    for (std::size_t i = 0; i < bytes; ++i)
      forged[offset + i] = static_cast<std::byte>(value == 0x80 && i + 1 < bytes ? 0 : value);
    const std::span<std::byte> all(forged);
    ByteWriter(all.last(8)).put(hash64(all.first(all.size() - 8)));
    if (world.load(SnapshotKind::canonical, forged) != Status::ok) return true;
  }
  return false;
}

TEST(Validation, KnowsABadValueForEachFieldThatHasOne) {
  const World world = full_world();
  const Bytes good = test::save(world, SnapshotKind::canonical);
  World other = full_world();
  std::size_t offset = k_snapshot_front_bytes;
  const auto check = [&](auto record) {
    visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
      const std::string field = std::string(name) + suffix;
      EXPECT_TRUE(is_free(field) || is_ever_refused(other, good, offset, sizeof(integer))) << field;
      offset += sizeof(integer);
    });
  };
  check(WorldHeader{});
  offset += 21 * sizeof(BodyRecord);
  check(BodyRecord{});  // the first of those with joints
}

TEST(RecordHashes, AreTheTermsOfTheStoresHash) {
  const World world = full_world();
  const StateHash hash = world.hash();
  const auto sum = [&](StateStore store) {
    std::vector<std::uint64_t> hashes(world.record_hashes(store, {}));
    EXPECT_EQ(world.record_hashes(store, hashes), hashes.size());
    std::uint64_t total = 0;
    for (const std::uint64_t one : hashes)
      total += one;
    return total;
  };
  EXPECT_EQ(sum(StateStore::bodies), hash.bodies);
  EXPECT_EQ(sum(StateStore::contacts), hash.contacts);
  EXPECT_EQ(sum(StateStore::joints), hash.joints);
}

TEST(Hash128, IsOfTheStateAlone) {
  const World world = full_world();
  World other = test::make_world(world.def());
  ASSERT_EQ(other.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
  EXPECT_EQ(other.hash128(), world.hash128());
  (void)other.step();
  EXPECT_NE(other.hash128().bodies, world.hash128().bodies);
}

}  // namespace
}  // namespace lockstone
