#include <algorithm>
#include <array>

#include <lockstone/hash.h>
#include <lockstone/world.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/state/limits.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/block_float.h"
#include "core/world/commands/command_checks.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr bool is_within(std::uint32_t value, std::uint32_t low, std::uint32_t high) {
  return value >= low && value <= high;
}

bool is_valid(const WorldDef& def) {
  return is_within(def.body_capacity, 1, 1U << 20) && is_within(def.pair_capacity, 1, 1U << 24) &&
         is_within(def.contact_capacity, 1, 1U << 24) && def.joint_capacity <= 1U << 20 &&
         def.converged_contacts <= 1U << 16 && def.vehicle_capacity <= k_max_vehicles &&
         def.terrain_tile_capacity <= k_max_terrain_tiles && is_within(def.tick_rate, 10, 480) &&
         is_within(def.substeps, 1, 16) && def.sleep_ms <= 60'000 &&
         def.sleep_distance >= Length::from_ratio(1, 1000) &&
         def.sleep_distance <= Length::from_integer(1) && is_valid_gravity(def.gravity) &&
         def.speed_limit >= Velocity::from_integer(1) && def.speed_limit <= k_speed_limit &&
         def.broad_phase <= BroadPhaseKind::sweep_and_prune;
}

}  // namespace

std::uint64_t config_hash(const WorldDef& def, std::uint64_t assets) {
  std::array<std::byte, 84> buffer{};
  ByteWriter writer(buffer);
  writer.put(k_simulation_abi);
  writer.put(def.body_capacity);
  writer.put(def.pair_capacity);
  writer.put(def.contact_capacity);
  writer.put(def.joint_capacity);
  writer.put(def.converged_contacts);
  writer.put(def.tick_rate);
  writer.put(def.substeps);
  writer.put(def.sleep_ms);
  writer.put(def.sleep_distance.raw);
  for (int i = 0; i < 3; ++i)
    writer.put(def.gravity[i].raw);
  writer.put(def.speed_limit.raw);
  writer.put(assets);
  if (def.vehicle_capacity != 0 || def.terrain_tile_capacity != 0) writer.put(def.vehicle_capacity);
  if (def.terrain_tile_capacity != 0) writer.put(def.terrain_tile_capacity);
  LKS_CHECK(writer.ok());
  return hash64(writer.written());
}

World::Impl::Impl(const WorldDef& definition, std::shared_ptr<const AssetSet> known_assets)
    : WorldData(definition, std::move(known_assets)),
      names(definition.body_capacity),
      sleep_flags(*this),
      islands(definition.body_capacity),
      found(definition.contact_capacity),
      waking(*this, sleep_flags, found),
      joint_registry(*this, waking),
      body_registry(*this, sleep_flags, waking, joint_registry, names),
      narrow(*this, found),
      moved(*this),
      left_out(*this, found, moved, islands),
      solver(std::make_unique<ContactSolver>(time_step, definition.body_capacity,
                                             definition.contact_capacity, definition.joint_capacity,
                                             definition.converged_contacts)),
      continuous(*this, moved, narrow, waking, passes),
      passes(*this, found, continuous, moved),
      mover(*this, moved, *solver, left_out, continuous, sleep_flags.rest_rules()),
      events(*this, found),
      island_sleep(*this, sleep_flags, waking, islands, found),
      trace(*this) {
  solver->make_room(parallel.workers());
}

World::Impl::~Impl() = default;

