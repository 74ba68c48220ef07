// Helpers of the lists of functions: domains, and words to quantities and back.
#pragma once

#include <cstdint>
#include <limits>

#include <lockstone/quat.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/int128.h"
#include "core/math/roots.h"
#include "tools/numerics/vectors.h"

namespace lockstone::numerics {

inline constexpr std::int64_t k_max64 = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t k_max32 = std::numeric_limits<std::int32_t>::max();

inline constexpr Domain k_any64{std::numeric_limits<std::int64_t>::min(), k_max64};
inline constexpr Domain k_any32{std::numeric_limits<std::int32_t>::min(), k_max32};
inline constexpr Domain k_positive64{1, k_max64};
inline constexpr Domain k_positive32{1, k_max32};

/// |x| < 2^bits
[[nodiscard]] constexpr Domain below(int bits) {
  const std::int64_t bound = (std::int64_t{1} << bits) - 1;
  return {-bound, bound};
}

[[nodiscard]] constexpr std::int32_t i32(std::int64_t word) {
  return static_cast<std::int32_t>(word);
}
[[nodiscard]] constexpr std::uint64_t u64(std::int64_t word) {
  return static_cast<std::uint64_t>(word);
}
[[nodiscard]] constexpr std::int64_t i64(std::uint64_t word) {
  return static_cast<std::int64_t>(word);
}

template <class T>
[[nodiscard]] Vec3<T> vec3_at(const Words& in, std::size_t at) {
  using Rep = typename T::Representation;
  return {T::from_raw(static_cast<Rep>(in[at])), T::from_raw(static_cast<Rep>(in[at + 1])),
          T::from_raw(static_cast<Rep>(in[at + 2]))};
}

[[nodiscard]] inline Quat quat_at(const Words& in, std::size_t at) {
  const auto unit = [&](std::size_t i) { return Unit::from_raw(i32(in[at + i])); };
  return {unit(0), unit(1), unit(2), unit(3)};
}

[[nodiscard]] inline Transform transform_at(const Words& in, std::size_t at) {
  return {vec3_at<Position>(in, at), quat_at(in, at + 3)};
}

template <class T>
[[nodiscard]] Words words(const Vec3<T>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

[[nodiscard]] inline Words words(const Quat& q) {
  return {q.x.raw, q.y.raw, q.z.raw, q.w.raw};
}

[[nodiscard]] inline Words words(const Transform& t) {
  Words all = words(t.position);
  for (const std::int64_t word : words(t.orientation))
    all.push_back(word);
  return all;
}

/// Four words from `at` on become a unit quaternion; a quaternion near the unit sphere stays.
inline void normalise_at(Words& in, std::size_t at) {
  const Quat q = quat_at(in, at);
  if (is_near_unit(norm_squared(q))) return;
  const Words unit = words(normalized(q));
  for (std::size_t i = 0; i < 4; ++i)
    in[at + i] = unit[i];
}

inline void make_two_units(Words& in) {
  normalise_at(in, 0);
  normalise_at(in, 4);
}

/// `list` repeated into one list of inputs.
[[nodiscard]] inline std::vector<Domain> inputs(
    std::initializer_list<std::pair<Domain, std::size_t>> list) {
  std::vector<Domain> all;
  for (const auto& [domain, count] : list)
    all.insert(all.end(), count, domain);
  return all;
}

}  // namespace lockstone::numerics
