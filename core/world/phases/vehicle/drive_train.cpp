#include "core/world/phases/vehicle/drive_train.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/world/phases/vehicle/tyre_curve.h"

namespace lockstone {
namespace {

// Parts of a tick so short that a wheel's turning follows the tyre's force.
constexpr std::uint32_t k_parts_a_second = 480;

// Slip beyond the best that a tyre at rest remembers, so that it lets go soon.
constexpr Real k_kept_slip = Real::ratio(5, 4);
constexpr Real k_most_slip = Real::ratio(8, 1);
// m/s: below it a tyre is damped, by its deflection of the time before.
constexpr Real k_slow = Real::ratio(1, 1);
constexpr Real k_damping_time = Real::ratio(3, 100);
constexpr Real k_least_speed = Real::ratio(3, 1);

Real spin_of(const WheelRecord& wheel) {
  return {wheel.spin.raw};
}

// The numbers of a wheel that stay through a tick.
struct Turning {
  Real radius, inertia, drive, brake, lock;
  Real spin_gain;           // dt / inertia
  Real kept;                // of the tyre's deflection in a part: 1 / (1 + |V|·dt/σ)
  Real damping;             // s
  Real steady_u, steady_w;  // steady slip over slip speed, 1 where the tyre grips best
  Real slowed;              // by brakes in a part
};

class DriveTrain {
 public:
  DriveTrain(VehicleRecord& vehicle, std::span<const WheelContact> contacts, Real dt)
      : vehicle_(vehicle),
        contacts_(contacts),
        dt_(dt),
        inverse_best_u_(k_real_one / (Real::of(vehicle.relaxation) * Real::of(vehicle.peak_slip))),
        inverse_best_w_(k_real_one /
                        (Real::of(vehicle.relaxation) * Real::of(vehicle.peak_angle))) {
    for (std::size_t i = 0; i < count(); ++i) {
      turnings_[i] = turning_of(i);
      speeds_right_[i] = contacts_[i].speed_right;
    }
    gear_ = ratio();
    share_work();
  }

  // One part of a tick; adds the forces.
  void advance(std::span<TyreForce> forces) {
    std::array<Real, k_max_wheels> torques{};
    vehicle_.has(k_vehicle_has_tracks) ? drive_tracks(torques) : drive(torques);
    for (std::size_t i = 0; i < count(); ++i) {
      const TyreForce force = pull(i);
      forces[i] = {forces[i].ahead + force.ahead, forces[i].right + force.right};
      speeds_right_[i] = speeds_right_[i] + force.right * (contacts_[i].yield_right * dt_);
      torques[i] = torques[i] - force.ahead * turnings_[i].radius;
      if (!vehicle_.has(k_vehicle_has_tracks)) turn(vehicle_.wheels[i], turnings_[i], torques[i]);
    }
    if (!vehicle_.has(k_vehicle_has_tracks)) return;
    turn_side(0, torques);
    turn_side(1, torques);
    hold_ratio();
  }

 private:
  [[nodiscard]] std::size_t count() const { return std::size_t{2} * vehicle_.axle_count; }

  [[nodiscard]] Turning turning_of(std::size_t i) const {
    const AxleRecord& axle = vehicle_.axles[i / 2];
    const Real load = Real::of(vehicle_.wheels[i].load);
    Turning turning;
    turning.radius = Real::of(axle.radius);
    turning.drive = Real{Real::of(axle.drive).raw / 2};
    turning.lock = Real::of(axle.differential_lock);
    turning.brake = Real::of(axle.brake) * Real::of(vehicle_.brake) +
                    Real::of(axle.handbrake) * Real::of(vehicle_.handbrake) +
                    Real::of(vehicle_.rolling_resistance) * load * turning.radius;
    // A lighter wheel would swing against its tyre faster than the parts of a tick follow.
    const Real stiffness = contacts_[i].grip * load * k_steepest_grip /
                           (Real::of(vehicle_.peak_slip) * Real::of(vehicle_.relaxation));
    const Real least = stiffness * (turning.radius * dt_) * (turning.radius * dt_);
    turning.inertia = std::max(Real::of(vehicle_.wheel_inertia), least);
    turning.spin_gain = dt_ / turning.inertia;
    turning.slowed = turning.brake * turning.spin_gain;
    const Real speed = abs_real(contacts_[i].speed_ahead), over = std::max(speed, k_least_speed);
    turning.kept = k_real_one / (k_real_one + speed * dt_ / Real::of(vehicle_.relaxation));
    turning.damping = k_damping_time * (k_slow / (k_slow + speed));
    turning.steady_u = k_real_one / (over * Real::of(vehicle_.peak_slip));
    turning.steady_w = k_real_one / (over * Real::of(vehicle_.peak_angle));
    return turning;
  }

