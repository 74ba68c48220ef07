// The shape of a body as parts and triangles, for pictures.
#include <algorithm>
#include <array>
#include <vector>

#include <lockstone/testing/floating.h>
#include <lockstone/world.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/polytope_box.h"
#include "core/geometry/convex/rounded_facets.h"
#include "core/geometry/distance/contact_point.h"
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/web/native/lockstone_web.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr std::size_t k_triangle_numbers = 9;

template <class T>
std::array<float, 3> floats(const Vec3<T>& v) {
  const auto number = [](T x) { return static_cast<float>(testing::to_double(x)); };
  return {number(v.x), number(v.y), number(v.z)};
}

/// Takes a shape apart.
class Outline final : public geometry::PartVisitor {
 public:
  void visit(const geometry::Part& part) override {
    if (part.polytope != nullptr)
      add_faces(*part.polytope, part.position, part.rotation);
    else
      add_part(part.shape, part.position, part.rotation);
  }

  void add_part(const Shape& shape, const Vec3<Length>& position, const Mat3& rotation) {
    if (shape.kind == ShapeKind::rounded_box) {
      const geometry::BoxPolytope box(shape.size, shape.fourth_size());
      return add_faces(box.view(), position, rotation);
    }
    lks_web_part part{};
    part.kind = static_cast<std::uint32_t>(shape.kind);
    std::ranges::copy(floats(shape.size), part.size);
    std::ranges::copy(floats(position), part.place);
    const std::array columns{floats(rotation.x), floats(rotation.y), floats(rotation.z)};
    for (std::size_t i = 0; i < 3; ++i)
      std::ranges::copy(columns[i], part.axes + 3 * i);
    parts.push_back(part);
  }

  // A fan of triangles for each face or facet; a triangle of a mesh has its front alone.
  void add_faces(const geometry::Polytope& polytope, const Vec3<Length>& position,
                 const Mat3& rotation) {
    if (polytope.radius > Length{}) {
      const geometry::RoundedFacets facets(polytope, geometry::FacetReach::surface);
      return facets.for_each([&](std::span<const geometry::RawVec> corners) {
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
          for (const std::size_t corner : {std::size_t{0}, i, i + 1})
            add_point(geometry::to_length(corners[corner]), position, rotation);
        }
      });
    }
    const std::size_t faces = geometry::is_flat(polytope) ? 1 : polytope.faces.size();
    for (const geometry::PolytopeFace& face : polytope.faces.first(faces)) {
      for (int i = 1; i + 1 < face.edge_count; ++i) {
        for (const int corner : {0, i, i + 1})
          add_point(geometry::start_of(polytope, face.first_edge + corner), position, rotation);
      }
    }
  }

  std::vector<lks_web_part> parts;
  std::vector<float> numbers;

 private:
  void add_point(const Vec3<Length>& point, const Vec3<Length>& position, const Mat3& rotation) {
    const auto p = floats(point), place = floats(position);
    const std::array columns{floats(rotation.x), floats(rotation.y), floats(rotation.z)};
    for (std::size_t i = 0; i < 3; ++i) {
      numbers.push_back(place[i] + columns[0][i] * p[0] + columns[1][i] * p[1] +
                        columns[2][i] * p[2]);
    }
  }
};

Outline outline_of(const World& world, BodyHandle body) {
  const Shape shape = world.body(body).shape;
  const geometry::AssetGeometry* asset = geometry_of(world, body);
  const Mat3 straight = to_matrix(Quat{});
  Outline outline;
  if (asset == nullptr)
    outline.add_part(shape, {}, straight);
  else if (asset->polytope() != nullptr)
    outline.add_faces(*asset->polytope(), {}, straight);
  else
    asset->visit_parts(asset->bounds(), outline);
  return outline;
}

template <class T>
void give_some(const std::vector<T>& all, T* out, std::size_t capacity) {
  std::copy_n(all.begin(), std::min(all.size(), capacity), out);
}

}  // namespace

lks_status lks_web_outline(const lks_world* world, lks_body body, lks_web_part* parts,
                           size_t part_capacity, size_t* part_count, float* triangles,
                           size_t triangle_capacity, size_t* triangle_count) {
  return call([&] {
    const World& source = read(world);
    const Outline outline = outline_of(source, existing_body(source, body));
    give_some(outline.parts, parts, part_capacity);
    give_some(outline.numbers, triangles, triangle_capacity * k_triangle_numbers);
    required(triangle_count, "triangle_count") = outline.numbers.size() / k_triangle_numbers;
    give_count(outline.parts.size(), part_capacity, required(part_count, "part_count"), "parts");
    if (outline.numbers.size() > triangle_capacity * k_triangle_numbers)
      throw_status(LKS_BUFFER_TOO_SMALL, "there are more triangles than room");
  });
}
