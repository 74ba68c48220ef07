// A game that shows its world: `watched` prints an address for `lockstone studio --world`, plays in
// real time for TICKS ticks, 3600 without the argument, and prints the hash after each.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <lockstone/hull.h>
#include <lockstone/watch/world_server.h>
#include <lockstone/world.h>

namespace {

using namespace lockstone;

std::shared_ptr<const Hull> wedge() {
  std::vector<Vec3<Length>> points;
  for (const int z : {-1, 1})
    for (const auto& [x, y] : {std::pair{-1, 0}, {1, 0}, {-1, 1}})
      points.push_back(
          {Length::from_ratio(x, 2), Length::from_ratio(y, 2), Length::from_ratio(z, 2)});
  return Hull::build(points).hull;
}

World make_world() {
  const std::shared_ptr<const Hull> hull = wedge();
  const auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{hull});
  WorldDef def;
  def.body_capacity = 64;
  World world = World::create(def, assets).value();
  BodyDef body;
  body.motion = MotionType::static_body;
  body.shape = Shape::half_space();
  (void)world.create_body(body);
  body.motion = MotionType::dynamic;
  for (int i = 0; i < 40; ++i) {
    const Length half = Length::from_ratio(2, 5);
    body.shape = i % 2 == 0 ? Shape::box(half, half, half) : hull->shape();
    body.position = {Position::from_ratio(i % 3, 4), Position::from_integer(1 + i),
                     Position::from_ratio(i % 5, 5)};
    (void)world.create_body(body);
  }
  return world;
}

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 3600;
  World world = make_world();
  std::string problem;
  auto server = watch::WorldServer::open(0, &problem);
  if (!server) {
    std::fprintf(stderr, "watched: %s\n", problem.c_str());
    return 1;
  }
  std::printf("%s\n", server.value()->address().c_str());
  std::fflush(stdout);
  const auto began = std::chrono::steady_clock::now();
  for (long tick = 1; tick <= ticks; ++tick) {
    world.step();
    const auto due = std::chrono::microseconds(1'000'000 * tick / world.def().tick_rate);
    server.value()->update(world, due.count());
    std::printf("tick %ld %016llx\n", tick, static_cast<unsigned long long>(world.hash().total));
    std::fflush(stdout);
    std::this_thread::sleep_until(began + due);
  }
  return 0;
}
