// The normal rows of contacts, solved at once.

#include <algorithm>

#include "core/dynamics/direct_words.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::k_block_points;
using lanes::ManifoldBlock;
using lanes::RowBody;

// What would pull is let go, and the rest solved again, so many times; then it is left to sweeps.
constexpr int k_most_rounds = 6;

// Where friction carries, what has just been put there begins to close one after another.
constexpr int k_most_leaning_rounds = 24;

// Of a group in which no point pushes.
constexpr int k_no_exponent = 1000;

}  // namespace

// How fast B goes along a row against A, Q50.
std::int64_t DirectContacts::read_row(const ContactRun& run, const Contact& contact,
                                      const ContactRow& row) {
  return read_turning(run, contact, row, read_linear(run, contact, row.linear));
}

// What both bodies' velocities add to it, Q80, and their spins.
ProductSum DirectContacts::read_linear(const ContactRun& run, const Contact& contact,
                                       const RawVec3& linear) {
  ProductSum sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum.add(linear[axis], run.rows[contact.row_b].velocity[axis]);
    sum.subtract(linear[axis], run.rows[contact.row_a].velocity[axis]);
  }
  return sum;
}

std::int64_t DirectContacts::read_turning(const ContactRun& run, const Contact& contact,
                                          const ContactRow& row, ProductSum sum) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum.add(row.response_b[axis], run.rows[contact.row_b].spin[axis]);
    sum.subtract(row.response_a[axis], run.rows[contact.row_a].spin[axis]);
  }
  return sum.rounded(30);
}

// Speeds of points, with what separations ask for.
void DirectContacts::read(const ContactRun& run, Contact& contact, bool pushes_out) const {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  const ProductSum linear = read_linear(run, contact, contact.normal);
  for (std::size_t i = 0; i < contact.count; ++i) {
    PointRow& point = contact.points[i];
    point.change = 0;
    const std::int64_t now = high_word(block.points[i].separation[lane]);
    std::int64_t bias = 0;
    if (now > run.rules.skin) {
      bias = product_rounded(now, std::int64_t{run.rules.substep_rate} << 32, 6);
    } else if (pushes_out) {
      bias = product_rounded(now + run.rules.overlap, low_word(block.soft[lane]) << 32, 26);
      bias = std::max(bias, -(std::int64_t{run.rules.push_out} << 30));
    }
    if (pushes_out) bias += product_rounded(point.impulse, point.own, 12 + k_give_shift);
    point.speed =
        std::clamp(read_turning(run, contact, point, linear) + std::min(bias, k_direct_bound),
                   -k_direct_bound, k_direct_bound);
  }
}

// Points that push, or close.
void DirectContacts::choose_active(Contact& contact) {
  std::uint32_t bits = 0;
  contact.active = 0;
  for (std::uint32_t i = 0; i < contact.count; ++i) {
    const PointRow& point = contact.points[i];
    if (contact.is_barred(i) || (point.impulse <= 0 && point.speed >= 0)) continue;
    bits |= 1U << i;
    contact.order[contact.active++] = static_cast<std::uint8_t>(i);
  }
  contact.active_bits = bits;
  if (contact.active == k_block_points) flatten(contact);
}

// Four speeds as of points in a plane.
void DirectContacts::flatten(Contact& contact) {
  if (contact.warp_size == 0) return;
  ProductSum sum;
  for (const PointRow& point : contact.points)
    sum.add(point.warp, point.speed);
  const std::int64_t warped = std::clamp(sum.rounded(30), -k_direct_bound / 2, k_direct_bound / 2);
  const bool is_small = magnitude(warped) < std::uint64_t{1} << 32;
  for (PointRow& point : contact.points) {
    const std::int64_t part =
        is_small ? raw::round_divide(warped * point.warp, contact.warp_size)
                 : round_divide(multiply_wide(warped, point.warp), contact.warp_size);
    point.speed = std::clamp(point.speed - part, -k_direct_bound, k_direct_bound);
  }
}

// The bodies that p and q share, and which of its sides each is.
DirectContacts::Shares DirectContacts::shares_of(const ContactRun& run, const Contact& p,
                                                 const Contact& q) {
  Shares shares;
  const auto add_body = [&](std::uint32_t body, bool a_of_p, bool a_of_q) {
    shares.all[shares.count++] = {run.bodies[body].inverse_mass, a_of_p, a_of_q};
  };
  if (p.a != 0 && p.a == q.a) add_body(p.a, true, true);
  if (p.a != 0 && p.a == q.b) add_body(p.a, true, false);
  if (p.b != 0 && p.b == q.a) add_body(p.b, false, true);
  if (p.b != 0 && p.b == q.b) add_body(p.b, false, false);
  return shares;
}

