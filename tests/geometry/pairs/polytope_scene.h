// Random pairs of shapes of which one at least is a polytope.
#pragma once

#include <memory>

#include "core/geometry/dispatch/polytope_kernels.h"
#include "tests/geometry/pairs/real_solid.h"
#include "tests/geometry/pairs/test_polytope.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {

/// A shape with its rotation, by value.
struct Body {
  Shape shape;
  Mat3 rotation;
  const geometry::Polytope* polytope = nullptr;

  [[nodiscard]] PosedShape posed() const { return {shape, rotation, polytope}; }
};

/// A pair of which one at least is a polytope.
struct PolytopeScene {
  TestPolytopePtr polytope_a;
  TestPolytopePtr polytope_b;
  Shape a;
  Shape b;
  Mat3 rotation_a;
  Mat3 rotation_b;
  Vec3<Length> offset;
  Length margin;

  [[nodiscard]] PosedShape posed_a() const {
    return {a, rotation_a, polytope_a ? &polytope_a->view() : nullptr};
  }
  [[nodiscard]] PosedShape posed_b() const {
    return {b, rotation_b, polytope_b ? &polytope_b->view() : nullptr};
  }
  [[nodiscard]] RealSolid real_a() const { return real_solid(posed_a(), {}); }
  [[nodiscard]] RealSolid real_b() const { return real_solid(posed_b(), real(offset)); }
  [[nodiscard]] Manifold collide() const {
    return lockstone::collide(posed_a(), posed_b(), offset, margin);
  }
  [[nodiscard]] bool has(ShapeKind kind) const { return a.kind == kind || b.kind == kind; }
  /// Of the capsule, else 0.
  [[nodiscard]] Real capsule_radius() const {
    return a.kind == ShapeKind::capsule   ? real(a.size.x)
           : b.kind == ShapeKind::capsule ? real(b.size.x)
                                          : 0;
  }
  /// A length that errors scale with.
  [[nodiscard]] Real scale() const {
    Real size = norm(real(offset));
    const RealSolid solid_a = real_a();
    const RealSolid solid_b = real_b();
    for (const RealVec& v : solid_a.vertices)
      size = std::max(size, norm(v) + solid_a.radius);
    for (const RealVec& v : solid_b.vertices)
      size = std::max(size, norm(v - real(offset)) + solid_b.radius);
    return 2 * size;
  }
};

inline std::string describe(const PolytopeScene& s) {
  std::string text = "a " + describe(s.a) + " b " + describe(s.b) + " Ra " +
                     describe(s.rotation_a) + " Rb " + describe(s.rotation_b) + " offset " +
                     std::to_string(s.offset.x.raw) + "," + std::to_string(s.offset.y.raw) + "," +
                     std::to_string(s.offset.z.raw) + " margin " + std::to_string(s.margin.raw);
  for (const TestPolytope* p : {s.polytope_a.get(), s.polytope_b.get()}) {
    if (p == nullptr) continue;
    text += "\n  vertices";
    for (const auto& v : p->view().vertices)
      text += " (" + std::to_string(v.x.raw) + "," + std::to_string(v.y.raw) + "," +
              std::to_string(v.z.raw) + ")";
  }
  return text;
}

inline void place(Dice& dice, PolytopeScene& scene, double high) {
  scene.rotation_a = to_matrix(dice.orientation());
  scene.rotation_b = dice.chance(8) ? scene.rotation_a : to_matrix(dice.orientation());
  const RealVec n = dice.direction();
  scene.offset = {};
  const Real reach = scene.real_a().reach(n) + scene.real_b().reach(n * -1);
  scene.offset = metres(n * std::min<Real>(reach * dice.uniform(0.2, 1.25), 1990));
  scene.margin = metres(dice.chance(4) ? 0 : std::min(64.0, high * dice.uniform(0, 0.5)));
}

inline PolytopeScene random_polytope_scene(Dice& dice, ShapeKind other, double low, double high) {
  PolytopeScene scene;
  const auto size = [&] { return std::exp(dice.uniform(std::log(low), std::log(high))); };
  const bool polytope_first = dice.chance(2);
  scene.polytope_a = random_polytope(dice, size());
  scene.a = {ShapeKind::hull, {}, {7}};
  if (other == ShapeKind::hull) {
    do
      scene.polytope_b = random_polytope(dice, size());
    while (geometry::is_flat(scene.polytope_a->view()) &&
           geometry::is_flat(scene.polytope_b->view()));
    scene.b = {ShapeKind::hull, {}, {static_cast<std::uint64_t>(polytope_first ? 6 : 8)}};
  } else {
    scene.b = dice.shape(other, low, high);
  }
  if (!polytope_first) {
    std::swap(scene.polytope_a, scene.polytope_b);
    std::swap(scene.a, scene.b);
  }
  place(dice, scene, high);
  return scene;
}

inline const std::array<ShapeKind, 4> k_kinds_beside_hulls{ShapeKind::sphere, ShapeKind::capsule,
                                                           ShapeKind::box, ShapeKind::hull};

/// Runs `check(dice, scene)` over polytopes and all kinds they meet, in several ranges of sizes.
template <class Check>
void for_random_polytope_scenes(int rounds, Check check) {
  Dice dice;
  const std::array<std::array<double, 2>, 4> ranges{
      {{0.2, 2.0}, {0.002, 0.05}, {0.002, 500.0}, {50.0, 500.0}}};
  for (const ShapeKind other : k_kinds_beside_hulls) {
    for (int i = 0; i < rounds; ++i) {
      const auto& range = ranges[static_cast<std::size_t>(i) % ranges.size()];
      const PolytopeScene scene = random_polytope_scene(dice, other, range[0], range[1]);
      check(dice, scene);
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << describe(scene);
        return;
      }
    }
  }
}

}  // namespace lockstone::test
