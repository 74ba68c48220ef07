#include "core/dynamics/step/contacts/iterated_gain_limit.h"

#include <algorithm>
#include <array>
#include <utility>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/rough_energy.h"
#include "core/dynamics/contact/block_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

// An island may gain this part of its energy: 2^-2.
constexpr int k_substep_gain_shift = 2;

// Of both operands of a word.
std::int64_t share_of_both(std::int64_t word, std::int32_t share) {
  const auto part = [share](std::int64_t x) { return raw::round_shift(x * share, k_share_bits); };
  return lanes::scalar::pack(static_cast<std::int32_t>(part(low_word(word))),
                             static_cast<std::int32_t>(part(high_word(word))));
}

// With the velocities that impulses give.
lanes::BodyVelocity sum_of(lanes::BodyVelocity free, const lanes::BodyVelocity& given) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    free.velocity[axis] = raw::saturating_add(free.velocity[axis], given.velocity[axis]);
    free.spin[axis] = raw::saturating_add(free.spin[axis], given.spin[axis]);
  }
  return free;
}

void add_rough(std::uint64_t& sum, std::uint64_t energy) {
  LKS_ASSERT(sum <= k_most_rough_energy && energy <= k_most_rough_energy);
  sum = std::min(sum + energy, k_most_rough_energy);
}

// High operands of points are the largest impulses of the tick; at its beginning the same as the
// low ones, and scaled with them.
void scale_impulses(lanes::ManifoldBlock& block, std::size_t lane, std::int32_t share,
                    bool is_beginning) {
  LKS_ASSERT(lane < lanes::k_block_lanes && share >= 0);
  for (lanes::ManifoldBlock::Point& point : block.points) {
    std::int64_t& word = point.impulse[lane];
    const std::int64_t both = share_of_both(word, share);
    word = is_beginning ? both : lanes::scalar::with_upper_of(both, word);
  }
  block.friction[lane] = share_of_both(block.friction[lane], share);
  std::int64_t& twist = block.twist[lane];  // its high operand is the radius
  twist = lanes::scalar::with_upper_of(share_of_both(twist, share), twist);
  if (!block.is_plain(lane)) block.rolling[lane] = share_of_both(block.rolling[lane], share);
}

}  // namespace

IteratedGainLimit::IteratedGainLimit(std::size_t body_capacity, const Parts& parts)
    : parts_(parts) {
  islands_.reserve(body_capacity + 1);
}

void IteratedGainLimit::limit_warm_start(const ContactScene& scene, const ContactRun& run) {
  scene_ = scene;
  islands_.clear();
  are_pushed_hard_ = false;
  limit(run, Impulses::to_come);
}

void IteratedGainLimit::limit_gains(const ContactRun& run) {
  if (!are_pushed_hard_.load(std::memory_order_relaxed)) return;
  parts_.islands.find_energy_sources(scene_, parts_.bodies, parts_.contacts);
  limit(run, Impulses::felt);
}

void IteratedGainLimit::limit(const ContactRun& run, Impulses which) {
  if (!find_hard_pushes(which)) return;
  LKS_ASSERT(islands_.size() == parts_.islands.count());
  sum_rough_energies(which);
  if (!find_gains()) return;
  sum_energies(which);
  choose_shares(which);
  scale_bodies(which);
  scale_contacts(run, which);
}

// The velocity that a body would have in this substep without the impulses.
lanes::BodyVelocity IteratedGainLimit::free_motion(std::uint32_t number, Impulses which) const {
  LKS_ASSERT(number > 0 && number < parts_.bodies.count());
  const SolverBody& body = parts_.bodies.constants()[number];
  lanes::BodyVelocity free =
      which == Impulses::felt ? parts_.bodies.before()[number] : parts_.bodies.rows()[number];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    free.velocity[axis] += body.gain[axis] * (std::int64_t{1} << k_grid_to_row);
    free.spin[axis] += body.spin_gain[axis] * (std::int64_t{1} << k_grid_to_row);
  }
  return free;
}

void IteratedGainLimit::note_pushes(std::size_t first, std::size_t end) {
  LKS_ASSERT(end <= parts_.bodies.count());
  if (are_pushed_hard_.load(std::memory_order_relaxed)) return;
  for (std::size_t i = std::max<std::size_t>(first, 1); i < end; ++i) {
    if (parts_.bodies.constants()[i].is_whole) continue;
    const lanes::BodyVelocity free = free_motion(static_cast<std::uint32_t>(i), Impulses::felt);
    if (is_below(difference(parts_.bodies.rows()[i], free), k_soft_push)) continue;
    return are_pushed_hard_.store(true, std::memory_order_relaxed);
  }
}

