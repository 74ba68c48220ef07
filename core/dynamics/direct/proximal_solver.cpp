#include "core/dynamics/direct/proximal_solver.h"

#include <algorithm>
#include <bit>

#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/problem/proximal_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using namespace proximal;
using lanes::ManifoldBlock;
using lanes::RowBody;
using lanes::scalar::pack;

// Units are such that all magnitudes at the beginning of a phase are below 2^27 of them; words hold
// 2^31. If a phase overflows, it is solved again with coarser units.
constexpr int k_start_bits = 27;
constexpr int k_most_bits = k_row_unit_bits - 1, k_least_bits = 2;
constexpr int k_coarser_bits = 5;
// A change of speed is none below this, m/s, Q50, nor below 2^-k_loose_bits of an approach.
constexpr std::int64_t k_least_contact_change = (std::int64_t{1} << 50) / 10000;
constexpr int k_loose_bits = 6;

// The leak of a normal's centre, at most: a tenth of its impulse, and half of the row's own weight.
constexpr std::int64_t k_leak_part = 10;

// Overlap goes at this rate, 1/s.
constexpr std::int64_t k_push_rate = 9;
// And no faster than this where there are joints, m/s, Q24.
constexpr std::int64_t k_most_jointed_push = (std::int64_t{1} << 24) / 4;

// Bounds of a body's velocity and spin, Q50, and of a total impulse.
constexpr std::int64_t k_motion_bound = std::int64_t{1} << 61;
constexpr std::int64_t k_most_total = std::int64_t{1} << (k_row_impulse_bits + 16);

}  // namespace

ProximalSolver::ProximalSolver(std::size_t rows, std::size_t body_capacity,
                               std::size_t contact_capacity, std::size_t joint_capacity)
    : local_(rows),
      body_capacity_(body_capacity),
      contact_capacity_(contact_capacity),
      joint_capacity_(std::min(joint_capacity, contact_capacity)),
      factor_(body_capacity, contact_capacity) {
  islands_.reserve(body_capacity);
  bodies_.reserve(body_capacity);
  contacts_.reserve(contact_capacity);
  joints_.reserve(joint_capacity_);
  problems_.reserve(contact_capacity);
  blocks_.reserve(contact_capacity);
  velocities_.reserve(2 * body_capacity);
  changes_.reserve(2 * body_capacity);
  gains_.reserve(2 * body_capacity);
  roots_.reserve(2 * body_capacity);
  pairs_.reserve(contact_capacity);
}

void ProximalSolver::clear(std::uint32_t first_free) {
  first_free_ = first_free;
  islands_.clear();
  bodies_.clear();
  contacts_.clear();
  joints_.clear();
  problems_.clear();
  blocks_.clear();
  velocities_.clear();
  changes_.clear();
  gains_.clear();
  roots_.clear();
  factor_.clear();
}

bool ProximalSolver::add(std::span<const std::uint32_t> bodies,
                         std::span<const ProximalContact> contacts,
                         std::span<const IslandJoint> joints) {
  Island island;
  island.first_body = static_cast<std::uint32_t>(bodies_.size());
  island.bodies = static_cast<std::uint32_t>(bodies.size());
  island.first_vector = static_cast<std::uint32_t>(velocities_.size());
  island.first_contact = static_cast<std::uint32_t>(contacts_.size());
  island.contacts = static_cast<std::uint32_t>(contacts.size());
  island.first_joint = static_cast<std::uint32_t>(joints_.size());
  island.joints = static_cast<std::uint32_t>(joints.size());
  island.first_problem = static_cast<std::uint32_t>(problems_.size());
  if (bodies_.size() + bodies.size() > body_capacity_ ||
      problems_.size() + island.problems() > contact_capacity_ ||
      joints_.size() + joints.size() > joint_capacity_)
    return false;
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    local_[bodies[i]] = i;
  pairs_.clear();
  const auto add_pair = [this](std::uint32_t a, std::uint32_t b) {
    if (a != 0 && b != 0) pairs_.emplace_back(local_[a], local_[b]);
  };
  for (const ProximalContact& contact : contacts)
    add_pair(contact.a, contact.b);
  for (const IslandJoint& joint : joints)
    add_pair(joint.a, joint.b);
  if (!factor_.plan(island.bodies, pairs_, island.plan)) return false;
  bodies_.insert(bodies_.end(), bodies.begin(), bodies.end());
  contacts_.insert(contacts_.end(), contacts.begin(), contacts.end());
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  for (const ProximalContact& contact : contacts)
    add_problem(island, contact.a, contact.b);
  for (const IslandJoint& joint : joints)
    add_problem(island, joint.a, joint.b);
  const std::size_t vectors = velocities_.size() + bodies.size() + 1;
  velocities_.resize(vectors);
  changes_.resize(vectors);
  gains_.resize(vectors);
  roots_.resize(vectors);
  islands_.push_back(island);
  return true;
}

