#include "core/geometry/box_face.h"

#include <algorithm>
#include <utility>

#include "core/geometry/box_clip.h"
#include "core/geometry/contact_point.h"
#include "core/geometry/manifold_reduction.h"
#include "core/geometry/normals.h"

namespace lockstone::geometry {
namespace {

constexpr std::array<int, 3> k_next = {1, 2, 0};
constexpr std::array<int, 3> k_after_next = {2, 0, 1};

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
        tangent_x(k_next[static_cast<std::size_t>(face.axis)]),
        tangent_y(k_after_next[static_cast<std::size_t>(face.axis)]),
        sign(face_of_b ? -face.sign : face.sign),
        of_b(face_of_b),
        flip(flip_pair != face_of_b),
        height(fine(reference.shape.size[face.axis])),
        step_j(face_of_b ? 1 : 3),
        step_i(face_of_b ? 3 : 1) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3<Unit>& of_b_axis = boxes.b_in_a[j];
      lanes[3 * j] = of_b_axis.x.raw;
      lanes[3 * j + 1] = of_b_axis.y.raw;
      lanes[3 * j + 2] = of_b_axis.z.raw;
    }
    std::int64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
      sum += magnitude_of(boxes.offset[i].raw) + reference.shape.size[i].raw +
             incident.shape.size[i].raw;
    }
    is_small = sum < Length::from_integer(32).raw;
  }

  [[nodiscard]] std::int64_t lane(int j, int i) const {
    return lanes[static_cast<std::size_t>(step_j * j + step_i * i)];
  }
  [[nodiscard]] RawVec axis_in_frame(int j) const {
    return {lane(j, tangent_x), lane(j, tangent_y), sign * lane(j, axis)};
  }
  /// The centre of the incident box above the reference face.
  [[nodiscard]] RawVec centre_in_frame() const {
    const RawVec& c = of_b ? pair.centre_in_b : pair.centre_in_a;
    const std::int64_t to_incident = of_b ? -1 : 1;
    return {to_incident * c[tangent_x], to_incident * c[tangent_y],
            raw::subtract(to_incident * sign * c[axis], height)};
  }
};

/// The incident face; the sign is that of its outward normal.
struct IncidentFace {
  int axis = 0;
  int sign = 1;
  RawVec normal{};  ///< either way, in the frame of the reference face, 30 fraction bits
  RawVec middle{};
  RawVec u{}, v{};  ///< half its edges

  explicit IncidentFace(const FaceFrame& frame) {
    std::int64_t most = -1;
    for (int j = 0; j < 3; ++j) {  // most opposed to the reference normal, the first of equals
      const std::int64_t lean = frame.sign * frame.lane(j, frame.axis);
      if (magnitude_of(lean) <= most) continue;
      most = magnitude_of(lean);
      axis = j;
      sign = lean > 0 ? -1 : 1;
    }
    const auto half_axis = [&](const RawVec& direction, int j) {
      const std::int64_t half = frame.incident.shape.size[j].raw;
      return RawVec{direction.x * half, direction.y * half, direction.z * half};
    };
    const int next = k_next[static_cast<std::size_t>(axis)];
    const int after = k_after_next[static_cast<std::size_t>(axis)];
    normal = frame.axis_in_frame(axis);
    const RawVec out = half_axis(normal, axis);
    middle = sign < 0 ? frame.centre_in_frame() - out : frame.centre_in_frame() + out;
    u = half_axis(frame.axis_in_frame(next), next);
    v = half_axis(frame.axis_in_frame(after), after);
  }

  [[nodiscard]] std::uint32_t index() const {
    return static_cast<std::uint32_t>(axis * 2 + (sign < 0 ? 1 : 0));
  }
  /// Its corners in order, exact.
  void fill(ClipPolygon& polygon) const {
    const RawVec one = middle + u, other = middle - u;
    const auto corner = [](const RawVec& at, std::uint32_t edge) {
      return ClipVertex{{at.x, at.y, at.z}, edge};
    };
    polygon.vertices[0] = corner(one + v, 0);
    polygon.vertices[1] = corner(other + v, 1);
    polygon.vertices[2] = corner(other - v, 2);
    polygon.vertices[3] = corner(one - v, 3);
    polygon.count = 4;
  }
  /// Whether a slab across a lane holds all corners.
  template <std::size_t Axis>
  [[nodiscard]] bool is_within(const Slab<Axis>& slab, Fine RawVec::*lane) const {
    const Fine reach = magnitude_of(u.*lane) + magnitude_of(v.*lane);
    return slab.holds(middle.*lane - reach, middle.*lane + reach);
  }
  /// Vertices may be taken to be on a side unless the face is steep across it.
  [[nodiscard]] Fine snap_across(std::int64_t lean) const {
    return 16 * magnitude_of(lean) <= magnitude_of(normal.z) ? k_snap : 0;
  }
};

