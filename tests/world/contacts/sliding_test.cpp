// Sliding without friction over thousands of triangles that lie in one plane: no edge between them
// is felt. On a ridge that is there, it is.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include <gtest/gtest.h>

#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/testing/floating.h>

#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

constexpr int k_samples = 73;  // 72 × 72 cells: 10368 triangles
constexpr int k_cell_mm = 1000;
constexpr int k_settle_ticks = 12;
constexpr int k_slide_ticks = 120;
constexpr int k_headings = test::share_of(16);

/// Grid points, the middle one at the origin; raised by `ridge` along the line that is 3 m from it.
std::vector<Vec3<Length>> grid_points(Length ridge) {
  std::vector<Vec3<Length>> points;
  for (int j = 0; j < k_samples; ++j) {
    for (int i = 0; i < k_samples; ++i) {
      const int column = i - k_samples / 2, row = j - k_samples / 2;
      points.push_back({Length::from_ratio(column * k_cell_mm, 1000),
                        column == 3 ? ridge : Length{}, Length::from_ratio(row * k_cell_mm, 1000)});
    }
  }
  return points;
}

// The diagonals alternate, so that edges of many directions meet.
AssetPtr grid_mesh(Length ridge = {}) {
  std::vector<TriangleIndices> triangles;
  for (std::uint32_t j = 0; j + 1 < k_samples; ++j) {
    for (std::uint32_t i = 0; i + 1 < k_samples; ++i) {
      const std::uint32_t a = j * k_samples + i, b = a + k_samples, c = b + 1, d = a + 1;
      if ((i + j) % 2 == 0) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  const std::vector<Vec3<Length>> points = grid_points(ridge);
  MeshDef def;
  def.vertices = points;
  def.triangles = triangles;
  const MeshResult made = Mesh::build(def);
  EXPECT_TRUE(made.ok());
  EXPECT_GE(made.mesh->triangle_count(), 10000U);
  return made.mesh;
}

AssetPtr flat_field() {
  const std::vector<Length> heights(std::size_t{k_samples} * k_samples);
  HeightFieldDef def;
  def.columns = def.rows = k_samples;
  def.cell_x = def.cell_z = Length::from_ratio(k_cell_mm, 1000);
  def.origin = {Length::from_ratio(-k_cell_mm * (k_samples / 2), 1000),
                {},
                Length::from_ratio(-k_cell_mm * (k_samples / 2), 1000)};
  def.heights = heights;
  const HeightFieldResult made = HeightField::build(def);
  EXPECT_TRUE(made.ok());
  return made.height_field;
}

// A brick with its edges cut, which lies on a face of 0.3 m × 0.2 m.
AssetPtr brick() {
  std::vector<Vec3<Length>> points;
  for (const int x : {-1, 1}) {
    for (const int z : {-1, 1}) {
      for (const int y : {-1, 1}) {
        points.push_back({Length::from_ratio(3 * x, 10), Length::from_ratio(2 * y, 10),
                          Length::from_ratio(2 * z, 10)});
        points.push_back({Length::from_ratio(4 * x, 10), {}, Length::from_ratio(3 * z, 10)});
      }
    }
  }
  return Hull::build(points).hull;
}

enum class Slider { ball, capsule, box, hull };
constexpr std::array k_sliders{Slider::ball, Slider::capsule, Slider::box, Slider::hull};

struct Track {
  AssetPtr surface;
  Quat orientation{};  ///< of the surface; gravity is square to it
};

/// How a slide differed from a straight one at constant speed.
struct Deviation {
  double height = 0;  ///< m, greatest
  double aside = 0;   ///< m, at the end
  double speed = 0;   ///< relative, at the end
};

std::array<double, 3> vector_of(const auto& v) {
  return {testing::to_double(v.x), testing::to_double(v.y), testing::to_double(v.z)};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A direction of the surface's frame in the world.
std::array<double, 3> axis(const Track& track, int which) {
  return vector_of(to_matrix(track.orientation).column(which));
}

template <class T>
Vec3<T> along(const std::array<double, 3>& direction, double amount) {
  const auto part = [&](double share) {
    return T::from_raw(std::llround(share * amount * 4294967296.0));
  };
  return {part(direction[0]), part(direction[1]), part(direction[2])};
}

World make_track(const Track& track, const AssetPtr& hull) {
  WorldDef def{.body_capacity = 128, .pair_capacity = 1024, .contact_capacity = 1024};
  def.gravity = along<Acceleration>(axis(track, 1), -9.81);
  World world = test::make_world(
      def, std::make_shared<const AssetSet>(std::vector<AssetPtr>{track.surface, hull}));
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = track.surface->shape();
  ground.orientation = track.orientation;
  ground.material.friction = {};
  test::add(world, ground);
  return world;
}

BodyDef slider_body(Slider kind, const AssetPtr& hull, const Track& track) {
  BodyDef def;
  def.material.friction = {};
  def.filter.group = -1;  // sliders do not meet each other
  def.orientation = track.orientation;
  double height = 0.25;
  if (kind == Slider::ball) def.shape = Shape::sphere(0.25_m);
  if (kind == Slider::box) def.shape = Shape::box(0.4_m, 0.25_m, 0.3_m);
  if (kind == Slider::hull) {
    def.shape = hull->shape();
    height = 0.2;
  }
  if (kind == Slider::capsule) {
    def.shape = Shape::capsule(0.4_m, 0.25_m);
    def.orientation = multiply(track.orientation, from_axis_angle({{}, {}, 1_r}, 1.5707963_rad));
  }
  def.position = along<Position>(axis(track, 1), height);
  return def;
}

/// One slider in flight over the track.
struct Run {
  BodyHandle body;
  std::array<double, 3> heading;
  std::array<double, 3> start{};
  Deviation deviation{};
};

std::array<double, 3> heading_of(const Track& track, int i) {
  const double angle = 2 * std::numbers::pi * (i + 0.13) / k_headings;
  const auto x = axis(track, 0), z = axis(track, 2);
  std::array<double, 3> heading;
  for (std::size_t k = 0; k < 3; ++k)
    heading[k] = x[k] * std::cos(angle) + z[k] * std::sin(angle);
  return heading;
}

std::vector<Run> settle(World& world, const Track& track, Slider kind, const AssetPtr& hull) {
  std::vector<Run> runs;
  for (int i = 0; i < k_headings; ++i) {
    BodyDef def = slider_body(kind, hull, track);
    // Each from another place of a cell.
    const auto offset = along<Position>(axis(track, 0), 0.061 * i - 0.4);
    def.position = def.position + offset;
    runs.push_back({test::add(world, def), heading_of(track, i)});
  }
  test::step(world, k_settle_ticks);
  return runs;
}

void observe(const World& world, const Track& track, Run& run) {
  const auto at = vector_of(world.position(run.body));
  const double height = dot(at, axis(track, 1)) - dot(run.start, axis(track, 1));
  run.deviation.height = std::max(run.deviation.height, std::abs(height));
}

Deviation finish(const World& world, const Track& track, const Run& run, double speed) {
  Deviation deviation = run.deviation;
  const auto at = vector_of(world.position(run.body));
  const auto velocity = vector_of(world.velocity(run.body));
  std::array<double, 3> way;
  for (std::size_t k = 0; k < 3; ++k)
    way[k] = at[k] - run.start[k];
  const auto up = axis(track, 1);
  const std::array<double, 3> aside{up[1] * run.heading[2] - up[2] * run.heading[1],
                                    up[2] * run.heading[0] - up[0] * run.heading[2],
                                    up[0] * run.heading[1] - up[1] * run.heading[0]};
  deviation.aside = std::abs(dot(way, aside));
  deviation.speed = std::abs(dot(velocity, run.heading) / speed - 1);
  return deviation;
}

void include(Deviation& worst, const Deviation& other) {
  worst.height = std::max(worst.height, other.height);
  worst.aside = std::max(worst.aside, other.aside);
  worst.speed = std::max(worst.speed, other.speed);
}

/// The worst of all headings at one speed.
Deviation slide(const Track& track, Slider kind, double speed) {
  const AssetPtr hull = brick();
  World world = make_track(track, hull);
  std::vector<Run> runs = settle(world, track, kind, hull);
  for (Run& run : runs) {
    run.start = vector_of(world.position(run.body));
    EXPECT_EQ(world.apply(SetVelocity{run.body, along<Velocity>(run.heading, speed)}), Status::ok);
    EXPECT_EQ(world.apply(SetAngularVelocity{run.body, {}}), Status::ok);
  }
  for (int tick = 0; tick < k_slide_ticks; ++tick) {
    EXPECT_EQ(world.step().status, Status::ok);
    for (Run& run : runs)
      observe(world, track, run);
  }
  Deviation worst;
  for (const Run& run : runs)
    include(worst, finish(world, track, run, speed));
  return worst;
}

const char* name_of(Slider kind) {
  constexpr std::array k_names{"ball", "capsule", "box", "hull"};
  return k_names[static_cast<std::size_t>(kind)];
}

void expect_smooth(const Track& track, std::initializer_list<double> speeds) {
  for (const Slider kind : k_sliders) {
    for (const double speed : speeds) {
      const Deviation worst = slide(track, kind, speed);
      EXPECT_LT(worst.height, 1e-3) << name_of(kind) << " at " << speed << " m/s";
      EXPECT_LT(worst.aside, 1e-3) << name_of(kind) << " at " << speed << " m/s";
      EXPECT_LT(worst.speed, 1e-4) << name_of(kind) << " at " << speed << " m/s";
    }
  }
}

TEST(Sliding, FeelsNoEdgeOfAFlatMesh) {
  expect_smooth({grid_mesh()}, {0.5, 3, 15});
}

TEST(Sliding, FeelsNoEdgeOfAFlatHeightField) {
  expect_smooth({flat_field()}, {1, 15});
}

TEST(Sliding, FeelsNoEdgeOfAMeshThatIsTurnedInSpace) {
  expect_smooth({grid_mesh(), normalized({0.3_r, -0.5_r, 0.2_r, 0.7_r})}, {7});
}

// The control: a fold of 1 cm throws fast bodies up, and slows slow ones.
TEST(Sliding, FeelsARidgeOfOneCentimetre) {
  const Track track{grid_mesh(0.01_m)};
  for (const Slider kind : k_sliders)
    EXPECT_GT(slide(track, kind, 5).height, 5e-3) << name_of(kind);
}

}  // namespace
}  // namespace lockstone
