// Canonical snapshots: a valid world, or a typed error and the old world untouched.

#include <lockstone/assert.h>
#include <lockstone/hash.h>

#include "core/world/state/snapshot_format.h"
#include "tests/fuzz/target.h"
#include "tests/world/world_fixture.h"

namespace lockstone::fuzz {
namespace {

using namespace literals;

constexpr WorldDef k_def{
    .body_capacity = 32, .pair_capacity = 512, .contact_capacity = 256, .joint_capacity = 8};

World sample_world() {
  World world = test::make_world(k_def);
  test::fill_with_random_bodies(world, 7, 16);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto kind = static_cast<JointKind>(i % 2 + 1);
    const JointDef def = JointDef::of(kind, world.body_at(1 + i), world.body_at(2 + i));
    LKS_CHECK(world.create_joint(def).ok());
  }
  BodyDef trigger;
  trigger.motion = MotionType::static_body;
  trigger.is_trigger = true;
  trigger.shape = Shape::sphere(2_m);
  (void)test::add(world, trigger);
  return world;
}

std::vector<Bytes> seeds() {
  World world = sample_world();
  std::vector<Bytes> all{test::save(world, SnapshotKind::canonical)};
  test::step(world, 40);
  all.push_back(test::save(world, SnapshotKind::canonical));
  test::step(world, 200);  // most sleep
  all.push_back(test::save(world, SnapshotKind::canonical));
  return all;
}

void mend(Bytes& bytes) {
  if (bytes.size() < k_snapshot_frame_bytes) return;
  ByteWriter head(bytes);
  head.put(k_snapshot_magic);
  head.put(k_snapshot_version);
  head.put<std::uint16_t>(0);
  head.put(config_hash(k_def));
  const std::span<std::byte> all(bytes);
  ByteWriter(all.last(8)).put(hash64(all.first(all.size() - 8)));
}

// An accepted state saves as it was, and its later states can be loaded again.
void use(World& world, ByteView bytes) {
  const Bytes same = test::save(world, SnapshotKind::canonical);
  LKS_CHECK(std::equal(same.begin(), same.end(), bytes.begin(), bytes.end()));
  test::step(world, 8);
  const Bytes later = test::save(world, SnapshotKind::canonical);
  World copy = test::make_world(k_def);
  LKS_CHECK(copy.load(SnapshotKind::canonical, later) == Status::ok);
  LKS_CHECK(copy.hash().total == world.hash().total);
}

bool run(ByteView bytes) {
  static World world = sample_world();
  static const Bytes good = test::save(world, SnapshotKind::canonical);
  static const std::uint64_t before = world.hash().total;
  if (world.load(SnapshotKind::canonical, bytes) != Status::ok) {
    LKS_CHECK(world.hash().total == before);
    return false;
  }
  use(world, bytes);
  LKS_CHECK(world.load(SnapshotKind::canonical, good) == Status::ok);
  return true;
}

const Registration k_registration{{.name = "snapshot", .seeds = seeds, .mend = mend, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