// Adds what the rows of p feel of impulses along those of q through a body, Q56, row by row; of p
// itself as far as the diagonal.
void DirectContacts::add_share(const Share& share, const Rows& p, const Rows& q, std::int64_t* to) {
  const ProductSum along = dot_sum(p.all[0]->linear, q.all[0]->linear);
  const int more = 30 - k_matrix_bits - share.inverse_mass.exponent;
  const std::int32_t mass = share.inverse_mass.mantissa;
  for (std::uint32_t r = 0; r < p.count; ++r, to += q.count) {
    const ContactRow& x = *p.all[r];
    const RawVec3& angular = share.a_of_p ? x.angular_a : x.angular_b;
    for (std::uint32_t s = 0; s < (&p == &q ? r + 1 : q.count); ++s) {
      const ContactRow& y = *q.all[s];
      const RawVec3& response = share.a_of_q ? y.response_a : y.response_b;
      const bool are_normal = r < p.normals && s < q.normals;
      ProductSum sum = are_normal ? along : dot_sum(x.linear, y.linear);
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum.add(angular[axis], response[axis]);
      const int shift = x.exponent + y.exponent + more;
      if (shift > 120) continue;
      const std::int64_t felt = scaled(sum.rounded(30), mass, std::max(shift, 1));
      to[s] += share.a_of_p == share.a_of_q ? felt : -felt;
    }
  }
}

// The same through all bodies that they share.
void DirectContacts::fill_block(const ContactRun& run, const Contact& p, const Contact& q,
                                std::int64_t* to) const {
  constexpr std::int64_t k_most = std::int64_t{1} << k_matrix_bits;
  const Rows x = all_rows_of(p), y = &p == &q ? Rows{} : all_rows_of(q);
  const Rows& columns = &p == &q ? x : y;
  const std::span<std::int64_t> all(to, std::size_t{x.count} * columns.count);
  std::ranges::fill(all, 0);
  if (all.empty()) return;
  const Shares shares = shares_of(run, p, q);
  for (std::uint32_t i = 0; i < shares.count; ++i)
    add_share(shares.all[i], x, columns, to);
  for (std::int64_t& value : all)
    value = std::clamp(value, -k_most, k_most);
  if (&p != &q) return;
  for (std::uint32_t r = 0; r < x.count; ++r)
    to[r * x.count + r] += to[r * x.count + r] >> k_give_shift;
}

DirectContacts::Rows DirectContacts::all_rows_of(const Contact& contact) const {
  Rows rows;
  rows.count = rows_of(contact);
  rows.normals = contact.active;
  for (std::uint32_t r = 0; r < rows.count; ++r)
    rows.all[r] = &row_of(contact, r);
  return rows;
}

// Answers whether other rows stand in the factors.
bool DirectContacts::note_rows(const Group& group) {
  bool changed = false;
  for (Contact& contact : contacts_of(group)) {
    const std::uint32_t tied = is_tied(contact) ? 1U << k_block_points : 0;
    const auto rows = static_cast<std::uint8_t>(contact.active_bits | tied);
    changed = changed || rows != contact.factored[group.which()];
    contact.factored[group.which()] = rows;
  }
  return changed;
}

void DirectContacts::factor(const ContactRun& run, Group& group) {
  const std::span<JointFactor::Column> columns = columns_of(group);
  const std::span<Contact> contacts = contacts_of(group);
  int& exponent = group.exponents[group.which()];
  exponent = k_no_exponent;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    columns[k].count = rows_of(contacts[k]);
    for (std::uint32_t r = 0; r < columns[k].count; ++r)
      exponent = std::min(exponent, row_of(contacts[k], r).exponent);
  }
  JointFactor& factors = factors_[group.which()];
  const std::uint32_t column = group.columns[group.which()];
  factors.fill_blocks(column, group.count, [&](std::uint32_t j, std::uint32_t k, std::int64_t* to) {
    fill_block(run, contacts[j], contacts[k], to);
  });
  (void)factors.factor(column, group.count);
}

void DirectContacts::solve(const ContactRun& run, bool pushes_out) {
  for (Group& group : groups_)
    solve_group(run, group, pushes_out);
}

// Whether no body of the group moves by more than what need not be solved.
bool DirectContacts::is_still(const ContactRun& run, const Group& group) const {
  const auto slow = [](std::int64_t v) { return v >= -k_direct_slow && v <= k_direct_slow; };
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const RowBody& row = run.rows[bodies_[group.first_body + i]];
    if (!std::ranges::all_of(row.velocity, slow) || !std::ranges::all_of(row.spin, slow))
      return false;
  }
  return true;
}

