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
         def.angular_damping >= Rate{} && is_valid(def.speed_limit);
}

// A shape without volume cannot be dynamic, and only a body with a centre of mass can move. Lighter
// or heavier bodies would leave the formats of the solver.
bool has_valid_mass(const BodyDef& def, const Asset* asset) {
  const bool has_solid =
      asset != nullptr ? asset->solid() != nullptr : is_primitive(def.shape.kind);
  if (!has_solid) return def.motion == MotionType::static_body;
  if (def.motion != MotionType::dynamic) return true;
  const Mass mass = mass_of(def, asset);
  return mass >= k_min_mass && mass <= k_max_mass;
}

// The fields that follow from shape and density.
void set_mass(BodyRecord& record, const BodyDef& def, const Asset* asset) {
  const ShapeProperties properties = properties_of(def.shape, asset);
  record.scale_exponent = static_cast<std::int8_t>(properties.scale_exponent);
  record.inertia = properties.inertia;
  if (def.motion != MotionType::dynamic) return;
  const BlockFloat inverse = inverse_of(mass_of(def, asset));
  record.inverse_mass = inverse.mantissa;
  record.inverse_mass_exponent = inverse.exponent;
}

BodyRecord make_record(const BodyDef& def, const Asset* asset, std::uint32_t generation) {
  BodyRecord record;
  const Transform pose = body_pose(asset, {def.position, def.orientation});
  record.position = pose.position;
  record.orientation = pose.orientation;
  set_contact_pose(record);
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
  set_mass(record, def, asset);
  set_speed_limit(record, def.speed_limit);
  if (!record.is_dynamic()) set_surface_motion(record, asset, def.surface_motion);
  return record;
}

// The asset that a shape names; null without error for a shape that names none.
Result<const Asset*> asset_of(const Shape& shape, const AssetSet& assets) {
  if (!is_asset(shape.kind)) return nullptr;
  const Asset* asset = assets.find(shape.asset);
  if (asset == nullptr) return Status::not_found;
  if (asset->kind() != shape.kind) return Status::invalid_argument;
  return asset;
}

bool has_centre_in_world(const BodyDef& def, const Asset* asset) {
  return is_within(body_pose(asset, {def.position, def.orientation}).position, k_world_limit);
}

}  // namespace

Mass mass_of(const BodyDef& def, const Asset* asset) {
  if (asset == nullptr) return mass_of(def.shape, def.material.density);
  return multiply_saturating<Mass>(def.material.density, asset->solid()->volume);
}

ShapeProperties properties_of(const Shape& shape, const Asset* asset) {
  const auto bounded = [](const Vec3<Unit>& inertia) {
    return Vec3<Unit>{max(inertia.x, k_min_inertia), max(inertia.y, k_min_inertia),
                      max(inertia.z, k_min_inertia)};
  };
  if (is_primitive(shape.kind)) {
    return {bounded(normalized_inertia(shape)), scale_exponent(shape), bounding_radius(shape)};
  }
  if (asset != nullptr && asset->solid() != nullptr) {
    const geometry::Solid& solid = *asset->solid();
    const Vec3<Unit> inertia{geometry::to_unit(solid.inertia.x), geometry::to_unit(solid.inertia.y),
                             geometry::to_unit(solid.inertia.z)};
    return {bounded(inertia), solid.scale_exponent, solid.radius};
  }
  return {bounded({}), k_largest_scale_exponent, {}};
}

Result<BodyHandle> World::Impl::create_body(const BodyDef& body_def) {
  if (!is_valid(body_def)) return Status::invalid_argument;
  const Result<const Asset*> found = asset_of(body_def.shape, *assets);
  if (!found.ok()) return found.status();
  const Asset* asset = found.value();
  Vec3<Velocity> surface;
  if (!has_valid_mass(body_def, asset) || !has_centre_in_world(body_def, asset) ||
      !to_surface_velocity(body_def.angular_velocity,
                           properties_of(body_def.shape, asset).scale_exponent, surface)) {
    return Status::invalid_argument;
  }
  std::uint32_t slot = free_hint;
  while (slot < header.body_limit && !is_free(bodies[slot]))
    ++slot;
  if (slot == def.body_capacity) return Status::capacity_exhausted;
  free_hint = slot + 1;
  header.body_limit = std::max(header.body_limit, slot + 1);

  body_hashes.mark(slot);
  BodyRecord& record = bodies[slot];
  record = make_record(body_def, asset, record.generation + 1);
  cache.set_asset(slot, asset);
  if (record.moves()) {
    record.velocity = body_def.velocity;
    record.spin = spin_of(record, to_matrix(record.orientation), surface);
    hold_in_range(record.spin);
    hold_axes(record);
    awake.insert(slot);
  }
  begin_rest(record, rest_rules);
  refresh(slot);
  disturb_around(slot);
  names.forget(handle_of(slot));
  return handle_of(slot);
}

