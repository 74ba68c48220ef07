// Joints of a world: creating, changing, destroying and querying them.

#include <algorithm>

#include <lockstone/path.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/joint/turn_springs.h"
#include "core/dynamics/state/limits.h"
#include "core/math/divide.h"
#include "core/math/roots.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/joint_progress.h"
#include "core/world/commands/joint_registry.h"
#include "core/world/derived/quantities.h"
#include "core/world/state/record_checks.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

bool in_world(const Vec3<Position>& p) {
  const auto is_within = [](Position x) { return x <= k_world_limit && x >= -k_world_limit; };
  return is_within(p.x) && is_within(p.y) && is_within(p.z);
}

bool is_valid(const JointAxisRecord& axis, std::uint8_t mode, bool is_angle) {
  const bool ranges = axis.hertz >= Number{} && axis.hertz <= Number::from_integer(1000) &&
                      axis.damping_ratio >= Number{} &&
                      axis.damping_ratio <= Number::from_integer(100) && axis.max_effort >= 0 &&
                      axis.max_effort <= k_effort_limit;
  if (mode > static_cast<std::uint8_t>(AxisMode::limited) || !ranges) return false;
  const auto known = [&](std::int32_t x) { return !is_angle || (x >= -k_pi && x <= k_pi); };
  return axis.lower <= axis.upper && known(axis.lower) && known(axis.upper) && known(axis.target);
}

// A path joint goes along its path, and across it nowhere.
bool has_path_axes(const JointRecord& joint) {
  const auto stays = [&](std::size_t i) {
    return joint.mode(i) == AxisMode::locked && !joint.axes[i].is_driven();
  };
  return joint.mode(0) != AxisMode::locked && stays(1) && stays(2);
}

bool has_valid_axes(const JointRecord& joint) {
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    if (!is_valid(joint.axes[i], joint.modes[i], i >= 3)) return false;
  }
  if (joint.is(JointKind::ball) && joint.axes[4].upper < 0) return false;
  if (joint.is(JointKind::path) && !has_path_axes(joint)) return false;
  return !joint.is(JointKind::distance) || joint.axes[0].lower >= 0;
}

// The fields that a path joint uses in place of a pulley's points.
bool has_path_place(const JointRecord& joint) {
  const Position none;
  return joint.ground_a.x >= none && joint.ground_a.x <= k_world_limit &&
         joint.ground_a.y == none && joint.ground_a.z == none && joint.ground_b.y == none &&
         joint.ground_b.z == none;
}

bool has_valid_ratio(const JointRecord& joint) {
  const std::int32_t ratio = joint.ratio.raw;
  if (joint.is(JointKind::pulley)) return ratio > 0 && ratio <= k_ratio_limit;
  if (joint.is(JointKind::ratchet)) return is_teeth(joint.ratio);
  return ratio >= -k_ratio_limit && ratio <= k_ratio_limit;
}

template <class Axis>
void set_axis(JointRecord& joint, std::size_t index, const Axis& from) {
  JointAxisRecord& axis = joint.axes[index];
  axis.max_effort = from.max_effort.raw;
  axis.lower = from.lower.raw;
  axis.upper = from.upper.raw;
  axis.target = from.target.raw;
  axis.speed = from.speed.raw;
  axis.hertz = from.hertz;
  axis.damping_ratio = from.damping_ratio;
  joint.modes[index] = static_cast<std::uint8_t>(from.mode);
}

// From the frame of the shape to that of mass.
bool set_frame(const JointFrame& frame, const geometry::AssetGeometry* asset, Vec3<Length>& anchor,
               Quat& orientation) {
  if (!has_direction(frame.orientation)) return false;
  const Transform mass = body_pose(asset, {});
  const Vec3<Position> point = apply_inverse(mass, rounded<Position>(frame.position));
  anchor = saturated<Length>(point);
  const Quat turn = normalized(frame.orientation);
  orientation =
      mass.orientation == Quat{} ? turn : normalized(multiply(conjugate(mass.orientation), turn));
  return true;
}

