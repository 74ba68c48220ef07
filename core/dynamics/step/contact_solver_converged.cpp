// Chooses the islands that are solved to convergence, and runs their solver.

#include <algorithm>

#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

// No island has more contacts.
constexpr std::uint32_t k_most_island_contacts = 1024;

// The velocity that gravity adds in a substep, m/s, Q32.
std::int64_t weight_of(const Vec3<Acceleration>& gravity, const TimeStep& step) {
  const auto size = static_cast<std::int64_t>(norm(gravity.x.raw, gravity.y.raw, gravity.z.raw));
  return step.substep.times(raw::scale_saturating(size, 32 - Acceleration::frac_bits));
}

// Whether impulses would need more bits than there are beside speeds: above 200,000 : 1.
bool is_too_uneven(BlockFloat a, BlockFloat b) {
  constexpr std::int32_t k_least_share = (1 << 30) / 200'000;
  if (a.mantissa == 0 || b.mantissa == 0) return false;
  return std::min(ratio(a, b), ratio(b, a)).raw < k_least_share;
}

}  // namespace

void ContactSolver::reserve_islands(std::size_t rows, std::size_t bodies, std::size_t contacts,
                                    std::size_t joints, std::size_t converged) {
  if (converged == 0) return;
  const std::size_t most = std::min<std::size_t>(converged, k_most_island_contacts);
  most_island_contacts_ = static_cast<std::uint32_t>(most);
  proximal_ =
      std::make_unique<ProximalSolver>(rows, std::min(bodies, converged), converged, joints);
  first_of_.reserve(3 * bodies + 3);
  next_of_.reserve(rows + contacts + joints);
  island_joints_.reserve(std::min(most, joints));
  island_bodies_.reserve(BodyFactor::k_most_bodies);
  island_contacts_.reserve(most);
}

std::uint32_t ContactSolver::converged_islands() const {
  return proximal_ == nullptr ? 0 : proximal_->count();
}

// Joints of nets, locked axes and rolling resistance have no rows here yet.
void ContactSolver::bar_islands(const ContactScene& scene) {
  const auto bar = [this](std::uint32_t body) {
    islands_.load(islands_.of(solver_index_[body])).is_barred = true;
  };
  for (std::uint32_t i = 0; i < scene.joint_links.size(); ++i)
    if (joints_->number_of(i) == JointSolver::k_in_net)
      load_of(scene, scene.joint_links[i]).is_barred = true;
  for (std::uint32_t i = 1; i < members_.size(); ++i)
    if (islands_.of(i) != 0 && (scene.bodies[members_[i]].locks & k_lock_moving) != 0)
      bar(members_[i]);
  const auto mass = [&](std::uint32_t number) {
    return (number & k_immovable) == 0 ? scene.bodies[members_[number]].inverse_mass_value()
                                       : BlockFloat{};
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    const bool rolls = scene.surfaces[entry.slot].rolling_arm != Length{};
    if (rolls || is_too_uneven(mass(entry.body_a), mass(entry.body_b)))
      island_of(i).is_barred = true;
  }
}

// Of the island of a joint, which has at least one dynamic body.
IslandLoad& ContactSolver::load_of(const ContactScene& scene, const JointLink& link) {
  const bool is_a = scene.bodies[link.body_a].is_dynamic();
  return islands_.load(islands_.of(solver_index_[is_a ? link.body_a : link.body_b]));
}

// Chains the bodies, the contacts and the joints of each island, in their order.
void ContactSolver::chain_islands(const ContactScene& scene) {
  const std::uint32_t islands = islands_.count();
  const auto bodies = static_cast<std::uint32_t>(members_.size());
  const auto entries = static_cast<std::uint32_t>(entries_.size());
  const auto joints = static_cast<std::uint32_t>(scene.joint_links.size());
  first_of_.assign(std::size_t{3} * islands, 0);
  next_of_.assign(bodies + entries + joints, 0);
  for (std::uint32_t i = bodies; i-- > 1;) {
    const std::uint32_t island = islands_.of(i);
    if (island == 0) continue;
    ++islands_.load(island).bodies;
    next_of_[i] = first_of_[island];
    first_of_[island] = i;
  }
  for (std::uint32_t i = entries; i-- > 0;) {
    const auto island = static_cast<std::uint32_t>(&island_of(i) - &islands_.load(0));
    next_of_[bodies + i] = first_of_[islands + island];
    first_of_[islands + island] = i + 1;
  }
  for (std::uint32_t i = joints; i-- > 0;) {
    IslandLoad& load = load_of(scene, scene.joint_links[i]);
    const auto island = static_cast<std::uint32_t>(&load - &islands_.load(0));
    ++load.joints;
    next_of_[bodies + entries + i] = first_of_[2 * islands + island];
    first_of_[2 * islands + island] = i + 1;
  }
}

// Where a body that no impulse moves holds an island, by the entry's number.
ContactSolver::Hold ContactSolver::hold_of(const ContactScene& scene, std::size_t index) const {
  const Entry& entry = entries_[index];
  const auto is_pushed = [this](std::uint32_t number) {
    return (number & k_immovable) == 0 && islands_.of(number) != 0;
  };
  const bool holds_a = !is_pushed(entry.body_a);
  if (!holds_a && is_pushed(entry.body_b)) return {};
  const ContactRecord& record = scene.records[entry.record];
  const Vec3<Unit> normal = scene.manifolds[entry.slot].normal;
  const std::uint32_t island = islands_.of(holds_a ? entry.body_b : entry.body_a);
  return {island, holds_a ? record.body_a : record.body_b, holds_a ? normal : -normal};
}

