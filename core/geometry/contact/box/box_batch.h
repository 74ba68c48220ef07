// Box pairs collided side by side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/geometry/distance/manifold.h"
#include "core/kernels/box/box_block.h"

namespace lockstone::geometry {

/// Some pairs of boxes at once. Their manifolds are those of `collide`, bit for bit. Faces and
/// points on them are found side by side, which settles most pairs of a pile; for the others that
/// is where the search for edges and vertices begins.
class BoxBatch {
 public:
  static constexpr std::size_t k_capacity = lanes::k_box_pairs;

  /// Boxes whose sizes and offset are below 16 m, together too.
  [[nodiscard]] static bool takes(const Shape& a, const Shape& b, const Vec3<Length>& offset);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool is_full() const { return size_ == k_capacity; }
  void clear() { size_ = 0; }

  /// Of a pair that it takes, in which no edges are held; there is room.
  void add(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset, Length margin,
           const HeldFeatures& held);
  void collide();

  /// After `collide`: whether faces alone settle the pair.
  [[nodiscard]] bool is_settled(std::size_t pair) const { return stages_[pair] == Stage::settled; }
  /// After `collide`.
  void write(std::size_t pair, Manifold& out) const;

 private:
  /// How much of a pair's manifold is found.
  enum class Stage : std::uint8_t {
    nothing,       ///< a face parts them, or the other face is held
    on_reference,  ///< the manifold on the reference face
    settled,       ///< which is that of the pair
  };

  [[nodiscard]] Stage settle(std::size_t pair);
  void write_reference(std::size_t pair, Manifold& out) const;
  void finish(std::size_t pair, Manifold& out) const;

  std::array<lanes::BoxSource, k_capacity> sources_{};
  std::array<HeldFeatures, k_capacity> held_{};
  std::array<lanes::FaceMeeting, k_capacity> meetings_{};
  std::array<lanes::FourPoints, k_capacity> points_{};
  std::array<lanes::FourPlaced, k_capacity> placed_{};
  std::array<std::int64_t, k_capacity> flips_{};    // 1: the first box is the manifold's B
  std::array<std::int64_t, k_capacity> swapped_{};  // 1: the reference box is
  std::array<std::uint8_t, k_capacity> counts_{};
  std::array<Stage, k_capacity> stages_{};
  std::size_t size_ = 0;
};

}  // namespace lockstone::geometry
