// A body as it is stored, saved and hashed.
#pragma once

#include <cstdint>

#include <lockstone/body.h>

#include "core/dynamics/fields.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Bits of BodyRecord::flags.
enum BodyFlag : std::uint8_t {
  k_body_trigger = 1,
  k_body_fixed_rotation = 2,
  k_body_bullet = 4,
  k_body_asleep = 8,     // neither moves nor is looked at; its velocities are zero
  k_body_no_sleep = 16,  // never falls asleep
  k_all_body_flags =
      k_body_trigger | k_body_fixed_rotation | k_body_bullet | k_body_asleep | k_body_no_sleep,
};

/// Canonical state of one body slot; all zero but `generation` when the slot is empty. Position and
/// orientation are those of the centre of mass and the principal axes.
///
/// Rotation is kept normalised by the scale s = 2^scale_exponent m, the first power of two not
/// below the body's radius. `spin` is angular momentum / (mass · s), a velocity: an impulse J at r
/// changes it by (r/s) × J/mass, as it changes `velocity` by J/mass. Surface speed ω·s follows from
/// it by the inverse of the normalised inertia. A kinematic body, which has no mass, keeps ω·s
/// itself in `spin`.
struct BodyRecord {
  Vec3<Position> position{};
  Vec3<Velocity> velocity{};
  Vec3<Velocity> spin{};
  std::uint64_t user_data = 0;
  AssetId asset{};  // Shape::asset
  Quat orientation{{}, {}, {}, {}};
  Vec3<Length> size{};   // Shape::size
  Vec3<Unit> inertia{};  // principal moments / (mass · s²), each in (0, 1]
  // Where it began to rest (rest.h), of a body that may fall asleep by resting; else zero.
  Vec3<Length> rest_position{};  // low 32 bits
  Quat rest_orientation{{}, {}, {}, {}};
  std::int32_t inverse_mass = 0;  // mantissa; the exponent is below
  Number gravity_scale{};
  Rate linear_damping{};
  Rate angular_damping{};
  Coefficient friction{};
  Coefficient restitution{};
  std::uint32_t category = 0;
  std::uint32_t mask = 0;
  std::int32_t group = 0;
  std::uint32_t generation = 0;  // of the last body in this slot
  std::uint8_t motion = 0;       // MotionType, 0 for an empty slot
  std::uint8_t shape_kind = 0;   // ShapeKind
  std::uint8_t flags = 0;        // BodyFlag
  std::int8_t scale_exponent = 0;
  std::int8_t inverse_mass_exponent = 0;
  std::uint8_t reserved0 = 0;  // keep the record free of padding; always 0
  std::uint16_t reserved1 = 0;
  std::uint32_t rest_ticks = 0;  // since it rests

  friend bool operator==(const BodyRecord&, const BodyRecord&) = default;

  [[nodiscard]] bool exists() const { return motion != 0; }
  [[nodiscard]] bool moves() const { return motion >= 2; }
  [[nodiscard]] bool is_static() const { return is(MotionType::static_body); }
  [[nodiscard]] bool is_dynamic() const { return is(MotionType::dynamic); }
  [[nodiscard]] bool is_trigger() const { return (flags & k_body_trigger) != 0; }
  [[nodiscard]] bool is_bullet() const { return (flags & k_body_bullet) != 0; }
  [[nodiscard]] bool is_asleep() const { return (flags & k_body_asleep) != 0; }
  [[nodiscard]] bool is_awake() const { return moves() && !is_asleep(); }
  [[nodiscard]] bool may_sleep() const { return (flags & k_body_no_sleep) == 0; }
  [[nodiscard]] bool rotates() const { return (flags & k_body_fixed_rotation) == 0; }
  [[nodiscard]] Shape shape() const { return {static_cast<ShapeKind>(shape_kind), size, asset}; }
  [[nodiscard]] CollisionFilter filter() const { return {category, mask, group}; }

  /// 1/kg; zero unless dynamic.
  [[nodiscard]] BlockFloat inverse_mass_value() const {
    return {inverse_mass, inverse_mass_exponent};
  }
  [[nodiscard]] bool has_spherical_inertia() const {
    return inertia.x == inertia.y && inertia.y == inertia.z;
  }

 private:
  [[nodiscard]] bool is(MotionType type) const { return motion == static_cast<std::uint8_t>(type); }
};

// clang-format off
#define LKS_BODY_FIELDS(X) \
  X(position) X(velocity) X(spin) X(user_data) X(asset) X(orientation) X(size) X(inertia) \
  X(rest_position) X(rest_orientation) X(inverse_mass) \
  X(gravity_scale) X(linear_damping) X(angular_damping) X(friction) X(restitution) X(category) \
  X(mask) X(group) X(generation) X(motion) X(shape_kind) X(flags) X(scale_exponent) \
  X(inverse_mass_exponent) X(reserved0) X(reserved1) X(rest_ticks)
// clang-format on

template <class F>
constexpr void visit_fields(BodyRecord& record, F&& f) {
#define LKS_VISIT(field) visit_value(#field, "", record.field, f);
  LKS_BODY_FIELDS(LKS_VISIT)
#undef LKS_VISIT
}

static_assert(visited_bytes<BodyRecord>() == sizeof(BodyRecord), "a field is missing in the list");

}  // namespace lockstone
