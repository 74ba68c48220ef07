#include "core/dynamics/direct/contact_phases.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/direct/contact_speeds.h"
#include "core/dynamics/problem/proximal_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone::contact_phases {
namespace {

using namespace proximal;
using lanes::BodyVelocity;
using lanes::ManifoldBlock;
using lanes::scalar::pack;
using Problem = lanes::ProximalBlock;
using RowWords = std::array<std::int64_t, k_contact_rows>;

// A change of speed is none below this, m/s, Q50, nor below 2^-k_loose_bits of an approach; while
// the bodies are stirred, it is none below 2^k_stir_bits of this for each level.
constexpr std::int64_t k_least_contact_change = (std::int64_t{1} << 50) / 10000;
constexpr int k_loose_bits = 6, k_stir_bits = 2;

// The leak of a normal's centre, at most: a tenth of its impulse, and half of the row's own weight.
constexpr std::int64_t k_leak_part = 10;

// Overlap goes at this rate, 1/s.
constexpr std::int64_t k_push_rate = 9;
// And no faster than this where there are joints, m/s, Q24.
constexpr std::int64_t k_most_jointed_push = (std::int64_t{1} << 24) / 4;

// Bounds of a body's velocity and spin, Q50, and of a total impulse: a light body under one of
// 200,000 times its mass that falls at 20 m/s feels 2^22 m/s.
constexpr std::int64_t k_motion_bound = std::int64_t{1} << 61;
constexpr std::int64_t k_most_total = std::int64_t{1} << (k_row_impulse_bits + 22);

// From here on the iterations only update the contact's separations.
void take_over(const ContactRun& run, ProximalContact& contact) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  LKS_ASSERT(contact.points <= lanes::k_block_points && contact.points <= contact.rows &&
             contact.rows <= k_contact_rows);
  contact.words = {block.mass_01[lane],
                   block.mass_23[lane],
                   block.tangent_mass[0][lane],
                   block.tangent_mass[1][lane],
                   block.twist_row[1][lane],
                   block.mean_part[lane],
                   block.soft[lane]};
  for (std::size_t i = 0; i < contact.points; ++i)
    block.points[i].impulse[lane] = 0;
  block.soft[lane] = low_word(block.soft[lane]) + (std::int64_t{1} << 62);
  block.mean_part[lane] = 0;
  block.mass_01[lane] = block.mass_23[lane] = 0;
  block.friction[lane] = 0;
  block.twist[lane] = pack(0, contact.radius);
  block.tangent_mass[0][lane] = block.tangent_mass[1][lane] = 0;
  block.twist_row[1][lane] = pack(block.twist_row[1][lane], 0);
}

// The island's 1/m₀.
BlockFloat find_unit(const ContactRun& run, const IslandView& island) {
  BlockFloat unit{};
  for (const std::uint32_t body : island.bodies) {
    const BlockFloat inverse = run.bodies[body].inverse_mass;
    LKS_ASSERT(inverse.mantissa > 0);
    if (unit.mantissa == 0 || is_less(inverse, unit)) unit = inverse;
  }
  LKS_ASSERT(unit.mantissa > 0);
  return unit;
}

// Sets the parts of rows that stay for the tick.
void begin_rows(const PreparedRows& prepared, std::int64_t weight, ProximalContact& contact,
                Problem& problem) {
  LKS_ASSERT(weight >= 0 && contact.points <= contact.rows);
  constexpr int k_down = k_row_impulse_bits - k_row_unit_bits;
  for (std::size_t i = 0; i < contact.rows; ++i) {
    ProximalRow& row = contact.all[i];
    const RowScale& scale = prepared.from_impulse[i];
    problem.warm[i] = within_row(scale.times(row.total, k_down));
    row.total = 0;
    problem.least_change[i] = row.to_speed.times(k_least_contact_change, 50 - k_row_unit_bits);
    if (i < contact.points)
      row.weight_leak = scale.times(raw::round_divide(weight << 29, prepared.own[i]), k_down);
  }
}

