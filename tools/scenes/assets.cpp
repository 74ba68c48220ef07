#include "tools/scenes/assets.h"

#include <array>
#include <vector>

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr Angle k_quarter_turn = 1.5707963_rad;

Length share(Unit part, Length whole) {
  return rounded<Length>(part * whole);
}

// Component by component.
Point scaled(const Vec3<Unit>& direction, const Point& half_axes) {
  return {share(direction.x, half_axes.x), share(direction.y, half_axes.y),
          share(direction.z, half_axes.z)};
}

// In the direction of part `i` of `count` of a turn.
Vec3<Unit> spoke(int i, int count) {
  return arena::direction_of(static_cast<std::int16_t>(i * 65536 / count));
}

AssetPtr mesh_of(std::span<const Point> vertices, std::span<const TriangleIndices> triangles) {
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  const MeshResult made = Mesh::build(def);
  LKS_CHECK(made.ok());
  return made.mesh;
}

void add_quad(std::vector<TriangleIndices>& triangles, std::uint32_t a, std::uint32_t b,
              std::uint32_t c, std::uint32_t d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

// Four legs under a top whose corners they stand at.
void add_legs(std::vector<CompoundChild>& children, Length x, Length z, const Point& half) {
  for (const Length at_x : {x, -x}) {
    for (const Length at_z : {z, -z})
      children.push_back(box_child({at_x, half.y, at_z}, half));
  }
}

}  // namespace

AssetPtr hull_of(std::span<const Point> points) {
  const HullResult made = Hull::build(points);
  LKS_CHECK(made.ok());
  return made.hull;
}

AssetPtr random_hull(Random& random, const Point& half_axes, int count) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i)
    points.push_back(scaled(to_matrix(random_orientation(random)).x, half_axes));
  return hull_of(points);
}

AssetPtr wedge(Length half_x, Length half_y, Length half_z) {
  const std::array<Point, 6> points{{{-half_x, -half_y, -half_z},
                                     {-half_x, -half_y, half_z},
                                     {-half_x, half_y, -half_z},
                                     {-half_x, half_y, half_z},
                                     {half_x, {}, -half_z},
                                     {half_x, {}, half_z}}};
  return hull_of(points);
}

AssetPtr prism(int sides, Length radius, Length half_height) {
  std::vector<Point> points;
  for (int i = 0; i < sides; ++i) {
    Point point = scaled(spoke(i, sides), {radius, {}, radius});
    for (const Length y : {half_height, -half_height}) {
      point.y = y;
      points.push_back(point);
    }
  }
  return hull_of(points);
}

AssetPtr compound_of(std::span<const CompoundChild> children) {
  const CompoundResult made = Compound::build(children);
  LKS_CHECK(made.ok());
  return made.compound;
}

CompoundChild box_child(const Point& position, const Point& half_extents, Number density) {
  CompoundChild child;
  child.shape = Shape::box(half_extents.x, half_extents.y, half_extents.z);
  child.position = position;
  child.density = density;
  return child;
}

AssetPtr chair() {
  std::vector<CompoundChild> children{box_child({{}, 0.45_m, {}}, {0.25_m, 0.03_m, 0.25_m}),
                                      box_child({{}, 0.78_m, -0.225_m}, {0.25_m, 0.3_m, 0.025_m})};
  add_legs(children, 0.22_m, 0.22_m, {0.025_m, 0.21_m, 0.025_m});
  return compound_of(children);
}

AssetPtr table() {
  std::vector<CompoundChild> children{box_child({{}, 0.75_m, {}}, {0.8_m, 0.03_m, 0.5_m})};
  add_legs(children, 0.7_m, 0.4_m, {0.04_m, 0.36_m, 0.04_m});
  return compound_of(children);
}

AssetPtr dumbbell() {
  std::array<CompoundChild, 3> children;
  children[0].shape = children[1].shape = Shape::sphere(0.25_m);
  children[0].position = {-0.5_m, {}, {}};
  children[1].position = {0.5_m, {}, {}};
  children[2].shape = Shape::capsule(0.4_m, 0.06_m);
  children[2].orientation = from_axis_angle(k_z_axis, k_quarter_turn);
  return compound_of(children);
}

