#include "core/geometry/distance/gjk/taper_gap.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/distance/cores/taper_point_gap.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A place on the axis: 0 at the first end, 1 at the second, 60 fraction bits.
using AxisPlace = std::int64_t;
constexpr int k_place_bits = 60;
constexpr AxisPlace k_second_end = AxisPlace{1} << k_place_bits;

RawVec part_of(const RawVec& v, AxisPlace place) {
  const auto part = [place](Fine lane) { return saturated_product(lane, place, k_place_bits); };
  return {part(v.x), part(v.y), part(v.z)};
}

/// A ball of the taper, and the point of the other core that is nearest to its centre.
struct Nearest {
  AxisPlace place = 0;
  bool apart = false;
  Fine rise = 0;  ///< by how much the gap falls from end to end, with the normal of this place
  CoreGap gap{};  ///< of the ball's centre from the other core
  Simplex features{};
};

/// An end of the part of the axis that holds the least, and a weight that the method halves.
struct Bracket {
  Nearest nearest;
  Fine weight;

  explicit Bracket(const Nearest& at) : nearest(at), weight(magnitude_of(at.rise)) {}
};

class TaperSearch {
 public:
  /// `offset` is that of the other's centre from the taper's.
  TaperSearch(const ConvexCore& taper, const ConvexCore& other, const RawVec& offset)
      : taper_(taper),
        other_(other),
        offset_(offset),
        first_(vertex_of(taper, 0)),
        axis_(vertex_of(taper, 1) - first_),
        growth_(taper.swell[1] - taper.swell[0]) {
    if (!is_taper(other) && other.rims.count == 0) query_.emplace(point_, other);
  }

  TaperGap find() {
    const Nearest nearest = least();
    if (!nearest.apart) return {};
    const Fine swell = taper_.swell[0] + saturated_product(growth_, nearest.place, k_place_bits);
    TaperGap result{true, nearest.gap, nearest.features};
    result.gap.distance -= swell;
    result.gap.on_a = result.gap.on_a + along(nearest.gap.normal, swell);
    for (DifferenceVertex& vertex : result.features.vertices)
      vertex.a = nearest.place < k_second_end / 2 ? 0 : 1;
    return result;
  }

 private:
  /// The place with the least gap; one that is not apart if the search meets any.
  Nearest least() {
    const Bracket first(nearest_at(0));
    if (!first.nearest.apart || first.nearest.rise <= 0) return first.nearest;
    const Bracket second(nearest_at(k_second_end));
    if (!second.nearest.apart || second.nearest.rise >= 0) return second.nearest;
    return least_between(first, second);
  }

  Nearest least_between(Bracket low, Bracket high) {
    constexpr AxisPlace k_narrow = AxisPlace{1} << 12;
    constexpr int k_first_halving = 80, k_most_steps = k_first_halving + 48;
    const Fine rounding = sum_of_magnitudes(axis_) >> Unit::frac_bits;
    int side = 0;  // of the last step
    Nearest middle;
    for (int step = 0; step < k_most_steps; ++step) {
      const AxisPlace width = high.nearest.place - low.nearest.place, least = width / 1024;
      if (width <= k_narrow) return at_leap(low.nearest, high.nearest);
      const bool halves = step % 4 == 3 || step >= k_first_halving;
      const AxisPlace by = halves ? width / 2
                                  : round_divide(multiply_wide(width, low.weight),
                                                 raw::add(low.weight, high.weight));
      middle = nearest_at(low.nearest.place + std::clamp(by, least, width - least));
      if (!middle.apart || magnitude_of(middle.rise) <= rounding) return middle;
      const int next = middle.rise > 0 ? 1 : -1;
      (next > 0 ? low : high) = Bracket(middle);
      if (next == side) (next > 0 ? high : low).weight = (next > 0 ? high : low).weight / 2 + 1;
      side = next;
    }
    return at_leap(low.nearest, high.nearest);
  }

