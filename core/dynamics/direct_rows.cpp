// The normal rows of contacts that are solved at once.

#include <algorithm>
#include <bit>

#include "core/dynamics/direct_contacts.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::k_block_points;
using lanes::ManifoldBlock;
using lanes::RowBody;
using Triple = std::array<std::int64_t, 3>;

// What would pull is let go, and the rest solved again, so many times; then it is left to sweeps.
constexpr int k_most_rounds = 4;

// Of a group in which no point pushes.
constexpr int k_no_exponent = 1000;

// What pushes overlap out gives way to its impulse by this part of a row's own response: where
// points say the same, each takes a share.
constexpr int k_give_shift = 16;

// What a point's speed and what is asked of it are held within, Q50.
constexpr std::int64_t k_speed_bound = std::int64_t{1} << 60;

// What a body's velocity and spin are held within, Q50; what a contact gives at a time, m/s, Q20.
constexpr std::int64_t k_body_bound = std::int64_t{1} << 61;
constexpr std::int64_t k_most_jump = std::int64_t{1} << 30;

std::int64_t low(std::int64_t word) {
  return static_cast<std::int32_t>(word);
}
std::int64_t high(std::int64_t word) {
  return word >> 32;
}
Triple low(const lanes::BlockWord (&words)[3], std::size_t lane) {
  return {low(words[0][lane]), low(words[1][lane]), low(words[2][lane])};
}
Triple high(const lanes::BlockWord (&words)[3], std::size_t lane) {
  return {high(words[0][lane]), high(words[1][lane]), high(words[2][lane])};
}

// a·x + b·y, in 30 bits less.
Triple mixed(const Triple& a, std::int64_t x, const Triple& b, std::int64_t y) {
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = raw::round_shift(a[i] * x + b[i] * y, 30);
  return result;
}

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// r̄ × n + scale·turn, Q30.
Triple angular(const Triple& arm, const Triple& normal, std::int64_t scale, const Triple& turn) {
  Triple result = cross(arm, normal);
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = raw::round_shift(result[i] + scale * turn[i], 30);
  return result;
}

// M·v, M in Q(shift): xx, yy, zz, xy, xz, yz.
Triple through(const std::array<std::int64_t, 6>& m, int shift, const Triple& v) {
  constexpr std::size_t k_entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i) {
    ProductSum sum;
    for (std::size_t j = 0; j < 3; ++j)
      sum.add(m[k_entry[i][j]], v[j]);
    result[i] = sum.rounded(shift);
  }
  return result;
}

// n·n + angular·response, Q30.
std::int64_t coupled(const Triple& normal_x, const Triple& normal_y, const Triple& angular_x,
                     const Triple& response_y, bool opposite) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(normal_x[i], normal_y[i]);
    sum.add(angular_x[i], response_y[i]);
  }
  const std::int64_t rounded = sum.rounded(30);
  return opposite ? -rounded : rounded;
}

// Of points p, q, r in the manifold's plane: twice the area of their triangle; Q26 in, Q52 out.
std::int64_t area(const std::int64_t (&x)[4], const std::int64_t (&y)[4], std::size_t p,
                  std::size_t q, std::size_t r) {
  return (x[q] - x[p]) * (y[r] - y[p]) - (y[q] - y[p]) * (x[r] - x[p]);
}

// The multiple of 2^-32 m/s next to a change of velocity in Q50.
std::int64_t on_grid(std::int64_t x) {
  constexpr int k_below = lanes::k_velocity_bits - lanes::k_grid_bits;
  return raw::round_shift(x, k_below) * (std::int64_t{1} << k_below);
}

void gain(std::int64_t& to, std::int64_t by) {
  to = std::clamp(to + by, -k_body_bound, k_body_bound);
}

}  // namespace