IteratedGainLimit::Motion IteratedGainLimit::motion_of(std::uint32_t number, Impulses which) const {
  const lanes::BodyVelocity free = free_motion(number, which);
  if (which == Impulses::to_come) return {free, parts_.bodies.before()[number]};
  LKS_ASSERT(which == Impulses::felt);
  return {free, difference(parts_.bodies.rows()[number], free)};
}

bool IteratedGainLimit::may_gain(const IslandTally& island, Impulses which) const {
  if (island.joints != 0 || island.is_converged) return false;
  return which == Impulses::to_come || !island.is_fed;
}

bool IteratedGainLimit::find_hard_pushes(Impulses which) {
  bool any = false;
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    const std::uint32_t island = parts_.islands.all().of(i);
    if (island == 0 || !may_gain(parts_.islands.tally(island), which)) continue;
    if (any && islands_[island].is_pushed_hard) continue;
    if (is_below(motion_of(i, which).given, k_soft_push)) continue;
    LKS_ASSERT(parts_.bodies.constants()[i].is_pushed());
    if (!any) clear_sums();
    LKS_ASSERT(is_reserved(islands_, parts_.islands.count()));
    islands_[island].is_pushed_hard = any = true;
  }
  return any;
}

// The energy that an island had at the tick's beginning is summed once a tick.
void IteratedGainLimit::clear_sums() {
  islands_.resize(parts_.islands.count());
  for (Island& island : islands_) {
    const Island before = std::exchange(island, {});
    island.knows_first = before.knows_first;
    island.first = before.first;
    LKS_ASSERT(island.knows_first || island.first == 0);
  }
}

// Calls `work(number, body, mass, island)` for each body of an island that is pushed hard; `mass`
// as a multiple of that of the island's first body.
template <class Work>
void IteratedGainLimit::for_each_hard_pushed(Work work) {
  constexpr BlockFloat k_same{1 << 30, -30};
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    Island& island = islands_[parts_.islands.all().of(i)];
    if (!island.is_pushed_hard) continue;
    const SolverBody& body = parts_.bodies.constants()[i];
    LKS_ASSERT(body.is_pushed());
    if (island.unit == BlockFloat{}) island.unit = body.inverse_mass;
    const bool is_alike = island.unit == body.inverse_mass;
    work(i, body, is_alike ? k_same : quotient(island.unit, body.inverse_mass), island);
  }
}

void IteratedGainLimit::sum_rough_energies(Impulses which) {
  for_each_hard_pushed([&](std::uint32_t i, const SolverBody& body, BlockFloat mass,
                           Island& island) {
    const lanes::BodyVelocity free = free_motion(i, which);
    const lanes::BodyVelocity all =
        which == Impulses::felt ? parts_.bodies.rows()[i] : sum_of(free, parts_.bodies.before()[i]);
    LKS_ASSERT(mass.mantissa > 0);
    const std::uint64_t error =
        rough_shift(static_cast<std::uint64_t>(mass.mantissa), mass.exponent + 6) + 1;
    add_rough(island.rough.free, rough_twice_energy(free, body.inverse_inertia, mass));
    add_rough(island.rough.all, rough_twice_energy(all, body.inverse_inertia, mass));
    add_rough(island.rough.all, error);
  });
}

// Leaves out islands that surely gain no more than half of the bound: most impulses of contacts
// take energy. Returns whether any is left, of which the exact sums follow.
bool IteratedGainLimit::find_gains() {
  bool any = false;
  for (Island& island : islands_) {
    const RoughEnergies rough = island.rough;
    island.exact = {};
    if (!island.is_pushed_hard) continue;
    LKS_ASSERT(island.first >= 0 && rough.all > 0);
    const std::uint64_t base = std::max(
        rough.free, std::min(static_cast<std::uint64_t>(island.first), k_most_rough_energy));
    const bool is_calm =
        rough.all < k_most_rough_energy && rough.all <= base + (base >> (k_substep_gain_shift + 1));
    island.is_pushed_hard = !is_calm;
    any = any || !is_calm;
  }
  return any;
}

