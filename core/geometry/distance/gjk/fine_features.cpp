#include "core/geometry/distance/gjk/fine_features.h"

#include <algorithm>

#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

Fine weighted(Fine x, Weight weight) {
  return static_cast<Fine>(round_shift(multiply_wide(x, weight), k_weight_bits).low);
}

RawVec weighted(const RawVec& v, Weight weight) {
  return {weighted(v.x, weight), weighted(v.y, weight), weighted(v.z, weight)};
}

int greatest_axis(const RawVec& v) {
  int greatest = 0;
  for (int k = 1; k < 3; ++k) {
    if (magnitude_of(v[k]) > magnitude_of(v[greatest])) greatest = k;
  }
  return greatest;
}

/// The component of a × b along one axis.
Int128 cross_along(const RawVec& a, const RawVec& b, int axis) {
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  return multiply_wide(a[i], b[j]) - multiply_wide(a[j], b[i]);
}

}  // namespace

FineFeatures features_of(const FinePair& pair, const Simplex& simplex) {
  FineFeatures features;
  features.count = simplex.count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
    features.a[i] = vertex_of(pair.a, simplex.vertices[i].a);
    features.b[i] = vertex_of(pair.b, simplex.vertices[i].b) + pair.offset;
    features.difference[i] = features.b[i] - features.a[i];
  }
  return features;
}

Weight weight_of(Int128 numerator, Int128 denominator) {
  if (!is_positive(numerator)) return 0;
  if (numerator >= denominator) return k_whole;
  // The quotient of the leading 63 bits of the denominator and as many of the numerator.
  const int excess = std::max(0, 65 - countl_zero(denominator.bits()));
  const std::uint64_t divisor = (denominator.bits() >> excess).low;
  const UInt128 size = numerator.bits();
  const int shift = k_weight_bits - excess;
  const UInt128 dividend = shift >= 0 ? size << shift : size >> -shift;
  if (dividend.high >= divisor) return k_whole;
  return std::min(k_whole, static_cast<Weight>(round_divide(dividend, divisor)));
}

RawVec blend(const FineFeatures& features, const std::array<RawVec, 3>& points) {
  RawVec sum = points[0];
  for (std::size_t i = 1; i < static_cast<std::size_t>(features.count); ++i)
    sum = sum + weighted(points[i] - points[0], features.weight[i]);
  return sum;
}

void weigh_edge(FineFeatures& features) {
  const RawVec edge = features.difference[1] - features.difference[0];
  const Int128 square = wide_dot(edge, edge);
  if (!is_zero(square))
    features.weight[1] = weight_of(-wide_dot(features.difference[0], edge), square);
}

void weigh_rim(FineFeatures& features) {
  std::array<Weight, 3> best{};
  std::uint64_t least = ~std::uint64_t{0};
  for (std::size_t from = 0; from < 3; ++from) {
    const std::size_t to = from < 2 ? from + 1 : 0;
    FineFeatures edge;
    edge.count = 2;
    edge.difference = {features.difference[from], features.difference[to], {}};
    weigh_edge(edge);
    const RawVec point = blend(edge, edge.difference);
    const std::uint64_t distance = norm(point.x, point.y, point.z);
    if (distance >= least) continue;
    least = distance;
    best = {};
    best[from] = k_whole - edge.weight[1];
    best[to] = edge.weight[1];
  }
  features.weight = best;
}

RawVec scaled_by_ratio(const RawVec& v, std::int64_t numerator, std::int64_t denominator) {
  const auto lane = [&](std::int64_t x) {
    return round_divide(multiply_wide(x, numerator), denominator);
  };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

bool weigh_foot(FineFeatures& features, const RawVec& foot, const RawVec& normal) {
  const RawVec p = features.difference[1] - features.difference[0];
  const RawVec q = features.difference[2] - features.difference[0];
  const RawVec f = foot - features.difference[0];
  const int axis = greatest_axis(normal);
  Int128 whole = cross_along(p, q, axis);
  Int128 at_p = cross_along(f, q, axis);
  Int128 at_q = cross_along(p, f, axis);
  if (whole.negative()) {
    whole = -whole;
    at_p = -at_p;
    at_q = -at_q;
  }
  features.weight[1] = weight_of(at_p, whole);
  features.weight[2] = std::min(weight_of(at_q, whole), k_whole - features.weight[1]);
  return !at_p.negative() && !at_q.negative() && at_p + at_q <= whole;
}

}  // namespace lockstone::geometry
