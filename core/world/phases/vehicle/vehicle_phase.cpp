#include "core/world/phases/vehicle/vehicle_phase.h"

#include <algorithm>
#include <array>

#include "core/world/commands/command_executor.h"
#include "core/world/phases/vehicle/drive_train.h"
#include "core/world/phases/vehicle/lean.h"
#include "core/world/phases/vehicle/wheel.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr Real k_two_pi{26986075409};  // 32 fraction bits
// Of the spring, beyond the wheel's travel.
constexpr Real k_stop_stiffness = Real::ratio(9, 1);

// The spring of a wheel: N/m, and N over m/s.
struct Spring {
  Real stiffness, damping;
};

// The mass that stands on each wheel of an axle: of two axles by the lever of the centre of mass,
// of others by their number.
Real mass_on_wheel(const VehicleRecord& vehicle, const Chassis& chassis, Real centre,
                   std::size_t axle) {
  const Real half{chassis.mass.raw / 2};
  if (vehicle.axle_count != 2) return Real{half.raw / vehicle.axle_count};
  const Real own = Real::of(vehicle.axles[axle].mount.x),
             other = Real::of(vehicle.axles[1 - axle].mount.x);
  const Real share = own == other ? Real::ratio(1, 2) : (centre - other) / (own - other);
  return half * clamp_real(share, Real::ratio(1, 20), Real::ratio(19, 20));
}

Spring spring_of(const AxleRecord& axle, Real mass) {
  const Real omega = k_two_pi * Real::of(axle.frequency);
  return {mass * omega * omega, (mass + mass) * omega * Real::of(axle.damping_ratio)};
}

// k·x in the middle of the tick and c·v, with the stop at the end of the travel. The middle makes a
// spring without a damper keep its energy: the map of a tick has determinant 1.
Real push_of(const Spring& spring, const AxleRecord& axle, const WheelContact& contact,
             const WheelRecord& wheel, Real dt) {
  const Real middle = Real::of(wheel.compression) + contact.closing * Real{dt.raw / 2};
  const Real beyond = std::max(Real::of(wheel.compression) - Real::of(axle.travel), Real{});
  return spring.stiffness * (middle + beyond * k_stop_stiffness) + spring.damping * contact.closing;
}

class VehicleTick {
 public:
  VehicleTick(World::Impl& world, VehicleRecord& vehicle)
      : world_(world), vehicle_(vehicle), chassis_(chassis_of(world, vehicle.chassis)) {}

  void run() {
    world_.moved.note_look(chassis_.body, chassis_.body);
    for (std::size_t i = 0; i < count(); ++i) {
      stand(i);
      if (contacts_[i].exists) world_.moved.note_look(chassis_.body, contacts_[i].ground.index);
    }
    load_wheels();
    shift(vehicle_);
    const auto forces = turn_wheels(vehicle_, contacts_, world_.def.tick_rate);
    for (std::size_t i = 0; i < count(); ++i)
      if (contacts_[i].exists) apply(i, forces[i]);
    if (vehicle_.has(k_vehicle_leans)) keep_balance();
  }

 private:
  [[nodiscard]] std::size_t count() const { return std::size_t{2} * vehicle_.axle_count; }

  // The wheels of an axle without a track are one.
  void stand(std::size_t i) {
    WheelRecord& wheel = vehicle_.wheels[i];
    if (i % 2 == 0 || vehicle_.axles[i / 2].half_track != Length{}) {
      contacts_[i] = find_ground(world_, vehicle_, chassis_, i, wheel);
      if (vehicle_.has(k_vehicle_leans) && contacts_[i].exists)
        contacts_[i].yield_right = yield_right(i);
      return;
    }
    contacts_[i] = contacts_[i - 1];
    wheel.compression = vehicle_.wheels[i - 1].compression;
    wheel.is_grounded = vehicle_.wheels[i - 1].is_grounded;
  }

