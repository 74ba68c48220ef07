// One list of fields per record, from which save, load, hash, diff and validation all come.
//
// A record type names its fields once in an X-macro and gets `visit_fields`, which calls
// `f(name, suffix, integer)` for every integer of the record in memory order. The static assertion
// beside each record proves that no byte is left out.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include <lockstone/fixed.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// A raw value as people read it: raw · 2^-frac_bits, in `unit`. A plain number has no unit.
struct FieldFormat {
  int frac_bits = 0;
  std::string_view unit;
};

/// The unit of a quantity, in ASCII as a wire carries it. A new dimension must be named here.
template <class D>
[[nodiscard]] constexpr std::string_view unit_of(D) = delete;
constexpr std::string_view unit_of(Scalar) {
  return "";
}
constexpr std::string_view unit_of(Metre) {
  return "m";
}
constexpr std::string_view unit_of(PerSecond) {
  return "1/s";
}
constexpr std::string_view unit_of(MetrePerSecond) {
  return "m/s";
}
constexpr std::string_view unit_of(MetrePerSecond2) {
  return "m/s^2";
}
constexpr std::string_view unit_of(KilogramPerMetre3) {
  return "kg/m^3";
}
constexpr std::string_view unit_of(Newton) {
  return "N";
}
constexpr std::string_view unit_of(NewtonMetre) {
  return "N m";
}

constexpr std::string_view unit_of(KilogramMetre2) {
  return "kg m^2";
}

template <class T>
inline constexpr FieldFormat k_format_of{T::frac_bits, unit_of(typename T::Unit{})};

/// Calls `f(name, suffix, integer, format)` where f takes a format, else without it.
template <class Integer, class F>
constexpr void visit_in(const FieldFormat& format, const char* name, const char* suffix,
                        Integer& integer, F&& f) {
  if constexpr (requires { f(name, suffix, integer, format); }) {
    f(name, suffix, integer, format);
  } else {
    f(name, suffix, integer);
  }
}

/// Calls `f` for each integer of `value`. `name` is the field's, `suffix` says which part.
template <class T, class F>
requires(std::is_integral_v<T>) constexpr void visit_value(const char* name, const char* suffix,
                                                           T& value, F&& f) {
  f(name, suffix, value);
}

template <class F>
constexpr void visit_value(const char* name, const char* suffix, AssetId& value, F&& f) {
  f(name, suffix, value.value);
}

template <class D, class R, int N, class F>
constexpr void visit_value(const char* name, const char* suffix, Fixed<D, R, N>& value, F&& f) {
  visit_in(k_format_of<Fixed<D, R, N>>, name, suffix, value.raw, f);
}

template <class T, class F>
constexpr void visit_value(const char* name, const char*, Vec3<T>& value, F&& f) {
  visit_value(name, ".x", value.x, f);
  visit_value(name, ".y", value.y, f);
  visit_value(name, ".z", value.z, f);
}

template <class F>
constexpr void visit_value(const char* name, const char*, Quat& value, F&& f) {
  visit_value(name, ".x", value.x, f);
  visit_value(name, ".y", value.y, f);
  visit_value(name, ".z", value.z, f);
  visit_value(name, ".w", value.w, f);
}

/// For fields whose bits are plain integers, not values of their type.
template <class D, class R, int N, class F>
constexpr void visit_bits(const char* name, const char* suffix, Fixed<D, R, N>& value, F&& f) {
  f(name, suffix, value.raw);
}

template <class T, class F>
constexpr void visit_bits(const char* name, const char*, Vec3<T>& value, F&& f) {
  visit_bits(name, ".x", value.x, f);
  visit_bits(name, ".y", value.y, f);
  visit_bits(name, ".z", value.z, f);
}

/// The number of bytes that visiting a record touches.
template <class Record>
[[nodiscard]] constexpr std::size_t visited_bytes() {
  std::size_t bytes = 0;
  Record record{};
  visit_fields(record, [&](const char*, const char*, auto& integer) { bytes += sizeof(integer); });
  return bytes;
}

}  // namespace lockstone
