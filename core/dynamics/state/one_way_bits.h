// A one-way direction and its tolerance in the 32 bits that a static or kinematic body has for it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <lockstone/assert.h>
#include <lockstone/rules.h>
#include <lockstone/trigonometry.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/body_record.h"
#include "core/math/roots.h"

namespace lockstone {

inline constexpr std::uint32_t k_most_one_way_degrees = 90;

[[nodiscard]] inline bool is_one_way(const BodyRecord& body) {
  return !body.is_dynamic() && body.union_c != Unit{};
}

[[nodiscard]] inline bool is_valid(const OneWay& rule) {
  return rule.direction == Vec3<Unit>{} ||
         (rule.tolerance >= 1 && rule.tolerance <= k_most_one_way_degrees);
}

/// Bits 0 … 23: x, y, z of the direction, the largest of magnitude 127; above them the degrees.
[[nodiscard]] inline Unit one_way_bits(const OneWay& rule) {
  LKS_ASSERT(is_valid(rule));
  if (rule.direction == Vec3<Unit>{}) return {};
  std::int64_t most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(std::int64_t{rule.direction[i].raw}));
  LKS_ASSERT(most > 0);
  std::uint32_t bits = std::uint32_t{rule.tolerance} << 24;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t part = raw::round_divide(std::int64_t{rule.direction[i].raw} * 127, most);
    bits |= (static_cast<std::uint32_t>(part) & 0xff) << 8 * i;
  }
  return Unit::from_raw(static_cast<std::int32_t>(bits));
}

/// A component of the direction, −127 … 127.
[[nodiscard]] inline std::int32_t one_way_part(Unit bits, int axis) {
  return static_cast<std::int8_t>(static_cast<std::uint32_t>(bits.raw) >> 8 * axis & 0xff);
}

[[nodiscard]] inline OneWay one_way_of(const BodyRecord& body) {
  OneWay rule;
  if (!is_one_way(body)) return rule;
  const Unit bits = body.union_c;
  rule.direction =
      direction_of(one_way_part(bits, 0), one_way_part(bits, 1), one_way_part(bits, 2));
  rule.tolerance = static_cast<std::uint8_t>(static_cast<std::uint32_t>(bits.raw) >> 24);
  LKS_ASSERT(rule.direction != Vec3<Unit>{});
  LKS_ASSERT(is_valid(rule));
  return rule;
}

/// Whether `one_way_bits` makes such bits. For bytes from outside.
[[nodiscard]] inline bool are_one_way_bits(Unit bits) {
  const std::uint32_t degrees = static_cast<std::uint32_t>(bits.raw) >> 24;
  std::int32_t most = 0, least = 0;
  for (int i = 0; i < 3; ++i) {
    most = std::max(most, std::abs(one_way_part(bits, i)));
    least = std::min(least, one_way_part(bits, i));
  }
  return bits == Unit{} ||
         (degrees >= 1 && degrees <= k_most_one_way_degrees && most == 127 && least >= -127);
}

/// The least cosine between a contact's normal and the direction.
[[nodiscard]] inline Unit least_cosine(const OneWay& rule) {
  constexpr std::int32_t k_degree = 2342544;  // π/180, 27 fraction bits
  return cos(Angle::from_raw(rule.tolerance * k_degree));
}

}  // namespace lockstone
