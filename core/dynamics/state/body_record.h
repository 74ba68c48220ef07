// A body as it is stored, saved and hashed.
#pragma once

#include <cstdint>

#include <lockstone/body.h>

#include "core/dynamics/state/fields.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Bits of BodyRecord::flags.
enum BodyFlag : std::uint8_t {
  k_body_trigger = 1,
  k_body_pushed = 2,  // by forces in this tick: the union tells how
  k_body_bullet = 4,
  k_body_asleep = 8,          // neither moves nor is looked at; its velocities are zero
  k_body_no_sleep = 16,       // never falls asleep
  k_body_changed_sleep = 32,  // sleeps and did not at the last events, or the reverse; dynamic
  k_body_persist_events = 64,
  k_body_no_contact_events = 128,
};

/// Bits of BodyRecord::locks: three axes of moving, three of turning, and the body as a whole.
enum BodyLock : std::uint8_t {
  k_lock_moving = 7,
  k_lock_turning = 7 << 3,
  k_body_disabled = 1 << 6,
  k_all_body_locks = k_lock_moving | k_lock_turning | k_body_disabled,
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
  AssetId asset{};  // Shape::asset: also a rounded box' fourth size
  Quat orientation{{}, {}, {}, {}};
  Quat recycling_orientation{
      {}, {}, {}, {}};             // and place: where contacts are found, recycling_pose.h
  Vec3<Length> recycling_place{};  // low 32 bits
  Vec3<Length> size{};             // Shape::size
  Vec3<Unit> inertia{};            // principal moments / (mass · s²), each in (0, 1]
  // A union of three. A body that forces push in this tick: the velocities that they give it
  // (tick_gain.h). Another dynamic body that may fall asleep: the pose at which it began to rest
  // (rest.h). A static or kinematic body: the motion of its surface. Else zero.
  Vec3<Unit> union_a{};           // force; place, low 32 bits of Length; velocity
  Vec3<Unit> union_b{};           // torque; x, y, z of the orientation; turning
  Unit union_c{};                 // exponents; w
  std::int32_t inverse_mass = 0;  // mantissa; the exponent is below
  Number gravity_scale{};
  Rate linear_damping{};
  Rate angular_damping{};
  SolverVelocity max_speed{};
  SolverVelocity max_surface_speed{};
  Coefficient friction{};
  Coefficient restitution{};
  Coefficient rolling_resistance{};
  std::uint32_t tag = 0;
  std::uint32_t category = 0;
  std::uint32_t mask = 0;
  std::int32_t group = 0;
  std::uint32_t generation = 0;  // of the last body in this slot
  std::uint16_t rules = 0;       // CombineRules of friction, restitution, rolling: 3 bits each
  std::uint8_t motion = 0;       // MotionType, 0 for an empty slot
  std::uint8_t shape_kind = 0;   // ShapeKind
  std::uint8_t flags = 0;        // BodyFlag
  std::int8_t scale_exponent = 0;
  std::int8_t inverse_mass_exponent = 0;
  std::uint8_t locks = 0;        // BodyLock
  std::uint16_t rest_ticks = 0;  // since it rests
  std::uint8_t still_ticks = 0;  // StillIslands: since its island moved
  std::uint8_t loose_time = 0;   // EffortPolicy: for so long its pile is iterated, unstirred
  SolverVelocity hit_speed{};    // EventSettings::hit_speed

  friend bool operator==(const BodyRecord&, const BodyRecord&) = default;

  [[nodiscard]] bool exists() const { return motion != 0; }
  [[nodiscard]] bool moves() const { return motion >= 2; }
  [[nodiscard]] bool is_static() const { return is(MotionType::static_body); }
  [[nodiscard]] bool is_dynamic() const { return is(MotionType::dynamic); }
  [[nodiscard]] bool is_ball() const { return shape().kind == ShapeKind::sphere; }
  [[nodiscard]] bool is_trigger() const { return (flags & k_body_trigger) != 0; }
  [[nodiscard]] bool is_pushed() const { return (flags & k_body_pushed) != 0; }
  [[nodiscard]] bool is_bullet() const { return (flags & k_body_bullet) != 0; }
  [[nodiscard]] bool is_asleep() const { return (flags & k_body_asleep) != 0; }
  [[nodiscard]] bool is_awake() const {
    return moves() && !is_asleep() && (locks & k_body_disabled) == 0;
  }
  [[nodiscard]] bool may_sleep() const { return (flags & k_body_no_sleep) == 0; }
  [[nodiscard]] bool has_changed_sleep() const { return (flags & k_body_changed_sleep) != 0; }
  [[nodiscard]] bool rotates() const { return (locks & k_lock_turning) != k_lock_turning; }
  [[nodiscard]] bool is_locked(int axis) const { return (locks >> axis & 1) != 0; }
  [[nodiscard]] bool is_turn_locked(int axis) const { return (locks >> (3 + axis) & 1) != 0; }

