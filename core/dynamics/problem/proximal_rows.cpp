#include "core/dynamics/problem/proximal_rows.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/contact/block_words.h"
#include "core/math/roots.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::ManifoldBlock;

constexpr std::int64_t k_whole_q30 = std::int64_t{1} << 30;

// ε: compliance over the row's response to itself, 2^-10.
constexpr int k_give_bits = 10;

// A contact gives half, a quarter … 2^-4 of that from 2, 4 … 32 times this load on.
constexpr std::int64_t k_overload = 200;
constexpr int k_most_overload = 4;

// Of an inertia that is not locked pivots are 2^-12 at least; Q60.
constexpr std::int64_t k_least_root_pivot = std::int64_t{1} << 40;

std::int64_t root_of(std::int64_t square) {
  return static_cast<std::int64_t>(isqrt_rounded(static_cast<std::uint64_t>(square)));
}

// Jacobians with which a row's side is found in 64 bits: 3/2, Q30.
constexpr std::uint64_t k_most_fast = std::uint64_t{3} << 29;

// Both sides of a row, each times the root of its share in the pair's inverse mass, Q30.
struct Sides {
  std::array<std::int64_t, 6> a{}, b{};
};

// `part` is the root of the share, with the sign of the side, Q30. Of gears and pulleys |linear|
// may be above 1.
std::array<std::int64_t, 6> scaled_side(const RawVec3& linear, const RawVec3& angular,
                                        const InertiaRoot& root, std::int64_t part) {
  LKS_ASSERT(part >= -k_whole_q30 && part <= k_whole_q30);
  std::array<std::int64_t, 6> side{};
  if (part == 0) return side;
  std::uint64_t most = 0;
  for (std::size_t i = 0; i < 3; ++i)
    most = std::max({most, magnitude(linear[i]), magnitude(angular[i])});
  if (most <= k_most_fast) {  // entries of the root are below √2, so sums of three fit
    const int shift = 30 - root.shift;
    RawVec3 turn;
    std::int64_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      std::int64_t sum = 0;
      for (std::size_t k = i; k < 3; ++k)
        sum += root.c[k][i] * angular[k];
      turn[i] = raw::round_shift(sum, shift);
      bits |= turn[i] ^ (turn[i] >> 63);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = raw::round_shift(linear[i] * part, 30);
      side[3 + i] = bits >> 32 == 0 ? raw::round_shift(turn[i] * part, 30)
                                    : product_rounded(turn[i], part, 30);
    }
    return side;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = product_rounded(linear[i], part, 30);
    ProductSum sum;
    for (std::size_t k = i; k < 3; ++k)
      sum.add(root.c[k][i], angular[k]);
    const std::int64_t turn = sum.rounded(30 - root.shift);
    side[3 + i] = product_rounded(turn, part, 30);
  }
  return side;
}

// Entries are below 2 but for rows of gears and pulleys; then the squares of a pair fit.
std::int64_t length_of(const Sides& sides) {
  UInt128 sum{};
  std::int64_t bits = 0;
  for (std::size_t i = 0; i < lanes::k_body_words; ++i) {
    const std::int64_t a = sides.a[i], b = sides.b[i];
    bits |= (a ^ (a >> 63)) | (b ^ (b >> 63));
    sum = sum + UInt128{0, static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(a) +
                               static_cast<std::uint64_t>(b) * static_cast<std::uint64_t>(b)};
  }
  LKS_ASSERT(bits >= 0);
  if (bits >> 31 != 0) {
    sum = {};
    for (std::size_t i = 0; i < lanes::k_body_words; ++i) {
      const std::uint64_t a = magnitude(sides.a[i]), b = magnitude(sides.b[i]);
      sum = sum + multiply_wide(a, a) + multiply_wide(b, b);
    }
  }
  return static_cast<std::int64_t>(isqrt128_rounded(sum));
}

// Over a length that is not less, Q30; `inverse` is 2^62 over that.
std::int64_t scaled_entry(std::int64_t from, std::int64_t inverse) {
  return std::clamp(raw::round_shift(from * inverse, 32), -k_whole_q30, k_whole_q30);
}

