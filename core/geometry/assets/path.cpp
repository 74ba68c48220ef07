// Canonical bytes: asset head · u8 closed · u32 points · per point: 3 × i32 position, 3 × i32 up.

#include <lockstone/path.h>
#include <lockstone/trigonometry.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/spline_curve.h"
#include "core/geometry/convex/asset_geometry.h"
#include "core/math/roots.h"
#include "core/math/rotation_log.h"

namespace lockstone {
namespace {

constexpr std::uint16_t k_path_version = 1;
constexpr std::size_t k_path_point_bytes = 24;

PathFault fault_of_point(std::span<const PathPoint> points, std::size_t i, bool closed) {
  const PathPoint& point = points[i];
  if (!geometry::is_asset_coordinate(point.position)) return PathFault::coordinate_out_of_range;
  if (point.up == Vec3<Unit>{}) return PathFault::no_direction_up;
  if (i + 1 == points.size() && !closed) return PathFault::none;
  const Vec3<Length>& next = points[(i + 1) % points.size()].position;
  const auto way = [&](int axis) {
    return std::int64_t{next[axis].raw} - point.position[axis].raw;
  };
  const std::uint64_t chord = norm(way(0), way(1), way(2));
  const bool fits = chord >= static_cast<std::uint64_t>(k_min_path_chord.raw) &&
                    chord <= static_cast<std::uint64_t>(k_max_path_chord.raw);
  return fits ? PathFault::none : PathFault::chord_out_of_range;
}

PathResult refused(PathFault fault, std::size_t point = 0) {
  return {nullptr, fault, static_cast<std::uint32_t>(point)};
}

std::vector<std::byte> encode(std::span<const PathPoint> points, bool closed) {
  std::vector<std::byte> bytes(geometry::k_asset_header_bytes + 5 +
                               points.size() * k_path_point_bytes);
  ByteWriter writer(bytes);
  geometry::put_asset_header(writer, ShapeKind::path, k_path_version);
  writer.put(static_cast<std::uint8_t>(closed));
  writer.put(static_cast<std::uint32_t>(points.size()));
  for (const PathPoint& point : points) {
    geometry::put_vector(writer, point.position);
    for (const Unit part : {point.up.x, point.up.y, point.up.z})
      writer.put(part.raw);
  }
  LKS_CHECK(writer.ok() && writer.size() == bytes.size());
  return bytes;
}

}  // namespace

std::string_view to_string(PathFault fault) {
  switch (fault) {
    case PathFault::none:
      return "none";
    case PathFault::too_few_points:
      return "too few points";
    case PathFault::too_many_points:
      return "too many points";
    case PathFault::coordinate_out_of_range:
      return "a point is too far from the origin";
    case PathFault::chord_out_of_range:
      return "two points are too near or too far apart";
    case PathFault::no_direction_up:
      return "a direction up is zero or goes along the path";
    case PathFault::too_sharp:
      return "the path turns back too sharply";
    case PathFault::too_long:
      return "the path is too long";
  }
  return "unknown";
}

namespace {

// It has no parts that anything could meet.
class PathGeometry final : public geometry::AssetGeometry {
 public:
  PathGeometry(std::span<const PathPoint> points, bool closed, const geometry::LocalBounds& bounds)
      : points_(points.begin(), points.end()), curve_(points, closed), bounds_(bounds) {}

  [[nodiscard]] std::span<const PathPoint> points() const { return points_; }
  [[nodiscard]] const geometry::SplineCurve& spline() const { return curve_; }

  [[nodiscard]] const geometry::LocalBounds& bounds() const override { return bounds_; }
  [[nodiscard]] const geometry::Curve* curve() const override { return &curve_; }
  void visit_parts(const geometry::LocalBounds&, geometry::PartVisitor&) const override {}
  void visit_parts_on_way(const Vec3<Length>&, const Vec3<Length>&, const Vec3<Length>&,
                          geometry::WayPartVisitor&) const override {}
  void visit_parts_near(const Vec3<Length>&, Length, geometry::NearPartVisitor&) const override {}