AssetPtr hammer() {
  const std::array<CompoundChild, 2> children{
      {box_child({{}, 0.4_m, {}}, {0.03_m, 0.4_m, 0.03_m}, 0.7_r),
       box_child({{}, 0.87_m, {}}, {0.18_m, 0.07_m, 0.07_m}, 7.8_r)}};
  return compound_of(children);
}

AssetPtr axe() {
  std::array<CompoundChild, 2> children;
  children[0] = box_child({{}, 0.5_m, {}}, {0.03_m, 0.5_m, 0.03_m}, 0.7_r);
  children[1].asset = wedge(0.15_m, 0.06_m, 0.04_m);
  children[1].shape = children[1].asset->shape();
  children[1].orientation = from_axis_angle(k_x_axis, k_quarter_turn);
  children[1].position = {0.12_m, 0.9_m, {}};
  children[1].density = 7.8_r;
  return compound_of(children);
}

AssetPtr panels(std::uint32_t columns, std::uint32_t rows, std::int32_t side_mm) {
  std::vector<Point> vertices;
  const auto place = [&](std::uint32_t i, std::uint32_t count) {
    return millimetres_long((2 * static_cast<std::int32_t>(i) - static_cast<std::int32_t>(count)) *
                            side_mm / 2);
  };
  for (std::uint32_t z = 0; z <= rows; ++z) {
    for (std::uint32_t x = 0; x <= columns; ++x)
      vertices.push_back({place(x, columns), {}, place(z, rows)});
  }
  std::vector<TriangleIndices> triangles;
  std::vector<std::uint16_t> groups;
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    const std::uint32_t corner = i / columns * (columns + 1) + i % columns;
    add_quad(triangles, corner, corner + columns + 1, corner + columns + 2, corner + 1);
    groups.insert(groups.end(), 2, static_cast<std::uint16_t>(i));
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  def.triangle_groups = groups;
  const MeshResult made = Mesh::build(def);
  LKS_CHECK(made.ok());
  return made.mesh;
}

AssetPtr extruded(std::span<const Point> profile, Length half_width, int strips) {
  const auto points = static_cast<std::uint32_t>(profile.size());
  std::vector<Point> vertices;
  std::vector<TriangleIndices> triangles;
  for (int strip = 0; strip <= strips; ++strip) {
    const Length z = Length::from_raw(half_width.raw / strips * (2 * strip - strips));
    for (const Point& point : profile)
      vertices.push_back({point.x, point.y, z});
    if (strip == 0) continue;
    const std::uint32_t near = static_cast<std::uint32_t>(strip) * points, far = near - points;
    for (std::uint32_t i = 0; i + 1 < points; ++i)
      add_quad(triangles, far + i, near + i, near + i + 1, far + i + 1);
  }
  return mesh_of(vertices, triangles);
}

AssetPtr bowl(Length radius, Length depth, int rings, int segments) {
  std::vector<Point> vertices{{}};
  std::vector<TriangleIndices> triangles;
  const auto vertex = [&](int ring, int segment) {
    return ring == 0 ? 0U
                     : static_cast<std::uint32_t>(1 + (ring - 1) * segments + segment % segments);
  };
  for (int ring = 1; ring <= rings; ++ring) {
    const Length reach = Length::from_raw(radius.raw / rings * ring);
    for (int i = 0; i < segments; ++i) {
      Point point = scaled(spoke(i, segments), {reach, {}, reach});
      point.y = Length::from_raw(depth.raw / (rings * rings) * ring * ring);
      vertices.push_back(point);
      const std::uint32_t outer = vertex(ring, i), next = vertex(ring, i + 1);
      if (ring == 1) triangles.push_back({0, next, outer});
      if (ring > 1) add_quad(triangles, vertex(ring - 1, i), vertex(ring - 1, i + 1), next, outer);
    }
  }
  return mesh_of(vertices, triangles);
}

AssetPtr wall_mesh(Length half_width, Length half_height) {
  const std::array<Point, 4> vertices{{{{}, -half_height, -half_width},
                                       {{}, -half_height, half_width},
                                       {{}, half_height, half_width},
                                       {{}, half_height, -half_width}}};
  const std::array<TriangleIndices, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  return mesh_of(vertices, triangles);
}

}  // namespace lockstone::scenes
