// Responses of the rows of joints to each other, and how velocities are read and pushed.

#include <algorithm>
#include <bit>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/product_sum.h"
#include "core/math/reciprocal.h"

namespace lockstone {
namespace {

using lanes::RowBody;

// 1/x of a response in Q30, to multiply a velocity with.
void set_inverse(std::int64_t response, std::int64_t& mantissa, int& shift) {
  mantissa = 0;
  shift = 1;
  if (response < 16) return;
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(response));
  mantissa =
      static_cast<std::int64_t>(reciprocal_q124(static_cast<std::uint64_t>(response) << zeros));
  shift = 60 + 64 - zeros - 30;
}

// response · inverse mass · 2^-shift, at most 2^-1
std::int64_t scaled_response(std::int64_t response, const BodyRecord& body, int shift) {
  if (shift >= 2 && shift <= 62 && magnitude(response) >> 32 == 0)
    return raw::round_shift_any(response * body.inverse_mass, shift);
  return product_rounded(response, body.inverse_mass, std::max(shift, 1));
}

void add_velocity(RowBody& body, const RawVec3& velocity, const RawVec3& spin) {
  const auto gained = [](std::int64_t x, std::int64_t by) {
    return bounded(bounded(x, k_row_bound) + bounded(by, 2 * k_row_bound), k_row_bound);
  };
  // Offset by the bound, a value out of bounds has bit 62 or 63 set.
  const auto excess = [](std::int64_t x) {
    return static_cast<std::uint64_t>(x) + static_cast<std::uint64_t>(k_row_bound);
  };
  RowBody next = body;
  std::uint64_t beyond = 0;
  const auto sum = [](std::int64_t x, std::int64_t by) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(x) +
                                     static_cast<std::uint64_t>(by));
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    next.velocity[axis] = sum(body.velocity[axis], velocity[axis]);
    next.spin[axis] = sum(body.spin[axis], spin[axis]);
    beyond |= excess(body.velocity[axis]) | excess(next.velocity[axis]);
    beyond |= excess(body.spin[axis]) | excess(next.spin[axis]);
  }
  for (std::size_t axis = 0; axis < 3 && beyond >> 62 != 0; ++axis) {
    next.velocity[axis] = gained(body.velocity[axis], velocity[axis]);
    next.spin[axis] = gained(body.spin[axis], spin[axis]);
  }
  body = next;
}

// The change between velocities held within bounds; contacts may push velocities out of them.
std::int64_t gain(std::int64_t before, std::int64_t after) {
  return bounded(after, k_row_bound) - bounded(before, k_row_bound);
}

std::int64_t self_response(const RawVec3& linear, const RawVec3& angular, const RawVec3& response) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(linear[i], linear[i]);
    sum.add(angular[i], response[i]);
  }
  return sum.rounded(30);
}

// A digit for each row: its axis, and whether it is a lock, a limit or a drive.
std::uint64_t row_list(const JointRows& rows) {
  std::uint64_t list = 1;
  for (const JointRow& row : rows.rows.first(rows.count))
    list = list << 5 | static_cast<std::uint64_t>(row.kind) << 3 | row.axis;
  return list;
}

// The Jacobians of one side of a row.
struct SideA {
  static const RawVec3& linear(const JointRow& row) { return row.linear_a; }
  static const RawVec3& angular(const JointRow& row) { return row.angular_a; }
};
struct SideB {
  static const RawVec3& linear(const JointRow& row) { return row.linear_b; }
  static const RawVec3& angular(const JointRow& row) { return row.angular_b; }
};

using Jumps = JointSolver::RowImpulses;

struct RowRange {
  std::size_t first, end;
};

