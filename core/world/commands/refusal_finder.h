// Looks through the fields of a definition or a command for the first that is wrong.
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>

#include <lockstone/body.h>
#include <lockstone/decimal.h>
#include <lockstone/fluid.h>
#include <lockstone/joint.h>
#include <lockstone/refusal.h>
#include <lockstone/rules.h>

namespace lockstone {

class RefusalFinder {
 public:
  /// Field names begin with `prefix`: "body.".
  explicit RefusalFinder(std::string prefix) : prefix_(std::move(prefix)) {}

  [[nodiscard]] bool done() const { return static_cast<bool>(found_); }
  [[nodiscard]] Refusal take() { return std::move(found_); }
  void adopt(Refusal found) {
    if (!done()) found_ = std::move(found);
  }

  /// Notes the field unless it is good, or another was noted before.
  void require(bool good, std::string_view field, std::string_view value, std::string_view rule) {
    if (good || done()) return;
    found_ = {prefix_ + std::string(field), std::string(value), "must be " + std::string(rule)};
  }

  /// low ≤ value ≤ high.
  template <class T>
  void within(std::string_view field, T value, T low, std::type_identity_t<T> high,
              std::string_view unit = {}) {
    if (done() || (value >= low && value <= high)) return;
    require(false, field, text(value, unit), text(low) + " … " + text(high, unit));
  }

  template <class T>
  void within(std::string_view field, const Vec3<T>& v, std::type_identity_t<T> limit,
              std::string_view unit) {
    constexpr std::string_view k_axes[] = {".x", ".y", ".z"};
    for (int i = 0; i < 3 && !done(); ++i)
      within(std::string(field) + std::string(k_axes[i]), v[i], -limit, limit, unit);
  }

  template <class T>
  void at_least(std::string_view field, T value, T low, std::string_view unit) {
    if (done() || value >= low) return;
    require(false, field, text(value, unit), "at least " + text(low, unit));
  }

  template <class T>
  void above_zero(std::string_view field, T value, std::string_view unit) {
    if (done() || value > T{}) return;
    require(false, field, text(value, unit), "above 0" + with_space(unit));
  }

  /// One of the enumerators first … last.
  template <class E>
  requires std::is_enum_v<E>
  void known(std::string_view field, E value, E first, E last) {
    if (done() || (value >= first && value <= last)) return;
    require(false, field, std::to_string(static_cast<int>(value)),
            std::string(to_string(first)) + " … " + std::string(to_string(last)) + " (" +
                std::to_string(static_cast<int>(first)) + " … " +
                std::to_string(static_cast<int>(last)) + ')');
  }

  void direction(std::string_view field, const Quat& q);

  [[nodiscard]] static std::string handle_text(std::uint32_t index, std::uint32_t generation) {
    return '{' + std::to_string(index) + ", " + std::to_string(generation) + '}';
  }

  template <class T>
  [[nodiscard]] static std::string text(T value, std::string_view unit = {}) {
    if constexpr (std::integral<T>)
      return std::to_string(value) + with_space(unit);
    else
      return to_decimal(value) + with_space(unit);
  }

 private:
  [[nodiscard]] static std::string with_space(std::string_view unit) {
    return unit.empty() ? std::string() : ' ' + std::string(unit);
  }

  std::string prefix_;
  Refusal found_;
};

/// The fields that definitions and commands have in common.
void check(RefusalFinder& find, const Surface& surface);
void check(RefusalFinder& find, const SurfaceMotion& motion);
void check(RefusalFinder& find, const SpeedLimit& limit);
void check(RefusalFinder& find, const EventSettings& settings);
void check(RefusalFinder& find, const Fluid& fluid);
void check(RefusalFinder& find, const PairSurface& surface);
void check(RefusalFinder& find, const Shape& shape, const Asset* asset);
/// Moments of inertia for a mass that is valid.
void check_moments(RefusalFinder& find, std::string_view field, const MassData& data,
                   int scale_exponent);
/// |ω · 2^exponent| ≤ 500 m/s on the surface.
void check_turning(RefusalFinder& find, const Vec3<AngularVelocity>& turning, int exponent);
void check_axis(RefusalFinder& find, JointKind kind, std::size_t axis, const LinearAxis& settings);
void check_axis(RefusalFinder& find, JointKind kind, std::size_t axis, const AngularAxis& settings);

}  // namespace lockstone
