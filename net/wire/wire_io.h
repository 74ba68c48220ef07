// Reading and writing of one message: its type first, ranges checked, nothing left over.
//
// Both classes have the same functions, so that one list of fields (wire_fields.h) serves both. The
// reader checks ranges; the writer takes a message as it is, but for blocks that are too long.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>

#include <lockstone/bytes.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

class WireWriter {
 public:
  WireWriter(MessageType type, std::span<std::byte> out) : writer_(out) { writer_.put(type); }

  template <class T>
  void constant(T value) {
    writer_.put(value);
  }
  template <class T>
  void value(T value) {
    if constexpr (std::is_same_v<T, bool>)
      writer_.put<std::uint8_t>(value ? 1 : 0);
    else
      writer_.put(value);
  }
  void tick(std::uint64_t tick) { writer_.put(tick); }
  template <class E>
  void choice(E value, E) {
    writer_.put(value);
  }

  /// A length byte and the characters.
  template <std::size_t k_capacity>
  void text(const FixedText<k_capacity>& text) {
    static_assert(k_capacity <= 255);
    writer_.put(static_cast<std::uint8_t>(text.view().size()));
    for (char c : text.view())
      writer_.put(static_cast<std::uint8_t>(c));
  }

  void text(const PlayerName& name) {
    writer_.put(static_cast<std::uint8_t>(name.view().size()));
    writer_.put_bytes(std::as_bytes(std::span(name.view())));
  }

  /// Two bytes of length, and the bytes.
  void block(ByteView bytes, std::size_t most_bytes) {
    fits_ = fits_ && bytes.size() <= most_bytes;
    writer_.put(static_cast<std::uint16_t>(bytes.size()));
    writer_.put_bytes(bytes);
  }
  void rest(ByteView bytes) { writer_.put_bytes(bytes); }

  /// The first `count` items, each by `visit(item)`.
  template <class Items, class Visit>
  void items(const Items& items, std::size_t count, Visit&& visit) {
    fits_ = fits_ && count <= items.size();
    for (std::size_t i = 0; i < std::min(count, items.size()); ++i)
      visit(items[i]);
  }

  void require(bool) {}
  /// Whether the message goes on.
  [[nodiscard]] bool goes_on(bool) { return true; }

  /// The message's size, or 0 when it did not fit.
  [[nodiscard]] std::size_t finish() const { return fits_ && writer_.ok() ? writer_.size() : 0; }

 private:
  ByteWriter writer_;
  bool fits_ = true;
};

class WireReader {
 public:
  WireReader(MessageType type, ByteView packet) : reader_(packet) { constant(type); }

  void require(bool condition) { in_range_ = in_range_ && condition; }

  /// The message ends here without an error if it does not go on.
  [[nodiscard]] bool goes_on(bool condition) {
    ends_early_ = ends_early_ || !condition;
    return condition;
  }

  template <class T>
  void constant(T value) {
    T found{};
    this->value(found);
    require(found == value);
  }

  template <class T>
  void value(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      const auto byte = reader_.get<std::uint8_t>();
      require(byte <= 1);
      value = byte == 1;
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(reader_.get<std::underlying_type_t<T>>());
    } else {
      value = reader_.get<T>();
    }
  }

  void tick(std::uint64_t& tick) {
    value(tick);
    require(tick <= k_max_tick);
  }

  /// One byte, 0 … `last`.
  template <class E>
  void choice(E& value, E last) {
    const auto byte = reader_.get<std::uint8_t>();
    require(byte <= static_cast<std::uint8_t>(last));
    value = byte <= static_cast<std::uint8_t>(last) ? static_cast<E>(byte) : last;
  }

  template <std::size_t k_capacity>
  void text(FixedText<k_capacity>& text) {
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

  void text(PlayerName& name) {
    const auto size = reader_.get<std::uint8_t>();
    const Result<PlayerName> read = PlayerName::from_bytes(reader_.get_bytes(size));
    require(read.ok());
    if (read) name = read.value();
  }

  void block(ByteView& bytes, std::size_t most_bytes) {
    const auto size = reader_.get<std::uint16_t>();
    require(size <= most_bytes);
    bytes = reader_.get_bytes(size);
  }
  void rest(ByteView& bytes) { bytes = reader_.get_bytes(reader_.remaining()); }

  template <class Items, class Visit>
  void items(Items& items, std::size_t count, Visit&& visit) {
    require(count <= items.size());
    for (std::size_t i = 0; i < std::min(count, items.size()); ++i)
      visit(items[i]);
  }

  /// The outcome of the whole message.
  [[nodiscard]] Status finish() {
    require(ends_early_ || reader_.remaining() == 0);
    if (!reader_.ok()) return Status::truncated;
    return in_range_ ? Status::ok : Status::malformed;
  }

 private:
  ByteReader reader_;
  bool in_range_ = true;
  bool ends_early_ = false;
};

}  // namespace lockstone::net