// Jumps of the rows of a joint that locks the axes of the world: of the first three, row i is along
// axis i, and its lever is across; others turn the bodies alone.
template <class Side>
void add_point(Side side, std::span<const JointRow> rows, const Jumps& jumps, std::size_t end,
               RawVec3& velocity, RawVec3& spin) {
  const RawVec3 &x = side.angular(rows[0]), &y = side.angular(rows[1]), &z = side.angular(rows[2]);
  ProductSum about_x, about_y, about_z;
  about_x.add(y[0], jumps[1]), about_x.add(z[0], jumps[2]);
  about_y.add(z[1], jumps[2]), about_y.add(x[1], jumps[0]);
  about_z.add(x[2], jumps[0]), about_z.add(y[2], jumps[1]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t along = side.linear(rows[i])[i];  // 1, −1 or held
    velocity[i] = along == 0 ? 0 : along < 0 ? -jumps[i] : jumps[i];
  }
  for (std::size_t r = 3; r < end; ++r) {
    if (jumps[r] == 0) continue;
    const RawVec3& axis = side.angular(rows[r]);
    about_x.add(axis[0], jumps[r]);
    about_y.add(axis[1], jumps[r]);
    about_z.add(axis[2], jumps[r]);
  }
  spin = {about_x.rounded(30), about_y.rounded(30), about_z.rounded(30)};
}

template <class Side>
void add_rows(Side side, std::span<const JointRow> rows, const Jumps& jumps, const RowRange& range,
              RawVec3& velocity, RawVec3& spin) {
  std::array<ProductSum, 3> along, about;
  for (std::size_t r = range.first; r < range.end; ++r) {
    if (jumps[r] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (rows[r].axis < 3) along[axis].add(side.linear(rows[r])[axis], jumps[r]);
      about[axis].add(side.angular(rows[r])[axis], jumps[r]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    velocity[axis] = along[axis].rounded(30);
    spin[axis] = about[axis].rounded(30);
  }
}

}  // namespace

JointPlace JointSolver::place_of(const Joint& joint, const JointPose& a, const JointPose& b) const {
  return {*joint.record,
          joint.frames,
          a,
          b,
          bodies_[joint.a].scale,
          bodies_[joint.b].scale,
          joint.exponent,
          joint.far,
          joint.holds_a_point};
}

// Rows where the bodies are now.
void JointSolver::linearize(Joint& joint) const {
  fill_rows(place_of(joint, bodies_[joint.a].pose, bodies_[joint.b].pose), RowParts::all,
            joint.rows);
  respond(joint, joint.rows.count, false);
  const std::int64_t most = raw::round_divide(k_close_way, step_.substep_rate());
  for (std::size_t r = 0; r < joint.rows.locks; ++r) {
    const std::int64_t open = joint.rows.rows[r].error;
    joint.left_open[r] = open - bounded(open, most);
  }
}

void JointSolver::linearize(const Cluster& cluster) {
  for (Joint& joint : joints_of(cluster))
    linearize(joint);
  for (Group& group : groups_of(cluster)) {
    group.is_fresh = false;
    group.is_factored = group.is_factored && group.exact;
  }
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
    hold(a, row.linear_a);
    hold(b, row.linear_b);
    row.response_a = response_of(inertia_a, row.angular_a);
    row.response_b = response_of(inertia_b, row.angular_b);
    if (row.kind == RowKind::lock) continue;  // solved by the factor
    std::int64_t response = 0;
    const auto add_side = [&](const Body& body, const Share& share, std::int64_t self) {
      if (body.pushed) response += product_rounded(self, share.mantissa, share.shift);
    };
    add_side(a, joint.share_a, self_response(row.linear_a, row.angular_a, row.response_a));
    add_side(b, joint.share_b, self_response(row.linear_b, row.angular_b, row.response_b));
    Solved& solved = joint.solved[i];
    set_inverse(std::min(response, k_product_bound), solved.inverse, solved.shift);
  }
}

