#include "core/geometry/manifold_reduction.h"

#include <algorithm>

#include "core/geometry/contact_point.h"

namespace lockstone::geometry {
namespace {

/// A vertex seen from above, 20 fraction bits: products of two differences fit 62 bits.
struct Flat {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

Flat flat(const FaceVertex& v) {
  return {raw::round_shift(v.x, k_fine_per_length), raw::round_shift(v.y, k_fine_per_length)};
}

Flat operator-(const Flat& a, const Flat& b) {
  return {a.x - b.x, a.y - b.y};
}

std::int64_t cross(const Flat& a, const Flat& b) {
  return a.x * b.y - a.y * b.x;
}
std::int64_t square(const Flat& a) {
  return a.x * a.x + a.y * a.y;
}

struct Triangle {
  Flat a;
  Flat b;
  Flat c;

  /// Twice the area beyond the side that `p` lies outside of most; not positive inside.
  [[nodiscard]] std::int64_t area_added_by(const Flat& p) const {
    const int winding = sign_of(cross(b - a, c - a));
    return std::max({winding * cross(p - a, b - a), winding * cross(p - b, c - b),
                     winding * cross(p - c, a - c)});
  }
};

/// Vertices by index, and which of them are taken.
struct Selection {
  const FacePolygon& polygon;
  std::array<int, 4> taken{};
  int count = 0;

  [[nodiscard]] Flat at(int i) const { return flat(polygon.vertices[static_cast<std::size_t>(i)]); }
  [[nodiscard]] Flat chosen(int i) const { return at(taken[static_cast<std::size_t>(i)]); }
  [[nodiscard]] Fine height(int i) const { return polygon.vertices[static_cast<std::size_t>(i)].z; }
  [[nodiscard]] bool has(int i) const {
    return std::find(taken.begin(), taken.begin() + count, i) != taken.begin() + count;
  }
  void take(int i) { taken[static_cast<std::size_t>(count++)] = i; }

  /// Takes the vertex with the highest positive score, if any.
  template <class Score>
  void take_best(Score score) {
    int best = -1;
    std::int64_t best_score = 0;
    for (int i = 0; i < polygon.count; ++i) {
      if (has(i)) continue;
      const std::int64_t candidate = score(at(i));
      if (candidate <= best_score + best_score / 16) continue;
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
  int best = 0;
  for (int i = 1; i < selection.polygon.count; ++i) {
    if (along_fixed_direction(selection.at(i)) > along_fixed_direction(selection.at(best))) {
      best = i;
    }
  }
  selection.take(best);
}

/// The widest support is worth nothing if the deepest vertex is not held.
void include_deepest(Selection& selection) {
  int deepest = 0;
  for (int i = 1; i < selection.polygon.count; ++i) {
    if (selection.height(i) < selection.height(deepest)) deepest = i;
  }
  Fine taken_depth = selection.height(selection.taken[0]);
  for (int i = 1; i < selection.count; ++i) {
    taken_depth =
        std::min(taken_depth, selection.height(selection.taken[static_cast<std::size_t>(i)]));
  }
  if (selection.height(deepest) >= taken_depth - k_deeper) return;
  if (selection.count < 4) return selection.take(deepest);
  int nearest = 0;
  for (int i = 1; i < 4; ++i) {
    const Flat p = selection.at(deepest);
    if (square(selection.chosen(i) - p) < square(selection.chosen(nearest) - p)) nearest = i;
  }
  selection.taken[static_cast<std::size_t>(nearest)] = deepest;
}

Selection select_four(const FacePolygon& polygon) {
  Selection selection{polygon};
  take_extreme(selection);
  selection.take_best([&](const Flat& p) { return square(p - selection.chosen(0)); });
  if (selection.count == 2) {
    const Flat origin = selection.chosen(0);
    const Flat line = selection.chosen(1) - origin;
    selection.take_best([&](const Flat& p) { return magnitude_of(cross(line, p - origin)); });
  }
  if (selection.count == 3) {
    const Triangle triangle{selection.chosen(0), selection.chosen(1), selection.chosen(2)};
    selection.take_best([&](const Flat& p) { return triangle.area_added_by(p); });
  }
  include_deepest(selection);
  return selection;
}

void sort_by_feature(FacePolygon& polygon) {
  std::sort(polygon.vertices.begin(), polygon.vertices.begin() + polygon.count,
            [](const FaceVertex& a, const FaceVertex& b) { return a.feature < b.feature; });
}

}  // namespace

void drop_far_vertices(FacePolygon& polygon, Length margin) {
  const auto end =
      std::remove_if(polygon.vertices.begin(), polygon.vertices.begin() + polygon.count,
                     [margin](const FaceVertex& v) { return !keeps(v.z, margin); });
  polygon.count = static_cast<int>(end - polygon.vertices.begin());
}

void reduce_to_four(FacePolygon& polygon) {
  sort_by_feature(polygon);
  if (polygon.count <= 4) return;
  const Selection selection = select_four(polygon);
  FacePolygon reduced;
  for (int i = 0; i < selection.count; ++i) {
    const auto taken = static_cast<std::size_t>(selection.taken[static_cast<std::size_t>(i)]);
    reduced.vertices[static_cast<std::size_t>(reduced.count++)] = polygon.vertices[taken];
  }
  polygon = reduced;
  sort_by_feature(polygon);
}

}  // namespace lockstone::geometry
