#include "tools/render/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "tools/render/item.h"
#include "tools/render/overlay.h"

namespace lockstone::render {
namespace {

constexpr double k_pitch = 0.52;  // radians above the horizon
constexpr double k_yaw = 0.5;
const Vec k_light = unit({-0.35, 0.85, 0.45});

std::string css(Color color, double brightness) {
  const auto channel = [&](int value) {
    return std::clamp(static_cast<int>(std::lround(value * brightness)), 0, 255);
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(color.red), channel(color.green),
                     channel(color.blue));
}

double brightness_of(const Vec& normal) {
  return 0.62 + 0.46 * std::max(0.0, dot(normal, k_light));
}

/// Metres of the picture plane to pixels.
struct Canvas {
  const Camera& camera;
  double scale = 1, left = 0, top = 0;
  std::string out;

  [[nodiscard]] double x(double right) const { return (right - left) * scale; }
  [[nodiscard]] double y(double up) const { return (top - up) * scale; }
  [[nodiscard]] std::string point(const Vec& at) const {
    const Spot spot = camera.project(at);
    return fmt::format("{:.1f},{:.1f}", x(spot.right), y(spot.up));
  }
};

void draw_face(Canvas& canvas, const Solid& solid, std::size_t axis, double sign) {
  const double half[] = {solid.size.x, solid.size.y, solid.size.z};
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Vec middle = solid.center + solid.axes[axis] * (sign * half[axis]);
  const Vec along_u = solid.axes[u] * half[u], along_v = solid.axes[v] * half[v];
  const std::string fill = css(solid.color, brightness_of(solid.axes[axis] * sign));
  canvas.out += fmt::format(
      "<polygon points='{} {} {} {}' fill='{}' stroke='{}'{}/>\n",
      canvas.point(middle + along_u + along_v), canvas.point(middle - along_u + along_v),
      canvas.point(middle - along_u - along_v), canvas.point(middle + along_u - along_v), fill,
      css(solid.color, 0.55), solid.solid ? "" : " opacity='.35'");
}

void draw_box(Canvas& canvas, const Solid& solid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double facing = dot(solid.axes[axis], canvas.camera.toward());
    draw_face(canvas, solid, axis, facing > 0 ? 1 : -1);
  }
}

// A capsule is a thick line with round ends, a ball one without length; lit from the upper left.
void draw_round(Canvas& canvas, const Solid& solid, const Vec& from, const Vec& to) {
  const Spot a = canvas.camera.project(from), b = canvas.camera.project(to);
  const double radius = solid.radius() * canvas.scale;
  const std::array<std::pair<double, double>, 4> layers{
      {{1.0, 0.62}, {0.86, 0.85}, {0.62, 1.02}, {0.25, 1.22}}};
  for (const auto& [share, brightness] : layers) {
    const double shift = (1 - share) * radius * 0.55;
    canvas.out += fmt::format(
        "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-width='{:.1f}' "
        "stroke-linecap='round'/>\n",
        canvas.x(a.right) - shift, canvas.y(a.up) - shift, canvas.x(b.right) - shift + 0.01,
        canvas.y(b.up) - shift, css(solid.color, brightness), 2 * radius * share);
  }
}

// A stripe around the ball in the plane of two body axes, so that one sees it roll.
void draw_stripe(Canvas& canvas, const Solid& solid, const Vec& u, const Vec& v) {
  constexpr int k_parts = 24;
  std::string points;
  for (int i = 0; i <= k_parts; ++i) {
    const double angle = 2 * M_PI * i / k_parts;
    const Vec out = u * std::cos(angle) + v * std::sin(angle);
    const bool seen = dot(out, canvas.camera.toward()) > 0;
    if (seen) points += canvas.point(solid.center + out * (solid.radius() * 0.97)) + ' ';
    if ((!seen || i == k_parts) && !points.empty()) {
      canvas.out += fmt::format(
          "<polyline points='{}' fill='none' stroke='{}' "
          "stroke-width='{:.1f}'/>\n",
          points, css(solid.color, 0.5), std::max(1.0, solid.radius() * canvas.scale * 0.12));
      points.clear();
    }
  }
}

// A flat piece is seen from behind too, as glass: a body in a bowl should not be hidden.
void draw_facet(Canvas& canvas, const Solid& solid, const Facet& facet) {
  const bool front = dot(facet.normal, canvas.camera.toward()) > 0;
  if (!front && !solid.is_flat()) return;
  std::string points;
  for (const Vec& corner : facet.corners)
    points += canvas.point(corner) + ' ';
  const double brightness = front ? brightness_of(facet.normal) : 0.6;
  canvas.out += fmt::format("<polygon points='{}' fill='{}' stroke='{}' stroke-width='{}'{}/>\n",
                            points, css(solid.color, brightness),
                            css(solid.color, solid.is_flat() ? brightness * 0.86 : 0.55),
                            solid.is_flat() ? 0.5 : 1.0,
                            !front         ? " opacity='.2'"
                            : !solid.solid ? " opacity='.35'"
                                           : "");
}

// Lines of a half-space's piece, a metre or more from each other.
void draw_grid(Canvas& canvas, const Solid& solid) {
  constexpr double k_most_lines = 40;
  const double half = solid.size.x, step = std::ceil(2 * half / k_most_lines);
  const std::string color = css(solid.color, 0.8);
  const auto line = [&](const Vec& from, const Vec& to) {
    const Spot a = canvas.camera.project(from), b = canvas.camera.project(to);
    canvas.out += fmt::format(
        "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-width='.7'/>\n",
        canvas.x(a.right), canvas.y(a.up), canvas.x(b.right), canvas.y(b.up), color);
  };
  for (double at = -half; at <= half; at += step) {
    for (const auto& [along, across] :
         {std::pair(solid.axes[0], solid.axes[2]), std::pair(solid.axes[2], solid.axes[0])}) {
      const Vec middle = solid.center + across * at;
      line(middle - along * half, middle + along * half);
    }
  }
}

void draw_ball_or_capsule(Canvas& canvas, const Solid& solid) {
  const bool capsule = solid.kind == ShapeKind::capsule;
  const Vec half = capsule ? solid.axes[1] * solid.size.y : Vec{};
  if (!solid.solid) canvas.out += "<g opacity='.35'>\n";
  draw_round(canvas, solid, solid.center - half, solid.center + half);
  if (!capsule) {
    draw_stripe(canvas, solid, solid.axes[0], solid.axes[1]);
    draw_stripe(canvas, solid, solid.axes[1], solid.axes[2]);
  }
  if (!solid.solid) canvas.out += "</g>\n";
}

void draw_solid(Canvas& canvas, const Solid& solid) {
  if (solid.kind == ShapeKind::box) return draw_box(canvas, solid);
  const bool plane = solid.kind == ShapeKind::half_space;
  for (const Facet& facet : solid.facets) {
    if (!plane || solid.solid) draw_facet(canvas, solid, facet);  // a trigger is a grid alone
  }
  if (plane) draw_grid(canvas, solid);
  if (solid.facets.empty()) draw_ball_or_capsule(canvas, solid);
}
void draw_shadow(Canvas& canvas, const Solid& solid) {
  const Vec& at = solid.shadow_at;
  const Vec slope = solid.shadow_normal * (1 / solid.shadow_normal.y);
  std::string points;
  for (const Vec& corner : outline_from_above(solid)) {
    const double y = at.y - (corner.x - at.x) * slope.x - (corner.z - at.z) * slope.z;
    points += canvas.point({corner.x, y, corner.z}) + ' ';
  }
  canvas.out += fmt::format("<polygon points='{}' fill='#101418' opacity='{:.2f}'/>\n", points,
                            0.34 / (1 + 0.15 * std::max(0.0, solid.center.y - at.y)));
}

Frame frame_of_those(const std::vector<Item>& items, const Camera& camera, const auto& wanted) {
  std::optional<Frame> frame;
  for (const Item& item : items) {
    if (!wanted(item)) continue;
    const Frame own = frame_of(item.solid, camera);
    if (!frame) frame = own;
    frame->include(own);
  }
  return frame.value_or(Frame{-1, 1, -1, 1});
}

// Those near the middle of the moving bodies: a few that fly far away should not make all the
// others small.
std::vector<bool> find_central(const std::vector<Item>& items) {
  constexpr double k_far = 3;
  std::vector<Vec> centers;
  for (const Item& item : items) {
    if (item.moves) centers.push_back(item.solid.center);
  }
  if (centers.empty()) return std::vector<bool>(items.size(), true);
  const auto quantile = [](std::vector<double> values, std::size_t percent) {
    const std::size_t index = (values.size() - 1) * percent / 100;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index),
                     values.end());
    return values[index];
  };
  const auto median = [&](double Vec::*axis) {
    std::vector<double> values;
    for (const Vec& center : centers)
      values.push_back(center.*axis);
    return quantile(values, 50);
  };
  const Vec middle{median(&Vec::x), median(&Vec::y), median(&Vec::z)};
  std::vector<double> distances;
  for (const Vec& center : centers)
    distances.push_back(length(center - middle));
  const double bound = k_far * (1 + quantile(distances, 80));
  std::vector<bool> central;
  for (const Item& item : items)
    central.push_back(length(item.solid.center - middle) < bound);
  return central;
}

