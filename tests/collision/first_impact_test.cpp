// Impacts on the way of a moving shape: a shortcut against the whole method.
#include "core/collision/continuous/first_impact.h"

#include <gtest/gtest.h>

#include <lockstone/mesh.h>

#include "tests/collision/random_rock.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

AssetPtr random_ground(Dice& dice) {
  const Triangles hills = grid(9, 9, 1, [&](int, int) { return dice.uniform(0, 0.5); });
  return Mesh::build(hills.def()).mesh;
}

// Over the middle of the ground.
Sweep random_sweep(Dice& dice) {
  Sweep sweep;
  sweep.start.orientation = dice.orientation();
  const Vec3<Length> start = metres(dice.uniform(2, 6), dice.uniform(0, 1.5), dice.uniform(2, 6));
  for (int i = 0; i < 3; ++i) {
    sweep.start.position[i] = rounded<Position>(start[i]);
    sweep.translation[i] = rounded<Position>(metres(dice.uniform(-1, 1)));
    sweep.rotation[i] =
        RotationComponent::from_raw(static_cast<std::int64_t>(dice.uniform(-0.7, 0.7) * 0x1p32));
  }
  return sweep;
}

// Triangles that stand still are left out where the shape stays in front of them. A mesh that
// moves by 2^-32 m does not stand still, and all of its triangles are tried.
TEST(FirstImpact, LeavesOutNoTriangleThatIsMet) {
  Dice dice;
  int hits = 0, misses = 0;
  for (int round = 0; round < share_of(3000); ++round) {
    const AssetPtr ground = random_ground(dice);
    const AssetPtr rock = round % 4 == 0 ? random_rock(dice, 16, 0.6, 1, 0.4) : nullptr;
    const Shape shape = rock != nullptr
                            ? rock->shape()
                            : dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.05, 0.8);
    const Sweep motion = random_sweep(dice);
    const geometry::AssetGeometry* asset =
        rock == nullptr ? nullptr : geometry::geometry_of(rock.get());
    const MovingShape moving{shape, asset, motion};
    const Shape sheet = ground->shape();
    Sweep still{};
    const auto impact_with = [&](const Sweep& sweep) {
      return first_impact(moving, {sheet, geometry::geometry_of(ground.get()), sweep});
    };
    const Impact standing = impact_with(still);
    still.translation.x = Position::from_raw(1);
    const Impact tried = impact_with(still);
    ASSERT_EQ(standing.hit, tried.hit) << "round " << round;
    (standing.hit ? hits : misses) += 1;
    if (!standing.hit) continue;
    ASSERT_EQ(standing.part_b, tried.part_b) << "round " << round;
    ASSERT_LE(std::abs(standing.fraction.raw - tried.fraction.raw), 1 << 10) << round;
  }
  EXPECT_GT(hits, share_of(300));
  EXPECT_GT(misses, share_of(300));
}

}  // namespace
}  // namespace lockstone::test
