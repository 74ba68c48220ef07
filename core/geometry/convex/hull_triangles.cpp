#include "core/geometry/convex/hull_triangles.h"

#include <algorithm>
#include <bit>

#include "core/geometry/numeric/exact_plane.h"

namespace lockstone::geometry {
namespace {

using PointList = std::span<const Vec3<Length>>;
using PointIndex = std::uint16_t;
using FacetIndex = int;

constexpr int k_no_point = -1;
constexpr FacetIndex k_no_facet = -1;
constexpr Length k_least_tolerance = Length::from_raw(2);

// Measured from points that happen to be extreme, a hull may seem thinner than it is.
constexpr std::int64_t k_clearly_thin = k_min_hull_thickness.raw / 4;

struct FirstSimplex {
  HullFault fault = HullFault::none;
  std::array<PointIndex, 4> points{};
  std::int64_t extent = 0;  ///< the greatest along an axis, raw
  Fine thickness = 0;       ///< height of the fourth point above the plane of the others
};

/// The two ends of the axis along which the points extend most.
void take_longest_axis(PointList points, FirstSimplex& simplex) {
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t low = 0, high = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i][axis] < points[low][axis]) low = i;
      if (points[i][axis] > points[high][axis]) high = i;
    }
    const std::int64_t extent = std::int64_t{points[high][axis].raw} - points[low][axis].raw;
    if (extent <= simplex.extent) continue;
    simplex.extent = extent;
    simplex.points[0] = static_cast<PointIndex>(low);
    simplex.points[1] = static_cast<PointIndex>(high);
  }
  if (simplex.extent < k_min_hull_thickness.raw) simplex.fault = HullFault::coincident;
}

/// |v|².
UInt128 square_of(const RawVec& v) {
  return dot_wide(v, v).bits();
}

void take_farthest_from_line(PointList points, FirstSimplex& simplex) {
  const Vec3<Length> a = points[simplex.points[0]];
  const RawVec line = difference(points[simplex.points[1]], a);
  UInt128 most{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const UInt128 square = square_of(cross(line, difference(points[i], a)));
    if (square <= most) continue;
    most = square;
    simplex.points[2] = static_cast<PointIndex>(i);
  }
  const std::uint64_t distance = isqrt128(most) / norm(line.x, line.y, line.z);
  if (distance < static_cast<std::uint64_t>(k_clearly_thin)) simplex.fault = HullFault::collinear;
}

/// Leaves the first three clockwise seen from the fourth.
void take_farthest_from_plane(PointList points, FirstSimplex& simplex) {
  auto& [a, b, c, d] = simplex.points;
  const ExactPlane plane = plane_through(points[a], points[b], points[c]);
  Fine apex = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Fine above = height(plane, points[i]);
    if (magnitude_of(above) <= magnitude_of(apex)) continue;
    apex = above;
    d = static_cast<PointIndex>(i);
  }
  simplex.thickness = magnitude_of(apex);
  if (simplex.thickness < fine(Length::from_raw(k_clearly_thin))) simplex.fault = HullFault::flat;
  if (apex > 0) std::swap(b, c);
}

FirstSimplex find_simplex(PointList points) {
  FirstSimplex simplex;
  take_longest_axis(points, simplex);
  if (simplex.fault == HullFault::none) take_farthest_from_line(points, simplex);
  if (simplex.fault == HullFault::none) take_farthest_from_plane(points, simplex);
  return simplex;
}

Length tolerance_for(const FirstSimplex& simplex, Length wanted) {
  const auto extent = std::bit_floor(static_cast<std::uint64_t>(simplex.extent));
  const Length usual = Length::from_raw(static_cast<std::int32_t>(extent >> 12));
  const auto thickness = static_cast<std::int32_t>(simplex.thickness >> (k_fine_per_length + 4));
  const Length most = Length::from_raw(thickness);
  return clamp(wanted == Length{} ? usual : wanted, k_least_tolerance, most);
}

struct Facet {
  std::array<PointIndex, 3> corner{};
  std::array<FacetIndex, 3> neighbour{};  // across the edge from corner i to i + 1
  ExactPlane plane{};
  int first_outside = k_no_point;  // list of points that lie above it
  int farthest = k_no_point;
  Fine distance = 0;  // of the farthest
  bool is_live = true;
  bool is_visible = false;  // from the point being added
};

class Builder {
 public:
  Builder(PointList points, const FirstSimplex& simplex, Length tolerance);

  void grow(int max_vertices) {
    // A closed surface of triangles has two more vertices than half its faces.
    while (live_count_ / 2 + 2 < max_vertices) {
      const FacetIndex facet = next_facet();
      if (facet == k_no_facet) return;
      add(facet);
    }
  }

  [[nodiscard]] std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    for (const Facet& facet : facets_)
      if (facet.is_live) result.push_back(facet.corner);
    return result;
  }

 private:
  [[nodiscard]] Facet& at(FacetIndex facet) { return facets_[static_cast<std::size_t>(facet)]; }
  [[nodiscard]] const Vec3<Length>& point(int index) const {
    return points_[static_cast<std::size_t>(index)];
  }
  FacetIndex make(PointIndex a, PointIndex b, PointIndex c);
  [[nodiscard]] FacetIndex next_facet() const;
  void add(FacetIndex facet);
  void see(FacetIndex facet, const Vec3<Length>& eye);
  void join_horizon(int apex);
  void join(FacetIndex outer, int edge, int apex);
  void retire_visible(int apex);
  void assign(int index);

  PointList points_;
  Fine tolerance_ = 0;
  int live_count_ = 0;
  std::vector<Facet> facets_;
  std::vector<FacetIndex> unused_;
  std::vector<int> next_outside_;        // of each point: the list it is in
  std::vector<FacetIndex> starting_at_;  // of each point: the new facet whose first corner it is
  std::vector<FacetIndex> visible_;
  std::vector<FacetIndex> fresh_;
};

