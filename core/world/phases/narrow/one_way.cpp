#include "core/world/phases/narrow/one_way.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/collision/continuous/first_impact.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/rounded_dot.h"
#include "core/world/derived/quantities.h"

namespace lockstone {
namespace {

// The least separation of all, Displacement::min(), has no opposite.
Displacement depth_of(const Manifold& manifold) {
  LKS_ASSERT(manifold.count > 0);
  const auto points = std::span(manifold.points).first(static_cast<std::size_t>(manifold.count));
  const auto deepest = std::ranges::min_element(points, {}, &ManifoldPoint::separation);
  return -max(deepest->separation, -Displacement::max());
}

// How deep a pair may be that is stopped, as it was a tick ago.
Displacement allowed_depth(const WorldData& world, const Pair& pair,
                           std::span<const ContactRecord> before) {
  if (before.empty()) {
    const Length half = world.cache.inner_radius(pair.a) / 2;
    return max(saturated<Displacement>(half), k_one_way_depth);
  }
  const bool passed = std::ranges::any_of(before, &ContactRecord::is_passing);
  return passed ? k_one_way_depth : Displacement::max();
}

// The front of a one-way body whose principal axes are turned like this.
Vec3<Unit> front_of(const WorldData& world, std::uint32_t body, const Mat3& rotation) {
  const Transform frame = body_pose(world.cache.asset(body), {});  // in the shape's frame
  const OneWay rule = one_way_of(world.bodies[body]);
  return rotate(rotation, rotate_inverse(to_matrix(frame.orientation), rule.direction));
}

// `normal`: away from the body. Every normal of a body that is not one-way holds.
bool holds(const WorldData& world, std::uint32_t body, const Mat3& rotation,
           const Vec3<Unit>& normal) {
  const BodyRecord& record = world.bodies[body];
  return !is_one_way(record) || rounded<Unit>(dot(front_of(world, body, rotation), normal)) >=
                                    least_cosine(one_way_of(record));
}

// Whether a motion against a one-way body goes with its front, or along it.
bool goes_with_front(const WorldData& world, std::uint32_t body, const Mat3& rotation,
                     const Vec3<Position>& motion) {
  return rounded_dot(motion, front_of(world, body, rotation)) >= 0;
}

}  // namespace

bool is_in_front(const WorldData& world, const Pair& pair, const Vec3<Unit>& normal) {
  return holds(world, pair.a, world.cache.rotation(pair.a), normal) &&
         holds(world, pair.b, world.cache.rotation(pair.b), -normal);
}

bool is_passing(const WorldData& world, const Pair& pair, std::span<const ContactRecord> before,
                PartContacts& parts) {
  const Displacement allowed = allowed_depth(world, pair, before);
  int kept = 0;
  bool is_deep = false;
  for (const PartContact& contact : parts) {
    if (!is_in_front(world, pair, contact.manifold.normal)) continue;
    is_deep = is_deep || depth_of(contact.manifold) > allowed;
    parts.contacts[static_cast<std::size_t>(kept++)] = contact;
  }
  const bool passes = is_deep || (kept == 0 && parts.count > 0);
  parts.count = passes ? 0 : kept;
  return passes;
}

bool passes_on_way(const WorldData& world, NarrowPhase& narrow, const Pair& pair,
                   const Sweep& way_a, const Sweep& way_b, Unit fraction) {
  LKS_ASSERT(!is_one_way(world.bodies[pair.a]));
  if (!is_one_way(world.bodies[pair.b])) return false;
  if (narrow.are_passing(pair.a, pair.b)) return true;
  const Transform pose_a = pose_at(way_a, fraction), pose_b = pose_at(way_b, fraction);
  const Mat3 turned_a = to_matrix(pose_a.orientation), turned_b = to_matrix(pose_b.orientation);
  if (goes_with_front(world, pair.b, turned_b, way_a.translation - way_b.translation)) return true;
  const Shape shape_a = world.bodies[pair.a].shape(), shape_b = world.bodies[pair.b].shape();
  PairScratch& scratch = narrow.scratch();
  collide_bodies(place(shape_a, world.cache.asset(pair.a), pose_a.position, turned_a),
                 place(shape_b, world.cache.asset(pair.b), pose_b.position, turned_b),
                 k_impact_gap * 4, scratch.triangles.get(), scratch.part_contacts);
  return std::ranges::none_of(scratch.part_contacts, [&](const PartContact& contact) {
    return holds(world, pair.b, turned_b, -contact.manifold.normal);
  });
}

}  // namespace lockstone
