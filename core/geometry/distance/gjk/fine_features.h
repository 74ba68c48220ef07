// The vertices of a feature in fine lanes, and their weights at the closest point.
#pragma once

#include "core/geometry/distance/gjk/closest_features.h"

namespace lockstone::geometry {

/// A weight in [0, 1], 60 fraction bits.
using Weight = std::int64_t;
inline constexpr int k_weight_bits = 60;
inline constexpr Weight k_whole = Weight{1} << k_weight_bits;

/// The features' vertices in fine lanes and their weights at the closest point. The first weight is
/// the rest to one.
struct FineFeatures {
  int count = 0;
  std::array<RawVec, 3> a{};
  std::array<RawVec, 3> b{};
  std::array<RawVec, 3> difference{};
  std::array<Weight, 3> weight{};
};

[[nodiscard]] FineFeatures features_of(const FinePair& pair, const Simplex& simplex);

/// numerator / denominator to nearest, clamped to [0, 1]; denominator > 0.
[[nodiscard]] Weight weight_of(Int128 numerator, Int128 denominator);

/// The weighed sum of points, one for each of the features.
[[nodiscard]] RawVec blend(const FineFeatures& features, const std::array<RawVec, 3>& points);

/// Weighs an edge's ends at the point nearest to the origin.
void weigh_edge(FineFeatures& features);

/// Weighs a triangle's vertices at the point of its rim that is nearest to the origin.
void weigh_rim(FineFeatures& features);

/// x · numerator / denominator.
[[nodiscard]] RawVec scaled_by_ratio(const RawVec& v, std::int64_t numerator,
                                     std::int64_t denominator);

/// Weights of the foot of the origin, by areas in the plane of the two axes that the normal is
/// least along. False when the foot is outside the triangle; then they are those of a point of it,
/// which need not be the nearest.
[[nodiscard]] bool weigh_foot(FineFeatures& features, const RawVec& foot, const RawVec& normal);

}  // namespace lockstone::geometry
