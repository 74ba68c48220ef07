// Commands: checked in full, then applied at once.

#include <algorithm>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/state/limits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/solid.h"
#include "core/math/block_float.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

bool is_valid(const BodyDef& def) {
  return (def.motion == MotionType::static_body || def.motion == MotionType::kinematic ||
          def.motion == MotionType::dynamic) &&
         validate(def.shape) == Status::ok && is_within(def.position, k_world_limit) &&
         has_direction(def.orientation) && is_within(def.velocity, k_speed_limit) &&
         geometry::is_valid(def.material.surface()) && def.material.density > Density{} &&
         is_valid(def.surface_motion.velocity, def.surface_motion.turning) &&
         (def.motion != MotionType::dynamic || def.surface_motion == SurfaceMotion{}) &&
         is_within(def.gravity_scale, k_gravity_scale_limit) && def.linear_damping >= Rate{} &&
         def.angular_damping >= Rate{} && is_valid(def.speed_limit) &&
         is_hit_speed(def.events.hit_speed);
}

// A shape without volume cannot be dynamic, and only triangles without one can be kinematic.
// Lighter or heavier bodies would leave the formats of the solver.
bool has_valid_mass(const BodyDef& def, const geometry::AssetGeometry* asset) {
  if (!may_have(def.motion, def.shape, asset)) return false;
  return def.motion != MotionType::dynamic ||
         has_valid_mass_data({mass_of(def, asset), def.mass.inertia},
                             properties_of(def.shape, asset).scale_exponent);
}

BodyRecord make_record(const BodyDef& def, const geometry::AssetGeometry* asset,
                       std::uint32_t generation) {
  BodyRecord record;
  const Transform pose = body_pose(asset, {def.position, def.orientation});
  record.position = pose.position;
  record.orientation = pose.orientation;
  set_recycling_pose(record);
  record.user_data = def.user_data;
  record.size = def.shape.size;
  record.asset = def.shape.asset;
  record.gravity_scale = def.gravity_scale;
  record.linear_damping = def.linear_damping;
  record.angular_damping = def.angular_damping;
  record.set_surface(def.material.surface());
  record.category = def.filter.category;
  record.mask = def.filter.mask;
  record.group = def.filter.group;
  record.generation = generation;
  record.motion = static_cast<std::uint8_t>(def.motion);
  record.shape_kind = static_cast<std::uint8_t>(def.shape.kind);
  record.flags = static_cast<std::uint8_t>((def.is_trigger ? k_body_trigger : 0) |
                                           (def.is_bullet ? k_body_bullet : 0) |
                                           (def.allow_sleep ? 0 : k_body_no_sleep));
  record.locks =
      static_cast<std::uint8_t>(locks_of(def.locks) | (def.fixed_rotation ? k_lock_turning : 0));
  set_solid(record, properties_of(def.shape, asset, def.motion));
  if (record.is_dynamic()) set_mass_data(record, {mass_of(def, asset), def.mass.inertia});
  set_speed_limit(record, def.speed_limit);
  set_events(record, def.events);
  if (!record.is_dynamic()) set_surface_motion(record, asset, def.surface_motion);
  return record;
}

bool has_centre_in_world(const BodyDef& def, const geometry::AssetGeometry* asset) {
  return is_within(body_pose(asset, {def.position, def.orientation}).position, k_world_limit);
}

}  // namespace

Result<const Asset*> asset_of(const Shape& shape, const AssetSet& assets) {
  if (!is_asset(shape.kind)) return nullptr;
  const Asset* asset = assets.find(shape.asset);
  if (asset == nullptr) return Status::not_found;
  if (asset->kind() != shape.kind) return Status::invalid_argument;
  return asset;
}

Mass mass_of(const Shape& shape, const geometry::AssetGeometry* asset, Density density) {
  if (asset == nullptr) return mass_of(shape, density);
  return multiply_saturating<Mass>(density, asset->solid()->volume);
}

Mass mass_of(const BodyDef& def, const geometry::AssetGeometry* asset) {
  if (def.mass.mass != Mass{}) return def.mass.mass;
  return mass_of(def.shape, asset, def.material.density);
}

Result<BodyHandle> BodyRegistry::create(const BodyDef& body_def) {
  if (!is_valid(body_def)) return Status::invalid_argument;
  const Result<const Asset*> found = asset_of(body_def.shape, *world_.assets);
  if (!found.ok()) return found.status();
  const geometry::AssetGeometry* asset = geometry::geometry_of(found.value());
  Vec3<Velocity> surface;
  if (!has_valid_mass(body_def, asset) || !has_centre_in_world(body_def, asset) ||
      !to_surface_velocity(body_def.angular_velocity,
                           properties_of(body_def.shape, asset, body_def.motion).scale_exponent,
                           surface)) {
    return Status::invalid_argument;
  }
  std::uint32_t slot = free_hint_;
  while (slot < world_.header.body_limit && !is_free(world_.bodies[slot]))
    ++slot;
  if (slot == world_.def.body_capacity) return Status::capacity_exhausted;
  free_hint_ = slot + 1;
  world_.header.body_limit = std::max(world_.header.body_limit, slot + 1);

  world_.hashes.bodies.mark(slot);
  BodyRecord& record = world_.bodies[slot];
  record = make_record(body_def, asset, record.generation + 1);
  world_.cache.set_asset(slot, asset);
  if (record.moves()) {
    record.velocity = body_def.velocity;
    record.spin = spin_of(record, to_matrix(record.orientation), surface);
    clamp_speed(record.spin);
    apply_axis_locks(record);
    world_.awake.insert(slot);
  }
  begin_rest(record, flags_.rest_rules());
  world_.refresh(slot);
  waking_.disturb_around(slot);
  names_.forget(world_.handle_of(slot));
  return world_.handle_of(slot);
}

