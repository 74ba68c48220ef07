#include "core/dynamics/contact/row_geometry.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/contact/block_words.h"

namespace lockstone {
namespace {

using lanes::k_block_points;
using lanes::ManifoldBlock;

// M·v, M in Q(shift): xx, yy, zz, xy, xz, yz.
RawVec3 through(const std::array<std::int64_t, 6>& m, int shift, const RawVec3& v) {
  constexpr std::size_t k_entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  RawVec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    ProductSum sum;
    for (std::size_t j = 0; j < 3; ++j)
      sum.add(m[k_entry[i][j]], v[j]);
    result[i] = sum.rounded(shift);
  }
  return result;
}

// m·v, where a body turns alike about all axes.
RawVec3 through(std::int64_t m, int shift, const RawVec3& v) {
  const auto word = static_cast<std::int32_t>(m);
  return {scaled(v[0], word, shift), scaled(v[1], word, shift), scaled(v[2], word, shift)};
}

void find_point(const ManifoldBlock& block, const ContactRows& contact, PointRow& point) {
  const std::size_t lane = contact.lane();
  const RawVec3 turn = mixed(contact.tangent, point.y, contact.binormal, -point.x);
  const std::int64_t scale = block.scale[lane];
  point.linear = contact.normal;
  point.angular_a = turned(low_words(block.arm, lane), contact.normal, low_word(scale), turn);
  point.angular_b = turned(high_words(block.arm, lane), contact.normal, high_word(scale), turn);
}

// Such that the row's response to itself lies in (2^-4, 1] when it is scaled twice.
void find_exponent(const ContactRun& run, const ContactPair& pair, ContactRow& row) {
  int most = -1000;
  const auto add_side = [&](std::uint32_t body, const RawVec3& turn, const RawVec3& response) {
    if (body == 0) return;
    const std::int64_t self = coupled(row.linear, row.linear, turn, response);
    const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
    most = std::max(most, width + 1 + run.bodies[body].inverse_mass.exponent);
  };
  add_side(pair.a, row.angular_a, row.response_a);
  add_side(pair.b, row.angular_b, row.response_b);
  LKS_ASSERT(most > -1000);
  row.exponent = (most + 2) >> 1;
}

// Of points p, q, r in the manifold's plane: twice the area of their triangle; Q26 in, Q52 out.
std::int64_t area(const std::int64_t (&x)[4], const std::int64_t (&y)[4], std::size_t p,
                  std::size_t q, std::size_t r) {
  return (x[q] - x[p]) * (y[r] - y[p]) - (y[q] - y[p]) * (x[r] - x[p]);
}

// Impulses (warp₀, warp₁, …) of four points in a plane add up to nothing.
void find_warp(ContactRows& contact) {
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
  LKS_ASSERT(contact.warp_size > 0);
}

}  // namespace

void find_masses(const ContactRun& run, ContactRows& contact) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  contact.masses = masses_of(block, lane);
  while (contact.count < k_block_points && contact.masses[contact.count] != 0)
    ++contact.count;
}

void find_rows(const ContactRun& run, ContactRows& contact) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  contact.normal = normal_of(block, lane);
  contact.tangent = tangent_of(block, lane);
  contact.binormal = binormal_of(block, lane);
  contact.inverse_mass =
      add(run.bodies[contact.a].inverse_mass, run.bodies[contact.b].inverse_mass);
  for (std::size_t i = 0; i < contact.count; ++i) {
    PointRow& point = contact.points[i];
    const std::int64_t offset = block.points[i].offset[lane];
    point.x = low_word(offset);
    point.y = high_word(offset);
    LKS_ASSERT(contact.masses[i] > 0);
    point.own = (std::int64_t{1} << 60) / contact.masses[i];
    point.impulse = low_word(block.points[i].impulse[lane]) * (std::int64_t{1} << k_row_more_bits);
    find_point(block, contact, point);
    find_responses(run, contact, point);
  }
  find_warp(contact);
}

void find_responses(const ContactRun& run, const ContactPair& pair, ContactRow& row) {
  const ManifoldBlock& block = run.blocks[pair.block()];
  const std::size_t lane = pair.lane();
  const int shift = block.shift(lane);
  LKS_ASSERT(shift >= 16 && shift <= 28);
  if (block.is_plain(lane)) {
    const std::int64_t both = block.moment[lane];
    row.response_a = through(low_word(both), shift, row.angular_a);
    row.response_b = through(high_word(both), shift, row.angular_b);
  } else {
    std::array<std::int64_t, 6> inertia_a{}, inertia_b{};
    for (std::size_t i = 0; i < 6; ++i) {
      const std::int64_t word = (i == 0 ? block.moment : block.inertia[i - 1])[lane];
      inertia_a[i] = low_word(word);
      inertia_b[i] = high_word(word);
    }
    row.response_a = through(inertia_a, shift, row.angular_a);
    row.response_b = through(inertia_b, shift, row.angular_b);
  }
  find_exponent(run, pair, row);
}

}  // namespace lockstone
