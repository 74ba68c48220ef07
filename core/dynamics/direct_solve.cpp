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

// Of a group in which no point pushes.
constexpr int k_no_exponent = 1000;

// What a point's speed and what is asked of it are held within, Q50.
constexpr std::int64_t k_speed_bound = std::int64_t{1} << 60;

// No solving for what is slower, Q50: 3.8 µm/s.
constexpr std::int64_t k_slow = std::int64_t{1} << 32;

}  // namespace

// Speeds, with what separations ask for, and impulses.
void DirectContacts::read(const DirectRun& run, Contact& contact, bool pushes_out) const {
  const ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  const RowBody& a = run.rows[contact.link.row_a];
  const RowBody& b = run.rows[contact.link.row_b];
  for (std::size_t i = 0; i < contact.count; ++i) {
    Point& point = contact.points[i];
    ProductSum sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum.add(contact.normal[axis], b.velocity[axis]);
      sum.subtract(contact.normal[axis], a.velocity[axis]);
      sum.add(point.response_b[axis], b.spin[axis]);
      sum.subtract(point.response_a[axis], a.spin[axis]);
    }
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
        std::clamp(sum.rounded(30) + std::min(bias, k_speed_bound), -k_speed_bound, k_speed_bound);
  }
}

// Points that push, or close. Answers whether other ones stand in the factors.
bool DirectContacts::choose_active(Contact& contact) {
  std::uint32_t bits = 0;
  contact.active = 0;
  for (std::uint32_t i = 0; i < contact.count; ++i) {
    Point& point = contact.points[i];
    point.active = !point.barred && (point.impulse > 0 || point.speed < 0);
    if (!point.active) continue;
    bits |= 1U << i;
    contact.order[contact.active++] = static_cast<std::uint8_t>(i);
  }
  const bool changed = bits != contact.factored;
  contact.factored = bits;
  if (contact.active == k_block_points) flatten(contact);
  return changed;
}

// Four speeds as of points in a plane.
void DirectContacts::flatten(Contact& contact) {
  if (contact.warp_size == 0) return;
  ProductSum sum;
  for (const Point& point : contact.points)
    sum.add(point.warp, point.speed);
  const std::int64_t warped = std::clamp(sum.rounded(30), -k_speed_bound / 2, k_speed_bound / 2);
  for (Point& point : contact.points)
    point.speed =
        std::clamp(point.speed - round_divide(multiply_wide(warped, point.warp), contact.warp_size),
                   -k_speed_bound, k_speed_bound);
}

// What point x of p feels of an impulse at y of q, through the bodies that both hold; Q56.
std::int64_t DirectContacts::entry(const DirectRun& run, const Contact& p, const Point& x,
                                   const Contact& q, const Point& y) {
  constexpr std::int64_t k_most = std::int64_t{1} << k_matrix_bits;
  std::int64_t total = 0;
  const auto add_body = [&](std::uint32_t body, bool a_of_p, bool a_of_q) {
    const BlockFloat& inverse_mass = run.bodies[body].inverse_mass;
    const std::int64_t sum = coupled(p.normal, q.normal, a_of_p ? x.angular_a : x.angular_b,
                                     a_of_q ? y.response_a : y.response_b, a_of_p != a_of_q);
    const int shift = x.exponent + y.exponent - inverse_mass.exponent + 30 - k_matrix_bits;
    if (shift <= 120) total += product_rounded(sum, inverse_mass.mantissa, std::max(shift, 1));
  };
  if (p.link.a != 0 && p.link.a == q.link.a) add_body(p.link.a, true, true);
  if (p.link.a != 0 && p.link.a == q.link.b) add_body(p.link.a, true, false);
  if (p.link.b != 0 && p.link.b == q.link.a) add_body(p.link.b, false, true);
  if (p.link.b != 0 && p.link.b == q.link.b) add_body(p.link.b, false, false);
  return std::clamp(total, -k_most, k_most);
}