// Joints may fasten bodies where they overlap, and then no impulses part them: they would grow
// without limit. The deeper a point overlaps, the softer its row, and the more of its impulse it
// forgets. A row keeps its compliance while it is within an eighth: with another one the factor at
// hand is that of another matrix. Returns whether the compliance changes.
bool soften(std::int64_t overlap, const ProximalRow& row, std::size_t i, Problem& problem) {
  constexpr std::int64_t k_hard = (std::int64_t{1} << 24) / 4000, k_soft = 16 * k_hard;  // m, Q24
  constexpr std::int64_t k_most_give = k_whole >> 3;
  constexpr std::int64_t k_width = k_soft - k_hard;
  const std::int64_t beyond = std::clamp<std::int64_t>(overlap - k_hard, 0, k_width);
  const std::int64_t kept = problem.give[i];
  LKS_ASSERT(row.give > 0 && kept > 0);
  const std::int64_t more = std::max<std::int64_t>(k_most_give - row.give, 0);
  const std::int64_t give = row.give + raw::round_divide(more * beyond, k_width);
  const bool changes = 8 * magnitude(give - kept) > static_cast<std::uint64_t>(kept);
  if (changes) set_give(give, i, problem);
  problem.held_centre[i] -= raw::round_divide(problem.held[i] / 2, k_width) * beyond;
  return changes;
}

// Sets the speeds at which separations close, or overlap is pushed out. Returns whether a row's
// compliance changes.
bool set_bias(const ContactRun& run, const ProximalContact& contact, Problem& problem,
              bool pushes_out, bool is_jointed) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  LKS_ASSERT(contact.points <= lanes::k_block_points);
  bool gives_change = false;
  for (std::size_t i = 0; i < contact.points; ++i) {
    const RowScale& to_speed = contact.all[i].to_speed;
    const std::int64_t apart = high_word(block.points[i].separation[lane]) + run.params.overlap;
    if (is_jointed && pushes_out)
      gives_change = soften(-apart, contact.all[i], i, problem) || gives_change;
    if (apart > 0) {
      problem.bias[i] =
          within_row(to_speed.times(apart * run.params.substep_rate, 24 - k_row_unit_bits));
    } else if (pushes_out) {
      const std::int64_t most =
          is_jointed ? k_most_jointed_push : std::int64_t{run.params.push_out} * (1 << 4);
      const std::int64_t out = std::max(apart * k_push_rate, -most);
      problem.bias[i] = to_speed.times(out, 24 - k_row_unit_bits);
    } else {
      problem.bias[i] = 0;
    }
  }
  return gives_change;
}

// Adds a contact's gain of impulse in the phase to its rows. Returns whether there is any; `moved`:
// by row, the pair's velocity jump, m/s, Q32.
bool gain_impulses(int bits, ProximalContact& contact, Problem& problem, RowWords& moved) {
  bool changes = false;
  for (std::size_t i = 0; i < contact.rows; ++i) {
    const std::int64_t impulse = problem.impulse[i], change = impulse - problem.start[i];
    if (change == 0) continue;
    const std::int64_t gained = raw::scale_saturating(change, k_row_unit_bits - bits);
    problem.held[i] = impulse == 0 ? 0 : within_row(problem.held[i] + within_row(gained));
    changes = true;
    ProximalRow& row = contact.all[i];
    const std::int64_t least = i < contact.points ? 0 : -k_most_total;
    const std::int64_t next =
        impulse == 0 ? 0 : row.total + row.to_impulse.times_word(change, bits - k_row_impulse_bits);
    moved[i] = std::clamp(next, least, k_most_total) - row.total;
    row.total += moved[i];
    LKS_ASSERT(i >= contact.points || row.total >= 0);
  }
  return changes;
}

// Writes a contact's impulses of points to its block, as iterations have them.
void write_points(const ContactRun& run, const ProximalContact& contact) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  for (std::size_t i = 0; i < contact.points; ++i) {
    const std::int64_t seen = std::min<std::int64_t>(
        raw::round_shift(contact.all[i].total, k_row_more_bits), lanes::k_most_impulse);
    LKS_ASSERT(seen >= 0);
    std::int64_t& word = block.points[i].impulse[lane];
    word = std::max<std::int64_t>(high_word(word), seen) * (std::int64_t{1} << 32) + seen;
  }
}

