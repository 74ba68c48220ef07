// A box's face clipped to the sides of another box's face, as far as points come of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_clip.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"
#include "core/geometry/distance/contact_point.h"
#include "core/kernels/box/box_block.h"

namespace lockstone::geometry {

using lanes::FaceMeeting;

/// Two polygons, one of which holds the clipped incident face.
struct Clipping {
  ClipPolygon polygons[2];

  const ClipPolygon& clip(const FaceMeeting& face) {
    LKS_ASSERT(face.half_x > 0 && face.half_y > 0);
    fill_corners(face);
    std::size_t used = 0;
    const Slab<0> across_x{face.half_x, snap_across(face, 0)};
    if (!is_within(face, across_x)) {
      across_x.clip(polygons[0], polygons[1]);
      if (polygons[1].count == 0) return polygons[1];
      used = 1;
    }
    const Slab<1> across_y{face.half_y, snap_across(face, 1)};
    if (!is_within(face, across_y)) {
      across_y.clip(polygons[used], polygons[1 - used]);
      used = 1 - used;
    }
    return polygons[used];
  }

 private:
  /// In order, exact.
  void fill_corners(const FaceMeeting& face) {
    const auto set = [&](std::size_t i, std::int64_t along_u, std::int64_t along_v) {
      ClipVertex& corner = polygons[0].vertices[i];
      for (std::size_t k = 0; k < 3; ++k)
        corner.at[k] = face.middle[k] + along_u * face.u[k] + along_v * face.v[k];
      corner.edge = static_cast<std::uint32_t>(i);
    };
    set(0, 1, 1);
    set(1, -1, 1);
    set(2, -1, -1);
    set(3, 1, -1);
    polygons[0].count = 4;
  }
  /// Whether a slab across a lane holds all corners.
  template <std::size_t Axis>
  static bool is_within(const FaceMeeting& face, const Slab<Axis>& slab) {
    const Fine reach = magnitude_of(face.u[Axis]) + magnitude_of(face.v[Axis]);
    return slab.holds(face.middle[Axis] - reach, face.middle[Axis] + reach);
  }
  /// Vertices may be taken to be on a side unless the face is steep across it.
  static Fine snap_across(const FaceMeeting& face, std::size_t axis) {
    return 16 * magnitude_of(face.normal[axis]) <= magnitude_of(face.normal[2]) ? k_snap : 0;
  }
};

/// Whether a vertex is neither above the face nor beyond its sides; so shallow, it is above the
/// opposite face.
[[nodiscard]] inline bool share_vertex(const ClipPolygon& polygon, const FaceMeeting& face) {
  for (int i = 0; i < polygon.count; ++i) {
    const std::array<Fine, 3>& at = polygon[i].at;
    if (at[2] <= 0 && magnitude_of(at[0]) <= face.half_x && magnitude_of(at[1]) <= face.half_y)
      return true;
  }
  return false;
}

/// Whether a ball fits into both boxes about a point of the incident face raised by half its depth.
/// The point times `weight`, and the radius: in 2^-24 m, of boxes below 32 m.
[[nodiscard]] inline bool holds_ball(const FaceMeeting& face, std::int64_t x, std::int64_t y,
                                     std::int64_t z, std::int64_t weight, std::int64_t radius) {
  LKS_ASSERT(weight > 0 && radius > 0);
  constexpr int shift = k_fine_bits - 24;
  const auto least = [&](std::int64_t half) { return weight * (half - radius); };
  const std::int64_t rise = -z / 2;
  if (((rise * magnitude_of(face.normal[2])) >> Unit::frac_bits) < weight * radius) return false;
  if (magnitude_of(x) > least(face.half_x >> shift)) return false;
  if (magnitude_of(y) > least(face.half_y >> shift)) return false;
  if (rise > least(face.height >> shift) || rise > least(face.half_n << 4)) return false;
  x -= weight * (face.middle[0] >> shift);
  y -= weight * (face.middle[1] >> shift);
  z += rise - weight * (face.middle[2] >> shift);
  const auto is_beside = [&](const std::array<std::int64_t, 3>& n, std::int64_t half) {
    const std::int64_t along = (n[0] * x + n[1] * y + n[2] * z) >> Unit::frac_bits;
    return magnitude_of(along) > least(half << 4);
  };
  return !is_beside(face.along_u, face.half_u) && !is_beside(face.along_v, face.half_v);
}

/// Whether a ball of this diameter fits into both boxes: about the mean of the vertices, or an
/// eighth of the way to it from the deepest of them. Of boxes below 32 m only.
[[nodiscard]] inline bool share_ball(const ClipPolygon& polygon, const FaceMeeting& face,
                                     Fine diameter) {
  LKS_ASSERT(polygon.count > 0 && diameter > 0);
  constexpr int shift = k_fine_bits - 24;
  const std::int64_t radius = (diameter >> (shift + 1)) + 1;
  const std::int64_t count = polygon.count;
  std::int64_t x = 0, y = 0, z = 0;
  int deepest = 0;
  for (int i = 0; i < polygon.count; ++i) {
    x += polygon[i].at[0] >> shift;
    y += polygon[i].at[1] >> shift;
    z += polygon[i].at[2] >> shift;
    if (polygon[i].at[2] < polygon[deepest].at[2]) deepest = i;
  }
  if (holds_ball(face, x, y, z, count, radius)) return true;
  const std::array<Fine, 3>& at = polygon[deepest].at;
  const auto nearly = [&](std::int64_t sum, Fine lane) {
    return (sum + 7 * count * (lane >> shift)) >> 3;
  };
  return holds_ball(face, nearly(x, at[0]), nearly(y, at[1]), nearly(z, at[2]), count, radius);
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
    LKS_ASSERT(count <= polygon.count);
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

/// The vertices of a manifold: all when they are no more than four and each has a name of its own,
/// else as reduced.
struct ChosenVertices {
  std::array<const ClipVertex*, 4> vertices;
  std::array<std::uint32_t, 4> edges;  ///< the two that meet, see KeptVertices
  std::size_t count;
  std::array<ClipVertex, 4> reduced;

  /// `common`: the part of the features that names the faces.
  ChosenVertices(const ClipPolygon& polygon, const KeptVertices& kept, std::uint32_t common,
                 const HeldFeatures& held)
      : count(static_cast<std::size_t>(kept.count)) {
    if (kept.count > 4 || kept.repeats()) {
      reduce(polygon, kept, common, held);
      return;
    }
    LKS_ASSERT(count > 0);
    for (std::size_t i = 0; i < count; ++i) {
      vertices[i] = &kept.vertex(polygon, i);
      edges[i] = kept.keys[i] >> 3;
    }
  }
  ChosenVertices(const ChosenVertices&) = delete;
  ChosenVertices& operator=(const ChosenVertices&) = delete;

 private:
  static constexpr std::uint32_t k_edge_pair = 63;

  void reduce(const ClipPolygon& polygon, const KeptVertices& kept, std::uint32_t common,
              const HeldFeatures& held) {
    std::array<FaceVertex, ClipPolygon::k_capacity> faces;
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<Fine, 3>& at = kept.vertex(polygon, i).at;
      faces[i] = {at[0], at[1], at[2], common | kept.keys[i] >> 3};
    }
    const auto all = std::span(faces).first(count);
    count = static_cast<std::size_t>(kept.repeats()
                                         ? reduce_to_four(all, k_fine_per_length)
                                         : reduce_sorted_to_four(all, k_fine_per_length, held));
    LKS_ASSERT(count > 0 && count <= k_max_manifold_points);
    for (std::size_t i = 0; i < count; ++i) {
      reduced[i] = {{faces[i].x, faces[i].y, faces[i].z}, 0};
      vertices[i] = &reduced[i];
      edges[i] = faces[i].feature & k_edge_pair;
    }
  }
};

}  // namespace lockstone::geometry
