// Values of the C interface as those of the core, and back.
#pragma once

#include <cstdint>

#include <lockstone/world.h>

#include "tools/bindings/c/call.h"

namespace lockstone::c {

template <class T>
[[nodiscard]] constexpr Vec3<T> vec(const lks_i64x3& v) {
  return {T::from_raw(v.x), T::from_raw(v.y), T::from_raw(v.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> vec(const lks_i32x3& v) {
  return {T::from_raw(v.x), T::from_raw(v.y), T::from_raw(v.z)};
}

template <class D, int F>
[[nodiscard]] constexpr lks_i64x3 raw_of(const Vec3<Fixed<D, std::int64_t, F>>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}
template <class D, int F>
[[nodiscard]] constexpr lks_i32x3 raw_of(const Vec3<Fixed<D, std::int32_t, F>>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

[[nodiscard]] constexpr Quat quat_of(const lks_quat& q) {
  return {Unit::from_raw(q.x), Unit::from_raw(q.y), Unit::from_raw(q.z), Unit::from_raw(q.w)};
}
[[nodiscard]] constexpr lks_quat raw_of(const Quat& q) {
  return {q.x.raw, q.y.raw, q.z.raw, q.w.raw};
}

[[nodiscard]] inline lks_pose raw_of(const Transform& pose) {
  return {raw_of(pose.position), raw_of(pose.orientation)};
}

[[nodiscard]] constexpr CollisionFilter filter_of(const lks_filter& filter) {
  return {filter.category, filter.mask, filter.group};
}
[[nodiscard]] constexpr lks_filter raw_of(const CollisionFilter& filter) {
  return {filter.category, filter.mask, filter.group};
}

/// BodyHandle and JointHandle from their 64 bits.
template <class Handle>
[[nodiscard]] constexpr Handle handle_of(std::uint64_t id) {
  return {static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32)};
}
template <class Handle>
[[nodiscard]] constexpr std::uint64_t id_of(Handle handle) {
  return std::uint64_t{handle.generation} << 32 | handle.index;
}

/// Throw for numbers that are no enumerators and bits that are no flags.
[[nodiscard]] Shape shape_of(const lks_shape& shape, std::string_view field);
[[nodiscard]] Surface surface_of(const lks_surface& surface, std::string_view field);
[[nodiscard]] Material material_of(const Surface& surface, lks_density density);
[[nodiscard]] SurfaceMotion surface_motion_of(const lks_surface_motion& motion);
[[nodiscard]] AxisLocks locks_of(std::uint32_t bits, std::string_view field);
[[nodiscard]] EventSettings events_of(std::uint32_t bits, lks_speed hit_speed,
                                      std::string_view field);
[[nodiscard]] Frame frame_of(std::uint32_t frame);

[[nodiscard]] lks_shape raw_of(const Shape& shape);
[[nodiscard]] lks_surface raw_of(const Surface& surface);
[[nodiscard]] std::uint32_t raw_of(const AxisLocks& locks);
[[nodiscard]] std::uint32_t raw_of(const EventSettings& events);  ///< without the hit speed

/// Throws beyond the world's limit. Commands check places themselves, but queries take a place
/// within the limit as a precondition.
[[nodiscard]] Vec3<Position> place_of(const lks_position3* place, std::string_view field);

}  // namespace lockstone::c