JointRecord make_joint(const JointDef& from) {
  JointRecord joint;
  joint.generation = 1;
  joint.kind = static_cast<std::uint8_t>(from.kind);
  joint.flags = from.collide ? k_joint_collide : 0;
  joint.body_a = from.body_a.index;
  joint.body_b = from.body_b.index;
  for (std::size_t i = 0; i < 3; ++i) {
    set_axis(joint, i, from.linear[i]);
    set_axis(joint, i + 3, from.angular[i]);
  }
  if (from.kind == JointKind::path) {
    joint.ground_b.x.raw = static_cast<std::int64_t>(from.path.value);
  } else {
    joint.ground_a = from.ground_a;
    joint.ground_b = from.ground_b;
  }
  joint.ratio = from.ratio;
  joint.break_force = from.break_force;
  joint.break_torque = from.break_torque;
  joint.user_data = from.user_data;
  return joint;
}

}  // namespace

JointDef JointDef::of(JointKind kind, BodyHandle a, BodyHandle b) {
  JointDef def;
  def.kind = kind;
  def.body_a = a;
  def.body_b = b;
  const auto lock = [&](std::initializer_list<int> axes) {
    for (const int axis : axes) {
      const auto i = static_cast<std::size_t>(axis % 3);
      (axis < 3 ? def.linear[i].mode : def.angular[i].mode) = AxisMode::locked;
    }
  };
  switch (kind) {
    case JointKind::ball:
      lock({0, 1, 2});
      break;
    case JointKind::hinge:
      lock({0, 1, 2, 4, 5});
      break;
    case JointKind::ratchet:
      lock({0, 1, 2, 4, 5});
      def.angular[0].mode = AxisMode::limited;
      def.ratio = Number::from_integer(12);
      break;
    case JointKind::path:
      lock({1, 2});
      def.linear[0].mode = AxisMode::limited;
      def.linear[0].upper = k_max_path_length;
      break;
    case JointKind::slider:
      lock({1, 2, 3, 4, 5});
      break;
    case JointKind::weld:
      lock({0, 1, 2, 3, 4, 5});
      break;
    case JointKind::wheel:
      lock({0, 2, 4, 5});
      break;
    default:
      break;
  }
  return def;
}

JointDef JointDef::rope(BodyHandle a, BodyHandle b, Length length) {
  JointDef def = of(JointKind::distance, a, b);
  def.linear[0].mode = AxisMode::limited;
  def.linear[0].upper = length;
  return def;
}

bool can_join(const BodyRecord& a, const BodyRecord& b) {
  return a.exists() && b.exists() && (a.is_dynamic() || b.is_dynamic());
}

Length anchor_reach(const BodyRecord& body) {
  const bool turns = body.moves() && body.rotates();
  const std::int64_t limit = turns ? std::int64_t{k_max_anchor_ratio}
                                         << (Length::frac_bits + body.scale_exponent)
                                   : std::int64_t{1024} << Length::frac_bits;
  return Length::from_raw(
      static_cast<std::int32_t>(std::min(limit, std::int64_t{1024} << Length::frac_bits)));
}

bool is_anchor(const BodyRecord& body, const Vec3<Length>& anchor) {
  return is_within(anchor, anchor_reach(body));
}

bool holds_something(const JointDef& def) {
  const JointDef made = JointDef::of(def.kind, {}, {});
  bool locks = false, holds = false;
  const auto look = [&](const auto& axis, AxisMode wanted) {
    if (wanted != AxisMode::locked) return;
    locks = true;
    holds =
        holds || axis.mode != AxisMode::free || axis.hertz > Number{} || axis.max_effort.raw > 0;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    look(def.linear[i], made.linear[i].mode);
    look(def.angular[i], made.angular[i].mode);
  }
  return holds || !locks;
}

