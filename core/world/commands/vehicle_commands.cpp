// The commands that make and drive vehicles.

#include "core/world/commands/command_executor.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/data/sorted_table.h"
#include "core/world/phases/vehicle/lean.h"
#include "core/world/phases/vehicle/vehicle_phase.h"
#include "core/world/phases/vehicle/wheel.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Before `main`: a program that links this file can load states with vehicles.
[[maybe_unused]] const bool k_links_vehicles = [] {
  linked_vehicle_phase = &vehicle_phase();
  return true;
}();

}  // namespace

bool can_be_chassis(const WorldData& world, std::uint32_t body) {
  return world.bodies[body].is_dynamic() && world.vehicles.size() > 0 &&
         (find_vehicle(world, body) != nullptr ||
          world.header.vehicle_count < world.vehicles.size());
}

Status CommandExecutor::execute(const SetVehicle& command) {
  if (world_.find(command.chassis) == nullptr) return Status::stale_handle;
  const std::uint32_t body = command.chassis.index;
  if (!command.def) {
    forget_vehicle_of(world_, body);
    return Status::ok;
  }
  if (!world_.bodies[body].is_dynamic() || !is_valid(*command.def)) return Status::invalid_argument;
  if (!set_record(world_.vehicles, world_.header.vehicle_count, record_of(body, *command.def)))
    return Status::capacity_exhausted;
  world_.waking.wake(body);
  world_.vehicle_phase = linked_vehicle_phase;
  return Status::ok;
}

Status CommandExecutor::execute(const DriveVehicle& command) {
  if (world_.find(command.chassis) == nullptr) return Status::stale_handle;
  VehicleRecord* vehicle = find_vehicle(world_, command.chassis.index);
  if (vehicle == nullptr) return Status::invalid_argument;
  set_controls(*vehicle, command.controls);
  return Status::ok;
}

/// The way of `vehicle_of` into a world.
class WorldVehicles {
 public:
  static const WorldData& of(const World& world) { return *world.impl_; }
};

std::optional<VehicleView> vehicle_of(const World& world, BodyHandle chassis) {
  const WorldData& data = WorldVehicles::of(world);
  if (data.find(chassis) == nullptr) return {};
  const VehicleRecord* record = find_vehicle(data, chassis.index);
  if (record == nullptr) return {};
  VehicleView view{def_of(*record), controls_of(*record), {}, record->engine_speed, record->gear};
  const Transform frame = pose_of(world, chassis);
  const Mat3 axes = to_matrix(frame.orientation);
  for (std::size_t i = 0; i < std::size_t{2} * record->axle_count; ++i) {
    const WheelRecord& wheel = record->wheels[i];
    view.wheels[i] = {frame.position + rounded<Position>(rotate(axes, centre_of_wheel(*record, i))),
                      wheel.spin,
                      wheel.compression,
                      wheel.load,
                      heading_of(*record, i).z.as<Unit>(),
                      wheel.is_grounded != 0};
  }
  view.lean = lean_of(data, axes);
  return view;
}

namespace {

constexpr std::array<std::int64_t, k_torque_points> k_torque_percent{55,  80, 95, 100,
                                                                     100, 96, 88, 70};

void set_torque(Engine& engine, Torque most) {
  for (std::size_t i = 0; i < k_torque_points; ++i)
    engine.torque[i] = Torque::from_raw(most.raw / 100 * k_torque_percent[i]);
}

void set_ratios(Gearbox& gearbox, const std::array<std::int64_t, 5>& hundredths) {
  for (std::size_t i = 0; i < hundredths.size(); ++i)
    gearbox.ratios[i] = Number::from_ratio(hundredths[i], 100);
}

}  // namespace

