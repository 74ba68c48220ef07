#include "tools/bench/neutral/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstone::bench {

double NeutralBody::mass() const {
  const double volume = is_box() ? 8 * size[0] * size[1] * size[2]
                                 : 4 * std::numbers::pi / 3 * size[0] * size[0] * size[0];
  return density * volume;
}

Triple NeutralBody::moments_over_mass() const {
  const double x = size[0] * size[0], y = size[1] * size[1], z = size[2] * size[2];
  if (is_box()) return {(y + z) / 3, (z + x) / 3, (x + y) / 3};
  return {0.4 * x, 0.4 * x, 0.4 * x};
}

int NeutralScene::ticks() const {
  return static_cast<int>(std::lround(seconds * k_scene_tick_rate));
}

Triple NeutralScene::gravity_at(double time) const {
  if (tilt.empty()) return {0, -gravity, 0};
  double degrees = tilt.back().degrees;
  const auto after =
      std::find_if(tilt.begin(), tilt.end(), [&](const NeutralTilt& t) { return t.time > time; });
  if (after == tilt.begin()) {
    degrees = tilt.front().degrees;
  } else if (after != tilt.end()) {
    const NeutralTilt &from = *(after - 1), &to = *after;
    const double share = (time - from.time) / (to.time - from.time);
    degrees = from.degrees + (to.degrees - from.degrees) * share;
  }
  const double angle = degrees * std::numbers::pi / 180;
  return {gravity * std::sin(angle), -gravity * std::cos(angle), 0};
}

NeutralBody neutral_ball(double radius, Triple position, double density) {
  NeutralBody body;
  body.size = {radius, radius, radius};
  body.position = position;
  body.density = density;
  return body;
}

NeutralBody neutral_box(Triple half_extents, Triple position, double density) {
  NeutralBody body = neutral_ball(0, position, density);
  body.shape = "box";
  body.size = half_extents;
  return body;
}

NeutralBody neutral_ground() {
  NeutralBody body = neutral_box({100, 1, 100}, {0, -1, 0});
  body.fixed = true;
  return body;
}

NeutralBody neutral_pivot() {
  NeutralBody body = neutral_ball(0.01, {});
  body.fixed = true;
  body.collides = false;
  return body;
}

const std::vector<NeutralScene>& neutral_scenes() {
  static const std::vector<NeutralScene> scenes = [] {
    std::vector<NeutralScene> all;
    add_flight_scenes(all);
    add_contact_scenes(all);
    add_joint_scenes(all);
    add_large_scenes(all);
    return all;
  }();
  return scenes;
}

const NeutralScene* find_neutral_scene(std::string_view name) {
  const auto& all = neutral_scenes();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const NeutralScene& scene) { return scene.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace lockstone::bench
