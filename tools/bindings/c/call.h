// Used by every function of the C interface: checks of arguments, and failures that become a status
// and a message. Exceptions stay within the library; none leaves `call`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <lockstone/refusal.h>
#include <lockstone/status.h>

#include "tools/bindings/c/lockstone.h"

namespace lockstone::c {

/// Why a call does nothing.
struct Failure {
  lks_status status;
  std::string message;
};

/// They throw a Failure; functions, because many places do.
[[noreturn]] void throw_status(lks_status status, std::string_view message);
[[noreturn]] void throw_failure(Status status, const Refusal& refusal = {});
[[noreturn]] void throw_invalid(std::string_view field, std::string_view rule);
[[noreturn]] void throw_null(std::string_view name);
[[noreturn]] void throw_wrong_size(std::string_view name, std::size_t size, std::size_t least,
                                   std::size_t most);
[[noreturn]] void throw_number(std::string_view field, std::uint32_t number,
                               std::string_view fault);

/// Keeps the message for lks_last_error, cut to its room between two characters.
lks_status remember(lks_status status, std::string_view message) noexcept;

/// Runs the function; its exception becomes a status and a message.
lks_status call_guarded(void (*function)(void* body), void* body) noexcept;

/// Runs the body of a function of the interface. The exceptions are caught in one place, or each of
/// the many functions would have code for them.
template <class Body>
lks_status call(Body&& body) noexcept {
  return call_guarded([](void* of) { (*static_cast<std::remove_reference_t<Body>*>(of))(); },
                      &body);
}

/// The object that the pointer points to; throws for null.
template <class T>
T& required(T* pointer, std::string_view name) {
  if (pointer == nullptr) throw_null(name);
  return *pointer;
}

/// Of an array: null is right for no elements.
template <class T>
T* array(T* pointer, std::size_t count, std::string_view name) {
  if (count > 0 && pointer == nullptr) throw_null(name);
  return pointer;
}

/// The value of a result; throws its status.
template <class T>
T value_of(Result<T>&& result) {
  if (!result.ok()) throw_failure(result.status());
  return std::move(result).value();
}

/// An enumerator by its number; throws beyond first … last.
template <class Enum>
Enum enumerator(std::uint32_t number, Enum first, Enum last, std::string_view field) {
  if (number < static_cast<std::uint32_t>(first) || number > static_cast<std::uint32_t>(last))
    throw_number(field, number, "is no such value");
  return static_cast<Enum>(number);
}

/// The number in a narrower type; throws where it does not fit.
template <class T>
T narrow(std::uint32_t number, std::string_view field) {
  if (number > std::numeric_limits<T>::max()) throw_number(field, number, "is out of range");
  return static_cast<T>(number);
}

/// 0 or 1 as a bool; throws otherwise.
bool flag(std::uint32_t number, std::string_view field);

/// Throws where a bit outside `known` is set.
void check_bits(std::uint32_t bits, std::uint32_t known, std::string_view field);

/// The size that a structure had when it was first released: a program compiled then still says it.
template <class T>
inline constexpr std::size_t k_first_size = sizeof(T);

template <class T>
void check_size(std::size_t size, std::string_view name) {
  if (size >= k_first_size<T> && size <= sizeof(T) && size % 8 == 0) return;
  throw_wrong_size(name, size, k_first_size<T>, sizeof(T));
}

/// A structure from the caller: the fields that it does not know have their defaults.
template <class T>
T take(const T* from, const T& defaults, std::string_view name) {
  const std::size_t size = required(from, name).size;
  check_size<T>(size, name);
  T whole = defaults;
  std::memcpy(&whole, from, size);
  return whole;
}

/// A structure to the caller: the fields that it knows.
template <class T>
void give(const T& whole, T* to, std::size_t size, std::string_view name) {
  required(to, name);
  check_size<T>(size, name);
  std::memcpy(to, &whole, size);
  to->size = static_cast<std::uint32_t>(size);
}

/// Says how many there are; throws where the caller's array holds fewer.
void give_count(std::size_t found, std::size_t capacity, std::size_t& count, std::string_view what);

/// Writes text that ends with a zero, cut to the room between two characters.
void write_text(std::string_view text, char* out, std::size_t capacity);

}  // namespace lockstone::c
