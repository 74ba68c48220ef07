// Why definitions are refused: the checks of `create`, `create_body` and `create_joint`, field by
// field. A test holds the two together.

#include <algorithm>
#include <array>

#include "core/dynamics/state/limits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/convex/solid.h"
#include "core/math/block_float.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/joint_progress.h"
#include "core/world/commands/refusal_finder.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/fluids.h"
#include "core/world/state/record_checks.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr Coefficient k_most_friction = Coefficient::from_ratio(199, 100);
constexpr Coefficient k_one = Coefficient::from_integer(1);

void check_sizes(RefusalFinder& find, const Shape& shape) {
  const geometry::ShapeTraits* traits = geometry::find_traits(shape.kind);
  const int used = traits == nullptr ? 0 : std::min(traits->size_count, 3);
  for (int i = 0; i < 3; ++i) {
    if (i < used) {
      const std::string_view name = traits->size_names[static_cast<std::size_t>(i)];
      find.within(joined({"shape.", name}), shape.size[i], least_size(shape), k_max_shape_size,
                  "m");
    } else {
      const std::string_view axis = std::string_view("xyz").substr(static_cast<std::size_t>(i), 1);
      find.require(shape.size[i] == Length{}, joined({"shape.size.", axis}),
                   RefusalFinder::text(shape.size[i], "m"),
                   joined({"0 m for a ", to_string(shape.kind)}));
    }
  }
  if (traits == nullptr || !has_fourth_size(shape.kind)) return;
  const Length most = k_max_shape_size - max(max(shape.size.x, shape.size.y), shape.size.z);
  find.within(joined({"shape.", traits->size_names[3]}), shape.fourth_size(), k_min_shape_size,
              most, "m");
}

}  // namespace

void check(RefusalFinder& find, const Shape& shape, const Asset* asset) {
  find.known("shape.kind", shape.kind, ShapeKind::sphere, k_last_shape_kind);
  if (find.done()) return;
  const std::string_view kind = to_string(shape.kind);
  const std::string id = hexadecimal(shape.asset.value);
  check_sizes(find, shape);
  if (!is_asset(shape.kind)) {
    find.require(shape.asset_id().is_null(), "shape.asset", id, joined({"null for a ", kind}));
    return;
  }
  find.require(!shape.asset.is_null(), "shape.asset", id,
               joined({"an asset's id for a ", kind, ": use Asset::shape"}));
  find.require(asset != nullptr, "shape.asset", id, "in the AssetSet that the world was made with");
  if (asset != nullptr) {
    find.require(asset->kind() == shape.kind, "shape.kind", kind,
                 joined({to_string(asset->kind()), ", as the asset is"}));
  }
}

void check_moments(RefusalFinder& find, std::string_view field, const MassData& data,
                   int scale_exponent) {
  if (find.done() || has_valid_mass_data(data, scale_exponent)) return;
  find.require(false, field, joined({to_decimal(data.inertia), " kg·m²"}),
               joined({"all 0, or each above 0 and at most the mass times (2^",
                       std::to_string(scale_exponent), " m)²"}));
}

