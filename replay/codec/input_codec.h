// The inputs of consecutive ticks, each coded against the tick before it.
// docs/reference/replay-format.md, "INPUT". A chunk is independent of the others: its first tick is
// coded against silence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/simulation.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// One player's input of one tick, held by value. The default is silence.
struct SlotState {
  std::array<std::byte, k_max_input_bytes> bytes{};
  InputOrigin origin = InputOrigin::received;
};

/// The largest number of equal ticks that one run byte stands for; it means "and no change
/// follows".
inline constexpr std::uint8_t k_run_full = 255;

class InputEncoder {
 public:
  /// Upper bound on the payload of `ticks` ticks.
  [[nodiscard]] static std::size_t bytes_max(std::size_t ticks, std::size_t players,
                                             std::size_t input_bytes);

  /// Begins a chunk. `out` has bytes_max() bytes for all ticks that will be added.
  void start(std::span<std::byte> out, std::size_t input_bytes);

  /// Appends a tick; each entry has `input_bytes` bytes. Never allocates.
  void add(std::span<const PlayerInput> inputs);

  /// Ends the chunk and returns its payload's size.
  [[nodiscard]] std::size_t finish();

 private:
  void put_slot(SlotState& slot, const PlayerInput& input);

  ByteWriter writer_{std::span<std::byte>{}};
  std::array<SlotState, k_max_players> last_;
  std::size_t input_bytes_ = 0;
  std::uint8_t run_ = 0;
};

/// Decoded ticks. Grows to the largest chunk seen and is used again for the next.
class InputBlock {
 public:
  [[nodiscard]] std::size_t ticks() const { return ticks_; }

  /// The inputs of the tick at `index` of the chunk, in slot order.
  [[nodiscard]] std::span<const PlayerInput> tick(std::size_t index) const {
    return std::span(inputs_).subspan(index * players_, players_);
  }

  /// Replaces the content. `ticks` is at most k_max_chunk_ticks, which bounds the memory.
  [[nodiscard]] DecodeFault decode(ByteView payload, std::size_t ticks, std::size_t players,
                                   std::size_t input_bytes);

 private:
  void append(std::span<const SlotState> slots);

  std::vector<std::byte> bytes_;
  std::vector<PlayerInput> inputs_;
  std::size_t ticks_ = 0;
  std::size_t players_ = 0;
  std::size_t input_bytes_ = 0;
};

}  // namespace lockstone::replay
