// The initial warm start of new stacks.
#include "core/dynamics/stack/initial_warm_start.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/contact/block_words.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;
using lanes::k_block_lanes;
using lanes::k_block_points;
using lanes::ManifoldBlock;

// Most rounds over the supports of one body, of each kind, and the change of an impulse that ends
// them, Q32: 0.1 µm/s.
constexpr int k_most_support_rounds = 16;
constexpr std::int64_t k_settled = std::int64_t{1} << 9;

// A body tips over if a point opens faster than this part of the speed that gravity and forces give
// it in a substep: 2^-3.
constexpr int k_tipping_shift = 3;

// Along the normal, towards the body that rests: of a point or of all points at once, Q50.
std::int64_t speed_of(const RawVec3& normal, const RawVec3& response, bool is_b,
                      const BodyVelocity& body) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(normal[i], body.velocity[i]);
    sum.add(response[i], body.spin[i]);
  }
  const std::int64_t speed = sum.rounded(30);
  return is_b ? speed : -speed;
}

// The impulse that stops it, Q32.
std::int64_t stopping(std::int64_t speed, std::int64_t response) {
  constexpr std::int64_t k_most = std::int64_t{1} << 60;
  return raw::round_divide(-std::clamp(speed, -k_most, k_most) * 4,
                           std::max<std::int64_t>(response >> 10, 1));
}

// direction · by, Q30 · Q32, to the Q50 of rows in steps of 2^-32; added or taken.
void add_scaled(const RawVec3& direction, std::int64_t by, bool is_taken,
                std::array<std::int64_t, 3>& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t change = product_rounded(direction[i], by, 30) * k_to_row;
    to[i] += is_taken ? -change : change;
  }
}

}  // namespace

void InitialWarmStart::make_room(std::uint32_t workers) {
  while (supports_.size() < workers)
    supports_.emplace_back().reserve(k_most_supports);
}

void InitialWarmStart::find(SupportGraph& order, const ContactRun& run,
                            std::span<BodyVelocity> warm, Parallel& parallel) {
  order.find(run,
             [&](const SupportLink&, std::uint32_t body) { return is_at_rest(run.rows[body]); });
  LKS_ASSERT(warm.size() >= run.bodies.size());
  mean_impulses_.assign(order.links().size(), k_no_impulse);
  order.descend(parallel, warm, [&](std::uint32_t body, std::uint32_t worker) {
    Supports& supports = supports_[worker];
    gather(order, run, body, supports);
    support_body(run.bodies[body], warm[body], supports);
    for (const Support& support : supports) {
      RowPush to_a, to_b;
      propagate(run, support, to_a, to_b);
      order.propagate(support.link, support.is_b, to_a, to_b, warm[body]);
    }
  });
}

// All points of a support push alike as far as that suffices, since iterations keep a pressure in
// the middle best. A body that tips over has no supports.
void InitialWarmStart::support_body(const SolverBody& body, const BodyVelocity& warm,
                                    Supports& supports) {
  LKS_ASSERT(body.is_pushed());
  BodyVelocity row = warm;
  for (std::size_t i = 0; i < 3; ++i) {
    row.velocity[i] += body.gain[i] * k_to_row;
    row.spin[i] += body.spin_gain[i] * k_to_row;
  }
  const auto settle = [&](const auto& push_support) {
    std::int64_t most = k_settled;
    for (int round = 0; round < k_most_support_rounds && most >= k_settled; ++round) {
      most = 0;
      for (Support& support : supports)
        most = std::max(most, push_support(support));
    }
  };
  settle([&](Support& support) { return push_together(support, row); });
  settle([&](Support& support) { return push_points(support, row); });
  if (tips(row, body, supports)) supports.clear();
}

// Whether a point opens faster than a part of the weight would close it, so that the body falls.
// Its push, if propagated, would grow from body to body.
bool InitialWarmStart::tips(const BodyVelocity& row, const SolverBody& body,
                            const Supports& supports) {
  const std::int64_t slow = (body.greatest_gain() >> k_tipping_shift) * k_to_row;
  return std::ranges::any_of(supports, [&](const Support& support) {
    for (std::size_t i = 0; i < support.contact.count; ++i)
      if (speed_of(support.contact.normal, support.response_of(i), support.is_b, row) > slow)
        return true;
    return false;
  });
}

void InitialWarmStart::gather(const SupportGraph& order, const ContactRun& run, std::uint32_t body,
                              Supports& supports) {
  supports.clear();
  order.for_supports(body, [&](const SupportLink& link, std::uint32_t number) {
    LKS_ASSERT(number < order.links().size());
    if (supports.size() == k_most_supports) return;
    Support& support = supports.emplace_back();
    support.contact = {link};
    support.link = number;
    support.takes_mean = link.takes_mean;
    support.is_b = link.b == body;
    fill(run, support);
  });
}

