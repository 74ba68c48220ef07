// Joints.
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

template <class Axis>
Axis axis_of(const lks_axis& raw, const char* field) {
  if (raw.reserved != 0) throw_invalid(field, "reserved must be 0");
  Axis axis;
  axis.mode = enumerator(raw.mode, AxisMode::locked, AxisMode::limited, field);
  axis.lower.raw = raw.lower;
  axis.upper.raw = raw.upper;
  axis.target.raw = raw.target;
  axis.speed.raw = raw.speed;
  axis.hertz.raw = raw.hertz;
  axis.damping_ratio.raw = raw.damping_ratio;
  axis.max_effort.raw = raw.max_effort;
  return axis;
}

template <class Axis>
lks_axis axis_raw(const Axis& axis) {
  return {static_cast<std::uint32_t>(axis.mode),
          axis.lower.raw,
          axis.upper.raw,
          axis.target.raw,
          axis.speed.raw,
          axis.hertz.raw,
          axis.damping_ratio.raw,
          0,
          axis.max_effort.raw};
}

JointFrame frame_of(const lks_joint_frame& frame) {
  return {vec<Length>(frame.position), quat_of(frame.orientation)};
}

lks_joint_frame frame_raw(const JointFrame& frame) {
  return {raw_of(frame.position), raw_of(frame.orientation)};
}

JointKind kind_of(std::uint32_t kind) {
  return enumerator(kind, JointKind::distance, k_last_joint_kind, "joint.kind");
}

lks_joint_def joint_def_raw(const JointDef& def) {
  lks_joint_def raw{};
  raw.size = sizeof raw;
  raw.kind = static_cast<std::uint32_t>(def.kind);
  raw.body_a = id_of(def.body_a);
  raw.body_b = id_of(def.body_b);
  raw.frame_a = frame_raw(def.frame_a);
  raw.frame_b = frame_raw(def.frame_b);
  for (std::size_t i = 0; i < 3; ++i) {
    raw.linear[i] = axis_raw(def.linear[i]);
    raw.angular[i] = axis_raw(def.angular[i]);
  }
  raw.ratio = def.ratio.raw;
  return raw;
}

JointDef joint_def_of(const lks_joint_def* from) {
  const lks_joint_def raw = take(from, joint_def_raw(JointDef{}), "def");
  JointDef def;
  def.kind = kind_of(raw.kind);
  def.body_a = handle_of<BodyHandle>(raw.body_a);
  def.body_b = handle_of<BodyHandle>(raw.body_b);
  def.frame_a = frame_of(raw.frame_a);
  def.frame_b = frame_of(raw.frame_b);
  for (std::size_t i = 0; i < 3; ++i) {
    def.linear[i] = axis_of<LinearAxis>(raw.linear[i], "joint.linear");
    def.angular[i] = axis_of<AngularAxis>(raw.angular[i], "joint.angular");
  }
  def.ground_a = vec<Position>(raw.ground_a);
  def.ground_b = vec<Position>(raw.ground_b);
  def.ratio = Number::from_raw(raw.ratio);
  def.break_force = Force::from_raw(raw.break_force);
  def.break_torque = Torque::from_raw(raw.break_torque);
  def.collide = flag(raw.collide, "joint.collide");
  def.user_data = raw.user_data;
  def.path.value = raw.path;
  return def;
}

lks_joint_view view_of(const JointView& joint) {
  lks_joint_view raw{};
  raw.size = sizeof raw;
  raw.kind = static_cast<std::uint32_t>(joint.kind);
  raw.body_a = id_of(joint.body_a);
  raw.body_b = id_of(joint.body_b);
  raw.user_data = joint.user_data;
  raw.offset = raw_of(joint.offset);
  raw.angle = raw_of(joint.angle);
  raw.force = raw_of(joint.force);
  raw.torque = raw_of(joint.torque);
  return raw;
}

template <class Command, class Axis>
lks_status set_axis(lks_world* world, lks_joint joint, std::uint32_t axis,
                    const lks_axis* settings) {
  return call([&] {
    if (axis > 2) throw_invalid("axis", "must be 0 … 2");
    order(world, Command{handle_of<JointHandle>(joint), static_cast<std::uint8_t>(axis),
                         axis_of<Axis>(required(settings, "settings"), "settings")});
  });
}

}  // namespace

lks_status lks_joint_def_init(lks_joint_def* def, size_t size, uint32_t kind, lks_body a,
                              lks_body b) {
  return call([&] {
    const JointDef made =
        JointDef::of(kind_of(kind), handle_of<BodyHandle>(a), handle_of<BodyHandle>(b));
    give(joint_def_raw(made), def, size, "def");
  });
}

lks_status lks_create_joint(lks_world* world, const lks_joint_def* def, lks_joint* out) {
  return call([&] {
    World& target = write(world);
    required(out, "out");
    const JointDef joint = joint_def_of(def);
    const Result<JointHandle> made = target.create_joint(joint);
    if (!made.ok()) throw_failure(made.status(), target.explain(joint));
    *out = id_of(made.value());
  });
}

lks_status lks_destroy_joint(lks_world* world, lks_joint joint) {
  return call([&] { order(world, DestroyJoint{handle_of<JointHandle>(joint)}); });
}

lks_status lks_set_linear_axis(lks_world* world, lks_joint joint, uint32_t axis,
                               const lks_axis* settings) {
  return set_axis<SetLinearAxis, LinearAxis>(world, joint, axis, settings);
}

lks_status lks_set_angular_axis(lks_world* world, lks_joint joint, uint32_t axis,
                                const lks_axis* settings) {
  return set_axis<SetAngularAxis, AngularAxis>(world, joint, axis, settings);
}

lks_status lks_joint_get(const lks_world* world, lks_joint joint, lks_joint_view* out) {
  return call([&] {
    const World& source = read(world);
    const auto handle = handle_of<JointHandle>(joint);
    if (!source.exists(handle)) throw_failure(Status::stale_handle);
    give(view_of(source.joint(handle)), out, required(out, "out").size, "out");
  });
}

lks_status lks_joints(const lks_world* world, lks_joint* joints, size_t capacity, size_t* count) {
  return call([&] {
    const World& source = read(world);
    required(count, "count");
    std::size_t found = 0;
    for (std::uint32_t index = 0; index < source.joint_limit(); ++index) {
      const JointHandle handle = source.joint_at(index);
      if (handle.is_null() || found++ >= capacity) continue;
      if (joints != nullptr) joints[found - 1] = id_of(handle);
    }
    give_count(found, capacity, *count, "joints");
  });
}
