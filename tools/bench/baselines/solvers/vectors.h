// Vectors, matrices and rotations in double: for the comparison of solvers alone.
#pragma once

#include <array>
#include <cmath>

namespace lockstone::bench::trial {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline Vec3 normalized(const Vec3& a) {
  return (1 / length(a)) * a;
}

// By columns.
struct Mat3 {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

inline Vec3 operator*(const Mat3& m, const Vec3& v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  return {a * b.x, a * b.y, a * b.z};
}
inline Mat3 transposed(const Mat3& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
inline Mat3 inverse(const Mat3& m) {
  const Vec3 yz = cross(m.y, m.z), zx = cross(m.z, m.x), xy = cross(m.x, m.y);
  const double scale = 1 / dot(m.x, yz);
  return transposed({scale * yz, scale * zx, scale * xy});
}
// Vectors orthonormal to `axis` and to each other, right-handed with it: the axis is the first.
inline Mat3 frame_along(const Vec3& axis) {
  const Vec3 x = normalized(axis);
  const Vec3 helper = std::fabs(x.y) < 0.7 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 y = normalized(cross(helper, x));
  return {x, y, cross(x, y)};
}

struct Quat {
  double w = 1, x = 0, y = 0, z = 0;
};

inline Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
}
inline Quat conjugate(const Quat& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
inline Quat normalized(const Quat& q) {
  const double s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}
// The rotation by this rotation vector.
inline Quat rotation(const Vec3& turn) {
  const double angle = length(turn);
  const double s = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * turn.x, s * turn.y, s * turn.z};
}
inline Vec3 rotation_vector(const Quat& q) {
  const double sign = q.w < 0 ? -1 : 1;
  const Vec3 v{sign * q.x, sign * q.y, sign * q.z};
  const double sine = length(v);
  return (sine < 1e-9 ? 2.0 : 2 * std::atan2(sine, sign * q.w) / sine) * v;
}
inline Mat3 matrix(const Quat& q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (z * x - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (z * z + x * x), 2 * (y * z + w * x)},
          {2 * (z * x + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

using Vec6 = std::array<double, 6>;
using Mat6 = std::array<double, 36>;  // by rows

inline double dot(const Vec6& a, const Vec6& b) {
  double sum = 0;
  for (int i = 0; i < 6; ++i)
    sum += a[i] * b[i];
  return sum;
}
inline void add(Vec6& a, const Vec6& b, double scale) {
  for (int i = 0; i < 6; ++i)
    a[i] += scale * b[i];
}

}  // namespace lockstone::bench::trial
