// What was solved at once is given to points and bodies, or left to the sweeps.

#include <algorithm>

#include "core/dynamics/direct_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::k_block_points;
using lanes::ManifoldBlock;
using lanes::RowBody;

constexpr std::int64_t k_most_row_impulse = std::int64_t{1} << (k_row_impulse_bits + 16);

// What a body's velocity and spin are held within, Q50.
constexpr std::int64_t k_body_bound = std::int64_t{1} << 61;

}  // namespace

// Gives points what was found; or, as long as others pull, only lets those go.
void DirectContacts::push_all(const ContactRun& run, const Group& group, bool only_lets_go) {
  for (Contact& contact : contacts_of(group)) {
    Impulses next{};
    for (std::size_t i = 0; i < contact.count; ++i) {
      const PointRow& point = contact.points[i];
      const bool stays = !contact.is_active(i) || (only_lets_go && !contact.is_barred(i));
      next[i] = point.impulse + (stays ? 0 : point.change);
    }
    push(run, contact, next);
    if (is_tied(contact) && !only_lets_go) push_tie(run, contact);
  }
  gain(run, group);
}

// As a sweep gives impulses to its bodies, but for `gain`.
void DirectContacts::push(const ContactRun& run, Contact& contact, const Impulses& next) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  std::int64_t change = 0;
  ProductSum about_b, about_t;
  for (std::size_t i = 0; i < contact.count; ++i) {
    PointRow& point = contact.points[i];
    const std::int64_t now = std::clamp<std::int64_t>(next[i], 0, k_most_row_impulse);
    const std::int64_t moved = now - point.impulse;
    point.impulse = now;
    const std::int64_t seen =
        std::min<std::int64_t>(raw::round_shift(now, k_row_more_bits), lanes::k_most_impulse);
    std::int64_t& word = block.points[i].impulse[lane];
    word = std::max<std::int64_t>(high_word(word), seen) * (std::int64_t{1} << 32) + seen;
    change += moved;
    about_b.subtract(point.x, moved);
    about_t.add(point.y, moved);
  }
  const RawVec3 force = mixed(contact.normal, change, {}, 0);
  const RawVec3 torque =
      mixed(contact.tangent, about_t.rounded(30), contact.binormal, about_b.rounded(30));
  give(run, contact, force, torque);
}

// An impulse and a torque, at the centre.
void DirectContacts::give(const ContactRun& run, const Contact& contact, const RawVec3& force,
                          const RawVec3& torque) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  const std::int64_t turn = block.gain_turn[lane], share = low_word(block.share[lane]);
  RawVec3 to_b{};
  for (std::size_t i = 0; i < 3; ++i)
    to_b[i] = product_rounded(force[i], share, 30);
  if (contact.a != 0) {
    Gain& a = gains_[gain_place_[contact.a]];
    const RawVec3 spin = moment_of(low_words(block.gain_arm, lane), force, torque, low_word(turn));
    for (std::size_t i = 0; i < 3; ++i) {
      a.velocity[i] += to_b[i] - force[i];
      a.spin[i] -= spin[i];
    }
  }
  if (contact.b == 0) return;
  Gain& b = gains_[gain_place_[contact.b]];
  const RawVec3 spin = moment_of(high_words(block.gain_arm, lane), force, torque, high_word(turn));
  for (std::size_t i = 0; i < 3; ++i) {
    b.velocity[i] += to_b[i];
    b.spin[i] += spin[i];
  }
}

void DirectContacts::push_tie(const ContactRun& run, const Contact& contact) {
  Tie& tie = ties_[contact.tie - 1];
  std::array<std::int64_t, 3> moved{};
  for (std::size_t i = 0; i < tie.count; ++i) {
    ContactRow& row = tie.rows[i];
    const std::int64_t now =
        std::clamp(row.impulse + row.change, -k_most_row_impulse, k_most_row_impulse);
    moved[i] = now - row.impulse;
    row.impulse = now;
  }
  const std::int64_t turn = product_rounded(moved[2], tie.radius, 30);
  give(run, contact, mixed(contact.tangent, moved[0], contact.binormal, moved[1]),
       mixed(contact.normal, turn, {}, 0));
}

// What contacts give adds up first: it may leave the range of a velocity on its way.
void DirectContacts::gain(const ContactRun& run, const Group& group) {
  constexpr int k_shift = lanes::k_velocity_bits - k_row_impulse_bits;
  const auto add = [](std::int64_t& to, std::int64_t by) {
    constexpr std::int64_t k_most = k_body_bound >> k_shift;
    const std::int64_t limited = std::clamp(by, -k_most, k_most) * (std::int64_t{1} << k_shift);
    to = std::clamp(to + limited, -k_body_bound, k_body_bound);
  };
  for (std::uint32_t k = group.first_body; k < group.first_body + group.body_count; ++k) {
    RowBody& row = run.rows[bodies_[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      add(row.velocity[i], gains_[k].velocity[i]);
      add(row.spin[i], gains_[k].spin[i]);
    }
    gains_[k] = {};
  }
}

// The sweeps do its normals as well.
void DirectContacts::give_back(const ContactRun& run, const Contact& contact) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  using lanes::scalar::pack;
  block.mass_01[lane] = pack(contact.masses[0], contact.masses[1]);
  block.mass_23[lane] = pack(contact.masses[2], contact.masses[3]);
  block.common[lane] += contact.common_mass;
}

// What does not come out is left to the sweeps; here is one in place of that which is past.
void DirectContacts::leave(const ContactRun& run, Group& group, bool pushes_out) {
  for (Contact& contact : contacts_of(group)) {
    for (std::size_t i = 0; i < contact.count; ++i) {
      read(run, contact, pushes_out);
      Impulses next{};
      for (std::size_t k = 0; k < contact.count; ++k)
        next[k] = contact.points[k].impulse;
      next[i] -=
          product_rounded(contact.points[i].speed, contact.masses[i], 80 - k_row_impulse_bits);
      push(run, contact, next);
      gain(run, group);
    }
    give_back(run, contact);
    release(run, contact);
  }
  group.is_left = true;
}

}  // namespace lockstone