// Marks islands that a moving kinematic body presses against another body that no impulse moves.
// No impulses satisfy their rows: they would grow without limit.
void ContactSolver::mark_pinched(const ContactScene& scene) {
  constexpr std::int64_t k_against = -(std::int64_t{1} << 57);  // cosine of −1/8, Q60
  moving_holds_.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Hold hold = hold_of(scene, i);
    if (hold.island == 0) continue;
    const BodyRecord& holder = scene.bodies[hold.body];
    if (holder.velocity != Vec3<Velocity>{} || holder.spin != Vec3<Velocity>{})
      moving_holds_.push_back(hold);
  }
  if (moving_holds_.empty()) return;
  std::ranges::sort(moving_holds_, {}, &Hold::key);
  const auto end = std::unique(moving_holds_.begin(), moving_holds_.end());
  moving_holds_.erase(end, moving_holds_.end());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Hold hold = hold_of(scene, i);
    if (hold.island == 0 || islands_.load(hold.island).is_pinched) continue;
    auto moving = std::ranges::lower_bound(moving_holds_, hold.island, {}, &Hold::island);
    for (; moving != moving_holds_.end() && moving->island == hold.island; ++moving)
      if (moving->body != hold.body && dot(hold.normal, moving->normal).raw < k_against)
        islands_.load(hold.island).is_pinched = true;
  }
}

// A contact as it is known before the blocks are laid out: `slot` is the entry, and the rows are
// the numbers of the bodies.
ProximalContact ContactSolver::converged_contact(std::uint32_t index) const {
  const Entry& entry = entries_[index];
  const auto pushed = [this](std::uint32_t number) {
    return (number & k_immovable) == 0 && islands_.of(number) != 0 ? number : 0;
  };
  ProximalContact contact;
  contact.slot = index;
  contact.a = pushed(entry.body_a);
  contact.b = pushed(entry.body_b);
  contact.row_a = entry.body_a;
  contact.row_b = entry.body_b;
  return contact;
}

void ContactSolver::plan_converged(const ContactScene& scene) {
  if (proximal_ == nullptr) return;
  proximal_->clear(first_without_contacts_);
  bar_islands(scene);
  chain_islands(scene);
  for (std::uint32_t island = 1; island < islands_.count(); ++island) {
    IslandLoad& load = islands_.load(island);
    const bool is_small = load.contacts != 0 &&
                          load.contacts + load.joints <= most_island_contacts_ &&
                          load.bodies <= BodyFactor::k_most_bodies;
    if (load.is_barred || load.is_pinched || !is_small) continue;
    list_island(island);
    load.is_converged = proximal_->add(island_bodies_, island_contacts_, island_joints_);
    if (!load.is_converged) continue;
    for (const IslandJoint& joint : island_joints_)
      joints_->island_joints().put_among_contacts(joint.joint);
  }
}

void ContactSolver::list_island(std::uint32_t island) {
  island_bodies_.clear();
  island_contacts_.clear();
  island_joints_.clear();
  for (std::uint32_t i = first_of_[island]; i != 0; i = next_of_[i])
    island_bodies_.push_back(i);
  for (std::uint32_t i = first_of_[islands_.count() + island]; i != 0;
       i = next_of_[members_.size() + i - 1])
    island_contacts_.push_back(converged_contact(i - 1));
  const std::size_t joints = members_.size() + entries_.size();
  for (std::uint32_t i = first_of_[2 * islands_.count() + island]; i != 0;
       i = next_of_[joints + i - 1])
    island_joints_.push_back(joints_->island_joints().joint(joints_->number_of(i - 1)));
}

void ContactSolver::begin_converged(const ContactScene& scene) {
  if (proximal_ == nullptr) return;
  for (ProximalContact& contact : proximal_->contacts()) {
    const Vec3<SolverVelocity>& arc = scene.surfaces[entries_[contact.slot].slot].arc;
    contact.arc = {arc.x.raw, arc.y.raw, arc.z.raw};
    contact.slot = slot_of(contact.slot);
    contact.row_a = row_of(contact.row_a);
    contact.row_b = row_of(contact.row_b);
  }
  // The first phase adds a scaled warm start itself: the velocities that single contacts of the
  // last tick give to a body may exceed all limits.
  for (const std::uint32_t body : proximal_->bodies())
    before_[body] = {};
  const std::int64_t weight = weight_of(scene.gravity, step_);
  for (std::uint32_t i = 0; i < proximal_->count(); ++i)
    proximal_->begin(contact_run(), i, weight, step_.substeps);
}

void ContactSolver::run_converged(StageKind kind, std::size_t first, std::size_t end) {
  for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
    if (kind == StageKind::end_islands)
      proximal_->end(contact_run(), i);
    else
      proximal_->solve(contact_run(), {joints_->island_joints(), joint_run()}, i,
                       kind == StageKind::push_islands);
  }
}

}  // namespace lockstone
