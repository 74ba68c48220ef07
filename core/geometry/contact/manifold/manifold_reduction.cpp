#include "core/geometry/contact/manifold/manifold_reduction.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <lockstone/assert.h>

#include "core/geometry/distance/contact_point.h"

namespace lockstone::geometry {
namespace {

/// A vertex seen from above: products of two differences fit 62 bits.
struct Flat {
  // No initialisers: an array of these is long, and little of it is used.
  std::int64_t x;
  std::int64_t y;
};

Flat operator-(const Flat& a, const Flat& b) {
  return {a.x - b.x, a.y - b.y};
}

std::int64_t cross(const Flat& a, const Flat& b) {
  return a.x * b.y - a.y * b.x;
}
std::int64_t square(const Flat& a) {
  return a.x * a.x + a.y * a.y;
}

/// A triangle, either way round.
class FlatTriangle {
 public:
  FlatTriangle(const Flat& a, const Flat& b, const Flat& c)
      : corners_{a, b, c},
        sides_{b - a, c - b, a - c},
        winding_(sign_of(cross(sides_[0], c - a))) {}

  /// Twice the area beyond the side that `p` lies outside of most; not positive inside.
  [[nodiscard]] std::int64_t area_added_by(const Flat& p) const {
    const auto beyond = [&](std::size_t i) { return winding_ * cross(p - corners_[i], sides_[i]); };
    return std::max(std::max(beyond(0), beyond(1)), beyond(2));
  }

 private:
  std::array<Flat, 3> corners_;
  std::array<Flat, 3> sides_;
  int winding_;
};

/// Vertices by index, and which of them are taken.
struct Selection {
  std::span<const FaceVertex> polygon;
  std::array<Flat, k_most_reduced> flat;
  std::array<int, 4> taken{-1, -1, -1, -1};
  int count = 0;

