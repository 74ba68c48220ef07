// A program that uses spheres and boxes alone.
#include <lockstone/literals.h>
#include <lockstone/world.h>

using namespace lockstone;
using namespace lockstone::literals;

int main() {
  Result<World> world = World::create({.body_capacity = 8});
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::box(9_m, 1_m, 9_m);
  BodyDef ball;
  ball.position = {{}, 3_m, {}};
  if (!world.value().create_body(ground).ok() || !world.value().create_body(ball).ok()) return 1;
  for (int tick = 0; tick < 60; ++tick)
    (void)world.value().step();
  return world.value().hash().total == 0 ? 1 : 0;
}
