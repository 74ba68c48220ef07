// Little-endian bytes, independent of the processor's byte order: every multi-byte value is coded
// by shifts. Neither class allocates; an access beyond the end sets a sticky failure instead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace lockstone {

using ByteView = std::span<const std::byte>;

/// Writes integers into a buffer that the caller owns.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::byte> buffer) : buffer_(buffer) {}

  /// Appends `value` in little-endian order; 1, 2, 4 or 8 bytes by its type.
  template <class T>
  requires(std::is_integral_v<T> || std::is_enum_v<T>) void put(T value) {
    if (!reserve(sizeof(T))) return;
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) {
      buffer_[size_++] = static_cast<std::byte>(bits & 0xff);
    }
  }

  void put_bytes(ByteView bytes) {
    if (!reserve(bytes.size())) return;
    for (std::byte byte : bytes)
      buffer_[size_++] = byte;
  }

  [[nodiscard]] bool ok() const { return ok_; }             ///< false once anything did not fit
  [[nodiscard]] std::size_t size() const { return size_; }  ///< bytes written so far
  [[nodiscard]] ByteView written() const { return buffer_.first(size_); }

 private:
  bool reserve(std::size_t bytes) {
    ok_ = ok_ && bytes <= buffer_.size() - size_;
    return ok_;
  }

  std::span<std::byte> buffer_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

/// Reads integers from bytes that may come from anywhere. After a read beyond the end, `ok()` is
/// false and every further read gives zero: check once, after the last read, before use.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  template <class T>
  requires std::is_integral_v<T>
  [[nodiscard]] T get() {
    if (!available(sizeof(T))) return T{};
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bits |= static_cast<std::uint64_t>(bytes_[position_ + i]) << (8 * i);
    }
    position_ += sizeof(T);
    return static_cast<T>(bits);
  }

  /// The next `count` bytes, or an empty view.
  [[nodiscard]] ByteView get_bytes(std::size_t count) {
    if (!available(count)) return {};
    ByteView view = bytes_.subspan(position_, count);
    position_ += count;
    return view;
  }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }

 private:
  bool available(std::size_t count) {
    ok_ = ok_ && count <= remaining();
    return ok_;
  }

  ByteView bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace lockstone