// Adds the change of motion by impulses of a contact to the gains of its bodies.
template <class Sum>
void push_bodies(const ManifoldBlock& block, const ProximalContact& contact, const RowWords& moved,
                 PhaseGain& a, PhaseGain& b) {
  const std::size_t lane = contact.lane();
  LKS_ASSERT(contact.rows <= contact.points + 3);
  const auto product = [](std::int64_t x, std::int64_t y) {
    Sum sum;
    sum.add(x, y);
    return sum.rounded(30);
  };
  LKS_ASSERT(contact.points <= contact.rows);
  std::int64_t push = 0;
  Sum about_b, about_t;
  for (std::size_t i = 0; i < contact.points; ++i) {
    push += moved[i];
    about_b.subtract(contact.x[i], moved[i]);
    about_t.add(contact.y[i], moved[i]);
  }
  const std::int64_t* friction = &moved[contact.points];
  const std::int64_t turn = product(friction[2], contact.radius);
  RawVec3 force = mixed<Sum>(contact.tangent, friction[0], contact.binormal, friction[1]);
  RawVec3 torque =
      mixed<Sum>(contact.tangent, about_t.rounded(30), contact.binormal, about_b.rounded(30));
  for (std::size_t i = 0; i < 3; ++i) {
    force[i] += product(contact.normal[i], push);
    torque[i] += product(contact.normal[i], turn);
  }
  const std::int64_t turns = block.gain_turn[lane], share = low_word(block.share[lane]);
  const RawVec3 spin_a =
      moment_of<Sum>(low_words(block.gain_arm, lane), force, torque, low_word(turns));
  const RawVec3 spin_b =
      moment_of<Sum>(high_words(block.gain_arm, lane), force, torque, high_word(turns));
  for (std::size_t i = 0; i < 3; ++i) {
    a.velocity[i] -= product(force[i], k_whole - share);
    a.spin[i] -= spin_a[i];
    b.velocity[i] += product(force[i], share);
    b.spin[i] += spin_b[i];
  }
}

// Of the tangents and the twist, as iterations have them.
std::array<std::int64_t, 3> friction_of(const ProximalContact& contact) {
  LKS_ASSERT(contact.points <= contact.rows && contact.rows - contact.points <= 3);
  std::array<std::int64_t, 3> seen{};
  for (std::size_t i = contact.points; i < contact.rows; ++i)
    seen[i - contact.points] =
        std::clamp<std::int64_t>(raw::round_shift(contact.all[i].total, k_row_more_bits),
                                 -lanes::k_most_impulse, lanes::k_most_impulse);
  return seen;
}

// Whether all impulses are below 2^-7 m/s, as at rest: then all sums of products fit in 64 bits.
bool are_small(const RowWords& moved) {
  std::int64_t bits = 0;
  for (const std::int64_t by : moved)
    bits |= by ^ (by >> 63);
  return bits >> (k_row_impulse_bits - 7) == 0;
}

}  // namespace

void begin(const ContactRun& run, const IslandView& island, std::int64_t weight, int substeps) {
  island.state.unit = find_unit(run, island);
  for (IslandJoint& joint : island.joints)
    joint.mass = mass_scale(island.state.unit, joint.inverse_mass);
  for (std::size_t i = 0; i < island.bodies.size(); ++i)
    island.roots[i] = inertia_root(run.bodies[island.bodies[i]].inverse_inertia);
  island.roots[island.bodies.size()] = {};
  for (std::size_t i = 0; i < island.contacts.size(); ++i) {
    ProximalContact& contact = island.contacts[i];
    Problem& problem = island.problems[i];
    PreparedRows prepared;
    find_proximal_rows(run, island.roots[problem.a], island.roots[problem.b], island.state.unit,
                       contact, problem, prepared);
    LKS_ASSERT(contact.points <= contact.rows && contact.rows <= k_contact_rows);
    problem.points = contact.points;
    problem.rows = contact.rows;
    take_over(run, contact);
    set_gives(weight, prepared, contact, problem);
    lanes::proximal_kernels().couple(problem);
    begin_rows(prepared, weight, contact, problem);
    measure_speeds(run, prepared, contact, problem);
    set_drives(run, substeps, contact, problem);
  }
}

// Rows do not change in a tick. Each substep but the first begins with the bodies gaining the same
// velocities as in the one before, so the rows' speeds gain the same, too.
void begin_substep(const IslandView& island) {
  for (std::size_t c = 0; c < island.contacts.size(); ++c) {
    ProximalContact& contact = island.contacts[c];
    Problem& problem = island.problems[c];
    for (std::size_t i = 0; i < contact.rows; ++i) {
      if (!island.state.is_first) {
        const std::int64_t start = problem.moving[i];
        problem.moving[i] = within_row(2 * start - problem.moved[i]);
        problem.moved[i] = start;
      }
      const std::int64_t held = island.state.is_first ? problem.warm[i] : problem.held[i];
      problem.held_centre[i] = held;
      if (i >= contact.points) continue;
      ProximalRow& row = contact.all[i];
      LKS_ASSERT(held >= 0);
      LKS_ASSERT(row.weight_leak >= 0);
      row.leak = std::min(held / k_leak_part, row.weight_leak);
      problem.held_centre[i] -= row.leak;
    }
    for (std::size_t i = 0; i < 2 && !island.state.is_first && contact.rows > contact.points; ++i)
      problem.bias[contact.points + i] += contact.bias_gain[i];
  }
  island.state.warms = island.state.is_first;
  island.state.is_first = false;
}

