// Rays and casts through a pile that comes to rest: as many a tick as a large match asks for.
#include <array>
#include <span>
#include <vector>

#include <lockstone/hash.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using arena::Random;
using scenes::millimetres;

constexpr int k_rays = 4096;
constexpr int k_casts = 512;
constexpr int k_half_mm = 15'000;

World make_storm(BroadPhaseKind broad_phase) {
  World world = k_mixed.make(broad_phase);
  BodyDef notes = scenes::fixed_box({{}, -100_m, {}}, {0.1_m, 0.1_m, 0.1_m});
  notes.user_data = 1;
  scenes::add(world, notes);
  return world;
}

Vec3<Position> random_place(Random& random) {
  const Position x = millimetres(random.between(-k_half_mm, k_half_mm));
  const Position y = millimetres(random.between(0, k_half_mm));
  return {x, y, millimetres(random.between(-k_half_mm, k_half_mm))};
}

Vec3<Length> random_way(Random& random) {
  const Mat3 turn = to_matrix(scenes::random_orientation(random));
  return saturated<Length>(rotate(turn, Vec3<Position>{20_m, {}, {}}));
}

// Sums of all answers, so that a wrong answer changes the final hash.
template <class Hit>
std::uint64_t digest(std::span<const Hit> hits) {
  std::uint64_t sum = 0;
  for (const Hit& hit : hits)
    sum = arena::mix(sum ^ (std::uint64_t{hit.body.index} << 32) ^
                     static_cast<std::uint32_t>(hit.fraction.raw));
  return sum;
}

std::uint64_t cast_rays(const World& world, Random& random) {
  std::vector<Ray> rays(k_rays);
  for (Ray& ray : rays) {
    ray.origin = random_place(random);
    ray.translation = random_way(random);
  }
  std::vector<RayHit> hits(rays.size());
  world.cast_rays(rays, hits);
  return digest<RayHit>(hits);
}

std::uint64_t cast_shapes(const World& world, Random& random) {
  const std::array<Shape, 3> shapes{Shape::sphere(0.3_m), Shape::capsule(0.4_m, 0.2_m),
                                    Shape::box(0.3_m, 0.2_m, 0.4_m)};
  std::vector<ShapeCast> casts(k_casts);
  for (std::size_t i = 0; i < casts.size(); ++i) {
    casts[i].shape = shapes[i % shapes.size()];
    casts[i].start.position = random_place(random);
    casts[i].start.orientation = scenes::random_orientation(random);
    casts[i].translation = random_way(random);
  }
  std::vector<ShapeHit> hits(casts.size());
  world.cast_shapes(casts, hits);
  return digest<ShapeHit>(hits);
}

// The last body that was made notes the answers.
void ask(World& world) {
  const BodyHandle notes = world.body_at(world.body_limit() - 1);
  Random random(arena::mix(world.tick()));
  const std::uint64_t rays = cast_rays(world, random);
  const std::uint64_t casts = cast_shapes(world, random);
  const std::uint64_t before = world.body(notes).user_data;
  scenes::order(world, SetUserData{notes, arena::mix(before ^ rays ^ arena::mix(casts))});
}

}  // namespace

constinit const SpeedScene k_storm{
    "storm", "4,096 rays and 512 casts a tick through a pile of 3,200 bodies", 200, make_storm, ask,
    true};

}  // namespace lockstone::bench
