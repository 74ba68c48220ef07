#include "core/world/phases/motion/early_stop.h"

#include <algorithm>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/motion.h"
#include "core/math/product_sum.h"

namespace lockstone {
// Twice, of each mass. `gain`: of the velocity in a tick, by gravity and forces.
std::int64_t EarlyStop::work_on(const Vec3<Velocity>& gain, const Vec3<Position>& from,
                                const Vec3<Position>& to) const {
  ProductSum work;
  for (int i = 0; i < 3; ++i)
    work.add(gain[i].raw, (to[i].raw - from[i].raw) * step_.tick_rate);
  return work.rounded(31);
}

void EarlyStop::add(const BodyRecord& body, const Transform& start, const BodySpeeds& start_speeds,
                    const Vec3<Position>& stop) {
  LKS_ASSERT(body.is_dynamic());
  const BlockFloat inverse = body.inverse_mass_value();
  if (inverse.mantissa == 0) return;
  if (unit_ == BlockFloat{}) unit_ = inverse;
  const auto add = [&](std::int64_t& sum, std::int64_t each) {
    sum = raw::saturating_add(sum, scale_saturating(each, quotient(unit_, inverse), 0));
  };
  const auto inertia_at = [&](const Quat& orientation) {
    return inverse_inertia(body, to_matrix(orientation));
  };
  const std::int64_t now = twice_energy(body.velocity, body.spin, inertia_at(body.orientation));
  const std::int64_t before =
      twice_energy(start_speeds.velocity, start_speeds.spin, inertia_at(start.orientation));
  const Vec3<Velocity> gain = tick_gain(body, gravity_, step_);
  add(energy_, now);
  add(gain_, now - before - work_on(gain, start.position, stop));
  add(lost_, work_on(gain, stop, body.position));
}

void EarlyStop::slow(BodyRecord& body) const {
  const std::int64_t excess = std::min(gain_, lost_);
  if (excess <= 0 || energy_ <= 0) return;
  const Unit share = Unit::from_raw(root_of_share(raw::saturating_add(energy_, -excess), energy_));
  for (int i = 0; i < 3; ++i) {
    body.velocity[i] = times(body.velocity[i], share);
    body.spin[i] = times(body.spin[i], share);
  }
}

}  // namespace lockstone