Builder::Builder(PointList points, const FirstSimplex& simplex, Length tolerance)
    : points_(points),
      tolerance_(fine(tolerance)),
      next_outside_(points.size(), k_no_point),
      starting_at_(points.size(), k_no_facet) {
  const auto [a, b, c, d] = simplex.points;
  fresh_ = {make(a, b, c), make(b, a, d), make(c, b, d), make(a, c, d)};
  at(0).neighbour = {1, 2, 3};
  at(1).neighbour = {0, 3, 2};
  at(2).neighbour = {0, 1, 3};
  at(3).neighbour = {0, 2, 1};
  for (std::size_t i = 0; i < points.size(); ++i)
    assign(static_cast<int>(i));
}

FacetIndex Builder::make(PointIndex a, PointIndex b, PointIndex c) {
  if (unused_.empty()) {
    unused_.push_back(static_cast<FacetIndex>(facets_.size()));
    facets_.emplace_back();
  }
  const FacetIndex index = unused_.back();
  unused_.pop_back();
  at(index) = {};
  at(index).corner = {a, b, c};
  at(index).plane = plane_through(points_[a], points_[b], points_[c]);
  ++live_count_;
  return index;
}

/// The facet with the farthest point above it; of equals, the point that comes first.
FacetIndex Builder::next_facet() const {
  FacetIndex best = k_no_facet;
  Fine most = 0;
  int farthest = k_no_point;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const Facet& facet = facets_[i];
    if (!facet.is_live || facet.farthest == k_no_point || facet.distance < most) continue;
    if (facet.distance == most && facet.farthest > farthest) continue;
    best = static_cast<FacetIndex>(i);
    most = facet.distance;
    farthest = facet.farthest;
  }
  return best;
}

void Builder::add(FacetIndex facet) {
  const int apex = at(facet).farthest;
  visible_.clear();
  fresh_.clear();
  see(facet, point(apex));
  join_horizon(apex);
  retire_visible(apex);
}

/// Collects the facets that the eye sees, starting from one of them.
void Builder::see(FacetIndex start, const Vec3<Length>& eye) {
  at(start).is_visible = true;
  visible_.push_back(start);
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    for (const FacetIndex neighbour : at(visible_[i]).neighbour) {
      Facet& facet = at(neighbour);
      if (facet.is_visible || side(facet.plane, eye) <= 0) continue;
      facet.is_visible = true;
      visible_.push_back(neighbour);
    }
  }
}

/// A new facet across each edge between a seen and an unseen facet. The edges are one cycle.
void Builder::join_horizon(int apex) {
  for (const FacetIndex seen : visible_) {
    for (const FacetIndex outer : std::array(at(seen).neighbour)) {
      if (at(outer).is_visible) continue;
      const auto& back = at(outer).neighbour;
      join(outer, static_cast<int>(std::ranges::find(back, seen) - back.begin()), apex);
    }
  }
  for (const FacetIndex index : fresh_) {
    const FacetIndex after = starting_at_[at(index).corner[1]];
    at(index).neighbour[1] = after;
    at(after).neighbour[2] = index;
  }
}

void Builder::join(FacetIndex outer, int edge, int apex) {
  const auto corner = [this, outer](int i) {
    return at(outer).corner[static_cast<std::size_t>(i % 3)];
  };
  const FacetIndex index = make(corner(edge + 1), corner(edge), static_cast<PointIndex>(apex));
  at(index).neighbour[0] = outer;
  at(outer).neighbour[static_cast<std::size_t>(edge)] = index;
  starting_at_[at(index).corner[0]] = index;
  fresh_.push_back(index);
}

/// Gives the points above the facets that are gone to the new ones.
void Builder::retire_visible(int apex) {
  for (const FacetIndex seen : visible_) {
    for (int p = at(seen).first_outside; p != k_no_point;) {
      const int next = next_outside_[static_cast<std::size_t>(p)];
      if (p != apex) assign(p);
      p = next;
    }
    at(seen).is_live = false;
    at(seen).first_outside = at(seen).farthest = k_no_point;
    unused_.push_back(seen);
    --live_count_;
  }
}

/// Puts a point on the list of the new facet that it is farthest above, if by more than the
/// tolerance.
void Builder::assign(int index) {
  FacetIndex best = k_no_facet;
  Fine most = tolerance_;
  for (const FacetIndex candidate : fresh_) {
    const Fine above = height(at(candidate).plane, point(index));
    if (above <= most) continue;
    most = above;
    best = candidate;
  }
  if (best == k_no_facet || side(at(best).plane, point(index)) <= 0) return;
  Facet& facet = at(best);
  next_outside_[static_cast<std::size_t>(index)] = facet.first_outside;
  facet.first_outside = index;
  const bool is_first = facet.farthest == k_no_point || most > facet.distance ||
                        (most == facet.distance && index < facet.farthest);
  if (!is_first) return;
  facet.distance = most;
  facet.farthest = index;
}

}  // namespace

HullTriangles hull_triangles(PointList points, const HullOptions& options) {
  HullTriangles result;
  const FirstSimplex simplex = find_simplex(points);
  result.fault = simplex.fault;
  if (result.fault != HullFault::none) return result;
  result.tolerance = tolerance_for(simplex, options.tolerance);
  Builder builder(points, simplex, result.tolerance);
  builder.grow(options.max_vertices);
  result.triangles = builder.triangles();
  return result;
}

}  // namespace lockstone::geometry
