// Why commands are refused: the checks of World::apply, field by field. A test holds the two
// together.

#include <algorithm>

#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/state/limits.h"
#include "core/dynamics/state/one_way_bits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/body_changes.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/refusal_finder.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/commands/terrain_changes.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/vehicle/vehicle_phase.h"
#include "core/world/world_impl.h"

namespace lockstone {

/// Checks one command of a world; the checks of each group of commands are a class inside it.
class CommandExplainer {
 public:
  class Subjects;
  class Motion;
  class Properties;
  class Nature;
  class Existence;
  struct All;
};

namespace {

void require_enabled(RefusalFinder& find, const BodyRecord& record) {
  find.require(is_enabled(record), "body", "a disabled body", "enabled");
}

}  // namespace

/// The bodies and joints that commands name, with the checks that several commands share.
class CommandExplainer::Subjects {
 public:
  Subjects(const World& of_world, World::Impl& of_impl, std::string prefix)
      : world(of_world), impl(of_impl), find(std::move(prefix)) {}

  const BodyRecord* body(BodyHandle handle) {
    const BodyRecord* record = impl.find(handle);
    find.require(record != nullptr, "body",
                 RefusalFinder::handle_text(handle.index, handle.generation),
                 "the handle of a body that exists");
    return record;
  }

  const JointRecord* joint(JointHandle handle) {
    const JointRecord* record = impl.find(handle);
    find.require(record != nullptr, "joint",
                 RefusalFinder::handle_text(handle.index, handle.generation),
                 "the handle of a joint that exists");
    return record;
  }

  void require_motion(const BodyRecord& record, bool good, std::string_view wanted) {
    find.require(good, "body",
                 joined({"a ", to_string(static_cast<MotionType>(record.motion)), " body"}),
                 wanted);
  }

  const BodyRecord* moving(BodyHandle handle) {
    const BodyRecord* record = body(handle);
    if (record != nullptr) require_motion(*record, record->moves(), "kinematic or dynamic");
    return record;
  }

  void placed(const Vec3<Position>& position, const Quat& orientation) {
    find.within("position", position, k_world_limit, "m");
    find.direction("orientation", orientation);
  }

  const World& world;
  World::Impl& impl;
  RefusalFinder find;
};

/// Checks the commands that move a body: places, velocities, impulses and forces.
class CommandExplainer::Motion {
 public:
  explicit Motion(Subjects& on) : on_(on) {}

  void of(const Teleport& c) {
    if (on_.body(c.body) == nullptr) return;
    on_.placed(c.position, c.orientation);
    if (on_.find.done()) return;
    on_.find.within("position (of the centre of mass)", target_of(c).position, k_world_limit, "m");
  }

  void of(const SetVelocity& c) {
    if (on_.moving(c.body) != nullptr) {
      on_.find.within("velocity", c.velocity, k_speed_limit, "m/s");
    }
  }
  void of(const SetAngularVelocity& c) {
    const BodyRecord* record = on_.moving(c.body);
    if (record != nullptr) check_turning(on_.find, c.angular_velocity, record->scale_exponent);
  }

  void of(const ApplyImpulse& c) { push(c.body, c.frame); }
  void of(const ApplyAngularImpulse& c) { push(c.body, c.frame); }
  void of(const ApplyForce& c) { force(c.body, push(c.body, c.frame)); }
  void of(const ApplyTorque& c) { force(c.body, push(c.body, c.frame)); }
  void of(const ApplyImpulseAt& c) { (void)push_at(c); }
  void of(const ApplyForceAt& c) { force(c.body, push_at(c)); }

  void of(const MoveKinematic& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, !record->is_dynamic() && record->moves(), "kinematic");
    on_.placed(c.position, c.orientation);
    if (on_.find.done()) return;
    const Vec3<Position> now = on_.world.position(c.body);
    Vec3<Velocity> velocity, spin;
    const bool near = motion_to(*record, target_of(c), on_.impl.def.tick_rate, velocity, spin);
    on_.find.require(near, "position",
                     joined({"from ", to_decimal(now), " to ", to_decimal(c.position), " m"}),
                     "so near, in place and orientation, that 500 m/s reach it in one tick");
  }

