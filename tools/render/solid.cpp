#include "tools/render/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lockstone::render {
namespace {

/// Who hides whom, and how sure that is.
struct Order {
  double gap = -std::numeric_limits<double>::infinity();
  int sign = 0;  ///< 1: b is in front of a, −1: behind
};

/// Points of a solid have dot(normal, point) ≤ offset.
struct Plane {
  Vec normal;
  double offset = 0;
};

// Both sides and the borders of a flat one.
void add_flat_planes(std::vector<Plane>& planes, const Facet& facet) {
  for (const double sign : {1.0, -1.0}) {
    const Vec normal = facet.normal * sign;
    planes.push_back({normal, dot(normal, facet.corners[0])});
  }
  for (std::size_t i = 0; i < facet.corners.size(); ++i) {
    const Vec& from = facet.corners[i];
    const Vec along = facet.corners[(i + 1) % facet.corners.size()] - from;
    const Vec normal = unit(cross(along, facet.normal));
    planes.push_back({normal, dot(normal, from)});
  }
}

// The planes that bound a solid; none for round ones.
std::vector<Plane> planes_of(const Solid& solid) {
  std::vector<Plane> planes;
  if (solid.is_flat()) {
    add_flat_planes(planes, solid.facets[0]);
    return planes;
  }
  for (const Facet& facet : solid.facets)
    planes.push_back({facet.normal, dot(facet.normal, facet.corners[0])});
  if (solid.kind != ShapeKind::box) return planes;
  const double half[] = {solid.size.x, solid.size.y, solid.size.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vec normal = solid.axes[axis] * sign;
      planes.push_back({normal, dot(normal, solid.center) + half[axis]});
    }
  }
  return planes;
}

// Of the planes of one solid the one that has the most of `b` on its outer side. If it looks
// towards the viewer, b is in front. (Solids that overlap a little, as resting ones do, have a
// small negative gap.)
Order order_by_planes(const std::vector<Plane>& planes, const Solid& b, const Vec& toward) {
  Order best;
  for (const Plane& plane : planes) {
    const double facing = dot(plane.normal, toward);
    if (std::abs(facing) < 1e-6) continue;
    const double gap = -b.reach(plane.normal * -1) - plane.offset;
    if (gap >= best.gap) best = {gap, facing > 0 ? 1 : -1};
  }
  return best;
}

/// A solid and values of it that are needed again and again.
struct Sight {
  const Solid& solid;
  Frame frame;
  std::vector<Plane> planes;
};

// 1 when b must be painted after a, −1 when before, 0 when it does not matter.
int compare(const Sight& a, const Sight& b, const Camera& camera) {
  Order best = order_by_planes(a.planes, b.solid, camera.toward());
  const Order other = order_by_planes(b.planes, a.solid, camera.toward());
  if (other.gap > best.gap) best = {other.gap, -other.sign};
  if (best.sign != 0) return best.sign;
  const double depth = dot(b.solid.center - a.solid.center, camera.toward());
  return depth > 0 ? 1 : depth < 0 ? -1 : 0;
}

/// Who must be painted before whom, as a graph.
struct Graph {
  std::vector<std::vector<std::size_t>> later;
  std::vector<std::size_t> waits_for;
};

Graph build_graph(const std::vector<Solid>& solids, const Camera& camera) {
  std::vector<Sight> sights;
  for (const Solid& solid : solids)
    sights.push_back({solid, frame_of(solid, camera), planes_of(solid)});
  Graph graph{std::vector<std::vector<std::size_t>>(solids.size()),
              std::vector<std::size_t>(solids.size())};
  for (std::size_t a = 0; a < solids.size(); ++a) {
    for (std::size_t b = a + 1; b < solids.size(); ++b) {
      if (!sights[a].frame.overlaps(sights[b].frame)) continue;
      const int order = compare(sights[a], sights[b], camera);
      if (order == 0) continue;
      graph.later[order > 0 ? a : b].push_back(order > 0 ? b : a);
      ++graph.waits_for[order > 0 ? b : a];
    }
  }
  return graph;
}