void ProximalSolver::add_problem(const Island& island, std::uint32_t a, std::uint32_t b) {
  Problem& problem = problems_.emplace_back();
  problem.a = a != 0 ? local_[a] : island.bodies;
  problem.b = b != 0 ? local_[b] : island.bodies;
  Blocks blocks;
  if (a != 0) blocks.a = factor_.diagonal(island.plan, problem.a);
  if (b != 0) blocks.b = factor_.diagonal(island.plan, problem.b);
  if (a != 0 && b != 0) blocks.both = factor_.find(island.plan, problem.a, problem.b);
  blocks_.push_back(blocks);
}

// From here on the iterations only update the contact's separations.
void ProximalSolver::take_over(const ContactRun& run, ProximalContact& contact) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  contact.words = {block.mass_01[lane],
                   block.mass_23[lane],
                   block.tangent_mass[0][lane],
                   block.tangent_mass[1][lane],
                   block.twist_row[1][lane],
                   block.rest[lane],
                   block.soft[lane]};
  for (std::size_t i = 0; i < contact.points; ++i)
    block.points[i].impulse[lane] = 0;
  block.soft[lane] = low_word(block.soft[lane]) + (std::int64_t{1} << 62);
  block.rest[lane] = 0;
  block.mass_01[lane] = block.mass_23[lane] = 0;
  block.friction[lane] = 0;
  block.twist[lane] = pack(0, contact.radius);
  block.tangent_mass[0][lane] = block.tangent_mass[1][lane] = 0;
  block.twist_row[1][lane] = pack(block.twist_row[1][lane], 0);
}

// The island's 1/m₀.
BlockFloat ProximalSolver::find_unit(const ContactRun& run, const Island& island) {
  BlockFloat unit{};
  const auto is_less = [](BlockFloat x, BlockFloat y) {
    return x.exponent != y.exponent ? x.exponent < y.exponent : x.mantissa < y.mantissa;
  };
  const auto take = [&](BlockFloat inverse) {
    if (unit.mantissa == 0 || is_less(inverse, unit)) unit = inverse;
  };
  for (const ProximalContact& contact : contacts_of(island))
    take(lockstone::add(run.bodies[contact.a].inverse_mass, run.bodies[contact.b].inverse_mass));
  for (const IslandJoint& joint : std::span(joints_).subspan(island.first_joint, island.joints))
    take(joint.inverse_mass);
  return unit;
}

void ProximalSolver::begin(const ContactRun& run, std::uint32_t index, std::int64_t weight,
                           int substeps) {
  Island& island = islands_[index];
  island.unit = find_unit(run, island);
  const std::span<InertiaRoot> roots =
      std::span(roots_).subspan(island.first_vector, island.bodies + 1);
  for (std::uint32_t i = 0; i < island.bodies; ++i)
    roots[i] = inertia_root(run.bodies[bodies_[island.first_body + i]].inverse_inertia);
  roots[island.bodies] = {};
  for (std::uint32_t i = 0; i < island.contacts; ++i) {
    ProximalContact& contact = contacts_[island.first_contact + i];
    Problem& problem = problems_[island.first_problem + i];
    PreparedRows prepared;
    find_proximal_rows(run, roots[problem.a], roots[problem.b], island.unit, contact, problem,
                       prepared);
    problem.points = contact.points;
    problem.rows = contact.rows;
    take_over(run, contact);
    set_gives(weight, prepared, contact, problem);
    lanes::proximal_kernels().couple(problem);
    begin_rows(prepared, weight, contact, problem);
    measure(run, prepared, contact, problem);
    set_drives(run, substeps, contact, problem);
  }
  if (island.joints != 0) find_carried_speeds(run, island);
}