Status validate(const JointRecord& joint) {
  if (!is_generation(joint.generation) || joint.kind > static_cast<std::uint8_t>(k_last_joint_kind))
    return Status::malformed;
  if (!joint.exists()) {
    JointRecord empty;
    empty.generation = joint.generation;
    return joint == empty ? Status::ok : Status::malformed;
  }
  const bool known = (joint.flags & ~k_all_joint_flags) == 0 && joint.body_a != joint.body_b;
  const bool on_ground = joint.is(JointKind::path)
                             ? has_path_place(joint)
                             : in_world(joint.ground_a) && in_world(joint.ground_b);
  const bool in_range = on_ground && joint.break_force >= Force{} &&
                        joint.break_torque >= Torque{} && joint.break_force.raw <= k_effort_limit &&
                        joint.break_torque.raw <= k_effort_limit && joint.total_length >= Length{};
  const bool turned = has_unit_norm(joint.orientation_a) && has_unit_norm(joint.orientation_b);
  const bool valid = known && in_range && turned && has_valid_axes(joint) && has_valid_ratio(joint);
  return valid ? Status::ok : Status::malformed;
}

bool make_joint(const JointDef& from, const geometry::AssetGeometry* asset_a,
                const geometry::AssetGeometry* asset_b, JointRecord& joint) {
  joint = make_joint(from);
  return set_frame(from.frame_a, asset_a, joint.anchor_a, joint.orientation_a) &&
         set_frame(from.frame_b, asset_b, joint.anchor_b, joint.orientation_b);
}

JointRegistry::JointRegistry(WorldData& world, Waking& waking) : world_(world), waking_(waking) {
  events_.reserve(world.def.joint_capacity);
}

Result<JointHandle> JointRegistry::create(const JointDef& from) {
  const BodyRecord* a = world_.find(from.body_a);
  const BodyRecord* b = world_.find(from.body_b);
  if (a == nullptr || b == nullptr) return Status::stale_handle;
  JointRecord joint;
  const bool framed = make_joint(from, world_.cache.asset(from.body_a.index),
                                 world_.cache.asset(from.body_b.index), joint);
  if (!framed || !joint.exists() || !holds_something(from) || validate(joint) != Status::ok ||
      !can_join(*a, *b) || !is_anchor(*a, joint.anchor_a) || !is_anchor(*b, joint.anchor_b)) {
    return Status::invalid_argument;
  }
  if (!begin_joint(world_, joint)) return Status::invalid_argument;
  std::uint32_t slot = free_hint_;
  while (slot < world_.header.joint_limit && !is_free(world_.joints[slot]))
    ++slot;
  if (slot == world_.def.joint_capacity) return Status::capacity_exhausted;
  free_hint_ = slot + 1;
  world_.header.joint_limit = std::max(world_.header.joint_limit, slot + 1);
  joint.generation = world_.joints[slot].generation + 1;
  world_.joints[slot] = joint;
  world_.hashes.joints.mark(slot);
  world_.joint_graph.add({slot, joint.body_a, joint.body_b}, world_.exempt_pair(joint));
  waking_.wake_ends(joint);
  return JointHandle{slot, joint.generation};
}

bool JointRegistry::fits(std::uint32_t body, const BodyRecord& changed) const {
  return std::ranges::all_of(world_.joint_graph.links(), [&](const JointLink& link) {
    const JointRecord& joint = world_.joints[link.joint];
    return (link.body_a != body || is_anchor(changed, joint.anchor_a)) &&
           (link.body_b != body || is_anchor(changed, joint.anchor_b));
  });
}

void JointRegistry::destroy(std::uint32_t joint) {
  waking_.wake_ends(world_.joints[joint]);
  world_.joint_graph.remove(joint, world_.exempt_pair(world_.joints[joint]));
  world_.hashes.joints.mark(joint);
  JointRecord empty;
  empty.generation = world_.joints[joint].generation;
  world_.joints[joint] = empty;
  free_hint_ = std::min(free_hint_, joint);
}

void JointRegistry::destroy_all_of(std::uint32_t body) {
  for (std::size_t i = world_.joint_graph.links().size(); i-- > 0;) {
    const JointLink link = world_.joint_graph.links()[i];
    if (link.body_a == body || link.body_b == body) destroy(link.joint);
  }
}