// The picture should show moving bodies, unless they are falling out of the world, and scenery that
// is not much wider than these: of a vast floor a part is enough.
Frame frame_all(const std::vector<Item>& items, const Camera& camera) {
  constexpr double k_fallen = 0.5, k_vast = 1.7, k_small = 7, k_border = 1.0;
  const std::vector<bool> central = find_central(items);
  double floor = 0;
  for (const Item& item : items) {
    if (!item.moves) floor = std::min(floor, item.solid.center.y);
  }
  const auto moves = [&](const Item& item) {
    const bool near = central[static_cast<std::size_t>(&item - items.data())];
    return item.moves && near && (floor == 0 || item.solid.center.y > floor - k_fallen);
  };
  Frame frame = frame_of_those(items, camera, moves);
  frame = {frame.left - k_border, frame.right + k_border, frame.low - k_border,
           frame.high + k_border};
  const double vast =
      k_vast * std::max({k_small, frame.right - frame.left, frame.high - frame.low});
  frame.include(frame_of_those(items, camera, [&](const Item& item) {
    const Frame own = frame_of(item.solid, camera);
    if (item.solid.kind == ShapeKind::half_space) return false;
    return moves(item) || (!item.moves && own.right - own.left < vast);
  }));
  return frame;
}

Canvas make_canvas(const Camera& camera, const Frame& frame, const Picture& picture) {
  constexpr double k_margin = 1.06;
  const double wide = std::max(1.0, (frame.right - frame.left) * k_margin);
  const double high = std::max(1.0, (frame.high - frame.low) * k_margin);
  const double scale = std::min(picture.width / wide, picture.height / high);
  const double middle = (frame.left + frame.right) / 2, center = (frame.low + frame.high) / 2;
  return {
      camera, scale, middle - picture.width / scale / 2, center + picture.height / scale / 2, {}};
}

