// Bodies: made and read. Their commands are in commands.cpp.
#include <algorithm>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr std::uint32_t k_def_flags =
    LKS_BODY_TRIGGER | LKS_BODY_FIXED_ROTATION | LKS_BODY_BULLET | LKS_BODY_ALLOW_SLEEP;

lks_body_def default_body_def() {
  const BodyDef def;
  lks_body_def raw{};
  raw.size = sizeof raw;
  raw.motion = static_cast<std::uint32_t>(def.motion);
  raw.shape = raw_of(def.shape);
  raw.orientation = raw_of(def.orientation);
  raw.surface = raw_of(def.material.surface());
  raw.density = def.material.density.raw;
  raw.filter = raw_of(def.filter);
  raw.gravity_scale = def.gravity_scale.raw;
  raw.flags = LKS_BODY_ALLOW_SLEEP;
  raw.speed_limit = def.speed_limit.linear.raw;
  raw.angular_speed_limit = def.speed_limit.angular.raw;
  raw.events = raw_of(def.events);
  return raw;
}

void set_flags(BodyDef& def, std::uint32_t flags) {
  check_bits(flags, k_def_flags, "body.flags");
  def.is_trigger = (flags & LKS_BODY_TRIGGER) != 0;
  def.fixed_rotation = (flags & LKS_BODY_FIXED_ROTATION) != 0;
  def.is_bullet = (flags & LKS_BODY_BULLET) != 0;
  def.allow_sleep = (flags & LKS_BODY_ALLOW_SLEEP) != 0;
}

BodyDef body_def_of(const lks_body_def* from) {
  const lks_body_def raw = take(from, default_body_def(), "def");
  BodyDef def;
  def.motion = enumerator(raw.motion, MotionType::static_body, MotionType::dynamic, "body.motion");
  def.shape = shape_of(raw.shape, "body.shape.kind");
  def.position = vec<Position>(raw.position);
  def.orientation = quat_of(raw.orientation);
  def.velocity = vec<Velocity>(raw.velocity);
  def.angular_velocity = vec<AngularVelocity>(raw.angular_velocity);
  def.material = material_of(surface_of(raw.surface, "body.surface"), raw.density);
  def.surface_motion = surface_motion_of(raw.surface_motion);
  def.filter = filter_of(raw.filter);
  def.gravity_scale = Number::from_raw(raw.gravity_scale);
  def.linear_damping = Rate::from_raw(raw.linear_damping);
  def.angular_damping = Rate::from_raw(raw.angular_damping);
  set_flags(def, raw.flags);
  def.locks = locks_of(raw.locks, "body.locks");
  def.speed_limit = {Velocity::from_raw(raw.speed_limit),
                     AngularVelocity::from_raw(raw.angular_speed_limit)};
  def.user_data = raw.user_data;
  def.events = events_of(raw.events, raw.hit_speed, "body.events");
  def.mass = {Mass::from_raw(raw.mass), vec<MomentOfInertia>(raw.inertia)};
  return def;
}

std::uint32_t flags_of(const BodyView& body) {
  std::uint32_t flags = 0;
  if (body.is_trigger) flags |= LKS_BODY_TRIGGER;
  if (body.is_bullet) flags |= LKS_BODY_BULLET;
  if (body.allow_sleep) flags |= LKS_BODY_ALLOW_SLEEP;
  if (body.is_asleep) flags |= LKS_BODY_ASLEEP;
  if (!body.is_enabled) flags |= LKS_BODY_DISABLED;
  return flags;
}

lks_body_view view_of(const BodyView& body) {
  lks_body_view raw{};
  raw.size = sizeof raw;
  raw.motion = static_cast<std::uint32_t>(body.motion);
  raw.shape = raw_of(body.shape);
  raw.position = raw_of(body.position);
  raw.centre_of_mass = raw_of(body.centre_of_mass);
  raw.velocity = raw_of(body.velocity);
  raw.angular_velocity = raw_of(body.angular_velocity);
  raw.orientation = raw_of(body.orientation);
  raw.surface = raw_of(body.surface);
  raw.filter = raw_of(body.filter);
  raw.flags = flags_of(body);
  raw.locks = raw_of(body.locks);
  raw.mass = body.mass.mass.raw;
  raw.user_data = body.user_data;
  raw.events = raw_of(body.events);
  raw.hit_speed = body.events.hit_speed.raw;
  raw.inertia = raw_of(body.mass.inertia);
  raw.principal_axes = raw_of(body.principal_axes);
  raw.surface_motion = {raw_of(body.surface_motion.velocity), raw_of(body.surface_motion.turning)};
  raw.gravity_scale = body.gravity_scale.raw;
  raw.linear_damping = body.linear_damping.raw;
  raw.angular_damping = body.angular_damping.raw;
  raw.speed_limit = body.speed_limit.linear.raw;
  raw.angular_speed_limit = body.speed_limit.angular.raw;
  return raw;
}

}  // namespace

lks_status lks_body_def_init(lks_body_def* def, size_t size) {
  return call([&] { give(default_body_def(), def, size, "def"); });
}

lks_status lks_create_body(lks_world* world, const lks_body_def* def, lks_body* out) {
  return call([&] {
    World& target = write(world);
    required(out, "out");
    const BodyDef body = body_def_of(def);
    const Result<BodyHandle> made = target.create_body(body);
    if (!made.ok()) throw_failure(made.status(), target.explain(body));
    *out = id_of(made.value());
  });
}

lks_status lks_set_name(lks_world* world, lks_body body, const char* name) {
  return call([&] {
    const Status status =
        write(world).set_name(handle_of<BodyHandle>(body), &required(name, "name"));
    if (status != Status::ok) throw_failure(status);
  });
}

lks_status lks_body_exists(const lks_world* world, lks_body body, uint32_t* out) {
  return call([&] { required(out, "out") = read(world).exists(handle_of<BodyHandle>(body)); });
}

lks_status lks_body_get(const lks_world* world, lks_body body, lks_body_view* out) {
  return call([&] {
    const World& source = read(world);
    const BodyHandle handle = existing_body(source, body);
    give(view_of(source.body(handle)), out, required(out, "out").size, "out");
  });
}

lks_status lks_body_pose(const lks_world* world, lks_body body, lks_pose* out) {
  return call([&] {
    const World& source = read(world);
    required(out, "out") = raw_of(pose_of(source, existing_body(source, body)));
  });
}

lks_status lks_body_velocity(const lks_world* world, lks_body body, lks_velocity3* out) {
  return call([&] {
    const World& source = read(world);
    required(out, "out") = raw_of(source.velocity(existing_body(source, body)));
  });
}

lks_status lks_bodies(const lks_world* world, lks_body* bodies, lks_pose* poses,
                      lks_velocity3* velocities, size_t capacity, size_t* count) {
  return call([&] {
    const World& source = read(world);
    required(count, "count");
    std::size_t found = 0;
    for (std::uint32_t index = 0; index < source.body_limit(); ++index) {
      const BodyHandle handle = source.body_at(index);
      if (handle.is_null() || found++ >= capacity) continue;
      if (bodies != nullptr) bodies[found - 1] = id_of(handle);
      if (poses != nullptr) poses[found - 1] = raw_of(pose_of(source, handle));
      if (velocities != nullptr) velocities[found - 1] = raw_of(source.velocity(handle));
    }
    give_count(found, capacity, *count, "bodies");
  });
}
