// A compound of two meshes and two convex shapes.
#pragma once

#include <array>

#include "tests/support/sample_assets.h"

namespace lockstone::test {

inline CompoundChild child_of(const AssetPtr& asset, const Vec3<Length>& position = {}) {
  CompoundChild child;
  child.asset = asset;
  child.shape = asset->shape();
  child.position = position;
  return child;
}

/// Two panels of 1 m (groups 0 and 1) in y = 0 from x = 0 to 2, turned ones of the same mesh from x
/// = 2 to 4, a box whose top is flush with them from x = −2 to 0, and a ball.
inline std::array<CompoundChild, 4> sample_level_children() {
  std::array<CompoundChild, 4> children;
  children[0] = child_of(sample_panels());
  children[1].shape = Shape::box(1_m, 0.5_m, 1_m);
  children[1].position = {-1_m, -0.5_m, 0.5_m};
  children[2] = child_of(children[0].asset, {4_m, 0_m, 1_m});
  children[2].orientation = {{}, Unit::from_integer(1), {}, {}};  // half a turn about y
  children[3].shape = Shape::sphere(0.25_m);
  children[3].position = {1_m, 3_m, 0_m};
  return children;
}

inline std::shared_ptr<const Compound> sample_level() {
  return Compound::build(sample_level_children()).compound;
}

}  // namespace lockstone::test