void draw_items(Canvas& canvas, const std::vector<Item>& items) {
  std::vector<Solid> solids;
  for (const Item& item : items)
    solids.push_back(item.solid);
  for (const std::size_t i : paint_order(solids, canvas.camera)) {
    if (items[i].over_own_shadow) draw_shadow(canvas, solids[i]);
    draw_solid(canvas, solids[i]);
    for (const std::size_t caster : items[i].shadows)
      draw_shadow(canvas, solids[caster]);
  }
}

void draw_labels(Canvas& canvas, const std::vector<Item>& items) {
  for (const Item& item : items) {
    if (item.label.empty()) continue;
    const Vec above{item.solid.center.x, item.solid.reach({0, 1, 0}) + 0.25, item.solid.center.z};
    const Spot spot = canvas.camera.project(above);
    canvas.out += fmt::format(
        "<text x='{:.1f}' y='{:.1f}' font-size='17' font-weight='bold' text-anchor='middle' "
        "fill='#fff' stroke='#222' stroke-width='3' paint-order='stroke'>{}</text>\n",
        canvas.x(spot.right), canvas.y(spot.up), item.label);
  }
}

std::string open_svg(int width, int height) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
      "stroke-linejoin='round' font-family='sans-serif'>\n"
      "<defs><linearGradient id='sky' x1='0' y1='0' x2='0' y2='1'><stop offset='0' "
      "stop-color='#8fb4cf'/><stop offset='1' stop-color='#e3ecf0'/></linearGradient></defs>\n",
      width, height);
}

// A band at the lower edge, so that it can be read before any background.
std::string caption(const Picture& picture) {
  constexpr int k_band = 26;
  if (picture.caption.empty()) return {};
  return fmt::format(
      "<rect y='{}' width='{}' height='{}' fill='#fff' opacity='.8'/>\n"
      "<text x='10' y='{}' font-size='14' fill='#203040' xml:space='preserve'>{}</text>\n",
      picture.height - k_band, picture.width, k_band, picture.height - 8, picture.caption);
}

Camera make_camera() {
  return {Vec{}, k_yaw, k_pitch};
}

}  // namespace

Frame framing(const World& world, const Picture& picture) {
  return frame_all(collect_items(world, picture.style), make_camera());
}

std::string draw(const World& world, const Picture& picture, const Frame& frame) {
  std::vector<Item> items = collect_items(world, picture.style);
  cast_shadows(world, items);
  const Camera camera = make_camera();
  Canvas canvas = make_canvas(camera, frame, picture);
  canvas.out = open_svg(picture.width, picture.height);
  canvas.out += "<rect width='100%' height='100%' fill='url(#sky)'/>\n";
  draw_items(canvas, items);
  draw_labels(canvas, items);
  if (picture.overlay)
    canvas.out += overlay(world, [&](const Vec& at) { return canvas.point(at); });
  canvas.out += caption(picture) + "</svg>\n";
  return std::move(canvas.out);
}

std::string draw(const World& world, const Picture& picture) {
  return draw(world, picture, framing(world, picture));
}

std::string strip(const std::vector<std::string>& pictures, const Picture& picture, int columns) {
  constexpr int k_gap = 4;
  const int count = static_cast<int>(pictures.size());
  const int rows = (count + columns - 1) / columns;
  const int wide = picture.width + k_gap, high = picture.height + k_gap;
  std::string out = open_svg(wide * std::min(columns, count) - k_gap, high * rows - k_gap);
  for (int i = 0; i < count; ++i) {
    out += fmt::format("<svg x='{}' y='{}' width='{}' height='{}'>\n", i % columns * wide,
                       i / columns * high, picture.width, picture.height);
    out += pictures[static_cast<std::size_t>(i)] + "</svg>\n";
  }
  return out + "</svg>\n";
}

}  // namespace lockstone::render