namespace {

void check_mass(RefusalFinder& find, const BodyDef& def, const geometry::AssetGeometry* asset) {
  if (!has_solid(def.shape, asset)) {
    const bool may_move = may_have(MotionType::kinematic, def.shape, asset);
    find.require(may_have(def.motion, def.shape, asset), "motion", to_string(def.motion),
                 joined({may_move ? "static or kinematic" : "static", " for a ",
                         to_string(def.shape.kind), " without volume"}));
    return;
  }
  if (def.motion != MotionType::dynamic) return;
  const bool is_given = def.mass.mass != Mass{};
  find.within(is_given ? "mass.mass" : "mass (volume of the shape · material.density)",
              mass_of(def, asset), k_min_mass, k_max_mass, "kg");
  check_moments(find, "mass.inertia", {mass_of(def, asset), def.mass.inertia},
                properties_of(def.shape, asset).scale_exponent);
}

void check_own_fields(RefusalFinder& find, const BodyDef& def) {
  find.within("position", def.position, k_world_limit, "m");
  find.direction("orientation", def.orientation);
  find.within("velocity", def.velocity, k_speed_limit, "m/s");
  RefusalFinder of_material("body.material.");
  check(of_material, def.material.surface());
  of_material.above_zero("density", def.material.density, "kg/m³");
  find.adopt(of_material.take());
  RefusalFinder of_surface("body.surface_motion.");
  check(of_surface, def.surface_motion);
  find.adopt(of_surface.take());
  find.require(def.motion != MotionType::dynamic || def.surface_motion == SurfaceMotion{},
               "surface_motion", "not zero", "zero for a dynamic body");
  find.within("gravity_scale", def.gravity_scale, -k_gravity_scale_limit, k_gravity_scale_limit);
  find.at_least("linear_damping", def.linear_damping, Rate{}, "1/s");
  find.at_least("angular_damping", def.angular_damping, Rate{}, "1/s");
  RefusalFinder of_limit("body.speed_limit.");
  check(of_limit, def.speed_limit);
  find.adopt(of_limit.take());
  RefusalFinder of_events("body.events.");
  check(of_events, def.events);
  find.adopt(of_events.take());
}

template <class Axis>
void check_axis_settings(RefusalFinder& find, const Axis& axis, std::string_view unit,
                         std::string_view effort_unit) {
  find.known("mode", axis.mode, AxisMode::locked, AxisMode::limited);
  find.within("hertz", axis.hertz, Number{}, Number::from_integer(1000), "Hz");
  find.within("damping_ratio", axis.damping_ratio, Number{}, Number::from_integer(100));
  using Effort = decltype(axis.max_effort);
  find.within("max_effort", axis.max_effort, Effort{}, Effort::from_raw(k_effort_limit),
              effort_unit);
  if (axis.lower > axis.upper) {
    find.require(false, "lower", RefusalFinder::text(axis.lower, unit),
                 joined({"at most the upper limit, ", RefusalFinder::text(axis.upper, unit)}));
  }
}

// A joint whose axes were never set as its kind asks.
void check_made_by_of(RefusalFinder& find, const JointDef& def) {
  find.require(holds_something(def), "kind", joined({to_string(def.kind), " with all axes free"}),
               "made by JointDef::of(kind, a, b), which locks the axes of the kind");
}

void check_ratio(RefusalFinder& find, const JointDef& def) {
  if (def.kind == JointKind::ratchet) {
    find.require(is_teeth(def.ratio), "ratio", RefusalFinder::text(def.ratio, "teeth"),
                 "a whole number, 2 … 1000");
    return;
  }
  const bool positive = def.kind == JointKind::pulley;
  find.within("ratio", def.ratio, positive ? Number::from_raw(1) : Number::from_raw(-k_ratio_limit),
              Number::from_raw(k_ratio_limit));
}

void check_anchor(RefusalFinder& find, std::string_view field, const BodyRecord& body,
                  const JointFrame& frame, const Vec3<Length>& anchor) {
  if (is_anchor(body, anchor)) return;
  find.require(false, field, joined({to_decimal(frame.position), " m"}),
               joined({"within ", to_decimal(anchor_reach(body)),
                       " m of the centre of mass along each axis"}));
}

void check_forces(RefusalFinder& find, const JointDef& def) {
  find.within("ground_a", def.ground_a, k_world_limit, "m");
  find.within("ground_b", def.ground_b, k_world_limit, "m");
  find.within("break_force", def.break_force, Force{}, Force::from_raw(k_effort_limit), "N");
  find.within("break_torque", def.break_torque, Torque{}, Torque::from_raw(k_effort_limit), "N·m");
}

}  // namespace

void check(RefusalFinder& find, const Surface& surface) {
  const CombineRule first = CombineRule::standard, last = CombineRule::maximum;
  find.within("friction", surface.friction, Coefficient{}, k_most_friction);
  find.within("restitution", surface.restitution, Coefficient{}, k_one);
  find.within("rolling_resistance", surface.rolling_resistance, Coefficient{}, k_one);
  find.known("friction_rule", surface.friction_rule, first, last);
  find.known("restitution_rule", surface.restitution_rule, first, last);
  find.known("rolling_rule", surface.rolling_rule, first, last);
}

void check(RefusalFinder& find, const SurfaceMotion& motion) {
  find.within("velocity", motion.velocity, SolverVelocity::from_integer(500), "m/s");
  find.within("turning", motion.turning, Rate::from_integer(500), "rad/s");
}

