#include "tools/bench/queries/query_scene.h"

#include <array>
#include <utility>

#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using arena::Random;

constexpr std::uint32_t k_body_space_m3 = 16;  // for each body

Length random_length(Random& random, int low_mm, int high_mm) {
  return arena::millimetres_long(random.between(low_mm, high_mm));
}

// The kinds of bodies; `scale` 1 for loose ones, larger for static ones. One more kind is one more
// function here; a kind that needs an asset takes it from the scene.
using ShapeMaker = Shape (*)(Random& random, int scale);

Shape make_sphere(Random& random, int scale) {
  return Shape::sphere(random_length(random, 200 * scale, 500 * scale));
}

Shape make_capsule(Random& random, int scale) {
  const Length half_height = random_length(random, 200 * scale, 500 * scale);
  return Shape::capsule(half_height, random_length(random, 100 * scale, 300 * scale));
}

Shape make_box(Random& random, int scale) {
  const Length x = random_length(random, 150 * scale, 450 * scale);
  const Length y = random_length(random, 150 * scale, 450 * scale);
  return Shape::box(x, y, random_length(random, 150 * scale, 450 * scale));
}

constexpr std::array<ShapeMaker, 3> k_kinds{make_sphere, make_capsule, make_box};

Position random_coordinate(Random& random, Position half_width) {
  const auto reach = static_cast<std::int32_t>(half_width.raw >> 20);
  return Position::from_raw(std::int64_t{random.between(-reach, reach)} << 20);
}

// The edge of the cube with room for all bodies, halved.
Position half_width_for(std::uint32_t bodies) {
  int half_dm = 10;  // decimetres, so that the cube of the whole edge is a small number
  while (std::int64_t{8} * half_dm * half_dm * half_dm <
         std::int64_t{1000} * k_body_space_m3 * bodies)
    ++half_dm;
  return Position::from_ratio(half_dm, 10);
}

constexpr std::uint32_t k_rocks = 32;  // every second is large, for static bodies

// A rock: the hull of random points on an ellipsoid.
std::shared_ptr<const Hull> make_rock(Random& random, int scale) {
  const int points = random.between(8, 32);
  Vec3<Length> size;
  for (int i = 0; i < 3; ++i)
    size[i] = random_length(random, 200 * scale, 500 * scale);
  std::vector<Vec3<Length>> cloud;
  for (int i = 0; i < points; ++i) {
    const Vec3<Unit> way = to_matrix(scenes::random_orientation(random)).x;
    cloud.push_back({rounded<Length>(size.x * way.x), rounded<Length>(size.y * way.y),
                     rounded<Length>(size.z * way.z)});
  }
  const HullResult rock = Hull::build(cloud);
  LKS_CHECK(rock.ok());
  return rock.hull;
}

void add_rocks(QueryScene& scene, Random& random) {
  for (std::uint32_t i = 0; i < k_rocks; ++i)
    scene.hulls.push_back(make_rock(random, i % 2 == 0 ? 1 : 2));
}

QueryBody make_body(const QueryScene& scene, Random& random, bool is_static) {
  QueryBody body;
  body.is_static = is_static;
  const auto rock = static_cast<std::uint32_t>(k_kinds.size());
  const std::uint32_t kind = random.below(scene.hulls.empty() ? rock : rock + 1);
  if (kind == rock) {
    const std::uint32_t pick = 2 * random.below(k_rocks / 2) + (is_static ? 1 : 0);
    body.shape = scene.hulls[pick]->shape();
  } else {
    body.shape = k_kinds[kind](random, is_static ? 2 : 1);
  }
  body.pose.position = random_place(random, scene.half_width);
  body.pose.orientation = scenes::random_orientation(random);
  return body;
}

// A terrain over the whole cube, about half way up: hills, and bumps of single vertices.
void add_terrain(QueryScene& scene, Random& random) {
  constexpr std::uint32_t k_cells = 224;                 // a side
  const std::int64_t half = scene.half_width.raw >> 12;  // as a Length counts
  for (std::uint32_t z = 0; z <= k_cells; ++z) {
    for (std::uint32_t x = 0; x <= k_cells; ++x) {
      const auto place = [&](std::uint32_t i) {
        return Length::from_raw(static_cast<std::int32_t>(half * (2 * i) / k_cells - half));
      };
      const int hill = static_cast<int>((x * x / 16 + z * 5 + (x ^ z) / 8) % 64);
      const int high_mm = 40 * (hill < 32 ? hill : 64 - hill) + random.between(0, 100);
      scene.terrain_vertices.push_back({place(x), arena::millimetres_long(high_mm), place(z)});
    }
  }
  constexpr std::uint32_t k_row = k_cells + 1;
  for (std::uint32_t i = 0; i < k_cells * k_row; ++i) {
    if (i % k_row == k_cells) continue;
    scene.terrain.push_back({i, i + k_row, i + 1});
    scene.terrain.push_back({i + 1, i + k_row, i + k_row + 1});
  }
}

void gather_assets(QueryScene& scene) {
  std::vector<AssetPtr> assets(scene.hulls.begin(), scene.hulls.end());
  if (!scene.terrain.empty()) {
    const MeshResult mesh = Mesh::build({scene.terrain_vertices, scene.terrain, {}, {}, {}});
    LKS_CHECK(mesh.ok());
    assets.push_back(mesh.mesh);
    scene.bodies.push_back({mesh.mesh->shape(), {}, true});
  }
  if (!assets.empty()) scene.assets = std::make_shared<const AssetSet>(std::move(assets));
}

}  // namespace

Vec3<Position> random_place(Random& random, Position half_width) {
  const Position x = random_coordinate(random, half_width);
  const Position y = random_coordinate(random, half_width);
  return {x, y, random_coordinate(random, half_width)};
}

QueryScene make_query_scene(QueryWorld kind, std::uint32_t bodies, std::uint64_t seed) {
  QueryScene scene;
  scene.half_width = half_width_for(bodies);
  Random random(arena::mix(seed));
  if (kind == QueryWorld::hulls) add_rocks(scene, random);
  for (std::uint32_t i = 0; i < bodies; ++i)
    scene.bodies.push_back(make_body(scene, random, i % 5 < 2));
  if (kind == QueryWorld::mesh) add_terrain(scene, random);
  gather_assets(scene);
  return scene;
}

World make_query_world(const QueryScene& scene, BroadPhaseKind broad_phase) {
  WorldDef def;
  def.broad_phase = broad_phase;
  def.body_capacity = static_cast<std::uint32_t>(scene.bodies.size());
  Result<World> made = World::create(def, scene.assets);
  LKS_CHECK(made.ok());
  World world = std::move(made.value());
  for (const QueryBody& body : scene.bodies) {
    BodyDef body_def = scenes::loose(body.shape, body.pose.position);
    if (body.is_static) body_def.motion = MotionType::static_body;
    body_def.orientation = body.pose.orientation;
    scenes::add(world, body_def);
  }
  world.drop_derived();  // as after a step or a load: the trees are built at once
  return world;
}

}  // namespace lockstone::bench
