#include "tools/bench/queries/query_scene.h"

#include <array>
#include <span>

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
// function here; what needs an asset takes it from the scene.
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

Vec3<Position> random_place(Random& random, Position half_width) {
  const Position x = random_coordinate(random, half_width);
  const Position y = random_coordinate(random, half_width);
  return {x, y, random_coordinate(random, half_width)};
}

// The edge of the cube with room for all bodies, halved.
Position half_width_for(std::uint32_t bodies) {
  int half_dm = 10;  // decimetres, so that the cube of the whole edge is a small number
  while (std::int64_t{8} * half_dm * half_dm * half_dm <
         std::int64_t{1000} * k_body_space_m3 * bodies)
    ++half_dm;
  return Position::from_ratio(half_dm, 10);
}

Vec3<Length> random_translation(Random& random, int metres) {
  const Mat3 turn = to_matrix(scenes::random_orientation(random));
  return saturated<Length>(rotate(turn, Vec3<Position>{Position::from_integer(metres), {}, {}}));
}

// Makes rows of `count` questions.
class RowMaker {
 public:
  RowMaker(const QueryScene& scene, const World& world, std::size_t count, std::uint64_t seed)
      : scene_(scene), world_(world), count_(count), random_(arena::mix(seed ^ 0x71)) {}

  QueryRow rays(std::string_view name, QueryKind kind, int metres) {
    QueryRow row{name, kind, {}, {}, {}, {}};
    while (row.rays.size() < count_) {
      const Vec3<Position> origin = random_place(random_, scene_.half_width);
      const Vec3<Length> translation = random_translation(random_, metres);
      std::array<BodyHandle, 1> holds{};
      if (world_.bodies_at(origin, holds) == 0) row.rays.push_back({origin, translation});
    }
    return row;
  }

  QueryRow points(std::string_view name, QueryKind kind, Length reach) {
    QueryRow row{name, kind, {}, {}, {}, reach};
    for (std::size_t i = 0; i < count_; ++i)
      row.rays.push_back({random_place(random_, scene_.half_width), {}});
    return row;
  }

  QueryRow overlaps(std::string_view name, const Shape& shape) {
    QueryRow row{name, QueryKind::overlap, {}, shape, {}, {}};
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3<Position> place = random_place(random_, scene_.half_width);
      row.poses.push_back({place, scenes::random_orientation(random_)});
    }
    return row;
  }

 private:
  const QueryScene& scene_;
  const World& world_;
  std::size_t count_;
  Random random_;
};

}  // namespace

QueryScene make_query_scene(std::uint32_t bodies, std::uint64_t seed) {
  QueryScene scene;
  scene.half_width = half_width_for(bodies);
  Random random(arena::mix(seed));
  for (std::uint32_t i = 0; i < bodies; ++i) {
    QueryBody body;
    body.is_static = i % 5 < 2;
    const std::uint32_t kind = random.below(k_kinds.size());
    body.shape = k_kinds[kind](random, body.is_static ? 2 : 1);
    body.pose.position = random_place(random, scene.half_width);
    body.pose.orientation = scenes::random_orientation(random);
    scene.bodies.push_back(body);
  }
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

std::vector<QueryRow> make_query_rows(const QueryScene& scene, const World& world,
                                      std::size_t count, std::uint64_t seed) {
  RowMaker make(scene, world, count, seed);
  std::vector<QueryRow> rows;
  rows.push_back(make.rays("ray closest 5 m", QueryKind::closest_ray, 5));
  rows.push_back(make.rays("ray closest 100 m", QueryKind::closest_ray, 100));
  rows.push_back(make.rays("ray any 5 m", QueryKind::blocked_ray, 5));
  rows.push_back(make.rays("ray any 100 m", QueryKind::blocked_ray, 100));
  rows.push_back(make.rays("ray all 5 m", QueryKind::all_rays, 5));
  rows.push_back(make.rays("ray all 100 m", QueryKind::all_rays, 100));
  rows.push_back(make.overlaps("overlap sphere 0.5 m", Shape::sphere(0.5_m)));
  rows.push_back(make.overlaps("overlap sphere 4 m", Shape::sphere(4_m)));
  rows.push_back(make.overlaps("overlap box 1 m", Shape::box(0.5_m, 0.5_m, 0.5_m)));
  rows.push_back(make.points("point", QueryKind::point, {}));
  rows.push_back(make.points("near point 10 m", QueryKind::near_point, 10_m));
  return rows;
}

}  // namespace lockstone::bench
