// One small asset of each kind.
#pragma once

#include <array>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/mesh.h>

namespace lockstone::test {

using namespace literals;

inline std::shared_ptr<const Hull> sample_hull() {
  constexpr std::array<Vec3<Length>, 5> points{Vec3<Length>{0_m, 0_m, 0_m},
                                               {2_m, 0_m, 0_m},
                                               {0_m, 1_m, 0_m},
                                               {0_m, 0_m, 3_m},
                                               {1_m, 1_m, 1_m}};
  return Hull::build(points).hull;
}

inline AssetPtr sample_mesh() {
  constexpr std::array<Vec3<Length>, 5> vertices{Vec3<Length>{0_m, 0_m, 0_m},
                                                 {0_m, 0_m, 1_m},
                                                 {1_m, 0_m, 0_m},
                                                 {1_m, 1_m, 1_m},
                                                 {2_m, 0_m, 0_m}};
  constexpr std::array triangles{TriangleIndices{0, 1, 2}, TriangleIndices{2, 1, 3},
                                 TriangleIndices{2, 3, 4}};
  constexpr std::array surfaces{Surface{}};
  constexpr std::array<std::uint8_t, 3> of_triangles{0, k_own_surface, 0};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  def.surfaces = surfaces;
  def.triangle_surfaces = of_triangles;
  return Mesh::build(def).mesh;
}

inline AssetPtr sample_height_field() {
  constexpr std::array<Length, 9> heights{0_m, 1_m, 0.5_m, 0_m, 2_m, 0_m, 1_m, 1_m, 1_m};
  constexpr std::array<std::uint8_t, 4> holes{0, 1, 0, 0};
  HeightFieldDef def;
  def.columns = def.rows = 3;
  def.heights = heights;
  def.holes = holes;
  return HeightField::build(def).height_field;
}

/// Two panels of 1 m in the plane y = 0, side by side along x: groups 0 and 1.
inline AssetPtr sample_panels() {
  constexpr std::array<Vec3<Length>, 6> vertices{{{0_m, 0_m, 0_m},
                                                  {0_m, 0_m, 1_m},
                                                  {1_m, 0_m, 0_m},
                                                  {1_m, 0_m, 1_m},
                                                  {2_m, 0_m, 0_m},
                                                  {2_m, 0_m, 1_m}}};
  constexpr std::array<TriangleIndices, 4> triangles{{{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}};
  constexpr std::array<std::uint16_t, 4> groups{0, 0, 1, 1};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  def.triangle_groups = groups;
  return Mesh::build(def).mesh;
}

inline AssetPtr sample_compound() {
  std::array<CompoundChild, 2> children;
  children[0].shape = Shape::box(1_m, 1_m, 0.5_m);
  children[1].asset = sample_hull();
  children[1].shape = children[1].asset->shape();
  children[1].position = {2_m, 0_m, 0_m};
  return Compound::build(children).compound;
}

inline std::array<AssetPtr, 4> sample_assets() {
  return {sample_hull(), sample_mesh(), sample_height_field(), sample_compound()};
}

}  // namespace lockstone::test
