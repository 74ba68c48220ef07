// The curve of a path: cubic splines by the length of chords, of its points and of the directions
// up. Its curvature is continuous.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/path.h>

#include "core/geometry/assets/curve.h"

namespace lockstone::geometry {

class SplineCurve final : public Curve {
 public:
  /// Points that `fault_of_points` finds no fault with.
  SplineCurve(std::span<const PathPoint> points, bool closed);

  [[nodiscard]] CurvePlace nearest(const Vec3<Position>& point, Position from) const override;
  [[nodiscard]] Position find(const Vec3<Position>& point) const override;
  [[nodiscard]] CurvePlace at(Position distance) const override;
  [[nodiscard]] Position length() const override { return length_; }
  [[nodiscard]] bool is_closed() const override { return closed_; }

  /// Looks at sixteen places between two points: a curve that nearly stops, or that goes up, has no
  /// frame there; the point before such a place is `point`.
  [[nodiscard]] PathFault fault(std::uint32_t& point) const;
  /// At a point of the path.
  [[nodiscard]] Mat3 frame_at(std::size_t point) const;

 private:
  // a[0] + a[1]·u + a[2]·u² + a[3]·u³, u = 0 … 1 in Q30; Q32.
  struct Cubic {
    Vec3<Position> a[4];

    [[nodiscard]] Vec3<Position> value(std::int64_t u) const;
    [[nodiscard]] Vec3<Position> slope(std::int64_t u) const;
    [[nodiscard]] Vec3<Position> bend(std::int64_t u) const;  // the second derivative
  };
  // From one point to the next.
  struct Piece {
    Cubic point, up;
    Position chord{};
    Position parameter{};  // where it begins
    Position distance{};   // the same along the curve
  };
  struct Spot {
    std::size_t piece = 0;
    std::int64_t u = 0;
  };

  void fit(std::span<const PathPoint> points, Cubic Piece::*cubic, bool ups);
  [[nodiscard]] Spot spot_of(Position parameter) const;
  [[nodiscard]] Spot moved(const Spot& spot, std::int64_t by) const;
  [[nodiscard]] Spot nearest_spot(const Vec3<Position>& point, const Spot& from) const;
  [[nodiscard]] Position parameter_of(const Spot& spot) const;
  [[nodiscard]] Position distance_to(const Spot& spot) const;
  [[nodiscard]] CurvePlace place_of(const Spot& spot) const;

  std::vector<Piece> pieces_;
  bool closed_;
  Position parameters_{};  // of the whole curve
  Position length_{};
};

}  // namespace lockstone::geometry
