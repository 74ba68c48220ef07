// One player's input of one tick: eight bytes, any values are accepted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/bytes.h>

namespace lockstone::arena {

inline constexpr std::size_t k_input_bytes = 8;

enum Button : std::uint8_t {
  k_jump = 1,
  k_push = 2,
  k_grab = 4,   ///< held: grab the object in front and carry it; let go: throw it
  k_shoot = 8,  ///< throw a snowball
  k_ride = 16,  ///< get into the buggy, or out of it
};

struct Input {
  std::int8_t move_x = 0;    ///< −127 … 127 along +x
  std::int8_t move_z = 0;    ///< along +z; a longer stick than 127 counts as 127
  std::int16_t yaw = 0;      ///< where the player aims, 1/65536 turns from +x towards +z
  std::uint8_t buttons = 0;  ///< set of Button; other bits mean nothing
  std::uint8_t reserved = 0;
  std::uint16_t sequence = 0;  ///< counts the player's inputs; the game ignores it

  void encode(std::span<std::byte> out) const {
    ByteWriter writer(out);
    writer.put(move_x);
    writer.put(move_z);
    writer.put(yaw);
    writer.put(buttons);
    writer.put(reserved);
    writer.put(sequence);
  }

  [[nodiscard]] static Input decode(ByteView bytes) {
    ByteReader reader(bytes);
    Input input;
    input.move_x = reader.get<std::int8_t>();
    input.move_z = reader.get<std::int8_t>();
    input.yaw = reader.get<std::int16_t>();
    input.buttons = reader.get<std::uint8_t>();
    input.reserved = reader.get<std::uint8_t>();
    input.sequence = reader.get<std::uint16_t>();
    return input;
  }
};

}  // namespace lockstone::arena
