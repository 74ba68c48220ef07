// How much better a less stable choice must be before it is taken, and any other before it replaces
// the choice of a tick ago.
#pragma once

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// 0.49 mm.
inline constexpr Fine k_edge_margin = Fine{1} << (k_fine_bits - 11);

/// 0.24 mm.
inline constexpr Fine k_face_margin = Fine{1} << (k_fine_bits - 12);

/// Two computations of one separation agree within this: 2^-18 m.
inline constexpr Fine k_agreement = Fine{1} << (k_fine_bits - 18);

/// A face contact is accepted this much farther than the nearest axis: 15 µm.
inline constexpr Fine k_face_slack = Fine{1} << (k_fine_bits - 16);

/// How far a polygon's vertex beyond a side may be and yet be moved onto it: 31 µm.
inline constexpr Fine k_snap = Fine{1} << (k_fine_bits - 15);

/// An edge axis replaces a face axis of separation `face` only above this value: an overlap smaller
/// by a tenth and by k_edge_margin. A relative and an absolute margin, as in Box3D's
/// b3CollideHulls.
[[nodiscard]] constexpr Fine edge_threshold(Fine face) {
  return face - face / 10 + k_edge_margin;
}

/// A face axis of separation `face` replaces two edges that met a tick ago only where their
/// separation is below this value: an overlap larger by a tenth and by k_edge_margin.
[[nodiscard]] constexpr Fine held_edge_threshold(Fine face) {
  return face + face / 10 - k_edge_margin;
}

/// The second shape's face replaces the first's only above this value.
[[nodiscard]] constexpr Fine second_face_threshold(Fine first) {
  return first + magnitude_of(first) / 32 + k_face_margin;
}

}  // namespace lockstone::geometry