// An entry of both sides, as a word of the problem.
std::int64_t scaled_pair(const Sides& sides, std::size_t i, std::int64_t inverse) {
  return lanes::scalar::pack(scaled_entry(sides.a[i], inverse), scaled_entry(sides.b[i], inverse));
}

// The pair that rows are found for.
struct Pair {
  const ContactRun& run;
  ProximalContact& contact;
  lanes::ProximalBlock& problem;
  PreparedRows& prepared;
  const InertiaRoot &root_a, &root_b;
  std::int64_t part_a = 0, part_b = 0;  // roots of the shares, A's negative, Q30
  RowScale mass;

  [[nodiscard]] Sides sides(const ContactRow& row) const {
    return {scaled_side(row.linear, row.angular_a, root_a, part_a),
            scaled_side(row.linear, row.angular_b, root_b, part_b)};
  }
};

// Row `index`, scaled by 1/length, Q30.
void set_row(const Pair& pair, const ContactRow& from, const Sides& sides, std::int64_t length,
             std::size_t index) {
  LKS_ASSERT(length > 0 && index < k_contact_rows);
  const std::int64_t inverse = (std::int64_t{1} << 62) / length;
  for (std::size_t i = 0; i < lanes::k_body_words; ++i)
    pair.problem.sides[i][index] = pair.problem.by_row[index][i] = scaled_pair(sides, i, inverse);
  const RowScale norm = RowScale::of(static_cast<std::uint64_t>(length), 30);
  ProximalRow& row = pair.contact.all[index];
  const RowScale from_impulse = pair.mass * norm;
  row.to_speed = pair.mass * norm.reciprocal();
  row.to_impulse = from_impulse.reciprocal();
  row.total = from.impulse;
  pair.prepared.from_impulse[index] = from_impulse;
  pair.prepared.own[index] = product_rounded(length, length, 30);
  pair.prepared.response_a[index] = from.response_a;
  pair.prepared.response_b[index] = from.response_b;
}

// The greatest response of a unit impulse along the plane of both tangents to itself, as a length.
std::int64_t greatest_length(const Sides& t, const Sides& b) {
  ProductSum tt, bb, tb;
  const auto add = [&](const std::array<std::int64_t, 6>& x, const std::array<std::int64_t, 6>& y) {
    for (std::size_t i = 0; i < 6; ++i) {
      tt.add(x[i], x[i]);
      bb.add(y[i], y[i]);
      tb.add(x[i], y[i]);
    }
  };
  add(t.a, b.a);
  add(t.b, b.b);
  const std::int64_t p = tt.rounded(30), q = bb.rounded(30), cross = tb.rounded(30);
  const std::int64_t half = raw::round_shift(p - q, 1);
  ProductSum square;
  square.add(half, half);
  square.add(cross, cross);
  const std::int64_t most =
      raw::round_shift(p + q, 1) + root_of(square.rounded(20)) * (std::int64_t{1} << 10);
  LKS_ASSERT(p >= 0 && q >= 0 && most >= 0);
  return static_cast<std::int64_t>(
      isqrt128_rounded(multiply_wide(magnitude(most), static_cast<std::uint64_t>(k_whole_q30))));
}