VehicleDef make_car(Length length, Length half_track, Length mount_height, Torque torque) {
  VehicleDef car;
  car.axle_count = 2;
  for (Axle& axle : std::span(car.axles).first(2)) {
    axle.half_track = half_track;
    axle.anti_roll = Number::from_ratio(1, 4);
  }
  car.axles[0].mount = {length / 2, mount_height, {}};
  car.axles[0].max_steer = Angle::from_ratio(6, 10);
  car.axles[1].mount = {-length / 2, mount_height, {}};
  car.axles[1].drive = Unit::from_integer(1);
  car.axles[1].handbrake = Torque::from_integer(4000);
  car.axles[1].differential_lock = Torque::from_integer(150);
  set_torque(car.engine, torque);
  set_ratios(car.gearbox, {340, 205, 138, 105, 84});
  return car;
}

// Each axle has two wheels in one place: inertia and brakes are halves.
VehicleDef make_motorcycle(Length length, Length mount_height, Torque torque) {
  VehicleDef cycle;
  cycle.kind = VehicleKind::motorcycle;
  cycle.axle_count = 2;
  for (Axle& axle : std::span(cycle.axles).first(2)) {
    axle.half_track = {};
    axle.radius = Length::from_ratio(31, 100);
    axle.travel = Length::from_ratio(15, 100);
    axle.frequency = Number::from_integer(2);
    axle.brake = Torque::from_integer(200);
  }
  cycle.axles[0].mount = {length / 2, mount_height, {}};
  cycle.axles[0].max_steer = Angle::from_ratio(5, 10);
  cycle.axles[1].mount = {-length / 2, mount_height, {}};
  cycle.axles[1].drive = Unit::from_integer(1);
  cycle.axles[1].handbrake = Torque::from_integer(200);
  cycle.wheel_inertia = MomentOfInertia::from_ratio(3, 10);
  cycle.engine.idle_speed = AngularVelocity::from_integer(120);
  cycle.engine.max_speed = AngularVelocity::from_integer(1000);
  cycle.engine.inertia = MomentOfInertia::from_ratio(5, 100);
  cycle.engine.friction = Torque::from_integer(12);
  cycle.gearbox.shift_up = AngularVelocity::from_integer(850);
  cycle.gearbox.shift_down = AngularVelocity::from_integer(400);
  cycle.gearbox.clutch = torque * 3;
  cycle.gearbox.final_drive = Number::from_ratio(45, 10);
  set_torque(cycle.engine, torque);
  set_ratios(cycle.gearbox, {260, 190, 150, 125, 110});
  return cycle;
}

VehicleDef make_tank(Length length, Length half_track, Length mount_height, Torque torque) {
  VehicleDef tank;
  tank.kind = VehicleKind::tracked;
  tank.axle_count = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    Axle& axle = tank.axles[i];
    axle.mount = {length / 2 - Length::from_raw(length.raw / 2 * static_cast<std::int32_t>(i)),
                  mount_height,
                  {}};
    axle.half_track = half_track;
    axle.radius = Length::from_ratio(35, 100);
    axle.frequency = Number::from_ratio(18, 10);
    axle.brake = axle.handbrake = torque * 6;
  }
  tank.axles[0].differential_lock = torque * 30;
  tank.wheel_inertia = MomentOfInertia::from_integer(20);
  tank.engine.idle_speed = AngularVelocity::from_integer(80);
  tank.engine.max_speed = AngularVelocity::from_integer(300);
  tank.engine.inertia = MomentOfInertia::from_integer(3);
  tank.engine.friction = torque / 8;
  tank.gearbox.shift_up = AngularVelocity::from_integer(260);
  tank.gearbox.shift_down = AngularVelocity::from_integer(110);
  tank.gearbox.reverse = Number::from_integer(8);
  tank.gearbox.clutch = torque * 2;
  tank.gearbox.final_drive = Number::from_integer(6);
  set_torque(tank.engine, torque);
  set_ratios(tank.gearbox, {800, 500, 320, 220, 150});
  return tank;
}

}  // namespace lockstone