void World::Impl::make_room() {
  narrow.make_room();
  solver->make_room(parallel.workers());
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::create(const WorldDef& def, std::shared_ptr<const AssetSet> assets) {
  if (!is_valid(def)) return Status::invalid_argument;
  if (assets == nullptr) assets = std::make_shared<const AssetSet>();
  return World(std::make_unique<Impl>(def, std::move(assets)));
}

const WorldDef& World::def() const {
  return impl_->def;
}
const std::shared_ptr<const AssetSet>& World::assets() const {
  return impl_->assets;
}
std::uint64_t World::tick() const {
  return impl_->header.tick;
}
StepReport World::step() {
  return impl_->step();
}
std::span<const ContactEvent> World::events() const {
  return impl_->events.list();
}
void World::set_clock(ProfileClock now, ProfileDetail detail) {
  impl_->profiler.set_clock(now, detail);
}
void World::set_task_runner(TaskRunner* runner, TaskPieces pieces) {
  impl_->parallel.set_runner(runner, pieces);
  impl_->make_room();
}
const StepProfile& World::profile() const {
  return impl_->profiler.profile();
}
bool World::exists(BodyHandle body) const {
  return impl_->find(body) != nullptr;
}
std::uint32_t World::body_count() const {
  return impl_->body_count();
}
std::uint32_t World::body_limit() const {
  return impl_->header.body_limit;
}
namespace {

const BodyRecord* existing(const BodyRecord* record, BodyHandle body, const char* function) {
  if (record == nullptr) {
    misused(function, body.index, body.generation,
            "names no body (destroyed?); ask World::exists first");
  }
  return record;
}

// Of the shape's frame: without an asset that of the record, and no call.
Transform pose_of(const BodyRecord& record, const geometry::AssetGeometry* asset) {
  const Transform pose{record.position, record.orientation};
  return asset == nullptr ? pose : shape_pose(asset, pose);
}

}  // namespace

BodyHandle World::body_at(std::uint32_t index) const {
  if (index >= impl_->header.body_limit || !impl_->bodies[index].exists()) return {};
  return {index, impl_->bodies[index].generation};
}

BodyView World::body(BodyHandle body) const {
  const BodyRecord* record = existing(impl_->find(body), body, "World::body");
  const Vec3<Velocity> w =
      surface_velocity(inverse_inertia(*record, impl_->cache.rotation(body.index)), record->spin);
  const auto angular = [&](Velocity v) {
    return AngularVelocity::from_raw(raw::scale_binary(v.raw, -record->scale_exponent));
  };
  const Transform pose = pose_of(*record, impl_->cache.asset(body.index));
  return {.motion = static_cast<MotionType>(record->motion),
          .shape = record->shape(),
          .position = pose.position,
          .orientation = pose.orientation,
          .centre_of_mass = record->position,
          .velocity = record->velocity,
          .principal_axes = record->orientation,
          .angular_velocity = {angular(w.x), angular(w.y), angular(w.z)},
          .mass = mass_data_of(*record),
          .filter = record->filter(),
          .surface = record->surface(),
          .surface_motion = surface_motion_of(*record, impl_->cache.asset(body.index)),
          .gravity_scale = record->gravity_scale,
          .linear_damping = record->linear_damping,
          .angular_damping = record->angular_damping,
          .locks = axis_locks(record->locks),
          .speed_limit = speed_limit_of(*record),
          .is_trigger = record->is_trigger(),
          .is_bullet = record->is_bullet(),
          .is_asleep = record->is_asleep(),
          .is_enabled = is_enabled(*record),
          .allow_sleep = record->may_sleep(),
          .events = {has_contact_events(*record), record->hit_speed, has_persist_events(*record)},
          .user_data = record->user_data};
}

Status World::set_name(BodyHandle body, std::string_view name) {
  if (!exists(body)) return Status::stale_handle;
  impl_->names.set(body, name);
  return Status::ok;
}

std::string_view World::name(BodyHandle body) const {
  return exists(body) ? impl_->names.of(body) : std::string_view{};
}

Transform pose_of(const World& world, BodyHandle body) {
  const BodyRecord* record = existing(world.impl_->find(body), body, "pose_of");
  return pose_of(*record, world.impl_->cache.asset(body.index));
}

Vec3<Position> World::position(BodyHandle body) const {
  const BodyRecord* record = existing(impl_->find(body), body, "World::position");
  return pose_of(*record, impl_->cache.asset(body.index)).position;
}

Vec3<Velocity> World::velocity(BodyHandle body) const {
  const BodyRecord* record = existing(impl_->find(body), body, "World::velocity");
  return record->velocity;
}

Mass World::mass(BodyHandle body) const {
  const BodyRecord* record = existing(impl_->find(body), body, "World::mass");
  return mass_of(*record);
}

bool World::touching(BodyHandle a, BodyHandle b) const {
  if (!exists(a) || !exists(b)) return false;
  const auto is_theirs = [&](const ContactRecord& contact) {
    const bool same = (contact.body_a == a.index && contact.body_b == b.index) ||
                      (contact.body_a == b.index && contact.body_b == a.index);
    return same && contact.is_touching();
  };
  bool found = std::ranges::any_of(impl_->contacts.active(), is_theirs);
  impl_->contacts.sleeping().for_each_of(
      a.index, [&](const ContactRecord& contact) { found = found || is_theirs(contact); });
  return found;
}

}  // namespace lockstone