  Selection(std::span<const FaceVertex> vertices, int shift) : polygon(vertices) {
    LKS_ASSERT(vertices.size() <= flat.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
      flat[i] = {raw::round_shift(vertices[i].x, shift), raw::round_shift(vertices[i].y, shift)};
  }

  [[nodiscard]] int size() const { return static_cast<int>(polygon.size()); }
  [[nodiscard]] const Flat& at(int i) const { return flat[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Flat& chosen(int i) const { return at(taken[static_cast<std::size_t>(i)]); }
  [[nodiscard]] Fine height(int i) const { return polygon[static_cast<std::size_t>(i)].z; }
  [[nodiscard]] bool has(int i) const {
    return i == taken[0] || i == taken[1] || i == taken[2] || i == taken[3];
  }
  void take(int i) { taken[static_cast<std::size_t>(count++)] = i; }

  /// Takes the vertex with the highest positive score, if any.
  template <class Score>
  void take_best(Score score) {
    LKS_ASSERT(count < 4);
    int best = -1;
    std::int64_t best_score = 0;
    for (int i = 0; i < size(); ++i) {
      const std::int64_t candidate = score(at(i));
      if (candidate <= best_score + (best_score >> 4) || has(i)) continue;
      best = i;
      best_score = candidate;
    }
    if (best >= 0) take(best);
  }
};

/// A direction that is square to no likely edge.
std::int64_t along_fixed_direction(const Flat& p) {
  return 5 * p.x + 11 * p.y;
}

void take_extreme(Selection& selection) {
  LKS_ASSERT(selection.size() > 0);
  int best = 0;
  for (int i = 1; i < selection.size(); ++i) {
    if (along_fixed_direction(selection.at(i)) > along_fixed_direction(selection.at(best))) {
      best = i;
    }
  }
  selection.take(best);
}

/// Of the four, the one whose place another may take: the nearest of those that no impulse pushed
/// at a tick ago, else the nearest.
std::size_t least_needed(const Selection& selection, int other, const HeldFeatures& held) {
  LKS_ASSERT(selection.count == 4);
  const auto is_loaded = [&](std::size_t i) {
    return held.is_loaded(selection.polygon[static_cast<std::size_t>(selection.taken[i])].feature);
  };
  const auto distance = [&](std::size_t i) {
    return square(selection.at(selection.taken[i]) - selection.at(other));
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const bool is_freer = !is_loaded(i) && is_loaded(best);
    const bool is_alike = is_loaded(i) == is_loaded(best);
    if (is_freer || (is_alike && distance(i) < distance(best))) best = i;
  }
  return best;
}

/// The widest support is worth nothing without the deepest vertex: it replaces one of the four, if
/// they are higher by more than `much`.
void include_deepest(Selection& selection, Fine much, const HeldFeatures& held) {
  LKS_ASSERT(selection.count > 0 && selection.count <= 4);
  LKS_ASSERT(much > 0);
  int deepest = 0;
  for (int i = 1; i < selection.size(); ++i) {
    if (selection.height(i) < selection.height(deepest)) deepest = i;
  }
  Fine taken_depth = selection.height(selection.taken[0]);
  for (int i = 1; i < selection.count; ++i) {
    taken_depth =
        std::min(taken_depth, selection.height(selection.taken[static_cast<std::size_t>(i)]));
  }
  if (selection.height(deepest) >= taken_depth - much) return;
  if (selection.count < 4) return selection.take(deepest);
  selection.taken[least_needed(selection, deepest, held)] = deepest;
}

void select_four(Selection& selection) {
  LKS_ASSERT(selection.size() > 4);
  take_extreme(selection);
  const Flat first = selection.chosen(0);
  selection.take_best([&](const Flat& p) { return square(p - first); });
  if (selection.count == 2) {
    const Flat line = selection.chosen(1) - first;
    selection.take_best([&](const Flat& p) { return magnitude_of(cross(line, p - first)); });
  }
  if (selection.count == 3) {
    const FlatTriangle triangle{first, selection.chosen(1), selection.chosen(2)};
    selection.take_best([&](const Flat& p) { return triangle.area_added_by(p); });
  }
  include_deepest(selection, k_deeper, {});
  LKS_ASSERT(selection.count > 0 && selection.count <= 4);
}

/// Returns whether four vertices are held.
bool take_held(Selection& selection, const HeldFeatures& held) {
  LKS_ASSERT(selection.size() > 4 && selection.count == 0);
  if (held.count < 4) return false;
  for (int i = 0; i < selection.size() && selection.count < 4; ++i)
    if (held.has(selection.polygon[static_cast<std::size_t>(i)].feature)) selection.take(i);
  if (selection.count == 4) return true;
  selection.taken = {-1, -1, -1, -1};
  selection.count = 0;
  return false;
}

/// The lowest of repeated features first.
void sort_by_feature(std::span<FaceVertex> polygon) {
  std::sort(polygon.begin(), polygon.end(), [](const FaceVertex& a, const FaceVertex& b) {
    if (a.feature != b.feature) return a.feature < b.feature;
    return std::tie(a.z, a.x, a.y) < std::tie(b.z, b.x, b.y);
  });
}

/// Of a sorted polygon: each feature once.
std::span<FaceVertex> without_repeats(std::span<FaceVertex> polygon) {
  const auto same = [](const FaceVertex& a, const FaceVertex& b) { return a.feature == b.feature; };
  const auto end = std::unique(polygon.begin(), polygon.end(), same);
  return polygon.first(static_cast<std::size_t>(end - polygon.begin()));
}

}  // namespace

int drop_far_vertices(std::span<FaceVertex> polygon, Length margin) {
  const auto end = std::remove_if(polygon.begin(), polygon.end(),
                                  [margin](const FaceVertex& v) { return !keeps(v.z, margin); });
  return static_cast<int>(end - polygon.begin());
}

int reduce_to_four(std::span<FaceVertex> polygon, int shift, const HeldFeatures& held) {
  LKS_ASSERT(polygon.size() <= k_most_reduced && shift >= 0);
  sort_by_feature(polygon);
  return reduce_sorted_to_four(without_repeats(polygon), shift, held);
}

int reduce_sorted_to_four(std::span<FaceVertex> polygon, int shift, const HeldFeatures& held) {
  if (polygon.size() <= 4) return static_cast<int>(polygon.size());
  Selection selection(polygon, shift);
  if (take_held(selection, held))
    include_deepest(selection, k_much_deeper, held);
  else
    select_four(selection);
  LKS_ASSERT(selection.count > 0 && selection.count <= 4);
  // By index is by feature, and no vertex moves up past one that is still needed.
  sort_few(std::span(selection.taken).first(static_cast<std::size_t>(selection.count)));
  for (std::size_t i = 0; i < static_cast<std::size_t>(selection.count); ++i)
    polygon[i] = polygon[static_cast<std::size_t>(selection.taken[i])];
  return selection.count;
}

}  // namespace lockstone::geometry
