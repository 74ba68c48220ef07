// The normal rows of contacts that are solved at once.

#include <algorithm>
#include <bit>

#include "core/dynamics/direct_words.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
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

// Of points p, q, r in the manifold's plane: twice the area of their triangle; Q26 in, Q52 out.
std::int64_t area(const std::int64_t (&x)[4], const std::int64_t (&y)[4], std::size_t p,
                  std::size_t q, std::size_t r) {
  return (x[q] - x[p]) * (y[r] - y[p]) - (y[q] - y[p]) * (x[r] - x[p]);
}

}  // namespace

void DirectContacts::fill(const DirectRun& run, Contact& contact) {
  const ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  const auto& axes = block.axes;
  contact.normal = normal_of(block, lane);
  contact.tangent = {high_word(axes[1][lane]), low_word(axes[2][lane]), high_word(axes[2][lane])};
  contact.binormal = {low_word(axes[3][lane]), high_word(axes[3][lane]), low_word(axes[4][lane])};
  contact.inverse_mass = lockstone::add(run.bodies[contact.link.a].inverse_mass,
                                        run.bodies[contact.link.b].inverse_mass);
  for (std::size_t i = 0; i < contact.count; ++i) {
    Point& point = contact.points[i];
    const std::int64_t offset = block.points[i].offset[lane];
    point.x = low_word(offset);
    point.y = high_word(offset);
    point.own = (std::int64_t{1} << 60) / contact.masses[i];
    point.impulse =
        low_word(block.points[i].impulse[lane]) * (std::int64_t{1} << k_direct_more_bits);
    fill_point(block, lane, contact, point);
    find_responses(run, contact, point);
  }
  find_warp(contact);
}

// What both bodies do of the row's angular parts.
void DirectContacts::find_responses(const DirectRun& run, const Contact& contact, Row& row) {
  const ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  const int shift = block.shift(lane);
  std::array<std::int64_t, 6> inertia_a{}, inertia_b{};
  for (std::size_t i = 0; i < 6; ++i) {
    if (block.is_plain(lane) && i >= 3) break;
    const std::int64_t word = block.inertia[block.is_plain(lane) ? 0 : i][lane];
    inertia_a[i] = low_word(word);
    inertia_b[i] = high_word(word);
  }
  row.response_a = through(inertia_a, shift, row.angular_a);
  row.response_b = through(inertia_b, shift, row.angular_b);
  find_exponent(run, contact, row);
}

void DirectContacts::fill_point(const ManifoldBlock& block, std::size_t lane,
                                const Contact& contact, Point& point) {
  const RawVec3 turn = mixed(contact.tangent, point.y, contact.binormal, -point.x);
  const std::int64_t scale = block.scale[lane];
  point.linear = contact.normal;
  point.angular_a = turned(low_words(block.arm, lane), contact.normal, low_word(scale), turn);
  point.angular_b = turned(high_words(block.arm, lane), contact.normal, high_word(scale), turn);
}

// Such that the row's response to itself lies in (2^-4, 1] when it is scaled twice.
void DirectContacts::find_exponent(const DirectRun& run, const Contact& contact, Row& row) {
  int most = -1000;
  const auto add_side = [&](std::uint32_t body, const RawVec3& turn, const RawVec3& response) {
    if (body == 0) return;
    const std::int64_t self = coupled(row.linear, row.linear, turn, response, false);
    const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
    most = std::max(most, width + 1 + run.bodies[body].inverse_mass.exponent);
  };
  add_side(contact.link.a, row.angular_a, row.response_a);
  add_side(contact.link.b, row.angular_b, row.response_b);
  row.exponent = (most + 2) >> 1;
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

// Of the points that the contact has.
void DirectContacts::find_masses(const ManifoldBlock& block, std::size_t lane, Contact& contact) {
  contact.masses = {low_word(block.mass_01[lane]), high_word(block.mass_01[lane]),
                    low_word(block.mass_23[lane]), high_word(block.mass_23[lane])};
  contact.common_mass = low_word(block.common[lane]);
  while (contact.count < k_block_points && contact.masses[contact.count] != 0)
    ++contact.count;
}

// From here on the sweeps leave its normal impulses alone: they only do its friction.
void DirectContacts::take_over(const DirectRun& run, Contact& contact) {
  ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  find_masses(block, lane, contact);
  block.soft[lane] = low_word(block.soft[lane]) + (std::int64_t{1} << 62);
  block.rest[lane] = 0;
  block.mass_01[lane] = block.mass_23[lane] = 0;
  block.common[lane] -= contact.common_mass;
}

// The sweeps do its normals as well.
void DirectContacts::give_back(const DirectRun& run, const Contact& contact) {
  ManifoldBlock& block = run.blocks[contact.link.slot / k_block_lanes];
  const std::size_t lane = contact.link.slot % k_block_lanes;
  const auto pack = [](std::int64_t low, std::int64_t high) {
    return high * (std::int64_t{1} << 32) + low;
  };
  block.mass_01[lane] = pack(contact.masses[0], contact.masses[1]);
  block.mass_23[lane] = pack(contact.masses[2], contact.masses[3]);
  block.common[lane] += contact.common_mass;
}

}  // namespace lockstone
