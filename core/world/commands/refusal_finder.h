// Looks through the fields of a definition or a command for the first that is wrong.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/decimal.h>
#include <lockstone/fluid.h>
#include <lockstone/joint.h>
#include <lockstone/refusal.h>
#include <lockstone/rules.h>

namespace lockstone {

/// The pieces of a text, one after another. Only refusals make texts, so these functions are
/// compiled for their size: each is one call where it is used.
[[nodiscard]] std::string joined(std::initializer_list<std::string_view> pieces);

class RefusalFinder {
 public:
  /// Field names begin with `prefix`: "body.".
  explicit RefusalFinder(std::string prefix) : prefix_(std::move(prefix)) {}

  [[nodiscard]] bool done() const { return static_cast<bool>(found_); }
  [[nodiscard]] Refusal take() { return std::move(found_); }
  void adopt(Refusal found) {
    if (!done()) found_ = std::move(found);
  }
  /// For the fields of a part, whose names begin with `name` behind the prefix.
  [[nodiscard]] RefusalFinder part(std::string_view name) const {
    return RefusalFinder(joined({prefix_, name}));
  }

  /// Notes the field unless it is good, or another was noted before.
  void require(bool good, std::string_view field, std::string_view value, std::string_view rule) {
    if (!good && !done()) note(field, value, rule);
  }

  /// low ≤ value ≤ high.
  template <class T>
  void within(std::string_view field, T value, T low, std::type_identity_t<T> high,
              std::string_view unit = {}) {
    if (value < low || value > high)
      note_range(field, raw_of(value), raw_of(low), raw_of(high), {k_bits<T>, unit});
  }

  template <class T>
  void within(std::string_view field, const Vec3<T>& v, std::type_identity_t<T> limit,
              std::string_view unit) {
    constexpr std::string_view k_axes[] = {".x", ".y", ".z"};
    for (int i = 0; i < 3; ++i)
      if (v[i] < -limit || v[i] > limit)
        note_range(joined({field, k_axes[i]}), v[i].raw, -limit.raw, limit.raw, {k_bits<T>, unit});
  }

  template <class T>
  void at_least(std::string_view field, T value, T low, std::string_view unit) {
    if (value < low) note_least(field, value.raw, low.raw, {k_bits<T>, unit});
  }

  template <class T>
  void above_zero(std::string_view field, T value, std::string_view unit) {
    if (value <= T{}) note_positive(field, value.raw, {k_bits<T>, unit});
  }

  /// One of the enumerators first … last.
  template <class E>
  requires std::is_enum_v<E>
  void known(std::string_view field, E value, E first, E last) {
    if (value < first || value > last)
      note_unknown(field, static_cast<int>(value), {to_string(first), static_cast<int>(first)},
                   {to_string(last), static_cast<int>(last)});
  }

  void direction(std::string_view field, const Quat& q);

  [[nodiscard]] static std::string handle_text(std::uint32_t index, std::uint32_t generation);

  template <class T>
  [[nodiscard]] static std::string text(T value, std::string_view unit = {}) {
    return number_text(raw_of(value), {k_bits<T>, unit});
  }

 private:
  /// How a raw number is written.
  struct Format {
    int bits;  // of the fraction
    std::string_view unit;
  };
  struct Named {
    std::string_view name;
    int number;
  };

  template <class T>
  static constexpr std::int64_t raw_of(T value) {
    if constexpr (std::integral<T>)
      return static_cast<std::int64_t>(value);
    else
      return value.raw;
  }
  template <class T>
  static constexpr int bits_of() {
    if constexpr (std::integral<T>)
      return 0;
    else
      return T::frac_bits;
  }
  template <class T>
  static constexpr int k_bits = bits_of<T>();

  [[nodiscard]] static std::string number_text(std::int64_t raw, Format format);
  void note(std::string_view field, std::string_view value, std::string_view rule);
  void note_range(std::string_view field, std::int64_t value, std::int64_t low, std::int64_t high,
                  Format format);
  void note_least(std::string_view field, std::int64_t value, std::int64_t low, Format format);
  void note_positive(std::string_view field, std::int64_t value, Format format);
  void note_unknown(std::string_view field, int value, Named first, Named last);

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
void check_axis(RefusalFinder& joint, JointKind kind, std::size_t axis, const LinearAxis& settings);
void check_axis(RefusalFinder& joint, JointKind kind, std::size_t axis,
                const AngularAxis& settings);

}  // namespace lockstone