void check(RefusalFinder& find, const SpeedLimit& limit) {
  find.above_zero("linear", limit.linear, "m/s");
  find.above_zero("angular", limit.angular, "rad/s");
}

void check(RefusalFinder& find, const EventSettings& settings) {
  find.within("hit_speed", settings.hit_speed, SolverVelocity{}, k_most_hit_speed, "m/s");
}

void check(RefusalFinder& find, const PairSurface& surface) {
  find.within("surface.friction", surface.friction, Coefficient{}, k_most_friction);
  find.within("surface.restitution", surface.restitution, Coefficient{}, k_one);
  find.within("surface.rolling_resistance", surface.rolling_resistance, Coefficient{}, k_one);
}

void check(RefusalFinder& find, const Fluid& fluid) {
  constexpr Position k_least = Position::from_raw(1);
  find.within("fluid.surface", fluid.surface, k_world_limit, "m");
  find.direction("fluid.orientation", fluid.orientation);
  find.within("fluid.size.x", fluid.size.x, k_least, k_most_fluid_size, "m");
  find.within("fluid.size.y", fluid.size.y, k_least, k_most_fluid_size, "m");
  find.within("fluid.size.z", fluid.size.z, k_least, k_most_fluid_size, "m");
  find.at_least("fluid.density", fluid.density, Density{}, "kg/m³");
  find.within("fluid.drag", fluid.drag, Number{}, k_most_fluid_drag);
  find.at_least("fluid.linear_drag", fluid.linear_drag, Rate{}, "1/s");
  find.within("fluid.flow", fluid.flow, k_speed_limit, "m/s");
}

void check_axis(RefusalFinder& joint, JointKind kind, std::size_t axis,
                const LinearAxis& settings) {
  RefusalFinder find = joint.part(joined({"linear[", std::to_string(axis), "]."}));
  check_axis_settings(find, settings, "m", "N");
  if (kind == JointKind::distance && axis == 0)
    find.at_least("lower", settings.lower, Length{}, "m");
  if (kind == JointKind::path) {
    const bool is_locked = settings.mode == AxisMode::locked;
    const bool is_driven = settings.hertz > Number{} || settings.max_effort > Force{};
    find.require(axis == 0 ? !is_locked : is_locked && !is_driven, "mode", to_string(settings.mode),
                 axis == 0 ? "free or limited: along the path" : "locked, without a drive: a path");
  }
  joint.adopt(find.take());
}

void check_axis(RefusalFinder& joint, JointKind kind, std::size_t axis,
                const AngularAxis& settings) {
  RefusalFinder find = joint.part(joined({"angular[", std::to_string(axis), "]."}));
  const Angle pi = Angle::from_raw(k_pi);
  check_axis_settings(find, settings, "rad", "N·m");
  find.within("lower", settings.lower, -pi, pi, "rad");
  find.within("upper", settings.upper, -pi, pi, "rad");
  find.within("target", settings.target, -pi, pi, "rad");
  if (kind == JointKind::ball && axis == 1) find.at_least("upper", settings.upper, Angle{}, "rad");
  joint.adopt(find.take());
}

void check_turning(RefusalFinder& find, const Vec3<AngularVelocity>& turning, int exponent) {
  Vec3<Velocity> surface;
  if (find.done() || to_surface_velocity(turning, exponent, surface)) return;
  const std::int64_t most =
      std::min(raw::scale_saturating(k_speed_limit.raw, -exponent), std::int64_t{1} << 52);
  find.within("angular_velocity", turning, AngularVelocity::from_raw(most), "rad/s");
}

std::string Refusal::to_line() const {
  if (field.empty()) return "nothing is wrong";
  return joined({field, ": ", value, ", ", rule});
}