// Sets the parts of rows that stay for the tick.
void ProximalSolver::begin_rows(const PreparedRows& prepared, std::int64_t weight,
                                ProximalContact& contact, Problem& problem) {
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

// Rows do not change in a tick. Each substep but the first begins with the bodies gaining the same
// velocities as in the one before, so the rows' speeds gain the same, too.
void ProximalSolver::begin_substep(Island& island) {
  for (std::uint32_t c = 0; c < island.contacts; ++c) {
    ProximalContact& contact = contacts_[island.first_contact + c];
    Problem& problem = problems_[island.first_problem + c];
    for (std::size_t i = 0; i < contact.rows; ++i) {
      if (!island.is_first) {
        const std::int64_t start = problem.moving[i];
        problem.moving[i] = within_row(2 * start - problem.moved[i]);
        problem.moved[i] = start;
      }
      const std::int64_t held = island.is_first ? problem.warm[i] : problem.held[i];
      problem.held_centre[i] = held;
      if (i >= contact.points) continue;
      ProximalRow& row = contact.all[i];
      row.leak = std::min(held / k_leak_part, row.weight_leak);
      problem.held_centre[i] -= row.leak;
    }
    for (std::size_t i = 0; i < 2 && !island.is_first && contact.rows > contact.points; ++i)
      problem.bias[contact.points + i] += contact.bias_gain[i];
  }
  island.warms = island.is_first;
  island.is_first = false;
}

// The leak drives overlap out: the phase after it, which leaves overlap alone, has none.
void ProximalSolver::return_leaks(const Island& island) {
  for (std::uint32_t c = 0; c < island.contacts; ++c) {
    const ProximalContact& contact = contacts_[island.first_contact + c];
    for (std::size_t i = 0; i < contact.points; ++i)
      problems_[island.first_problem + c].held_centre[i] += contact.all[i].leak;
  }
}

// Sets the speeds at which separations close, or overlap is pushed out.
void ProximalSolver::set_bias(const ContactRun& run, const ProximalContact& contact,
                              Problem& problem, bool pushes_out, bool is_jointed) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  for (std::size_t i = 0; i < contact.points; ++i) {
    const RowScale& to_speed = contact.all[i].to_speed;
    const std::int64_t apart = high_word(block.points[i].separation[lane]) + run.rules.overlap;
    if (is_jointed && pushes_out) soften(-apart, contact.all[i], i, problem);
    if (apart > 0) {
      problem.bias[i] =
          within_row(to_speed.times(apart * run.rules.substep_rate, 24 - k_row_unit_bits));
    } else if (pushes_out) {
      const std::int64_t most =
          is_jointed ? k_most_jointed_push : std::int64_t{run.rules.push_out} * (1 << 4);
      const std::int64_t out = std::max(apart * k_push_rate, -most);
      problem.bias[i] = to_speed.times(out, 24 - k_row_unit_bits);
    } else {
      problem.bias[i] = 0;
    }
  }
}

// An impact need not be solved as finely as rest: nothing is solved below 2^-k_loose_bits of the
// fastest approach with which the substep began.
void ProximalSolver::loosen(Island& island) {
  const auto width = [](std::int64_t x) {
    return static_cast<int>(
        std::bit_width(static_cast<std::uint64_t>(std::max<std::int64_t>(x, 0))));
  };
  int most = 0;
  for (const Problem& problem : problems_of(island).first(island.contacts)) {
    for (std::size_t i = 0; i < problem.points; ++i)
      most = std::max(
          most, width(-(problem.moved[i] + problem.bias[i])) - width(problem.least_change[i]));
  }
  island.loose = std::max(most - k_loose_bits, 0);
}

// Chooses the phase's units. Returns false where nothing moves or pushes.
bool ProximalSolver::set_units(Island& island) {
  const std::span<const Problem> problems = problems_of(island);
  const std::uint64_t most = lanes::proximal_kernels().magnitudes(problems.data(), problems.size());
  if (most == 0) return false;
  const int finest = k_row_unit_bits + k_start_bits - static_cast<int>(std::bit_width(most));
  island.bits = std::clamp(finest, k_least_bits, k_most_bits);
  return true;
}

// Adds a contact's gain of impulse in the phase to its blocks, and the change of motion that
// follows to the gains of its bodies.
void ProximalSolver::give_contact(const ContactRun& run, int bits, ProximalContact& contact,
                                  Problem& problem, Gain& a, Gain& b) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  std::array<std::int64_t, k_contact_rows> moved{};
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
  }
  if (!changes) return;
  std::int64_t push = 0;
  ProductSum about_b, about_t;
  for (std::size_t i = 0; i < contact.points; ++i) {
    const std::int64_t seen = std::min<std::int64_t>(
        raw::round_shift(contact.all[i].total, k_row_more_bits), lanes::k_most_impulse);
    std::int64_t& word = block.points[i].impulse[lane];
    word = std::max<std::int64_t>(high_word(word), seen) * (std::int64_t{1} << 32) + seen;
    push += moved[i];
    about_b.subtract(contact.x[i], moved[i]);
    about_t.add(contact.y[i], moved[i]);
  }
  const std::int64_t* friction = &moved[contact.points];
  const std::int64_t turn = product_rounded(friction[2], contact.radius, 30);
  RawVec3 force = mixed(contact.tangent, friction[0], contact.binormal, friction[1]);
  RawVec3 torque =
      mixed(contact.tangent, about_t.rounded(30), contact.binormal, about_b.rounded(30));
  const RawVec3 along = mixed(contact.normal, push, {}, 0),
                about = mixed(contact.normal, turn, {}, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    force[i] += along[i];
    torque[i] += about[i];
  }
  const std::int64_t turns = block.gain_turn[lane], share = low_word(block.share[lane]);
  const RawVec3 spin_a = moment_of(low_words(block.gain_arm, lane), force, torque, low_word(turns));
  const RawVec3 spin_b =
      moment_of(high_words(block.gain_arm, lane), force, torque, high_word(turns));
  for (std::size_t i = 0; i < 3; ++i) {
    a.velocity[i] -= product_rounded(force[i], k_whole - share, 30);
    a.spin[i] -= spin_a[i];
    b.velocity[i] += product_rounded(force[i], share, 30);
    b.spin[i] += spin_b[i];
  }
}

