#include "core/geometry/contact/feature/clip_feature.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/geometry/numeric/normals.h"
#include "core/math/int128.h"

namespace lockstone::geometry {
namespace {

constexpr std::uint32_t k_side = std::uint32_t{1} << 8;  ///< an edge that is a side of the face

/// A vertex with the edge that leaves it: of the clipped feature, or a side of the face.
struct CutVertex {
  std::int64_t x;  ///< 30 bits
  std::int64_t y;
  Fine z;
  std::uint32_t id;
  std::uint32_t edge;
};

struct CutCorner {
  std::int64_t x;
  std::int64_t y;
};

/// At most all edges of the feature and one vertex a side.
using CutPolygon = std::array<CutVertex, k_most_reduced>;

/// Where the segment from v to w crosses a line; heights above the line have different signs.
CutVertex crossing(const CutVertex& v, const CutVertex& w, std::int64_t height_v,
                   std::int64_t height_w) {
  const std::int64_t whole = height_v - height_w;
  const auto part = [&](std::int64_t from, std::int64_t to) {
    const Int128 step = multiply_wide(to - from, height_v);
    return from + (whole < 0 ? round_divide(-step, -whole) : round_divide(step, whole));
  };
  return {part(v.x, w.x), part(v.y, w.y), part(v.z, w.z), 0, 0};
}

class Clipper {
 public:
  Clipper(CutPolygon& polygon, int count) : polygon_(polygon), count_(count) {}

  /// Keeps the part to the left of the line from p to q.
  void cut(const CutCorner& p, const CutCorner& q, std::uint32_t side) {
    const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
    if (dx == 0 && dy == 0) return;
    const auto height = [&](const CutVertex& v) { return dx * (v.y - p.y) - dy * (v.x - p.x); };
    LKS_ASSERT(count_ <= static_cast<int>(polygon_.size()));
    CutPolygon before;
    std::copy_n(polygon_.begin(), count_, before.begin());
    const int count = count_;
    count_ = 0;
    const int edges =
        count == 2 ? 1 : count;  // a segment has one, and that of a point is never cut
    for (int i = 0; i < count; ++i) {
      const CutVertex& v = before[static_cast<std::size_t>(i)];
      const CutVertex& w = before[static_cast<std::size_t>(i + 1 < count ? i + 1 : 0)];
      const std::int64_t height_v = height(v), height_w = height(w);
      if (height_v >= 0) add(v);
      if (i >= edges || (height_v >= 0) == (height_w >= 0)) continue;
      CutVertex at = crossing(v, w, height_v, height_w);
      at.id = k_crossing | v.edge << 9 | side;
      at.edge = height_v >= 0 ? k_side | side : v.edge;
      add(at);
    }
  }

  [[nodiscard]] int count() const { return count_; }

 private:
  void add(const CutVertex& vertex) {
    LKS_ASSERT(count_ < static_cast<int>(k_most_reduced));
    polygon_[static_cast<std::size_t>(count_++)] = vertex;
  }

  CutPolygon& polygon_;
  int count_;
};

std::int64_t greatest(const RawVec& v, std::int64_t most) {
  return std::max({most, magnitude_of(v.x), magnitude_of(v.y), magnitude_of(v.z)});
}

}  // namespace

ClipFrame frame_on(const ContactFeature& face) {
  const RawVec origin = face.points[0].at + along(face.normal, face.radius);
  ClipFrame frame{origin, perpendicular_to(face.normal), {}, face.normal};
  frame.v = rounded<Unit>(cross(face.normal, frame.u));
  return frame;
}

void clip(const ContactFeature& face, const ClipFrame& frame, const ContactFeature& other,
          const RawVec& offset, ClippedFeature& out) {
  LKS_ASSERT(face.is_flat && face.count > 2 && other.count > 0);
  std::int64_t most = 1;
  const auto of = [](const ContactFeature& feature, int i) -> const FeaturePoint& {
    return feature.points[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < face.count; ++i)
    most = greatest(of(face, i).at - frame.origin, most);
  for (int i = 0; i < other.count; ++i)
    most = greatest(of(other, i).at + offset - frame.origin, most);
  // A coordinate is at most √3 times the greatest: it fits 30 bits.
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most))) - 28);
  LKS_ASSERT(most >> shift < std::int64_t{1} << 28);
  CutPolygon polygon;
  for (int i = 0; i < other.count; ++i) {
    const RawVec p = of(other, i).at + offset - frame.origin;
    polygon[static_cast<std::size_t>(i)] = {
        raw::round_shift(dot(p, frame.u), shift), raw::round_shift(dot(p, frame.v), shift),
        dot(p, frame.normal), of(other, i).id, static_cast<std::uint32_t>(i)};
  }
  Clipper clipper(polygon, other.count);
  const auto corner = [&](int i) {
    const RawVec p = of(face, i).at - frame.origin;
    return CutCorner{raw::round_shift(dot(p, frame.u), shift),
                     raw::round_shift(dot(p, frame.v), shift)};
  };
  for (int i = 0; i < face.count; ++i)
    clipper.cut(corner(i), corner(i + 1 < face.count ? i + 1 : 0), static_cast<std::uint32_t>(i));
  out.count = clipper.count();
  for (int i = 0; i < out.count; ++i) {
    const CutVertex& v = polygon[static_cast<std::size_t>(i)];
    const std::int64_t unit = std::int64_t{1} << shift;
    out.vertices[static_cast<std::size_t>(i)] = {v.x * unit, v.y * unit, v.z, v.id};
  }
  LKS_ASSERT(out.count <= static_cast<int>(out.vertices.size()));
  out.shift = shift;
}

}  // namespace lockstone::geometry
