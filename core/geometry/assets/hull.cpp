#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include <lockstone/hull.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/hull_rounding.h"
#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/hull_faces.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/polytope_columns.h"
#include "core/geometry/convex/slab_tests.h"
#include "core/geometry/convex/solid.h"
#include "core/geometry/convex/solid_integrals.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/numeric/exact_plane.h"

namespace lockstone {

using geometry::Fine;
using geometry::HalfEdge;
using geometry::LocalBounds;
using geometry::Loop;
using geometry::PolytopeFace;

static_assert(k_max_hull_vertices == geometry::k_max_polytope_vertices);

namespace {

struct HullGeometry final : geometry::AssetGeometry {
  AssetId id;
  std::vector<Vec3<Length>> vertices;
  std::vector<PolytopeFace> faces;
  std::vector<HalfEdge> edges;
  geometry::PolytopeColumns columns;
  geometry::Polytope surface;
  LocalBounds box;
  geometry::Solid mass;
  geometry::FacetCorrection facets;
  Length tolerance{};  // as asked for

  bool round(Length radius, const std::vector<Loop>& loops);
  [[nodiscard]] geometry::Part part() const;

  [[nodiscard]] const LocalBounds& bounds() const override { return box; }
  [[nodiscard]] const geometry::Solid* solid() const override { return &mass; }
  [[nodiscard]] const geometry::Polytope* polytope() const override { return &surface; }
  void visit_parts(const LocalBounds& region, geometry::PartVisitor& visitor) const override;
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach,
                          geometry::WayPartVisitor& visitor) const override;
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        geometry::NearPartVisitor& visitor) const override;
};

const HullGeometry& geometry_of(const Hull& hull) {
  return static_cast<const HullGeometry&>(hull.geometry());
}

constexpr std::uint16_t k_hull_version = 1;
constexpr std::uint16_t k_rounded_hull_version = 2;  // ends with the radius

using Points = std::vector<Vec3<Length>>;

void sort_unique(Points& points) {
  const auto key = [](const Vec3<Length>& p) { return std::tie(p.x, p.y, p.z); };
  std::ranges::sort(points, {}, key);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

HullFault fault_of(std::span<const Vec3<Length>> points, const HullOptions& options) {
  const bool good_count = options.max_vertices >= 4 && options.max_vertices <= k_max_hull_vertices;
  const Length radius = options.radius;
  const bool good_radius =
      radius == Length{} || (radius >= k_min_shape_size && radius <= k_max_shape_size &&
                             geometry::hull_rounding() != nullptr);
  if (!good_count || options.tolerance < Length{} || !good_radius)
    return HullFault::invalid_options;
  if (points.size() > k_max_hull_points) return HullFault::too_many_points;
  const Length most = k_max_asset_coordinate - radius;
  const auto is_inside = [most](Length c) { return c >= -most && c <= most; };
  for (const Vec3<Length>& p : points)
    if (!is_inside(p.x) || !is_inside(p.y) || !is_inside(p.z))
      return HullFault::coordinate_out_of_range;
  return points.size() < 4 ? HullFault::too_few_points : HullFault::none;
}

/// Keeps the points that at least `least` of the groups name; whether any was dropped.
template <class Groups>
bool keep_used(Points& points, const Groups& groups, int least) {
  std::vector<int> uses(points.size());
  for (const auto& group : groups)
    for (const std::uint16_t index : group)
      ++uses[index];
  Points kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (uses[i] >= least) kept.push_back(points[i]);
  const bool dropped = kept.size() < points.size();
  points = std::move(kept);
  return dropped;
}

struct Boundary {
  HullFault fault = HullFault::none;
  std::vector<geometry::Triangle> triangles;  // the exact hull
  std::vector<Loop> faces;
};

/// Whether the hull of the other points reaches within its tolerance of the one.
bool is_redundant(const Points& points, std::size_t index, const HullOptions& options) {
  Points others = points;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(index));
  const geometry::HullTriangles hull = geometry::hull_triangles(others, options);
  if (hull.fault != HullFault::none) return false;
  return std::ranges::all_of(hull.triangles, [&](const geometry::Triangle& t) {
    const auto plane = geometry::plane_through(others[t[0]], others[t[1]], others[t[2]]);
    return geometry::height(plane, points[index]) <= geometry::fine(hull.tolerance);
  });
}

