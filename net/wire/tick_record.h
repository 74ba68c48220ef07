// One confirmed tick as bytes: two bits of InputOrigin a slot (slot n in byte n / 4, bits 2(n % 4)
// and up), the slots' inputs, and the number of the tick's commands, which come apart. Also what a
// tick's hash and log are made of.
#pragma once

#include <array>
#include <span>

#include <lockstone/net/wire.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

/// Writes a slot's part. `bytes` has shape.input_bytes bytes.
void set_slot(std::span<std::byte> record, TickShape shape, std::size_t slot, InputOrigin origin,
              ByteView bytes);

/// Reads a slot's part of a valid record; the bytes point into it.
[[nodiscard]] PlayerInput get_slot(ByteView record, TickShape shape, std::size_t slot);

/// The number of the tick's commands.
void set_command_count(std::span<std::byte> record, std::uint8_t count);
[[nodiscard]] std::uint8_t command_count(ByteView record);

/// Whether a record from outside is one that a server may have built: no stray bits, and zero
/// bytes where the origin says so.
[[nodiscard]] bool valid_record(ByteView record, TickShape shape);

/// All slots of a record, in order, as Simulation::step wants them.
class RecordInputs {
 public:
  RecordInputs(ByteView record, TickShape shape) : count_(shape.player_count) {
    for (std::size_t slot = 0; slot < count_; ++slot)
      inputs_[slot] = get_slot(record, shape, slot);
  }
  [[nodiscard]] std::span<const PlayerInput> view() const {
    return std::span(inputs_).first(count_);
  }

 private:
  std::array<PlayerInput, k_max_players> inputs_{};
  std::size_t count_;
};

}  // namespace lockstone::net
