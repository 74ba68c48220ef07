#include "core/geometry/distance/gjk/closest_features.h"

#include "core/geometry/distance/gjk/fine_features.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

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

/// The weights that an edge's ends have on the lattice: there the foot lies along the normal, and
/// in fine lanes so within the few steps that the lattice moves a vertex by.
void weigh_edge_as_on_lattice(FineFeatures& features, const Simplex& simplex) {
  const RawVec& from = simplex.vertices[0].point;
  const RawVec edge = simplex.vertices[1].point - from;
  const Int128 square = wide_dot(edge, edge);
  if (!is_zero(square)) features.weight[1] = weight_of(-wide_dot(from, edge), square);
}

/// The gap whose vector from A to B is the blend of the differences. Where that is too short to
/// have a direction, or its direction does not separate as well, the lattice's stands in, with the
/// points that lie along it.
CoreGap gap_between(FineFeatures& features, const LatticePair& lattice, const Simplex& simplex,
                    Side rest) {
  const RawVec v = blend(features, features.difference);
  if (!is_negligible(v) && is_supported(lattice, simplex, v, rest)) {
    const Direction d = direction(v.x, v.y, v.z);
    return {d.unit, static_cast<Fine>(d.length), blend(features, features.a),
            blend(features, features.b)};
  }
  if (simplex.count == 2) weigh_edge_as_on_lattice(features, simplex);
  const RawVec along_lattice = direction_to(simplex);
  const Vec3<Unit> normal = direction_of(along_lattice.x, along_lattice.y, along_lattice.z);
  const Fine distance = dot(blend(features, features.difference), normal);
  return {normal, std::max(Fine{0}, distance), blend(features, features.a),
          blend(features, features.b)};
}

CoreGap refine_edge(FineFeatures& features, const LatticePair& lattice, const Simplex& simplex,
                    Side rest) {
  weigh_edge(features);
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

/// Whether the weighed point is within 8 steps of the foot.
bool is_near(const FineFeatures& features, const RawVec& foot, int shift) {
  const RawVec aside = blend(features, features.difference) - foot;
  return norm(aside.x, aside.y, aside.z) <= std::uint64_t{8} << shift;
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
  const RawVec foot = scaled_by_ratio(normal, distance, norm_of_normal);
  if (!weigh_foot(features, foot, normal)) {
    weigh_rim(features);
    if (!is_near(features, foot, lattice.shift)) return keep_lattice_triangle(features, simplex);
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
