#include "tools/render/item.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <lockstone/compound.h>
#include <lockstone/literals.h>
#include <lockstone/vehicle.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/parts.h"
#include "tools/render/convex_facets.h"

namespace lockstone::render {
namespace {

using namespace lockstone::literals;

/// Where a frame lies in the world, in doubles.
struct Place {
  Vec origin;
  std::array<Vec, 3> axes;

  [[nodiscard]] Vec turned(const Vec& v) const {
    return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
  }
  [[nodiscard]] Vec at(const Vec& v) const { return origin + turned(v); }
  [[nodiscard]] Place then(const Vec& position, const Mat3& rotation) const {
    return {at(position),
            {turned(to_vec(rotation.x)), turned(to_vec(rotation.y)), turned(to_vec(rotation.z))}};
  }
};

Vec middle_of(const std::vector<Vec>& points) {
  Vec sum;
  for (const Vec& point : points)
    sum = sum + point;
  return sum * (1 / static_cast<double>(points.size()));
}

// The first `faces` faces of a polyhedron.
std::vector<Facet> facets_of(const geometry::Polytope& polytope, const Place& place,
                             std::size_t faces) {
  std::vector<Facet> facets;
  for (const geometry::PolytopeFace& face : polytope.faces.first(faces)) {
    Facet facet{place.turned(to_vec(face.normal)), {}};
    for (int edge = face.first_edge; edge < face.first_edge + face.edge_count; ++edge)
      facet.corners.push_back(place.at(to_vec(geometry::start_of(polytope, edge))));
    facets.push_back(std::move(facet));
  }
  return facets;
}

Color tinted(Color color, const Surface* surface) {
  if (surface == nullptr) return color;
  const double rough = std::min(1.0, testing::to_double(surface->friction));
  const auto blend = [&](int smooth, int own) {
    return static_cast<int>(smooth + (own - smooth) * rough);
  };
  return {blend(200, color.red), blend(225, color.green), blend(245, color.blue)};
}

/// Takes a body apart.
class Pieces final : public geometry::PartVisitor {
 public:
  Pieces(std::vector<Item>& items, Item body, Place place)
      : items_(items), body_(std::move(body)), place_(std::move(place)) {}

  void visit(const geometry::Part& part) override {
    add(part.shape, part.polytope, place_.then(to_vec(part.position), part.rotation), part.surface);
  }

  void add(const Shape& shape, const geometry::Polytope* polytope, const Place& place,
           const Surface* surface) {
    Item item = body_;
    item.solid.kind = shape.kind;
    item.solid.center = place.origin;
    item.solid.axes = place.axes;
    item.solid.size = to_vec(shape.size);
    item.solid.color = tinted(item.solid.color, surface);
    const auto inner = polytope == nullptr ? hull_within(shape) : hull_within(*polytope);
    if (inner != nullptr) polytope = inner->geometry().polytope();
    if (polytope != nullptr) {
      const bool flat = geometry::is_flat(*polytope);
      item.solid.facets = facets_of(*polytope, place, flat ? 1 : polytope->faces.size());
      item.solid.center =
          flat ? middle_of(item.solid.facets[0].corners) : place.at(to_vec(polytope->interior));
    }
    items_.push_back(std::move(item));
    body_.label.clear();  // once is enough
  }

