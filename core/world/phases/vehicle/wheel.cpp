#include "core/world/phases/vehicle/wheel.h"

#include <lockstone/assert.h>
#include <lockstone/trigonometry.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/body/inertia.h"
#include "core/dynamics/state/surface.h"
#include "core/world/derived/quantities.h"
#include "core/world/query/world_queries.h"

namespace lockstone {
namespace {

// A steeper ground is a wall to a wheel: the least cosine between its normal and the chassis' up.
constexpr Real k_least_up = Real::ratio(3, 10);

Real3 turned(const Mat3& axes, const Real3& v) {
  return Real3::of(axes.x) * v.x + Real3::of(axes.y) * v.y + Real3::of(axes.z) * v.z;
}

// The x of the point about which a vehicle turns: the mean of the axles that are not steered.
Real pole_of(const VehicleRecord& vehicle) {
  Real sum{};
  std::int64_t count = 0;
  for (std::size_t i = 0; i < vehicle.axle_count; ++i) {
    if (vehicle.axles[i].max_steer != Angle{}) continue;
    sum = sum + Real::of(vehicle.axles[i].mount.x);
    ++count;
  }
  return count == 0 ? Real{} : Real{sum.raw / count};
}

struct Touch {
  BodyHandle body{};
  Vec3<Position> point{};
  Vec3<Unit> normal{};
  Real drop{};  // of the wheel's centre below its highest place
};

Touch cast_wheel(const WorldData& world, const VehicleRecord& vehicle, const Chassis& chassis,
                 std::size_t wheel) {
  const AxleRecord& axle = vehicle.axles[wheel / 2];
  const Vec3<Position> top =
      chassis.frame.position + rounded<Position>(rotate(chassis.axes, highest_centre(axle, wheel)));
  const Real radius = Real::of(axle.radius), travel = Real::of(axle.travel);
  const Real3 up = Real3::of(chassis.axes.y);
  const Vec3<Position> start = top + (up * radius).as<Position>();
  QueryFilter filter;
  filter.mask = vehicle.mask;
  filter.ignore = world.handle_of(chassis.body);
  if (vehicle.has(k_vehicle_casts_spheres)) {
    const Real way = travel + radius;
    const ShapeHit hit = first_hit(
        world, {Shape::sphere(axle.radius), {start, {}}, (up * -way).as<Length>()}, filter);
    return {hit.body, hit.point, hit.normal, Real::of(hit.fraction) * way - radius};
  }
  const Real way = travel + radius + radius;
  const RayHit hit = first_hit(world, Ray{start, (up * -way).as<Length>()}, filter);
  return {hit.body, hit.point, hit.normal, Real::of(hit.fraction) * way - radius - radius};
}

Real grip_of(const AxleRecord& axle, const BodyRecord& ground) {
  Surface tyre;
  tyre.friction = axle.friction;
  return Real::of(combined_friction(tyre, ground.surface()));
}

}  // namespace

Real3 unit_real(const Real3& v) {
  return Real3::of(direction_of(v.x.raw, v.y.raw, v.z.raw));
}

Real3 turning_of(const WorldData& world, std::uint32_t body) {
  const BodyRecord& record = world.bodies[body];
  if (record.spin == Vec3<Velocity>{}) return {};
  const Vec3<Velocity> w =
      surface_velocity(inverse_inertia(record, world.cache.rotation(body)), record.spin);
  const auto part = [&](Velocity v) {
    return Real{raw::scale_binary(v.raw, -record.scale_exponent)};
  };
  return {part(w.x), part(w.y), part(w.z)};
}

Real3 velocity_at(const WorldData& world, std::uint32_t body, const Vec3<Position>& point) {
  const BodyRecord& record = world.bodies[body];
  if (!record.is_awake()) return {};
  const Real3 arm = Real3::of(point - record.position);
  return Real3::of(record.velocity) + cross_real(turning_of(world, body), arm);
}

Chassis chassis_of(const WorldData& world, std::uint32_t body) {
  const BodyRecord& record = world.bodies[body];
  Chassis chassis;
  chassis.body = body;
  chassis.frame = shape_pose(world.cache.asset(body), {record.position, record.orientation});
  chassis.axes = to_matrix(chassis.frame.orientation);
  chassis.velocity = Real3::of(record.velocity);
  chassis.turning = turning_of(world, body);
  chassis.mass = Real::of(mass_of(record));
  chassis.moments = Real3::of(mass_data_of(record).inertia);
  chassis.dt = Real::ratio(1, world.def.tick_rate);
  return chassis;
}

Real yield_to(const WorldData& world, const Chassis& chassis, const Real3& torque) {
  constexpr Real k_least = Real::ratio(1, 1000);
  const Mat3& axes = world.cache.rotation(chassis.body);
  const auto part = [&](const Vec3<Unit>& axis, Real moment) {
    const Real along = dot_real(torque, Real3::of(axis));
    return along * along / std::max(moment, k_least);
  };
  return part(axes.x, chassis.moments.x) + part(axes.y, chassis.moments.y) +
         part(axes.z, chassis.moments.z);
}

// The wheels of an axle turn about a point at the height of the pole, L behind: with the angle δ of
// the axle's middle it is L / tan δ to the right.
Real3 heading_of(const VehicleRecord& vehicle, std::size_t wheel) {
  const AxleRecord& axle = vehicle.axles[wheel / 2];
  if (axle.max_steer == Angle{} || vehicle.steer == Unit{}) return {k_real_one, {}, {}};
  const Angle angle = (Real::of(axle.max_steer) * Real::of(vehicle.steer)).as<Angle>();
  const SinCos turn = sin_cos(angle);
  const Real sine = Real::of(turn.sin), cosine = Real::of(turn.cos);
  const Real ahead = Real::of(axle.mount.x) - pole_of(vehicle);
  constexpr Real k_near = Real::ratio(1, 100);
  if (abs_real(ahead) < k_near) return {cosine, {}, sine};
  const Real right = Real::of(axle.mount.z) +
                     (wheel % 2 == 0 ? -Real::of(axle.half_track) : Real::of(axle.half_track));
  const Real3 heading{ahead * cosine - right * sine, {}, ahead * sine};
  return unit_real(ahead < Real{} ? heading * -k_real_one : heading);
}

WheelContact find_ground(const WorldData& world, const VehicleRecord& vehicle,
                         const Chassis& chassis, std::size_t wheel, WheelRecord& record) {
  const AxleRecord& axle = vehicle.axles[wheel / 2];
  WheelContact contact;
  const Touch touch = cast_wheel(world, vehicle, chassis, wheel);
  const Real3 chassis_up = Real3::of(chassis.axes.y);
  contact.up = Real3::of(touch.normal);
  const Real slope = dot_real(contact.up, chassis_up);
  contact.exists = !touch.body.is_null() && slope >= k_least_up;
  record.is_grounded = contact.exists ? 1 : 0;
  record.compression = {};
  if (!contact.exists) return contact;
  record.compression = (Real::of(axle.travel) - touch.drop).as<Length>();
  contact.ground = touch.body;
  contact.point = touch.point;
  const Real3 heading = turned(chassis.axes, heading_of(vehicle, wheel));
  contact.ahead = unit_real(heading - contact.up * dot_real(contact.up, heading));
  contact.right = cross_real(contact.ahead, contact.up);
  const Real3 arm = Real3::of(touch.point - world.bodies[chassis.body].position);
  const Real3 velocity = chassis.velocity + cross_real(chassis.turning, arm) -
                         velocity_at(world, touch.body.index, touch.point);
  contact.speed_ahead = dot_real(velocity, contact.ahead);
  contact.speed_right = dot_real(velocity, contact.right);
  contact.closing = -dot_real(velocity, contact.up) / slope;
  contact.grip = grip_of(axle, world.bodies[touch.body.index]);
  return contact;
}

}  // namespace lockstone
