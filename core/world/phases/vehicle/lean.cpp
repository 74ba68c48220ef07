#include "core/world/phases/vehicle/lean.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/trigonometry.h>

#include "core/math/roots.h"

namespace lockstone {
namespace {

// The lean goes to its aim with this angular frequency, without overshooting.
constexpr Real k_omega = Real::ratio(7, 1);
// The most of its turning that the damping may take in a tick.
constexpr Real k_most_damping = Real::ratio(8, 10);
// The force that pays for the torque's work, over the weight.
constexpr Real k_most_payment = Real::ratio(3, 10);
constexpr Real k_least_height = Real::ratio(1, 10);
constexpr Real k_least_gravity = Real::ratio(1, 100);
// Where the way ahead is steeper there is no lean about it.
constexpr Real k_least_level = Real::ratio(2, 10);

// Directions are units.
struct Level {
  bool exists = false;
  Real gravity{};
  Real3 up{}, ahead{};
};

Level level_of(const WorldData& world, const Mat3& axes) {
  const Real3 gravity = Real3::of(world.header.gravity);
  Level level;
  level.gravity = length_real(length_real(gravity.x, gravity.y), gravity.z);
  if (level.gravity < k_least_gravity) return level;
  level.up = unit_real(gravity * -k_real_one);
  const Real3 ahead = Real3::of(axes.x);
  const Real3 flat = ahead - level.up * dot_real(level.up, ahead);
  if (dot_real(flat, flat) < k_least_level * k_least_level) return level;
  level.ahead = unit_real(flat);
  level.exists = true;
  return level;
}

Angle lean_to(const Level& level, const Mat3& axes) {
  const Real aside = -dot_real(Real3::of(axes.z), level.up);
  return atan2_raw(aside.raw, dot_real(Real3::of(axes.y), level.up).raw);
}

// How the wheels stand: the speed of the centre of mass over their ground, along the level way
// ahead, and its height; means over the wheels.
struct Stance {
  std::int64_t count = 0;
  Real speed{}, height{};
};

Stance stance_of(const WorldData& world, const Chassis& chassis, const Real3& ahead,
                 std::span<const WheelContact> contacts) {
  Stance stance;
  for (const WheelContact& contact : contacts) {
    if (!contact.exists) continue;
    const Real3 arm = Real3::of(world.bodies[chassis.body].position - contact.point);
    const Real3 velocity = contact.ahead * contact.speed_ahead +
                           contact.right * contact.speed_right + cross_real(chassis.turning, arm);
    stance.speed = stance.speed + dot_real(velocity, ahead);
    stance.height = stance.height + dot_real(arm, Real3::of(chassis.axes.y));
    ++stance.count;
  }
  if (stance.count == 0) return stance;
  stance.speed.raw /= stance.count;
  stance.height = std::max(Real{stance.height.raw / stance.count}, k_least_height);
  return stance;
}

// The torque t that does so much work a second, towards which a body turns at w, at the mean of the
// speeds of a tick: t·(w + t·dt/2I).
Real torque_for(Real power, Real turning, Real inertia, Real dt) {
  const Real gain = dt / inertia;
  const Real root = length_real(turning, sqrt_real((power + power) * gain));
  return std::max(root - turning, Real{}) / gain;
}

}  // namespace

Angle lean_of(const WorldData& world, const Mat3& axes) {
  const Level level = level_of(world, axes);
  return level.exists ? lean_to(level, axes) : Angle{};
}

Balance balance_of(const WorldData& world, const VehicleRecord& vehicle, const Chassis& chassis,
                   std::span<const WheelContact> contacts) {
  const Level level = level_of(world, chassis.axes);
  const Stance stance = stance_of(world, chassis, level.ahead, contacts);
  if (!level.exists || stance.count == 0) return {};
  const Real weight =
      chassis.mass * level.gravity * Real::of(world.bodies[chassis.body].gravity_scale);
  if (weight <= Real{}) return {};
  // About the way ahead: through the centre of mass, which a sudden torque sees, and on the ground.
  const Real own = k_real_one / yield_to(world, chassis, level.ahead);
  const Real inertia = own + chassis.mass * stance.height * stance.height;
  // tan φ = v·ω / g, ω to the right
  const Real towards = -(stance.speed * dot_real(chassis.turning, level.up));
  const Angle aim =
      clamp(atan2_raw(towards.raw, level.gravity.raw), -vehicle.max_lean, vehicle.max_lean);
  const Real lean = Real::of(lean_to(level, chassis.axes));
  const Real leaning = dot_real(chassis.turning, level.ahead), dt = chassis.dt;
  const Real damping = std::min((inertia + inertia) * k_omega, own * k_most_damping / dt);
  const Real stiffness = Real{(damping * k_omega).raw / 2} + weight * stance.height;
  const Real most = weight * stance.height * Real::ratio(2, 1);
  // The spring and the damper give no more than they took.
  const Real free = clamp_real(-(lean * stiffness), -most, most) - leaning * damping;
  // The rest is paid for by the way ahead.
  const Real wanted = clamp_real(Real::of(aim) * stiffness, -most, most);
  const Real sign = wanted < Real{} ? -k_real_one : k_real_one;
  const Real speed = abs_real(stance.speed), payment = k_most_payment * weight;
  const Real torque =
      std::min(abs_real(wanted), torque_for(payment * speed, leaning * sign, own, dt));
  const Real gained = (free + torque * sign) * Real{dt.raw / 2} / own;
  const Real power = torque * (leaning + gained) * sign;
  const Real paid = power > Real{} && speed > Real{} ? std::min(power / speed, payment) : Real{};
  return {level.ahead * (free + torque * sign),
          level.ahead * (stance.speed > Real{} ? -paid : paid)};
}

}  // namespace lockstone
