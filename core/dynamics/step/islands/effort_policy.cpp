#include "core/dynamics/step/islands/effort_policy.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/step/input/contact_params.h"
#include "core/math/roots.h"

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

// A component of velocity, 1/16 m/s, within ±2^14 or so.
std::int32_t coarse(Velocity v) {
  return static_cast<std::int32_t>(raw::round_shift(v.raw, Velocity::frac_bits - 4));
}

// Whether an island that is stirred may be solved more coarsely, or iterated. With uneven masses
// passes change little while they are far from the solution: a coarser tolerance would end them too
// early. Where no body is fast, none is stirred.
bool may_be_stirred(const IslandTally& island) {
  if (!island.motion.is_fast) return false;
  if (island.joints != 0) return island.may_be_loose();
  return island.least_share >= IslandTally::k_least_alike;
}

// Until `mark_stirred` the mean velocity of an island is the sum of its bodies' velocities.
void add_motion(const BodyRecord& body, IslandTally& island) {
  island.loose += is_loose(body) ? 1U : 0U;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t speed = coarse(body.velocity[i]);
    std::int32_t& sum = island.motion.velocity[i];
    sum = raw::saturate<std::int32_t>(std::int64_t{sum} + speed);
    island.motion.is_fast = island.motion.is_fast || std::abs(speed) > 1;
  }
}

// The greatest n for which a body differs from the mean velocity of its island by more than
// 2^n/32 m/s along an axis, up to IslandMotion::k_levels; else 0.
std::size_t stir_level_of(const BodyRecord& body, const IslandTally& island) {
  std::int32_t most = 1;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(coarse(body.velocity[i]) - island.motion.velocity[i]));
  const auto beyond = static_cast<std::uint32_t>(most - 1);
  return std::min(static_cast<std::size_t>(std::bit_width(beyond)), IslandMotion::k_levels);
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

// Whether iterations have brought it to rest, or almost: to less than 0.24 mm/s. They hold it until
// it is still: it would move again, to another equilibrium, if it converged.
constexpr int k_held_exponent = -12;
bool is_held_by_iterations(const IslandTally& island) {
  return island.keeps_pose && island.slow == island.bodies;
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
  gravity_ = gravity;
}

void EffortPolicy::mark_iterated(const ContactScene& scene, const SolverBodies& bodies,
                                 const ContactList& contacts, const TickJoints& joints,
                                 IslandBuilder& islands) {
  for (std::uint32_t i = 0; i < scene.joint_links.size(); ++i) {
    const JointLink& link = scene.joint_links[i];
    IslandTally& tally = islands.tally(islands.of(scene, bodies, link));
    const AddedJoint& added = joints.solver().added(i);
    if (added.joint == JointSolver::k_in_balls) tally.iterates_only = true;
    const bool drives = added.is_driven;
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
    if (is_slower_than(body, k_held_exponent)) {
      ++island.slow;
      if (body.orientation != body.recycling_orientation) island.keeps_pose = true;
    }
    add_motion(body, island);
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
    if (islands.of(contact.a) == 0 || islands.of(contact.b) == 0) tally.is_supported = true;
    tally.least_share = std::min(tally.least_share, share);
  });
}

void EffortPolicy::mark_stirred(const ContactScene& scene, const SolverBodies& bodies,
                                IslandBuilder& islands) {
  for (std::uint32_t index = 1; index < islands.count(); ++index) {
    IslandTally& island = islands.tally(index);
    LKS_ASSERT(island.bodies > 0);
    for (std::int32_t& component : island.motion.velocity)
      component /= static_cast<std::int32_t>(island.bodies);
  }
  if (islands.all().any(may_be_stirred)) {
    for_each_body(scene, bodies, islands, [](IslandTally& island, const BodyRecord& body) {
      if (!may_be_stirred(island)) return;
      const std::size_t level = stir_level_of(body, island);
      for (std::size_t i = 0; i < level; ++i)
        ++island.motion.stirred[i];
    });
  }
  for (std::uint32_t index = 1; index < islands.count(); ++index)
    islands.tally(index).is_loose = is_loose_pile(islands.tally(index));
}

int EffortPolicy::stir_level(const IslandTally& island) {
  std::size_t level = 0;
  while (level < IslandMotion::k_levels && island.motion.stirred[level] > island.bodies / 4)
    ++level;
  return static_cast<int>(level);
}

bool EffortPolicy::is_stirred(const IslandTally& island) {
  constexpr int k_loosening = 3;  // above 1/4 m/s
  return stir_level(island) >= k_loosening;
}

bool EffortPolicy::gives_up(const IslandTally& island, const IslandView& solved) const {
  LKS_ASSERT(island.is_converged && island.bodies != 0);
  LKS_ASSERT(solved.plan.products == 0 || solved.plan.products >= solved.plan.bodies);
  // Single stacks of any height have fewer, four for each body.
  constexpr std::uint32_t k_small_products = 4096;
  if (solved.plan.products <= k_small_products || !island.may_be_loose()) return false;
  return solved.state.unsolved >= static_cast<std::uint32_t>(step_.substeps);
}

bool EffortPolicy::stands(const IslandView& island, const ContactRun& run) const {
  constexpr std::int64_t k_upright = (std::int64_t{1} << 60) / 8 * 7;
  const Vec3<Unit> unit = direction_of(gravity_);
  const RawVec3 down{unit.x.raw, unit.y.raw, unit.z.raw};
  std::int64_t all = 0, upright = 0;
  for (const ProximalContact& contact : island.contacts) {
    const lanes::ManifoldBlock& block = run.blocks[contact.place.block()];
    const std::size_t lane = contact.place.lane();
    std::int64_t impulse = 0;
    for (const lanes::ManifoldBlock::Point& point : block.points)
      impulse += low_word(point.impulse[lane]);
    LKS_ASSERT(impulse >= 0);
    const RawVec3 normal = normal_of(block, lane);
    std::int64_t along = 0;  // of two unit vectors, Q60
    for (std::size_t i = 0; i < 3; ++i)
      along += normal[i] * down[i];
    all += impulse;
    if (std::abs(along) >= k_upright) upright += impulse;
  }
  LKS_ASSERT(upright >= 0 && upright <= all);
  return upright > all / 4 * 3;
}

bool EffortPolicy::is_loose_pile(const IslandTally& island) {
  return island.may_be_loose() && (is_stirred(island) || island.loose > island.bodies / 2);
}

std::uint8_t EffortPolicy::loose_time(const IslandTally& island, const BodyRecord& body,
                                      const TimeStep& step, std::uint64_t tick) {
  constexpr std::int32_t k_seconds = 4, k_unit_rate = 60;
  const std::int32_t most = k_seconds * std::min(step.tick_rate, k_unit_rate);
  LKS_ASSERT(most > 0 && most <= UINT8_MAX);
  if (island.is_given_up) return static_cast<std::uint8_t>(most);
  if (!island.is_loose) return 0;
  if (is_stirred(island) || island.joints != 0) return static_cast<std::uint8_t>(most);
  const int unit = std::max(step.tick_rate / k_unit_rate, 1);
  const bool counts = tick % static_cast<std::uint64_t>(unit) == 0;
  return static_cast<std::uint8_t>(std::max(body.loose_time - (counts ? 1 : 0), 0));
}

bool EffortPolicy::may_converge(const IslandTally& island) const {
  if (island.iterates_only || island.is_pinched || island.is_loose) return false;
  if (is_held_by_iterations(island)) return false;
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
