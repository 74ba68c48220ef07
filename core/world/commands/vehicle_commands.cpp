// The commands that make and drive vehicles.

#include "core/world/commands/command_executor.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/data/sorted_table.h"
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
  return view;
}

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
  constexpr std::int64_t k_percent[] = {55, 80, 95, 100, 100, 96, 88, 70};
  for (std::size_t i = 0; i < k_torque_points; ++i)
    car.engine.torque[i] = Torque::from_raw(torque.raw / 100 * k_percent[i]);
  constexpr std::int64_t k_ratios[] = {340, 205, 138, 105, 84};  // hundredths
  for (std::size_t i = 0; i < std::size(k_ratios); ++i)
    car.gearbox.ratios[i] = Number::from_ratio(k_ratios[i], 100);
  return car;
}

}  // namespace lockstone
