// Ranges of vehicles, and their records: checks of states need them apart from the phase.

#include <algorithm>

#include "core/world/phases/vehicle/vehicle_phase.h"

namespace lockstone {

const VehiclePhase* linked_vehicle_phase = nullptr;

namespace {

constexpr Torque k_most_torque = Torque::from_integer(1'000'000);
constexpr MomentOfInertia k_least_inertia = MomentOfInertia::from_ratio(1, 100),
                          k_most_inertia = MomentOfInertia::from_integer(1000);
constexpr AngularVelocity k_most_speed = AngularVelocity::from_integer(3000);
constexpr Number k_most_ratio = Number::from_integer(100);

template <class T>
bool is_between(T x, T low, T high) {
  return x >= low && x <= high;
}
bool is_torque(Torque x) {
  return is_between(x, Torque{}, k_most_torque);
}
bool is_share(Unit x) {
  return is_between(x, Unit{}, Unit::from_integer(1));
}

bool is_valid(const Axle& axle) {
  constexpr Length k_cm = Length::from_ratio(1, 100), k_far = Length::from_integer(32);
  const bool is_placed =
      std::max({abs(axle.mount.x), abs(axle.mount.y), abs(axle.mount.z)}) <= k_far;
  const bool has_wheels =
      is_between(axle.half_track, Length{}, Length::from_integer(16)) &&
      is_between(axle.radius, k_cm * 5, Length::from_integer(4)) &&
      is_between(axle.travel, k_cm, Length::from_integer(4)) &&
      is_between(axle.friction, Coefficient{}, Coefficient::from_ratio(199, 100));
  const bool has_springs =
      is_between(axle.frequency, Number::from_ratio(1, 5), Number::from_integer(10)) &&
      is_between(axle.damping_ratio, Number{}, Number::from_integer(2)) &&
      is_between(axle.anti_roll, Number{}, Number::from_integer(4));
  return is_placed && has_wheels && has_springs &&
         abs(axle.max_steer) <= Angle::from_ratio(12, 10) && is_share(axle.drive) &&
         is_torque(axle.brake) && is_torque(axle.handbrake) && is_torque(axle.differential_lock);
}

bool is_valid(const Tyre& tyre) {
  constexpr Unit k_least = Unit::from_ratio(1, 50), k_one = Unit::from_integer(1);
  return is_between(tyre.peak_slip, k_least, k_one) &&
         is_between(tyre.peak_angle, k_least, k_one) &&
         is_between(tyre.relaxation, Length::from_ratio(1, 10), Length::from_integer(4)) &&
         is_share(tyre.rolling_resistance);
}

bool is_valid(const Engine& engine) {
  return std::ranges::all_of(engine.torque, is_torque) &&
         is_between(engine.idle_speed, AngularVelocity::from_integer(1), engine.max_speed) &&
         engine.max_speed <= k_most_speed &&
         is_between(engine.inertia, k_least_inertia, k_most_inertia) && is_torque(engine.friction);
}

bool is_valid(const Gearbox& gearbox) {
  const auto is_ratio = [](Number x) { return is_between(x, Number{}, k_most_ratio); };
  const auto is_speed = [](AngularVelocity x) {
    return is_between(x, AngularVelocity{}, k_most_speed);
  };
  return std::ranges::all_of(gearbox.ratios, is_ratio) && is_ratio(gearbox.reverse) &&
         is_between(gearbox.final_drive, Number::from_ratio(1, 10), k_most_ratio) &&
         is_speed(gearbox.shift_up) && is_speed(gearbox.shift_down) && is_torque(gearbox.clutch) &&
         gearbox.shift_ticks <= 600;
}

AxleRecord axle_record_of(const Axle& axle) {
  return {axle.mount,         axle.half_track, axle.radius,           axle.travel, axle.frequency,
          axle.damping_ratio, axle.anti_roll,  axle.max_steer,        axle.drive,  axle.friction,
          axle.brake,         axle.handbrake,  axle.differential_lock};
}

Axle axle_of(const AxleRecord& axle) {
  return {axle.mount,         axle.half_track,        axle.radius,    axle.travel, axle.frequency,
          axle.damping_ratio, axle.anti_roll,         axle.max_steer, axle.drive,  axle.brake,
          axle.handbrake,     axle.differential_lock, axle.friction};
}

// The wheels of a side have one speed, and their tracks too.
bool has_alike_wheels(std::span<const Axle> axles) {
  return std::ranges::all_of(axles, [&](const Axle& a) { return a.radius == axles[0].radius; });
}

}  // namespace

bool is_valid(const VehicleDef& def) {
  if (def.axle_count < 1 || def.axle_count > k_max_axles || def.cast > WheelCast::sphere ||
      def.kind > VehicleKind::tracked)
    return false;
  const auto axles = std::span(def.axles).first(def.axle_count);
  if (def.kind == VehicleKind::tracked && !has_alike_wheels(axles)) return false;
  if (!is_between(def.max_lean, Angle{}, Angle::from_ratio(12, 10))) return false;
  return std::ranges::all_of(axles, [](const Axle& axle) { return is_valid(axle); }) &&
         is_valid(def.tyre) && is_valid(def.engine) && is_valid(def.gearbox) &&
         is_between(def.wheel_inertia, k_least_inertia, k_most_inertia);
}

VehicleRecord record_of(std::uint32_t chassis, const VehicleDef& def) {
  VehicleRecord record;
  record.chassis = chassis;
  record.axle_count = def.axle_count;
  for (std::size_t i = 0; i < def.axle_count; ++i)
    record.axles[i] = axle_record_of(def.axles[i]);
  record.torque = def.engine.torque;
  record.idle_speed = record.engine_speed = def.engine.idle_speed;
  record.max_speed = def.engine.max_speed;
  record.engine_inertia = def.engine.inertia;
  record.engine_friction = def.engine.friction;
  record.ratios = def.gearbox.ratios;
  record.reverse = def.gearbox.reverse;
  record.final_drive = def.gearbox.final_drive;
  record.shift_up = def.gearbox.shift_up;
  record.shift_down = def.gearbox.shift_down;
  record.clutch_torque = def.gearbox.clutch;
  record.shift_ticks = def.gearbox.shift_ticks;
  record.wheel_inertia = def.wheel_inertia;
  record.peak_slip = def.tyre.peak_slip;
  record.peak_angle = def.tyre.peak_angle;
  record.relaxation = def.tyre.relaxation;
  record.rolling_resistance = def.tyre.rolling_resistance;
  if (def.gearbox.automatic) record.flags |= k_vehicle_automatic;
  if (def.cast == WheelCast::sphere) record.flags |= k_vehicle_casts_spheres;
  record.mask = def.mask;
  if (def.kind == VehicleKind::tracked) record.flags |= k_vehicle_has_tracks;
  if (def.kind == VehicleKind::motorcycle) {
    record.flags |= k_vehicle_leans;
    record.max_lean = def.max_lean;
  }
  set_controls(record, {});
  return record;
}

VehicleDef def_of(const VehicleRecord& record) {
  VehicleDef def;
  def.axle_count = std::min(record.axle_count, k_max_axles);
  for (std::size_t i = 0; i < def.axle_count; ++i)
    def.axles[i] = axle_of(record.axles[i]);
  def.tyre = {record.peak_slip, record.peak_angle, record.relaxation, record.rolling_resistance};
  def.engine = {record.torque, record.idle_speed, record.max_speed, record.engine_inertia,
                record.engine_friction};
  def.gearbox = {
      record.ratios,   record.reverse,    record.final_drive,   record.has(k_vehicle_automatic),
      record.shift_up, record.shift_down, record.clutch_torque, record.shift_ticks};
  def.wheel_inertia = record.wheel_inertia;
  def.cast = record.has(k_vehicle_casts_spheres) ? WheelCast::sphere : WheelCast::ray;
  def.mask = record.mask;
  if (record.has(k_vehicle_has_tracks)) def.kind = VehicleKind::tracked;
  if (record.has(k_vehicle_leans)) {
    def.kind = VehicleKind::motorcycle;
    def.max_lean = record.max_lean;
  }
  return def;
}

void set_controls(VehicleRecord& record, const VehicleControls& controls) {
  constexpr Unit k_one = Unit::from_integer(1);
  record.throttle = clamp(controls.throttle, Unit{}, k_one);
  record.brake = clamp(controls.brake, Unit{}, k_one);
  record.handbrake = clamp(controls.handbrake, Unit{}, k_one);
  record.steer = clamp(controls.steer, -k_one, k_one);
  record.clutch = clamp(controls.clutch, Unit{}, k_one);
  record.wanted_gear = std::clamp(controls.gear, -1, static_cast<std::int32_t>(k_max_gears));
}

VehicleControls controls_of(const VehicleRecord& record) {
  return {record.throttle, record.brake,  record.handbrake,
          record.steer,    record.clutch, record.wanted_gear};
}

}  // namespace lockstone
