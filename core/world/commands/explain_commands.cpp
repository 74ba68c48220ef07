// Why commands are refused: the checks of World::apply, field by field. A test holds the two
// together.

#include <algorithm>

#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/state/limits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/refusal_finder.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {

/// Checks one command of a world; `of(command)` for each kind.
class CommandExplainer {
 public:
  CommandExplainer(const World& world, World::Impl& impl, std::string prefix)
      : world_(world), impl_(impl), find_(std::move(prefix)) {}

  Refusal take() { return find_.take(); }

  void of(const std::monostate&) { find_.require(false, "command", "none", "a command"); }
  void of(const CreateBody& c) { find_.adopt(world_.explain(c.def)); }
  void of(const CreateJoint& c) { find_.adopt(world_.explain(c.def)); }
  void of(const DestroyBody& c) { (void)body(c.body); }
  void of(const DestroyJoint& c) { (void)joint(c.joint); }
  void of(const SetFilter& c) { (void)body(c.body); }
  void of(const SetUserData& c) { (void)body(c.body); }

  void of(const Teleport& c) {
    if (body(c.body) == nullptr) return;
    find_.within("position", c.position, k_world_limit, "m");
    find_.direction("orientation", c.orientation);
    if (find_.done()) return;
    find_.within("position (of the centre of mass)",
                 body_pose(impl_.cache.asset(c.body.index), {c.position, c.orientation}).position,
                 k_world_limit, "m");
  }

  void of(const SetVelocity& c) {
    if (moving(c.body) != nullptr) find_.within("velocity", c.velocity, k_speed_limit, "m/s");
  }
  void of(const SetAngularVelocity& c) {
    if (const BodyRecord* record = moving(c.body)) turning(*record, c.angular_velocity);
  }

  void of(const ApplyImpulse& c) { push(c.body, c.frame); }
  void of(const ApplyAngularImpulse& c) { push(c.body, c.frame); }
  void of(const ApplyForce& c) { push(c.body, c.frame); }
  void of(const ApplyTorque& c) { push(c.body, c.frame); }
  void of(const ApplyImpulseAt& c) { push_at(c); }
  void of(const ApplyForceAt& c) { push_at(c); }

  void of(const MoveKinematic& c) {
    const BodyRecord* record = body(c.body);
    if (record == nullptr) return;
    require_motion(*record, !record->is_dynamic() && record->moves(), "kinematic");
    find_.within("position", c.position, k_world_limit, "m");
    find_.direction("orientation", c.orientation);
    if (find_.done()) return;
    const Vec3<Position> now = world_.position(c.body);
    const Transform target =
        body_pose(impl_.cache.asset(c.body.index), {c.position, c.orientation});
    Vec3<Velocity> velocity, spin;
    find_.require(motion_to(*record, target, impl_.def.tick_rate, velocity, spin), "position",
                  "from " + to_decimal(now) + " to " + to_decimal(c.position) + " m",
                  "so near, in place and orientation, that 500 m/s reach it in one tick");
  }

  void of(const SetMaterial& c) {
    if (body(c.body) != nullptr) check(find_, c.surface);
  }
  void of(const SetSurfaceMotion& c) {
    const BodyRecord* record = body(c.body);
    if (record == nullptr) return;
    require_motion(*record, !record->is_dynamic(), "static or kinematic");
    check(find_, c.motion);
  }
  void of(const SetGravityScale& c) {
    if (body(c.body) != nullptr)
      find_.within("scale", c.scale, -k_gravity_scale_limit, k_gravity_scale_limit);
  }
  void of(const SetDamping& c) {
    if (body(c.body) == nullptr) return;
    find_.at_least("linear", c.linear, Rate{}, "1/s");
    find_.at_least("angular", c.angular, Rate{}, "1/s");
  }
  void of(const SetAxisLocks& c) {
    const BodyRecord* record = body(c.body);
    if (record == nullptr) return;
    require_motion(*record, record->is_dynamic(), "dynamic");
    BodyRecord locked = *record;
    locked.locks = locks_of(c.locks);
    find_.require(impl_.joint_registry.fits(c.body.index, locked), "locks", "a body that turns",
                  "such that every joint of the body is near enough to it");
  }
  void of(const SetSpeedLimit& c) {
    if (body(c.body) != nullptr) check(find_, c.limit);
  }
  void of(const SetGravity& c) {
    find_.within("gravity", c.gravity, Acceleration::from_integer(1000), "m/s²");
  }

