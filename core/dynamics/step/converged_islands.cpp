#include "core/dynamics/step/converged_islands.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/math/roots.h"

namespace lockstone {
namespace {

// The velocity that gravity adds in a substep, m/s, Q32, but at most 2 m/s, which its products need
// to fit.
std::int64_t weight_of(const Vec3<Acceleration>& gravity, const TimeStep& step) {
  constexpr std::int64_t k_most = std::int64_t{2} << 32;
  const auto size = static_cast<std::int64_t>(norm(gravity.x.raw, gravity.y.raw, gravity.z.raw));
  const std::int64_t gain =
      step.substep.times(raw::scale_saturating(size, 32 - Acceleration::frac_bits));
  return std::min(gain, k_most);
}

}  // namespace

ConvergedIslands::ConvergedIslands(const TimeStep& step, std::size_t body_capacity,
                                   std::size_t contact_capacity, std::size_t joint_capacity,
                                   std::size_t converged_contacts,
                                   std::uint32_t most_island_contacts)
    : step_(step),
      solver_({body_capacity + contact_capacity + 1, std::min(body_capacity, converged_contacts),
               converged_contacts, joint_capacity}),
      lists_(body_capacity, contact_capacity, joint_capacity) {
  bodies_.reserve(BodyFactor::k_most_bodies);
  contacts_.reserve(most_island_contacts);
  joints_.reserve(std::min<std::size_t>(most_island_contacts, joint_capacity));
}

void ConvergedIslands::plan(const ContactScene& scene, const SolverBodies& bodies,
                            const ContactList& contacts, const EffortPolicy& effort,
                            IslandBuilder& islands, TickJoints& joints) {
  solver_.clear(joints.first_without_contacts());
  EffortPolicy::mark_iterated(scene, bodies, contacts, joints, islands);
  lists_.build(scene, bodies, contacts, islands);
  EffortPolicy::mark_stirred(scene, bodies, islands);
  for (std::uint32_t island = 1; island < islands.count(); ++island) {
    IslandTally& tally = islands.tally(island);
    if (!effort.may_converge(tally)) continue;
    if (!solver_.islands().has_room(tally.bodies, tally.contacts, tally.joints)) continue;
    list(contacts, islands, joints, island);
    LKS_ASSERT(bodies_.size() == tally.bodies && contacts_.size() == tally.contacts);
    LKS_ASSERT(joints_.size() == tally.joints);
    tally.is_converged = solver_.islands().add(bodies_, contacts_, joints_);
    if (!tally.is_converged) continue;
    for (const IslandJoint& joint : joints_)
      joints.solver().island_joints().put_among_contacts(joint.joint);
  }
}

void ConvergedIslands::list(const ContactList& contacts, const IslandBuilder& islands,
                            TickJoints& joints, std::uint32_t island) {
  bodies_.clear();
  contacts_.clear();
  joints_.clear();
  lists_.for_bodies(island, [&](std::uint32_t number) { bodies_.push_back(number); });
  LKS_ASSERT(std::ranges::is_sorted(bodies_));
  const auto pushed = [&](BodyRef body) { return islands.of(body) == 0 ? 0 : body.number(); };
  lists_.for_contacts(island, [&](ContactId id) {
    contacts_.push_back({id, pushed(contacts[id].a), pushed(contacts[id].b)});
    LKS_ASSERT(contacts_.back().a != contacts_.back().b);
  });
  lists_.for_joints(island, [&](std::uint32_t link) {
    joints_.push_back(joints.solver().island_joints().joint(joints.solver().added(link).joint));
  });
}

IslandView ConvergedIslands::take(std::uint32_t island) {
  const IslandView view = solver_.islands().view(island);
  LKS_ASSERT(!view.contacts.empty() && !view.state.is_whole);
  view.state.is_whole = true;
  return view;
}

void ConvergedIslands::give_up(const EffortPolicy& effort, const ContactRun& run,
                               IslandBuilder& islands) {
  for (std::uint32_t i = 0; i < count(); ++i) {
    if (solver_.islands().state(i).unsolved == 0) continue;
    const IslandView view = solver_.islands().view(i);
    IslandTally& tally = islands.tally(islands.all().of(view.bodies[0]));
    tally.is_given_up = effort.gives_up(tally, view);
    view.state.forgets = tally.is_given_up && tally.joints == 0 && effort.stands(view, run);
  }
}

// Iterations that began with impulses of phases which were not solved would let it sink, since no
// contact has a mean impulse.
void ConvergedIslands::forget(const ContactList& contacts, std::span<ContactRecord> records) {
  for (std::uint32_t i = 0; i < count(); ++i) {
    if (!solver_.islands().state(i).forgets) continue;
    for (const ProximalContact& contact : solver_.islands().view(i).contacts) {
      ContactRecord& record = records[contacts[contact.id].record];
      ContactRecord fresh = ContactRecord::of(record.key());
      fresh.flags = record.flags;
      record = fresh;
    }
  }
}

void ConvergedIslands::begin(const Tick& tick, const ContactRun& run, std::size_t first,
                             std::size_t end) {
  LKS_ASSERT(first <= end && end <= count());
  const std::int64_t weight = weight_of(tick.scene.gravity, step_);
  for (auto i = static_cast<std::uint32_t>(first); i < end; ++i)
    begin(tick, run, i, weight);
}

void ConvergedIslands::begin(const Tick& tick, const ContactRun& run, std::uint32_t island,
                             std::int64_t weight) {
  const IslandView view = solver_.islands().view(island);
  for (ProximalContact& contact : view.contacts) {
    const ContactRef& ref = tick.contacts[contact.id];
    LKS_ASSERT(contact.a < tick.bodies.count() && contact.b < tick.bodies.count());
    const Vec3<SolverVelocity>& arc = tick.scene.surfaces[ref.manifold].arc;
    contact.arc = {arc.x.raw, arc.y.raw, arc.z.raw};
    contact.place = tick.layout.lane_of(contact.id);
    contact.row_a = tick.bodies.row_of(ref.a);
    contact.row_b = tick.bodies.row_of(ref.b);
  }
  LKS_ASSERT(!view.bodies.empty() && weight >= 0);
  // The first phase adds a scaled warm start itself: the velocities that single contacts of the
  // last tick give to a body may exceed all limits.
  for (const std::uint32_t body : view.bodies)
    tick.bodies.before()[body] = {};
  const IslandTally& tally = tick.islands.tally(tick.islands.all().of(view.bodies[0]));
  view.state.is_measured = !view.joints.empty() || tally.has_ball_impacts;
  view.state.stir = view.joints.empty() ? EffortPolicy::stir_level(tally) : 0;
  solver_.begin(run, island, weight, step_.substeps);
}

}  // namespace lockstone
