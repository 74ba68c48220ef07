// A joint as it is stored, saved and hashed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lockstone/joint.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/fields.h"

namespace lockstone {

/// Bits of JointRecord::flags.
enum JointFlag : std::uint8_t {
  k_joint_collide = 1,
  k_all_joint_flags = k_joint_collide,
};

inline constexpr std::size_t k_joint_axes = 6;

/// Of JointRecord::energy_gained.
inline constexpr int k_gained_frac_bits = 16;

/// Settings and impulses of one axis; lengths and angles, speeds and efforts are raws of the public
/// types. Impulses are per substep and the pair's velocity jump, λ·(1/mA + 1/mB); those of a joint
/// whose first three axes are rigid are along the axes of the world. An angular axis has the length
/// unit 2^k m, k the greater scale exponent of the bodies that move.
struct JointAxisRecord {
  std::int64_t max_effort = 0;
  std::int32_t lower = 0;
  std::int32_t upper = 0;
  std::int32_t target = 0;
  std::int32_t speed = 0;
  Number hertz{};
  Number damping_ratio{};
  SolverVelocity impulse{};        // of lock or limit; of a pulley, gear or rack its only one
  SolverVelocity drive_impulse{};  // of spring or motor

  friend bool operator==(const JointAxisRecord&, const JointAxisRecord&) = default;

  [[nodiscard]] bool is_spring() const { return hertz.raw > 0; }
  [[nodiscard]] bool is_driven() const { return is_spring() || max_effort > 0; }
};

/// Canonical state of one joint slot; all zero but `generation` when the slot is empty. Frames are
/// relative to centres of mass and principal axes.
struct JointRecord {
  std::array<JointAxisRecord, k_joint_axes> axes{};  // along x, y, z; twist, swing y, swing z
  Vec3<Position> ground_a{};  // of a pulley; of a path joint its x is a parameter
  Vec3<Position> ground_b{};  // of a pulley; of a path joint its x is the path's name
  std::uint64_t user_data = 0;
  Force break_force{};
  Torque break_torque{};
  Vec3<Length> anchor_a{};
  Vec3<Length> anchor_b{};
  Quat orientation_a{{}, {}, {}, {}};
  Quat orientation_b{{}, {}, {}, {}};
  Length total_length{};  // of a pulley
  Number ratio{};
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t generation = 0;                    // of the last joint in this slot
  std::array<std::uint8_t, k_joint_axes> modes{};  // AxisMode
  std::uint8_t kind = 0;                           // JointKind, 0 for an empty slot
  std::uint8_t flags = 0;                          // JointFlag
  std::int32_t energy_gained = 0;                  // see EnergyAccount; twice, (m/s)², Q16

  friend bool operator==(const JointRecord&, const JointRecord&) = default;

