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
#include "tests/support/sample_level.h"

namespace lockstone::fuzz {
namespace {

using namespace literals;

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  for (const AssetPtr& asset : test::sample_assets())
    all.push_back(asset->canonical_bytes());
  all.push_back(test::sample_level()->canonical_bytes());
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
  static const AssetSet known({test::sample_hull(), test::sample_panels()});
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