 private:
  std::vector<PathPoint> points_;
  geometry::SplineCurve curve_;
  geometry::LocalBounds bounds_;
};

const PathGeometry& geometry_of(const Path& path) {
  return static_cast<const PathGeometry&>(path.geometry());
}

}  // namespace

Path::Path(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : Asset(ShapeKind::path, id, std::move(geometry)) {}

PathResult Path::build(std::span<const PathPoint> points, bool closed) {
  if (points.size() < (closed ? 3U : 2U)) return refused(PathFault::too_few_points);
  if (points.size() > k_max_path_points) return refused(PathFault::too_many_points);
  geometry::LocalBounds bounds{points[0].position, points[0].position};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const PathFault fault = fault_of_point(points, i, closed); fault != PathFault::none)
      return refused(fault, i);
    for (int axis = 0; axis < 3; ++axis) {
      bounds.lower[axis] = min(bounds.lower[axis], points[i].position[axis]);
      bounds.upper[axis] = max(bounds.upper[axis], points[i].position[axis]);
    }
  }
  auto made = std::make_unique<const PathGeometry>(points, closed, bounds);
  std::uint32_t point = 0;
  if (const PathFault fault = made->spline().fault(point); fault != PathFault::none)
    return refused(fault, point);
  const AssetId id = geometry::id_of(encode(points, closed));
  return {std::shared_ptr<const Path>(new Path(id, std::move(made)))};
}

PathResult Path::build(std::span<const PathPoint> points, std::span<const Angle> banks,
                       bool closed) {
  PathResult level = build(points, closed);
  if (banks.empty() || !level.ok()) return level;
  if (banks.size() != points.size()) misused("Path::build: as many banks as points, or none");
  std::vector<PathPoint> turned(points.begin(), points.end());
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (banks[i] == Angle{}) continue;
    const Mat3 frame = geometry_of(*level.path).spline().frame_at(i);
    const SinCos bank = sin_cos(banks[i]);
    for (int axis = 0; axis < 3; ++axis)
      turned[i].up[axis] = rounded<Unit>(frame.z[axis] * bank.cos - frame.y[axis] * bank.sin);
  }
  return build(turned, closed);
}

Result<std::shared_ptr<const Path>> Path::from_bytes(ByteView bytes) {
  ByteReader reader(bytes);
  const Status head = geometry::read_asset_header(reader, ShapeKind::path, k_path_version);
  if (head != Status::ok) return head;
  const auto closed = reader.get<std::uint8_t>();
  const auto count = reader.get<std::uint32_t>();
  if (!reader.ok()) return Status::truncated;
  if (closed > 1 || count > k_max_path_points) return Status::malformed;
  if (reader.remaining() < count * k_path_point_bytes) return Status::truncated;
  if (reader.remaining() > count * k_path_point_bytes) return Status::malformed;
  std::vector<PathPoint> points(count);
  for (PathPoint& point : points) {
    point.position = geometry::get_vector(reader);
    for (Unit* part : {&point.up.x, &point.up.y, &point.up.z})
      part->raw = reader.get<std::int32_t>();
  }
  const PathResult built = build(points, closed != 0);
  if (!built.ok()) return Status::malformed;
  return built.path;
}

std::span<const PathPoint> Path::points() const {
  return geometry_of(*this).points();
}
bool Path::is_closed() const {
  return geometry_of(*this).spline().is_closed();
}
Length Path::length() const {
  return rounded<Length>(geometry_of(*this).spline().length());
}
Transform Path::at(Length distance) const {
  const geometry::CurvePlace place = geometry_of(*this).spline().at(distance);
  return {place.point, orientation_of(place.frame)};
}
std::vector<std::byte> Path::canonical_bytes() const {
  return encode(points(), is_closed());
}

}  // namespace lockstone
