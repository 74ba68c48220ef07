#include "core/geometry/contact/polytope/face_reach.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/numeric/clip_edge.h"

namespace lockstone::geometry {
namespace {

/// Far above the errors of points (2^-20 m), and by how much clipping moves vertices (√2 · k_snap,
/// and steps of its lattice), in 20 fraction bits: 122 µm.
constexpr std::int64_t k_side_slack = 128;
/// The same of heights: those of points, and of vertices that were moved along a face which leans
/// by at most a sixteenth on either axis.
constexpr Fine k_height_slack = 2 * k_witness_slack + k_snap / 8;

/// A side of the reference face, in its polytope's axes.
struct FaceSide {
  RawVec start;
  RawVec outward;  ///< a quarter as long as the side, each lane off by at most 1

  /// How far a point is beyond the side, times a quarter of its length.
  [[nodiscard]] std::int64_t excess(const RawVec& point) const {
    const RawVec way = point - start;
    return way.x * outward.x + way.y * outward.y + way.z * outward.z;
  }
  /// The same of the side's slack. The errors of `outward` are covered by half of it where the side
  /// is not far shorter than the way to the point.
  [[nodiscard]] std::int64_t slack() const { return k_side_slack * sum_of_magnitudes(outward); }
  [[nodiscard]] bool measures(const RawVec& point) const {
    return sum_of_magnitudes(point - start) <= k_side_slack / 4 * sum_of_magnitudes(outward);
  }
};

FaceSide face_side_of(const PolytopeView& view, const PolytopeFace& face, int edge) {
  const RawVec outward = cross_narrow(raws_of(edge_vector(view.own, edge)), raws_of(face.normal));
  return {raws_of(start_of(view.own, edge)), {outward.x >> 32, outward.y >> 32, outward.z >> 32}};
}

/// Where products of 30 bits with differences of its coordinates and the own polytope's fit.
bool is_near(const RawVec& point) {
  const auto size = static_cast<std::uint64_t>(magnitude_of(point.x) | magnitude_of(point.y) |
                                               magnitude_of(point.z));
  return std::bit_width(size) <= 30;
}

struct SidePoint {
  std::int64_t excess = 0;
  Fine height = 0;
};

/// The least height between two points on the inner side of a side; k_any if there is none.
Fine least_inside(const SidePoint& from, const SidePoint& to) {
  constexpr Fine none = std::numeric_limits<Fine>::max();
  const Fine start = from.excess <= 0 ? from.height : none;
  if ((from.excess < 0) == (to.excess < 0) || from.excess == 0 || to.excess == 0) return start;
  const SidePoint& inside = from.excess < 0 ? from : to;
  const SidePoint& outside = from.excess < 0 ? to : from;
  return std::min(start, cut_between(inside.height, outside.height,
                                     share_inside(-inside.excess, outside.excess)));
}

}  // namespace

bool may_come_down(const PolytopeFaceMeeting& meeting, int incident, Fine height) {
  const PolytopeView& view = meeting.view;
  const PolytopeFace& face = view.own.faces[static_cast<std::size_t>(meeting.face.face)];
  const RawVec deepest =
      view.to_own_coarse(view.other.vertices[static_cast<std::size_t>(meeting.face.support)]);
  if (!is_near(deepest)) return true;
  FaceSide side{};
  std::int64_t farthest = 0;
  for (int i = 0; i < face.edge_count; ++i) {
    const FaceSide next = face_side_of(view, face, face.first_edge + i);
    const std::int64_t excess = next.excess(deepest);
    if (excess <= farthest) continue;
    farthest = excess;
    side = next;
  }
  const std::int64_t slack = side.slack();
  if (farthest <= slack) return true;
  const PolytopeFace& other = view.other.faces[static_cast<std::size_t>(incident)];
  const auto point_at = [&](int i, SidePoint& at) {
    const RawVec point = view.to_own_coarse(start_of(view.other, other.first_edge + i));
    if (!is_near(point) || !side.measures(point)) return false;
    at = {side.excess(point) - slack, lean_of(point, face.normal) - face.offset};
    return true;
  };
  SidePoint from;
  if (!point_at(other.edge_count - 1, from)) return true;
  for (int i = 0; i < other.edge_count; ++i) {
    SidePoint to;
    if (!point_at(i, to)) return true;
    if (least_inside(from, to) <= height + k_height_slack) return true;
    from = to;
  }
  return false;
}

}  // namespace lockstone::geometry
