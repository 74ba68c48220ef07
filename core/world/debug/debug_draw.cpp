// Debug drawing of a world.

#include <algorithm>

#include <lockstone/debug_draw.h>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/world/commands/joint_registry.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

Position from_bounds(BoundsCoordinate x) {
  return Position::from_raw(std::int64_t{x.raw} << (Position::frac_bits - 10));
}

DebugState state_of(const BodyRecord& body) {
  if (body.is_trigger()) return DebugState::trigger;
  if (body.is_dynamic()) return body.is_asleep() ? DebugState::asleep : DebugState::awake;
  return body.moves() ? DebugState::kinematic : DebugState::static_body;
}

class WorldDrawing {
 public:
  explicit WorldDrawing(World::Impl& world) : world_(world) {}

  void draw_shapes(DebugDraw& out);
  void draw_wheels(DebugDraw& out) const;
  void draw_bounds(DebugDraw& out) const;
  void draw_masses(DebugDraw& out) const;
  void draw_contacts(DebugDraw& out);
  void draw_joints(DebugDraw& out) const;

 private:
  void find_all_islands();
  [[nodiscard]] DebugContact drawn_contact(const ContactRecord& record,
                                           const Manifold& manifold) const;

  World::Impl& world_;
};

// Of all dynamic bodies there are, asleep ones too.
void WorldDrawing::find_all_islands() {
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i)
    if (world_.bodies[i].exists() && world_.bodies[i].is_dynamic())
      world_.islands.begin(std::span(&i, 1));
  const auto tie = [&](std::uint32_t a, std::uint32_t b) {
    if (world_.bodies[a].is_dynamic() && world_.bodies[b].is_dynamic()) world_.islands.join(a, b);
  };
  world_.for_each_contact([&](const ContactRecord& contact) {
    if (!contact.is_inert()) tie(contact.body_a, contact.body_b);
  });
  for (const JointLink& joint : world_.joint_graph.links())
    tie(joint.body_a, joint.body_b);
}

void WorldDrawing::draw_shapes(DebugDraw& out) {
  find_all_islands();
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    const BodyRecord& body = world_.bodies[i];
    if (!body.exists() || !is_enabled(body)) continue;
    const Transform pose = shape_pose(world_.cache.asset(i), {body.position, body.orientation});
    out.draw_shape(
        {.body = world_.handle_of(i),
         .state = state_of(body),
         .shape = body.shape(),
         .pose = pose,
         .rotation = to_matrix(pose.orientation),
         .asset = world_.assets->find(body.shape().asset_id()),
         .island = body.is_dynamic() ? world_.handle_of(world_.islands.root(i)) : BodyHandle{},
         .user_data = body.user_data});
  }
}

// Wheels are no bodies: spheres with the colours of their chassis.
void WorldDrawing::draw_wheels(DebugDraw& out) const {
  for (const VehicleRecord& vehicle :
       std::span(world_.vehicles).first(world_.header.vehicle_count)) {
    const std::uint32_t chassis = vehicle.chassis;
    const BodyRecord& body = world_.bodies[chassis];
    if (!is_enabled(body)) continue;
    const Transform frame =
        shape_pose(world_.cache.asset(chassis), {body.position, body.orientation});
    const Mat3 rotation = to_matrix(frame.orientation);
    for (std::size_t i = 0; i < std::size_t{2} * vehicle.axle_count; ++i) {
      const Vec3<Position> centre =
          frame.position + rounded<Position>(rotate(rotation, centre_of_wheel(vehicle, i)));
      out.draw_shape({.body = world_.handle_of(chassis),
                      .state = state_of(body),
                      .shape = Shape::sphere(vehicle.axles[i / 2].radius),
                      .pose = {centre, frame.orientation},
                      .rotation = rotation,
                      .user_data = body.user_data});
    }
  }
}

void WorldDrawing::draw_bounds(DebugDraw& out) const {
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    if (!world_.broad_phase.has(i)) continue;
    const Bounds& bounds = world_.broad_phase.bounds(i);
    DebugBounds drawn{.body = world_.handle_of(i)};
    for (int axis = 0; axis < 3; ++axis) {
      drawn.lower[axis] = from_bounds(bounds.lower[axis]);
      drawn.upper[axis] = from_bounds(bounds.upper[axis]);
    }
    out.draw_bounds(drawn);
  }
}

