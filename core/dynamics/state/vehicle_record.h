// A vehicle as it is stored, saved and hashed.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/vehicle.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

/// Bits of VehicleRecord::flags.
enum VehicleFlag : std::uint32_t {
  k_vehicle_automatic = 1,
  k_vehicle_casts_spheres = 2,
  k_vehicle_leans = 4,       // a motorcycle
  k_vehicle_has_tracks = 8,  // not both
  k_all_vehicle_flags =
      k_vehicle_automatic | k_vehicle_casts_spheres | k_vehicle_leans | k_vehicle_has_tracks,
};

struct AxleRecord {
  Vec3<Length> mount{};
  Length half_track{};
  Length radius{};
  Length travel{};
  Number frequency{};
  Number damping_ratio{};
  Number anti_roll{};
  Angle max_steer{};
  Unit drive{};
  Coefficient friction{};
  Torque brake{};
  Torque handbrake{};
  Torque differential_lock{};

  friend bool operator==(const AxleRecord&, const AxleRecord&) = default;
};

struct WheelRecord {
  AngularVelocity spin{};
  Position slip_along{};   // deflection of the tyre at the ground, against the force
  Position slip_across{};  // the same to the right
  Force load{};
  Length compression{};
  std::uint32_t is_grounded = 0;

  friend bool operator==(const WheelRecord&, const WheelRecord&) = default;
};

/// Records are sorted by chassis; axles and wheels beyond axle_count are zero.
struct VehicleRecord {
  std::uint32_t chassis = 0;  // its index
  std::uint32_t axle_count = 0;
  std::array<AxleRecord, k_max_axles> axles{};
  std::array<Torque, k_torque_points> torque{};
  AngularVelocity idle_speed{};
  AngularVelocity max_speed{};
  MomentOfInertia engine_inertia{};
  Torque engine_friction{};
  std::array<Number, k_max_gears> ratios{};
  Number reverse{};
  Number final_drive{};
  AngularVelocity shift_up{};
  AngularVelocity shift_down{};
  Torque clutch_torque{};
  MomentOfInertia wheel_inertia{};
  Unit peak_slip{};
  Unit peak_angle{};
  Length relaxation{};
  Coefficient rolling_resistance{};
  std::uint32_t shift_ticks = 0;
  std::uint32_t flags = 0;  // VehicleFlag
  std::uint32_t mask = 0;
  Unit throttle{};
  Unit brake{};
  Unit handbrake{};
  Unit steer{};
  Unit clutch{};
  std::int32_t wanted_gear = 0;
  Angle max_lean{};  // 0 but of motorcycles
  std::array<WheelRecord, 2 * k_max_axles> wheels{};
  AngularVelocity engine_speed{};
  std::int32_t gear = 0;
  std::uint32_t shifting = 0;  // ticks that the clutch stays open

  friend bool operator==(const VehicleRecord&, const VehicleRecord&) = default;

  [[nodiscard]] std::uint32_t key() const { return chassis; }
  [[nodiscard]] bool has(VehicleFlag flag) const { return (flags & flag) != 0; }
};

/// The highest place of a wheel's centre in the axes of the chassis; the left wheel of an axle is
/// the first one.
[[nodiscard]] inline Vec3<Length> highest_centre(const AxleRecord& axle, std::size_t wheel) {
  Vec3<Length> centre = axle.mount;
  centre.z += wheel % 2 == 0 ? -axle.half_track : axle.half_track;
  return centre;
}

/// Where it is now: of axle wheel / 2.
[[nodiscard]] inline Vec3<Length> centre_of_wheel(const VehicleRecord& vehicle, std::size_t wheel) {
  const AxleRecord& axle = vehicle.axles[wheel / 2];
  Vec3<Length> centre = highest_centre(axle, wheel);
  centre.y += vehicle.wheels[wheel].compression - axle.travel;
  return centre;
}

template <class F>
constexpr void visit_axle(const char* name, AxleRecord& axle, F&& f) {
  visit_value(name, ".mount", axle.mount, f);
  visit_value(name, ".half_track", axle.half_track, f);
  visit_value(name, ".radius", axle.radius, f);
  visit_value(name, ".travel", axle.travel, f);
  visit_value(name, ".frequency", axle.frequency, f);
  visit_value(name, ".damping_ratio", axle.damping_ratio, f);
  visit_value(name, ".anti_roll", axle.anti_roll, f);
  visit_value(name, ".max_steer", axle.max_steer, f);
  visit_value(name, ".drive", axle.drive, f);
  visit_value(name, ".friction", axle.friction, f);
  visit_value(name, ".brake", axle.brake, f);
  visit_value(name, ".handbrake", axle.handbrake, f);
  visit_value(name, ".differential_lock", axle.differential_lock, f);
}

template <class F>
constexpr void visit_wheel(const char* name, WheelRecord& wheel, F&& f) {
  visit_value(name, ".spin", wheel.spin, f);
  visit_value(name, ".slip_along", wheel.slip_along, f);
  visit_value(name, ".slip_across", wheel.slip_across, f);
  visit_value(name, ".load", wheel.load, f);
  visit_value(name, ".compression", wheel.compression, f);
  visit_value(name, ".is_grounded", wheel.is_grounded, f);
}

// clang-format off
#define LKS_VEHICLE_FIELDS_1(X) X(idle_speed) X(max_speed) X(engine_inertia) X(engine_friction)
#define LKS_VEHICLE_FIELDS_2(X) \
  X(reverse) X(final_drive) X(shift_up) X(shift_down) X(clutch_torque) X(wheel_inertia) \
  X(peak_slip) X(peak_angle) X(relaxation) X(rolling_resistance) X(shift_ticks) X(flags) X(mask) \
  X(throttle) X(brake) X(handbrake) X(steer) X(clutch) X(wanted_gear) X(max_lean)
// clang-format on

template <class F>
constexpr void visit_fields(VehicleRecord& record, F&& f) {
  constexpr const char* k_axles[] = {"axle[0]", "axle[1]", "axle[2]"};
  constexpr const char* k_wheels[] = {"wheel[0]", "wheel[1]", "wheel[2]",
                                      "wheel[3]", "wheel[4]", "wheel[5]"};
  constexpr const char* k_parts[] = {"[0]", "[1]", "[2]", "[3]", "[4]", "[5]", "[6]", "[7]"};
#define LKS_VISIT(field) visit_value(#field, "", record.field, f);
  visit_value("chassis", "", record.chassis, f);
  visit_value("axle_count", "", record.axle_count, f);
  for (std::size_t i = 0; i < k_max_axles; ++i)
    visit_axle(k_axles[i], record.axles[i], f);
  for (std::size_t i = 0; i < k_torque_points; ++i)
    visit_value("torque", k_parts[i], record.torque[i], f);
  LKS_VEHICLE_FIELDS_1(LKS_VISIT)
  for (std::size_t i = 0; i < k_max_gears; ++i)
    visit_value("ratio", k_parts[i], record.ratios[i], f);
  LKS_VEHICLE_FIELDS_2(LKS_VISIT)
  for (std::size_t i = 0; i < 2 * k_max_axles; ++i)
    visit_wheel(k_wheels[i], record.wheels[i], f);
  visit_value("engine_speed", "", record.engine_speed, f);
  visit_value("gear", "", record.gear, f);
  visit_value("shifting", "", record.shifting, f);
#undef LKS_VISIT
}

static_assert(visited_bytes<VehicleRecord>() == sizeof(VehicleRecord), "a field is missing");

}  // namespace lockstone