  // Twice that of one force where two wheels are one.
  [[nodiscard]] Real yield_right(std::size_t i) const {
    const WheelContact& contact = contacts_[i];
    const Real3 arm = Real3::of(contact.point - world_.bodies[chassis_.body].position);
    const Real one = k_real_one / std::max(chassis_.mass, Real::ratio(1, 1000)) +
                     yield_to(world_, chassis_, cross_real(arm, contact.right));
    return vehicle_.axles[i / 2].half_track == Length{} ? one + one : one;
  }

  void load_wheels() {
    const Vec3<Position> apart = world_.bodies[chassis_.body].position - chassis_.frame.position;
    const Real centre = dot_real(Real3::of(apart), Real3::of(chassis_.axes.x));
    for (std::size_t axle = 0; axle < vehicle_.axle_count; ++axle) {
      const AxleRecord& record = vehicle_.axles[axle];
      const Spring spring = spring_of(record, mass_on_wheel(vehicle_, chassis_, centre, axle));
      const std::size_t left = 2 * axle, right = left + 1;
      WheelRecord *const l = &vehicle_.wheels[left], *const r = &vehicle_.wheels[right];
      const Real roll = spring.stiffness * Real::of(record.anti_roll) *
                        (Real::of(l->compression) - Real::of(r->compression));
      load(left, push_of(spring, record, contacts_[left], *l, chassis_.dt) + roll);
      load(right, push_of(spring, record, contacts_[right], *r, chassis_.dt) - roll);
    }
  }

  void load(std::size_t wheel, Real push) {
    vehicle_.wheels[wheel].load =
        contacts_[wheel].exists ? std::max(push, Real{}).as<Force>() : Force{};
  }

  void keep_balance() {
    const Balance balance =
        balance_of(world_, vehicle_, chassis_, std::span(contacts_).first(count()));
    const BodyHandle handle = world_.handle_of(chassis_.body);
    CommandExecutor commands(world_);
    (void)commands.execute(ApplyTorque{handle, balance.torque.as<Torque>(), Frame::world});
    (void)commands.execute(ApplyForce{handle, balance.force.as<Force>(), Frame::world});
  }

  // At the point of the ground, and against it.
  void apply(std::size_t wheel, const TyreForce& tyre) {
    const WheelContact& contact = contacts_[wheel];
    const Real3 force = contact.up * Real::of(vehicle_.wheels[wheel].load) +
                        contact.ahead * tyre.ahead + contact.right * tyre.right;
    push(chassis_.body, force, contact.point);
    if (world_.bodies[contact.ground.index].is_dynamic())
      push(contact.ground.index, force * -k_real_one, contact.point);
  }

  // A point too far away for a force counts as the centre of mass.
  void push(std::uint32_t body, const Real3& force, const Vec3<Position>& point) {
    const BodyHandle handle = world_.handle_of(body);
    const Vec3<Length> arm = saturated<Length>(point - world_.bodies[body].position);
    CommandExecutor commands(world_);
    const ApplyForceAt at{handle, force.as<Force>(), arm, Frame::world};
    if (commands.execute(at) == Status::ok) return;
    (void)commands.execute(ApplyForce{handle, at.force, Frame::world});
  }

  World::Impl& world_;
  VehicleRecord& vehicle_;
  const Chassis chassis_;
  std::array<WheelContact, k_max_wheels> contacts_{};
};

void drive_all(World::Impl& world) {
  for (std::uint32_t i = 0; i < world.header.vehicle_count; ++i) {
    VehicleRecord& vehicle = world.vehicles[i];
    const BodyRecord& chassis = world.bodies[vehicle.chassis];
    if (chassis.is_dynamic() && is_enabled(chassis)) VehicleTick(world, vehicle).run();
  }
}

}  // namespace

const VehiclePhase& vehicle_phase() {
  static constexpr VehiclePhase k_phase{&drive_all};
  return k_phase;
}

}  // namespace lockstone
