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
  const RowBody& a = run.rows[contact.row_a];
  const RowBody& b = run.rows[contact.row_b];
  ProductSum sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum.add(row.linear[axis], b.velocity[axis]);
    sum.subtract(row.linear[axis], a.velocity[axis]);
    sum.add(row.response_b[axis], b.spin[axis]);
    sum.subtract(row.response_a[axis], a.spin[axis]);
  }
  return sum.rounded(30);
}

// Speeds of points, with what separations ask for.
void DirectContacts::read(const ContactRun& run, Contact& contact, bool pushes_out) const {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
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
    point.speed = std::clamp(read_row(run, contact, point) + std::min(bias, k_direct_bound),
                             -k_direct_bound, k_direct_bound);
  }
}

// Points that push, or close. Answers whether other ones stand in the factors.
bool DirectContacts::choose_active(Contact& contact) {
  std::uint32_t bits = 0;
  contact.active = 0;
  for (std::uint32_t i = 0; i < contact.count; ++i) {
    const PointRow& point = contact.points[i];
    if (contact.is_barred(i) || (point.impulse <= 0 && point.speed >= 0)) continue;
    bits |= 1U << i;
    contact.order[contact.active++] = static_cast<std::uint8_t>(i);
  }
  const bool changed = bits != contact.active_bits;
  contact.active_bits = bits;
  if (contact.active == k_block_points) flatten(contact);
  return changed;
}

// Four speeds as of points in a plane.
void DirectContacts::flatten(Contact& contact) {
  if (contact.warp_size == 0) return;
  ProductSum sum;
  for (const PointRow& point : contact.points)
    sum.add(point.warp, point.speed);
  const std::int64_t warped = std::clamp(sum.rounded(30), -k_direct_bound / 2, k_direct_bound / 2);
  for (PointRow& point : contact.points)
    point.speed =
        std::clamp(point.speed - round_divide(multiply_wide(warped, point.warp), contact.warp_size),
                   -k_direct_bound, k_direct_bound);
}

// What row x of p feels of an impulse along y of q, through the bodies that both hold; Q56.
std::int64_t DirectContacts::entry(const ContactRun& run, const Contact& p, const ContactRow& x,
                                   const Contact& q, const ContactRow& y) {
  constexpr std::int64_t k_most = std::int64_t{1} << k_matrix_bits;
  std::int64_t total = 0;
  const auto add_body = [&](std::uint32_t body, bool a_of_p, bool a_of_q) {
    const BlockFloat& inverse_mass = run.bodies[body].inverse_mass;
    const std::int64_t sum = coupled(x.linear, y.linear, a_of_p ? x.angular_a : x.angular_b,
                                     a_of_q ? y.response_a : y.response_b, a_of_p != a_of_q);
    const int shift = x.exponent + y.exponent - inverse_mass.exponent + 30 - k_matrix_bits;
    if (shift <= 120) total += product_rounded(sum, inverse_mass.mantissa, std::max(shift, 1));
  };
  if (p.a != 0 && p.a == q.a) add_body(p.a, true, true);
  if (p.a != 0 && p.a == q.b) add_body(p.a, true, false);
  if (p.b != 0 && p.b == q.a) add_body(p.b, false, true);
  if (p.b != 0 && p.b == q.b) add_body(p.b, false, false);
  return std::clamp(total, -k_most, k_most);
}

void DirectContacts::factor(const ContactRun& run, Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<Contact> contacts = contacts_of(group);
  group.exponent = k_no_exponent;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    columns[k].count = rows_of(contacts[k]);
    for (std::uint32_t r = 0; r < columns[k].count; ++r)
      group.exponent = std::min(group.exponent, row_of(contacts[k], r).exponent);
  }
  factor_.fill(group.column, group.count,
               [&](std::uint32_t j, std::uint32_t r, std::uint32_t k, std::uint32_t s) {
                 const Contact &p = contacts[j], &q = contacts[k];
                 const std::int64_t value = entry(run, p, row_of(p, r), q, row_of(q, s));
                 return j == k && r == s ? value + (value >> k_give_shift) : value;
               });
  (void)factor_.factor(group.column, group.count);
  group.is_factored = true;
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
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<Contact> contacts = contacts_of(group);
  std::uint32_t idle = 0;
  for (Contact& contact : contacts) {
    read(run, contact, pushes_out);
    if (choose_active(contact)) group.is_factored = false;
    if (contact.tie != 0 && !read_tie(run, contact)) release(run, contact);
    idle += contact.count - contact.active;
  }
  if (is_solved(group)) return !group.leans || !release_slipping(run, group);
  if (!group.is_factored) factor(run, group);
  if (group.exponent == k_no_exponent) return true;  // no point pushes
  for (std::uint32_t k = 0; k < group.count; ++k) {
    for (std::uint32_t r = 0; r < columns[k].count; ++r) {
      const ContactRow& row = row_of(contacts[k], r);
      const int shift = std::min(4 + row.exponent - group.exponent, 62);
      factor_.rhs(columns[k].first_row + r) = raw::round_shift(-row.speed, shift);
    }
  }
  factor_.solve(group.column, group.count);
  const bool pulls = find_changes(group);
  if (group.is_left) return false;
  if (!pulls && group.leans && release_slipping(run, group)) return false;
  push_all(run, group, pulls);
  return !pulls && (idle == 0 || is_last);
}

// Answers whether any point would pull. What pushes without end is not believed.
bool DirectContacts::find_changes(Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
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
  const int shift = k_row_impulse_bits - 46 - row.exponent - group.exponent;
  row.change =
      std::clamp<std::int64_t>(scale_saturating(factor_.rhs(rhs), contact.inverse_mass, shift),
                               -k_direct_bound, k_direct_bound);
}

}  // namespace lockstone
