// Box pairs side by side against one at a time.
#include "core/geometry/contact/box/box_batch.h"

#include <vector>

#include "core/geometry/contact/collide_pairs.h"
#include "core/kernels/target.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {
namespace {

using geometry::BoxBatch;

/// Two boxes of which one lies on the other: turned, tilted and pressed in a little.
Scene lying_boxes(Dice& dice) {
  Scene scene;
  scene.a = dice.shape(ShapeKind::box, 0.2, 1);
  scene.b = dice.chance(2) ? scene.a : dice.shape(ShapeKind::box, 0.2, 1);
  scene.rotation_a = to_matrix(dice.orientation());
  const double tilt = dice.chance(4) ? 0 : dice.uniform(-2e-3, 2e-3);
  const double yaw = dice.chance(3) ? 0 : dice.uniform(-0.8, 0.8);
  const auto beside = [&](Length x, Length y) {
    const double reach = std::ldexp(x.raw + y.raw, -Length::frac_bits);
    return metres(dice.chance(4) ? 0 : 0.8 * reach * dice.uniform(-1, 1));
  };
  const Vec3<Length> at{beside(scene.a.size.x, scene.b.size.x),
                        scene.a.size.y + scene.b.size.y - metres(dice.uniform(0.001, 0.004)),
                        beside(scene.a.size.z, scene.b.size.z)};
  scene.offset = rotate(scene.rotation_a, at);
  const Mat3 leaned = multiply(turned(1, 0, dice.uniform(-1, 1), tilt), turned(0, 1, 0, yaw));
  scene.rotation_b = multiply(scene.rotation_a, leaned);
  scene.margin = metres(0.02);
  return scene;
}

Scene any_boxes(Dice& dice) {
  if (dice.chance(3)) return lying_boxes(dice);
  return dice.chance(2) ? random_scene(dice, ShapeKind::box, ShapeKind::box, 0.2, 2)
                        : random_scene(dice, ShapeKind::box, ShapeKind::box, 0.001, 0.05);
}

bool are_equal(const Manifold& a, const Manifold& b) {
  if (a.count != b.count || a.normal != b.normal) return false;
  for (std::size_t i = 0; i < k_max_manifold_points; ++i) {
    const ManifoldPoint &p = a.points[i], &q = b.points[i];
    if (p.anchor_a != q.anchor_a || p.anchor_b != q.anchor_b || p.separation != q.separation ||
        p.feature != q.feature)
      return false;
  }
  return true;
}

/// The features of the scene a moment ago, when B was up to 2 mm aside.
HeldFeatures held_in(Dice& dice, const Scene& scene) {
  Scene before = scene;
  for (int axis = 0; axis < 3; ++axis)
    before.offset[axis] += metres(dice.uniform(-0.002, 0.002));
  return held_by(before.collide());
}

/// How many of the scenes are settled by faces alone; all are as `collide` has them. Every other
/// one is held.
std::size_t settle(Dice& dice, const std::vector<Scene>& scenes) {
  BoxBatch batch;
  std::vector<HeldFeatures> held;
  for (const Scene& scene : scenes) {
    held.push_back(held.size() % 2 == 0 ? HeldFeatures{} : held_in(dice, scene));
    if (geometry::is_of_edges(held.back().first())) held.back() = {};  // those are not taken
    batch.add(scene.posed_a(), scene.posed_b(), scene.offset, scene.margin, held.back());
  }
  batch.collide();
  std::size_t settled = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Manifold found, alone;
    batch.write(i, found);
    collide(scenes[i].posed_a(), scenes[i].posed_b(), scenes[i].offset, scenes[i].margin, held[i],
            alone);
    EXPECT_TRUE(are_equal(found, alone)) << describe(scenes[i]);
    if (batch.is_settled(i)) ++settled;
  }
  return settled;
}

template <class MakeScene>
std::vector<Scene> some_scenes(Dice& dice, const MakeScene& make) {
  std::vector<Scene> scenes(static_cast<std::size_t>(dice.between(1, BoxBatch::k_capacity)));
  for (Scene& scene : scenes) {
    do
      scene = make(dice);
    while (!BoxBatch::takes(scene.a, scene.b, scene.offset));
  }
  return scenes;
}

TEST(BoxBatch, CollidesAsOneAtATimeBitForBitOnEveryTarget) {
  Dice dice;
  for (const std::string_view target : lanes::supported_targets()) {
    ASSERT_EQ(lanes::set_target(target), Status::ok);
    std::size_t pairs = 0, settled = 0;
    for (int round = 0; round < 1000; ++round) {
      const std::vector<Scene> scenes = some_scenes(dice, any_boxes);
      settled += settle(dice, scenes);
      pairs += scenes.size();
    }
    EXPECT_GT(settled, pairs / 8) << target;
    EXPECT_LT(settled, pairs) << target;
  }
}

TEST(BoxBatch, SettlesNearlyAllThatLieOnOneAnother) {
  Dice dice;
  std::size_t pairs = 0, settled = 0;
  for (int round = 0; round < 300; ++round) {
    const std::vector<Scene> scenes = some_scenes(dice, lying_boxes);
    settled += settle(dice, scenes);
    pairs += scenes.size();
  }
  EXPECT_GT(settled, pairs - pairs / 10);
}

TEST(BoxBatch, SettlesByFacesNeitherPairsThatAreApartNorThoseThatMeetByEdges) {
  const Shape cube = Shape::box(metres(0.5), metres(0.5), metres(0.5));
  const Mat3 level, on_edge = turned(1, 0, 0, 0.7854), across = turned(0, 0, 1, 0.7854);
  BoxBatch batch;
  batch.add({cube, level}, {cube, level}, metres(0, 1.5, 0), metres(0.02), {});
  batch.add({cube, on_edge}, {cube, across}, metres(0, 1.41, 0), metres(0.02), {});
  batch.add({cube, level}, {cube, level}, metres(0, 0.999, 0), metres(0.02), {});
  batch.collide();
  EXPECT_FALSE(batch.is_settled(0));
  EXPECT_FALSE(batch.is_settled(1));
  EXPECT_TRUE(batch.is_settled(2));
}

TEST(BoxBatch, TakesNoBoxesOfSixteenMetresTogether) {
  const Shape cube = Shape::box(metres(2), metres(2), metres(2));
  EXPECT_TRUE(BoxBatch::takes(cube, cube, metres(0, 3.9, 0)));
  EXPECT_FALSE(BoxBatch::takes(cube, cube, metres(0, 4, 0)));
  EXPECT_FALSE(BoxBatch::takes(cube, Shape::sphere(metres(1)), {}));
}

}  // namespace
}  // namespace lockstone::test
