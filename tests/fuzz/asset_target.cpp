// Assets: hulls, meshes, height fields, compounds.

#include <array>

#include <lockstone/assert.h>
#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>
#include <lockstone/world.h>

#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

using namespace literals;

std::shared_ptr<const Hull> sample_hull() {
  constexpr std::array<Vec3<Length>, 5> points{Vec3<Length>{0_m, 0_m, 0_m},
                                               {2_m, 0_m, 0_m},
                                               {0_m, 1_m, 0_m},
                                               {0_m, 0_m, 3_m},
                                               {1_m, 1_m, 1_m}};
  return Hull::build(points).hull;
}

AssetPtr sample_mesh() {
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

AssetPtr sample_height_field() {
  constexpr std::array<Length, 9> heights{0_m, 1_m, 0.5_m, 0_m, 2_m, 0_m, 1_m, 1_m, 1_m};
  constexpr std::array<std::uint8_t, 4> holes{0, 1, 0, 0};
  HeightFieldDef def;
  def.columns = def.rows = 3;
  def.heights = heights;
  def.holes = holes;
  return HeightField::build(def).height_field;
}

AssetPtr sample_compound() {
  std::array<CompoundChild, 2> children;
  children[0].shape = Shape::box(1_m, 1_m, 0.5_m);
  children[1].asset = sample_hull();
  children[1].shape = children[1].asset->shape();
  children[1].position = {2_m, 0_m, 0_m};
  return Compound::build(children).compound;
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  for (const AssetPtr& asset :
       {AssetPtr(sample_hull()), sample_mesh(), sample_height_field(), sample_compound()})
    all.push_back(asset->canonical_bytes());
  return all;
}

// A ball falls on it for a while.
void use(const AssetPtr& asset) {
  WorldDef def{
      .body_capacity = 4, .pair_capacity = 16, .contact_capacity = 256, .joint_capacity = 0};
  Result<World> world =
      World::create(def, std::make_shared<const AssetSet>(std::vector<AssetPtr>{asset}));
  LKS_CHECK(world.ok());
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = asset->shape();
  LKS_CHECK(world.value().create_body(ground).ok());
  BodyDef ball;
  ball.shape = Shape::sphere(0.5_m);
  ball.position = {0.5_m, 1_m, 0.5_m};
  LKS_CHECK(world.value().create_body(ball).ok());
  for (int tick = 0; tick < 4; ++tick)
    (void)world.value().step();
}

bool run(ByteView bytes) {
  static const AssetSet known({sample_hull()});
  const Result<AssetPtr> asset = load_asset(bytes, known);
  if (!asset.ok()) return false;
  const Bytes again = asset.value()->canonical_bytes();
  LKS_CHECK(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
  use(asset.value());
  return true;
}

const Registration k_registration{{.name = "asset", .seeds = seeds, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
