// Hull contacts that remember their features of a tick ago, as those of boxes do
// (held_features_test.cpp).

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/contact/manifold/contact_choice.h"
#include "tests/geometry/pairs/polytope_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

/// An eight-sided disc, a tetrahedron and a slab.
class Solids {
 public:
  Solids() {
    all_.push_back(std::make_unique<TestPolytope>(prism_points(8, 0.5, 0.1)));
    all_.push_back(std::make_unique<TestPolytope>(
        std::vector{metres(0.3, 0.3, 0.3), metres(0.3, -0.3, -0.3), metres(-0.3, 0.3, -0.3),
                    metres(-0.3, -0.3, 0.3)}));
    all_.push_back(std::make_unique<TestPolytope>(box_points(2, 0.25, 2)));
  }

  [[nodiscard]] const geometry::Polytope& view(std::size_t index) const {
    return all_[index]->view();
  }

 private:
  std::vector<std::unique_ptr<TestPolytope>> all_;
};

/// One of the solids, turned.
struct TurnedSolid {
  std::size_t index = 0;
  Mat3 rotation;
};

struct HullPair {
  const Solids& solids;
  TurnedSolid a, b;
  Vec3<Length> offset;

  [[nodiscard]] Manifold collide(const HeldFeatures& held = {}) const {
    const Shape of_a = shape(a), of_b = shape(b);
    Manifold manifold;
    lockstone::collide({of_a, a.rotation, &solids.view(a.index)},
                       {of_b, b.rotation, &solids.view(b.index)}, offset, metres(0.02), held,
                       manifold);
    return manifold;
  }

 private:
  static Shape shape(const TurnedSolid& solid) {
    return {ShapeKind::hull, {}, {static_cast<std::uint32_t>(solid.index + 1)}};
  }
};

/// Two of the solids that overlap by a few millimetres, in any way.
HullPair touching_pair(Dice& dice, const Solids& solids) {
  const auto draw = [&] {
    const auto index = static_cast<std::size_t>(dice.between(0, 2));
    return TurnedSolid{index, to_matrix(dice.orientation())};
  };
  const TurnedSolid a = draw(), b = draw();
  const RealVec n = dice.direction();
  HullPair pair{solids, a, b,
                metres(5 * static_cast<double>(n.x), 5 * static_cast<double>(n.y),
                       5 * static_cast<double>(n.z))};
  for (int i = 0; i < 4000 && !geometry::touches(pair.collide()); ++i)
    pair.offset -= pair.offset / 512;
  return pair;
}

/// Two of them that have moved since they had the features that they hold.
struct MovedHulls {
  HullPair pair;
  HeldFeatures held;

  MovedHulls(Dice& dice, const Solids& solids) : pair(touching_pair(dice, solids)) {
    held = held_by(pair.collide());
    tremble(dice, 2e-3, pair.offset);
  }
};

// A manifold may be kept while nothing moves, or found again from its own features.
TEST(HeldHullFeatures, OfAManifoldGiveThatManifold) {
  Dice dice;
  const Solids solids;
  for (int round = 0; round < test::share_of(3000); ++round) {
    const MovedHulls hulls(dice, solids);
    const HeldFeatures found = held_by(hulls.pair.collide(hulls.held));
    if (found.count == 0) continue;
    EXPECT_EQ(found, held_by(hulls.pair.collide(found))) << round;
  }
}

TEST(HeldHullFeatures, CostNoMoreOverlapThanTheirMargins) {
  Dice dice;
  const Solids solids;
  for (int round = 0; round < test::share_of(3000); ++round) {
    const MovedHulls hulls(dice, solids);
    const Manifold plain = hulls.pair.collide();
    if (!geometry::touches(plain)) continue;
    EXPECT_GT(depth_of(hulls.pair.collide(hulls.held)), 1.25 * depth_of(plain) - 1.2e-3) << round;
  }
}

/// How often the four points of a disc that lies on a slab change while it trembles.
int changes_of_a_lying_disc(bool holds) {
  Dice dice;
  const Solids solids;
  const Mat3 level = to_matrix(Quat{});
  HullPair pair{solids, {2, level}, {0, level}, metres(0, 0.3499, 0)};
  HeldFeatures last = held_by(pair.collide());
  int changes = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double x = dice.uniform(-1e-4, 1e-4), z = dice.uniform(-1e-4, 1e-4);
    pair.b.rotation = to_matrix(quat(x, 0, z, 1));
    const HeldFeatures now = held_by(pair.collide(holds ? last : HeldFeatures{}));
    changes += now == last ? 0 : 1;
    last = now;
  }
  return changes;
}

TEST(HeldHullFeatures, KeepTheFourPointsOfADiscThatTrembles) {
  EXPECT_GT(changes_of_a_lying_disc(false), 20);
  EXPECT_EQ(changes_of_a_lying_disc(true), 0);
}

}  // namespace
}  // namespace lockstone::test