 private:
  template <class Move>
  [[nodiscard]] Transform target_of(const Move& c) const {
    return body_pose(on_.impl.cache.asset(c.body.index), {c.position, c.orientation});
  }

  bool push(BodyHandle handle, Frame frame) {
    const BodyRecord* record = on_.body(handle);
    if (record == nullptr) return false;
    on_.require_motion(*record, record->is_dynamic(), "dynamic");
    on_.find.known("frame", frame, Frame::world, Frame::body);
    return !on_.find.done();
  }

  void force(BodyHandle handle, bool good) {
    if (good) require_enabled(on_.find, *on_.impl.find(handle));
  }

  template <class Push>
  bool push_at(const Push& c) {
    if (!push(c.body, c.frame)) return false;
    TickGain unused;
    const bool near = gain_of(on_.impl, c.body, {{}, {}, &c.point, c.frame}, unused) == Status::ok;
    const BodyRecord& record = *on_.impl.find(c.body);
    const Length radius = properties_of(record.shape(), on_.impl.cache.asset(c.body.index)).radius;
    on_.find.require(near, "point", joined({to_decimal(c.point), " m"}),
                     joined({"within twice the body's radius, ", to_decimal(radius),
                             " m, of its centre of mass along each axis"}));
    return !on_.find.done();
  }

  Subjects& on_;
};

/// Checks the commands that change a property of a body or of the world.
class CommandExplainer::Properties {
 public:
  explicit Properties(Subjects& on) : on_(on) {}

