#include "core/dynamics/step/contacts/warm_start_limit.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/contact/block_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

// Warm starts that change no component of any velocity by more are not looked at: 1/4 m/s, Q50.
constexpr std::int64_t k_soft_push = std::int64_t{1} << (lanes::k_velocity_bits - 2);

// An island may gain this part of its energy: 2^-2.
constexpr int k_warm_gain_shift = 2;

// Of both operands of a word.
std::int64_t share_of_both(std::int64_t word, std::int32_t share) {
  const auto part = [share](std::int64_t x) { return raw::round_shift(x * share, k_share_bits); };
  return lanes::scalar::pack(static_cast<std::int32_t>(part(low_word(word))),
                             static_cast<std::int32_t>(part(high_word(word))));
}

void scale_impulses(lanes::ManifoldBlock& block, std::size_t lane, std::int32_t share) {
  LKS_ASSERT(lane < lanes::k_block_lanes && share >= 0);
  for (lanes::ManifoldBlock::Point& point : block.points)
    point.impulse[lane] = share_of_both(point.impulse[lane], share);
  block.friction[lane] = share_of_both(block.friction[lane], share);
  const std::int64_t twist = share_of_both(block.twist[lane], share);
  block.twist[lane] = block.twist[lane] - low_word(block.twist[lane]) + low_word(twist);
  if (!block.is_plain(lane)) block.rolling[lane] = share_of_both(block.rolling[lane], share);
}

}  // namespace

WarmStartLimit::WarmStartLimit(std::size_t body_capacity, const Parts& parts) : parts_(parts) {
  islands_.reserve(body_capacity + 1);
}

void WarmStartLimit::limit(const ContactRun& run) {
  if (!find_hard_pushes()) return;
  sum_energies();
  choose_shares();
  scale_bodies();
  scale_contacts(run);
}

bool WarmStartLimit::find_hard_pushes() {
  bool any = false;
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    if (is_below(parts_.bodies.before()[i], k_soft_push)) continue;
    const std::uint32_t island = parts_.islands.all().of(i);
    if (island == 0 || parts_.islands.tally(island).joints != 0) continue;
    LKS_ASSERT(!parts_.islands.tally(island).is_converged);
    if (!any) islands_.assign(parts_.islands.count(), {});
    LKS_ASSERT(is_reserved(islands_, parts_.islands.count()));
    islands_[island].is_pushed_hard = any = true;
  }
  return any;
}

void WarmStartLimit::sum_energies() {
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    Island& island = islands_[parts_.islands.all().of(i)];
    if (!island.is_pushed_hard) continue;
    const SolverBody& body = parts_.bodies.constants()[i];
    LKS_ASSERT(body.is_pushed());
    if (island.unit == BlockFloat{}) island.unit = body.inverse_mass;
    const BlockFloat mass = quotient(island.unit, body.inverse_mass);
    const lanes::BodyVelocity &row = parts_.bodies.rows()[i], &warm = parts_.bodies.before()[i];
    Vec3<Velocity> velocity = velocity_of_row(row.velocity), spin = velocity_of_row(row.spin);
    for (int axis = 0; axis < 3; ++axis) {
      velocity[axis].raw += body.gain[static_cast<std::size_t>(axis)];
      spin[axis].raw += body.spin_gain[static_cast<std::size_t>(axis)];
    }
    const Vec3<Velocity> gain = velocity_of_row(warm.velocity),
                         spin_gain = velocity_of_row(warm.spin);
    const Vec3<Velocity> surface = surface_velocity(body.inverse_inertia, spin_gain);
    add_energy(island.free, twice_energy(velocity, spin, body.inverse_inertia), mass);
    add_energy(island.square, energy_product(gain, gain, spin_gain, surface), mass);
    add_energy(island.linear, 2 * energy_product(velocity, gain, spin, surface), mass);
  }
}

// With a share s of the warm start the energy is free + s·linear + s²·square.
void WarmStartLimit::choose_shares() {
  for (Island& island : islands_) {
    const std::int64_t gained = raw::saturating_add(island.linear, island.square);
    if (gained > island.free >> k_warm_gain_shift)
      island.share = share_of(-(island.linear >> 1), island.square);
    LKS_ASSERT(island.share >= 0 && island.share <= 1 << k_share_bits);
  }
}

void WarmStartLimit::scale_bodies() {
  for (std::uint32_t i = 1; i < parts_.bodies.count(); ++i) {
    const std::int32_t share = islands_[parts_.islands.all().of(i)].share;
    if (share == 1 << k_share_bits) continue;
    LKS_ASSERT(share >= 0 && share < 1 << k_share_bits);
    lanes::BodyVelocity& warm = parts_.bodies.before()[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      warm.velocity[axis] = product_rounded(warm.velocity[axis], share, k_share_bits);
      warm.spin[axis] = product_rounded(warm.spin[axis], share, k_share_bits);
    }
  }
}

void WarmStartLimit::scale_contacts(const ContactRun& run) {
  parts_.contacts.for_each([&](ContactId id, const ContactRef& contact) {
    const std::int32_t share = islands_[parts_.islands.of(contact)].share;
    if (share == 1 << k_share_bits) return;
    const ContactLane place = parts_.layout.lane_of(id);
    scale_impulses(run.blocks[place.block()], place.lane(), share);
  });
}

}  // namespace lockstone