  void of(const WakeBody& c) { (void)moving(c.body); }
  void of(const SetAllowSleep& c) { (void)moving(c.body); }
  void of(const SleepBody& c) {
    const BodyRecord* record = body(c.body);
    if (record == nullptr) return;
    require_motion(*record, record->is_dynamic(), "dynamic");
    find_.require(impl_.sleep_flags.rest_rules().ticks != 0, "body",
                  "in a world whose sleep_ms is 0", "in a world where bodies sleep");
    find_.require(
        find_.done() || record->is_asleep() || impl_.island_sleep.may_island_sleep(c.body.index),
        "body", "in an island with a body whose allow_sleep is false", "free to sleep");
  }

  void of(const SetLinearAxis& c) { axis(c); }
  void of(const SetAngularAxis& c) { axis(c); }

 private:
  const BodyRecord* body(BodyHandle handle) {
    const BodyRecord* record = impl_.find(handle);
    find_.require(record != nullptr, "body",
                  RefusalFinder::handle_text(handle.index, handle.generation),
                  "the handle of a body that exists");
    return record;
  }

  const JointRecord* joint(JointHandle handle) {
    const JointRecord* record = impl_.find(handle);
    find_.require(record != nullptr, "joint",
                  RefusalFinder::handle_text(handle.index, handle.generation),
                  "the handle of a joint that exists");
    return record;
  }

  void require_motion(const BodyRecord& record, bool good, std::string_view wanted) {
    find_.require(good, "body",
                  "a " + std::string(to_string(static_cast<MotionType>(record.motion))) + " body",
                  wanted);
  }

  const BodyRecord* moving(BodyHandle handle) {
    const BodyRecord* record = body(handle);
    if (record != nullptr) require_motion(*record, record->moves(), "kinematic or dynamic");
    return record;
  }

  void turning(const BodyRecord& record, const Vec3<AngularVelocity>& omega) {
    check_turning(find_, omega, record.scale_exponent);
  }

  bool push(BodyHandle handle, Frame frame) {
    const BodyRecord* record = body(handle);
    if (record == nullptr) return false;
    require_motion(*record, record->is_dynamic(), "dynamic");
    find_.known("frame", frame, Frame::world, Frame::body);
    return !find_.done();
  }

  template <class Push>
  void push_at(const Push& c) {
    if (!push(c.body, c.frame)) return;
    TickGain unused;
    const bool near = gain_of(impl_, c.body, {{}, {}, &c.point, c.frame}, unused) == Status::ok;
    const BodyRecord& record = *impl_.find(c.body);
    const Length radius = properties_of(record.shape(), impl_.cache.asset(c.body.index)).radius;
    find_.require(near, "point", to_decimal(c.point) + " m",
                  "within twice the body's radius, " + to_decimal(radius) +
                      " m, of its centre of mass along each axis");
  }

  template <class SetAxis>
  void axis(const SetAxis& c) {
    const JointRecord* record = joint(c.joint);
    if (record == nullptr) return;
    find_.within("axis", std::uint32_t{c.axis}, 0U, 2U);
    if (!find_.done()) check_axis(find_, static_cast<JointKind>(record->kind), c.axis, c.settings);
  }

  const World& world_;
  World::Impl& impl_;
  RefusalFinder find_;
};

Refusal World::explain(const Command& command) const {
  CommandExplainer explainer(*this, *impl_, std::string(name_of(command)) + '.');
  std::visit([&](const auto& c) { explainer.of(c); }, command);
  return explainer.take();
}

}  // namespace lockstone
