#include <array>

#include "tools/bench/queries/query_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using arena::Random;

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

  QueryRow casts(std::string_view name, const Shape& shape, int metres) {
    QueryRow row{name, QueryKind::closest_cast, {}, shape, {}, {}};
    while (row.poses.size() < count_) {
      const Vec3<Position> place = random_place(random_, scene_.half_width);
      const Transform start{place, scenes::random_orientation(random_)};
      const Vec3<Length> translation = random_translation(random_, metres);
      std::array<BodyHandle, 1> touched{};
      if (world_.overlap_shape(shape, start, touched) != 0) continue;
      row.poses.push_back(start);
      row.rays.push_back({place, translation});
    }
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
  rows.push_back(make.casts("cast sphere 5 m", Shape::sphere(0.25_m), 5));
  rows.push_back(make.casts("cast sphere 100 m", Shape::sphere(0.25_m), 100));
  rows.push_back(make.casts("cast capsule 20 m", Shape::capsule(0.5_m, 0.3_m), 20));
  rows.push_back(make.casts("cast box 20 m", Shape::box(0.4_m, 0.2_m, 0.3_m), 20));
  rows.push_back(make.overlaps("overlap sphere 0.5 m", Shape::sphere(0.5_m)));
  rows.push_back(make.overlaps("overlap sphere 4 m", Shape::sphere(4_m)));
  rows.push_back(make.overlaps("overlap box 1 m", Shape::box(0.5_m, 0.5_m, 0.5_m)));
  rows.push_back(make.points("point", QueryKind::point, {}));
  rows.push_back(make.points("near point 10 m", QueryKind::near_point, 10_m));
  return rows;
}

}  // namespace lockstone::bench
