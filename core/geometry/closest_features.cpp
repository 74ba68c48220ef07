#include "core/geometry/closest_features.h"

#include "core/geometry/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A weight in [0, 1], 60 fraction bits.
using Weight = std::int64_t;
constexpr int k_weight_bits = 60;
constexpr Weight k_whole = Weight{1} << k_weight_bits;

/// The features' vertices in fine lanes and what they weigh at the closest point. The first one
/// takes what the others leave.
struct FineFeatures {
  int count = 0;
  std::array<RawVec, 3> a{};
  std::array<RawVec, 3> b{};
  std::array<RawVec, 3> difference{};
  std::array<Weight, 3> weight{};
};

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

/// numerator / denominator to nearest, clamped to [0, 1]; denominator > 0.
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

Fine part(Fine x, Weight weight) {
  return static_cast<Fine>(round_shift(multiply_wide(x, weight), k_weight_bits).low);
}

RawVec part(const RawVec& v, Weight weight) {
  return {part(v.x, weight), part(v.y, weight), part(v.z, weight)};
}

RawVec blend(const FineFeatures& features, const std::array<RawVec, 3>& points) {
  RawVec sum = points[0];
  for (std::size_t i = 1; i < static_cast<std::size_t>(features.count); ++i)
    sum = sum + part(points[i] - points[0], features.weight[i]);
  return sum;
}

/// Whether no vertex of the lattice's difference lies more than a step beyond the features along
/// `normal`.
bool is_supported(const LatticePair& lattice, const Simplex& simplex, const RawVec& normal,
                  Side rest) {
  const RawVec inward = truncated(rest == Side::beyond ? normal : -normal, 31);
  const RawVec extreme = least_along(lattice, inward).point;
  const std::int64_t beyond = narrow_dot(inward, simplex.vertices[0].point - extreme);
  const std::int64_t step =
      std::max({magnitude_of(inward.x), magnitude_of(inward.y), magnitude_of(inward.z)});
  return beyond <= step;
}

/// The gap whose vector from A to B is the blend of the differences. Where that is too short to
/// have a direction, or its direction does not separate as well, the lattice's stands in.
CoreGap gap_between(const FineFeatures& features, const LatticePair& lattice,
                    const Simplex& simplex, Side rest) {
  const RawVec v = blend(features, features.difference);
  const Direction d = direction(v.x, v.y, v.z);
  CoreGap gap{d.unit, static_cast<Fine>(d.length), blend(features, features.a),
              blend(features, features.b)};
  if (is_negligible(v) || !is_supported(lattice, simplex, v, rest)) {
    const RawVec along_lattice = direction_to(simplex);
    gap.normal = direction_of(along_lattice.x, along_lattice.y, along_lattice.z);
    gap.distance = std::max(Fine{0}, dot(v, gap.normal));
  }
  return gap;
}

CoreGap refine_edge(FineFeatures& features, const LatticePair& lattice, const Simplex& simplex,
                    Side rest) {
  const RawVec edge = features.difference[1] - features.difference[0];
  const Int128 square = wide_dot(edge, edge);
  if (!is_zero(square)) {
    features.weight[1] = weight_of(-wide_dot(features.difference[0], edge), square);
  }
  return gap_between(features, lattice, simplex, rest);
}

/// Weights as on the lattice, direction and distance along its normal.
CoreGap keep_lattice_triangle(FineFeatures& features, const Simplex& simplex) {
  const auto& [a, b, c, unused] = simplex.vertices;
  const TriangleWeights weights = weights_of(a.point, b.point, c.point);
  features.weight[1] = weight_of(weights.numerators[1], weights.denominator);
  features.weight[2] =
      std::min(weight_of(weights.numerators[2], weights.denominator), k_whole - features.weight[1]);
  const RawVec& n = simplex.normal;
  const Vec3<Unit> normal = direction_of(n.x, n.y, n.z);
  const Fine distance = dot(blend(features, features.difference), normal);
  return {normal, std::max(Fine{0}, distance), blend(features, features.a),
          blend(features, features.b)};
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

Fine scaled_by_ratio(Fine x, std::int64_t numerator, std::int64_t denominator) {
  return round_divide(multiply_wide(x, numerator), denominator);
}

/// Weights of the foot of the origin, by areas in the plane of the two axes that the normal is
/// least along. False when the foot is outside the triangle; then they are those of a point of it.
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

/// Whether the weighed point is as near as the foot, within 8 steps.
bool is_near(const FineFeatures& features, Fine distance, int shift) {
  const RawVec v = blend(features, features.difference);
  const auto length = static_cast<Fine>(norm(v.x, v.y, v.z));
  return length - distance <= Fine{8} << shift;
}

CoreGap refine_triangle(FineFeatures& features, const LatticePair& lattice, const Simplex& simplex,
                        Side rest) {
  const RawVec p = features.difference[1] - features.difference[0];
  const RawVec q = features.difference[2] - features.difference[0];
  const RawVec normal = truncated(wide_cross(p, q), 61);
  const auto norm_of_normal = static_cast<std::int64_t>(norm(normal.x, normal.y, normal.z));
  // Below 2^40 the norm would be coarse: nothing but a sliver is that small.
  if (norm_of_normal < std::int64_t{1} << 40 || !is_supported(lattice, simplex, normal, rest)) {
    return keep_lattice_triangle(features, simplex);
  }
  const Fine distance =
      std::max(Fine{0}, round_divide(wide_dot(normal, features.difference[0]), norm_of_normal));
  const RawVec foot{scaled_by_ratio(normal.x, distance, norm_of_normal),
                    scaled_by_ratio(normal.y, distance, norm_of_normal),
                    scaled_by_ratio(normal.z, distance, norm_of_normal)};
  if (!weigh_foot(features, foot, normal) && !is_near(features, distance, lattice.shift)) {
    return keep_lattice_triangle(features, simplex);
  }
  return {direction_of(normal.x, normal.y, normal.z), distance, blend(features, features.a),
          blend(features, features.b)};
}

}  // namespace

CoreGap refine(const FinePair& fine_pair, const LatticePair& lattice, const Simplex& simplex,
               Side rest) {
  LKS_ASSERT(simplex.count >= 1 && simplex.count <= 3);
  FineFeatures features = features_of(fine_pair, simplex);
  if (simplex.count == 3) return refine_triangle(features, lattice, simplex, rest);
  if (simplex.count == 2) return refine_edge(features, lattice, simplex, rest);
  return gap_between(features, lattice, simplex, rest);
}

}  // namespace lockstone::geometry
