// Level ground of 6 m by 6 m and more, of triangles.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <lockstone/height_field.h>
#include <lockstone/literals.h>
#include <lockstone/mesh.h>

#include "tests/world/world_fixture.h"

namespace lockstone::test {

inline AssetPtr flat_mesh() {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  constexpr int k_cells = 12;
  for (int x = 0; x <= k_cells; ++x)
    for (int z = 0; z <= k_cells; ++z)
      vertices.push_back(
          {Length::from_ratio(x * 5 - 30, 10), {}, Length::from_ratio(z * 5 - 30, 10)});
  const auto at = [](int x, int z) { return static_cast<std::uint32_t>(x * (k_cells + 1) + z); };
  for (int x = 0; x < k_cells; ++x) {
    for (int z = 0; z < k_cells; ++z) {
      triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z)});
      triangles.push_back({at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)});
    }
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

inline AssetPtr level_field() {
  const std::vector<Length> heights(13 * 13);
  HeightFieldDef def;
  def.columns = def.rows = 13;
  def.heights = heights;
  return HeightField::build(def).height_field;
}

/// A world whose ground, around the origin, is a mesh or a height field. Nothing sleeps.
inline World world_on_triangles(bool mesh) {
  using namespace literals;
  const AssetPtr asset = mesh ? flat_mesh() : level_field();
  const WorldDef def{.body_capacity = 64, .sleep_ms = 0};
  World world = make_world(def, std::make_shared<AssetSet>(std::vector{asset}));
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = asset->shape();
  if (!mesh) ground.position = {-6_m, {}, -6_m};
  add(world, ground);
  return world;
}

}  // namespace lockstone::test
