// Vehicles.
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_axle raw_of(const Axle& axle) {
  lks_axle raw{};
  raw.mount = c::raw_of(axle.mount);
  raw.half_track = axle.half_track.raw;
  raw.radius = axle.radius.raw;
  raw.travel = axle.travel.raw;
  raw.frequency = axle.frequency.raw;
  raw.damping_ratio = axle.damping_ratio.raw;
  raw.anti_roll = axle.anti_roll.raw;
  raw.max_steer = axle.max_steer.raw;
  raw.drive = axle.drive.raw;
  raw.friction = axle.friction.raw;
  raw.brake = axle.brake.raw;
  raw.handbrake = axle.handbrake.raw;
  raw.differential_lock = axle.differential_lock.raw;
  return raw;
}

Axle axle_of(const lks_axle& raw) {
  Axle axle;
  axle.mount = vec<Length>(raw.mount);
  axle.half_track.raw = raw.half_track;
  axle.radius.raw = raw.radius;
  axle.travel.raw = raw.travel;
  axle.frequency.raw = raw.frequency;
  axle.damping_ratio.raw = raw.damping_ratio;
  axle.anti_roll.raw = raw.anti_roll;
  axle.max_steer.raw = raw.max_steer;
  axle.drive.raw = raw.drive;
  axle.friction.raw = raw.friction;
  axle.brake.raw = raw.brake;
  axle.handbrake.raw = raw.handbrake;
  axle.differential_lock.raw = raw.differential_lock;
  return axle;
}

void put_engine(const Engine& engine, lks_vehicle_def& raw) {
  for (std::size_t i = 0; i < k_torque_points; ++i)
    raw.torque[i] = engine.torque[i].raw;
  raw.idle_speed = engine.idle_speed.raw;
  raw.max_speed = engine.max_speed.raw;
  raw.engine_inertia = engine.inertia.raw;
  raw.engine_friction = engine.friction.raw;
}

Engine engine_of(const lks_vehicle_def& raw) {
  Engine engine;
  for (std::size_t i = 0; i < k_torque_points; ++i)
    engine.torque[i].raw = raw.torque[i];
  engine.idle_speed.raw = raw.idle_speed;
  engine.max_speed.raw = raw.max_speed;
  engine.inertia.raw = raw.engine_inertia;
  engine.friction.raw = raw.engine_friction;
  return engine;
}

void put_gearbox(const Gearbox& gearbox, lks_vehicle_def& raw) {
  for (std::size_t i = 0; i < k_max_gears; ++i)
    raw.ratios[i] = gearbox.ratios[i].raw;
  raw.reverse = gearbox.reverse.raw;
  raw.final_drive = gearbox.final_drive.raw;
  raw.automatic = gearbox.automatic ? 1 : 0;
  raw.shift_ticks = gearbox.shift_ticks;
  raw.shift_up = gearbox.shift_up.raw;
  raw.shift_down = gearbox.shift_down.raw;
  raw.clutch = gearbox.clutch.raw;
}

Gearbox gearbox_of(const lks_vehicle_def& raw) {
  Gearbox gearbox;
  for (std::size_t i = 0; i < k_max_gears; ++i)
    gearbox.ratios[i].raw = raw.ratios[i];
  gearbox.reverse.raw = raw.reverse;
  gearbox.final_drive.raw = raw.final_drive;
  gearbox.automatic = flag(raw.automatic, "vehicle.automatic");
  gearbox.shift_ticks = raw.shift_ticks;
  gearbox.shift_up.raw = raw.shift_up;
  gearbox.shift_down.raw = raw.shift_down;
  gearbox.clutch.raw = raw.clutch;
  return gearbox;
}

lks_vehicle_def raw_of(const VehicleDef& def) {
  lks_vehicle_def raw{};
  raw.size = sizeof raw;
  raw.axle_count = def.axle_count;
  for (std::size_t i = 0; i < k_max_axles; ++i)
    raw.axles[i] = raw_of(def.axles[i]);
  raw.peak_slip = def.tyre.peak_slip.raw;
  raw.peak_angle = def.tyre.peak_angle.raw;
  raw.relaxation = def.tyre.relaxation.raw;
  raw.rolling_resistance = def.tyre.rolling_resistance.raw;
  put_engine(def.engine, raw);
  put_gearbox(def.gearbox, raw);
  raw.wheel_inertia = def.wheel_inertia.raw;
  raw.cast = static_cast<std::uint32_t>(def.cast);
  raw.mask = def.mask;
  raw.kind = static_cast<std::uint32_t>(def.kind);
  raw.max_lean = def.max_lean.raw;
  return raw;
}

