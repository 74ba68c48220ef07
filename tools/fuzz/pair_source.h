// Random pairs of convex shapes, many of them at the limits: each depends on seed and index alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/distance/manifold.h"
#include "core/geometry/mesh_contact/triangle_polytope.h"
#include "tools/fuzz/dice.h"
#include "tools/fuzz/hull_pool.h"

namespace lockstone::fuzz {

enum class Kind : std::uint8_t {
  sphere,
  capsule,
  box,
  hull,
  triangle,
  half_space,
  cylinder,
  cone,
  tapered_capsule,
  rounded_box,
  rounded_hull
};
inline constexpr int k_kinds = 11;

[[nodiscard]] std::string_view name_of(Kind kind);
[[nodiscard]] std::optional<Kind> kind_named(std::string_view name);

/// Whether the two ever meet: flat and unbounded ones do not meet each other.
[[nodiscard]] bool do_meet(Kind a, Kind b);

/// A rim of a cylinder or a cone: a circle about an axis of norm 1, in world axes.
struct Circle {
  Real3 centre;
  Real3 axis;
  double radius = 0;
};

/// A shape in its place, with its core in real numbers.
struct Body {
  Kind kind = Kind::sphere;
  Shape shape{};
  Mat3 rotation{};
  std::shared_ptr<const Hull> hull;
  std::unique_ptr<geometry::TrianglePolytope> triangle;  ///< owns the arrays of the polytope
  const geometry::Polytope* polytope = nullptr;
  std::vector<Real3> core;  ///< vertices in world axes, ordered as those of `ConvexCore`; of a cone
                            ///< its apex, of a cylinder none
  std::vector<Circle> rims;
  std::array<double, 2> swell{};  ///< of a tapered capsule's two vertices, beyond the radius
  double radius = 0;              ///< around the core
  double unevenness = 0;          ///< how far vertices lie below the faces they are of, at most

  [[nodiscard]] PosedShape posed() const { return {shape, rotation, polytope}; }
  [[nodiscard]] bool is_one_sided() const { return kind == Kind::triangle; }
  [[nodiscard]] bool is_tapered() const { return kind == Kind::tapered_capsule; }
  [[nodiscard]] bool is_box() const { return kind == Kind::box || kind == Kind::rounded_box; }
  /// Whether a radius surrounds a core with faces.
  [[nodiscard]] bool is_rounded() const {
    return kind == Kind::rounded_box || kind == Kind::rounded_hull;
  }
  [[nodiscard]] bool has_rims() const { return !rims.empty(); }
  /// Of the rims, 0 without.
  [[nodiscard]] double rim_radius() const { return rims.empty() ? 0 : rims.front().radius; }
  /// Sets the rotation and the data that depends on it.
  void turn_to(const Mat3& rotation);
  /// The farthest that a vertex and the radius reach along a unit direction.
  [[nodiscard]] double reach(const Real3& direction) const;
  /// Of the smallest ball about the centre that holds it.
  [[nodiscard]] double size() const;
};

struct Pair {
  Body a;
  Body b;
  Vec3<Length> offset{};
  Length margin{};
  Vec3<Length> cast_from{};  ///< the offset that B is cast from
  Vec3<Length> way{};
  Vec3<Length> ray_origin{};  ///< from A's centre
  Vec3<Length> ray_way{};
  Mat3 turn{};  ///< to turn both by

  [[nodiscard]] const Body* half_space() const;
  [[nodiscard]] bool has(Kind kind) const { return a.kind == kind || b.kind == kind; }
  /// The length that errors scale with: of cores and offset.
  [[nodiscard]] double size() const;
  [[nodiscard]] double radii() const { return a.radius + b.radius; }
  [[nodiscard]] bool has_rims() const { return a.has_rims() || b.has_rims(); }
  [[nodiscard]] double rim_radii() const { return a.rim_radius() + b.rim_radius(); }
};

/// How far the cores, less the radii, are apart along a unit direction from A to B, with B's centre
/// at `offset`: at most their distance for every direction; negative when they overlap along it.
[[nodiscard]] double separation(const Pair& pair, const Real3& offset, const Real3& direction);

/// Where B is: anywhere, or as `place_specially` says.
enum class Places : std::uint8_t { random, special };

/// Pair number `index` of the pool's seed; `kinds` has one that meets another or itself.
[[nodiscard]] Pair make_pair(HullPool& pool, std::uint64_t seed, std::uint64_t index,
                             const std::vector<Kind>& kinds, Places places = Places::random);

/// All numbers, raw.
[[nodiscard]] std::string describe(const Pair& pair);

}  // namespace lockstone::fuzz