void add_friction(const Pair& pair, const ManifoldBlock& block) {
  ProximalContact& contact = pair.contact;
  const std::size_t lane = contact.lane();
  std::array<ContactRow, 3> rows{};
  rows[0].linear = contact.tangent;
  rows[1].linear = contact.binormal;
  for (std::size_t i = 0; i < 2; ++i) {
    rows[i].angular_a = turned(low_words(block.arm, lane), rows[i].linear, 0, {});
    rows[i].angular_b = turned(high_words(block.arm, lane), rows[i].linear, 0, {});
  }
  const std::int64_t scale = block.scale[lane];
  const RawVec3 turn = mixed(contact.normal, contact.radius, {}, 0);
  rows[2].angular_a = turned({}, {}, low_word(scale), turn);
  rows[2].angular_b = turned({}, {}, high_word(scale), turn);
  const std::int64_t impulses[] = {low_word(block.friction[lane]), high_word(block.friction[lane]),
                                   low_word(block.twist[lane])};
  for (std::size_t i = 0; i < 3; ++i) {
    rows[i].impulse = impulses[i] * (std::int64_t{1} << k_row_more_bits);
    find_responses(pair.run, contact, rows[i]);
  }
  const Sides t = pair.sides(rows[0]), b = pair.sides(rows[1]), n = pair.sides(rows[2]);
  const std::int64_t length = std::max<std::int64_t>(greatest_length(t, b), k_whole_q30 / 2);
  const std::size_t first = contact.points;
  set_row(pair, rows[0], t, length, first);
  set_row(pair, rows[1], b, length, first + 1);
  contact.rows = contact.points + 2;
  LKS_ASSERT(contact.rows <= k_contact_rows);
  const std::int64_t twist = length_of(n);
  if (twist < k_whole_q30 >> 16) return;  // neither body turns about the normal
  set_row(pair, rows[2], n, twist, first + 2);
  ++contact.rows;
  pair.problem.twist_ratio =
      raw::saturate<std::int32_t>(raw::round_divide(length << lanes::k_friction_point, twist));
}

}  // namespace

RowScale mass_scale(BlockFloat unit, BlockFloat inverse) {
  LKS_ASSERT(unit.mantissa > 0 && inverse.mantissa > 0);
  std::uint64_t ratio = (static_cast<std::uint64_t>(unit.mantissa) << 31) /
                        static_cast<std::uint64_t>(inverse.mantissa);  // 2^30 … 2^32
  int shift = 31 + inverse.exponent - unit.exponent;
  if ((shift & 1) != 0) {
    ratio <<= 1;
    ++shift;
  }
  return RowScale::of(isqrt_rounded(ratio << 30), (shift + 30) / 2);
}

std::int64_t part_of(std::int64_t share) {
  LKS_ASSERT(share >= 0 && share <= k_whole_q30);
  return root_of(share << 30);
}

bool find_proximal_lock(const JointRow& row, const ProximalJoint& joint, ProximalLock& lock) {
  LKS_ASSERT(std::abs(joint.part_a) <= k_whole_q30 && std::abs(joint.part_b) <= k_whole_q30);
  constexpr std::int64_t k_least_length = k_whole_q30 >> 16;
  const Sides sides{scaled_side(row.linear_a, row.angular_a, joint.root_a, joint.part_a),
                    scaled_side(row.linear_b, row.angular_b, joint.root_b, joint.part_b)};
  const std::int64_t length = length_of(sides);
  if (length < k_least_length) return false;
  const std::int64_t inverse = (std::int64_t{1} << 62) / length;
  const auto scaled = [&](std::int64_t x) {  // no entry is longer than the row
    return raw::round_shift(x * inverse, 32);
  };
  for (std::size_t i = 0; i < lanes::k_body_words; ++i)
    lock.row[i] = lanes::scalar::pack(scaled(sides.a[i]), scaled(sides.b[i]));
  const RowScale norm = RowScale::of(static_cast<std::uint64_t>(length), 30);
  lock.to_speed = joint.mass * norm.reciprocal();
  lock.to_impulse = (joint.mass * norm).reciprocal();
  return true;
}

InertiaRoot inertia_root(const InverseInertia& m) {
  LKS_ASSERT(m.xx >= 0 && m.yy >= 0 && m.zz >= 0 && m.exponent >= 0);
  InertiaRoot root;
  root.shift = m.exponent >> 1;
  const int odd = m.exponent & 1;
  const std::int64_t entry[3][3] = {{std::int64_t{m.xx} << odd, 0, 0},
                                    {std::int64_t{m.xy} * (1 << odd), std::int64_t{m.yy} << odd, 0},
                                    {std::int64_t{m.xz} * (1 << odd),
                                     std::int64_t{m.yz} * (1 << odd), std::int64_t{m.zz} << odd}};
  for (std::size_t k = 0; k < 3; ++k) {
    std::int64_t pivot = entry[k][k] << 30;
    for (std::size_t j = 0; j < k; ++j)
      pivot -= root.c[k][j] * root.c[k][j];
    if (pivot < k_least_root_pivot) continue;  // it does not turn about this axis
    root.c[k][k] = root_of(pivot);
    for (std::size_t i = k + 1; i < 3; ++i) {
      std::int64_t sum = entry[i][k] * k_whole_q30;
      for (std::size_t j = 0; j < k; ++j)
        sum -= root.c[i][j] * root.c[k][j];
      root.c[i][k] = raw::round_divide(sum, root.c[k][k]);
    }
  }
  return root;
}