VehicleDef vehicle_def_of(const lks_vehicle_def* from) {
  const lks_vehicle_def raw = take(from, raw_of(VehicleDef{}), "def");
  VehicleDef def;
  def.axle_count = raw.axle_count;
  for (std::size_t i = 0; i < k_max_axles; ++i)
    def.axles[i] = axle_of(raw.axles[i]);
  def.tyre = {Unit::from_raw(raw.peak_slip), Unit::from_raw(raw.peak_angle),
              Length::from_raw(raw.relaxation), Coefficient::from_raw(raw.rolling_resistance)};
  def.engine = engine_of(raw);
  def.gearbox = gearbox_of(raw);
  def.wheel_inertia.raw = raw.wheel_inertia;
  def.cast = enumerator(raw.cast, WheelCast::ray, WheelCast::sphere, "vehicle.cast");
  def.mask = raw.mask;
  def.kind = enumerator(raw.kind, VehicleKind::car, VehicleKind::tracked, "vehicle.kind");
  def.max_lean.raw = raw.max_lean;
  return def;
}

lks_vehicle_controls raw_of(const VehicleControls& controls) {
  lks_vehicle_controls raw{};
  raw.size = sizeof raw;
  raw.gear = controls.gear;
  raw.throttle = controls.throttle.raw;
  raw.brake = controls.brake.raw;
  raw.handbrake = controls.handbrake.raw;
  raw.steer = controls.steer.raw;
  raw.clutch = controls.clutch.raw;
  return raw;
}

VehicleControls controls_of(const lks_vehicle_controls* from) {
  const lks_vehicle_controls raw = take(from, raw_of(VehicleControls{}), "controls");
  return {Unit::from_raw(raw.throttle), Unit::from_raw(raw.brake),  Unit::from_raw(raw.handbrake),
          Unit::from_raw(raw.steer),    Unit::from_raw(raw.clutch), raw.gear};
}

lks_vehicle_view raw_of(const VehicleView& view) {
  lks_vehicle_view raw{};
  raw.size = sizeof raw;
  raw.gear = view.gear;
  raw.engine_speed = view.engine_speed.raw;
  raw.wheel_count = 2 * view.def.axle_count;
  raw.lean = view.lean.raw;
  for (std::size_t i = 0; i < raw.wheel_count; ++i) {
    const WheelView& wheel = view.wheels[i];
    raw.wheels[i] = {c::raw_of(wheel.centre),
                     wheel.spin.raw,
                     wheel.load.raw,
                     wheel.compression.raw,
                     wheel.steer_sin.raw,
                     wheel.is_grounded ? 1U : 0U,
                     0};
  }
  return raw;
}

}  // namespace

lks_status lks_vehicle_controls_init(lks_vehicle_controls* controls, size_t size) {
  return call([&] { give(raw_of(VehicleControls{}), controls, size, "controls"); });
}

lks_status lks_make_car(lks_length length, lks_length half_track, lks_length height,
                        lks_force torque, lks_vehicle_def* out, size_t size) {
  return call([&] {
    const VehicleDef car = make_car(Length::from_raw(length), Length::from_raw(half_track),
                                    Length::from_raw(height), Torque::from_raw(torque));
    give(raw_of(car), out, size, "out");
  });
}

lks_status lks_make_motorcycle(lks_length length, lks_length height, lks_force torque,
                               lks_vehicle_def* out, size_t size) {
  return call([&] {
    const VehicleDef cycle = make_motorcycle(Length::from_raw(length), Length::from_raw(height),
                                             Torque::from_raw(torque));
    give(raw_of(cycle), out, size, "out");
  });
}

lks_status lks_make_tank(lks_length length, lks_length half_track, lks_length height,
                         lks_force torque, lks_vehicle_def* out, size_t size) {
  return call([&] {
    const VehicleDef tank = make_tank(Length::from_raw(length), Length::from_raw(half_track),
                                      Length::from_raw(height), Torque::from_raw(torque));
    give(raw_of(tank), out, size, "out");
  });
}

lks_status lks_set_vehicle(lks_world* world, lks_body chassis, const lks_vehicle_def* def) {
  return call([&] {
    SetVehicle command{handle_of<BodyHandle>(chassis), {}};
    if (def != nullptr) command.def = vehicle_def_of(def);
    order(world, command);
  });
}

lks_status lks_drive_vehicle(lks_world* world, lks_body chassis,
                             const lks_vehicle_controls* controls) {
  return call([&] {
    order(world, DriveVehicle{handle_of<BodyHandle>(chassis), controls_of(controls)});
  });
}

lks_status lks_vehicle_get(const lks_world* world, lks_body chassis, lks_vehicle_view* out) {
  return call([&] {
    const World& from = read(world);
    const std::uint32_t size = required(out, "out").size;
    const std::optional<VehicleView> view = vehicle_of(from, existing_body(from, chassis));
    if (!view) throw_invalid("chassis", "must be the chassis of a vehicle");
    give(raw_of(*view), out, size, "out");
  });
}