void DirectContacts::fill(const DirectRun& run, Contact& contact) {
  const ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  const auto& axes = block.axes;
  contact.normal = {low(axes[0][lane]), high(axes[0][lane]), low(axes[1][lane])};
  contact.tangent = {high(axes[1][lane]), low(axes[2][lane]), high(axes[2][lane])};
  contact.binormal = {low(axes[3][lane]), high(axes[3][lane]), low(axes[4][lane])};
  contact.inverse_mass = lockstone::add(run.bodies[contact.link.a].inverse_mass,
                                        run.bodies[contact.link.b].inverse_mass);
  const std::int64_t masses[] = {low(block.mass_01[lane]), high(block.mass_01[lane]),
                                 low(block.mass_23[lane]), high(block.mass_23[lane])};
  while (contact.count < k_block_points && masses[contact.count] != 0) {
    Point& point = contact.points[contact.count++];
    const std::int64_t offset = block.points[contact.count - 1].offset[lane];
    point.x = low(offset);
    point.y = high(offset);
    point.own = (std::int64_t{1} << 60) / masses[contact.count - 1];
    fill_point(block, lane, contact, point);
    find_exponent(run, contact, point);
  }
  find_warp(contact);
}

void DirectContacts::fill_point(const ManifoldBlock& block, std::size_t lane,
                                const Contact& contact, Point& point) {
  const Triple turn = mixed(contact.tangent, point.y, contact.binormal, -point.x);
  const int shift = static_cast<int>(high(block.axes[4][lane]));
  std::array<std::int64_t, 6> inertia_a{}, inertia_b{};
  for (std::size_t i = 0; i < 6; ++i) {
    inertia_a[i] = low(block.inertia[i][lane]);
    inertia_b[i] = high(block.inertia[i][lane]);
  }
  const std::int64_t scale = block.scale[lane];
  point.angular_a = angular(low(block.arm, lane), contact.normal, low(scale), turn);
  point.angular_b = angular(high(block.arm, lane), contact.normal, high(scale), turn);
  point.response_a = through(inertia_a, shift, point.angular_a);
  point.response_b = through(inertia_b, shift, point.angular_b);
}

// Such that the row's response to itself lies in (2^-4, 1] when it is scaled twice.
void DirectContacts::find_exponent(const DirectRun& run, const Contact& contact, Point& point) {
  int most = -1000;
  const auto add_side = [&](std::uint32_t body, const Triple& turn, const Triple& response) {
    if (body == 0) return;
    const std::int64_t self = coupled(contact.normal, contact.normal, turn, response, false);
    const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
    most = std::max(most, width + 1 + run.bodies[body].inverse_mass.exponent);
  };
  add_side(contact.link.a, point.angular_a, point.response_a);
  add_side(contact.link.b, point.angular_b, point.response_b);
  point.exponent = (most + 2) >> 1;
}

// Impulses (warp₀, warp₁, …) of four points in a plane add up to nothing.
void DirectContacts::find_warp(Contact& contact) {
  if (contact.count != k_block_points) return;
  std::int64_t x[4], y[4];
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = raw::round_shift(contact.points[i].x, 4);
    y[i] = raw::round_shift(contact.points[i].y, 4);
  }
  const std::int64_t warp[] = {area(x, y, 1, 2, 3), -area(x, y, 0, 2, 3), area(x, y, 0, 1, 3),
                               -area(x, y, 0, 1, 2)};
  std::uint64_t most = 0;
  for (const std::int64_t part : warp)
    most = std::max(most, magnitude(part));
  const int shift = static_cast<int>(std::bit_width(most)) - 30;
  if (shift < 1) return;  // all in a line
  ProductSum size;
  for (std::size_t i = 0; i < 4; ++i) {
    contact.points[i].warp = raw::round_shift(warp[i], shift);
    size.add(contact.points[i].warp, contact.points[i].warp);
  }
  contact.warp_size = size.rounded(30);
}

// The sweeps keep what was solved.
void DirectContacts::make_rigid(const DirectRun& run, const Contact& contact) {
  ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  block.soft[lane] = low(block.soft[lane]) + (std::int64_t{1} << 62);
  block.rest[lane] = 0;
}

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
    const std::int64_t now = high(block.points[i].separation[lane]);
    std::int64_t bias = 0;
    if (now > run.rules.skin) {
      bias = product_rounded(now, std::int64_t{run.rules.substep_rate} << 32, 6);
    } else if (pushes_out) {
      bias = product_rounded(now + run.rules.overlap, low(block.soft[lane]) << 32, 26);
      bias = std::max(bias, -(std::int64_t{run.rules.push_out} << 30));
    }
    point.impulse = static_cast<std::int32_t>(low(block.points[i].impulse[lane]));
    if (pushes_out)
      bias += product_rounded(std::int64_t{point.impulse} << 30, point.own, 30 + k_give_shift);
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