  // Deflects the tyre by its slip, and returns its force: du/dt + |V|·u/σ = slip speed, after
  // Pacejka, "Tire and Vehicle Dynamics", section 7.2.
  TyreForce pull(std::size_t i) {
    const WheelContact& contact = contacts_[i];
    WheelRecord& wheel = vehicle_.wheels[i];
    if (!contact.exists) {
      wheel.slip_along = wheel.slip_across = {};
      return {};
    }
    const Turning& turning = turnings_[i];
    const Real along = contact.speed_ahead - spin_of(wheel) * turning.radius;
    const Real across = speeds_right_[i];
    Real u = (Real::of(wheel.slip_along) + along * dt_) * turning.kept;
    Real w = (Real::of(wheel.slip_across) + across * dt_) * turning.kept;
    bound(u, w, along * turning.steady_u, across * turning.steady_w);
    wheel.slip_along = u.as<Position>();
    wheel.slip_across = w.as<Position>();
    const Grip grip = grip_of((u + along * turning.damping) * inverse_best_u_,
                              (w + across * turning.damping) * inverse_best_w_);
    const Real most = -(contact.grip * Real::of(wheel.load));
    return {most * grip.along, most * grip.across};
  }

  // `steady_u`, `steady_w`: the slip at which the deflection would stay, 1 where the tyre grips
  // best. Roots are drawn only where the bound may matter: none is above the sum of the parts.
  void bound(Real& u, Real& w, Real steady_u, Real steady_w) const {
    const Real part_u = abs_real(u * inverse_best_u_), part_w = abs_real(w * inverse_best_w_);
    if (part_u + part_w <= k_kept_slip) return;
    const Real slip = length_real(part_u, part_w);
    if (slip <= k_kept_slip) return;
    const Real most = clamp_real(length_real(steady_u, steady_w), k_kept_slip, k_most_slip);
    if (slip <= most) return;
    const Real part = most / slip;
    u = u * part;
    w = w * part;
  }

  // Brakes and rolling resistance slow a wheel, and hold it.
  static void turn(WheelRecord& wheel, const Turning& turning, Real torque) {
    const Real spin = spin_of(wheel) + torque * turning.spin_gain, slowed = turning.slowed;
    const Real left = abs_real(spin) <= slowed ? Real{}
                      : spin > Real{}          ? spin - slowed
                                               : spin + slowed;
    wheel.spin = AngularVelocity::from_raw(left.raw);
  }

  // Engine over wheels.
  [[nodiscard]] Real ratio() const {
    if (vehicle_.gear == 0 || vehicle_.shifting != 0) return {};
    const Real last = Real::of(vehicle_.final_drive);
    if (vehicle_.gear < 0) return -(Real::of(vehicle_.reverse) * last);
    return Real::of(vehicle_.ratios[static_cast<std::size_t>(vehicle_.gear - 1)]) * last;
  }

  // The share of each wheel in the torque of the drive, and the inertia of the driven wheels.
  void share_work() {
    Real share{};
    for (std::size_t i = 0; i < count(); ++i) {
      share = share + turnings_[i].drive;
      if (turnings_[i].drive > Real{}) driven_inertia_ = driven_inertia_ + turnings_[i].inertia;
    }
    share_ = share;
    for (std::size_t i = 0; i < count(); ++i)
      shares_[i] = share > Real{} ? turnings_[i].drive / share : Real{};
    if (!vehicle_.has(k_vehicle_has_tracks)) reduced_ = reduced_inertia(driven_inertia_);
  }

  // Of the engine and a shaft beyond the gear, by their difference of speed.
  [[nodiscard]] Real reduced_inertia(Real shaft) const {
    if (gear_ == Real{}) return {};
    const Real engine = Real::of(vehicle_.engine_inertia), beyond = shaft / (gear_ * gear_);
    return engine * beyond / (engine + beyond);
  }

