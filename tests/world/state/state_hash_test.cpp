// The state's hash is kept up to date, and yet a function of the state alone.

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

// The hash of a world that never hashed before.
std::uint64_t fresh_hash(const World& world) {
  World fresh = test::make_world(world.def());
  EXPECT_EQ(fresh.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
  return fresh.hash().total;
}

// One of the commands that write a body.
Command random_command(test::Random& random, BodyHandle body) {
  const Velocity speed = Velocity::from_integer(random.between(-3, 3));
  switch (random.between(0, 7)) {
    case 0:
      return SetVelocity{body, {speed, speed, {}}};
    case 1:
      return SetAngularVelocity{body, {1_rps, {}, {}}};
    case 2:
      return ApplyImpulse{body, {Impulse::from_integer(random.between(-9, 9)), {}, {}}};
    case 3:
      return ApplyAngularImpulse{body, {{}, AngularImpulse::from_integer(1), {}}};
    case 4:
      return SetMaterial{body, {0.25_r, 0.5_r}};
    case 5:
      return SetUserData{body, random.next()};
    case 6:
      return SetFilter{body, {1, 0xffffffff, static_cast<std::int32_t>(body.index)}};
    default:
      return Teleport{body, {{}, 20_m, {}}, {}};
  }
}

TEST(StateHash, KeptFromTickToTickIsThatOfTheStateAlone) {
  test::Random random(test::run_seed());
  World world = test::make_world();
  test::fill_with_random_bodies(world, random.next(), 60);
  for (int tick = 0; tick < 120; ++tick) {
    for (int i = 0; i < 3; ++i) {
      const auto index = static_cast<std::uint32_t>(random.between(0, 60));
      const BodyHandle body = world.body_at(index);
      if (body.is_null()) continue;
      (void)world.apply(random_command(random, body));
      if (random.between(0, 9) == 0) (void)world.apply(DestroyBody{body});
    }
    if (tick % 20 == 0) (void)world.create_body({});
    ASSERT_EQ(world.hash().total, fresh_hash(world)) << "before tick " << tick;
    (void)world.step();
    ASSERT_EQ(world.hash().total, fresh_hash(world)) << "after tick " << tick;
  }
}

}  // namespace
}  // namespace lockstone
