// A straight path against bounds, with which rays and casts walk trees.
#pragma once

#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/collision/broad_phase/bounds.h"

namespace lockstone {

/// A box carried along a segment. Tests are conservative: they may pass bounds that are missed by
/// up to 3 mm, or by the length of a way that is short beside the box, and never miss bounds that
/// are met.
class SegmentProbe {
 public:
  /// From `origin` by `translation`, each component within ±k_max_cast, with everything within
  /// `reach` of it.
  SegmentProbe(const Vec3<Position>& origin, const Vec3<Length>& translation,
               const Vec3<Length>& reach);

  /// Gives up the part of the path beyond a fraction of the translation.
  void shorten(Unit fraction);

  [[nodiscard]] bool meets(const Bounds& bounds) const;

 private:
  void set(const Vec3<Length>& translation);

  Vec3<Position> origin_;
  Vec3<Length> translation_;
  Vec3<Length> reach_;
  Bounds swept_{};
  // Twice the middle, and the whole of the way, in bounds coordinates.
  std::int64_t middle_[3] = {};
  std::int64_t way_[3] = {};
  std::int64_t half_[3] = {};
  // The way is along one axis, or none, or short beside the box: its bounds are about all of it.
  bool bounds_suffice_ = false;
};

/// The point a fraction of the way along.
[[nodiscard]] Vec3<Position> along(const Vec3<Position>& origin, const Vec3<Length>& translation,
                                   Unit fraction);

}  // namespace lockstone