// The powers of two that scale the locks in a factor.
void JointSolver::scale_locks(Joint& joint) const {
  for (std::size_t r = 0; r < joint.rows.locks; ++r) {
    const JointRow& row = joint.rows.rows[r];
    int most = -250;  // below all: a byte holds half of it
    const auto add_side = [&](const Body& body, std::int64_t self) {
      if (!body.pushed) return;
      const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
      most = std::max(most, width + 1 + body.record->inverse_mass_exponent);
    };
    add_side(bodies_[joint.a], self_response(row.linear_a, row.angular_a, row.response_a));
    add_side(bodies_[joint.b], self_response(row.linear_b, row.angular_b, row.response_b));
    joint.scales[r] = static_cast<std::int8_t>((most + 2) >> 1);
  }
}

// The responses of the locks of p to impulses on those of q, through the bodies that both hold.
void JointSolver::fill_block(const Joint& p, const Joint& q, std::int64_t* block) const {
  std::fill_n(block, p.rows.locks * q.rows.locks, 0);
  if (p.a == q.a) add_shared(p, true, q, true, block);
  if (p.a == q.b) add_shared(p, true, q, false, block);
  if (p.b == q.a) add_shared(p, false, q, true, block);
  if (p.b == q.b) add_shared(p, false, q, false, block);
  for (std::size_t i = 0; i < p.rows.locks * q.rows.locks; ++i)
    block[i] = bounded(block[i], std::int64_t{1} << k_matrix_bits);
}

void JointSolver::add_shared(const Joint& p, bool a_of_p, const Joint& q, bool a_of_q,
                             std::int64_t* block) const {
  const Body& shared = bodies_[a_of_p ? p.a : p.b];
  if (!shared.pushed) return;
  const auto linear_x = a_of_p ? &JointRow::linear_a : &JointRow::linear_b;
  const auto linear_y = a_of_q ? &JointRow::linear_a : &JointRow::linear_b;
  const auto angular_x = a_of_p ? &JointRow::angular_a : &JointRow::angular_b;
  const auto response_y = a_of_q ? &JointRow::response_a : &JointRow::response_b;
  const std::size_t columns = q.rows.locks;
  const int excess = 30 - k_matrix_bits - shared.record->inverse_mass_exponent;
  const auto add = [&](std::size_t r, std::size_t s, const ProductSum& sum) {
    const int shift = p.scales[r] + q.scales[s] + excess;
    if (shift > 120) return;
    block[r * columns + s] += scaled_response(sum.rounded(30), *shared.record, shift);
  };
  const bool is_diagonal = &p == &q;
  const bool are_points = p.rows.is_point && q.rows.is_point;
  if (are_points && p.rows.locks == 3 && columns == 3) {  // row i along axis i, its lever across
    for (std::size_t r = 0; r < 3; ++r) {
      const RawVec3& lever = p.rows.rows[r].*angular_x;
      const std::size_t j = (r + 1) % 3, k = (r + 2) % 3;
      for (std::size_t s = 0; s < (is_diagonal ? r + 1 : 3); ++s) {
        const RawVec3& response = q.rows.rows[s].*response_y;
        ProductSum sum;
        sum.add(lever[j], response[j]);
        sum.add(lever[k], response[k]);
        if (r == s) sum.add((p.rows.rows[r].*linear_x)[r], (q.rows.rows[r].*linear_y)[r]);
        add(r, s, sum);
      }
    }
    return;
  }
  for (std::size_t r = 0; r < p.rows.locks; ++r) {
    const JointRow& x = p.rows.rows[r];
    for (std::size_t s = 0; s < (is_diagonal ? r + 1 : columns); ++s) {
      const JointRow& y = q.rows.rows[s];
      ProductSum sum;
      for (std::size_t i = 0; i < 3; ++i) {
        sum.add((x.*linear_x)[i], (y.*linear_y)[i]);
        sum.add((x.*angular_x)[i], (y.*response_y)[i]);
      }
      add(r, s, sum);
    }
  }
}