/// Two polygons, one of which holds what is left of the incident face.
struct Clipping {
  ClipPolygon polygons[2];

  const ClipPolygon& clip(const FaceFrame& frame, const IncidentFace& face) {
    const Vec3<Length>& half = frame.reference.shape.size;
    face.fill(polygons[0]);
    std::size_t used = 0;
    const Slab<0> across_x{fine(half[frame.tangent_x]), face.snap_across(face.normal.x)};
    if (!face.is_within(across_x, &RawVec::x)) {
      across_x.clip(polygons[0], polygons[1]);
      if (polygons[1].count == 0) return polygons[1];
      used = 1;
    }
    const Slab<1> across_y{fine(half[frame.tangent_y]), face.snap_across(face.normal.y)};
    if (!face.is_within(across_y, &RawVec::y)) {
      across_y.clip(polygons[used], polygons[1 - used]);
      used = 1 - used;
    }
    return polygons[used];
  }
};

/// Whether a vertex is neither above the face nor beyond its sides; so shallow, it is above the
/// opposite face.
bool share_vertex(const ClipPolygon& polygon, const FaceFrame& frame) {
  const Fine half_x = fine(frame.reference.shape.size[frame.tangent_x]);
  const Fine half_y = fine(frame.reference.shape.size[frame.tangent_y]);
  for (int i = 0; i < polygon.count; ++i) {
    const std::array<Fine, 3>& at = polygon[i].at;
    if (at[2] <= 0 && magnitude_of(at[0]) <= half_x && magnitude_of(at[1]) <= half_y) return true;
  }
  return false;
}

/// Whether a ball of this diameter fits into both boxes about a point: the mean of the vertices,
/// raised by half its depth. Sums instead of means, in 2^-24 m; of small boxes only.
bool share_ball(const ClipPolygon& polygon, const FaceFrame& frame, const IncidentFace& face,
                Fine diameter) {
  constexpr int shift = k_fine_bits - 24;
  const std::int64_t radius = (diameter >> (shift + 1)) + 1;
  const std::int64_t count = polygon.count;
  std::int64_t x = 0, y = 0, z = 0;
  for (int i = 0; i < polygon.count; ++i) {
    x += polygon[i].at[0] >> shift;
    y += polygon[i].at[1] >> shift;
    z += polygon[i].at[2] >> shift;
  }
  const auto least = [&](Length half) { return count * ((std::int64_t{half.raw} << 4) - radius); };
  const Vec3<Length>& half = frame.reference.shape.size;
  const Vec3<Length>& other = frame.incident.shape.size;
  const std::int64_t rise = -z / 2;
  if (magnitude_of(x) > least(half[frame.tangent_x])) return false;
  if (magnitude_of(y) > least(half[frame.tangent_y])) return false;
  if (rise > least(half[frame.axis]) || rise > least(other[face.axis])) return false;
  if (((rise * magnitude_of(face.normal.z)) >> Unit::frac_bits) < count * radius) return false;
  x -= count * (face.middle.x >> shift);
  y -= count * (face.middle.y >> shift);
  z += rise - count * (face.middle.z >> shift);
  const auto is_beside = [&](int axis) {
    const RawVec n = frame.axis_in_frame(axis);
    const std::int64_t along = (n.x * x + n.y * y + n.z * z) >> Unit::frac_bits;
    return magnitude_of(along) > least(other[axis]);
  };
  return !is_beside(k_next[static_cast<std::size_t>(face.axis)]) &&
         !is_beside(k_after_next[static_cast<std::size_t>(face.axis)]);
}

/// What all vertices' names share: kind, which box, which of its faces, the incident face.
std::uint32_t common_feature(const FaceFrame& frame, const IncidentFace& face) {
  const auto reference = static_cast<std::uint32_t>(frame.axis * 2 + (frame.sign < 0 ? 1 : 0));
  return 1U << 13 | (frame.of_b ? 1U << 12 : 0U) | reference << 9 | face.index() << 6;
}

/// The vertices that `keeps` admits, each named by the two edges that meet in it.
struct KeptVertices {
  static constexpr std::uint32_t k_none = ~std::uint32_t{0};

