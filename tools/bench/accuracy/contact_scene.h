// Helpers for rows of contact: ground, bodies and numbers.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <lockstone/literals.h>

#include "tools/bench/accuracy/scene_run.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {

inline constexpr double k_gravity = 9.81;
inline constexpr double k_degree = std::numbers::pi / 180;

/// The usual setting, or with `--sweep` 1 to 16 substeps.
[[nodiscard]] inline std::vector<AccuracyResult> at_settings(
    const AccuracyOptions& options, const std::function<AccuracyResult(const Setting&)>& measure) {
  if (options.sweep) return over_substeps(measure);
  return {measure(k_usual_setting)};
}

/// Nothing sleeps.
[[nodiscard]] inline WorldDef contact_world(std::uint32_t bodies = 64) {
  WorldDef def;
  def.body_capacity = bodies;
  def.pair_capacity = def.contact_capacity = 32 * bodies;
  def.sleep_ms = 0;
  return def;
}

/// Any fixed-point value from a double, to nearest.
template <class T>
[[nodiscard]] T fixed(double x) {
  return T::from_raw(
      static_cast<typename T::Representation>(std::llround(std::ldexp(x, T::frac_bits))));
}
template <class T>
[[nodiscard]] Vec3<T> fixed(double x, double y, double z) {
  return {fixed<T>(x), fixed<T>(y), fixed<T>(z)};
}

/// Gravity on a slope that falls towards +x.
[[nodiscard]] inline Vec3<Acceleration> tilted_gravity(double angle) {
  return fixed<Acceleration>(k_gravity * std::sin(angle), -k_gravity * std::cos(angle), 0);
}

/// Turns gravity evenly over some seconds.
inline void tilt(SceneRun& scene, double from, double to, double seconds) {
  const int ticks = static_cast<int>(seconds * scene.setting().tick_rate);
  for (int tick = 1; tick <= ticks; ++tick) {
    (void)scene.world().apply(SetGravity{tilted_gravity(from + (to - from) * tick / ticks)});
    scene.step();
  }
}

/// A static box of 200 m with its top at y = 0.
[[nodiscard]] inline BodyDef ground(Coefficient friction = Coefficient::from_ratio(1, 2)) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape =
      Shape::box(Length::from_integer(100), Length::from_integer(1), Length::from_integer(100));
  def.position.y = Position::from_integer(-1);
  def.material.friction = friction;
  return def;
}

[[nodiscard]] inline BodyDef body_at(const Shape& shape, double x, double y, double z) {
  BodyDef def;
  def.shape = shape;
  def.position = fixed<Position>(x, y, z);
  return def;
}

[[nodiscard]] inline Shape unit_box() {
  constexpr Length k_half = Length::from_ratio(1, 2);
  return Shape::box(k_half, k_half, k_half);
}

}  // namespace lockstone::bench