void DirectContacts::solve_group(const DirectRun& run, Group& group, bool pushes_out) {
  for (Contact& contact : contacts_of(group))
    for (Point& point : contact.points)
      point.barred = false;
  for (int round = 1; round <= k_most_rounds; ++round)
    if (try_once(run, group, pushes_out, round == k_most_rounds)) return;
}

// False when points had to be let go.
bool DirectContacts::try_once(const DirectRun& run, Group& group, bool pushes_out, bool is_last) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<Contact> contacts = contacts_of(group);
  bool changed = !group.is_factored;
  for (Contact& contact : contacts) {
    read(run, contact, pushes_out);
    changed = choose_active(contact) || changed;
  }
  if (changed) factor(run, group);
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
  if (pulls && is_last) return true;  // what others push would want those that pull
  for (Contact& contact : contacts)
    push_all(run, contact, pulls);
  return !pulls;
}

// Answers whether any point would pull.
bool DirectContacts::find_changes(Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  bool pulls = false;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Contact& contact = contacts_of(group)[k];
    for (std::uint32_t r = 0; r < contact.active; ++r) {
      Point& point = contact.points[contact.order[r]];
      const int shift = 4 - 30 - point.exponent - group.exponent;
      const std::int64_t solved = factor_.rhs(columns[k].first_row + r);
      point.change = std::clamp<std::int64_t>(scale_saturating(solved, contact.inverse_mass, shift),
                                              -k_speed_bound, k_speed_bound);
      point.barred = point.impulse + point.change < 0;
      pulls = pulls || point.barred;
    }
  }
  return pulls;
}

// Gives its points what was found; or, as long as others pull, only lets those go.
void DirectContacts::push_all(const DirectRun& run, Contact& contact, bool only_lets_go) {
  std::array<std::int32_t, k_block_points> next{};
  for (std::size_t i = 0; i < contact.count; ++i) {
    const Point& point = contact.points[i];
    next[i] = point.impulse;
    if (!point.active || (only_lets_go && !point.barred)) continue;
    next[i] = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(point.impulse + point.change, 0, lanes::k_most_impulse));
  }
  push(run, contact, next);
}

// As a sweep gives impulses to its bodies.
void DirectContacts::push(const DirectRun& run, Contact& contact,
                          const std::array<std::int32_t, k_block_points>& next) {
  ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  std::int64_t change = 0, x = 0, y = 0;
  for (std::size_t i = 0; i < contact.count; ++i) {
    const Point& point = contact.points[i];
    const std::int64_t moved = std::int64_t{next[i]} - point.impulse;
    std::int64_t& word = block.points[i].impulse[lane];
    word = std::max<std::int64_t>(high(word), next[i]) * (std::int64_t{1} << 32) + next[i];
    change += moved;
    x += raw::round_shift(point.x * moved, 30);
    y += raw::round_shift(point.y * moved, 30);
  }
  const auto limited = [](std::int64_t jump) {
    return std::clamp(jump, -k_most_jump, k_most_jump);
  };
  x = limited(x);
  y = limited(y);
  const Triple force = mixed(contact.normal, limited(change), {}, 0);
  const Triple torque = mixed(contact.tangent, y, contact.binormal, -x);
  const Triple spin_a = cross(low(block.gain_arm, lane), force);
  const Triple spin_b = cross(high(block.gain_arm, lane), force);
  const std::int64_t turn = block.gain_turn[lane], share = low(block.share[lane]);
  RowBody& a = run.rows[contact.link.row_a];
  RowBody& b = run.rows[contact.link.row_b];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t to_b = on_grid(force[i] * share);
    gain(b.velocity[i], to_b);
    gain(a.velocity[i], to_b - force[i] * (std::int64_t{1} << 30));
    gain(b.spin[i], on_grid(spin_b[i] + torque[i] * high(turn)));
    gain(a.spin[i], -on_grid(spin_a[i] + torque[i] * low(turn)));
  }
}

}  // namespace lockstone
