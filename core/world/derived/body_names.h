// Names that a game gives its bodies, for people: a side table that is neither state nor derived
// from it, so that no snapshot and no hash holds it and no step reads it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <lockstone/body.h>

namespace lockstone {

/// One slot for each body slot, with the generation that it names. A slot keeps its name until
/// another is set, so that a body that a rollback brings back has its own again.
class BodyNames {
 public:
  explicit BodyNames(std::size_t body_capacity) : slots_(body_capacity) {}

  void set(BodyHandle body, std::string_view name) {
    Slot slot{body.generation, {}};  // `name` may point into the old one
    std::size_t size = std::min(name.size(), k_max_body_name);
    const auto continues = [&](std::size_t at) { return (name[at] & 0xc0) == 0x80; };  // UTF-8
    while (size > 0 && size < name.size() && continues(size))
      --size;
    std::ranges::transform(name.substr(0, size), slot.text.begin(), printable);
    slots_[body.index] = slot;
  }

  /// Of a new body, which has none: another timeline may have named one of its handle.
  void forget(BodyHandle body) {
    if (slots_[body.index].generation == body.generation) slots_[body.index] = {};
  }

  /// Empty for none. Valid until `set` or `forget` of the slot.
  [[nodiscard]] std::string_view of(BodyHandle body) const {
    if (body.index >= slots_.size()) return {};
    const Slot& slot = slots_[body.index];
    if (slot.generation != body.generation) return {};
    const auto end = std::ranges::find(slot.text, '\0');
    return {slot.text.data(), static_cast<std::size_t>(end - slot.text.begin())};
  }

 private:
  struct Slot {
    std::uint32_t generation = 0;
    std::array<char, k_max_body_name> text{};  // padded with zeros
  };

  // A name stands in quotes in a line of a log, and may come from a player.
  [[nodiscard]] static char printable(char c) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    return is_control || c == '"' ? '?' : c;
  }

  std::vector<Slot> slots_;
};

}  // namespace lockstone