  void of(const SetFilter& c) { (void)on_.body(c.body); }
  void of(const SetUserData& c) { (void)on_.body(c.body); }
  void of(const SetMaterial& c) {
    if (on_.body(c.body) != nullptr) check(on_.find, c.surface);
  }
  void of(const SetSurfaceMotion& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, !record->is_dynamic(), "static or kinematic");
    check(on_.find, c.motion);
  }
  void of(const SetGravityScale& c) {
    if (on_.body(c.body) == nullptr) return;
    on_.find.within("scale", c.scale, -k_gravity_scale_limit, k_gravity_scale_limit);
  }
  void of(const SetDamping& c) {
    if (on_.body(c.body) == nullptr) return;
    on_.find.at_least("linear", c.linear, Rate{}, "1/s");
    on_.find.at_least("angular", c.angular, Rate{}, "1/s");
  }
  void of(const SetAxisLocks& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, record->is_dynamic(), "dynamic");
    BodyRecord locked = *record;
    locked.locks = locks_of(c.locks);
    on_.find.require(on_.impl.joint_registry.fits(c.body.index, locked), "locks",
                     "a body that turns", "such that every joint of the body is near enough to it");
  }
  void of(const SetSpeedLimit& c) {
    if (on_.body(c.body) != nullptr) check(on_.find, c.limit);
  }
  void of(const SetEvents& c) {
    if (on_.body(c.body) != nullptr) check(on_.find, c.settings);
  }
  void of(const SetFluid& c) {
    on_.find.within("number", c.number, 0U, k_max_fluids - 1);
    if (c.fluid.density != Density{}) check(on_.find, c.fluid);
  }
  void of(const SetVehicle& c) {
    const BodyRecord* record = on_.body(c.chassis);
    if (record == nullptr || !c.def) return;
    on_.require_motion(*record, record->is_dynamic(), "dynamic");
    on_.find.require(is_valid(*c.def), "def", "a number out of its range",
                     "within the ranges of lockstone/vehicle.h");
    on_.find.require(can_be_chassis(on_.impl, c.chassis.index), "def", "one more vehicle",
                     joined({"one of WorldDef::vehicle_capacity, ",
                             std::to_string(on_.impl.def.vehicle_capacity)}));
  }
  void of(const DriveVehicle& c) {
    if (on_.body(c.chassis) == nullptr) return;
    on_.find.require(find_vehicle(on_.impl, c.chassis.index) != nullptr, "chassis",
                     "a body without wheels", "the chassis of a vehicle");
  }
  void of(const SetHeights& c) {
    if (on_.body(c.body) == nullptr) return;
    on_.find.require(terrain_of(on_.impl, c.body.index) != nullptr, "body",
                     "a body without a height field", "one with a height field");
    if (on_.find.done()) return;
    require_valid(c);
    if (on_.find.done()) return;
    on_.find.require(has_room_for(on_.impl, c), "body", "more changed tiles than there is room for",
                     joined({"one whose change fits WorldDef::terrain_tile_capacity, ",
                             std::to_string(on_.impl.def.terrain_tile_capacity)}));
  }
  void of(const SetMeshGroup& c) {
    if (on_.body(c.body) == nullptr) return;
    on_.find.require(mesh_groups_of(on_.impl, c.body.index) != nullptr, "body",
                     "a body without a mesh of groups", "one with a mesh of groups");
    if (on_.find.done()) return;
    on_.find.require(has_group(on_.impl, c), "group", std::to_string(c.group),
                     "one with triangles");
    on_.find.require(has_room_for(on_.impl, c), "group", "one more than there is room for",
                     "one that fits WorldDef::terrain_tile_capacity");
  }
  void of(const SetOneWay& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, !record->is_dynamic(), "static or kinematic");
    if (c.one_way.direction != Vec3<Unit>{})
      on_.find.within("one_way.tolerance", std::uint32_t{c.one_way.tolerance}, 1U,
                      k_most_one_way_degrees);
  }
  void of(const SetPairRule& c) {
    if (on_.body(c.a) == nullptr || on_.body(c.b) == nullptr) return;
    on_.find.require(c.a != c.b, "b", "the same body as a", "another body");
    if (c.rule.surface) check(on_.find, *c.rule.surface);
    const bool removes = c.rule == PairRule{};
    on_.find.require(removes || has_room_for_rule(on_.impl, rule_key(c.a.index, c.b.index)), "rule",
                     "one more than there is room for",
                     joined({"one of at most ", std::to_string(k_max_pair_rules)}));
  }
  void of(const SetSurfaceRule& c) {
    if (!c.surface) return;
    check(on_.find, *c.surface);
    on_.find.require(has_room_for_surface_rule(on_.impl, rule_key(c.tag_a, c.tag_b)), "surface",
                     "one more than there is room for",
                     joined({"one of at most ", std::to_string(k_max_surface_rules)}));
  }
  void of(const SetGravity& c) {
    on_.find.within("gravity", c.gravity, Acceleration::from_integer(1000), "m/s²");
  }

 private:
  void require_valid(const SetHeights& c) {
    const HeightsFault fault = fault_of(on_.impl, c);
    const std::string samples = std::to_string(std::size_t{c.columns} * c.rows);
    const auto require = [&](HeightsFault bad, std::string_view field, std::size_t value,
                             std::string_view rule) {
      on_.find.require(fault != bad, field, std::to_string(value), rule);
    };
    require(HeightsFault::columns, "columns", c.columns, "1 or more, within the grid from column");
    require(HeightsFault::rows, "rows", c.rows, "1 or more, within the grid from row");
    require(HeightsFault::heights, "heights", c.heights.size(),
            joined({"none, or columns × rows (", samples, ") heights of ±512 m"}));
    require(HeightsFault::holes, "holes", c.holes.size(),
            "none, or as many as there are cells between the samples");
    require(HeightsFault::cell_surfaces, "cell_surfaces", c.cell_surfaces.size(),
            "none, or as many surfaces of the asset as there are cells between the samples");
    require(HeightsFault::nothing, "heights", 0, "given, or holes or surfaces");
  }

  Subjects& on_;
};

/// Checks the commands that change a body itself.
class CommandExplainer::Nature {
 public:
  explicit Nature(Subjects& on) : on_(on) {}

