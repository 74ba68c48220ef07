// What the rows of joints feel of each other, and how velocities are read and pushed.

#include <algorithm>
#include <bit>

#include "core/dynamics/joint_numbers.h"
#include "core/dynamics/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

using lanes::RowBody;

// 1/x of a response in Q30, to multiply a velocity with.
void set_inverse(std::int64_t response, std::int64_t& mantissa, int& shift) {
  mantissa = 0;
  shift = 1;
  if (response < 16) return;
  const int power = 60 + static_cast<int>(std::bit_width(static_cast<std::uint64_t>(response)));
  const std::uint64_t quotient =
      round_divide(UInt128{0, 1} << power, static_cast<std::uint64_t>(response));
  mantissa = static_cast<std::int64_t>(quotient);
  shift = power - 30;
}

std::int64_t self_response(const RawVec3& linear, const RawVec3& angular, const RawVec3& response) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(linear[i], linear[i]);
    sum.add(angular[i], response[i]);
  }
  return sum.rounded(30);
}

}  // namespace

JointPlace JointSolver::place_of(const Joint& joint, const JointPose& a, const JointPose& b) const {
  return {*joint.record,
          a,
          b,
          bodies_[joint.a].record->scale_exponent,
          bodies_[joint.b].record->scale_exponent,
          joint.exponent};
}

// Rows and factors where the bodies are now.
void JointSolver::linearize(const Cluster& cluster) {
  for (Joint& joint : joints_of(cluster)) {
    fill_rows(place_of(joint, bodies_[joint.a].pose, bodies_[joint.b].pose), RowParts::all,
              joint.rows);
    respond(joint, joint.rows.count, false);
  }
  for (Group& group : groups_of(cluster))
    factor_group(group);
}

// Along an axis that is locked a body neither moves nor answers.
void JointSolver::hold(const Body& body, RawVec3& linear) {
  if (!body.pushed || (body.record->locks & k_lock_moving) == 0) return;
  for (int axis = 0; axis < 3; ++axis)
    if (body.record->is_locked(axis)) linear[static_cast<std::size_t>(axis)] = 0;
}

void JointSolver::respond(Joint& joint, std::size_t rows, bool ahead) const {
  const Body& a = bodies_[joint.a];
  const Body& b = bodies_[joint.b];
  const InverseInertia& inertia_a = ahead ? a.inertia_ahead : a.inverse_inertia;
  const InverseInertia& inertia_b = ahead ? b.inertia_ahead : b.inverse_inertia;
  for (std::size_t i = 0; i < rows; ++i) {
    JointRow& row = joint.rows.rows[i];
    Solved& solved = joint.solved[i];
    hold(a, row.linear_a);
    hold(b, row.linear_b);
    row.response_a = response_of(inertia_a, row.angular_a);
    row.response_b = response_of(inertia_b, row.angular_b);
    std::int64_t response = 0;
    int most = -1000;
    const auto add_side = [&](const Body& body, const Share& share, std::int64_t self) {
      if (!body.pushed) return;
      response += product_rounded(self, share.mantissa, share.shift);
      const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
      most = std::max(most, width + 1 + body.record->inverse_mass_exponent);
    };
    add_side(a, joint.share_a, self_response(row.linear_a, row.angular_a, row.response_a));
    add_side(b, joint.share_b, self_response(row.linear_b, row.angular_b, row.response_b));
    set_inverse(std::min(response, k_product_bound), solved.inverse, solved.shift);
    solved.exponent = (most + 2) >> 1;
  }
}

// What row r of p feels of an impulse on row s of q, through the bodies that both hold.
std::int64_t JointSolver::entry(const Joint& p, std::size_t r, const Joint& q,
                                std::size_t s) const {
  const JointRow& x = p.rows.rows[r];
  const JointRow& y = q.rows.rows[s];
  const int exponent = p.solved[r].exponent + q.solved[s].exponent;
  std::int64_t total = 0;
  const auto through = [&](std::uint32_t body, bool a_of_p, bool a_of_q) {
    const Body& shared = bodies_[body];
    if (!shared.pushed) return;
    const RawVec3& linear_x = a_of_p ? x.linear_a : x.linear_b;
    const RawVec3& linear_y = a_of_q ? y.linear_a : y.linear_b;
    const RawVec3& angular_x = a_of_p ? x.angular_a : x.angular_b;
    const RawVec3& response_y = a_of_q ? y.response_a : y.response_b;
    ProductSum sum;
    for (std::size_t i = 0; i < 3; ++i) {
      sum.add(linear_x[i], linear_y[i]);
      sum.add(angular_x[i], response_y[i]);
    }
    const int shift = exponent - shared.record->inverse_mass_exponent + 30 - k_matrix_bits;
    if (shift > 120) return;
    total += product_rounded(sum.rounded(30), shared.record->inverse_mass, std::max(shift, 1));
  };
  if (p.a == q.a) through(p.a, true, true);
  if (p.a == q.b) through(p.a, true, false);
  if (p.b == q.a) through(p.b, false, true);
  if (p.b == q.b) through(p.b, false, false);
  return bounded(total, std::int64_t{1} << k_matrix_bits);
}

