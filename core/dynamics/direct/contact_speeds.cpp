#include "core/dynamics/direct/contact_speeds.h"

#include <lockstone/assert.h>

#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/problem/proximal_words.h"

namespace lockstone {
namespace {

using namespace proximal;
using lanes::BodyVelocity;
using lanes::ManifoldBlock;

// Velocity and spin of A and B, Q50.
struct Motion {
  RawVec3 along{}, spin_a{}, spin_b{};
};

std::int64_t speed_along(const RawVec3* linear, const RawVec3& response_a,
                         const RawVec3& response_b, const Motion& motion) {
  ProductSum sum;
  for (std::size_t k = 0; k < 3; ++k) {
    if (linear != nullptr) sum.add((*linear)[k], motion.along[k]);
    sum.add(response_b[k], motion.spin_b[k]);
    sum.subtract(response_a[k], motion.spin_a[k]);
  }
  return sum.rounded(30);
}

// √(m/m₀)·(v, Cᵀ·spin), in units of kept quantities.
BodyVector motion_of(const lanes::BodyVelocity& row, const InertiaRoot& root,
                     const RowScale& mass) {
  constexpr int k_down = lanes::k_velocity_bits - k_row_unit_bits;
  BodyVector u{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = mass.times(row.velocity[i], k_down);
    ProductSum turn;
    for (std::size_t k = i; k < 3; ++k)
      turn.add(root.c[k][i], row.spin[k]);
    u[3 + i] = mass.times(turn.rounded(30 - root.shift), k_down);
  }
  return u;
}

// How bodies move now, as all rows see it.
void find_motions(const ContactRun& run, const IslandView& island) {
  const std::span<BodyVector> motions = island.changes;
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    const std::uint32_t body = island.bodies[k];
    motions[k] = motion_of(run.rows[body], island.roots[k],
                           mass_scale(island.state.unit, run.bodies[body].inverse_mass));
  }
  motions[island.bodies.size()] = {};
}

// The speed of a contact's row by the motion of the bodies that impulses move.
std::int64_t speed_of(const IslandView& island, const lanes::ProximalBlock& problem,
                      std::size_t row) {
  LKS_ASSERT(row < problem.rows);
  const std::span<const BodyVector> motions = island.changes;
  const BodyVector &a = motions[problem.a], &b = motions[problem.b];
  ProductSum sum;
  for (std::size_t i = 0; i < lanes::k_body_words; ++i) {
    sum.add(low_word(problem.by_row[row][i]), a[i]);
    sum.add(high_word(problem.by_row[row][i]), b[i]);
  }
  return sum.rounded(30);
}

}  // namespace

void set_drives(const ContactRun& run, int substeps, ProximalContact& contact,
                lanes::ProximalBlock& problem) {
  LKS_ASSERT(substeps >= 1 && contact.points <= contact.rows);
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  if (block.is_plain(lane)) return;
  const std::int64_t drives[] = {low_word(block.drive[lane]) * (std::int64_t{1} << 30),
                                 high_word(block.drive[lane]) * (std::int64_t{1} << 30),
                                 low_word(block.turn[lane]) * contact.radius};
  for (std::size_t i = contact.points; i < contact.rows; ++i) {
    problem.bias[i] =
        contact.all[i].to_speed.times(drives[i - contact.points], 50 - k_row_unit_bits);
  }
  for (std::size_t i = 0; i < 2 && contact.rows > contact.points; ++i) {
    const RawVec3& along = i == 0 ? contact.tangent : contact.binormal;
    ProductSum gain;
    for (std::size_t k = 0; k < 3; ++k)
      gain.add(along[k], contact.arc[k]);
    std::int64_t& bias = problem.bias[contact.points + i];
    contact.bias_gain[i] =
        contact.all[contact.points + i].to_speed.times(gain.rounded(1), 49 - k_row_unit_bits);
    bias -= raw::round_divide(contact.bias_gain[i] * (substeps - 1), 2);
  }
}

void measure_speeds(const ContactRun& run, const PreparedRows& prepared,
                    const ProximalContact& contact, lanes::ProximalBlock& problem) {
  LKS_ASSERT(contact.points <= contact.rows && contact.rows <= k_contact_rows);
  Motion start, gained;
  const auto add_side = [&](std::uint32_t index, std::uint32_t body, RawVec3& spin,
                            RawVec3& gained_spin, std::int64_t sign) {
    const BodyVelocity& row = run.rows[index];
    for (std::size_t k = 0; k < 3; ++k) {
      start.along[k] += sign * row.velocity[k];
      spin[k] = row.spin[k];
      if (body == 0) continue;
      const SolverBody& constants = run.bodies[body];
      gained.along[k] += sign * constants.gain[k] * k_to_row;
      gained_spin[k] = constants.spin_gain[k] * k_to_row;
    }
  };
  add_side(contact.row_a, contact.a, start.spin_a, gained.spin_a, -1);
  add_side(contact.row_b, contact.b, start.spin_b, gained.spin_b, 1);
  const RawVec3* linear[k_contact_rows] = {};
  std::fill_n(linear, contact.points, &contact.normal);
  if (contact.rows > contact.points) {
    linear[contact.points] = &contact.tangent;
    linear[contact.points + 1] = &contact.binormal;
  }
  for (std::size_t i = 0; i < contact.rows; ++i) {
    const ProximalRow& row = contact.all[i];
    const auto read = [&](const Motion& motion) {
      const std::int64_t speed =
          speed_along(linear[i], prepared.response_a[i], prepared.response_b[i], motion);
      return within_row(row.to_speed.times(speed, 50 - k_row_unit_bits));
    };
    problem.moved[i] = read(start);
    problem.moving[i] = within_row(problem.moved[i] + read(gained));
  }
}

// The rest of the rows' speeds, which kinematic bodies give them.
void begin_measuring(const ContactRun& run, const IslandView& island) {
  find_motions(run, island);
  for (std::size_t i = 0; i < island.contacts.size(); ++i) {
    ProximalContact& contact = island.contacts[i];
    const lanes::ProximalBlock& problem = island.problems[i];
    for (std::size_t r = 0; r < contact.rows; ++r)
      contact.all[r].carried = within_row(problem.moved[r] - speed_of(island, problem, r));
  }
}

void measure_again(const ContactRun& run, const IslandView& island) {
  find_motions(run, island);
  for (std::size_t i = 0; i < island.contacts.size(); ++i) {
    const ProximalContact& contact = island.contacts[i];
    lanes::ProximalBlock& problem = island.problems[i];
    for (std::size_t r = 0; r < contact.rows; ++r)
      problem.moving[r] = within_row(contact.all[r].carried + speed_of(island, problem, r));
  }
}

}  // namespace lockstone