/// Drops points in an edge or a face but for less than the tolerance; whether there were any.
bool drop_redundant(Points& points, std::vector<std::uint16_t> suspects,
                    const HullOptions& options) {
  const std::size_t before = points.size();
  for (; !suspects.empty() && points.size() > 4; suspects.pop_back()) {  // from the last
    const std::size_t index = suspects.back();
    if (!is_redundant(points, index, options)) continue;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(index));
  }
  return points.size() < before;
}

/// Drops points until every remaining one is a vertex where three or more faces meet. Reducing the
/// result again changes nothing.
Boundary reduce(Points& points, const HullOptions& options) {
  while (!points.empty()) {
    geometry::HullTriangles hull = geometry::hull_triangles(points, options);
    if (hull.fault != HullFault::none) return {hull.fault, {}, {}};
    if (keep_used(points, hull.triangles, 1)) continue;
    geometry::MergedFaces faces = geometry::merge_faces(points, hull.triangles, hull.tolerance);
    if (keep_used(points, faces.loops, 3)) continue;
    if (drop_redundant(points, std::move(faces.dented), options)) continue;
    return {HullFault::none, std::move(hull.triangles), std::move(faces.loops)};
  }
  return {HullFault::flat, {}, {}};
}

/// The faces' half edges in their order, joined to their twins.
std::vector<HalfEdge> half_edges_of(const std::vector<Loop>& faces, std::size_t vertex_count) {
  std::vector<HalfEdge> edges;
  std::vector<std::uint16_t> index_of(vertex_count * vertex_count);
  const auto end_of = [](const Loop& loop, std::size_t i) {
    return loop[i + 1 == loop.size() ? 0 : i + 1];
  };
  for (std::size_t face = 0; face < faces.size(); ++face) {
    const Loop& loop = faces[face];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      index_of[loop[i] * vertex_count + end_of(loop, i)] = static_cast<std::uint16_t>(edges.size());
      edges.push_back({loop[i], 0, static_cast<std::uint16_t>(face)});
    }
  }
  std::size_t edge = 0;
  for (const Loop& loop : faces)
    for (std::size_t i = 0; i < loop.size(); ++i)
      edges[edge++].twin = index_of[end_of(loop, i) * vertex_count + loop[i]];
  return edges;
}

std::vector<PolytopeFace> planes_of(const std::vector<Loop>& faces, const Points& vertices) {
  std::vector<PolytopeFace> planes;
  std::uint16_t first_edge = 0;
  for (const Loop& loop : faces) {
    const geometry::SupportingFace face = geometry::supporting_face(vertices, loop);
    const auto count = static_cast<std::uint16_t>(loop.size());
    planes.push_back({face.normal, face.offset, first_edge, count});
    first_edge = static_cast<std::uint16_t>(first_edge + count);
  }
  return planes;
}

/// How far a vertex lies below a face that it is around, at most.
Fine unevenness_of(const std::vector<Loop>& loops, const std::vector<PolytopeFace>& faces,
                   const Points& vertices) {
  Fine most = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const std::uint16_t v : loops[i])
      most = std::max(most, faces[i].offset - dot(vertices[v], faces[i].normal).raw);
  return most;
}

LocalBounds bounds_of(std::span<const Vec3<Length>> points, Length radius) {
  LocalBounds bounds{points.front(), points.front()};
  for (const Vec3<Length>& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      bounds.lower[axis] = min(bounds.lower[axis], point[axis]);
      bounds.upper[axis] = max(bounds.upper[axis], point[axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] -= radius;
    bounds.upper[axis] += radius;
  }
  return bounds;
}

/// The least extent square to a face.
Fine thickness_of(const std::vector<PolytopeFace>& faces, const Points& vertices) {
  Fine least = geometry::fine(Length::max());
  for (const PolytopeFace& face : faces) {
    Fine extent = 0;
    for (const Vec3<Length>& vertex : vertices)
      extent = std::max(extent, face.offset - dot(vertex, face.normal).raw);
    least = std::min(least, extent);
  }
  return least;
}

/// Of a sphere about `centre` below all faces and the vertices around them, rounded down.
Length inner_radius_of(const std::vector<Loop>& loops, const std::vector<PolytopeFace>& faces,
                       const Points& vertices, const Vec3<Length>& centre) {
  Fine least = geometry::fine(Length::max());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const std::uint16_t v : loops[i])
      least =
          std::min(least, dot(vertices[v], faces[i].normal).raw - dot(centre, faces[i].normal).raw);
  least -= least >> 28;  // the norm of a normal may be off by 2^-29
  return Length::from_raw(
      static_cast<std::int32_t>(std::max<Fine>(least, 0) >> geometry::k_fine_per_length));
}

