// Commands that change a body itself: its type of motion, its shape, its mass, whether it takes
// part.

#include <algorithm>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/contact/recycling_pose.h"
#include "core/math/block_float.h"
#include "core/world/commands/body_changes.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr Density k_default_density = Density::from_integer(1000);

// From surface speed w of another scale to spin.
void set_turning(BodyRecord& record, const Mat3& rotation, Vec3<Velocity> w, int scale_exponent) {
  for (int i = 0; i < 3; ++i)
    w[i].raw = raw::scale_binary(w[i].raw, record.scale_exponent - scale_exponent);
  clamp_speed(w);
  record.spin = record.moves() ? spin_of(record, rotation, w) : Vec3<Velocity>{};
  clamp_speed(record.spin);
  if (record.is_dynamic()) apply_axis_locks(record);
}

// A limit of the surface speed for the same angular speed. The greatest is none.
void rescale_speed_limit(BodyRecord& record, int scale_exponent) {
  constexpr std::int64_t k_most = k_speed_limit.raw >> 12;
  std::int32_t& limit = record.max_surface_speed.raw;
  if (limit == k_most) return;
  limit = static_cast<std::int32_t>(std::clamp<std::int64_t>(
      raw::scale_binary(limit, record.scale_exponent - scale_exponent), 1, k_most));
}

}  // namespace

// The body with another motion. Triangles have another scale where they move.
BodyRecord with_motion(const World::Impl& world, std::uint32_t body, MotionType motion) {
  BodyRecord record = world.bodies[body];
  record.motion = static_cast<std::uint8_t>(motion);
  const geometry::AssetGeometry* asset = world.cache.asset(body);
  record.scale_exponent =
      static_cast<std::int8_t>(properties_of(record.shape(), asset, motion).scale_exponent);
  return record;
}

// Whether the body may become `changed`, which has another type of motion.
bool can_become(const World::Impl& world, std::uint32_t body, const BodyRecord& changed) {
  if (!may_have(static_cast<MotionType>(changed.motion), changed.shape(), world.cache.asset(body)))
    return false;
  return world.joint_registry.hold_dynamic(body, changed) &&
         world.joint_registry.fits(body, changed);
}

Mass mass_as_dynamic(const World::Impl& world, const SetMotionType& command) {
  if (command.mass != Mass{}) return command.mass;
  const std::uint32_t body = command.body.index;
  return mass_of(world.bodies[body].shape(), world.cache.asset(body), k_default_density);
}

// The body with its new shape in the frame of the old one. Its speeds still follow from the old.
BodyRecord reshaped(const World::Impl& world, const SetShape& command,
                    const geometry::AssetGeometry* asset) {
  const std::uint32_t body = command.body.index;
  BodyRecord record = world.bodies[body];
  const Transform frame =
      shape_pose(world.cache.asset(body), {record.position, record.orientation});
  const Transform pose = body_pose(asset, frame);
  record.position = pose.position;
  record.orientation = pose.orientation;
  record.shape_kind = static_cast<std::uint8_t>(command.shape.kind);
  record.size = command.shape.size;
  record.asset = command.shape.asset;
  set_solid(record, properties_of(command.shape, asset, static_cast<MotionType>(record.motion)));
  if (record.is_dynamic() && command.mass != Mass{}) set_mass_data(record, {command.mass, {}});
  return record;
}

bool can_take_shape(const World::Impl& world, const SetShape& command,
                    const geometry::AssetGeometry* asset) {
  const std::uint32_t body = command.body.index;
  const BodyRecord& record = world.bodies[body];
  if (!may_have(static_cast<MotionType>(record.motion), command.shape, asset)) return false;
  if (record.is_dynamic() && command.mass != Mass{} && !is_body_mass(command.mass)) return false;
  const BodyRecord changed = reshaped(world, command, asset);
  return is_within(changed.position, k_world_limit) &&
         world.joint_registry.fit_moved(body, changed, body_pose(world.cache.asset(body), {}),
                                        body_pose(asset, {}));
}

void BodyRegistry::leave(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  if (record.is_pushed()) end_pushes(record, flags_.rest_rules());
  record.flags &= static_cast<std::uint8_t>(~k_body_changed_sleep);
  record.loose_time = 0;
  flags_.forget(body);
  drop_contacts_of(body);
  joints_.forget_impulses_of(body);
  world_.joint_graph.forget_awake_list();
}

void BodyRegistry::enter(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  set_recycling_pose(record);
  begin_rest(record, flags_.rest_rules());
  if (record.is_awake()) world_.awake.insert(body);
  world_.refresh(body);
  waking_.disturb_around(body);
}

