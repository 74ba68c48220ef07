#include "core/geometry/contact/box/box_face.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_polygon.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"

namespace lockstone::geometry {
namespace {

using Lanes = std::array<std::int64_t, 3>;

constexpr std::array<int, 3> k_next_axis = {1, 2, 0};
constexpr std::array<int, 3> k_axis_after_next = {2, 0, 1};

/// The reference face, and the other box's axes as seen from it.
struct FaceFrame {
  const BoxPair& pair;
  const PosedShape& reference;
  const PosedShape& incident;
  int axis;
  int tangent_x;
  int tangent_y;
  int sign;  ///< of the face's outward normal
  bool of_b;
  bool flip;  ///< whether the incident box is the manifold's A
  Fine height;
  bool is_small;  ///< sizes and offset, together below 32 m
  // The lane of the incident box's axis j along the reference's axis i: step_j · j + step_i · i.
  std::array<std::int64_t, 9> lanes;
  int step_j, step_i;

  FaceFrame(const BoxPair& boxes, const FaceAxis& face, bool face_of_b, bool flip_pair)
      : pair(boxes),
        reference(face_of_b ? boxes.b : boxes.a),
        incident(face_of_b ? boxes.a : boxes.b),
        axis(face.axis),
        tangent_x(k_next_axis[static_cast<std::size_t>(face.axis)]),
        tangent_y(k_axis_after_next[static_cast<std::size_t>(face.axis)]),
        sign(face_of_b ? -face.sign : face.sign),
        of_b(face_of_b),
        flip(flip_pair != face_of_b),
        height(fine(reference.shape.size[face.axis])),
        step_j(face_of_b ? 1 : 3),
        step_i(face_of_b ? 3 : 1) {
    LKS_ASSERT(face.axis >= 0 && face.axis < 3 && (face.sign == 1 || face.sign == -1));
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3<Unit>& of_b_axis = boxes.b_in_a[j];
      lanes[3 * j] = of_b_axis.x.raw;
      lanes[3 * j + 1] = of_b_axis.y.raw;
      lanes[3 * j + 2] = of_b_axis.z.raw;
    }
    is_small = sum_of_magnitudes(boxes.offset) + sum_of_magnitudes(reference.shape.size) +
                   sum_of_magnitudes(incident.shape.size) <
               Length::from_integer(32).raw;
  }

  [[nodiscard]] std::int64_t lane(int j, int i) const {
    return lanes[static_cast<std::size_t>(step_j * j + step_i * i)];
  }
  [[nodiscard]] Lanes axis_in_frame(int j) const {
    return {lane(j, tangent_x), lane(j, tangent_y), sign * lane(j, axis)};
  }
  /// The centre of the incident box above the reference face.
  [[nodiscard]] Lanes centre_in_frame() const {
    const RawVec& c = of_b ? pair.centre_in_b : pair.centre_in_a;
    const std::int64_t to_incident = of_b ? -1 : 1;
    return {to_incident * c[tangent_x], to_incident * c[tangent_y],
            raw::subtract(to_incident * sign * c[axis], height)};
  }
};

/// The face of the incident box that is most opposed to the reference face, the first of equals.
FaceMeeting meeting_of(const FaceFrame& frame) {
  int axis = 0, sign = 1;
  std::int64_t most = -1;
  for (int j = 0; j < 3; ++j) {
    const std::int64_t lean = frame.sign * frame.lane(j, frame.axis);
    if (magnitude_of(lean) <= most) continue;
    most = magnitude_of(lean);
    axis = j;
    sign = lean > 0 ? -1 : 1;
  }
  const Vec3<Length>& size = frame.incident.shape.size;
  const int next = k_next_axis[static_cast<std::size_t>(axis)];
  const int after = k_axis_after_next[static_cast<std::size_t>(axis)];
  const auto times = [](const Lanes& direction, Length half) {
    return Lanes{direction[0] * half.raw, direction[1] * half.raw, direction[2] * half.raw};
  };
  FaceMeeting meeting{};
  meeting.normal = frame.axis_in_frame(axis);
  meeting.along_u = frame.axis_in_frame(next);
  meeting.along_v = frame.axis_in_frame(after);
  meeting.u = times(meeting.along_u, size[next]);
  meeting.v = times(meeting.along_v, size[after]);
  const Lanes out = times(meeting.normal, size[axis]), centre = frame.centre_in_frame();
  for (std::size_t k = 0; k < 3; ++k)
    meeting.middle[k] = sign < 0 ? raw::subtract(centre[k], out[k]) : raw::add(centre[k], out[k]);
  meeting.half_x = fine(frame.reference.shape.size[frame.tangent_x]);
  meeting.half_y = fine(frame.reference.shape.size[frame.tangent_y]);
  meeting.height = frame.height;
  meeting.half_n = size[axis].raw;
  meeting.half_u = size[next].raw;
  meeting.half_v = size[after].raw;
  const int reference = frame.axis * 2 + (frame.sign < 0 ? 1 : 0);
  const int incident = axis * 2 + (sign < 0 ? 1 : 0);
  meeting.common = 1 << 13 | (frame.of_b ? 1 << 12 : 0) | reference << 9 | incident << 6;
  LKS_ASSERT(meeting.half_x > 0 && meeting.half_y > 0 && meeting.height > 0);
  return meeting;
}

/// Points in the world's axes. Of small boxes coordinates are rounded to 2^-27 m first, so that
/// their products with units fit 64 bits.
class FacePoints {
 public:
  explicit FacePoints(const FaceFrame& frame)
      : frame_(frame),
        up_(signed_axis(frame.reference.rotation.column(frame.axis), frame.sign)),
        offset_(frame.of_b ? -frame.pair.offset : frame.pair.offset),
        height_(frame.height) {
    const Vec3<Unit>& x = frame.reference.rotation.column(frame.tangent_x);
    const Vec3<Unit>& y = frame.reference.rotation.column(frame.tangent_y);
    x_ = {x.x.raw, x.y.raw, x.z.raw};
    y_ = {y.x.raw, y.y.raw, y.z.raw};
    z_ = {up_.x.raw, up_.y.raw, up_.z.raw};
  }