// Points whose hull, seen from above, is the solid's outline.
std::vector<Vec> outline_points(const Solid& solid) {
  std::vector<Vec> points;
  for (const Facet& facet : solid.facets)
    points.insert(points.end(), facet.corners.begin(), facet.corners.end());
  if (!solid.facets.empty()) return points;
  if (solid.kind == ShapeKind::box) {
    for (int corner = 0; corner < 8; ++corner) {
      const auto sign = [&](int bit) { return (corner >> bit & 1) != 0 ? 1.0 : -1.0; };
      points.push_back(solid.center + solid.axes[0] * (solid.size.x * sign(0)) +
                       solid.axes[1] * (solid.size.y * sign(1)) +
                       solid.axes[2] * (solid.size.z * sign(2)));
    }
    return points;
  }
  constexpr int k_parts = 20;
  const double half = solid.kind == ShapeKind::capsule ? solid.size.y : 0;
  for (int i = 0; i < 2 * k_parts; ++i) {
    const double angle = 2 * M_PI * i / k_parts;
    const Vec end = solid.center + solid.axes[1] * (i < k_parts ? half : -half);
    points.push_back(end + Vec{std::cos(angle), 0, std::sin(angle)} * solid.radius());
  }
  return points;
}

// Which side of the line a b, seen from above, c lies on.
double side(const Vec& a, const Vec& b, const Vec& c) {
  return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

}  // namespace

// Andrew's monotone chain: the lower hull from left to right, the upper one back.
std::vector<Vec> outline_from_above(const Solid& solid) {
  constexpr double k_flat = 1e-9;  // m²: nearer points count as one
  std::vector<Vec> points = outline_points(solid);
  std::sort(points.begin(), points.end(),
            [](const Vec& a, const Vec& b) { return std::pair(a.x, a.z) < std::pair(b.x, b.z); });
  std::vector<Vec> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec& point : points) {
      while (hull.size() >= start + 2 && side(hull[hull.size() - 2], hull.back(), point) < k_flat) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // the next pass begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double Solid::reach(const Vec& direction) const {
  if (!facets.empty()) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Facet& facet : facets) {
      for (const Vec& corner : facet.corners)
        most = std::max(most, dot(direction, corner));
    }
    return most;
  }
  const double at_center = dot(direction, center);
  const double norm = length(direction);
  switch (kind) {
    case ShapeKind::sphere:
      return at_center + size.x * norm;
    case ShapeKind::capsule:
      return at_center + std::abs(dot(direction, axes[1])) * size.y + size.x * norm;
    default:
      return at_center + std::abs(dot(direction, axes[0])) * size.x +
             std::abs(dot(direction, axes[1])) * size.y +
             std::abs(dot(direction, axes[2])) * size.z;
  }
}

void Frame::include(const Frame& other) {
  left = std::min(left, other.left);
  right = std::max(right, other.right);
  low = std::min(low, other.low);
  high = std::max(high, other.high);
}

Frame frame_of(const Solid& solid, const Camera& camera) {
  const Spot middle = camera.project(solid.center);
  const auto extent = [&](const Vec& direction) {
    return solid.reach(direction) - dot(direction, solid.center);
  };
  return {middle.right - extent(camera.right() * -1), middle.right + extent(camera.right()),
          middle.up - extent(camera.up() * -1), middle.up + extent(camera.up())};
}

std::vector<std::size_t> paint_order(const std::vector<Solid>& solids, const Camera& camera) {
  Graph graph = build_graph(solids, camera);
  constexpr auto k_done = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order;
  while (order.size() < solids.size()) {
    // The one with the fewest that should come before it, and of those the farthest: on a cycle,
    // which overlapping bodies can form, something has to give.
    std::size_t best = k_done;
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if (graph.waits_for[i] == k_done) continue;
      const auto key = [&](std::size_t s) {
        return std::pair(graph.waits_for[s], camera.project(solids[s].center).near);
      };
      if (best == k_done || key(i) < key(best)) best = i;
    }
    order.push_back(best);
    graph.waits_for[best] = k_done;
    for (const std::size_t next : graph.later[best]) {
      if (graph.waits_for[next] != k_done) --graph.waits_for[next];
    }
  }
  return order;
}

}  // namespace lockstone::render
