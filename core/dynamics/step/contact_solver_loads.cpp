// Large islands in the contact solver: the loads that their contacts begin with.

#include <algorithm>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {

namespace {

// A contact is overloaded when it carries this many halves of a body's weight.
constexpr std::int64_t k_loaded_halves = 5;

std::int64_t impulse_of(const ContactRecord& record) {
  std::int64_t sum = 0;
  for (const ContactPointRecord& point : record.points)
    sum += point.normal_impulse.raw;
  return sum;
}

bool is_touching(const Manifold& manifold, Displacement skin) {
  for (int i = 0; i < manifold.count; ++i)
    if (manifold.points[static_cast<std::size_t>(i)].separation <= skin) return true;
  return false;
}

}  // namespace

// Whether the lighter body, at rest, gains more from the contact than gravity and forces give it;
// or has just been put there, so that nobody knows yet.
bool ContactSolver::is_loaded(const ContactScene& scene, const Entry& entry,
                              std::int64_t share_b) const {
  const bool b_is_lighter = share_b >= 1 << 29;
  const std::uint32_t index = b_is_lighter ? entry.body_b : entry.body_a;
  if ((index & k_immovable) != 0) return false;
  const std::int64_t impulse = impulse_of(scene.records[entry.record]);
  const std::int64_t share = b_is_lighter ? share_b : (std::int64_t{1} << 30) - share_b;
  const std::int64_t jump = raw::round_shift(impulse * (share >> 2), 15);  // Q32 + 1
  const std::int64_t weight = bodies_[index].greatest_gain();
  if (weight == 0) return false;
  if (jump < k_loaded_halves * weight) {
    if (impulse != 0 || ((entry.body_a | entry.body_b) & k_immovable) != 0) return false;
    if (!is_touching(scene.manifolds[entry.slot], Displacement::from_raw(rules_.skin)))
      return false;
  }
  return is_at_rest(rows_[index]);
}

// Where many contacts are overloaded, and a good part of all is new, bodies were just put on each
// other: the impulses that they stand on are not known yet. Stacks find theirs again from time to
// time.
void ContactSolver::find_first_loads(const ContactScene& scene, Parallel& parallel) {
  first_loads_.clear();
  if (has_heap_ && scene.tick % k_heap_ticks == 0) {
    add_supports(scene, [&](std::size_t i) {
      const IslandLoad& island = island_of(i);
      return island.is_heap() && !island.needs_first_loads() && is_free(entries_[i].body_a) &&
             is_free(entries_[i].body_b);
    });
    heap_loads_.find(supports_, contact_run(), before_, parallel);
  }
  // Last, since `store` reads its supports.
  if (islands_.any(&IslandLoad::needs_first_loads)) {
    add_supports(scene, [&](std::size_t i) { return island_of(i).needs_first_loads(); });
    first_loads_.find(supports_, contact_run(), before_, parallel);
  }
}

// Neither joints nor locked axes hold it.
bool ContactSolver::is_free(std::uint32_t index) const {
  if ((index & k_immovable) != 0) return true;
  return bodies_[index].held == 0 && joints_->find(members_[index]) == nullptr;
}

// Of the entries that `takes` chooses, those that touch.
template <class Takes>
void ContactSolver::add_supports(const ContactScene& scene, const Takes& takes) {
  supports_.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!takes(i)) continue;
    const Entry& entry = entries_[i];
    if (!is_touching(scene.manifolds[entry.slot], Displacement::from_raw(rules_.skin))) continue;
    const ContactPair pair{slot_of(i), pushed_number(entry.body_a), pushed_number(entry.body_b)};
    const ContactSurface& surface = scene.surfaces[entry.slot];
    const bool is_driven = surface.drive != Vec3<SolverVelocity>{} || surface.twist_drive != Rate{};
    const bool is_on_ground = ((entry.body_a | entry.body_b) & k_immovable) != 0 && !is_driven;
    supports_.add({{pair}, entry.record, scene.records[entry.record].count == 0, is_on_ground});
  }
}

ContactRun ContactSolver::contact_run() {
  return {rows_, before_, std::span(bodies_).first(members_.size()), blocks_, rules_};
}

}  // namespace lockstone
