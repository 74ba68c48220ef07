#include "core/dynamics/step/contacts/stack_warm_start.h"

#include <lockstone/assert.h>

#include "core/dynamics/step/input/contact_params.h"
#include "core/dynamics/step/islands/effort_policy.h"

namespace lockstone {

StackWarmStart::StackWarmStart(std::size_t body_capacity, std::size_t contact_capacity,
                               std::size_t joint_capacity, const Parts& parts)
    : parts_(parts),
      supports_(body_capacity + contact_capacity + joint_capacity, contact_capacity),
      initial_(contact_capacity),
      limit_(body_capacity,
             {parts.bodies, parts.contacts, parts.islands, parts.layout, parts.substeps}) {}

void StackWarmStart::make_room(std::uint32_t workers) {
  initial_.make_room(workers);
  rebalance_.make_room(workers);
}

// Where many contacts are overloaded, and a good part of all is new, bodies were just put on each
// other: the impulses that they stand on are not known yet.
void StackWarmStart::find(const ContactScene& scene, const ContactRun& run, Parallel& parallel) {
  IslandBuilder& islands = parts_.islands;
  initial_.clear();
  if (islands.has_stacks() && EffortPolicy::rebalances(scene.tick)) {
    add_supports(scene, [&](const ContactRef& contact) {
      const IslandTally& island = islands.tally(contact);
      return island.is_stack() && !island.needs_initial_warm_start() && is_free(contact.a) &&
             is_free(contact.b);
    });
    rebalance_.find(supports_, run, parts_.bodies.before(), parallel);
  }
  // Last, since `store` reads its supports.
  if (islands.all().any(&IslandTally::needs_initial_warm_start)) {
    add_supports(scene, [&](const ContactRef& contact) {
      return islands.tally(contact).needs_initial_warm_start();
    });
    initial_.find(supports_, run, parts_.bodies.before(), parallel);
  }
  limit_.limit_warm_start(scene, run);
}

// It has neither joints nor locked axes.
bool StackWarmStart::is_free(BodyRef body) const {
  if (body.is_standing()) return true;
  const std::uint32_t number = body.number();
  return parts_.bodies.constants()[number].locked == 0 &&
         parts_.joints.solver().find(parts_.bodies.side(number).body()) == nullptr;
}

// Of the contacts that `takes` chooses, those that touch.
template <class Takes>
void StackWarmStart::add_supports(const ContactScene& scene, const Takes& takes) {
  supports_.clear();
  parts_.contacts.for_each([&](ContactId id, const ContactRef& contact) {
    if (!takes(contact) || !is_touching(scene.manifolds[contact.manifold])) return;
    LKS_ASSERT(contact.record < scene.records.size());
    const ContactPair pair{parts_.layout.lane_of(id), parts_.bodies.pushed_number(contact.a),
                           parts_.bodies.pushed_number(contact.b)};
    const ContactSurface& surface = scene.surfaces[contact.manifold];
    const bool is_new = scene.records[contact.record].count == 0;
    const bool is_driven = surface.drive != Vec3<SolverVelocity>{} || surface.twist_drive != Rate{};
    supports_.add({{pair},
                   contact.record,
                   is_new && !parts_.islands.tally(contact).is_converged,
                   contact.has_standing() && !is_driven});
  });
}

}  // namespace lockstone