// Joints that had to bear more than they do are destroyed, by index.
void JointRegistry::break_overloaded() {
  events_.clear();
  const auto exceeds = [](const auto& v, auto limit) {
    return limit.raw > 0 && norm(v.x.raw, v.y.raw, v.z.raw) > static_cast<std::uint64_t>(limit.raw);
  };
  for (const JointLink& link : world_.joint_graph.awake_links()) {
    const std::uint32_t index = link.joint;
    const JointRecord& joint = world_.joints[index];
    if (joint.break_force.raw == 0 && joint.break_torque.raw == 0) continue;
    const JointView now = view_of(world_, joint);
    if (!exceeds(now.force, joint.break_force) && !exceeds(now.torque, joint.break_torque)) {
      continue;
    }
    events_.push_back({{index, joint.generation}, now.body_a, now.body_b, joint.user_data});
  }
  for (const JointEvent& event : events_)
    destroy(event.joint.index);
}

void JointRegistry::mark_awake() {
  for (const JointLink& joint : world_.joint_graph.awake_links())
    world_.hashes.joints.mark(joint.joint);
}

// Before joints that give way, whose view tells of it.
void JointRegistry::advance() {
  for (const JointLink& link : world_.joint_graph.awake_links()) {
    JointRecord& joint = world_.joints[link.joint];
    if (joint.is(JointKind::ratchet) || joint.is(JointKind::path)) advance_joint(world_, joint);
  }
}

void JointRegistry::rebuild() {
  free_hint_ = 0;
  world_.joint_graph.rebuild(std::span(world_.joints).first(world_.header.joint_limit),
                             [&](const JointRecord& joint) { return world_.exempt_pair(joint); });
}

Status CommandExecutor::execute(const CreateJoint& command) {
  return world_.joint_registry.create(command.def).status();
}

Status CommandExecutor::execute(const DestroyJoint& command) {
  if (world_.find(command.joint) == nullptr) return Status::stale_handle;
  world_.joint_registry.destroy(command.joint.index);
  return Status::ok;
}

// `first`: of the three axes that the command may name.
template <class SetAxis>
Status CommandExecutor::set_axis_of(const SetAxis& command, std::size_t first) {
  JointRecord* joint = world_.edit(command.joint);
  if (joint == nullptr) return Status::stale_handle;
  if (command.axis > 2) return Status::invalid_argument;
  JointRecord changed = *joint;
  set_axis(changed, first + command.axis, command.settings);
  keep_progress(world_, *joint, changed);
  if (validate(changed) != Status::ok) return Status::invalid_argument;
  if (*joint == changed) return Status::ok;
  world_.waking.wake_ends(changed);
  *joint = changed;
  return Status::ok;
}

Status CommandExecutor::execute(const SetLinearAxis& command) {
  return set_axis_of(command, 0);
}

Status CommandExecutor::execute(const SetAngularAxis& command) {
  return set_axis_of(command, 3);
}

Result<JointHandle> World::create_joint(const JointDef& def) {
  return impl_->joint_registry.create(def);
}
std::span<const JointEvent> World::joint_events() const {
  return impl_->joint_registry.events();
}
bool World::exists(JointHandle joint) const {
  return impl_->find(joint) != nullptr;
}
std::uint32_t World::joint_count() const {
  return static_cast<std::uint32_t>(impl_->joint_graph.links().size());
}
std::uint32_t World::joint_limit() const {
  return impl_->header.joint_limit;
}
JointHandle World::joint_at(std::uint32_t index) const {
  if (index >= impl_->header.joint_limit || !impl_->joints[index].exists()) return {};
  return {index, impl_->joints[index].generation};
}
JointView World::joint(JointHandle joint) const {
  const JointRecord* record = impl_->find(joint);
  if (record == nullptr)
    misused("World::joint", joint.index, joint.generation,
            "names no joint (destroyed, or broken?); ask World::exists first");
  return view_of(*impl_, *record);
}

}  // namespace lockstone