void IteratedGainLimit::sum_energies(Impulses which) {
  for_each_hard_pushed(
      [&](std::uint32_t i, const SolverBody& body, BlockFloat mass, Island& island) {
        const Motion motion = motion_of(i, which);
        const Vec3<Velocity> velocity = velocity_of_row(motion.free.velocity),
                             spin = velocity_of_row(motion.free.spin),
                             gain = velocity_of_row(motion.given.velocity),
                             spin_gain = velocity_of_row(motion.given.spin);
        const Vec3<Velocity> surface = surface_velocity(body.inverse_inertia, spin_gain);
        add_energy(island.exact.free, twice_energy(velocity, spin, body.inverse_inertia), mass);
        add_energy(island.exact.square, energy_product(gain, gain, spin_gain, surface), mass);
        add_energy(island.exact.linear, 2 * energy_product(velocity, gain, spin, surface), mass);
        if (which == Impulses::felt && !island.knows_first) add_first_energy(i, mass, island);
      });
  if (which != Impulses::felt) return;
  for (Island& island : islands_) {
    island.knows_first = island.knows_first || island.is_pushed_hard;
    LKS_ASSERT(island.knows_first || island.first == 0);
  }
}

// Of the velocities at the tick's beginning and of those that gravity and forces give in the tick,
// as if they were at right angles.
void IteratedGainLimit::add_first_energy(std::uint32_t number, BlockFloat mass,
                                         Island& island) const {
  LKS_ASSERT(parts_.substeps > 0 && parts_.bodies.side(number).body() < scene_.bodies.size());
  const SolverBody& body = parts_.bodies.constants()[number];
  const BodyRecord& record = scene_.bodies[parts_.bodies.side(number).body()];
  LKS_ASSERT(record.is_dynamic());
  const auto of_tick = [this](const std::array<std::int64_t, 3>& gain) {
    const std::int64_t substeps = parts_.substeps;
    return Vec3<Velocity>{Velocity::from_raw(substeps * gain[0]),
                          Velocity::from_raw(substeps * gain[1]),
                          Velocity::from_raw(substeps * gain[2])};
  };
  add_energy(island.first, twice_energy(record.velocity, record.spin, body.inverse_inertia), mass);
  add_energy(island.first,
             twice_energy(of_tick(body.gain), of_tick(body.spin_gain), body.inverse_inertia), mass);
}

// With a share s of the impulses the energy is free + s·linear + s²·square.
void IteratedGainLimit::choose_shares(Impulses which) {
  for (Island& island : islands_) {
    const auto& [free, square, linear] = island.exact;
    const std::int64_t base = which == Impulses::to_come ? free : std::max(free, island.first);
    LKS_ASSERT(base >= 0 && square >= 0);
    const std::int64_t all = raw::saturating_add(free, raw::saturating_add(linear, square));
    if (all > raw::saturating_add(base, base >> k_substep_gain_shift))
      island.share = share_of(-(linear >> 1), square);
    LKS_ASSERT(island.share >= 0 && island.share <= 1 << k_share_bits);
  }
}

void IteratedGainLimit::scale_bodies(Impulses which) {
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    const std::int32_t share = islands_[parts_.islands.all().of(i)].share;
    if (share == 1 << k_share_bits) continue;
    LKS_ASSERT(share >= 0 && share < 1 << k_share_bits);
    const Motion motion = motion_of(i, which);
    const auto part = [share](std::int64_t x) { return product_rounded(x, share, k_share_bits); };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t velocity = part(motion.given.velocity[axis]),
                         spin = part(motion.given.spin[axis]);
      if (which == Impulses::to_come) {
        parts_.bodies.before()[i].velocity[axis] = velocity;
        parts_.bodies.before()[i].spin[axis] = spin;
      } else {
        parts_.bodies.rows()[i].velocity[axis] = motion.free.velocity[axis] + velocity;
        parts_.bodies.rows()[i].spin[axis] = motion.free.spin[axis] + spin;
      }
    }
    if (which == Impulses::felt) parts_.bodies.apply_axis_locks(i);
  }
}

void IteratedGainLimit::scale_contacts(const ContactRun& run, Impulses which) {
  parts_.contacts.for_each([&](ContactId id, const ContactRef& contact) {
    const std::int32_t share = islands_[parts_.islands.of(contact)].share;
    if (share == 1 << k_share_bits) return;
    const ContactLane place = parts_.layout.lane_of(id);
    LKS_ASSERT(place.block() < run.blocks.size());
    scale_impulses(run.blocks[place.block()], place.lane(), share, which == Impulses::to_come);
  });
}

}  // namespace lockstone
