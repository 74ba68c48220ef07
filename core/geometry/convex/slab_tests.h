// A ray, or a box on its way, and a point against axis-aligned boxes: conservative tests for trees
// and grids.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/geometry/convex/parts.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// The ray origin + f · translation, ready for many boxes: one reciprocal an axis (Williams,
/// Barrus, Morley and Shirley, An efficient and robust ray-box intersection algorithm). Fractions
/// are raw `Unit`: 2^30 is the end of the ray. A box on that way is a ray that meets boxes wider by
/// its half extents.
class RayWindow {
 public:
  RayWindow(const Vec3<Length>& origin, const Vec3<Length>& translation,
            const Vec3<Length>& reach) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t way = translation[axis].raw;
      Axis& a = axes_[static_cast<std::size_t>(axis)];
      a.first = std::int64_t{origin[axis].raw} + reach[axis].raw;
      a.last = std::int64_t{origin[axis].raw} - reach[axis].raw;
      a.backward = way < 0;
      a.inverse = way == 0 ? 0 : (std::uint64_t{1} << 62) / static_cast<std::uint64_t>(abs_of(way));
    }
  }

  /// Whether the ray may be in the box at a fraction from 0 to `limit`; never false when it is.
  /// `at` is then at most the fraction where it enters, and short of it by at most 4 · 2^-30 when
  /// that is in 0 … 1.
  [[nodiscard]] bool meets(const LocalBounds& box, std::int64_t limit, std::int64_t& at) const {
    std::int64_t enter = 0;
    std::int64_t leave = limit;
    for (int axis = 0; axis < 3; ++axis) {
      const Axis& a = axes_[static_cast<std::size_t>(axis)];
      const std::int64_t low = box.lower[axis].raw - a.first;
      const std::int64_t high = box.upper[axis].raw - a.last;
      if (a.inverse == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      enter = std::max(enter, a.fraction(a.backward ? -high : low) - k_slack);
      leave = std::min(leave, a.fraction(a.backward ? -low : high) + k_slack);
    }
    at = enter;
    return enter <= leave;
  }

  [[nodiscard]] static std::int64_t limit_of(Unit fraction) { return fraction.raw; }

 private:
  // The reciprocal and the product are each short by at most one.
  static constexpr std::int64_t k_slack = 2;

  static constexpr std::int64_t abs_of(std::int64_t x) { return x < 0 ? -x : x; }

  struct Axis {
    std::int64_t first = 0, last = 0;  ///< of the extent at the origin: its upper and lower end
    std::uint64_t inverse = 0;         ///< ⌊2^62 / |translation|⌋; 0 when there is no movement
    bool backward = false;

    /// distance / |translation| with 30 fraction bits, towards zero. |distance| < 2^32.
    [[nodiscard]] std::int64_t fraction(std::int64_t distance) const {
      const auto size = static_cast<std::uint64_t>(abs_of(distance));
      const std::uint64_t low = (size * (inverse & 0xffffffffU)) >> 32;
      const auto value = static_cast<std::int64_t>(size * (inverse >> 32) + low);
      return distance < 0 ? -value : value;
    }
  };

  std::array<Axis, 3> axes_{};
};

/// A point, and boxes within a distance of it. Distances are squared, in steps of 2^-19 m.
class NearWindow {
 public:
  explicit NearWindow(const Vec3<Length>& point) : point_(point) {}

  /// Whether the box may be within `limit`; never false when it is. `at` is then at most its
  /// distance.
  [[nodiscard]] bool meets(const LocalBounds& box, std::int64_t limit, std::int64_t& at) const {
    at = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t p = point_[axis].raw;
      const std::int64_t off =
          std::max({std::int64_t{0}, box.lower[axis].raw - p, p - box.upper[axis].raw}) >> 1;
      if (off >= k_far) return false;
      at += off * off;
    }
    return at <= limit;
  }

  /// Of a distance up to 1024 m.
  [[nodiscard]] static std::int64_t limit_of(Length distance) {
    const std::int64_t halved = (std::int64_t{distance.raw} >> 1) + 1;
    return halved * halved;
  }

 private:
  static constexpr std::int64_t k_far = std::int64_t{1} << 30;  // 2 km: squares stay small

  Vec3<Length> point_;
};

}  // namespace lockstone::geometry