void JointSolver::factor_group(Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<const std::uint32_t> joints = joints_of(group);
  group.exponent = 1000;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints[k]];
    columns[k].count = static_cast<std::uint32_t>(joint.rows.locks);
    for (std::size_t r = 0; r < joint.rows.locks; ++r)
      group.exponent = std::min(group.exponent, joint.solved[r].exponent);
  }
  factor_.fill(group.column, group.count,
               [&](std::uint32_t j, std::uint32_t r, std::uint32_t k, std::uint32_t s) {
                 return entry(joints_[joints[j]], r, joints_[joints[k]], s);
               });
  clamps_ += factor_.factor(group.column, group.count);
}

// The relative velocity that a row sees, Q50.
std::int64_t JointSolver::speed(const JointRun& run, const Joint& joint,
                                const JointRow& row) const {
  const RowBody& a = run.rows[bodies_[joint.a].solver];
  const RowBody& b = run.rows[bodies_[joint.b].solver];
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(row.linear_a[i], a.velocity[i]);
    sum.add(row.response_a[i], a.spin[i]);
    sum.add(row.linear_b[i], b.velocity[i]);
    sum.add(row.response_b[i], b.spin[i]);
  }
  return bounded(sum.rounded(30), k_row_bound);
}

void JointSolver::push(const JointRun& run, const Joint& joint, std::size_t row,
                       std::int64_t impulse) {
  if (impulse == 0) return;
  RowImpulses impulses;
  impulses[row] = impulse;
  push(run, joint, row, row + 1, impulses);
}

// Joint impulses go to the velocities at the substep's beginning as well: the next one must not
// take them for those of contacts, which start it again.
void JointSolver::push(const JointRun& run, const Joint& joint, std::size_t first, std::size_t end,
                       const RowImpulses& impulses) {
  const auto push_side = [&](std::uint32_t index, const Share& share, auto linear, auto angular) {
    if (share.mantissa == 0) return;
    std::array<ProductSum, 3> velocity, spin;
    const auto jump = [&](std::size_t r) {
      return product_rounded(impulses[r], share.mantissa, share.shift);
    };
    std::size_t r = first;
    if (joint.rows.is_point && first == 0 && end >= 3) {  // row i along axis i, its levers across
      const auto& rows = joint.rows.rows;
      const RawVec3 jumps = {jump(0), jump(1), jump(2)};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        velocity[i].add((rows[i].*linear)[i], jumps[i]);
        spin[i].add((rows[j].*angular)[i], jumps[j]);
        spin[i].add((rows[k].*angular)[i], jumps[k]);
      }
      r = 3;
    }
    for (; r < end; ++r) {
      const JointRow& row = joint.rows.rows[r];
      const std::int64_t each = jump(r);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        velocity[axis].add((row.*linear)[axis], each);
        spin[axis].add((row.*angular)[axis], each);
      }
    }
    const std::uint32_t solver = bodies_[index].solver;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t v = velocity[axis].rounded(30), w = spin[axis].rounded(30);
      const auto gain = [&](std::int64_t& x, std::int64_t by) {
        x = bounded(bounded(x, k_row_bound) + by, k_row_bound);
      };
      gain(run.rows[solver].velocity[axis], v);
      gain(run.rows[solver].spin[axis], w);
      if (run.before.empty()) continue;
      gain(run.before[solver].velocity[axis], v);
      gain(run.before[solver].spin[axis], w);
    }
  };
  push_side(joint.a, joint.share_a, &JointRow::linear_a, &JointRow::angular_a);
  push_side(joint.b, joint.share_b, &JointRow::linear_b, &JointRow::angular_b);
}

}  // namespace lockstone