  [[nodiscard]] const Vec3<Unit>& up() const { return up_; }

  void add(const ClipVertex& v, std::uint32_t feature, Manifold& out) const {
    if (!frame_.is_small) return add_large(v, feature, out);
    LKS_ASSERT(out.count < k_max_manifold_points);
    ManifoldPoint& point = out.points[static_cast<std::size_t>(out.count++)];
    point.separation = to_separation(v.at[2]);
    point.feature = feature;
    Vec3<Length>& on_reference = frame_.flip ? point.anchor_b : point.anchor_a;
    Vec3<Length>& on_incident = frame_.flip ? point.anchor_a : point.anchor_b;
    const RawVec beside = in_plane(v);
    if (point.separation.raw > 0) {
      place(beside, 2 * height_, {}, on_reference);
      place(beside, 2 * (height_ + v.at[2]), offset_, on_incident);
    } else {  // touching: both are the midpoint
      place(beside, 2 * height_ + v.at[2], {}, on_reference);
      on_incident.x.raw = on_reference.x.raw - offset_.x.raw;
      on_incident.y.raw = on_reference.y.raw - offset_.y.raw;
      on_incident.z.raw = on_reference.z.raw - offset_.z.raw;
    }
  }

 private:
  static constexpr int k_shift = k_fine_bits - 27;

  [[nodiscard]] RawVec in_plane(const ClipVertex& v) const {
    const std::int64_t x = raw::round_shift(v.at[0], k_shift);
    const std::int64_t y = raw::round_shift(v.at[1], k_shift);
    return {x_.x * x + y_.x * y, x_.y * x + y_.y * y, x_.z * x + y_.z * y};
  }
  /// At half of `twice_height`, as seen from `origin`. Lane by lane, for whole copies would wait.
  void place(const RawVec& beside, Fine twice_height, const Vec3<Length>& origin,
             Vec3<Length>& point) const {
    const std::int64_t height = raw::round_shift(twice_height, k_shift + 1);
    const auto lane = [&](std::int64_t along) {
      constexpr int shift = Unit::frac_bits + k_fine_per_length - k_shift;
      return static_cast<std::int32_t>(raw::round_shift(along, shift));
    };
    point.x.raw = lane(beside.x + z_.x * height) - origin.x.raw;
    point.y.raw = lane(beside.y + z_.y * height) - origin.y.raw;
    point.z.raw = lane(beside.z + z_.z * height) - origin.z.raw;
  }

  void add_large(const ClipVertex& v, std::uint32_t feature, Manifold& out) const {
    const Mat3& rotation = frame_.reference.rotation;
    const RawVec beside = along(rotation.column(frame_.tangent_x), v.at[0]) +
                          along(rotation.column(frame_.tangent_y), v.at[1]);
    const Witnesses witnesses{beside + along(up_, height_), beside + along(up_, height_ + v.at[2])};
    ManifoldPoint& point = out.points[static_cast<std::size_t>(out.count)];
    add_point(out, witnesses, offset_, v.at[2], frame_.pair.margin, feature);
    if (frame_.flip) std::swap(point.anchor_a, point.anchor_b);
  }

  const FaceFrame& frame_;
  RawVec x_, y_, z_;  ///< along the face, along it, and up; 30 fraction bits
  Vec3<Unit> up_;
  Vec3<Length> offset_;  ///< from the reference to the incident box
  Fine height_;
};

}  // namespace

bool is_of_face(std::uint32_t feature) {
  return feature >> 13 == 1;
}

bool is_of_second_face(std::uint32_t feature) {
  return feature >> 12 == 3;
}

bool face_manifold(const BoxPair& pair, const FaceAxis& face, bool of_b, bool flip, Fine wanted,
                   const HeldFeatures& held, Manifold& out) {
  const FaceFrame frame(pair, face, of_b, flip);
  const FaceMeeting meeting = meeting_of(frame);
  Clipping clipping;
  const ClipPolygon& polygon = clipping.clip(meeting);
  KeptVertices kept(polygon, pair.margin);
  out.count = 0;
  out.normal = {};
  if (kept.count > 0) {
    const FacePoints points(frame);
    const auto common = static_cast<std::uint32_t>(meeting.common);
    out.normal = unit_axis(frame.flip ? -points.up() : points.up());
    kept.sort();
    const ChosenVertices chosen(polygon, kept, common, held);
    for (std::size_t i = 0; i < chosen.count; ++i)
      points.add(*chosen.vertices[i], common | chosen.edges[i], out);
  }
  LKS_ASSERT(is_manifold(out));
  std::fill(out.points.begin() + out.count, out.points.end(), ManifoldPoint{});
  if (kept.count == 0 || wanted < 0) return false;
  if (wanted == 0) return share_vertex(polygon, meeting);
  return frame.is_small && share_ball(polygon, meeting, wanted);
}

}  // namespace lockstone::geometry
