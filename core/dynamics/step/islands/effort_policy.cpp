#include "core/dynamics/step/islands/effort_policy.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/step/input/contact_params.h"

namespace lockstone {
namespace {

// No converged island has more contacts, whatever the world allows.
constexpr std::size_t k_most_island_contacts = 1024;

// A contact is overloaded when it carries this many halves of a body's weight.
constexpr std::int64_t k_overload_halves = 5;

// Contacts of a stack are rigid if their points are within k_rigid_range of k_resting_overlap, they
// carry more than 1/k_rigid_part of the impulse of a bearing contact, and their bodies are slower
// than 2^-k_rigid_shift of the speed that gravity gives in a substep.
constexpr Displacement k_rigid_range = Displacement::from_ratio(1, 5000);
constexpr std::int64_t k_rigid_part = 10;
constexpr int k_rigid_shift = 6;

// The lesser of two inverse masses over the greater, Q30; 1 where a body has no mass.
std::int32_t lesser_share(BlockFloat a, BlockFloat b) {
  if (a.mantissa == 0 || b.mantissa == 0) return 1 << 30;
  if (a == b) return 1 << 29;
  return (is_less(a, b) ? ratio(a, b) : ratio(b, a)).raw;
}

// Below this share, 200,000 : 1, impulses would need more bits than there are beside speeds.
constexpr std::int32_t k_least_share = (1 << 30) / 200'000;

// A component of velocity, 1/16 m/s, within ±2^14 or so: that of 2^16 bodies fits a word.
std::int32_t coarse(Velocity v) {
  return static_cast<std::int32_t>(raw::round_shift(v.raw, Velocity::frac_bits - 4));
}

// Whether a body differs from the mean velocity of its island by more than 1/4 m/s along an axis.
bool has_own_velocity(const BodyRecord& body, const IslandTally& island) {
  constexpr std::int32_t k_fast = 4;
  for (int i = 0; i < 3; ++i)
    if (std::abs(coarse(body.velocity[i]) - island.velocity[i]) > k_fast) return true;
  return false;
}

// Calls `work(island, body)` for each dynamic body, whose island is not 0.
template <class Work>
void for_each_body(const ContactScene& scene, const SolverBodies& bodies, IslandBuilder& islands,
                   Work work) {
  for (std::uint32_t number = 1; number < bodies.count(); ++number) {
    const std::uint32_t island = islands.of(BodyRef::numbered(number));
    if (island != 0) work(islands.tally(island), scene.bodies[bodies.side(number).body()]);
  }
}

std::int64_t impulse_of(const ContactRecord& record) {
  std::int64_t sum = 0;
  for (const ContactPointRecord& point : record.points)
    sum += point.normal_impulse.raw;
  return sum;
}

}  // namespace

EffortPolicy::EffortPolicy(const TimeStep& step, std::size_t converged_contacts)
    : step_(step),
      most_island_contacts_(
          static_cast<std::uint32_t>(std::min(converged_contacts, k_most_island_contacts))) {}

void EffortPolicy::begin(const Vec3<Acceleration>& gravity) {
  std::int64_t most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(std::int64_t{gravity[i].raw}));
  bearing_impulse_ =
      most == 0 ? INT64_MAX
                : raw::round_divide(5 * raw::round_shift(most, Acceleration::frac_bits - 20),
                                    step_.substep_rate());
  LKS_ASSERT(bearing_impulse_ >= 0);
}

void EffortPolicy::mark_iterated(const ContactScene& scene, const SolverBodies& bodies,
                                 const ContactList& contacts, const TickJoints& joints,
                                 IslandBuilder& islands) {
  for (std::uint32_t i = 0; i < scene.joint_links.size(); ++i) {
    const JointLink& link = scene.joint_links[i];
    IslandTally& tally = islands.tally(islands.of(scene, bodies, link));
    if (joints.solver().number_of(i) == JointSolver::k_in_balls) tally.iterates_only = true;
    const bool drives = is_driven(scene.joints[link.joint]);
    const bool is_free =
        scene.bodies[link.body_a].is_dynamic() && scene.bodies[link.body_b].is_dynamic() && !drives;
    if (!is_free) tally.is_carried = true;
    // The problem of an island has no rows of springs and motors. Solved beside it they push bodies
    // into contacts that give way, or one undoes the other.
    if (drives) tally.iterates_only = true;
    const BodyRecord &a = scene.bodies[link.body_a], &b = scene.bodies[link.body_b];
    tally.least_share =
        std::min(tally.least_share, lesser_share(a.inverse_mass_value(), b.inverse_mass_value()));
  }
  for_each_body(scene, bodies, islands, [](IslandTally& island, const BodyRecord& body) {
    if ((body.locks & k_lock_moving) != 0) island.iterates_only = true;
  });
  const auto mass = [&](BodyRef body) {
    return body.is_standing()
               ? BlockFloat{}
               : scene.bodies[bodies.side(body.number()).body()].inverse_mass_value();
  };
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    IslandTally& tally = islands.tally(contact);
    LKS_ASSERT(scene.surfaces[contact.manifold].rolling_arm >= Length{});
    const bool rolls = scene.surfaces[contact.manifold].rolling_arm != Length{};
    const std::int32_t share = lesser_share(mass(contact.a), mass(contact.b));
    LKS_ASSERT(share >= 0);
    if (rolls || share < k_least_share) tally.iterates_only = true;
    tally.least_share = std::min(tally.least_share, share);
  });
}