  std::array<std::uint32_t, ClipPolygon::k_capacity> keys;  ///< edges · 8 + index in the polygon
  int count = 0;

  KeptVertices(const ClipPolygon& polygon, Length margin) {
    keys[0] = keys[1] = keys[2] = keys[3] = k_none;
    if (polygon.count == 0) return;
    std::uint32_t edge_in = polygon[polygon.count - 1].edge;
    for (int i = 0; i < polygon.count; ++i) {
      const ClipVertex& v = polygon[i];
      keys[static_cast<std::size_t>(count)] =
          edge_in << 6 | v.edge << 3 | static_cast<std::uint32_t>(i);
      count += keeps(v.at[2], margin) ? 1 : 0;
      edge_in = v.edge;
    }
    if (count < 4) keys[static_cast<std::size_t>(count)] = k_none;
  }

  void sort() {
    if (count > 4) return sort_few(std::span(keys).first(static_cast<std::size_t>(count)));
    const auto order = [&](std::size_t i, std::size_t j) {
      const std::uint32_t low = std::min(keys[i], keys[j]);
      keys[j] = std::max(keys[i], keys[j]);
      keys[i] = low;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
  }
  [[nodiscard]] const ClipVertex& vertex(const ClipPolygon& polygon, std::size_t i) const {
    return polygon[static_cast<int>(keys[i] & 7)];
  }
  /// Of sorted ones: whether two have one name.
  [[nodiscard]] bool repeats() const {
    bool found = false;
    for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(count); ++i)
      found = found || keys[i] >> 3 == keys[i + 1] >> 3;
    return found;
  }
};

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

/// The vertices of a manifold: all when they are no more than four and each has a name of its own,
/// else as reduced.
struct ChosenVertices {
  std::array<const ClipVertex*, 4> vertices;
  std::array<std::uint32_t, 4> edges;  ///< the two that meet, see KeptVertices
  std::size_t count;
  std::array<ClipVertex, 4> reduced;

  ChosenVertices(const ClipPolygon& polygon, const KeptVertices& kept)
      : count(static_cast<std::size_t>(kept.count)) {
    if (kept.count > 4 || kept.repeats()) {
      reduce(polygon, kept);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      vertices[i] = &kept.vertex(polygon, i);
      edges[i] = kept.keys[i] >> 3;
    }
  }
  ChosenVertices(const ChosenVertices&) = delete;
  ChosenVertices& operator=(const ChosenVertices&) = delete;

 private:
  void reduce(const ClipPolygon& polygon, const KeptVertices& kept) {
    std::array<FaceVertex, ClipPolygon::k_capacity> faces;
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<Fine, 3>& at = kept.vertex(polygon, i).at;
      faces[i] = {at[0], at[1], at[2], kept.keys[i] >> 3};
    }
    const auto all = std::span(faces).first(count);
    count =
        static_cast<std::size_t>(kept.repeats() ? reduce_to_four(all, k_fine_per_length)
                                                : reduce_sorted_to_four(all, k_fine_per_length));
    for (std::size_t i = 0; i < count; ++i) {
      reduced[i] = {{faces[i].x, faces[i].y, faces[i].z}, 0};
      vertices[i] = &reduced[i];
      edges[i] = faces[i].feature;
    }
  }
};

}  // namespace

bool face_manifold(const BoxPair& pair, const FaceAxis& face, bool of_b, bool flip, Fine wanted,
                   Manifold& out) {
  const FaceFrame frame(pair, face, of_b, flip);
  const IncidentFace incident(frame);
  Clipping clipping;
  const ClipPolygon& polygon = clipping.clip(frame, incident);
  KeptVertices kept(polygon, pair.margin);
  out.count = 0;
  out.normal = {};
  if (kept.count > 0) {
    const FacePoints points(frame);
    const std::uint32_t common = common_feature(frame, incident);
    out.normal = unit_axis(frame.flip ? -points.up() : points.up());
    kept.sort();
    const ChosenVertices chosen(polygon, kept);
    for (std::size_t i = 0; i < chosen.count; ++i)
      points.add(*chosen.vertices[i], common | chosen.edges[i], out);
  }
  std::fill(out.points.begin() + out.count, out.points.end(), ManifoldPoint{});
  if (kept.count == 0 || wanted < 0) return false;
  if (wanted == 0) return share_vertex(polygon, frame);
  return frame.is_small && share_ball(polygon, frame, incident, wanted);
}

}  // namespace lockstone::geometry
