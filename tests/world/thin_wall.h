// A law of continuous collision: no shape passes a thin wall.
#pragma once

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone::test {

/// 8 cm to 50 cm.
inline Length bullet_size(Random& random) {
  return Length::from_raw(static_cast<std::int32_t>(random.between(1 << 14, 1 << 17)));
}

/// Throws turning bodies of random shapes at a wall of one centimetre, or twice another half
/// extent, at 20 m/s to 400 m/s.
inline void expect_none_passes_a_thin_wall(Shape (*random_shape)(Random& random),
                                           Length half = Length::from_ratio(1, 200)) {
  using namespace literals;
  Random random(run_seed());
  for (int run = 0; run < share_of(600); ++run) {
    World world = make_world({.body_capacity = 16, .gravity = {}});
    BodyDef wall;
    wall.motion = MotionType::static_body;
    wall.shape = Shape::box(half, 20_m, 20_m);
    add(world, wall);
    BodyDef def = dynamic_body(random_shape(random), {}, {}, {});
    def.position.x.raw =
        -random.between(std::int64_t{1} << 30, std::int64_t{20} << 32) - (std::int64_t{1} << 31);
    def.velocity.x.raw = random.between(std::int64_t{20} << 32, std::int64_t{400} << 32);
    def.velocity.y.raw = random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    for (int axis = 0; axis < 3; ++axis)
      def.angular_velocity[axis].raw =
          random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    const BodyHandle bullet = add(world, def);
    for (int tick = 0; tick < 30; ++tick) {
      step(world, 1);
      const BodyView view = world.body(bullet);
      if (metres(abs(view.position.y)) > 19 || metres(abs(view.position.z)) > 19) break;
      ASSERT_LT(metres(view.position.x), 0.0) << "run " << run << " tick " << tick;
    }
  }
}

}  // namespace lockstone::test