  [[nodiscard]] bool exists() const { return kind != 0; }
  [[nodiscard]] bool is(JointKind k) const { return kind == static_cast<std::uint8_t>(k); }
  [[nodiscard]] bool collides() const { return (flags & k_joint_collide) != 0; }
  [[nodiscard]] AxisMode mode(std::size_t axis) const { return static_cast<AxisMode>(modes[axis]); }
};

/// A path joint keeps the name of its path, and where on it it is, in place of a pulley's points.
[[nodiscard]] inline AssetId path_of(const JointRecord& joint) {
  return {static_cast<std::uint64_t>(joint.ground_b.x.raw)};
}
/// Its place, by which the next one is found: along the chords of the path's points, m.
[[nodiscard]] inline Position path_parameter(const JointRecord& joint) {
  return joint.ground_a.x;
}

/// Whether a joint locks all turning: frame B then stays at the rotation vector of the targets.
[[nodiscard]] inline bool locks_turning(const JointRecord& joint) {
  if (joint.is(JointKind::path)) return false;
  for (std::size_t i = 3; i < k_joint_axes; ++i)
    if (joint.mode(i) != AxisMode::locked || joint.axes[i].is_driven()) return false;
  return true;
}

/// Whether it turns frame B in the coming tick.
[[nodiscard]] inline bool turns_locks(const JointRecord& joint) {
  const std::int32_t any = joint.axes[3].speed | joint.axes[4].speed | joint.axes[5].speed;
  return any != 0 && locks_turning(joint);
}

/// Whether springs, motors or turning locks may give energy.
[[nodiscard]] inline bool is_driven(const JointRecord& joint) {
  for (const JointAxisRecord& axis : joint.axes)
    if (axis.is_driven()) return true;
  return turns_locks(joint);
}

/// Of an axis's raws.
struct JointAxisFormats {
  FieldFormat value, speed, effort;
};
inline constexpr JointAxisFormats k_linear_formats{k_format_of<Length>, k_format_of<SolverVelocity>,
                                                   k_format_of<Force>};
inline constexpr JointAxisFormats k_angular_formats{
    {Angle::frac_bits, "rad"}, {Rate::frac_bits, "rad/s"}, k_format_of<Torque>};

template <class F>
constexpr void visit_fields(JointRecord& record, F&& f) {
  constexpr const char* k_axis_names[] = {"linear[0]",  "linear[1]",  "linear[2]",
                                          "angular[0]", "angular[1]", "angular[2]"};
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    JointAxisRecord& axis = record.axes[i];
    const char* name = k_axis_names[i];
    const JointAxisFormats& formats = i < 3 ? k_linear_formats : k_angular_formats;
    visit_in(formats.effort, name, ".max_effort", axis.max_effort, f);
    visit_in(formats.value, name, ".lower", axis.lower, f);
    visit_in(formats.value, name, ".upper", axis.upper, f);
    visit_in(formats.value, name, ".target", axis.target, f);
    visit_in(formats.speed, name, ".speed", axis.speed, f);
    visit_in({Number::frac_bits, "Hz"}, name, ".hertz", axis.hertz.raw, f);
    visit_value(name, ".damping_ratio", axis.damping_ratio, f);
    visit_value(name, ".impulse", axis.impulse, f);
    visit_value(name, ".drive_impulse", axis.drive_impulse, f);
  }
  visit_value("ground_a", "", record.ground_a, f);
  visit_value("ground_b", "", record.ground_b, f);
  visit_value("user_data", "", record.user_data, f);
  visit_value("break_force", "", record.break_force, f);
  visit_value("break_torque", "", record.break_torque, f);
  visit_value("anchor_a", "", record.anchor_a, f);
  visit_value("anchor_b", "", record.anchor_b, f);
  visit_value("orientation_a", "", record.orientation_a, f);
  visit_value("orientation_b", "", record.orientation_b, f);
  visit_value("total_length", "", record.total_length, f);
  visit_value("ratio", "", record.ratio, f);
  visit_value("body_a", "", record.body_a, f);
  visit_value("body_b", "", record.body_b, f);
  visit_value("generation", "", record.generation, f);
  for (std::size_t i = 0; i < k_joint_axes; ++i)
    visit_value(k_axis_names[i], ".mode", record.modes[i], f);
  visit_value("kind", "", record.kind, f);
  visit_value("flags", "", record.flags, f);
  visit_in({k_gained_frac_bits, "m²/s²"}, "energy_gained", "", record.energy_gained, f);
}

static_assert(visited_bytes<JointRecord>() == sizeof(JointRecord), "a field is missing");

/// The scale of a joint's angular axes: the greater scale exponent of the bodies that are pushed.
[[nodiscard]] inline int angular_exponent(const BodyRecord& a, const BodyRecord& b) {
  if (!a.is_dynamic()) return b.scale_exponent;
  if (!b.is_dynamic()) return a.scale_exponent;
  return a.scale_exponent > b.scale_exponent ? a.scale_exponent : b.scale_exponent;
}

/// A live joint and the bodies it holds, for callers that need no more.
struct JointLink {
  std::uint32_t joint = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
};

}  // namespace lockstone