void DirectContacts::solve_group(const ContactRun& run, Group& group, bool pushes_out) {
  const bool is_first = !group.is_filled;
  if (group.is_left || (!is_first && is_still(run, group))) return;
  if (is_first) {
    for (Contact& contact : contacts_of(group)) {
      find_rows(run, contact);
      if (group.leans) tie(run, contact);
    }
    group.is_filled = true;
  }
  for (Contact& contact : contacts_of(group))
    contact.barred_bits = 0;
  // What cannot give way, for friction holds it, is not pushed out; but what has just been put
  // there would slide away.
  if (group.leans) hold_ties(group, !pushes_out || (is_first && group.is_new));
  const int most = group.leans ? k_most_leaning_rounds : k_most_rounds;
  for (int round = 1; round <= most && !group.is_left; ++round)
    if (try_once(run, group, pushes_out, round == most)) return;
  leave(run, group, pushes_out);
}

// Whether no point that pushes moves, and no other closes, by more than what need not be solved.
bool DirectContacts::is_solved(const Group& group) const {
  const auto contact_is = [&](const Contact& contact) {
    for (std::size_t i = 0; i < contact.count; ++i) {
      const std::int64_t speed = contact.points[i].speed;
      if (contact.is_barred(i)) continue;
      if (speed < -k_direct_slow || (speed > k_direct_slow && contact.is_active(i))) return false;
    }
    return is_stuck(contact);
  };
  return std::ranges::all_of(std::span(contacts_).subspan(group.first, group.count), contact_is);
}

// False when points had to be let go, or others may have begun to close.
bool DirectContacts::try_once(const ContactRun& run, Group& group, bool pushes_out, bool is_last) {
  const std::span<JointFactor::Column> columns = columns_of(group);
  const std::span<Contact> contacts = contacts_of(group);
  JointFactor& factors = factors_[group.which()];
  std::uint32_t idle = 0;
  for (Contact& contact : contacts) {
    read(run, contact, pushes_out);
    choose_active(contact);
    if (contact.tie != 0 && !read_tie(run, contact)) release(run, contact);
    idle += contact.count - contact.active;
  }
  if (is_solved(group)) return !group.leans || !release_slipping(run, group);
  if (note_rows(group)) factor(run, group);
  if (group.exponent() == k_no_exponent) return true;  // no point pushes
  for (std::uint32_t k = 0; k < group.count; ++k) {
    for (std::uint32_t r = 0; r < columns[k].count; ++r) {
      const ContactRow& row = row_of(contacts[k], r);
      const int shift = std::min(4 + row.exponent - group.exponent(), 62);
      factors.rhs(columns[k].first_row + r) = raw::round_shift(-row.speed, shift);
    }
  }
  factors.solve(group.columns[group.which()], group.count);
  const bool pulls = find_changes(group);
  if (group.is_left) return false;
  if (!pulls && group.leans && release_slipping(run, group)) return false;
  push_all(run, group, pulls);
  return !pulls && (idle == 0 || is_last);
}

// Answers whether any point would pull. What pushes without end is not believed.
bool DirectContacts::find_changes(Group& group) {
  const std::span<JointFactor::Column> columns = columns_of(group);
  bool pulls = false;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Contact& contact = contacts_of(group)[k];
    for (std::uint32_t r = 0; r < contact.active; ++r) {
      PointRow& point = contact.points[contact.order[r]];
      find_change(group, contact, columns[k].first_row + r, point);
      if (point.impulse + point.change < 0) {
        contact.barred_bits |= 1U << contact.order[r];
        pulls = true;
      }
      if (point.impulse + point.change > group.most) group.is_left = true;
    }
    for (std::uint32_t r = contact.active; r < columns[k].count; ++r)
      find_change(group, contact, columns[k].first_row + r,
                  ties_[contact.tie - 1].rows[r - contact.active]);
  }
  return pulls;
}

void DirectContacts::find_change(const Group& group, const Contact& contact, std::uint32_t rhs,
                                 ContactRow& row) {
  const std::int64_t solved = factors_[group.which()].rhs(rhs);
  const BlockFloat mass = contact.inverse_mass;
  const int shift = 46 + row.exponent + group.exponent() - mass.exponent - k_row_impulse_bits;
  row.change = shift >= 1 && shift <= 125 ? product_rounded(solved, mass.mantissa, shift)
                                          : scale_saturating(solved, mass, -shift - mass.exponent);
  row.change = std::clamp(row.change, -k_direct_bound, k_direct_bound);
}

}  // namespace lockstone
