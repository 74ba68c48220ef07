// Pairs of boxes side by side: which faces meet and how they lie, and points brought to the world's
// axes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::lanes {

/// This many pairs have the widest lanes.
inline constexpr std::size_t k_box_pairs = 8;

/// A pair of boxes. Sizes, offset and margin are lengths below 16 m, together too.
struct alignas(16) BoxSource {
  std::array<std::int32_t, 9> axes_a;  ///< three columns, Q30
  std::array<std::int32_t, 9> axes_b;
  std::array<std::int32_t, 3> half_a;  ///< Q20
  std::array<std::int32_t, 3> half_b;
  std::array<std::int32_t, 3> offset;  ///< from A to B
  std::int32_t margin;
};
static_assert(sizeof(BoxSource) == 28 * sizeof(std::int32_t));

/// The face that separates two boxes most, and the face of the other box that is most opposed to
/// it, in the frame of the first: x and y along it, z out of it. Lengths in 2^-50 m.
struct alignas(16) FaceMeeting {
  std::array<std::int64_t, 3> middle;   ///< of the opposed face
  std::array<std::int64_t, 3> u, v;     ///< half its edges
  std::array<std::int64_t, 3> normal;   ///< of the opposed face, either way, Q30
  std::array<std::int64_t, 3> along_u;  ///< directions of its edges, Q30
  std::array<std::int64_t, 3> along_v;
  std::int64_t half_x, half_y;  ///< of the reference face
  std::int64_t height;          ///< of the reference face over the middle of its box
  std::int64_t half_n;          ///< of the other box, along `normal` and its edges, Q20
  std::int64_t half_u, half_v;
  std::int64_t separation;  ///< along the reference face
  std::int64_t is_apart;    ///< 1: a face separates by the margin or more, and all other fields are
                            ///< meaningless
  std::int64_t is_shallow;  ///< 1: no deeper than an eighth of A's half size across its best face
  std::int64_t common;      ///< the features' part that names the faces, see `face_manifold`
  // Two operands a word: in the world's axes x, y, and z, Q30, and the offset to the other box.
  std::array<std::int64_t, 6> axes;
};
static_assert(sizeof(FaceMeeting) == 34 * sizeof(std::int64_t));

/// A point over a reference face, and its feature id.
struct alignas(16) FacePoint {
  std::int64_t x, y, z;
  std::int64_t feature;
};
using FourPoints = std::array<FacePoint, 4>;

/// Points as a manifold holds them: anchors on A and B, separation, feature.
struct alignas(16) PlacedPoint {
  std::array<std::int32_t, 8> words;
};
using FourPlaced = std::array<PlacedPoint, 4>;

struct BoxKernels {
  /// Of k_box_pairs pairs.
  void (*meet)(const BoxSource* sources, FaceMeeting* meetings);
  /// Where `swapped` is 1 the reference face is B's.
  void (*place)(const FaceMeeting* meetings, const FourPoints* points, const std::int64_t* swapped,
                FourPlaced* placed);
};

extern const BoxKernels k_scalar_boxes;

/// Those of the target in force.
[[nodiscard]] const BoxKernels& box_kernels();

}  // namespace lockstone::lanes
