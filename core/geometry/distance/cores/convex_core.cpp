#include "core/geometry/distance/cores/convex_core.h"

#include <bit>
#include <limits>

#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/numeric/wide_vectors.h"

namespace lockstone::geometry {
namespace {

constexpr int k_lattice_norm_bits = 30;

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// The rotated vertices, brought about the middle of their bounds.
void list_vertices(const Polytope& polytope, const Mat3& rotation, ConvexCore& core) {
  LKS_ASSERT(!polytope.vertices.empty() && polytope.vertices.size() <= core.x.size());
  const Mat3 rows{{rotation.x.x, rotation.y.x, rotation.z.x},
                  {rotation.x.y, rotation.y.y, rotation.z.y},
                  {rotation.x.z, rotation.y.z, rotation.z.z}};
  core.vertex_count = static_cast<int>(polytope.vertices.size());
  core.radius = polytope.radius;
  RawVec lower = to_local(rows, polytope.vertices[0]);
  RawVec upper = lower;
  for (std::size_t i = 0; i < polytope.vertices.size(); ++i) {
    const RawVec v = to_local(rows, polytope.vertices[i]);
    lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
    upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
    core.x[i] = v.x;
    core.y[i] = v.y;
    core.z[i] = v.z;
  }
  core.reference = {lower.x / 2 + upper.x / 2, lower.y / 2 + upper.y / 2,
                    lower.z / 2 + upper.z / 2};
  core.extent = upper - core.reference;
  for (int k = 0; k < 3; ++k)
    core.extent[k] = std::max(core.extent[k], core.reference[k] - lower[k]);
  for (std::size_t i = 0; i < polytope.vertices.size(); ++i) {
    core.x[i] -= core.reference.x;
    core.y[i] -= core.reference.y;
    core.z[i] -= core.reference.z;
  }
}

/// The core's vertex greatest along a direction, dot(x, y, z) being its exact product with it.
template <class Dot>
int greatest_vertex(const LatticeCore& core, Dot dot) {
  if (core.vertex_count == 0) {
    unsigned bits = 0;
    for (int i = 0; i < core.generator_count; ++i) {
      const RawVec& g = core.generators[at(i)];
      if (!is_negative(dot(g.x, g.y, g.z))) bits |= 1U << i;
    }
    return static_cast<int>(bits);
  }
  std::size_t best = 0;
  auto greatest = dot(core.x[0], core.y[0], core.z[0]);
  for (std::size_t i = 1; i < at(core.vertex_count); ++i) {
    const auto value = dot(core.x[i], core.y[i], core.z[i]);
    if (greatest < value) {
      greatest = value;
      best = i;
    }
  }
  return static_cast<int>(best);
}

RawVec lattice_point(const LatticeCore& core, int index) {
  if (core.rims != nullptr) return shifted(rim_point(*core.rims, index), core.shift);
  if (core.vertex_count != 0) return {core.x[at(index)], core.y[at(index)], core.z[at(index)]};
  RawVec sum;
  for (int i = 0; i < core.generator_count; ++i) {
    const RawVec& g = core.generators[at(i)];
    sum = (index >> i & 1) != 0 ? sum + g : sum - g;
  }
  return sum;
}

DifferenceVertex difference_vertex(const LatticePair& pair, int a, int b) {
  return {lattice_point(pair.b, b) + pair.offset - lattice_point(pair.a, a), a, b};
}

auto product_with(const RawVec& d) {
  return
      [d](std::int64_t x, std::int64_t y, std::int64_t z) { return d.x * x + d.y * y + d.z * z; };
}

int greatest_vertex_along(const LatticeCore& core, const RawVec& direction) {
  if (core.rims != nullptr) return farthest_rim_vertex(*core.rims, direction);
  return greatest_vertex(core, product_with(direction));
}

auto wide_product_with(const RawVec& d) {
  return [d](std::int64_t x, std::int64_t y, std::int64_t z) { return wide_dot(d, {x, y, z}); };
}

/// The vertex greatest along a direction of any length. Of listed vertices, those are compared
/// exactly that the direction's leading 31 bits put close to the greatest: the cut bits are worth
/// less than 1 in each component, so a product errs by less than |x| + |y| + |z| < 2^32.
int exactly_greatest_vertex(const LatticeCore& core, const RawVec& direction) {
  if (core.rims != nullptr) return farthest_rim_vertex(*core.rims, direction);
  if (core.vertex_count == 0) return greatest_vertex(core, wide_product_with(direction));
  const RawVec leading = truncated(direction, 31);
  const auto product = product_with(leading);
  const auto count = at(core.vertex_count);
  std::array<std::int64_t, k_max_polytope_vertices> near;
  std::int64_t greatest = std::numeric_limits<std::int64_t>::min();
  for (std::size_t i = 0; i < count; ++i) {
    near[i] = product(core.x[i], core.y[i], core.z[i]);
    greatest = std::max(greatest, near[i]);
  }
  std::size_t best = count;
  Int128 most;
  for (std::size_t i = 0; i < count; ++i) {
    if (greatest - near[i] > std::int64_t{1} << 33) continue;
    const Int128 value = wide_dot(direction, {core.x[i], core.y[i], core.z[i]});
    if (best != count && value <= most) continue;
    most = value;
    best = i;
  }
  return static_cast<int>(best);
}

void to_lattice(const ConvexCore& core, int shift, LatticeCore& lattice) {
  lattice.generator_count = core.generator_count;
  lattice.vertex_count = core.vertex_count;
  lattice.rims = core.rims.count != 0 ? &core.rims : nullptr;
  lattice.shift = shift;
  for (std::size_t i = 0; i < at(core.generator_count); ++i)
    lattice.generators[i] = shifted(core.generators[i], shift);
  for (std::size_t i = 0; i < at(core.vertex_count); ++i) {
    lattice.x[i] = static_cast<std::int32_t>(raw::round_shift(core.x[i], shift));
    lattice.y[i] = static_cast<std::int32_t>(raw::round_shift(core.y[i], shift));
    lattice.z[i] = static_cast<std::int32_t>(raw::round_shift(core.z[i], shift));
  }
}

}  // namespace

void make_core(const PosedShape& shape, ConvexCore& core) {
  core.generator_count = 0;
  core.vertex_count = 0;
  core.rims.count = 0;
  core.radius = {};
  core.reference = {};
  core.extent = {};
  core.swell = {};
  core.polytope = shape.polytope;
  core.rotation = shape.rotation;
  if (shape.polytope != nullptr) {
    list_vertices(*shape.polytope, shape.rotation, core);
  } else {
    traits_of(shape.shape).make_core(shape, core);
  }
}

void add_generator(ConvexCore& core, const RawVec& generator) {
  core.generators[at(core.generator_count++)] = generator;
  for (int k = 0; k < 3; ++k)
    core.extent[k] += magnitude_of(generator[k]);
}

RawVec vertex_of(const ConvexCore& core, int index) {
  if (core.rims.count != 0) return rim_point(core.rims, index);
  if (core.vertex_count != 0) {
    return core.reference + RawVec{core.x[at(index)], core.y[at(index)], core.z[at(index)]};
  }
  RawVec sum = core.reference;
  for (int i = 0; i < core.generator_count; ++i) {
    const RawVec& g = core.generators[at(i)];
    sum = (index >> i & 1) != 0 ? sum + g : sum - g;
  }
  return sum;
}

int farthest_vertex(const ConvexCore& core, const RawVec& direction) {
  if (core.rims.count != 0) return farthest_rim_vertex(core.rims, direction);
  int best = 0;
  Int128 greatest = wide_dot(direction, vertex_of(core, 0));
  for (int i = 1; i < vertex_count(core); ++i) {
    const Int128 product = wide_dot(direction, vertex_of(core, i));
    if (product <= greatest) continue;
    greatest = product;
    best = i;
  }
  return best;
}

RawVec farthest_point(const ConvexCore& core, const Vec3<Unit>& n) {
  if (!is_tapered(core)) return vertex_of(core, farthest_vertex(core, raws_of(n)));
  const RawVec first = vertex_of(core, 0) + along(n, core.swell[0]);
  const RawVec second = vertex_of(core, 1) + along(n, core.swell[1]);
  return dot(second - first, n) > 0 ? second : first;
}

RawVec reference_offset(const ConvexCore& a, const ConvexCore& b, const RawVec& offset) {
  return offset + b.reference - a.reference;
}

int lattice_shift(const ConvexCore& a, const ConvexCore& b, const RawVec& offset) {
  constexpr int coarse = 32;
  std::uint64_t squares = 0;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t reach = magnitude_of(offset[k]) + a.extent[k] + b.extent[k];
    LKS_ASSERT(reach >= 0 && reach < std::int64_t{1} << 62);
    const auto steps = static_cast<std::uint64_t>(reach >> coarse) + 1;
    squares += steps * steps;
  }
  const int norm_bits = (64 - std::countl_zero(squares) + 1) / 2 + coarse;  // |reach| < 2^norm_bits
  return norm_bits - k_lattice_norm_bits;
}

void to_lattice(const ConvexCore& a, const ConvexCore& b, int shift, LatticePair& pair) {
  pair.shift = shift;
  to_lattice(a, shift, pair.a);
  to_lattice(b, shift, pair.b);
}

void set_offset(const RawVec& offset, LatticePair& pair) {
  pair.offset = shifted(offset, pair.shift);
}

DifferenceVertex least_along(const LatticePair& pair, const RawVec& direction) {
  return difference_vertex(pair, greatest_vertex_along(pair.a, direction),
                           greatest_vertex_along(pair.b, -direction));
}

DifferenceVertex greatest_along(const LatticePair& pair, const RawVec& direction) {
  return difference_vertex(pair, exactly_greatest_vertex(pair.a, -direction),
                           exactly_greatest_vertex(pair.b, direction));
}

}  // namespace lockstone::geometry