  /// Of two places side by side, where the derivative leaps over zero: by a little from one feature
  /// of the lattice to the next, and a normal between both is level; by more where the axis touches
  /// the other core, and then the place says nothing.
  [[nodiscard]] static Nearest at_leap(const Nearest& low, const Nearest& high) {
    constexpr std::int64_t k_alike = std::int64_t{1} << (Unit::frac_bits - 13);
    Nearest result = low;
    const RawVec a = raws_of(low.gap.normal), b = raws_of(high.gap.normal), leap = b - a;
    result.apart =
        std::max({magnitude_of(leap.x), magnitude_of(leap.y), magnitude_of(leap.z)}) < k_alike;
    const auto lane = [&](std::int64_t from, std::int64_t by) {
      return from + round_divide(multiply_wide(by, low.rise), raw::add(low.rise, -high.rise));
    };
    result.gap.normal = direction_of(lane(a.x, leap.x), lane(a.y, leap.y), lane(a.z, leap.z));
    result.gap.distance = dot(low.gap.on_b - low.gap.on_a, result.gap.normal);
    return result;
  }

  Nearest nearest_at(AxisPlace place) {
    Nearest result;
    result.place = place;
    const RawVec centre = first_ + part_of(axis_, place);
    result.apart = find_gap(centre, result.gap);
    result.gap.on_a = centre;
    result.features = query_ ? query_->features() : all_of_other();
    result.rise = dot(axis_, result.gap.normal) + growth_;
    return result;
  }

  /// The axis of another taper; of rims a vertex that stands for none.
  [[nodiscard]] Simplex all_of_other() const {
    Simplex all;
    all.count = other_.generator_count + 1;
    all.vertices[1].b = 1;
    return all;
  }

  bool find_gap(const RawVec& centre, CoreGap& gap) {
    if (query_) {
      if (!query_->find(offset_ - centre)) return false;
      gap = query_->gap();
      gap.on_b = gap.on_b + centre;
      return true;
    }
    const bool round = is_taper(other_);
    const TaperPointGap of_taper =
        round ? taper_point_gap(other_, centre - offset_)
              : TaperPointGap{rim_point_gap(other_.rims, centre - offset_)};
    const RimPointGap& found = of_taper.gap;
    gap.normal = -found.normal;
    gap.distance = found.distance;
    gap.on_b = offset_ + found.on_surface;
    return round ? of_taper.from_axis > k_no_distance : found.distance > 0;
  }

  const ConvexCore& taper_;
  const ConvexCore& other_;
  RawVec offset_;
  RawVec first_;
  RawVec axis_;
  Fine growth_;
  ConvexCore point_;
  std::optional<GapQuery> query_;  // of polytopes and boxes
};

}  // namespace

TaperGap taper_gap(const ConvexCore& a, const ConvexCore& b, const RawVec& offset) {
  if (is_tapered(a)) return TaperSearch(a, b, offset).find();
  TaperGap result = TaperSearch(b, a, -offset).find();
  result.gap.normal = -result.gap.normal;
  std::swap(result.gap.on_a, result.gap.on_b);
  result.gap.on_a = result.gap.on_a + offset;
  result.gap.on_b = result.gap.on_b + offset;
  for (DifferenceVertex& vertex : result.features.vertices)
    std::swap(vertex.a, vertex.b);
  return result;
}

CoreGap taper_point_core_gap(const ConvexCore& a, const ConvexCore& b, const RawVec& offset) {
  const bool first = is_tapered(a);
  const RimPointGap found = taper_point_gap(first ? a : b, first ? offset : -offset).gap;
  CoreGap gap{first ? found.normal : -found.normal, found.distance, {}, offset};
  (first ? gap.on_a : gap.on_b) = first ? found.on_surface : offset + found.on_surface;
  return gap;
}

}  // namespace lockstone::geometry
