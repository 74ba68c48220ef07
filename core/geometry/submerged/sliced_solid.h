// Volume, moment and section of a solid of revolution below a plane, by slices across its axis y.
#pragma once

#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/submerged/submerged.h"

namespace lockstone::geometry {

/// A piece of the outline between two heights, in units of the scale, 30 fraction bits: a straight
/// line from radius `r0` to `r1`, or an arc.
struct Outline {
  std::int64_t y0 = 0, y1 = 0;
  std::int64_t r0 = 0, r1 = 0;  ///< of a line
  std::int64_t arc_radius = 0;  ///< not 0: an arc about (0, arc_centre)
  std::int64_t arc_centre = 0;

  [[nodiscard]] std::int64_t radius_at(std::int64_t y) const;
};

/// The sum over outlines that follow one another.
class SlicedSolid {
 public:
  /// n · x ≤ offset, 30 fraction bits.
  SlicedSolid(const Vec3<Unit>& normal, std::int64_t offset);

  void add(const Outline& outline);
  /// About the origin.
  void finish(SubmergedPart& part) const;

 private:
  struct Breaks {
    std::int64_t y[2];
  };
  [[nodiscard]] std::int64_t depth_at(std::int64_t y) const;
  [[nodiscard]] Breaks breaks_of(const Outline& outline) const;
  [[nodiscard]] std::int64_t break_of_line(const Outline& outline, std::int64_t sign) const;
  [[nodiscard]] bool is_across() const { return across_ < 1 << 24; }
  void add_disc(const Outline& outline);
  void add_interval(const Outline& outline, std::int64_t y0, std::int64_t y1);

  Vec3<Unit> normal_;
  std::int64_t offset_;
  std::int64_t across_;  // the length of the normal's part across the axis, 30 bits

  std::int64_t volume_ = 0;
  std::int64_t along_ = 0;   // moment along the axis
  std::int64_t toward_ = 0;  // moment along the normal's part across the axis
  std::int64_t section_ = 0;
};

}  // namespace lockstone::geometry
