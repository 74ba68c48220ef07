// A curve in space with a frame along it, for joints.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::geometry {

/// A place on a curve, in the curve's own frame.
struct CurvePlace {
  Vec3<Position> point{};
  Mat3 frame{};          // x along the curve, z up
  Position parameter{};  // along the chords of the curve's points, m
  Position distance{};   // along the curve from its beginning; beyond an open end straight on, m
  std::array<std::int64_t, 3> turning{};  // of the frame on the way along the curve, rad/m, Q30
};

class Curve {
 public:
  virtual ~Curve() = default;

  /// The place nearest to a point that is reached from the place of another parameter downhill.
  [[nodiscard]] virtual CurvePlace nearest(const Vec3<Position>& point, Position from) const = 0;
  /// The parameter of the nearest place of all.
  [[nodiscard]] virtual Position find(const Vec3<Position>& point) const = 0;
  /// The place at a distance from the beginning; beyond an open end that end.
  [[nodiscard]] virtual CurvePlace at(Position distance) const = 0;
  /// At most k_max_path_length.
  [[nodiscard]] virtual Position length() const = 0;
  [[nodiscard]] virtual bool is_closed() const = 0;
};

}  // namespace lockstone::geometry
