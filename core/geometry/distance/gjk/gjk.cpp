#include "core/geometry/distance/gjk/gjk.h"

#include <algorithm>
#include <tuple>

#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/cores/half_space_gap.h"
#include "core/geometry/distance/cores/rim_point_gap.h"
#include "core/geometry/distance/gjk/fine_closest.h"
#include "core/geometry/distance/gjk/taper_gap.h"

namespace lockstone {
namespace geometry {
namespace {

constexpr int k_max_iterations = 512;

auto key_of(const Vec3<Unit>& v) {
  return std::tuple(v.x, v.y, v.z);
}
auto key_of(const Vec3<Length>& v) {
  return std::tuple(v.x, v.y, v.z);
}

/// −1, 0 or 1. Without <=>, which older libraries lack for tuples.
template <class Key>
int compare_keys(const Key& a, const Key& b) {
  if (a == b) return 0;
  return a < b ? -1 : 1;
}

/// −1, 0 or 1: the order of two vertex lists.
int compare(const Polytope* a, const Polytope* b) {
  if (a == b) return 0;
  if (a == nullptr || b == nullptr) return a == nullptr ? -1 : 1;
  if (a->vertices.size() != b->vertices.size()) {
    return a->vertices.size() < b->vertices.size() ? -1 : 1;
  }
  for (std::size_t i = 0; i < a->vertices.size(); ++i) {
    const int order = compare_keys(key_of(a->vertices[i]), key_of(b->vertices[i]));
    if (order != 0) return order;
  }
  return 0;
}

auto pose_key(const PosedShape& s) {
  return std::tuple(key_of(s.rotation.x), key_of(s.rotation.y), key_of(s.rotation.z));
}

}  // namespace

bool is_exchanged(const PosedShape& a, const PosedShape& b, const RawVec& offset) {
  if (a.shape.kind != b.shape.kind) return a.shape.kind < b.shape.kind;
  const int sizes = compare_keys(key_of(a.shape.size), key_of(b.shape.size));
  if (sizes != 0) return sizes < 0;
  const int vertices = compare(a.polytope, b.polytope);
  if (vertices != 0) return vertices < 0;
  const int poses = compare_keys(pose_key(a), pose_key(b));
  if (poses != 0) return poses < 0;
  return std::tuple(offset.x, offset.y, offset.z) < std::tuple(0, 0, 0);
}

GjkResult gjk(const LatticePair& pair, const RawVec& guess) {
  GjkResult result;
  result.simplex = simplex_of(least_along(pair, guess));
  result.overlapping = result.simplex.normal == RawVec{};
  while (!result.overlapping) {
    ++result.iterations;
    LKS_ASSERT(result.iterations <= k_max_iterations);
    if (result.iterations > k_max_iterations) break;
    const DifferenceVertex next = least_along(pair, direction_to(result.simplex));
    if (!improves(result.simplex, next.point)) break;
    result.overlapping = extend(result.simplex, next);
  }
  return result;
}

bool GapQuery::find(const RawVec& offset) {
  offset_ = offset;
  const RawVec between = reference_offset(a_, b_, offset);
  const int shift = lattice_shift(a_, b_, between);
  if (is_closed_form()) {
    shift_ = lattice_.shift = shift;
    return find_in_closed_form();
  }
  if (shift != shift_) to_lattice(a_, b_, shift, lattice_);
  shift_ = shift;
  set_offset(between, lattice_);
  if (is_tapered(a_) || is_tapered(b_)) return find_taper_gap();
  if (guess_ == RawVec{}) guess_ = truncated(lattice_.offset, 31);
  if (guess_ == RawVec{}) guess_.y = 1;
  const GjkResult result = gjk(lattice_, guess_);
  simplex_ = result.simplex;
  features_ = simplex_;
  if (!result.overlapping) guess_ = direction_to(simplex_);
  if (is_coarse() && find_fine()) return true;
  if (result.overlapping) return false;
  gap_ = refine(fine_pair(), lattice_, simplex_, Side::beyond);
  if (is_coarse()) gap_.distance = 0;  // no plane separates the exact vertices: they touch
  return true;
}

/// Shapes that are apart by the exact vertices are apart, whatever the lattice says.
bool GapQuery::find_fine() {
  const FineClosest closest = fine_closest(fine_pair(), simplex_);
  if (!closest.apart) return false;
  gap_ = closest.gap;
  features_ = closest.features;
  return true;
}

bool GapQuery::find_taper_gap() {
  const TaperGap found = taper_gap(a_, b_, offset_);
  if (!found.apart) return false;
  gap_ = found.gap;
  simplex_ = features_ = found.features;
  return true;
}

bool GapQuery::find_in_closed_form() {
  if (is_tapered(a_) || is_tapered(b_)) {
    gap_ = taper_point_core_gap(a_, b_, offset_);
    simplex_ = features_ = simplex_of({gap_.on_b - gap_.on_a, 0, 0});
    return true;
  }
  const bool first = a_.rims.count != 0;
  const RimPointGap gap = rim_point_gap(first ? a_.rims : b_.rims, first ? offset_ : -offset_);
  gap_.normal = first ? gap.normal : -gap.normal;
  gap_.distance = gap.distance;
  gap_.on_a = first ? gap.on_surface : RawVec{};
  gap_.on_b = first ? offset_ : offset_ + gap.on_surface;
  simplex_ = features_ = simplex_of({gap_.on_b - gap_.on_a, 0, 0});
  return gap.distance > 0;
}

namespace {

ClosestFeature feature_of(const Simplex& simplex) {
  ClosestFeature feature;
  feature.count = simplex.count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
    feature.a[i] = simplex.vertices[i].a;
    feature.b[i] = simplex.vertices[i].b;
  }
  return feature;
}

ClosestPoints with_surfaces(const CoreGap& gap, Length radius_a, Length radius_b,
                            const RawVec& offset) {
  ClosestPoints result;
  const Fine apart = gap.distance - fine(radius_a) - fine(radius_b);
  result.overlapping = apart <= 0;
  result.distance = to_position(std::max(apart, Fine{0}));
  result.normal = gap.normal;
  const Witnesses surface = inflate(gap.on_a, radius_a, gap.on_b, radius_b, gap.normal);
  result.point_a = to_length(surface.on_a);
  result.point_b = to_length(surface.on_b - offset);
  return result;
}

ClosestPoints ordered_distance(const PosedShape& a, const PosedShape& b, const RawVec& offset) {
  GapQuery query(a, b);
  if (!query.find(offset)) {
    ClosestPoints inside;
    inside.overlapping = true;
    inside.cores_overlap = true;
    return inside;
  }
  ClosestPoints result = with_surfaces(query.gap(), query.a().radius, query.b().radius, offset);
  result.feature = feature_of(query.features());
  return result;
}

ClosestPoints half_space_distance(const PosedShape& half_space, const PosedShape& shape,
                                  const RawVec& offset) {
  const HalfSpaceGap gap = half_space_gap(half_space, shape, offset);
  ClosestPoints result;
  result.overlapping = gap.distance <= 0;
  result.distance = to_position(std::max(gap.distance, Fine{0}));
  result.normal = gap.normal;
  result.point_a = to_length(gap.on_plane);
  result.point_b = to_length(gap.on_shape);
  result.feature = {1, {}, {gap.vertex}};
  return result;
}

ClosestPoints exchanged(const ClosestPoints& points) {
  ClosestPoints result = points;
  result.normal = -points.normal;
  std::swap(result.point_a, result.point_b);
  std::swap(result.feature.a, result.feature.b);
  return result;
}

}  // namespace
}  // namespace geometry

ClosestPoints distance(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset) {
  using namespace geometry;
  const RawVec between = fine(offset);
  if (a.shape.kind == ShapeKind::half_space) return half_space_distance(a, b, between);
  if (b.shape.kind == ShapeKind::half_space) return exchanged(half_space_distance(b, a, -between));
  if (!is_exchanged(a, b, between)) return ordered_distance(a, b, between);
  return exchanged(ordered_distance(b, a, -between));
}

}  // namespace lockstone
