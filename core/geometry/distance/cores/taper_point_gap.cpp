#include "core/geometry/distance/cores/taper_point_gap.h"

#include <lockstone/assert.h>

#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// The vector times along / length.
RawVec part_of(const RawVec& v, Fine along, Fine length) {
  if (length == 0) return {};
  const auto part = [&](Fine lane) { return round_divide(multiply_wide(lane, along), length); };
  return {part(v.x), part(v.y), part(v.z)};
}

/// The axis of a taper and the balls at its ends.
class Taper {
 public:
  explicit Taper(const ConvexCore& core)
      : low_(vertex_of(core, 0)),
        axis_(vertex_of(core, (1 << core.generator_count) - 1) - low_),
        length_(static_cast<Fine>(norm(axis_.x, axis_.y, axis_.z))),
        swell_(core.swell[0]),
        fall_(core.swell[0] - core.swell[1]) {
    LKS_ASSERT(is_taper(core) && magnitude_of(fall_) <= length_);
    rise_ = taper_rise(length_, fall_);
  }

  [[nodiscard]] TaperPointGap gap(const RawVec& point) const {
    const Fine along_axis = foot_of(point - low_);
    const RawVec centre = low_ + part_of(axis_, along_axis, length_);
    const RawVec v = point - centre;
    const Fine swell =
        length_ == 0 ? swell_ : swell_ - round_divide(multiply_wide(fall_, along_axis), length_);
    if (is_negligible(v)) return {{side_normal(), -swell, {}}, 0};
    const Direction d = direction(v.x, v.y, v.z);
    const auto from_axis = static_cast<Fine>(d.length);
    return {{d.unit, from_axis - swell, {}}, from_axis};
  }

 private:
  /// Where on the axis the nearest ball is: y − ρ · fall / rise, within the ends.
  [[nodiscard]] Fine foot_of(const RawVec& from) const {
    if (length_ == 0) return 0;
    const Fine up = round_divide(wide_dot(from, axis_), length_);
    const RawVec aside = from - part_of(axis_, up, length_);
    const auto out = static_cast<Fine>(norm(aside.x, aside.y, aside.z));
    const Int128 foot = multiply_wide(up, rise_) - multiply_wide(out, fall_);
    if (foot.negative()) return 0;
    if (foot >= multiply_wide(length_, rise_)) return length_;
    return round_divide(foot, rise_);
  }

  [[nodiscard]] Vec3<Unit> side_normal() const {
    if (length_ == 0) return k_concentric_normal;
    const Vec3<Unit> up = direction_of(axis_.x, axis_.y, axis_.z), out = perpendicular_to(up);
    const Vec3<Unit> flat = direction_of(rise_, fall_, 0);
    const auto lane = [&flat](Unit x, Unit y) { return (x * flat.x + y * flat.y).raw; };
    return direction_of(lane(out.x, up.x), lane(out.y, up.y), lane(out.z, up.z));
  }

  RawVec low_;
  RawVec axis_;
  Fine length_;
  Fine swell_;
  Fine fall_;      ///< by which the upper ball is smaller
  Fine rise_ = 0;  ///< the length of the side
};

}  // namespace

Fine taper_rise(Fine length, Fine fall) {
  const Int128 square = multiply_wide(length, length) - multiply_wide(fall, fall);
  return static_cast<Fine>(isqrt128(square.bits()));
}

TaperPointGap taper_point_gap(const ConvexCore& core, const RawVec& point) {
  TaperPointGap result = Taper(core).gap(point);
  result.gap.on_surface = point - along(result.gap.normal, result.gap.distance);
  return result;
}

}  // namespace lockstone::geometry
