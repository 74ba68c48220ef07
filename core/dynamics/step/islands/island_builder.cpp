#include "core/dynamics/step/islands/island_builder.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/geometry/contact/manifold/contact_choice.h"

namespace lockstone {
namespace {

// Whether shapes overlap as only bodies do that were pressed together: by more than 4 mm.
bool is_jammed(const Manifold& manifold) {
  constexpr Displacement k_deep = Displacement::from_ratio(-1, 250);
  return geometry::deepest_of(manifold) < geometry::fine(k_deep);
}

}  // namespace

IslandBuilder::IslandBuilder(std::size_t body_capacity, std::size_t contact_capacity)
    : islands_(body_capacity + contact_capacity + 1, body_capacity), pinched_(contact_capacity) {}

void IslandBuilder::build(const ContactScene& scene, const SolverBodies& bodies,
                          const ContactList& contacts) {
  knows_sources_ = false;
  join(scene, bodies, contacts);
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    IslandTally& own = tally(contact);
    ++own.contacts;
    own.fresh += contacts.is_new(contact) ? 1U : 0U;
    own.bearing += contacts.is_bearing(contact) ? 1U : 0U;
    LKS_ASSERT(own.fresh <= own.contacts && own.bearing <= own.contacts);
  });
  mark_pinched(scene, contacts);
}

void IslandBuilder::join(const ContactScene& scene, const SolverBodies& bodies,
                         const ContactList& contacts) {
  islands_.clear();
  for (std::uint32_t number = 1; number < bodies.count(); ++number)
    islands_.add_body(bodies.side(number).is_dynamic());
  const auto is_dynamic = [&](BodyRef body) {
    return !body.is_standing() && bodies.side(body.number()).is_dynamic();
  };
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    if (is_dynamic(contact.a) && is_dynamic(contact.b))
      islands_.join(contact.a.number(), contact.b.number());
  });
  for (const JointLink& link : scene.joint_links) {
    LKS_ASSERT(link.body_a != link.body_b);
    if (scene.bodies[link.body_a].is_dynamic() && scene.bodies[link.body_b].is_dynamic())
      islands_.join(bodies.number_of(link.body_a), bodies.number_of(link.body_b));
  }
  islands_.settle();
}

std::uint32_t IslandBuilder::of(const ContactScene& scene, const SolverBodies& bodies,
                                const JointLink& link) const {
  const bool is_a = scene.bodies[link.body_a].is_dynamic();
  const std::uint32_t island = islands_.of(bodies.number_of(is_a ? link.body_a : link.body_b));
  LKS_ASSERT(island != 0);
  return island;
}

// Where a body that no impulse moves holds an island by a contact.
ImmovablePush IslandBuilder::push_of(const ContactScene& scene, const ContactRef& contact) const {
  const bool holds_a = of(contact.a) == 0;
  if (!holds_a && of(contact.b) != 0) return {};
  const ContactRecord& record = scene.records[contact.record];
  const Vec3<Unit> normal = scene.manifolds[contact.manifold].normal;
  return {of(contact), holds_a ? record.body_a : record.body_b, holds_a ? normal : -normal};
}

void IslandBuilder::mark_pinched(const ContactScene& scene, const ContactList& contacts) {
  pinched_.clear();
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    const ImmovablePush push = push_of(scene, contact);
    if (push.island == 0) return;
    LKS_ASSERT(push.body < scene.bodies.size() && push.island < islands_.count());
    if (has_motion(scene.bodies[push.body]) || is_jammed(scene.manifolds[contact.manifold]))
      pinched_.add_pressing(push);
  });
  if (!pinched_.has_pressing()) return;
  pinched_.sort();
  // Most contacts with level ground are alike: the last push that pinches no island.
  ImmovablePush harmless{};
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    const ImmovablePush push = push_of(scene, contact);
    if (push.island == 0 || push == harmless || tally(push.island).is_pinched) return;
    tally(push.island).is_pinched = pinched_.is_pinched(push);
    if (!tally(push.island).is_pinched) harmless = push;
  });
}

void IslandBuilder::find_energy_sources(const ContactScene& scene, const SolverBodies& bodies,
                                        const ContactList& contacts) {
  if (knows_sources_) return;
  knows_sources_ = true;
  const auto moves = [&](std::uint32_t index) {
    return !scene.bodies[index].is_dynamic() && has_motion(scene.bodies[index]);
  };
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    const ContactRecord& record = scene.records[contact.record];
    const ContactSurface& surface = scene.surfaces[contact.manifold];
    if (surface.restitution != Coefficient{}) tally(contact).may_bounce = true;
    if (moves(record.body_a) || moves(record.body_b) || surface.twist_drive != Rate{} ||
        surface.drive != Vec3<SolverVelocity>{})
      tally(contact).is_fed = true;
  });
  for (const JointLink& link : scene.joint_links) {
    LKS_ASSERT(link.joint < scene.joints.size());
    const bool is_fed =
        is_driven(scene.joints[link.joint]) || moves(link.body_a) || moves(link.body_b);
    for (const std::uint32_t body : {link.body_a, link.body_b}) {
      if (!scene.bodies[body].is_dynamic()) continue;
      IslandTally& own = tally(islands_.of(bodies.number_of(body)));
      own.has_joints = true;
      own.is_fed = own.is_fed || is_fed;
    }
  }
}

}  // namespace lockstone
