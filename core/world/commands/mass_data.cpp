// Mass data of bodies: their ranges, and how a record keeps them.

#include "core/dynamics/body/inertia.h"
#include "core/math/block_float.h"
#include "core/world/commands/command_checks.h"

namespace lockstone {
namespace {

// Moments over mass · s², Q30.
Vec3<Unit> normalized_moments(const MassData& data, int scale_exponent) {
  const BlockFloat inverse_mass = inverse_of(data.mass);
  Vec3<Unit> moments;
  for (int i = 0; i < 3; ++i) {
    moments[i].raw = raw::saturate<std::int32_t>(
        scale_saturating(data.inertia[i].raw, inverse_mass, 2 - 2 * scale_exponent));
  }
  return moments;
}

}  // namespace

bool has_valid_mass_data(const MassData& data, int scale_exponent) {
  if (!is_body_mass(data.mass)) return false;
  if (data.inertia == Vec3<MomentOfInertia>{}) return true;
  const Vec3<Unit> moments = normalized_moments(data, scale_exponent);
  for (int i = 0; i < 3; ++i) {
    if (data.inertia[i] <= MomentOfInertia{} || moments[i] > Unit::from_integer(1)) return false;
  }
  return true;
}

void set_solid(BodyRecord& record, const ShapeProperties& properties) {
  record.scale_exponent = static_cast<std::int8_t>(properties.scale_exponent);
  record.inertia = properties.inertia;
}

void set_mass_data(BodyRecord& record, const MassData& data) {
  LKS_ASSERT(record.is_dynamic() && data.mass >= k_min_mass);
  const BlockFloat inverse = inverse_of(data.mass);
  record.inverse_mass = inverse.mantissa;
  record.inverse_mass_exponent = inverse.exponent;
  if (data.inertia == Vec3<MomentOfInertia>{}) return;
  record.inertia = normalized_moments(data, record.scale_exponent);
  for (int i = 0; i < 3; ++i)
    record.inertia[i] = max(record.inertia[i], k_min_inertia);
}

}  // namespace lockstone
