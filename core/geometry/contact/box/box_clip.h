// A face of a box clipped to the slabs of another face: Sutherland and Hodgman, Reentrant polygon
// clipping, with both sides of a slab at once.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// A vertex in the frame of the reference face, x and y along it, z the height above it, with the
/// label of the edge that leaves it: 0 … 3 of the incident face, 4 … 7 the sides +x, −x, +y, −y of
/// the reference face.
struct ClipVertex {
  // No initialisers: a polygon holds eight, and mostly uses four.
  std::array<Fine, 3> at;
  std::uint32_t edge;
};

/// Convex, in order. Vertices that do not fit are left out: a quadrilateral gives no more than
/// eight.
struct ClipPolygon {
  static constexpr int k_capacity = 8;

  std::array<ClipVertex, k_capacity> vertices;
  int count;

  void add(const ClipVertex& v) {
    if (count < k_capacity) vertices[static_cast<std::size_t>(count++)] = v;
  }
  void leave_by(std::uint32_t edge) { vertices[static_cast<std::size_t>(count - 1)].edge = edge; }
  [[nodiscard]] const ClipVertex& operator[](int i) const {
    return vertices[static_cast<std::size_t>(i)];
  }
};

/// depth / (depth + excess) with 32 fraction bits, at most 1; error < 2^-30. Both are positive, and
/// the sum fits 64 bits.
[[nodiscard]] constexpr std::uint64_t cut_share(Fine depth, Fine excess) {
  const auto inside = static_cast<std::uint64_t>(depth);
  const std::uint64_t whole = inside + static_cast<std::uint64_t>(excess);
  const int lead = std::countl_zero(whole);
  return (((inside << lead) >> 32) << 32) / ((whole << lead) >> 32);
}

/// rise · share for a share with 32 fraction bits, to nearest, ties away from zero.
[[nodiscard]] constexpr Fine part_of(Fine rise, std::uint64_t share) {
  const auto sign = static_cast<std::uint64_t>(rise >> 63);
  const std::uint64_t size = (static_cast<std::uint64_t>(rise) ^ sign) - sign;
  const std::uint64_t low = ((size & 0xffffffffU) * share + 0x80000000U) >> 32;
  const std::uint64_t part = (size >> 32) * share + low;
  return static_cast<Fine>((part ^ sign) - sign);
}

/// Between two opposite sides of the reference face: |at[Axis]| ≤ half.
template <std::size_t Axis>
struct Slab {
  static constexpr std::size_t k_beside = 1 - Axis;

  Fine half;
  Fine snap;  ///< how far beyond counts as on a side: of a polygon that reaches inside it

  /// Whether all of a polygon between these two lanes is within.
  [[nodiscard]] bool holds(Fine least, Fine most) const {
    return most <= high_end(least) && least >= -low_end(most);
  }

  /// The part of the polygon that is within.
  void clip(const ClipPolygon& polygon, ClipPolygon& result) const {
    LKS_ASSERT(polygon.count > 0 && half > 0);
    Fine least = polygon[0].at[Axis], most = least;
    for (int i = 1; i < polygon.count; ++i) {
      least = std::min(least, polygon[i].at[Axis]);
      most = std::max(most, polygon[i].at[Axis]);
    }
    result.count = 0;
    if (least > half || most < -half) return;
    const Ends ends{high_end(least), -low_end(most)};
    int start = ends.beyond(polygon[0].at[Axis]);
    for (int i = 0; i < polygon.count; ++i) {
      const ClipVertex& from = polygon[i];
      const ClipVertex& to = polygon[i + 1 < polygon.count ? i + 1 : 0];
      const int end = ends.beyond(to.at[Axis]);
      if (start == 0) result.add(from);
      if (start != end) cross_sides(from, start, to, end, result);
      start = end;
    }
  }

 private:
  struct Ends {
    Fine high;
    Fine low;

    /// The side that a lane is beyond: 1 or −1, 0 for none.
    [[nodiscard]] int beyond(Fine x) const { return (x > high ? 1 : 0) - (x < low ? 1 : 0); }
  };

  // A polygon wholly outside a side stays outside.
  [[nodiscard]] Fine high_end(Fine least) const { return least < half ? half + snap : half; }
  [[nodiscard]] Fine low_end(Fine most) const { return most > -half ? half + snap : half; }

  /// How far inside the side a vertex is.
  [[nodiscard]] Fine depth(int side, const ClipVertex& v) const {
    return side > 0 ? raw::subtract(half, v.at[Axis]) : raw::add(half, v.at[Axis]);
  }
  static std::uint32_t label(int side) { return (Axis == 0 ? 4U : 6U) + (side > 0 ? 0U : 1U); }

  /// Of an edge that comes in, or goes out: the point on the side, unless it begins or ends there.
  void cross_sides(const ClipVertex& from, int start, const ClipVertex& to, int end,
                   ClipPolygon& result) const {
    if (start != 0 && depth(start, to) > 0) add_cut(to, from, start, from.edge, result);
    if (end == 0) return;
    if (depth(end, from) > 0) add_cut(from, to, end, 0, result);
    if (result.count > 0) result.leave_by(label(end));
  }

  /// Where the edge between a vertex inside a side and one outside crosses it, measured from the
  /// inside.
  void add_cut(const ClipVertex& inside, const ClipVertex& outside, int side, std::uint32_t edge,
               ClipPolygon& result) const {
    LKS_ASSERT(side == 1 || side == -1);
    const std::uint64_t share = cut_share(depth(side, inside), -depth(side, outside));
    LKS_ASSERT(share <= std::uint64_t{1} << 32);
    const auto cut = [&](std::size_t axis) {
      return inside.at[axis] + part_of(raw::subtract(outside.at[axis], inside.at[axis]), share);
    };
    ClipVertex v;
    v.at[Axis] = side > 0 ? half : -half;
    v.at[k_beside] = cut(k_beside);
    v.at[2] = cut(2);
    v.edge = edge;
    result.add(v);
  }
};

}  // namespace lockstone::geometry