/// The most by which a point lies beyond a face, rounded up.
Length deviation_of(const std::vector<PolytopeFace>& faces, std::span<const Vec3<Length>> points) {
  Fine most = 0;
  for (const Vec3<Length>& point : points)
    for (const PolytopeFace& face : faces)
      most = std::max(most, dot(point, face.normal).raw - face.offset);
  constexpr Fine below_one = (Fine{1} << geometry::k_fine_per_length) - 1;
  return Length::from_raw(
      static_cast<std::int32_t>((most + below_one) >> geometry::k_fine_per_length));
}

std::vector<std::byte> encode(std::span<const Vec3<Length>> vertices, Length tolerance,
                              Length radius) {
  const bool rounded = radius > Length{};
  std::vector<std::byte> bytes(geometry::k_asset_header_bytes + 6 + 12 * vertices.size() +
                               (rounded ? 4 : 0));
  ByteWriter writer(bytes);
  geometry::put_asset_header(writer, ShapeKind::hull,
                             rounded ? k_rounded_hull_version : k_hull_version);
  writer.put(tolerance.raw);
  writer.put(static_cast<std::uint16_t>(vertices.size()));
  for (const Vec3<Length>& v : vertices)
    for (const Length c : {v.x, v.y, v.z})
      writer.put(c.raw);
  if (rounded) writer.put(radius.raw);
  LKS_CHECK(writer.ok() && writer.size() == bytes.size());
  return bytes;
}

/// Surrounds the polytope by a radius; false when the solid becomes too large.
bool HullGeometry::round(Length radius, const std::vector<Loop>& loops) {
  surface.radius = radius;
  const geometry::HullRounding& rounding = *geometry::hull_rounding();
  surface.kernels = &rounding.kernels;
  const auto rounded = rounding.solid_of(surface);
  if (!rounded) return false;
  mass = *rounded;
  mass.inner_radius = radius + inner_radius_of(loops, faces, vertices, mass.centre);
  surface.interior = mass.centre;
  facets = rounding.facets_of(surface, mass.volume);
  surface.facets = &facets;
  return true;
}

geometry::Part HullGeometry::part() const {
  geometry::Part part;
  part.shape = {ShapeKind::hull, {}, id};
  part.polytope = &surface;
  return part;
}

void HullGeometry::visit_parts(const LocalBounds& region, geometry::PartVisitor& visitor) const {
  if (overlap(region, box)) visitor.visit(part());
}

void HullGeometry::visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                                      const Vec3<Length>& reach,
                                      geometry::WayPartVisitor& visitor) const {
  std::int64_t at = 0;
  const geometry::RayWindow window(origin, translation, reach);
  if (window.meets(box, window.limit_of(Unit::from_integer(1)), at)) visitor.visit(part());
}

void HullGeometry::visit_parts_near(const Vec3<Length>& point, Length reach,
                                    geometry::NearPartVisitor& visitor) const {
  std::int64_t at = 0;
  const geometry::NearWindow window(point);
  if (window.meets(box, window.limit_of(reach), at)) visitor.visit(part());
}

}  // namespace

