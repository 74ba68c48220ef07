// Physical quantities that follow from records and shapes.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/body_record.h"
#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/distance/manifold.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Kilograms; 0 of a body that nothing pushes.
[[nodiscard]] Mass mass_of(const BodyRecord& record);
/// With its principal moments, saturating.
[[nodiscard]] MassData mass_data_of(const BodyRecord& record);
/// The limits of its speeds as the body keeps them.
[[nodiscard]] SpeedLimit speed_limit_of(const BodyRecord& record);

/// ω × way, each component within the speed limit, of a body whose surface speed is ω·2^exponent.
[[nodiscard]] Vec3<Velocity> velocity_around(const Vec3<Velocity>& w, const Vec3<Position>& way,
                                             int exponent);

/// An impulse λ·(1/mA + 1/mB) a substep, as λ a second: N, and N·m with the length 2^exponent.
[[nodiscard]] std::int64_t effort_of(std::int64_t impulse, std::int32_t rate,
                                     BlockFloat inverse_mass, int exponent);

/// An anchor of a body that is there, in the world.
[[nodiscard]] Vec3<Position> place_at(const Vec3<Position>& position, const Vec3<Length>& anchor);

/// Halfway between the surfaces of A and B at a point of their manifold.
[[nodiscard]] Vec3<Position> place_between(const ManifoldPoint& point, const BodyRecord& a,
                                           const BodyRecord& b);

/// Properties that follow from a body's shape alone.
struct ShapeProperties {
  Vec3<Unit> inertia{};  // principal moments / (mass · s²), at least k_min_inertia
  int scale_exponent = 0;
  Length radius{};
};
[[nodiscard]] ShapeProperties properties_of(const Shape& shape,
                                            const geometry::AssetGeometry* asset);

/// Whether a body of this shape has a mass distribution.
[[nodiscard]] bool has_solid(const Shape& shape, const geometry::AssetGeometry* asset);

/// The same of a body: of a kinematic one of triangles its scale and radius follow from its bounds.
[[nodiscard]] ShapeProperties properties_of(const Shape& shape,
                                            const geometry::AssetGeometry* asset,
                                            MotionType motion);

/// Whether the body is made of triangles, without a solid, and may move: a kinematic mesh.
[[nodiscard]] inline bool is_surface(const BodyRecord& body, const geometry::AssetGeometry* asset) {
  return body.moves() && asset != nullptr && asset->solid() == nullptr;
}

/// Whether the body leads in its pairs, as its proxy does.
[[nodiscard]] inline bool leads(const BodyRecord& body, const geometry::AssetGeometry* asset) {
  return body.moves() && !is_surface(body, asset);
}

/// Whether a body of this motion may have the shape: a dynamic one needs a solid, a kinematic one a
/// solid, or a mesh that reaches no farther than 1024 m from its origin.
[[nodiscard]] bool may_have(MotionType motion, const Shape& shape,
                            const geometry::AssetGeometry* asset);

}  // namespace lockstone