void find_proximal_rows(const ContactRun& run, const InertiaRoot& root_a, const InertiaRoot& root_b,
                        BlockFloat unit, ProximalContact& contact, lanes::ProximalBlock& problem,
                        PreparedRows& prepared) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  ContactRows rows{};
  static_cast<ContactPair&>(rows) = contact;
  find_rows(run, rows);
  contact.points = rows.count;
  contact.normal = rows.normal;
  contact.tangent = rows.tangent;
  contact.binormal = rows.binormal;
  contact.radius = high_word(block.twist[lane]);
  const std::int64_t share_b = low_word(block.share[lane]);
  LKS_ASSERT(share_b >= 0 && share_b <= k_whole_q30);
  const Pair pair{run,
                  contact,
                  problem,
                  prepared,
                  root_a,
                  root_b,
                  contact.a == 0 ? 0 : -root_of((k_whole_q30 - share_b) << 30),
                  contact.b == 0 ? 0 : root_of(share_b << 30),
                  mass_scale(unit, rows.inverse_mass)};
  for (std::size_t i = 0; i < rows.count; ++i) {
    const Sides sides = pair.sides(rows.points[i]);
    set_row(pair, rows.points[i], sides, std::max<std::int64_t>(length_of(sides), k_whole_q30 / 2),
            i);
    problem.normal[i] = -1;
    contact.x[i] = rows.points[i].x;
    contact.y[i] = rows.points[i].y;
  }
  contact.rows = contact.points;
  if (contact.points == 0 || high_word(block.share[lane]) == 0) return;
  add_friction(pair, block);
  const std::int64_t coefficient = high_word(block.share[lane]);
  const RowScale tangent = prepared.from_impulse[contact.points];
  for (std::size_t i = 0; i < contact.points; ++i) {
    const RowScale ratio = tangent * contact.all[i].to_impulse;
    problem.limits[i] = raw::saturate<std::int32_t>(
        std::max<std::int64_t>(ratio.times(coefficient, 30 - lanes::k_friction_point), 1));
  }
}

void set_gives(std::int64_t weight, const PreparedRows& prepared, ProximalContact& contact,
               lanes::ProximalBlock& problem) {
  LKS_ASSERT(weight >= 0 && contact.rows <= k_contact_rows);
  std::int64_t most = 0, load = 0;
  for (std::size_t i = 0; i < contact.rows; ++i) {
    const std::int64_t own = prepared.own[i];
    most = std::max(most, own);
    if (i < contact.points) load = std::max(load, product_rounded(contact.all[i].total, own, 30));
  }
  int overload = 0;
  while (weight > 0 && overload < k_most_overload &&
         (load >> (overload + 1)) >= k_overload * weight)
    ++overload;
  for (std::size_t i = 0; i < contact.rows; ++i) {
    const std::int64_t ratio = raw::round_divide(most << 16, prepared.own[i]);  // 1 or more, Q16
    const std::int64_t give = std::min(ratio << (30 - 16 - k_give_bits - overload), k_whole_q30);
    contact.all[i].give = give;
    set_give(give, i, problem);
  }
}

void set_give(std::int64_t give, std::size_t row, lanes::ProximalBlock& problem) {
  LKS_ASSERT(give >= k_whole_q30 >> BodyFactor::k_least_bits && give <= k_whole_q30);
  LKS_ASSERT(row < k_contact_rows);
  std::int64_t& own = problem.coupling[row][row];
  if (own != 0) own = std::min<std::int64_t>(own - problem.give[row] + give, INT32_MAX);
  problem.give[row] = give;
  problem.own_part[row] = raw::round_divide(k_whole_q30 << 30, k_whole_q30 + give);
  problem.weight[row] = raw::round_divide(std::int64_t{1} << (60 - BodyFactor::k_least_bits), give);
}

}  // namespace lockstone