  void of(const SetEnabled& c) { (void)on_.body(c.body); }
  void of(const SetMotionType& c) {
    const BodyRecord* record = on_.body(c.body);
    on_.find.known("motion", c.motion, MotionType::static_body, MotionType::dynamic);
    if (on_.find.done()) return;
    if (c.motion == static_cast<MotionType>(record->motion)) return;
    const BodyRecord changed = with_motion(on_.impl, c.body.index, c.motion);
    on_.find.require(can_become(on_.impl, c.body.index, changed), "motion", to_string(c.motion),
                     "one for which the shape has a volume, each joint has a dynamic body, and "
                     "joints are near enough");
    if (changed.is_dynamic() && !on_.find.done())
      on_.find.within("mass", mass_as_dynamic(on_.impl, c), k_min_mass, k_max_mass, "kg");
  }
  void of(const SetShape& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    const Asset* asset = is_asset(c.shape.kind) ? on_.impl.assets->find(c.shape.asset) : nullptr;
    check(on_.find, c.shape, asset);
    if (on_.find.done()) return;
    if (record->is_dynamic() && c.mass != Mass{})
      on_.find.within("mass", c.mass, k_min_mass, k_max_mass, "kg");
    if (on_.find.done()) return;
    on_.find.require(can_take_shape(on_.impl, c, geometry::geometry_of(asset)), "shape",
                     to_string(c.shape.kind),
                     "one with a volume for a body that moves, with its centre of mass in the "
                     "world and near enough to the body's joints");
  }
  void of(const SetMassData& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, record->is_dynamic(), "dynamic");
    const Mass mass = c.data.mass == Mass{} ? mass_of(*record) : c.data.mass;
    on_.find.within("data.mass", mass, k_min_mass, k_max_mass, "kg");
    check_moments(on_.find, "data.inertia", {mass, c.data.inertia}, record->scale_exponent);
  }

 private:
  Subjects& on_;
};

/// Checks the commands that create and destroy, move joints' axes, and let bodies sleep or wake.
class CommandExplainer::Existence {
 public:
  explicit Existence(Subjects& on) : on_(on) {}

  void of(const std::monostate&) { on_.find.require(false, "command", "none", "a command"); }
  void of(const CreateBody& c) { on_.find.adopt(on_.world.explain(c.def)); }
  void of(const CreateJoint& c) { on_.find.adopt(on_.world.explain(c.def)); }
  void of(const DestroyBody& c) { (void)on_.body(c.body); }
  void of(const DestroyJoint& c) { (void)on_.joint(c.joint); }

  void of(const WakeBody& c) { (void)on_.moving(c.body); }
  void of(const SetAllowSleep& c) { (void)on_.moving(c.body); }
  void of(const SleepBody& c) {
    const BodyRecord* record = on_.body(c.body);
    if (record == nullptr) return;
    on_.require_motion(*record, record->is_dynamic(), "dynamic");
    require_enabled(on_.find, *record);
    on_.find.require(on_.impl.sleep_flags.rest_rules().ticks != 0, "body",
                     "in a world whose sleep_ms is 0", "in a world where bodies sleep");
    const bool free = on_.find.done() || record->is_asleep() ||
                      on_.impl.island_sleep.may_island_sleep(c.body.index);
    on_.find.require(free, "body", "in an island with a body whose allow_sleep is false",
                     "free to sleep");
  }

  void of(const SetLinearAxis& c) { axis(c); }
  void of(const SetAngularAxis& c) { axis(c); }

 private:
  template <class SetAxis>
  void axis(const SetAxis& c) {
    const JointRecord* record = on_.joint(c.joint);
    if (record == nullptr) return;
    on_.find.within("axis", std::uint32_t{c.axis}, 0U, 2U);
    if (on_.find.done()) return;
    check_axis(on_.find, static_cast<JointKind>(record->kind), c.axis, c.settings);
  }

  Subjects& on_;
};

/// `of(command)` for each kind of command.
struct CommandExplainer::All : Motion, Properties, Nature, Existence {
  explicit All(Subjects& on) : Motion(on), Properties(on), Nature(on), Existence(on) {}
  using Existence::of;
  using Motion::of;
  using Nature::of;
  using Properties::of;
};

Refusal World::explain(const Command& command) const {
  CommandExplainer::Subjects subjects(*this, *impl_, std::string(name_of(command)) + '.');
  CommandExplainer::All explainer(subjects);
  std::visit([&](const auto& c) { explainer.of(c); }, command);
  return subjects.find.take();
}

}  // namespace lockstone
