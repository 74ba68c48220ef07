// Box contacts that remember their features of a tick ago.
//
// The scenes overlap by up to a few millimetres, and tremble by less: as boxes in a pile do.

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/manifold/contact_choice.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {
namespace {

Manifold collide_holding(const Scene& scene, const HeldFeatures& held) {
  Manifold manifold;
  collide(scene.posed_a(), scene.posed_b(), scene.offset, scene.margin, held, manifold);
  return manifold;
}

/// Two boxes that overlap by less than 3 mm, in any way.
Scene touching_boxes(Dice& dice) {
  Scene scene;
  do {
    scene = random_scene(dice, ShapeKind::box, ShapeKind::box, 0.2, 1);
    scene.margin = metres(0.02);
    for (int i = 0; i < 8 && scene.collide().count > 0; ++i)
      scene.offset += scene.offset / 16;
    for (int i = 0; i < 400 && !geometry::touches(scene.collide()); ++i)
      scene.offset -= scene.offset / 512;
  } while (!geometry::touches(scene.collide()));
  return scene;
}

bool is_other(const Manifold& a, const Manifold& b) {
  return geometry::touches(a) && geometry::touches(b) && !geometry::are_alike(a.normal, b.normal);
}

/// Whether the normal changes three times or more while the boxes tremble.
bool alternates(Dice dice, const Scene& still, bool holds) {
  Manifold last = still.collide();
  int changes = 0;
  for (int tick = 0; tick < 40; ++tick) {
    Scene scene = still;
    tremble(dice, 1.5e-4, scene.offset);
    const Manifold next = collide_holding(scene, holds ? held_by(last) : HeldFeatures{});
    changes += is_other(last, next) ? 1 : 0;
    last = next;
  }
  return changes >= 3;
}

TEST(HeldFeatures, KeepNormalsFromAlternatingWhileBoxesTremble) {
  Dice dice;
  int held = 0, plain = 0;
  for (int round = 0; round < 16000; ++round) {
    const Scene scene = touching_boxes(dice);
    held += alternates(dice, scene, true) ? 1 : 0;
    plain += alternates(dice, scene, false) ? 1 : 0;
  }
  EXPECT_GT(plain, 4);
  EXPECT_LT(4 * held, plain);
}

/// Boxes that have moved since they had the features that they hold.
struct MovedBoxes {
  Scene scene;
  HeldFeatures held;

  MovedBoxes(Dice& dice, double metres_most) : scene(touching_boxes(dice)) {
    held = held_by(scene.collide());
    tremble(dice, metres_most, scene.offset);
  }
  [[nodiscard]] Manifold collide() const { return collide_holding(scene, held); }
};

TEST(HeldFeatures, CostNoMoreOverlapThanTheirMargins) {
  Dice dice;
  for (int round = 0; round < 3000; ++round) {
    const MovedBoxes boxes(dice, 2e-3);
    const Manifold plain = boxes.scene.collide(), holding = boxes.collide();
    if (!geometry::touches(plain)) continue;
    ASSERT_TRUE(geometry::touches(holding)) << describe(boxes.scene);
    // Twice a tenth and half a millimetre: of edges beside a face, and of that beside other edges.
    const double deepest = depth_of(plain);
    EXPECT_GT(depth_of(holding), 1.25 * deepest - 1.2e-3) << describe(boxes.scene);
  }
}

// A manifold may be kept while nothing moves, or found again from its own features.
TEST(HeldFeatures, OfAManifoldGiveThatManifold) {
  Dice dice;
  for (int round = 0; round < 20000; ++round) {
    const MovedBoxes boxes(dice, 2e-3);
    const Manifold found = boxes.collide();
    if (found.count == 0) continue;
    const HeldFeatures held = held_by(found);
    EXPECT_EQ(held, held_by(collide_holding(boxes.scene, held))) << describe(boxes.scene);
  }
}

TEST(HeldFeatures, GiveTheSameManifoldInEitherOrder) {
  Dice dice;
  for (int round = 0; round < 1000; ++round) {
    const MovedBoxes boxes(dice, 1e-3);
    const Scene& scene = boxes.scene;
    Manifold back;
    collide(scene.posed_b(), scene.posed_a(), -scene.offset, scene.margin, boxes.held, back);
    expect_flipped(boxes.collide(), back);
  }
}

TEST(HeldFeatures, ChangeNothingForBoxesThatAreApart) {
  Dice dice;
  for (int round = 0; round < 1000; ++round) {
    Scene scene = touching_boxes(dice);
    const HeldFeatures held = held_by(scene.collide());
    scene.offset += scene.offset / 256;
    const Manifold plain = scene.collide(), holding = collide_holding(scene, held);
    if (geometry::touches(plain)) continue;
    EXPECT_EQ(plain.count, holding.count);
    EXPECT_EQ(plain.normal, holding.normal);
  }
}

}  // namespace
}  // namespace lockstone::test
