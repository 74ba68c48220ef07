#include "core/dynamics/contact/row_geometry.h"

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

}  // namespace

void find_rows(const ContactRun& run, ContactRows& contact) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  contact.normal = normal_of(block, lane);
  contact.tangent = tangent_of(block, lane);
  contact.binormal = binormal_of(block, lane);
  contact.inverse_mass =
      add(run.bodies[contact.a].inverse_mass, run.bodies[contact.b].inverse_mass);
  const std::array masses = masses_of(block, lane);
  for (contact.count = 0; contact.count < k_block_points; ++contact.count) {
    const std::size_t i = contact.count;
    LKS_ASSERT(masses[i] >= 0);
    if (masses[i] == 0) break;
    PointRow& point = contact.points[i];
    const std::int64_t offset = block.points[i].offset[lane];
    point.x = low_word(offset);
    point.y = high_word(offset);
    point.impulse = low_word(block.points[i].impulse[lane]) * (std::int64_t{1} << k_row_more_bits);
    find_point(block, contact, point);
    find_responses(run, contact, point);
  }
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
}

}  // namespace lockstone
