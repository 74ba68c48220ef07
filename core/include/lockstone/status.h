// The result of an operation that can fail.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone {

/// The outcome of an operation. Every peer of a match gets the same one at the same tick.
enum class [[nodiscard]] Status : std::uint8_t{
    ok = 0,
    capacity_exhausted,   ///< a store of the world is full; nothing was changed
    stale_handle,         ///< the object that the handle named no longer exists
    invalid_argument,     ///< a value lies outside its documented range
    truncated,            ///< the bytes end before the announced length
    malformed,            ///< the bytes break their format
    checksum_mismatch,    ///< the bytes were damaged
    unsupported_version,  ///< the bytes are of another format version
    incompatible,         ///< the bytes are well formed but belong to another configuration
    io_error,             ///< the operating system refused to read or write
    not_found,            ///< the named thing does not exist
};

/// A short lower-case English name, for logs.
[[nodiscard]] std::string_view to_string(Status status);

/// Prints the status and aborts: `Result::value` was called on an error.
[[noreturn]] void no_value(Status error);

/// A value or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(Status error) : error_(error) { LKS_CHECK(error != Status::ok); }  // NOLINT

  [[nodiscard]] bool ok() const { return value_.has_value(); }
  [[nodiscard]] explicit operator bool() const { return ok(); }
  [[nodiscard]] Status status() const { return error_; }

  /// The value. Calling it on an error is a programmer's error: the program prints the status and
  /// aborts.
  [[nodiscard]] T& value() & {
    if (!ok()) no_value(error_);
    return *value_;
  }
  [[nodiscard]] const T& value() const& {
    if (!ok()) no_value(error_);
    return *value_;
  }
  [[nodiscard]] T&& value() && {
    if (!ok()) no_value(error_);
    return std::move(*value_);
  }

 private:
  std::optional<T> value_;
  Status error_ = Status::ok;
};

}  // namespace lockstone