void return_leaks(const IslandView& island) {
  for (std::size_t c = 0; c < island.contacts.size(); ++c) {
    const ProximalContact& contact = island.contacts[c];
    for (std::size_t i = 0; i < contact.points; ++i)
      island.problems[c].held_centre[i] += contact.all[i].leak;
  }
}

void set_biases(const ContactRun& run, const IslandView& island, bool pushes_out) {
  LKS_ASSERT(island.problems.size() == island.contacts.size() + island.joints.size());
  bool gives_change = false;
  const bool is_jointed = !island.joints.empty();
  for (std::size_t c = 0; c < island.contacts.size(); ++c)
    gives_change = set_bias(run, island.contacts[c], island.problems[c], pushes_out, is_jointed) ||
                   gives_change;
  if (gives_change) island.state.drop_factor();
}

void loosen(const IslandView& island) {
  const auto width = [](std::int64_t x) {
    return static_cast<int>(
        std::bit_width(static_cast<std::uint64_t>(std::max<std::int64_t>(x, 0))));
  };
  int most = 0;
  for (const Problem& problem : island.contact_problems()) {
    for (std::size_t i = 0; i < problem.points; ++i)
      most = std::max(
          most, width(-(problem.moved[i] + problem.bias[i])) - width(problem.least_change[i]));
  }
  island.state.loose = std::max({most - k_loose_bits, k_stir_bits * island.state.stir, 0});
  LKS_ASSERT(island.state.loose < 63);
}

// Gains are summed first: a partial sum may leave the range of a velocity.
void give(const ContactRun& run, const IslandView& island) {
  const std::span<PhaseGain> gains = island.gains;
  std::ranges::fill(gains, PhaseGain{});
  for (std::size_t c = 0; c < island.contacts.size(); ++c) {
    Problem& problem = island.problems[c];
    RowWords moved{};
    LKS_ASSERT(problem.a < gains.size() && problem.b < gains.size());
    ProximalContact& contact = island.contacts[c];
    if (!gain_impulses(island.state.bits, contact, problem, moved)) continue;
    write_points(run, contact);
    const ManifoldBlock& block = run.blocks[contact.block()];
    if (are_small(moved))
      push_bodies<SmallProductSum>(block, contact, moved, gains[problem.a], gains[problem.b]);
    else
      push_bodies<ProductSum>(block, contact, moved, gains[problem.a], gains[problem.b]);
  }
  const auto add = [](std::int64_t& to, std::int64_t by) {
    constexpr std::int64_t k_most = k_motion_bound >> k_row_shift;
    to = std::clamp(to + std::clamp(by, -k_most, k_most) * k_to_row, -k_motion_bound,
                    k_motion_bound);
  };
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    BodyVelocity& row = run.rows[island.bodies[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      add(row.velocity[i], gains[k].velocity[i]);
      add(row.spin[i], gains[k].spin[i]);
    }
  }
}

std::int64_t friction_word(const ProximalContact& contact) {
  LKS_ASSERT(contact.rows <= k_contact_rows);
  const std::array<std::int64_t, 3> seen = friction_of(contact);
  return pack(seen[0], seen[1]);
}

void end(const ContactRun& run, const IslandView& island) {
  for (const ProximalContact& contact : island.contacts) {
    ManifoldBlock& block = run.blocks[contact.block()];
    const std::size_t lane = contact.lane();
    const std::array<std::int64_t, 3> seen = friction_of(contact);
    block.friction[lane] = pack(seen[0], seen[1]);
    block.twist[lane] = pack(seen[2], contact.radius);
    block.mass_01[lane] = contact.words[0];
    block.mass_23[lane] = contact.words[1];
    block.tangent_mass[0][lane] = contact.words[2];
    block.tangent_mass[1][lane] = contact.words[3];
    block.twist_row[1][lane] = contact.words[4];
    block.mean_part[lane] = contact.words[5];
    block.soft[lane] = contact.words[6];
  }
}

}  // namespace lockstone::contact_phases
