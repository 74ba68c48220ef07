#include "core/geometry/contact/box/box_batch.h"

#include <algorithm>
#include <cstring>

#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_polygon.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/numeric/normals.h"

namespace lockstone::geometry {
namespace {

void copy(const Mat3& from, std::array<std::int32_t, 9>& to) {
  static_assert(sizeof(Mat3) == 9 * sizeof(std::int32_t));
  std::memcpy(to.data(), &from, sizeof from);
}

void copy(const Vec3<Length>& from, std::array<std::int32_t, 3>& to) {
  to = {from.x.raw, from.y.raw, from.z.raw};
}

Mat3 rotation_of(const std::array<std::int32_t, 9>& axes) {
  Mat3 rotation;
  std::memcpy(static_cast<void*>(&rotation), axes.data(), sizeof rotation);
  return rotation;
}

Vec3<Length> lengths_of(const std::array<std::int32_t, 3>& v) {
  return {Length::from_raw(v[0]), Length::from_raw(v[1]), Length::from_raw(v[2])};
}

Shape box_of(const std::array<std::int32_t, 3>& half) {
  const Vec3<Length> size = lengths_of(half);
  return Shape::box(size.x, size.y, size.z);
}

/// Whether the deepest point is as deep as the face says: see `attains`.
bool reaches(const lanes::FourPoints& points, std::size_t count, Fine separation) {
  const Displacement least = to_separation(separation - k_agreement);
  const Displacement most = to_separation(separation + k_face_slack);
  Displacement deepest = to_separation(points[0].z);
  for (std::size_t i = 1; i < count; ++i)
    deepest = min(deepest, to_separation(points[i].z));
  return deepest >= least && deepest <= most;
}

/// Whether the boxes are known to overlap along every axis by so much that no edge is taken; as
/// `collide_boxes` asks.
bool rules_out_edges(const ClipPolygon& polygon, const FaceMeeting& face) {
  const Fine threshold = std::min(edge_threshold(face.separation), Fine{0});
  if (threshold == 0) return share_vertex(polygon, face);
  return share_ball(polygon, face, -threshold + k_agreement);
}

}  // namespace

bool BoxBatch::takes(const Shape& a, const Shape& b, const Vec3<Length>& offset) {
  return a.kind == ShapeKind::box && b.kind == ShapeKind::box &&
         sum_of_magnitudes(a.size) + sum_of_magnitudes(b.size) + sum_of_magnitudes(offset) <
             Length::from_integer(16).raw;
}

void BoxBatch::add(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                   Length margin, const HeldFeatures& held) {
  LKS_ASSERT(size_ < k_capacity && takes(a.shape, b.shape, offset));
  const bool flip = box_belongs_first(b, a, offset);
  const PosedShape& first = flip ? b : a;
  const PosedShape& second = flip ? a : b;
  lanes::BoxSource& source = sources_[size_];
  copy(first.rotation, source.axes_a);
  copy(second.rotation, source.axes_b);
  copy(first.shape.size, source.half_a);
  copy(second.shape.size, source.half_b);
  copy(flip ? -offset : offset, source.offset);
  source.margin = margin.raw;
  flips_[size_] = flip ? 1 : 0;
  held_[size_] = held;
  ++size_;
}

void BoxBatch::collide() {
  const lanes::BoxKernels& kernels = lanes::box_kernels();
  kernels.meet(sources_.data(), meetings_.data());
  for (std::size_t i = 0; i < size_; ++i)
    stages_[i] = settle(i);
  kernels.place(meetings_.data(), points_.data(), swapped_.data(), placed_.data());
}

BoxBatch::Stage BoxBatch::settle(std::size_t pair) {
  LKS_ASSERT(pair < size_);
  const FaceMeeting& face = meetings_[pair];
  lanes::FourPoints& points = points_[pair];
  counts_[pair] = 0;
  if (face.is_apart != 0) return Stage::nothing;
  const bool apart = face.separation > 0;
  const std::uint32_t held = held_[pair].first();
  const bool of_b = (face.common >> 12 & 1) != 0;
  if (!apart && is_of_face(held) && is_of_second_face(held) != of_b) return Stage::nothing;
  swapped_[pair] = flips_[pair] ^ (of_b ? 1 : 0);
  Clipping clipping;
  const ClipPolygon& polygon = clipping.clip(face);
  KeptVertices kept(polygon, Length::from_raw(sources_[pair].margin));
  if (kept.count == 0) return Stage::on_reference;
  kept.sort();
  const ChosenVertices chosen(polygon, kept, static_cast<std::uint32_t>(face.common), held_[pair]);
  for (std::size_t i = 0; i < chosen.count; ++i) {
    const ClipVertex& v = *chosen.vertices[i];
    points[i] = {v.at[0], v.at[1], v.at[2], face.common | chosen.edges[i]};
  }
  LKS_ASSERT(chosen.count > 0 && chosen.count <= k_max_manifold_points);
  counts_[pair] = static_cast<std::uint8_t>(chosen.count);
  const bool is_settled = apart ? reaches(points, chosen.count, face.separation)
                                : face.is_shallow != 0 && rules_out_edges(polygon, face);
  return is_settled ? Stage::settled : Stage::on_reference;
}

void BoxBatch::write(std::size_t pair, Manifold& out) const {
  LKS_ASSERT(pair < size_);
  if (stages_[pair] != Stage::nothing) write_reference(pair, out);
  if (stages_[pair] != Stage::settled) finish(pair, out);
}

void BoxBatch::finish(std::size_t pair, Manifold& out) const {
  LKS_ASSERT(stages_[pair] != Stage::settled);
  const lanes::BoxSource& source = sources_[pair];
  const Mat3 rotation_a = rotation_of(source.axes_a), rotation_b = rotation_of(source.axes_b);
  const Shape shape_a = box_of(source.half_a), shape_b = box_of(source.half_b);
  const auto go_on = stages_[pair] == Stage::nothing ? collide_boxes : collide_boxes_beyond;
  go_on({shape_a, rotation_a}, {shape_b, rotation_b}, lengths_of(source.offset),
        Length::from_raw(source.margin), flips_[pair] != 0, held_[pair], out);
}

void BoxBatch::write_reference(std::size_t pair, Manifold& out) const {
  LKS_ASSERT(counts_[pair] <= k_max_manifold_points);
  const std::array<std::int64_t, 6>& axes = meetings_[pair].axes;
  const auto low = [](std::int64_t x) { return Unit::from_raw(static_cast<std::int32_t>(x)); };
  const Vec3<Unit> up{low(axes[3]), low(axes[3] >> 32), low(axes[4])};
  out.normal = counts_[pair] == 0 ? Vec3<Unit>{} : unit_axis(swapped_[pair] != 0 ? -up : up);
  out.count = counts_[pair];
  for (std::size_t i = 0; i < k_max_manifold_points; ++i) {
    static_assert(sizeof(ManifoldPoint) == sizeof(lanes::PlacedPoint));
    if (i < counts_[pair])
      std::memcpy(static_cast<void*>(&out.points[i]), &placed_[pair][i], sizeof(ManifoldPoint));
    else
      out.points[i] = {};
  }
}

}  // namespace lockstone::geometry
