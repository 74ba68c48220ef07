// Commands that change the material and the limits of a body.

#include <algorithm>

#include "core/dynamics/body/motion.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/world_impl.h"

namespace lockstone {

bool to_surface_velocity(const Vec3<AngularVelocity>& omega, int exponent, Vec3<Velocity>& w) {
  constexpr AngularVelocity k_limit = AngularVelocity::from_integer(1 << 20);
  if (!is_within(omega, k_limit)) return false;
  for (int i = 0; i < 3; ++i)
    w[i].raw = raw::scale_binary(omega[i].raw, exponent);
  return is_within(w, k_speed_limit);
}

std::uint8_t locks_of(const AxisLocks& locks) {
  const bool bits[] = {locks.move_x, locks.move_y, locks.move_z,
                       locks.turn_x, locks.turn_y, locks.turn_z};
  unsigned result = 0;
  for (unsigned i = 0; i < 6; ++i)
    result |= static_cast<unsigned>(bits[i]) << i;
  return static_cast<std::uint8_t>(result);
}

AxisLocks axis_locks(std::uint8_t bits) {
  const auto bit = [&](int i) { return (bits >> i & 1) != 0; };
  return {bit(0), bit(1), bit(2), bit(3), bit(4), bit(5)};
}

void set_events(BodyRecord& record, const EventSettings& settings) {
  const auto set = [&](BodyFlag flag, bool on) {
    record.flags = static_cast<std::uint8_t>(on ? record.flags | flag : record.flags & ~flag);
  };
  set(k_body_no_contact_events, !settings.contacts);
  set(k_body_persist_events, settings.persist);
  record.hit_speed = settings.hit_speed;
}

void set_speed_limit(BodyRecord& record, const SpeedLimit& limit) {
  const auto bounded = [](std::int64_t speed) {
    constexpr std::int64_t k_least = 1, k_most = k_speed_limit.raw >> 12;
    return SolverVelocity::from_raw(
        static_cast<std::int32_t>(std::clamp(raw::round_shift(speed, 12), k_least, k_most)));
  };
  constexpr AngularVelocity k_any = AngularVelocity::from_integer(1 << 20);
  record.max_speed = bounded(min(limit.linear, k_speed_limit).raw);
  record.max_surface_speed =
      bounded(raw::scale_binary(min(limit.angular, k_any).raw, record.scale_exponent));
}

namespace {

// A component of ω × way, in the format of the surface's velocity.
std::int64_t turned_around(const SurfaceMotion& motion, const Vec3<Position>& way, int axis) {
  const auto product = [&](int turning, int along) {
    return raw::round_shift(
        raw::multiply_shift(way[along].raw, motion.turning[turning].raw, Rate::frac_bits),
        Position::frac_bits - SolverVelocity::frac_bits);
  };
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  return product(j, k) - product(k, j);
}

}  // namespace

void set_surface_motion(BodyRecord& record, const geometry::AssetGeometry* asset,
                        const SurfaceMotion& motion) {
  const Transform body = body_pose(asset, {});  // in the shape's frame
  const Mat3 axes = to_matrix(body.orientation);
  // v + ω × centre
  Vec3<SolverVelocity> at_centre;
  for (int i = 0; i < 3; ++i) {
    at_centre[i].raw = raw::saturate<std::int32_t>(motion.velocity[i].raw +
                                                   turned_around(motion, body.position, i));
    at_centre[i] = clamp(at_centre[i], SolverVelocity::from_integer(-1000),
                         SolverVelocity::from_integer(1000));
  }
  record.set_surface_motion(rotate_inverse(axes, at_centre), rotate_inverse(axes, motion.turning));
}

// v = v_c − ω × centre, both along the axes of the shape's frame.
SurfaceMotion surface_motion_of(const BodyRecord& record, const geometry::AssetGeometry* asset) {
  if (!record.has_surface_motion()) return {};
  const Transform body = body_pose(asset, {});  // in the shape's frame
  const Mat3 axes = to_matrix(body.orientation);
  SurfaceMotion motion{rotate(axes, record.surface_velocity()),
                       rotate(axes, record.surface_turning())};
  for (int i = 0; i < 3; ++i) {
    motion.velocity[i].raw = raw::saturate<std::int32_t>(motion.velocity[i].raw -
                                                         turned_around(motion, body.position, i));
  }
  return motion;
}

bool motion_to(const BodyRecord& body, const Transform& target, int tick_rate,
               Vec3<Velocity>& velocity, Vec3<Velocity>& spin) {
  const Vec3<RotationComponent> turn = rotation_between(body.orientation, target.orientation);
  constexpr std::int64_t k_far = std::int64_t{1} << 44;  // 4096 m in a tick
  for (int i = 0; i < 3; ++i) {
    const std::int64_t way = (target.position[i] - body.position[i]).raw;
    velocity[i].raw = std::clamp(way, -k_far, k_far) * tick_rate;
    spin[i].raw = raw::scale_binary(turn[i].raw * tick_rate, body.scale_exponent);
  }
  return is_within(velocity, k_speed_limit) && is_within(spin, k_speed_limit);
}

Status CommandExecutor::execute(const SetMaterial& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!geometry::is_valid(command.surface)) return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  record->set_surface(command.surface);
  return Status::ok;
}