  // The torque of the engine goes through the clutch to the wheels.
  void drive(std::span<Real> torques) {
    Real carrier{};
    for (std::size_t i = 0; i < count(); ++i)
      carrier = carrier + turnings_[i].drive * spin_of(vehicle_.wheels[i]);
    const Real torque =
        share_ > Real{} ? turn_engine(carrier / share_, reduced_, gear_) : turn_engine({}, {}, {});
    for (std::size_t i = 0; i < count(); ++i)
      torques[i] = torque * shares_[i];
    for (std::size_t i = 0; i + 1 < count(); i += 2)
      lock(i, torques);
  }

  // Through the clutch to a shaft that turns at the speed `carrier`. Returns the torque on the
  // shaft, none in gear 0.
  [[nodiscard]] Real turn_engine(Real carrier, Real reduced, Real gear) {
    const Real engine_torque = torque_of_engine(), engine = Real::of(vehicle_.engine_inertia);
    Real through{};
    if (gear != Real{}) {
      const Real turns = carrier * gear;
      const Real wanted = (Real{vehicle_.engine_speed.raw} - turns) * reduced / (dt_ + dt_);
      const Real most = Real::of(vehicle_.clutch_torque) * grip_of_clutch(turns);
      through = clamp_real(wanted, -most, most);
    }
    const Real speed = Real{vehicle_.engine_speed.raw} + (engine_torque - through) * dt_ / engine;
    vehicle_.engine_speed = AngularVelocity::from_raw(std::max(speed, Real{}).raw);
    return through * gear;
  }

  // The ratio a : b of the sides' speeds, left and right, that the steering gear wants.
  struct Steering {
    Real a, b;
  };
  [[nodiscard]] Steering steering() const {
    const Real steer = Real::of(vehicle_.steer), twice = steer + steer;
    return {k_real_one + std::min(twice, Real{}), k_real_one - std::max(twice, Real{})};
  }

  // The torques on the sides do the work of the shaft's, T: a·T/(a² + b²) and b·T/(a² + b²) where
  // it turns at (a·l + b·r)/(a² + b²).
  void drive_tracks(std::span<Real> torques) {
    const auto [a, b] = steering();
    const Real left = spin_of(vehicle_.wheels[0]), right = spin_of(vehicle_.wheels[1]);
    const Real squares = a * a + b * b;
    const Real inertia = a * a * inertia_of_side(0) + b * b * inertia_of_side(1);
    const Real torque =
        turn_engine((a * left + b * right) / squares, reduced_inertia(inertia), gear_) / squares;
    torques[0] = a * torque;
    torques[1] = b * torque;
  }

  [[nodiscard]] Real inertia_of_side(std::size_t side) const {
    Real inertia{};
    for (std::size_t i = side; i < count(); i += 2)
      inertia = inertia + turnings_[i].inertia;
    return inertia;
  }

  // Torques b·M and −a·M of the steering gear on the sides: they only slow.
  void hold_ratio() {
    const auto [a, b] = steering();
    const Real left = spin_of(vehicle_.wheels[0]), right = spin_of(vehicle_.wheels[1]);
    const Real yield_left = b / inertia_of_side(0), yield_right = a / inertia_of_side(1);
    const Real most = turnings_[0].lock * dt_;
    const Real held =
        clamp_real((a * right - b * left) / (b * yield_left + a * yield_right), -most, most);
    set_spin(0, left + yield_left * held);
    set_spin(1, right - yield_right * held);
  }

  void set_spin(std::size_t side, Real spin) {
    for (std::size_t i = side; i < count(); i += 2)
      vehicle_.wheels[i].spin = AngularVelocity::from_raw(spin.raw);
  }

  // The wheels of a side are on one shaft.
  void turn_side(std::size_t side, std::span<const Real> torques) {
    Real torque{}, brake{};
    for (std::size_t i = side; i < count(); i += 2) {
      torque = torque + torques[i];
      brake = brake + turnings_[i].brake;
    }
    Turning turning;
    turning.spin_gain = dt_ / inertia_of_side(side);
    turning.slowed = brake * turning.spin_gain;
    turn(vehicle_.wheels[side], turning, torque);
    set_spin(side, spin_of(vehicle_.wheels[side]));
  }

  // From the faster wheel of an axle to the slower one.
  void lock(std::size_t left, std::span<Real> torques) const {
    const Real most = turnings_[left].lock;
    const Real apart = spin_of(vehicle_.wheels[left]) - spin_of(vehicle_.wheels[left + 1]);
    const Real wanted{(apart * turnings_[left].inertia / dt_).raw / 4};
    const Real moved = clamp_real(wanted, -most, most);
    torques[left] = torques[left] - moved;
    torques[left + 1] = torques[left + 1] + moved;
  }

