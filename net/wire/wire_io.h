// Reading and writing of one message: its type first, ranges checked, nothing left over.
#pragma once

#include <lockstone/bytes.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

class WireWriter {
 public:
  WireWriter(MessageType type, std::span<std::byte> out) : writer_(out) { writer_.put(type); }

  template <class T>
  void put(T value) {
    writer_.put(value);
  }
  void put_flag(bool flag) { writer_.put<std::uint8_t>(flag ? 1 : 0); }
  void put_bytes(ByteView bytes) { writer_.put_bytes(bytes); }

  /// A length byte and the characters.
  template <std::size_t k_capacity>
  void put_text(const FixedText<k_capacity>& text) {
    static_assert(k_capacity <= 255);
    put(static_cast<std::uint8_t>(text.view().size()));
    for (char c : text.view())
      put(static_cast<std::uint8_t>(c));
  }

  /// The message's size, or 0 when the buffer was too short.
  [[nodiscard]] std::size_t finish() const { return writer_.ok() ? writer_.size() : 0; }

 private:
  ByteWriter writer_;
};

class WireReader {
 public:
  WireReader(MessageType type, ByteView packet) : reader_(packet) {
    require(reader_.get<std::uint8_t>() == static_cast<std::uint8_t>(type));
  }

  void require(bool condition) { in_range_ = in_range_ && condition; }

  template <class T>
  [[nodiscard]] T get() {
    return reader_.get<T>();
  }

  [[nodiscard]] ByteView get_bytes(std::size_t count) { return reader_.get_bytes(count); }
  [[nodiscard]] ByteView get_rest() { return reader_.get_bytes(reader_.remaining()); }

  [[nodiscard]] bool get_flag() {
    const auto value = reader_.get<std::uint8_t>();
    require(value <= 1);
    return value == 1;
  }

  [[nodiscard]] std::uint64_t get_tick() {
    const auto tick = reader_.get<std::uint64_t>();
    require(tick <= k_max_tick);
    return tick;
  }

  /// One byte, 0 … `last`.
  template <class E>
  [[nodiscard]] E get_enum(E last) {
    const auto value = reader_.get<std::uint8_t>();
    require(value <= static_cast<std::uint8_t>(last));
    return value <= static_cast<std::uint8_t>(last) ? static_cast<E>(value) : last;
  }

  template <std::size_t k_capacity>
  void get_text(FixedText<k_capacity>& text) {
    const auto size = reader_.get<std::uint8_t>();
    require(size <= k_capacity);
    const ByteView bytes = reader_.get_bytes(size);
    std::array<char, 255> chars{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      chars[i] = static_cast<char>(bytes[i]);
      require(chars[i] >= ' ' && chars[i] <= '~');
    }
    text = FixedText<k_capacity>({chars.data(), bytes.size()});
  }

  /// The outcome so far, whatever follows.
  [[nodiscard]] Status status() const {
    if (!reader_.ok()) return Status::truncated;
    return in_range_ ? Status::ok : Status::malformed;
  }

  /// The outcome of the whole message.
  [[nodiscard]] Status finish() {
    require(reader_.remaining() == 0);
    return status();
  }

 private:
  ByteReader reader_;
  bool in_range_ = true;
};

}  // namespace lockstone::net