Status CommandExecutor::execute(const SetSurfaceMotion& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (record->is_dynamic() || !is_valid(command.motion.velocity, command.motion.turning))
    return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  set_surface_motion(*record, world_.cache.asset(command.body.index), command.motion);
  return Status::ok;
}

Status CommandExecutor::execute(const SetGravityScale& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!is_within(command.scale, k_gravity_scale_limit)) return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  record->gravity_scale = command.scale;
  return Status::ok;
}

Status CommandExecutor::execute(const SetDamping& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (command.linear < Rate{} || command.angular < Rate{}) return Status::invalid_argument;
  record->linear_damping = command.linear;
  record->angular_damping = command.angular;
  return Status::ok;
}

Status CommandExecutor::execute(const SetAxisLocks& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->is_dynamic()) return Status::invalid_argument;
  BodyRecord locked = *record;
  locked.locks = locks_of(command.locks);
  if (!world_.joint_registry.fits(command.body.index, locked)) return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  const Vec3<Velocity> turning = surface_velocity(
      inverse_inertia(*record, world_.cache.rotation(command.body.index)), record->spin);
  record->locks = static_cast<std::uint8_t>(locked.locks | (record->locks & k_body_disabled));
  record->spin = spin_of(*record, world_.cache.rotation(command.body.index), turning);
  clamp_speed(record->spin);
  apply_axis_locks(*record);
  world_.refresh(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetSpeedLimit& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!is_valid(command.limit)) return Status::invalid_argument;
  set_speed_limit(*record, command.limit);
  return Status::ok;
}

Status CommandExecutor::execute(const SetEvents& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!is_hit_speed(command.settings.hit_speed)) return Status::invalid_argument;
  set_events(*record, command.settings);
  world_.cache.refresh_events(command.body.index, *record);
  return Status::ok;
}

Status CommandExecutor::execute(const MoveKinematic& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (record->is_dynamic() || !record->moves() || !is_within(command.position, k_world_limit) ||
      !has_direction(command.orientation)) {
    return Status::invalid_argument;
  }
  const Transform target =
      body_pose(world_.cache.asset(command.body.index), {command.position, command.orientation});
  Vec3<Velocity> velocity, spin;
  if (!motion_to(*record, target, world_.def.tick_rate, velocity, spin))
    return Status::invalid_argument;
  world_.waking.wake(command.body.index);
  record->velocity = velocity;
  record->spin = record->rotates() ? spin : Vec3<Velocity>{};
  world_.refresh(command.body.index);
  return Status::ok;
}

}  // namespace lockstone