void InitialWarmStart::fill(const ContactRun& run, Support& support) {
  LKS_ASSERT(support.contact.a != 0 || support.contact.b != 0);
  ContactRows& contact = support.contact;
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  find_rows(run, contact);
  const std::int64_t share_b = low_word(block.share[lane]);
  support.share = support.is_b ? share_b : (std::int64_t{1} << 30) - share_b;
  const auto own = [&](const RawVec3& turn, const RawVec3& response) {
    return product_rounded(coupled(contact.normal, contact.normal, turn, response), support.share,
                           30);
  };
  if (contact.count == 0) return;
  for (std::size_t i = 0; i < contact.count; ++i) {
    const RawVec3 &turn = support.turn_of(i), &response = support.response_of(i);
    support.impulse[i] = contact.points[i].impulse;
    support.own[i] = own(turn, response);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      support.turn[axis] += turn[axis];
      support.response[axis] += response[axis];
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    support.turn[axis] = raw::round_divide(support.turn[axis], contact.count);
    support.response[axis] = raw::round_divide(support.response[axis], contact.count);
  }
  support.common = own(support.turn, support.response);
}

// Returns the magnitude of the change of each point's impulse, Q32.
std::int64_t InitialWarmStart::push_together(Support& support, BodyVelocity& body) {
  const ContactRows& contact = support.contact;
  if (contact.count == 0) return 0;
  const std::int64_t least =
      *std::ranges::min_element(std::span(support.impulse).first(contact.count));
  const std::int64_t all =
      stopping(speed_of(contact.normal, support.response, support.is_b, body), support.common);
  const std::int64_t each = std::max(raw::round_divide(all, contact.count), -least);
  LKS_ASSERT(least >= 0);
  for (std::size_t i = 0; i < contact.count; ++i)
    support.impulse[i] += each;
  const std::int64_t by = product_rounded(each * contact.count, support.share, 30);
  add_scaled(contact.normal, by, !support.is_b, body.velocity);
  add_scaled(support.turn, by, !support.is_b, body.spin);
  return std::abs(each);
}

std::int64_t InitialWarmStart::push_points(Support& support, BodyVelocity& body) {
  const ContactRows& contact = support.contact;
  std::int64_t most = 0;
  for (std::size_t i = 0; i < contact.count; ++i) {
    const std::int64_t asked = stopping(
        speed_of(contact.normal, support.response_of(i), support.is_b, body), support.own[i]);
    const std::int64_t change = std::max(asked, -support.impulse[i]);
    support.impulse[i] += change;
    LKS_ASSERT(support.impulse[i] >= 0);
    const std::int64_t by = product_rounded(change, support.share, 30);
    add_scaled(contact.normal, by, !support.is_b, body.velocity);
    add_scaled(support.turn_of(i), by, !support.is_b, body.spin);
    most = std::max(most, std::abs(change));
  }
  return most;
}

// Gives the impulses to the block, rounded to its steps, and to both bodies. A new contact takes
// them as its mean impulse.
void InitialWarmStart::propagate(const ContactRun& run, const Support& support, RowPush& to_a,
                                 RowPush& to_b) {
  const ContactRows& contact = support.contact;
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  const std::int64_t share_b = low_word(block.share[lane]);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < contact.count; ++i) {
    const PointRow& point = contact.points[i];
    const std::int64_t now = std::clamp<std::int64_t>(
        raw::round_shift(support.impulse[i], k_row_more_bits), 0, lanes::k_most_impulse);
    sum += now;
    std::int64_t& word = block.points[i].impulse[lane];
    word = std::max<std::int64_t>(high_word(word), now) * (std::int64_t{1} << 32) + now;
    const std::int64_t change = now * (std::int64_t{1} << k_row_more_bits) - point.impulse;
    const std::int64_t part_b = product_rounded(change, share_b, 30), part_a = change - part_b;
    if (contact.a != 0) {
      add_scaled(contact.normal, part_a, true, to_a.velocity);
      add_scaled(point.angular_a, part_a, true, to_a.spin);
    }
    if (contact.b != 0) {
      add_scaled(contact.normal, part_b, false, to_b.velocity);
      add_scaled(point.angular_b, part_b, false, to_b.spin);
    }
  }
  if (!support.takes_mean || contact.count == 0) return;
  const std::int64_t mean = raw::round_divide(sum, contact.count);
  LKS_ASSERT(mean >= 0 && mean <= lanes::k_most_impulse);
  block.mean_part[lane] = ((std::int64_t{1} << 30) - high_word(block.soft[lane])) * mean;
  mean_impulses_[support.link] = static_cast<std::int32_t>(mean);
}

void InitialWarmStart::store(const SupportGraph& order, std::span<ContactRecord> records) const {
  for (std::size_t i = 0; i < mean_impulses_.size(); ++i)
    if (mean_impulses_[i] != k_no_impulse)
      records[order.links()[i].record].mean_impulse.raw = mean_impulses_[i];
}

}  // namespace lockstone
