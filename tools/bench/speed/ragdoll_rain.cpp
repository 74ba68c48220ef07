// Ragdolls that fall on a grid of meshes, a row of them every 48 ticks; from the tenth row on the
// oldest go. After Box3D's benchmark "rain" (Erin Catto, shared/benchmarks.c): its places, meshes
// and numbers, with the ragdolls of our own scene, or with figures of its proportions.
#include <vector>

#include "tools/bench/speed/figure.h"
#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/assets.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr int k_cells = 10;  // each way
constexpr int k_cell_mm = 15'000;
constexpr int k_group = 3;             // ragdolls at one place
constexpr std::uint64_t k_every = 48;  // ticks

struct MeshParts {
  std::vector<scenes::Point> vertices;
  std::vector<TriangleIndices> triangles;

  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
};

// A flat floor of 8 × 8 squares.
void add_floor(MeshParts& parts) {
  constexpr std::uint32_t k_squares = 8, k_row = k_squares + 1;
  const auto first = static_cast<std::uint32_t>(parts.vertices.size());
  const auto place = [](std::uint32_t i) {
    return arena::millimetres_long(static_cast<int>(i) * k_cell_mm / 8 - k_cell_mm / 2);
  };
  for (std::uint32_t i = 0; i < k_row * k_row; ++i)
    parts.vertices.push_back({place(i % k_row), {}, place(i / k_row)});
  for (std::uint32_t i = 0; i < k_squares * k_row; ++i) {
    if (i % k_row == k_squares) continue;
    const std::uint32_t at = first + i;
    parts.add_quad(at, at + k_row, at + k_row + 1, at + 1);
  }
}

Mat3 turn_about(const Vec3<Unit>& axis, int step, int steps) {
  return to_matrix(
      from_axis_angle(axis, Angle::from_ratio(6'283'185LL * step, 1'000'000LL * steps)));
}

// A ring about the y axis, half of it above the floor.
void add_torus(MeshParts& parts) {
  constexpr int k_steps = 16;
  const auto first = static_cast<std::uint32_t>(parts.vertices.size());
  for (int i = 0; i < k_steps; ++i) {
    const Mat3 along = turn_about(scenes::k_y_axis, i, k_steps);
    for (int j = 0; j < k_steps; ++j) {
      const Mat3 about = turn_about(scenes::k_z_axis, j, k_steps);
      const Vec3<Position> place = rotate(about, Vec3<Position>{1_m, {}, {}}) +
                                   Vec3<Position>{millimetres(k_cell_mm / 4), {}, {}};
      parts.vertices.push_back(saturated<Length>(rotate(along, place)));
    }
  }
  const auto at = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(i % k_steps * k_steps + j % k_steps);
  };
  for (int i = 0; i < k_steps; ++i) {
    for (int j = 0; j < k_steps; ++j)
      parts.add_quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  }
}

AssetPtr make_cell() {
  MeshParts parts;
  add_floor(parts);
  add_torus(parts);
  const MeshResult cell = Mesh::build({parts.vertices, parts.triangles, {}, {}, {}});
  LKS_CHECK(cell.ok());
  return cell.mesh;
}

Position middle_of(int cell) {
  return millimetres((2 * cell + 1 - k_cells) * k_cell_mm / 2);
}

World make_ragdoll_rain(BroadPhaseKind broad_phase) {
  const AssetPtr cell = make_cell();
  WorldDef def = speed_def(broad_phase, 8192, 65'536, 32'768);
  def.joint_capacity = 4096;
  World world = make_speed_world(def, {cell});
  for (int i = 0; i < k_cells * k_cells; ++i) {
    scenes::add(world,
                scenes::fixed(cell->shape(), {middle_of(i / k_cells), {}, middle_of(i % k_cells)}));
  }
  return world;
}

// Every body of a ragdoll tells its column.
void remove_column(World& world, std::uint64_t column) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (!body.is_null() && world.body(body).user_data == column + 1)
      scenes::order(world, DestroyBody{body});
  }
}

using AddOne = void(World&, const Vec3<Position>&, std::uint64_t);

void add_column(World& world, std::uint64_t column, AddOne& add) {
  for (int i = 0; i < k_cells * k_group; ++i) {
    const Position aside = millimetres(i % k_group * 750);
    add(world, {middle_of(static_cast<int>(column)) + aside, 20_m, middle_of(i / k_group)},
        column + 1);
  }
}

void rain(World& world, AddOne& add) {
  if (world.tick() % k_every != 0) return;
  const std::uint64_t column = world.tick() / k_every % k_cells;
  remove_column(world, column);
  add_column(world, column, add);
}

void rain_ragdolls(World& world) {
  rain(world, scenes::add_ragdoll);
}

void rain_figures(World& world) {
  rain(world, add_figure);
}

}  // namespace

constinit const SpeedScene k_ragdoll_rain{"ragdoll-rain",
                                          "300 ragdolls fall on 100 meshes of floor and ring", 1000,
                                          make_ragdoll_rain, rain_ragdolls};
constinit const SpeedScene k_figure_rain{
    "figure-rain", "300 figures of 14 bodies fall on 100 meshes of floor and ring", 1000,
    make_ragdoll_rain, rain_figures};

}  // namespace lockstone::bench
