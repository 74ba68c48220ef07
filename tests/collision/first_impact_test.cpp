// Impacts on the way of a moving shape: a shortcut against the whole method.
#include "core/collision/continuous/first_impact.h"

#include <gtest/gtest.h>

#include <lockstone/mesh.h>

#include "tests/collision/random_rock.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

// A ground of 8 × 8 squares of a metre, each of two triangles, up to half a metre high.
AssetPtr random_ground(Dice& dice) {
  constexpr std::uint32_t k_side = 9;
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
    const double x = i % k_side, z = i / k_side;
    vertices.push_back(metres(x - 4, dice.uniform(0, 0.5), z - 4));
  }
  for (std::uint32_t row = 0; row + 1 < k_side; ++row) {
    for (std::uint32_t column = 0; column + 1 < k_side; ++column) {
      const std::uint32_t at = row * k_side + column;
      triangles.push_back(TriangleIndices{at, at + k_side, at + 1});
      triangles.push_back(TriangleIndices{at + 1, at + k_side, at + k_side + 1});
    }
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

Sweep random_sweep(Dice& dice) {
  Sweep sweep;
  sweep.start.orientation = dice.orientation();
  for (int i = 0; i < 3; ++i) {
    const double reach = i == 1 ? 1.5 : 2;
    sweep.start.position[i] = rounded<Position>(metres(dice.uniform(i == 1 ? 0 : -2, reach)));
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