Status World::Impl::execute(const CreateBody& command) {
  return create_body(command.def).status();
}

Status World::Impl::execute(const DestroyBody& command) {
  const BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  const std::uint32_t index = command.body.index;
  disturb(index);
  destroy_joints_of(index);
  awake.erase(index);
  changed_sleep.erase(index);
  drop_contacts_of(index);
  broad_phase.remove(index);
  triggers.erase(index);
  BodyRecord empty;
  empty.generation = record->generation;
  bodies[index] = empty;
  free_hint = std::min(free_hint, index);
  return Status::ok;
}

Status World::Impl::execute(const Teleport& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!is_within(command.position, k_world_limit) || !has_direction(command.orientation)) {
    return Status::invalid_argument;
  }
  const Transform pose =
      body_pose(cache.asset(command.body.index), {command.position, command.orientation});
  if (!is_within(pose.position, k_world_limit)) return Status::invalid_argument;
  disturb(command.body.index);
  drop_contacts_of(command.body.index);
  record->position = pose.position;
  record->orientation = pose.orientation;
  set_contact_pose(*record);
  begin_rest(*record, rest_rules);
  refresh(command.body.index);
  disturb_around(command.body.index);
  return Status::ok;
}

Status World::Impl::execute(const SetVelocity& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves() || !is_within(command.velocity, k_speed_limit)) {
    return Status::invalid_argument;
  }
  wake(command.body.index);
  record->velocity = command.velocity;
  hold_axes(*record);
  refresh(command.body.index);
  return Status::ok;
}

Status World::Impl::execute(const SetAngularVelocity& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  Vec3<Velocity> surface;
  if (!record->moves() ||
      !to_surface_velocity(command.angular_velocity, record->scale_exponent, surface)) {
    return Status::invalid_argument;
  }
  wake(command.body.index);
  record->spin = spin_of(*record, cache.rotation(command.body.index), surface);
  hold_in_range(record->spin);
  refresh(command.body.index);
  return Status::ok;
}

Status World::Impl::execute(const SetFilter& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  disturb(command.body.index);
  record->category = command.filter.category;
  record->mask = command.filter.mask;
  record->group = command.filter.group;
  refresh(command.body.index);
  disturb_around(command.body.index);
  return Status::ok;
}

Status World::Impl::execute(const SetUserData& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  record->user_data = command.user_data;
  return Status::ok;
}

Status World::Impl::execute(const SetGravity& command) {
  if (!is_valid_gravity(command.gravity)) return Status::invalid_argument;
  if (header.gravity != command.gravity) wake_all();
  header.gravity = command.gravity;
  return Status::ok;
}

// After `disturb`: none of them is frozen.
void World::Impl::drop_contacts_of(std::uint32_t body) {
  const std::span<ContactRecord> all(contact_store.data(), active_contacts);
  const auto end = std::remove_if(all.begin(), all.end(), [&](const ContactRecord& contact) {
    return contact.body_a == body || contact.body_b == body;
  });
  const auto count = static_cast<std::uint32_t>(end - all.begin());
  remembers_manifolds = remembers_manifolds && count == active_contacts;
  header.contact_count -= active_contacts - count;
  active_contacts = count;
}

Result<BodyHandle> World::create_body(const BodyDef& def) {
  return impl_->create_body(def);
}

Status World::apply(const Command& command) {
  return std::visit(
      [this](const auto& c) {
        if constexpr (std::is_same_v<std::decay_t<decltype(c)>, std::monostate>) {
          return Status::invalid_argument;
        } else {
          return impl_->execute(c);
        }
      },
      command);
}

}  // namespace lockstone
