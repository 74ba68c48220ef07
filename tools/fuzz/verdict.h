// The findings of a pair's checks, and the sum of many.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace lockstone::fuzz {

enum class Check : std::uint8_t {
  flip,       ///< collide, distance, penetration and cast_shape of exchanged arguments, in bits
  distance,   ///< proven by witnesses and a separating plane
  witness,    ///< on the features that are named, and opposite each other
  depth,      ///< the normal separates by it, and no direction tried by less
  turned,     ///< distance less depth after a common rotation
  apart,      ///< collide's separation against the distance
  overlap,    ///< of collide's points against the depth; some point touches
  margin,     ///< points exactly where the distance is below the margin
  manifold,   ///< unit normal, ascending features, points within the margin
  anchors,    ///< on the surfaces
  separated,  ///< separated_along: alike both ways, and nothing collides
  overlaps,   ///< agrees with collide and with the distance
  cast,       ///< nothing before the fraction, contact there
  cast_miss,  ///< nothing along the whole way
  ray,        ///< the point hit is on the surface
  ray_miss,   ///< hit and miss agree with the reference
};
inline constexpr int k_checks = 16;

struct CheckText {
  std::string_view name;
  std::string_view bound;  ///< the greatest value allowed
};

[[nodiscard]] CheckText text_of(Check check);

/// A figure of one check.
struct Figure {
  std::uint64_t count = 0;
  std::uint64_t failures = 0;
  double worst = 0;               ///< error, m
  double worst_share = 0;         ///< of the bound
  std::uint64_t worst_index = 0;  ///< of the pair with the worst share, the first of equals

  void add(const Figure& other);
};

/// Records the measurements of one pair's checks.
class Verdict {
 public:
  explicit Verdict(std::uint64_t index) : index_(index) {}

  void measure(Check check, double error, double allowed);
  void require(Check check, bool holds) { measure(check, holds ? 0 : 1, 0.5); }

  [[nodiscard]] const std::array<Figure, k_checks>& figures() const { return figures_; }
  [[nodiscard]] bool failed() const;

 private:
  std::uint64_t index_;
  std::array<Figure, k_checks> figures_{};
};

}  // namespace lockstone::fuzz
