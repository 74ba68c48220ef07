// Faces that are left out, because nothing of the incident face comes down to them, against their
// manifolds; and the shortest mean of normals, against means in floating point.
#include "core/geometry/contact/polytope/face_reach.h"

#include "core/geometry/mesh_contact/mesh_contacts.h"
#include "tests/geometry/pairs/polytope_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using geometry::Fine;
using geometry::Polytope;
using geometry::PolytopeFaceMeeting;
using geometry::PolytopePair;
using geometry::Support;

constexpr int k_reach_scenes = share_of(3'000);
constexpr Length k_margin = Length::from_integer(64);

Fine height_drawn(Dice& dice, Fine at, double scale) {
  if (dice.chance(3)) return at + dice.between(-64, 64);
  return at + static_cast<Fine>(std::ldexp(dice.uniform(-scale, scale), geometry::k_fine_bits));
}

/// A face of A that is left out has no point that is low enough.
void expect_none_hidden(Dice& dice, const PolytopeScene& scene, int& hidden, int& clipped) {
  const Polytope& a = scene.polytope_a->view();
  const Polytope& b = scene.polytope_b->view();
  const PolytopePair pair = geometry::make_polytope_pair(a, scene.rotation_a, b, scene.rotation_b,
                                                         scene.offset, k_margin);
  const HeldFeatures none;
  for (int face = 0; face < static_cast<int>(a.faces.size()); ++face) {
    const Vec3<Unit> normal = a.faces[static_cast<std::size_t>(face)].normal;
    const Support deepest = geometry::support_of(b, -pair.from_a.to_other(normal));
    const Fine separation = geometry::separation_on(pair, normal);
    const PolytopeFaceMeeting meeting{
        pair.from_a, scene.offset, k_margin, {face, deepest.vertex, separation}, false, {}};
    const Manifold whole = geometry::face_manifold(meeting);
    if (whole.count == 0) continue;
    const Fine lowest = geometry::fine(geometry::least_separation(whole));
    const Fine highest = height_drawn(dice, lowest, static_cast<double>(scene.scale()));
    const Manifold limited = geometry::face_manifold(meeting, highest);
    ++clipped;
    if (limited.count != 0) {
      EXPECT_EQ(limited.count, whole.count);
      EXPECT_EQ(limited.normal, whole.normal);
      continue;
    }
    ++hidden;
    EXPECT_GT(lowest, highest);
  }
}

TEST(FaceReach, HidesNoFaceThatIsComeDownTo) {
  Dice dice;
  int hidden = 0, clipped = 0;
  const std::array<std::array<double, 2>, 3> ranges{{{0.2, 2.0}, {0.02, 0.5}, {0.02, 50.0}}};
  for (int i = 0; i < k_reach_scenes; ++i) {
    const auto& range = ranges[static_cast<std::size_t>(i) % ranges.size()];
    const PolytopeScene scene = random_polytope_scene(dice, ShapeKind::hull, range[0], range[1]);
    expect_none_hidden(dice, scene, hidden, clipped);
    if (HasFailure()) FAIL() << describe(scene);
  }
  EXPECT_GT(hidden, clipped / 50);
  EXPECT_LT(hidden, clipped);
}

TEST(LeastMeanNormal, IsAtMostTheLengthOfAnyMean) {
  Dice dice;
  for (int i = 0; i < k_reach_scenes; ++i) {
    const TestPolytopePtr made = random_polytope(dice, 1);
    const Polytope& p = made->view();
    Real shortest = 1;
    for (const geometry::HalfEdge& edge : p.edges) {
      const RealVec n = real(p.faces[edge.face].normal);
      const RealVec m = real(p.faces[p.edges[edge.twin].face].normal);
      shortest = std::min(shortest, norm(n + m) / 2);
    }
    const Real found = real(geometry::least_mean_normal_of(p.faces, p.edges));
    EXPECT_LE(found, shortest);
    EXPECT_NEAR(static_cast<double>(found), static_cast<double>(shortest), 1e-4);
  }
}

}  // namespace
}  // namespace lockstone::test
