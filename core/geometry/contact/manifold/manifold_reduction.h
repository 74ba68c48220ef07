// From a clipped polygon to at most four points.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// Sorts a handful by insertion.
template <class T>
constexpr void sort_few(std::span<T> values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    for (std::size_t j = i; j > 0 && values[j] < values[j - 1]; --j)
      std::swap(values[j], values[j - 1]);
  }
}

/// A vertex of a clipped polygon in the frame of a reference face: x and y along the face, z the
/// height above it. Fine.
struct FaceVertex {
  // No initialisers: arrays of these are long, and little of them is used.
  Fine x;
  Fine y;
  Fine z;
  std::uint32_t feature;  ///< incident face and the two polygon edges that meet here
};

/// Removes vertices whose separation `keeps` refuses. Keeps the order of the rest, which come
/// first; returns their number.
[[nodiscard]] int drop_far_vertices(std::span<FaceVertex> polygon, Length margin);

/// More than any polygon has.
inline constexpr std::size_t k_most_reduced = 272;

/// Brings at most four vertices to the front, ascending by feature, each once, and returns how
/// many: the one farthest in a fixed direction, the one farthest from it, the one that spans the
/// largest triangle with both, and the one that adds most area to that. Each later candidate must
/// be better by a sixteenth, so that equals do not alternate. A vertex more than k_deeper deeper
/// than the four replaces the nearest of them. Areas are measured with x and y shifted right by
/// `shift`, which brings their differences within 2^30.
[[nodiscard]] int reduce_to_four(std::span<FaceVertex> polygon, int shift,
                                 const HeldFeatures& held = {});

/// The same for vertices that ascend by feature and have one each. Where four of them have the
/// features that were held, these stay; one that is more than k_much_deeper deeper than they
/// replaces the nearest of those that carried nothing. A rocking body would rattle if the point
/// that holds it were replaced.
[[nodiscard]] int reduce_sorted_to_four(std::span<FaceVertex> polygon, int shift,
                                        const HeldFeatures& held);

/// 7.6 µm.
inline constexpr Fine k_deeper = Fine{1} << (k_fine_bits - 17);

/// 61 µm.
inline constexpr Fine k_much_deeper = Fine{1} << (k_fine_bits - 14);

}  // namespace lockstone::geometry