void EffortPolicy::mark_loose(const ContactScene& scene, const SolverBodies& bodies,
                              IslandBuilder& islands) {
  if (!islands.all().any(&IslandTally::may_be_loose)) return;
  for_each_body(scene, bodies, islands, [](IslandTally& island, const BodyRecord& body) {
    if (!island.may_be_loose()) return;
    for (int i = 0; i < 3; ++i)
      island.velocity[i] += coarse(body.velocity[i]);
    island.loose += is_loose(body) ? 1U : 0U;
  });
  for (std::uint32_t index = 1; index < islands.count(); ++index) {
    IslandTally& island = islands.tally(index);
    if (!island.may_be_loose()) continue;
    LKS_ASSERT(island.bodies > 0);
    for (std::int32_t& component : island.velocity)
      component /= static_cast<std::int32_t>(island.bodies);
  }
  for_each_body(scene, bodies, islands, [](IslandTally& island, const BodyRecord& body) {
    if (island.may_be_loose() && has_own_velocity(body, island)) ++island.stirred;
  });
  for (std::uint32_t index = 1; index < islands.count(); ++index)
    islands.tally(index).is_loose = is_loose_pile(islands.tally(index));
}

bool EffortPolicy::is_stirred(const IslandTally& island) {
  return island.stirred > island.bodies / 4;
}

bool EffortPolicy::is_loose_pile(const IslandTally& island) {
  return island.may_be_loose() && (is_stirred(island) || island.loose > island.bodies / 2);
}

std::uint8_t EffortPolicy::loose_time(const IslandTally& island, const BodyRecord& body,
                                      const TimeStep& step, std::uint64_t tick) {
  constexpr std::int32_t k_seconds = 4, k_unit_rate = 60;
  if (!island.is_loose) return 0;
  const std::int32_t most = k_seconds * std::min(step.tick_rate, k_unit_rate);
  if (is_stirred(island) || island.joints != 0) return static_cast<std::uint8_t>(most);
  const int unit = std::max(step.tick_rate / k_unit_rate, 1);
  const bool counts = tick % static_cast<std::uint64_t>(unit) == 0;
  return static_cast<std::uint8_t>(std::max(body.loose_time - (counts ? 1 : 0), 0));
}

bool EffortPolicy::may_converge(const IslandTally& island) const {
  if (island.iterates_only || island.is_pinched || island.is_loose) return false;
  return island.contacts != 0 && island.contacts + island.joints <= most_island_contacts_ &&
         island.bodies <= BodyFactor::k_most_bodies;
}

bool EffortPolicy::rests(const lanes::BodyVelocity& row, const SolverBody& body) {
  return is_slower(row, body, k_rigid_shift);
}

bool EffortPolicy::is_rigid(const ContactScene& scene, const SolverBodies& bodies,
                            const ContactRef& contact) const {
  const ContactRecord& record = scene.records[contact.record];
  LKS_ASSERT(record.count <= k_max_manifold_points);
  if (std::int64_t{record.mean_impulse.raw} * record.count * k_rigid_part <= bearing_impulse_)
    return false;
  const Manifold& manifold = scene.manifolds[contact.manifold];
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
    const std::int64_t off =
        std::int64_t{manifold.points[i].separation.raw} + k_resting_overlap.raw;
    if (off > k_rigid_range.raw || off < -k_rigid_range.raw) return false;
  }
  const auto is_at_rest = [&](BodyRef body) {
    return body.is_standing() || bodies.constants()[body.number()].rests;
  };
  return is_at_rest(contact.a) && is_at_rest(contact.b);
}

bool EffortPolicy::is_overloaded(const ContactScene& scene, const SolverBodies& bodies,
                                 const ContactRef& contact, std::int64_t share_b) {
  LKS_ASSERT(share_b >= 0 && share_b <= std::int64_t{1} << 30);
  const bool b_is_lighter = share_b >= 1 << 29;
  const BodyRef lighter = b_is_lighter ? contact.b : contact.a;
  if (lighter.is_standing()) return false;
  const std::int64_t impulse = impulse_of(scene.records[contact.record]);
  const std::int64_t share = b_is_lighter ? share_b : (std::int64_t{1} << 30) - share_b;
  const std::int64_t jump = raw::round_shift(impulse * (share >> 2), 15);  // Q32 + 1
  const std::int64_t weight = bodies.constants()[lighter.number()].greatest_gain();
  if (weight == 0) return false;
  if (jump < k_overload_halves * weight) {
    if (impulse != 0 || contact.has_standing()) return false;
    if (!is_touching(scene.manifolds[contact.manifold])) return false;
  }
  return is_at_rest(bodies.rows()[lighter.number()]);
}

}  // namespace lockstone
