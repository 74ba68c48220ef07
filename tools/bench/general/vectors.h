// Vectors and turns in double precision, for scenes and measures.
#pragma once

#include <cmath>

#include "tools/bench/general/scene.h"

namespace lockstone::bench::general {

inline Triple operator+(const Triple& a, const Triple& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Triple operator-(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Triple operator*(double s, const Triple& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Triple& a) {
  return std::sqrt(dot(a, a));
}

inline Turn operator*(const Turn& a, const Turn& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}
inline Turn inverse(const Turn& q) {
  return {-q[0], -q[1], -q[2], q[3]};
}
inline Triple turned(const Turn& q, const Triple& v) {
  const Triple axis{q[0], q[1], q[2]};
  const Triple t = 2.0 * cross(axis, v);
  return v + q[3] * t + cross(axis, t);
}
inline Turn turn_about(const Triple& axis, double angle) {
  const double s = std::sin(angle / 2) / norm(axis);
  return {s * axis[0], s * axis[1], s * axis[2], std::cos(angle / 2)};
}
/// Takes x to the unit vector `to`.
inline Turn turn_from_x(const Triple& to) {
  if (to[0] < -0.999999) return {0, 1, 0, 0};
  const Triple axis = cross({1, 0, 0}, to);
  const double w = 1 + to[0], length = std::sqrt(dot(axis, axis) + w * w);
  return {axis[0] / length, axis[1] / length, axis[2] / length, w / length};
}
/// A rotation vector as a turn.
inline Turn turn_by(const Triple& v) {
  return norm(v) > 0 ? turn_about(v, norm(v)) : Turn{0, 0, 0, 1};
}
/// The angle between two orientations, 0 … π.
inline double angle_between(const Turn& a, const Turn& b) {
  const Turn q = inverse(a) * b;
  return 2 * std::atan2(norm(Triple{q[0], q[1], q[2]}), std::abs(q[3]));
}
/// Of b against a about x, in (−π, π].
inline double twist(const Turn& a, const Turn& b) {
  const Turn q = inverse(a) * b;
  const double angle = 2 * std::atan2(q[0], q[3]);
  return std::remainder(angle, 2 * std::acos(-1.0));
}

}  // namespace lockstone::bench::general