// Gains are summed first: a partial sum may leave the range of a velocity.
void ProximalSolver::give(const ContactRun& run, Island& island) {
  const std::span<Gain> gains = std::span(gains_).subspan(island.first_vector, island.bodies + 1);
  for (Gain& gain : gains)
    gain = {};
  for (std::uint32_t c = 0; c < island.contacts; ++c) {
    Problem& problem = problems_[island.first_problem + c];
    give_contact(run, island.bits, contacts_[island.first_contact + c], problem, gains[problem.a],
                 gains[problem.b]);
  }
  const auto add = [](std::int64_t& to, std::int64_t by) {
    constexpr std::int64_t k_most = k_motion_bound >> k_row_shift;
    to = std::clamp(to + std::clamp(by, -k_most, k_most) * k_to_row, -k_motion_bound,
                    k_motion_bound);
  };
  for (std::uint32_t k = 0; k < island.bodies; ++k) {
    RowBody& row = run.rows[bodies_[island.first_body + k]];
    for (std::size_t i = 0; i < 3; ++i) {
      add(row.velocity[i], gains[k].velocity[i]);
      add(row.spin[i], gains[k].spin[i]);
    }
  }
}

// Adds the velocities that the phase gave to bodies to the speeds of the rows.
void ProximalSolver::follow(Island& island) {
  const std::span<Problem> problems = problems_of(island);
  lanes::proximal_kernels().follow(problems.data(), problems.size(), of(velocities_, island).data(),
                                   30 + island.bits - k_row_unit_bits);
}

void ProximalSolver::solve(const ContactRun& run, const JointAccess& joints, std::uint32_t index,
                           bool pushes_out) {
  Island& island = islands_[index];
  if (pushes_out)
    begin_substep(island);
  else
    return_leaks(island);
  if (island.joints != 0) see_joints(run, joints, island, pushes_out);
  for (std::uint32_t c = 0; c < island.contacts; ++c)
    set_bias(run, contacts_[island.first_contact + c], problems_[island.first_problem + c],
             pushes_out, island.joints != 0);
  loosen(island);
  if (!set_units(island)) return;
  while (!converge(island, pushes_out) && island.bits >= k_least_bits + k_coarser_bits)
    island.bits -= k_coarser_bits;
  if (island.warms)
    for (Problem& problem : problems_of(island))
      problem.warm = {};
  island.warms = false;
  give(run, island);
  give_joints(joints, island);
  follow(island);
}

void ProximalSolver::end(const ContactRun& run, std::uint32_t index) const {
  const Island& island = islands_[index];
  for (const ProximalContact& contact :
       std::span(contacts_).subspan(island.first_contact, island.contacts)) {
    ManifoldBlock& block = run.blocks[contact.block()];
    const std::size_t lane = contact.lane();
    std::array<std::int64_t, 3> seen{};
    for (std::size_t i = contact.points; i < contact.rows; ++i)
      seen[i - contact.points] =
          std::clamp<std::int64_t>(raw::round_shift(contact.all[i].total, k_row_more_bits),
                                   -lanes::k_most_impulse, lanes::k_most_impulse);
    block.friction[lane] = pack(seen[0], seen[1]);
    block.twist[lane] = pack(seen[2], contact.radius);
    block.mass_01[lane] = contact.words[0];
    block.mass_23[lane] = contact.words[1];
    block.tangent_mass[0][lane] = contact.words[2];
    block.tangent_mass[1][lane] = contact.words[3];
    block.twist_row[1][lane] = contact.words[4];
    block.rest[lane] = contact.words[5];
    block.soft[lane] = contact.words[6];
  }
}

}  // namespace lockstone