Status BodyRegistry::destroy(BodyHandle body) {
  const BodyRecord* record = world_.edit(body);
  if (record == nullptr) return Status::stale_handle;
  const std::uint32_t index = body.index;
  waking_.disturb(index);
  joints_.destroy_all_of(index);
  forget_rules_of(world_, index);
  forget_vehicle_of(world_, index);
  flags_.forget(index);
  drop_contacts_of(index);
  world_.broad_phase.remove(index);
  world_.triggers.erase(index);
  world_.cache.forget_events(index);
  BodyRecord empty;
  empty.generation = record->generation;
  world_.bodies[index] = empty;
  if (forget_terrain_of(world_, index)) refresh_terrain(world_);
  free_hint_ = std::min(free_hint_, index);
  return Status::ok;
}

void BodyRegistry::drop_contacts_of(std::uint32_t body) {
  world_.contacts.drop_active_of(body);
  world_.header.contact_count = world_.contacts.count();
}

Status CommandExecutor::execute(const CreateBody& command) {
  return world_.body_registry.create(command.def).status();
}

Status CommandExecutor::execute(const DestroyBody& command) {
  return world_.body_registry.destroy(command.body);
}

Status CommandExecutor::execute(const Teleport& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!is_within(command.position, k_world_limit) || !has_direction(command.orientation)) {
    return Status::invalid_argument;
  }
  const Transform pose =
      body_pose(world_.cache.asset(command.body.index), {command.position, command.orientation});
  if (!is_within(pose.position, k_world_limit)) return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  world_.body_registry.drop_contacts_of(command.body.index);
  record->position = pose.position;
  record->orientation = pose.orientation;
  record->loose_time = 0;
  set_recycling_pose(*record);
  begin_rest(*record, world_.sleep_flags.rest_rules());
  world_.refresh(command.body.index);
  world_.joint_registry.restart_joints_of(command.body.index);
  world_.waking.disturb_around(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetVelocity& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves() || !is_within(command.velocity, k_speed_limit)) {
    return Status::invalid_argument;
  }
  world_.waking.wake(command.body.index);
  record->velocity = command.velocity;
  apply_axis_locks(*record);
  world_.refresh(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetAngularVelocity& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  Vec3<Velocity> surface;
  if (!record->moves() ||
      !to_surface_velocity(command.angular_velocity, record->scale_exponent, surface)) {
    return Status::invalid_argument;
  }
  world_.waking.wake(command.body.index);
  record->spin = spin_of(*record, world_.cache.rotation(command.body.index), surface);
  clamp_speed(record->spin);
  world_.refresh(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetFilter& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  world_.waking.disturb(command.body.index);
  record->category = command.filter.category;
  record->mask = command.filter.mask;
  record->group = command.filter.group;
  world_.refresh(command.body.index);
  world_.waking.disturb_around(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetUserData& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  record->user_data = command.user_data;
  return Status::ok;
}

Status CommandExecutor::execute(const SetGravity& command) {
  if (!is_valid_gravity(command.gravity)) return Status::invalid_argument;
  if (world_.header.gravity != command.gravity) world_.waking.wake_all();
  world_.header.gravity = command.gravity;
  return Status::ok;
}

Status CommandExecutor::execute(const WakeBody& command) {
  const BodyRecord* record = world_.find(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves()) return Status::invalid_argument;
  world_.waking.wake(command.body.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SleepBody& command) {
  const BodyRecord* record = world_.find(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->is_dynamic() || !is_enabled(*record) || world_.sleep_flags.rest_rules().ticks == 0)
    return Status::invalid_argument;
  if (record->is_asleep()) return Status::ok;
  return world_.island_sleep.put_to_sleep(command.body.index);
}

Status CommandExecutor::execute(const SetAllowSleep& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves()) return Status::invalid_argument;
  if (!command.allow) world_.waking.wake(command.body.index);
  record->flags = static_cast<std::uint8_t>(command.allow ? record->flags & ~k_body_no_sleep
                                                          : record->flags | k_body_no_sleep);
  begin_rest(*record, world_.sleep_flags.rest_rules());
  return Status::ok;
}

Result<BodyHandle> World::create_body(const BodyDef& def) {
  return impl_->body_registry.create(def);
}

}  // namespace lockstone