Status CommandExecutor::execute(const SetMotionType& command) {
  const std::uint32_t body = command.body.index;
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (command.motion < MotionType::static_body || command.motion > MotionType::dynamic)
    return Status::invalid_argument;
  const BodyRecord changed = with_motion(world_, body, command.motion);
  if (changed.motion == record->motion) return Status::ok;
  if (!can_become(world_, body, changed)) return Status::invalid_argument;
  const Mass mass = changed.is_dynamic() ? mass_as_dynamic(world_, command) : Mass{};
  if (changed.is_dynamic() && !is_body_mass(mass)) return Status::invalid_argument;
  world_.waking.disturb(body);
  world_.body_registry.leave(body);
  const bool swaps_union = record->is_dynamic() || changed.is_dynamic();
  const Vec3<Velocity> turning =
      surface_velocity(inverse_inertia(*record, world_.cache.rotation(body)), record->spin);
  const int old_exponent = record->scale_exponent;
  record->motion = changed.motion;
  record->scale_exponent = changed.scale_exponent;
  rescale_speed_limit(*record, old_exponent);
  record->inverse_mass = record->inverse_mass_exponent = 0;
  if (record->is_dynamic()) set_mass_data(*record, {mass, {}});
  if (swaps_union) record->set_rest({}, Quat{{}, {}, {}, {}});
  if (!record->moves()) record->velocity = {};
  set_turning(*record, world_.cache.rotation(body), turning, old_exponent);
  world_.joint_registry.rebuild();
  world_.body_registry.enter(body);
  return Status::ok;
}

Status CommandExecutor::execute(const SetShape& command) {
  if (world_.find(command.body) == nullptr) return Status::stale_handle;
  if (validate(command.shape) != Status::ok) return Status::invalid_argument;
  const Result<const Asset*> found = asset_of(command.shape, *world_.assets);
  if (!found.ok()) return found.status();
  const geometry::AssetGeometry* asset = geometry::geometry_of(found.value());
  if (!can_take_shape(world_, command, asset)) return Status::invalid_argument;
  change_shape(command, asset);
  return Status::ok;
}

void CommandExecutor::change_shape(const SetShape& command, const geometry::AssetGeometry* asset) {
  const std::uint32_t body = command.body.index;
  world_.waking.disturb(body);
  BodyRecord& record = *world_.edit(command.body);
  const BodyRecord old = record;
  const geometry::AssetGeometry* old_asset = world_.cache.asset(body);
  const SurfaceMotion motion = surface_motion_of(old, old_asset);
  const Vec3<Velocity> turning =
      surface_velocity(inverse_inertia(old, world_.cache.rotation(body)), old.spin);
  record = reshaped(world_, command, asset);
  rescale_speed_limit(record, old.scale_exponent);
  record.loose_time = 0;
  if (record.moves()) {
    record.velocity += velocity_around(turning, record.position - old.position, old.scale_exponent);
    clamp_speed(record.velocity);
  }
  set_turning(record, to_matrix(record.orientation), turning, old.scale_exponent);
  if (!record.is_dynamic()) set_surface_motion(record, asset, motion);
  world_.joint_registry.move_frames(body, body_pose(old_asset, {}), body_pose(asset, {}));
  world_.joint_registry.forget_impulses_of(body);
  world_.contacts.forget_manifolds();
  const bool changes_pairs = is_surface(old, old_asset) != is_surface(record, asset);
  if (changes_pairs) world_.body_registry.drop_contacts_of(body);
  world_.cache.set_asset(body, asset);
  if (changes_pairs) world_.joint_registry.rebuild();
  if (forget_terrain_of(world_, body)) refresh_terrain(world_);
  set_recycling_pose(record);
  begin_rest(record, world_.sleep_flags.rest_rules());
  world_.refresh(body);
  world_.waking.disturb_around(body);
}

Status CommandExecutor::execute(const SetMassData& command) {
  const std::uint32_t body = command.body.index;
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->is_dynamic()) return Status::invalid_argument;
  MassData data = command.data;
  if (data.mass == Mass{}) data.mass = mass_of(*record);
  if (!has_valid_mass_data(data, record->scale_exponent)) return Status::invalid_argument;
  world_.waking.disturb(body);
  const Mat3& rotation = world_.cache.rotation(body);
  const Vec3<Velocity> turning = surface_velocity(inverse_inertia(*record, rotation), record->spin);
  set_solid(*record, properties_of(record->shape(), world_.cache.asset(body)));
  set_mass_data(*record, data);
  set_turning(*record, rotation, turning, record->scale_exponent);
  world_.refresh(body);
  return Status::ok;
}

Status CommandExecutor::execute(const SetEnabled& command) {
  const std::uint32_t body = command.body.index;
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (is_enabled(*record) == command.enabled) return Status::ok;
  world_.waking.disturb(body);
  world_.body_registry.leave(body);
  record->locks ^= k_body_disabled;
  world_.body_registry.enter(body);
  return Status::ok;
}

}  // namespace lockstone