void JointSolver::factor_group(Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<const std::uint32_t> joints = joints_of(group);
  group.exponent = 1000;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints[k]];
    columns[k].count = static_cast<std::uint32_t>(joint.rows.locks);
    scale_locks(joint);
    for (std::size_t r = 0; r < joint.rows.locks; ++r)
      group.exponent = std::min<int>(group.exponent, joint.scales[r]);
  }
  factor_.fill_blocks(group.column, group.count,
                      [&](std::uint32_t j, std::uint32_t k, std::int64_t* block) {
                        fill_block(joints_[joints[j]], joints_[joints[k]], block);
                      });
  clamps_ += factor_.factor(group.column, group.count);
}

// Whether the group has a factor for the rows that it has now, as they were at some time.
bool JointSolver::has_factor(const Group& group) const {
  return group.is_factored && std::ranges::all_of(joints_of(group), [this](std::uint32_t index) {
           return joints_[index].factored == row_list(joints_[index].rows);
         });
}

void JointSolver::factor(const JointRun& run, Group& group, bool ahead) {
  if (has_solved_loops(group)) {
    (void)mark_left_out(run, group);
    factor_loops(group, ahead);
  } else {
    factor_group(group);
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].factored = row_list(joints_[index].rows);
  group.is_factored = group.is_fresh = true;
}

// The relative velocity that a row sees, Q50.
std::int64_t JointSolver::speed(const JointRun& run, const Joint& joint,
                                const JointRow& row) const {
  const RowBody& a = run.rows[bodies_[joint.a].solver];
  const RowBody& b = run.rows[bodies_[joint.b].solver];
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(row.response_a[i], a.spin[i]);
    sum.add(row.response_b[i], b.spin[i]);
  }
  if (joint.rows.is_point && row.axis < 3) {
    sum.add(row.linear_a[row.axis], a.velocity[row.axis]);
    sum.add(row.linear_b[row.axis], b.velocity[row.axis]);
  } else if (row.axis < 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum.add(row.linear_a[i], a.velocity[i]);
      sum.add(row.linear_b[i], b.velocity[i]);
    }
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

// The changes of velocity by joints in a stage are also added to the velocities at the substep's
// beginning: else the next substep would take them for impulses of contacts, and repeat them.
void JointSolver::begin_pushes(const JointRun& run, const Cluster& cluster) {
  for (const std::uint32_t body : bodies_of(cluster))
    bodies_[body].unpushed = run.rows[bodies_[body].solver];
}

void JointSolver::end_pushes(const JointRun& run, std::span<const std::uint32_t> bodies) {
  if (run.before.empty()) return;
  for (const std::uint32_t index : bodies) {
    const Body& body = bodies_[index];
    if (!body.pushed) continue;
    const RowBody& row = run.rows[body.solver];
    RawVec3 velocity, spin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      velocity[axis] = gain(body.unpushed.velocity[axis], row.velocity[axis]);
      spin[axis] = gain(body.unpushed.spin[axis], row.spin[axis]);
    }
    add_velocity(run.before[body.solver], velocity, spin);
  }
}

void JointSolver::push(const JointRun& run, const Joint& joint, std::size_t first, std::size_t end,
                       const RowImpulses& impulses) {
  const auto push_side = [&](std::uint32_t index, const Share& share, auto side) {
    if (share.mantissa == 0) return;
    RowImpulses jumps;  // of the body's own velocity
    for (std::size_t r = first; r < end; ++r)
      jumps[r] = product_rounded(impulses[r], share.mantissa, share.shift);
    RawVec3 velocity{}, spin;
    if (joint.rows.is_point && first == 0 && end >= 3)
      add_point(side, joint.rows.rows, jumps, end, velocity, spin);
    else
      add_rows(side, joint.rows.rows, jumps, {first, end}, velocity, spin);
    add_velocity(run.rows[bodies_[index].solver], velocity, spin);
  };
  push_side(joint.a, joint.share_a, SideA{});
  push_side(joint.b, joint.share_b, SideB{});
}

}  // namespace lockstone
