#include "core/geometry/distance/cores/rim_point_gap.h"

#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A point of the half-plane: away from the axis, and along it from the base.
struct HalfPlanePoint {
  Fine out = 0;
  Fine up = 0;
};

Fine length_of(Fine x, Fine y) {
  return static_cast<Fine>(norm(x, y, 0));
}

/// (a · b + c · d) / length.
Fine height_of(Fine a, Fine b, Fine c, Fine d, Fine length) {
  return round_divide(multiply_wide(a, b) + multiply_wide(c, d), length);
}

/// The half-plane of the axis and a point, and the solid's half in it.
class HalfPlane {
 public:
  HalfPlane(const Rims& rims, const RawVec& point)
      : axis_(rims.centres[1] - rims.centres[0]),
        height_(static_cast<Fine>(norm(axis_.x, axis_.y, axis_.z))),
        base_(fine(rims.radii[0])),
        top_(fine(rims.radii[1])),
        side_(length_of(height_, base_ - top_)) {
    LKS_ASSERT(rims.count == 2 && base_ > 0 && height_ > 0);
    const RawVec from_base = point - rims.centres[0];
    at_.up = round_divide(wide_dot(from_base, axis_), height_);
    const auto part = [&](Fine lane) { return round_divide(multiply_wide(lane, at_.up), height_); };
    const RawVec aside = from_base - RawVec{part(axis_.x), part(axis_.y), part(axis_.z)};
    at_.out = static_cast<Fine>(norm(aside.x, aside.y, aside.z));
    out_ = at_.out < k_no_distance ? unit_axis(rims.u) : direction_of(aside.x, aside.y, aside.z);
    up_ = direction_of(axis_.x, axis_.y, axis_.z);
  }

  /// Distance of the point and the normal there.
  RimPointGap gap() const {
    const Fine beyond_side = height_of(height_, at_.out - base_, base_ - top_, at_.up, side_);
    const Fine below = -at_.up, above = at_.up - height_;
    if (below <= 0 && beyond_side <= 0 && (top_ == 0 || above <= 0))
      return inside(below, above, beyond_side);
    const Fine along_side = height_of(top_ - base_, at_.out - base_, height_, at_.up, side_);
    if (beyond_side > 0 && along_side >= 0 && along_side <= side_)
      return {side_normal(), beyond_side, {}};
    if (below > 0 && at_.out <= base_) return {-up_, below, {}};
    if (above > 0 && at_.out <= top_) return {up_, above, {}};
    return along_side < 0 ? from_rim({base_, 0}) : from_rim({top_, height_});
  }

  [[nodiscard]] Vec3<Unit> side_normal() const { return unit(height_, base_ - top_); }

 private:
  RimPointGap inside(Fine below, Fine above, Fine beyond_side) const {
    RimPointGap nearest{-up_, below, {}};
    if (top_ > 0 && above > nearest.distance) nearest = {up_, above, {}};
    if (beyond_side > nearest.distance) nearest = {side_normal(), beyond_side, {}};
    return nearest;
  }

  RimPointGap from_rim(const HalfPlanePoint& rim) const {
    const Fine out = at_.out - rim.out, up = at_.up - rim.up;
    const Fine distance = length_of(out, up);
    return {distance < k_no_distance ? side_normal() : unit(out, up), distance, {}};
  }

  /// The direction out · out_ + up · up_.
  Vec3<Unit> unit(Fine out, Fine up) const {
    const Vec3<Unit> flat = direction_of(out, up, 0);
    const auto lane = [&flat](Unit x, Unit y) { return (x * flat.x + y * flat.y).raw; };
    if (flat.y == Unit{} && flat.x > Unit{}) return out_;
    return direction_of(lane(out_.x, up_.x), lane(out_.y, up_.y), lane(out_.z, up_.z));
  }

  RawVec axis_;  ///< from the base's centre to the top's
  Fine height_;
  Fine base_;  ///< radii
  Fine top_;
  Fine side_;  ///< length of the line
  HalfPlanePoint at_{};
  Vec3<Unit> out_{};
  Vec3<Unit> up_{};
};

}  // namespace

RimPointGap rim_point_gap(const Rims& rims, const RawVec& point) {
  RimPointGap gap = HalfPlane(rims, point).gap();
  gap.on_surface = point - along(gap.normal, gap.distance);
  return gap;
}

Vec3<Unit> rim_side_normal(const Rims& rims, const RawVec& point) {
  return HalfPlane(rims, point).side_normal();
}

}  // namespace lockstone::geometry