void DirectContacts::factor(const DirectRun& run, Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<Contact> contacts = contacts_of(group);
  group.exponent = k_no_exponent;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    columns[k].count = contacts[k].active;
    for (std::uint32_t r = 0; r < contacts[k].active; ++r)
      group.exponent = std::min(group.exponent, contacts[k].points[contacts[k].order[r]].exponent);
  }
  factor_.fill(group.column, group.count,
               [&](std::uint32_t j, std::uint32_t r, std::uint32_t k, std::uint32_t s) {
                 const Contact &p = contacts[j], &q = contacts[k];
                 const std::int64_t value =
                     entry(run, p, p.points[p.order[r]], q, q.points[q.order[s]]);
                 return j == k && r == s ? value + (value >> k_give_shift) : value;
               });
  (void)factor_.factor(group.column, group.count);
  group.is_factored = true;
}

void DirectContacts::solve(const DirectRun& run, bool pushes_out) {
  for (Group& group : groups_)
    solve_group(run, group, pushes_out);
}

// Whether no body of the group moves by more than what need not be solved.
bool DirectContacts::is_still(const DirectRun& run, const Group& group) const {
  const auto slow = [](std::int64_t v) { return v >= -k_slow && v <= k_slow; };
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const RowBody& row = run.rows[bodies_[group.first_body + i]];
    if (!std::ranges::all_of(row.velocity, slow) || !std::ranges::all_of(row.spin, slow))
      return false;
  }
  return true;
}

void DirectContacts::solve_group(const DirectRun& run, Group& group, bool pushes_out) {
  const bool is_first = !group.is_filled;
  if (group.is_left || (!is_first && is_still(run, group))) return;
  if (is_first) {
    for (Contact& contact : contacts_of(group))
      fill(run, contact);
    group.is_filled = true;
  }
  for (Contact& contact : contacts_of(group))
    for (Point& point : contact.points)
      point.barred = false;
  for (int round = 1; round <= k_most_rounds && !group.is_left; ++round)
    if (try_once(run, group, pushes_out, round == k_most_rounds)) return;
  leave(run, group, pushes_out);
}

// Whether no point that pushes moves, and no other closes, by more than what need not be solved.
bool DirectContacts::is_solved(const Group& group) const {
  const auto point_is = [](const Point& p) {
    return p.barred || (p.speed >= -k_slow && (p.speed <= k_slow || !p.active));
  };
  const auto contact_is = [&](const Contact& contact) {
    return std::ranges::all_of(std::span(contact.points).first(contact.count), point_is);
  };
  return std::ranges::all_of(std::span(contacts_).subspan(group.first, group.count), contact_is);
}

// False when points had to be let go, or others may have begun to close.
bool DirectContacts::try_once(const DirectRun& run, Group& group, bool pushes_out, bool is_last) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<Contact> contacts = contacts_of(group);
  std::uint32_t idle = 0;
  for (Contact& contact : contacts) {
    read(run, contact, pushes_out);
    if (choose_active(contact)) group.is_factored = false;
    idle += contact.count - contact.active;
  }
  if (is_solved(group)) return true;
  if (!group.is_factored) factor(run, group);
  if (group.exponent == k_no_exponent) return true;  // no point pushes
  for (std::uint32_t k = 0; k < group.count; ++k) {
    for (std::uint32_t r = 0; r < contacts[k].active; ++r) {
      const Point& point = contacts[k].points[contacts[k].order[r]];
      const int shift = std::min(4 + point.exponent - group.exponent, 62);
      factor_.rhs(columns[k].first_row + r) = raw::round_shift(-point.speed, shift);
    }
  }
  factor_.solve(group.column, group.count);
  const bool pulls = find_changes(group);
  if (group.is_left) return false;
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
      Point& point = contact.points[contact.order[r]];
      const int shift = k_direct_bits - 46 - point.exponent - group.exponent;
      const std::int64_t solved = factor_.rhs(columns[k].first_row + r);
      point.change = std::clamp<std::int64_t>(scale_saturating(solved, contact.inverse_mass, shift),
                                              -k_speed_bound, k_speed_bound);
      point.barred = point.impulse + point.change < 0;
      if (point.impulse + point.change > group.most) group.is_left = true;
      pulls = pulls || point.barred;
    }
  }
  return pulls;
}

}  // namespace lockstone