  // It opens where the engine would stall: `turns` is the speed that the wheels give it.
  [[nodiscard]] Real grip_of_clutch(Real turns) const {
    const Real pressed = k_real_one - Real::of(vehicle_.clutch);
    const Real idle{vehicle_.idle_speed.raw};
    if (turns >= idle) return pressed;
    const Real above = Real{vehicle_.engine_speed.raw} / idle - Real::ratio(105, 100);
    return pressed * clamp_real(above + above, Real{}, k_real_one);
  }

  // The governor keeps the engine turning, and stops it at its greatest speed.
  [[nodiscard]] Real torque_of_engine() const {
    const Real speed{vehicle_.engine_speed.raw}, most{vehicle_.max_speed.raw};
    const Real idle{vehicle_.idle_speed.raw};
    Real throttle = speed >= most ? Real{} : Real::of(vehicle_.throttle);
    const Real below = (idle - speed) * Real::ratio(8, 1) / idle;
    throttle = std::max(throttle, clamp_real(below, Real{}, k_real_one));
    const Real part = speed / most, drag = Real::of(vehicle_.engine_friction) * part;
    return throttle * full_torque(part) - drag * (k_real_one - throttle);
  }

  [[nodiscard]] Real full_torque(Real part) const {
    const Real at = clamp_real(part, Real{}, k_real_one) * Real::ratio(k_torque_points - 1, 1);
    const auto low =
        std::min<std::size_t>(static_cast<std::size_t>(at.raw >> 32), k_torque_points - 2);
    const Real rest = at - Real::ratio(static_cast<std::int64_t>(low), 1);
    const Real a = Real::of(vehicle_.torque[low]), b = Real::of(vehicle_.torque[low + 1]);
    return a + (b - a) * rest;
  }

  VehicleRecord& vehicle_;
  std::span<const WheelContact> contacts_;
  Real dt_;
  Real inverse_best_u_, inverse_best_w_;  // 1 / deflection where the tyre grips best
  Real gear_{}, share_{}, driven_inertia_{}, reduced_{};
  std::array<Real, k_max_wheels> shares_{};
  std::array<Turning, k_max_wheels> turnings_{};
  // Of a motorcycle they follow the forces: it is light to turn about its way ahead.
  std::array<Real, k_max_wheels> speeds_right_{};
};

std::int32_t top_gear(const VehicleRecord& vehicle) {
  const auto end = std::ranges::find(vehicle.ratios, Number{});
  return static_cast<std::int32_t>(end - vehicle.ratios.begin());
}

// Of an automatic gearbox ahead: up and down by the engine's speed.
std::int32_t automatic_gear(const VehicleRecord& vehicle) {
  const std::int32_t now = std::max(vehicle.gear, 1);
  if (vehicle.engine_speed > vehicle.shift_up) return std::min(now + 1, top_gear(vehicle));
  if (vehicle.engine_speed < vehicle.shift_down) return std::max(now - 1, 1);
  return now;
}

}  // namespace

void shift(VehicleRecord& vehicle) {
  if (vehicle.shifting > 0) {
    --vehicle.shifting;
    return;
  }
  const bool chooses = vehicle.has(k_vehicle_automatic) && vehicle.wanted_gear > 0;
  const std::int32_t gear =
      chooses ? automatic_gear(vehicle) : std::clamp(vehicle.wanted_gear, -1, top_gear(vehicle));
  if (gear == vehicle.gear) return;
  vehicle.gear = gear;
  vehicle.shifting = vehicle.shift_ticks;
}

std::array<TyreForce, k_max_wheels> turn_wheels(VehicleRecord& vehicle,
                                                std::span<const WheelContact> contacts,
                                                std::uint32_t tick_rate) {
  LKS_ASSERT(contacts.size() >= std::size_t{2} * vehicle.axle_count);
  const std::int64_t parts = (k_parts_a_second + tick_rate - 1) / tick_rate;
  DriveTrain train(vehicle, contacts, Real::ratio(1, parts * tick_rate));
  std::array<TyreForce, k_max_wheels> forces{};
  for (std::int64_t i = 0; i < parts; ++i)
    train.advance(forces);
  for (TyreForce& force : forces)
    force = {Real{force.ahead.raw / parts}, Real{force.right.raw / parts}};
  return forces;
}

}  // namespace lockstone