 private:
  std::vector<Item>& items_;
  Item body_;
  Place place_;
};

Item blank_item(BodyHandle body, const BodyView& view, const Look& look) {
  Item item;
  item.body = body;
  item.label = look.label;
  item.moves = view.motion != MotionType::static_body;
  item.solid.color = look.color;
  item.solid.solid = !view.is_trigger;
  return item;
}

Place place_of(const BodyView& view) {
  const Mat3 axes = to_matrix(view.orientation);
  return {to_vec(view.position), {to_vec(axes.x), to_vec(axes.y), to_vec(axes.z)}};
}

// Of a vehicle, if the body is its chassis: they throw no shadows, and do not count for the
// framing.
void add_wheels(const World& world, BodyHandle body, const Item& blank, const Place& place,
                std::vector<Item>& items) {
  const std::optional<VehicleView> vehicle = vehicle_of(world, body);
  if (!vehicle) return;
  Item wheel = blank;
  wheel.moves = false;
  wheel.label.clear();
  wheel.solid.color = {64, 66, 72};
  for (std::size_t i = 0; i < std::size_t{2} * vehicle->def.axle_count; ++i) {
    const Axle& axle = vehicle->def.axles[i / 2];
    if (i % 2 != 0 && axle.half_track == Length{}) continue;
    const double sine = testing::to_double(vehicle->wheels[i].steer_sin);
    const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    const Vec ahead = place.turned({cosine, 0, sine}), across = place.turned({-sine, 0, cosine});
    const Place at{to_vec(vehicle->wheels[i].centre), {ahead, across, place.axes[1] * -1}};
    Pieces(items, wheel, at)
        .add(Shape::cylinder(axle.radius / 4, axle.radius), nullptr, at, nullptr);
  }
}

void add_body(const World& world, BodyHandle body, const Style& style, std::vector<Item>& items) {
  const BodyView view = world.body(body);
  const Look look = style(body, view);
  if (!look.visible || view.shape.kind == ShapeKind::half_space) return;
  const Item blank = blank_item(body, view, look);
  add_wheels(world, body, blank, place_of(view), items);
  Pieces pieces(items, blank, place_of(view));
  const geometry::AssetGeometry* asset = geometry_of(world, body);
  const geometry::Polytope* polytope = asset == nullptr ? nullptr : asset->polytope();
  if (asset == nullptr || polytope != nullptr) {
    pieces.add(view.shape, polytope, place_of(view), nullptr);
  } else {
    asset->visit_parts(asset->bounds(), pieces);
  }
}

/// Where everything is.
struct Extent {
  Vec middle;
  double radius = 0;
};

// Of the moving bodies, if there are any.
Extent extent_of(const std::vector<Item>& items) {
  std::vector<Vec> centers;
  const bool moving =
      std::any_of(items.begin(), items.end(), [](const Item& i) { return i.moves; });
  for (const Item& item : items) {
    if (item.moves == moving) centers.push_back(item.solid.center);
  }
  Extent extent;
  if (centers.empty()) return extent;
  extent.middle = middle_of(centers);
  for (const Vec& center : centers)
    extent.radius = std::max(extent.radius, length(center - extent.middle));
  return extent;
}

// A square piece of the plane, its corners on whole metres of the body's frame.
void add_half_space(const World& world, BodyHandle body, const Style& style, const Extent& extent,
                    std::vector<Item>& items) {
  const BodyView view = world.body(body);
  const Look look = style(body, view);
  if (!look.visible) return;
  const Place place = place_of(view);
  const Vec offset = extent.middle - place.origin;
  const double x = std::round(dot(offset, place.axes[0])),
               z = std::round(dot(offset, place.axes[2]));
  const double half = std::ceil(extent.radius * 1.2) + 3;
  Item item = blank_item(body, view, look);
  item.solid.kind = ShapeKind::half_space;
  item.solid.center = place.at({x, 0, z});
  item.solid.axes = place.axes;
  item.solid.size = {half, 0, half};
  item.solid.facets = {{place.axes[1],
                        {place.at({x - half, 0, z - half}), place.at({x - half, 0, z + half}),
                         place.at({x + half, 0, z + half}), place.at({x + half, 0, z - half})}}};
  items.push_back(std::move(item));
}

Position to_position(double x) {
  return Position::from_raw(std::llround(x * 4294967296.0));
}

// Whether a body is one piece, onto which a shadow can be drawn.
bool is_one_piece(ShapeKind kind) {
  return is_primitive(kind) || kind == ShapeKind::hull || kind == ShapeKind::half_space;
}

void cast_shadow(const World& world, std::vector<Item>& items, std::size_t caster,
                 const std::vector<std::size_t>& place) {
  Item& item = items[caster];
  const Vec& from = item.solid.center;
  const RayHit hit = world.cast_ray({to_position(from.x), to_position(from.y), to_position(from.z)},
                                    {{}, -40_m, {}}, {.ignore = item.body});
  if (hit.body.is_null() || place[hit.body.index] == items.size()) return;
  // None at all: the ray began inside something. Too steep: the shadow would be a long streak.
  if (hit.normal.y < Unit(0.3_r)) return;
  const ShapeKind kind = world.body(hit.body).shape.kind;
  item.solid.shadow = true;
  item.solid.shadow_at = to_vec(hit.point) + Vec{0, 0.01, 0};
  if (!is_primitive(kind) || kind == ShapeKind::box) item.solid.shadow_normal = to_vec(hit.normal);
  item.over_own_shadow = !is_one_piece(kind);
  if (!item.over_own_shadow) items[place[hit.body.index]].shadows.push_back(caster);
}

}  // namespace

std::vector<Item> collect_items(const World& world, const Style& style) {
  std::vector<Item> items;
  std::vector<BodyHandle> half_spaces;
  for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
    const BodyHandle body = world.body_at(index);
    if (body.is_null()) continue;
    if (world.body(body).shape.kind == ShapeKind::half_space) half_spaces.push_back(body);
    add_body(world, body, style, items);
  }
  const Extent extent = extent_of(items);
  for (const BodyHandle body : half_spaces)
    add_half_space(world, body, style, extent, items);
  return items;
}

void cast_shadows(const World& world, std::vector<Item>& items) {
  std::vector<std::size_t> place(world.body_limit(), items.size());
  for (std::size_t i = 0; i < items.size(); ++i)
    place[items[i].body.index] = i;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].moves && items[i].solid.solid) cast_shadow(world, items, i, place);
  }
}

}  // namespace lockstone::render
