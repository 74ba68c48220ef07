#include "core/world/derived/quantities.h"

#include <algorithm>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/body/inertia.h"
#include "core/dynamics/state/limits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/solid.h"
#include "core/math/divide.h"

namespace lockstone {

Mass mass_of(const BodyRecord& record) {
  if (record.inverse_mass == 0) return {};
  // 1 / (mantissa·2^e) in Q32 = (2^62 / mantissa) · 2^(−e − 30)
  const std::int64_t quotient = raw::round_divide(std::int64_t{1} << 62, record.inverse_mass);
  return Mass::from_raw(raw::scale_binary(quotient, -record.inverse_mass_exponent - 30));
}

MassData mass_data_of(const BodyRecord& record) {
  if (!record.is_dynamic()) return {};
  MassData data{mass_of(record), {}};
  // Q30 of mass · s², mass in Q32, to Q28.
  const int shift = 34 - 2 * record.scale_exponent;
  for (int i = 0; i < 3; ++i) {
    const Int128 product = multiply_wide(data.mass.raw, std::int64_t{record.inertia[i].raw});
    data.inertia[i].raw = saturate_to_int64(round_shift(product, shift));
  }
  return data;
}

SpeedLimit speed_limit_of(const BodyRecord& record) {
  const Velocity surface = rounded<Velocity>(record.max_surface_speed);
  return {rounded<Velocity>(record.max_speed),
          AngularVelocity::from_raw(raw::scale_binary(surface.raw, -record.scale_exponent))};
}

Vec3<Velocity> velocity_around(const Vec3<Velocity>& w, const Vec3<Position>& way, int exponent) {
  const Vec3<Length> arm = saturated<Length>(way);
  const auto product = [&](Velocity turning, Length along) {
    return raw::multiply_shift(turning.raw, along.raw, Length::frac_bits);
  };
  Vec3<Velocity> around;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    around[i].raw = raw::scale_binary(product(w[j], arm[k]) - product(w[k], arm[j]), -exponent);
    around[i] = clamp(around[i], -k_speed_limit, k_speed_limit);
  }
  return around;
}

std::int64_t effort_of(std::int64_t impulse, std::int32_t rate, BlockFloat inverse_mass,
                       int exponent) {
  const int shift = std::clamp(exponent - inverse_mass.exponent, -63, 63);
  return divide_raw_saturating(impulse * rate, inverse_mass.mantissa, shift);
}

Vec3<Position> place_at(const Vec3<Position>& position, const Vec3<Length>& anchor) {
  Vec3<Position> place = position;
  for (int i = 0; i < 3; ++i)
    place[i] += rounded<Position>(anchor[i]);
  return place;
}

Vec3<Position> place_between(const ManifoldPoint& point, const BodyRecord& a, const BodyRecord& b) {
  const Vec3<Position> on_a = place_at(a.position, point.anchor_a);
  const Vec3<Position> on_b = place_at(b.position, point.anchor_b);
  Vec3<Position> place;
  for (int i = 0; i < 3; ++i)
    place[i] = on_a[i] + (on_b[i] - on_a[i]) / 2;
  return place;
}

ShapeProperties properties_of(const Shape& shape, const geometry::AssetGeometry* asset) {
  const auto bounded = [](const Vec3<Unit>& inertia) {
    return Vec3<Unit>{max(inertia.x, k_min_inertia), max(inertia.y, k_min_inertia),
                      max(inertia.z, k_min_inertia)};
  };
  if (is_primitive(shape.kind)) {
    return {bounded(normalized_inertia(shape)), scale_exponent(shape), bounding_radius(shape)};
  }
  if (asset != nullptr && asset->solid() != nullptr) {
    const geometry::Solid& solid = *asset->solid();
    const Vec3<Unit> inertia{geometry::to_unit(solid.inertia.x), geometry::to_unit(solid.inertia.y),
                             geometry::to_unit(solid.inertia.z)};
    return {bounded(inertia), solid.scale_exponent, solid.radius};
  }
  return {bounded({}), k_largest_scale_exponent, {}};
}

bool has_solid(const Shape& shape, const geometry::AssetGeometry* asset) {
  return asset != nullptr ? asset->solid() != nullptr : is_primitive(shape.kind);
}

ShapeProperties properties_of(const Shape& shape, const geometry::AssetGeometry* asset,
                              MotionType motion) {
  constexpr Length k_least = Length::from_ratio(1, 1024);
  ShapeProperties properties = properties_of(shape, asset);
  if (motion != MotionType::kinematic || has_solid(shape, asset)) return properties;
  properties.radius = max(bounding_radius(shape, asset), k_least);
  properties.scale_exponent = scale_exponent_of(properties.radius);
  return properties;
}

bool may_have(MotionType motion, const Shape& shape, const geometry::AssetGeometry* asset) {
  if (motion == MotionType::static_body || has_solid(shape, asset)) return true;
  constexpr Length k_most = Length::from_integer(1 << k_largest_scale_exponent);
  return motion == MotionType::kinematic && asset != nullptr &&
         shape.kind != ShapeKind::height_field && asset->mesh_kernels() != nullptr &&
         bounding_radius(shape, asset) <= k_most;
}

}  // namespace lockstone