  [[nodiscard]] Vec3<Length> rest_position() const { return read<Length>(union_a); }
  [[nodiscard]] Quat rest_orientation() const { return {union_b.x, union_b.y, union_b.z, union_c}; }
  void set_rest(const Vec3<Length>& place, const Quat& turned) {
    union_a = read<Unit>(place);
    union_b = {turned.x, turned.y, turned.z};
    union_c = turned.w;
  }

  /// SurfaceMotion about the centre of mass, along the body's axes. Only bodies that are not
  /// dynamic have one.
  [[nodiscard]] bool has_surface_motion() const {
    return !is_dynamic() && (union_a != Vec3<Unit>{} || union_b != Vec3<Unit>{});
  }
  [[nodiscard]] Vec3<SolverVelocity> surface_velocity() const {
    return read<SolverVelocity>(union_a);
  }
  [[nodiscard]] Vec3<Rate> surface_turning() const { return read<Rate>(union_b); }
  void set_surface_motion(const Vec3<SolverVelocity>& v, const Vec3<Rate>& turning) {
    union_a = read<Unit>(v);
    union_b = read<Unit>(turning);
  }

  [[nodiscard]] Surface surface() const {
    const auto rule = [&](int shift) { return static_cast<CombineRule>(rules >> shift & 7); };
    return {friction, restitution, rolling_resistance, rule(0), rule(3), rule(6), tag};
  }
  void set_surface(const Surface& surface) {
    friction = surface.friction;
    restitution = surface.restitution;
    rolling_resistance = surface.rolling_resistance;
    tag = surface.tag;
    rules = static_cast<std::uint16_t>(static_cast<unsigned>(surface.friction_rule) |
                                       static_cast<unsigned>(surface.restitution_rule) << 3 |
                                       static_cast<unsigned>(surface.rolling_rule) << 6);
  }
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
  template <class To, class From>
  [[nodiscard]] static Vec3<To> read(const Vec3<From>& v) {
    return {To::from_raw(v.x.raw), To::from_raw(v.y.raw), To::from_raw(v.z.raw)};
  }
  [[nodiscard]] bool is(MotionType type) const { return motion == static_cast<std::uint8_t>(type); }
};

/// SetEnabled.
[[nodiscard]] inline bool is_enabled(const BodyRecord& body) {
  return (body.locks & k_body_disabled) == 0;
}
[[nodiscard]] inline bool is_loose(const BodyRecord& body) {
  return body.loose_time != 0;
}

/// EventSettings.
[[nodiscard]] inline bool has_contact_events(const BodyRecord& body) {
  return (body.flags & k_body_no_contact_events) == 0;
}
[[nodiscard]] inline bool has_persist_events(const BodyRecord& body) {
  return (body.flags & k_body_persist_events) != 0;
}
[[nodiscard]] inline bool has_hit_events(const BodyRecord& body) {
  return body.hit_speed > SolverVelocity{};
}

// clang-format off
// X: a field in the unit of its type; B: one that holds bits without a unit.
#define LKS_BODY_FIELDS(X, B) \
  X(position) X(velocity) X(spin) X(user_data) X(asset) X(orientation) \
  X(recycling_orientation) B(recycling_place) X(size) X(inertia) B(union_a) B(union_b) B(union_c) X(inverse_mass) \
  X(gravity_scale) X(linear_damping) X(angular_damping) X(max_speed) X(max_surface_speed) \
  X(friction) X(restitution) X(rolling_resistance) X(tag) X(category) X(mask) X(group) \
  X(generation) X(rules) X(motion) X(shape_kind) X(flags) X(scale_exponent) \
  X(inverse_mass_exponent) X(locks) X(rest_ticks) X(still_ticks) X(loose_time) X(hit_speed)
// clang-format on

template <class F>
constexpr void visit_fields(BodyRecord& record, F&& f) {
#define LKS_VISIT(field) visit_value(#field, "", record.field, f);
#define LKS_VISIT_BITS(field) visit_bits(#field, "", record.field, f);
  LKS_BODY_FIELDS(LKS_VISIT, LKS_VISIT_BITS)
#undef LKS_VISIT_BITS
#undef LKS_VISIT
}

static_assert(visited_bytes<BodyRecord>() == sizeof(BodyRecord), "a field is missing in the list");

}  // namespace lockstone
