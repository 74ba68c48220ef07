// Vectors for pictures. Doubles are allowed here: nothing flows back into a simulation.
#pragma once

#include <array>
#include <cmath>

#include <lockstone/quat.h>
#include <lockstone/testing/floating.h>
#include <lockstone/vec3.h>

namespace lockstone::render {

struct Vec {
  double x = 0, y = 0, z = 0;

  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator*(const Vec& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

[[nodiscard]] inline double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double length(const Vec& a) {
  return std::sqrt(dot(a, a));
}
[[nodiscard]] inline Vec unit(const Vec& a) {
  return a * (1 / length(a));
}

template <class T>
[[nodiscard]] Vec to_vec(const Vec3<T>& v) {
  return {testing::to_double(v.x), testing::to_double(v.y), testing::to_double(v.z)};
}

/// A point of the picture, in metres to the right and up, and its nearness to the viewer.
struct Spot {
  double right = 0, up = 0, near = 0;
};

/// Parallel projection onto a plane seen from `yaw` (0: along −z) and above by `pitch`, in radians.
class Camera {
 public:
  Camera(const Vec& target, double yaw, double pitch)
      : target_(target),
        right_{std::cos(yaw), 0, -std::sin(yaw)},
        toward_{std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)},
        up_(cross(toward_, right_)) {}

  [[nodiscard]] Spot project(const Vec& point) const {
    const Vec offset = point - target_;
    return {dot(offset, right_), dot(offset, up_), dot(offset, toward_)};
  }

  /// Unit vectors of the picture in the world.
  [[nodiscard]] const Vec& toward() const { return toward_; }
  [[nodiscard]] const Vec& right() const { return right_; }
  [[nodiscard]] const Vec& up() const { return up_; }

 private:
  Vec target_;
  Vec right_;
  Vec toward_;
  Vec up_;
};

}  // namespace lockstone::render
