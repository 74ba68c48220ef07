// One list of fields per record, from which save, load, hash, diff and validation all come.
//
// A record type names its fields once in an X-macro and gets `visit_fields`, which calls
// `f(name, suffix, integer)` for every integer of the record in memory order. The static assertion
// beside each record proves that no byte is left out.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include <lockstone/fixed.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/vec3.h>

namespace lockstone {

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
  f(name, suffix, value.raw);
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

/// The number of bytes that visiting a record touches.
template <class Record>
[[nodiscard]] constexpr std::size_t visited_bytes() {
  std::size_t bytes = 0;
  Record record{};
  visit_fields(record, [&](const char*, const char*, auto& integer) { bytes += sizeof(integer); });
  return bytes;
}

}  // namespace lockstone
