#include "tools/render/overlay.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace lockstone::render {
namespace {

constexpr double k_axis = 0.25;        // metres, of a frame's axes
constexpr double k_newton = 1 / 2e4;   // metres of an arrow for each newton
constexpr double k_longest_arrow = 3;  // metres
constexpr const char* k_colors[] = {"#d02020", "#20a020", "#2040e0"};

class Overlay final : public DebugDraw {
 public:
  explicit Overlay(const PlaceInPicture& place) : place_(place) {}

  void draw_shape(const DebugShape& shape) override {
    if (shape.state == DebugState::asleep) asleep_.insert(shape.body);
    if (shape.state == DebugState::static_body) still_.insert(shape.body);
  }

  void draw_bounds(const DebugBounds& bounds) override {
    if (still_.contains(bounds.body)) return;
    const Vec low = to_vec(bounds.lower), high = to_vec(bounds.upper);
    const char* dashes = asleep_.contains(bounds.body) ? " stroke-dasharray='2 3'" : "";
    const auto corner = [&](int i) {
      return Vec{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                 (i & 4) != 0 ? high.z : low.z};
    };
    for (int i = 0; i < 8; ++i)
      for (const int bit : {1, 2, 4})
        if ((i & bit) == 0) line(corner(i), corner(i | bit), "#404850", 0.6, dashes);
  }

  void draw_mass(const DebugMass& mass) override { axes(to_vec(mass.centre), mass.axes, 1); }

  void draw_contact(const DebugContact& contact) override {
    const Vec normal = to_vec(contact.normal);
    for (std::uint32_t i = 0; i < contact.count; ++i) {
      const DebugContactPoint& point = contact.points[i];
      const Vec from = to_vec(point.point);
      const double length = std::min(testing::to_double(point.force) * k_newton, k_longest_arrow);
      line(from, from + normal * std::max(length, 0.05), "#e08000", 2);
      dot_at(from, contact.touching ? "#e00000" : "#e0c000");
    }
  }

  void draw_joint(const DebugJoint& joint) override {
    const Vec a = to_vec(joint.place_a), b = to_vec(joint.place_b);
    axes(a, joint.frame_a, 2);
    axes(b, joint.frame_b, 1);
    line(a, b, "#c000c0", 2);
    for (std::size_t i = 0; i < 3; ++i) {
      if (joint.modes[i] != AxisMode::limited) continue;
      const Vec axis = column(joint.frame_a, i);
      line(a + axis * testing::to_double(joint.linear_lower[i]),
           a + axis * testing::to_double(joint.linear_upper[i]), "#c000c0", 1);
    }
  }

  std::string out;

 private:
  [[nodiscard]] static Vec column(const Mat3& m, std::size_t i) {
    const Vec columns[] = {to_vec(m.x), to_vec(m.y), to_vec(m.z)};
    return columns[i];
  }

  void line(const Vec& from, const Vec& to, const char* color, double width,
            const char* more = "") {
    out += fmt::format("<polyline points='{} {}' fill='none' stroke='{}' stroke-width='{}'{}/>\n",
                       place_(from), place_(to), color, width, more);
  }

  void dot_at(const Vec& at, const char* color) {
    out += fmt::format(
        "<polyline points='{0} {0}' stroke='{1}' stroke-width='6' stroke-linecap='round'/>\n",
        place_(at), color);
  }

  void axes(const Vec& at, const Mat3& frame, double width) {
    for (std::size_t i = 0; i < 3; ++i)
      line(at, at + column(frame, i) * k_axis, k_colors[i], width);
  }

  const PlaceInPicture& place_;
  std::set<BodyHandle> asleep_, still_;
};

}  // namespace

std::string overlay(const World& world, const PlaceInPicture& place) {
  Overlay lines(place);
  world.draw(lines,
             {.shapes = true, .bounds = true, .masses = true, .contacts = true, .joints = true});
  return std::move(lines.out);
}

}  // namespace lockstone::render