void WorldDrawing::draw_masses(DebugDraw& out) const {
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    if (!world_.bodies[i].exists() || !world_.bodies[i].is_dynamic()) continue;
    out.draw_mass({world_.handle_of(i), world_.bodies[i].position, world_.cache.rotation(i),
                   mass_of(world_.bodies[i])});
  }
}

// A manifold as bodies are now, with the impulses of the last step.
DebugContact WorldDrawing::drawn_contact(const ContactRecord& record,
                                         const Manifold& manifold) const {
  const BodyRecord& a = world_.bodies[record.body_a];
  const BodyRecord& b = world_.bodies[record.body_b];
  const BlockFloat inverse_mass = add(a.inverse_mass_value(), b.inverse_mass_value());
  const auto force_of = [&](SolverVelocity impulse) {
    return Force::from_raw(
        effort_of(impulse.raw, world_.time_step.substep_rate(), inverse_mass, 0));
  };
  DebugContact drawn{.a = world_.handle_of(record.body_a),
                     .b = world_.handle_of(record.body_b),
                     .normal = manifold.normal,
                     .touching = record.is_touching(),
                     .count = static_cast<std::uint32_t>(manifold.count)};
  for (int i = 0; i < 3; ++i)
    drawn.friction[i] = force_of(record.friction_impulse[i]);
  for (std::size_t i = 0; i < drawn.count; ++i) {
    const ManifoldPoint& point = manifold.points[i];
    drawn.points[i].point = place_between(point, a, b);
    drawn.points[i].separation = point.separation;
    drawn.points[i].force = force_of(record.impulse_of(point.feature));
  }
  return drawn;
}

void WorldDrawing::draw_contacts(DebugDraw& out) {
  PairScratch& scratch = world_.narrow.scratch();
  Pair collided;
  world_.for_each_contact([&](const ContactRecord& record) {
    if (record.is_inert()) return;
    const Pair pair{record.body_a, record.body_b};
    if (pair != collided) {
      collide_bodies(world_.placed(pair.a), world_.placed(pair.b), world_.narrow.margin_of(pair),
                     scratch.triangles.get(), scratch.part_contacts);
    }
    collided = pair;
    const auto part = std::ranges::find_if(scratch.part_contacts, [&](const PartContact& contact) {
      return contact.part_a == record.part_a && contact.part_b == record.part_b;
    });
    if (part != scratch.part_contacts.end())
      out.draw_contact(drawn_contact(record, part->manifold));
  });
}

void WorldDrawing::draw_joints(DebugDraw& out) const {
  for (const JointLink& link : world_.joint_graph.links()) {
    const JointRecord& joint = world_.joints[link.joint];
    const Mat3& turn_a = world_.cache.rotation(joint.body_a);
    const Mat3& turn_b = world_.cache.rotation(joint.body_b);
    DebugJoint drawn{
        .joint = {link.joint, joint.generation},
        .view = view_of(world_, joint),
        .place_a = world_.bodies[joint.body_a].position + arm_of(turn_a, joint.anchor_a),
        .place_b = world_.bodies[joint.body_b].position + arm_of(turn_b, joint.anchor_b),
        .frame_a = frame_of(turn_a, joint.orientation_a),
        .frame_b = frame_of(turn_b, joint.orientation_b),
        .ground_a = joint.ground_a,
        .ground_b = joint.ground_b,
    };
    for (std::size_t i = 0; i < 3; ++i) {
      drawn.modes[i] = joint.mode(i);
      drawn.modes[i + 3] = joint.mode(i + 3);
      drawn.linear_lower[i].raw = joint.axes[i].lower;
      drawn.linear_upper[i].raw = joint.axes[i].upper;
      drawn.angular_lower[i].raw = joint.axes[i + 3].lower;
      drawn.angular_upper[i].raw = joint.axes[i + 3].upper;
    }
    out.draw_joint(drawn);
  }
}

}  // namespace

void World::draw(DebugDraw& out, const DebugDrawOptions& options) const {
  WorldDrawing drawing(*impl_);
  if (options.shapes) drawing.draw_shapes(out);
  if (options.shapes) drawing.draw_wheels(out);
  if (options.bounds) drawing.draw_bounds(out);
  if (options.masses) drawing.draw_masses(out);
  if (options.contacts) drawing.draw_contacts(out);
  if (options.joints) drawing.draw_joints(out);
}

}  // namespace lockstone
