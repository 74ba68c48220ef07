// Clouds of points for the tests of hulls.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <lockstone/hull.h>

#include "tests/geometry/scene.h"

namespace lockstone::test {

using Cloud = std::vector<Vec3<Length>>;

inline Cloud in_cube(Dice& dice, int count, double half) {
  Cloud cloud;
  for (int i = 0; i < count; ++i)
    cloud.push_back(
        metres(dice.uniform(-half, half), dice.uniform(-half, half), dice.uniform(-half, half)));
  return cloud;
}

/// Whether no point lies within this many steps of a plane through three others.
inline bool is_in_general_position(const Cloud& cloud, Real steps) {
  const std::size_t count = cloud.size();
  const auto is_near = [&](std::size_t i, std::size_t j, std::size_t k) {
    const RealVec at = real(cloud[i]);
    const RealVec normal = cross(real(cloud[j]) - at, real(cloud[k]) - at);
    const Real reach = std::ldexp(steps, -Length::frac_bits) * norm(normal);
    for (std::size_t p = 0; p < count; ++p)
      if (p != i && p != j && p != k && std::fabs(dot(real(cloud[p]) - at, normal)) <= reach)
        return true;
    return false;
  };
  for (std::size_t k = 2; k < count; ++k)
    for (std::size_t pair = 0; pair < k * k; ++pair)
      if (pair % k < pair / k && is_near(pair % k, pair / k, k)) return false;
  return true;
}

inline Cloud on_sphere(Dice& dice, int count, double radius) {
  Cloud cloud;
  for (int i = 0; i < count; ++i)
    cloud.push_back(metres(dice.direction() * radius));
  return cloud;
}

/// Many coplanar, collinear and repeated ones.
inline Cloud on_grid(Dice& dice, int count, int cells, double step) {
  Cloud cloud;
  const auto coordinate = [&] { return static_cast<double>(dice.between(0, cells)) * step; };
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(), y = coordinate();
    cloud.push_back(metres(x, y, coordinate()));
  }
  return cloud;
}

inline Cloud prism(int sides, double radius, double half_height) {
  Cloud cloud;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / sides;
    for (const double y : {-half_height, half_height})
      cloud.push_back(metres(radius * std::cos(angle), y, radius * std::sin(angle)));
  }
  return cloud;
}

inline Cloud box(double x, double y, double z) {
  Cloud cloud;
  for (int i = 0; i < 8; ++i)
    cloud.push_back(metres((i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z));
  return cloud;
}

inline Cloud moved(Cloud cloud, const Vec3<Length>& by) {
  for (Vec3<Length>& p : cloud)
    p += by;
  return cloud;
}

inline Cloud turned(Cloud cloud, const Mat3& rotation) {
  for (Vec3<Length>& p : cloud)
    p = rotate(rotation, p);
  return cloud;
}

inline Cloud mirrored(Cloud cloud, int axis) {
  for (Vec3<Length>& p : cloud)
    p[axis] = -p[axis];
  return cloud;
}

inline Cloud shuffled(Dice& dice, Cloud cloud) {
  for (std::size_t i = cloud.size(); i > 1; --i)
    std::swap(cloud[i - 1], cloud[static_cast<std::size_t>(dice.next() % i)]);
  return cloud;
}

struct NamedCloud {
  std::string name;
  Cloud points;
};

/// One of each kind, all of which have a hull.
inline std::vector<NamedCloud> clouds(Dice& dice) {
  Cloud repeated = in_cube(dice, 40, 1);
  for (int i = 0; i < 1000; ++i)
    repeated.push_back(repeated[static_cast<std::size_t>(dice.between(0, 39))]);
  const Mat3 tilt = to_matrix(dice.orientation());
  const int sides = static_cast<int>(dice.between(3, 30));
  return {{"cube", in_cube(dice, static_cast<int>(dice.between(12, 300)), 1)},
          {"sphere", on_sphere(dice, static_cast<int>(dice.between(12, 120)), 0.5)},
          {"grid", on_grid(dice, 200, 4, 0.25)},
          {"tilted grid", turned(on_grid(dice, 200, 4, 0.25), tilt)},
          {"fine grid", on_grid(dice, 300, 20, 0.3)},
          {"repeated", repeated},
          {"prism", prism(sides, 0.5, 1)},
          {"tilted prism", turned(prism(sides, 0.5, 1), tilt)},
          {"tilted box", turned(box(1, 0.5, 0.25), tilt)},
          {"plate", turned(box(1, 0.0007, 1), tilt)},
          {"needle", turned(box(0.001, 0.001, 0.5), tilt)},
          {"huge", turned(prism(sides, 300, 350), tilt)},
          {"huge sphere", on_sphere(dice, 100, 510)},
          {"tiny", in_cube(dice, 60, 0.003)},
          {"far", moved(in_cube(dice, 60, 1), metres(-500, 400, 510))}};
}

}  // namespace lockstone::test