Refusal World::explain(const WorldDef& def) {
  RefusalFinder find("world.");
  find.within("body_capacity", def.body_capacity, 1U, 1U << 20);
  find.within("pair_capacity", def.pair_capacity, 1U, 1U << 24);
  find.within("contact_capacity", def.contact_capacity, 1U, 1U << 24);
  find.within("joint_capacity", def.joint_capacity, 0U, 1U << 20);
  find.within("vehicle_capacity", def.vehicle_capacity, 0U, k_max_vehicles);
  find.within("terrain_tile_capacity", def.terrain_tile_capacity, 0U, k_max_terrain_tiles);
  find.within("converged_contacts", def.converged_contacts, 0U, 1U << 16);
  find.within("tick_rate", std::uint32_t{def.tick_rate}, 10U, 480U, "ticks/s");
  find.within("substeps", std::uint32_t{def.substeps}, 1U, 16U);
  find.within("sleep_ms", std::uint32_t{def.sleep_ms}, 0U, 60'000U, "ms");
  find.within("sleep_distance", def.sleep_distance, Length::from_ratio(1, 1000),
              Length::from_integer(1), "m");
  find.within("gravity", def.gravity, Acceleration::from_integer(1000), "m/s²");
  find.within("speed_limit", def.speed_limit, Velocity::from_integer(1), k_speed_limit, "m/s");
  find.known("broad_phase", def.broad_phase, BroadPhaseKind::tree, BroadPhaseKind::sweep_and_prune);
  return find.take();
}

Refusal World::explain(const BodyDef& def) const {
  RefusalFinder find("body.");
  const Asset* named = is_asset(def.shape.kind) ? impl_->assets->find(def.shape.asset) : nullptr;
  const geometry::AssetGeometry* asset = geometry::geometry_of(named);
  find.known("motion", def.motion, MotionType::static_body, MotionType::dynamic);
  check(find, def.shape, named);
  check_own_fields(find, def);
  if (find.done()) return find.take();
  check_mass(find, def, asset);
  find.within("position (of the centre of mass)",
              body_pose(asset, {def.position, def.orientation}).position, k_world_limit, "m");
  check_turning(find, def.angular_velocity,
                properties_of(def.shape, asset, def.motion).scale_exponent);
  const std::uint32_t capacity = impl_->def.body_capacity;
  find.require(body_count() < capacity, "count", std::to_string(body_count()),
               joined({"below WorldDef::body_capacity, ", std::to_string(capacity)}));
  return find.take();
}

Refusal World::explain(const JointDef& def) const {
  RefusalFinder find("joint.");
  const BodyRecord* a = impl_->find(def.body_a);
  const BodyRecord* b = impl_->find(def.body_b);
  const auto handle = [](BodyHandle body) {
    return RefusalFinder::handle_text(body.index, body.generation);
  };
  constexpr std::string_view k_body = "the handle of a body that exists";
  find.require(a != nullptr, "body_a", handle(def.body_a), k_body);
  find.require(b != nullptr, "body_b", handle(def.body_b), k_body);
  find.require(def.body_a != def.body_b, "body_b", handle(def.body_b), "another body than body_a");
  find.known("kind", def.kind, JointKind::distance, k_last_joint_kind);
  find.direction("frame_a.orientation", def.frame_a.orientation);
  find.direction("frame_b.orientation", def.frame_b.orientation);
  if (find.done()) return find.take();
  find.require(a->is_dynamic() || b->is_dynamic(), "body_a", "neither body is dynamic",
               "dynamic, or body_b");
  check_made_by_of(find, def);
  for (std::size_t i = 0; i < 3; ++i)
    check_axis(find, def.kind, i, def.linear[i]);
  for (std::size_t i = 0; i < 3; ++i)
    check_axis(find, def.kind, i, def.angular[i]);
  check_ratio(find, def);
  check_forces(find, def);
  if (find.done()) return find.take();
  JointRecord joint;
  (void)make_joint(def, impl_->cache.asset(def.body_a.index), impl_->cache.asset(def.body_b.index),
                   joint);
  check_anchor(find, "frame_a.position", *a, def.frame_a, joint.anchor_a);
  check_anchor(find, "frame_b.position", *b, def.frame_b, joint.anchor_b);
  find.require(!joint.is(JointKind::pulley) || find.done() || begin_joint(*impl_, joint),
               "ground_a", joined({to_decimal(def.ground_a), " m"}),
               "where each rope, and both by the ratio, are 1000 m long at most");
  find.require(!joint.is(JointKind::path) || find.done() || begin_joint(*impl_, joint), "path",
               hexadecimal(def.path.value), "the id of a path in the AssetSet of the world");
  const std::uint32_t capacity = impl_->def.joint_capacity;
  find.require(joint_count() < capacity, "count", std::to_string(joint_count()),
               joined({"below WorldDef::joint_capacity, ", std::to_string(capacity)}));
  return find.take();
}

}  // namespace lockstone
