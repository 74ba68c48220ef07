// Bodies of all kinds that tumble over one mesh of 100,352 triangles.
#include <vector>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/assets.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr std::uint32_t k_cells = 224;  // each way
constexpr int k_cell_mm = 1600;
constexpr int k_half_mm = static_cast<int>(k_cells) * k_cell_mm / 2;

// Ridges of 16 m in both directions.
int height_mm(std::uint32_t x, std::uint32_t z) {
  const auto ridge = [](std::uint32_t i) {
    const auto at = static_cast<int>(i % 64);
    return at < 32 ? at : 64 - at;
  };
  return 240 * ridge(x) + 260 * ridge(z + x / 3);
}

AssetPtr make_mesh() {
  constexpr std::uint32_t k_row = k_cells + 1;
  arena::Random random(3);
  std::vector<scenes::Point> vertices;
  std::vector<TriangleIndices> triangles;
  for (std::uint32_t i = 0; i < k_row * k_row; ++i) {
    const std::uint32_t x = i % k_row, z = i / k_row;
    const auto place = [](std::uint32_t n) {
      return arena::millimetres_long(static_cast<int>(n) * k_cell_mm - k_half_mm);
    };
    const int bump_mm = random.between(0, 300);
    vertices.push_back({place(x), arena::millimetres_long(height_mm(x, z) + bump_mm), place(z)});
    if (x == k_cells || z == k_cells) continue;
    triangles.push_back({i, i + k_row, i + 1});
    triangles.push_back({i + 1, i + k_row, i + k_row + 1});
  }
  const MeshResult mesh = Mesh::build({vertices, triangles, {}, {}, {}});
  LKS_CHECK(mesh.ok() && mesh.mesh->triangle_count() == 2 * k_cells * k_cells);
  return mesh.mesh;
}

World make_terrain(BroadPhaseKind broad_phase) {
  constexpr int k_side = 60, k_spacing_mm = 2500;
  arena::Random random(5);
  const AssetPtr mesh = make_mesh();
  const AssetPtr rock = scenes::random_hull(random, {0.4_m, 0.35_m, 0.45_m}, 20);
  World world = make_speed_world(speed_def(broad_phase, 4096, 65'536, 32'768), {mesh, rock});
  scenes::add(world, scenes::fixed(mesh->shape(), {}));
  for (int i = 0; i < k_side * k_side; ++i) {
    const auto place = [&](int n) { return millimetres((2 * n + 1 - k_side) * k_spacing_mm / 2); };
    const Shape shape = i % 4 == 0 ? rock->shape() : scenes::random_shape(random);
    BodyDef body = scenes::loose(shape, {place(i % k_side), 18_m, place(i / k_side)});
    body.orientation = scenes::random_orientation(random);
    scenes::add(world, body);
  }
  return world;
}

}  // namespace

constinit const SpeedScene k_terrain{
    "terrain", "3,600 mixed bodies tumble over a mesh of 100,352 triangles", 400, make_terrain};

}  // namespace lockstone::bench