Hull::Hull(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : Asset(ShapeKind::hull, id, std::move(geometry)) {}

HullResult Hull::build(std::span<const Vec3<Length>> points, const HullOptions& options) {
  if (const HullFault fault = fault_of(points, options); fault != HullFault::none)
    return {nullptr, fault, {}};
  auto made = std::make_unique<HullGeometry>();
  made->vertices.assign(points.begin(), points.end());
  sort_unique(made->vertices);
  const Boundary boundary = reduce(made->vertices, options);
  if (boundary.fault != HullFault::none) return {nullptr, boundary.fault, {}};
  made->faces = planes_of(boundary.faces, made->vertices);
  if (thickness_of(made->faces, made->vertices) < geometry::fine(k_min_hull_thickness))
    return {nullptr, HullFault::flat, {}};
  const auto solid = geometry::solid_of(made->vertices, boundary.triangles);
  if (!solid) return {nullptr, HullFault::too_large, {}};
  made->mass = *solid;
  made->mass.inner_radius =
      inner_radius_of(boundary.faces, made->faces, made->vertices, solid->centre);
  made->edges = half_edges_of(boundary.faces, made->vertices.size());
  made->box = bounds_of(made->vertices, options.radius);
  made->tolerance = options.tolerance;
  made->surface = {made->vertices, made->faces, made->edges, solid->centre,
                   &geometry::polytope_kernels()};
  made->columns.fill(made->vertices, made->faces, made->edges);
  made->surface.wide = &made->columns.view();
  made->surface.unevenness = unevenness_of(boundary.faces, made->faces, made->vertices);
  made->surface.least_mean_normal = geometry::least_mean_normal_of(made->faces, made->edges);
  if (options.radius > Length{} && !made->round(options.radius, boundary.faces))
    return {nullptr, HullFault::too_large, {}};
  made->id = geometry::id_of(encode(made->vertices, options.tolerance, options.radius));
  const AssetId id = made->id;
  const Length deviation = deviation_of(made->faces, points);
  return {std::shared_ptr<const Hull>(new Hull(id, std::move(made))), HullFault::none, deviation};
}

Result<std::shared_ptr<const Hull>> Hull::from_bytes(ByteView bytes) {
  ByteReader reader(bytes);
  Status head = geometry::read_asset_header(reader, ShapeKind::hull, k_hull_version);
  const bool rounded = head == Status::unsupported_version;
  if (rounded) {
    reader = ByteReader(bytes);
    head = geometry::read_asset_header(reader, ShapeKind::hull, k_rounded_hull_version);
    if (geometry::hull_rounding() == nullptr) return Status::unsupported_version;
  }
  if (head != Status::ok) return head;
  const std::size_t tail = rounded ? 4 : 0;
  const auto tolerance = Length::from_raw(reader.get<std::int32_t>());
  const std::size_t count = reader.get<std::uint16_t>();
  if (!reader.ok() || reader.remaining() < 12 * count + tail) return Status::truncated;
  if (reader.remaining() > 12 * count + tail || count > k_max_hull_vertices)
    return Status::malformed;
  Points vertices(count);
  for (Vec3<Length>& v : vertices)
    for (int axis = 0; axis < 3; ++axis)
      v[axis].raw = reader.get<std::int32_t>();
  const auto radius = Length::from_raw(rounded ? reader.get<std::int32_t>() : 0);
  if (rounded && radius == Length{}) return Status::malformed;
  HullResult result = build(vertices, {tolerance, k_max_hull_vertices, radius});
  const bool same = result.ok() && std::ranges::equal(result.hull->vertices(), vertices);
  if (!same) return Status::malformed;
  return std::move(result.hull);
}

Length Hull::radius() const {
  return geometry_of(*this).surface.radius;
}

Length Hull::tolerance() const {
  return geometry_of(*this).tolerance;
}

std::span<const Vec3<Length>> Hull::vertices() const {
  return geometry_of(*this).vertices;
}

int Hull::face_count() const {
  return static_cast<int>(geometry_of(*this).faces.size());
}

std::vector<int> Hull::face_vertices(int face) const {
  if (face < 0 || face >= face_count())
    misused("Hull::face_vertices: the face must be 0 … face_count() - 1");
  const HullGeometry& hull = geometry_of(*this);
  const PolytopeFace& loop = hull.faces[static_cast<std::size_t>(face)];
  std::vector<int> indices;
  for (const HalfEdge& edge : std::span(hull.edges).subspan(loop.first_edge, loop.edge_count))
    indices.push_back(edge.origin);
  return indices;
}

std::vector<std::byte> Hull::canonical_bytes() const {
  const HullGeometry& hull = geometry_of(*this);
  return encode(hull.vertices, hull.tolerance, hull.surface.radius);
}

std::string_view to_string(HullFault fault) {
  switch (fault) {
    case HullFault::none:
      return "none";
    case HullFault::invalid_options:
      return "invalid options";
    case HullFault::too_few_points:
      return "too few points";
    case HullFault::too_many_points:
      return "too many points";
    case HullFault::coordinate_out_of_range:
      return "coordinate out of range";
    case HullFault::coincident:
      return "points coincide";
    case HullFault::collinear:
      return "points lie on a line";
    case HullFault::flat:
      return "points lie in a plane";
    case HullFault::too_large:
      return "too large";
  }
  return "unknown hull fault";
}

}  // namespace lockstone
