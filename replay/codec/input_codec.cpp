#include "replay/codec/input_codec.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::replay {
namespace {

constexpr std::uint8_t k_origin_bits = 3;
constexpr std::uint8_t k_bytes_changed = 4;

std::size_t mask_bytes(std::size_t bits) {
  return (bits + 7) / 8;
}

std::uint64_t get_mask(ByteReader& reader, std::size_t bits) {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < mask_bytes(bits); ++i) {
    mask |= std::uint64_t{reader.get<std::uint8_t>()} << (8 * i);
  }
  return mask;
}

void put_mask(ByteWriter& writer, std::uint64_t mask, std::size_t bits) {
  for (std::size_t i = 0; i < mask_bytes(bits); ++i) {
    writer.put(static_cast<std::uint8_t>((mask >> (8 * i)) & 0xff));
  }
}

bool has_bit_beyond(std::uint64_t mask, std::size_t bits) {
  return bits < 64 && (mask >> bits) != 0;
}

std::uint64_t changed_bytes(const SlotState& slot, ByteView bytes) {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (slot.bytes[i] != bytes[i]) mask |= std::uint64_t{1} << i;
  }
  return mask;
}

DecodeFault decode_bytes(ByteReader& reader, SlotState& slot, std::size_t input_bytes) {
  const std::size_t start = reader.position();
  const std::uint64_t mask = get_mask(reader, input_bytes);
  if (!reader.ok()) return malformed(start, "inputs end early");
  if (mask == 0 || has_bit_beyond(mask, input_bytes)) return malformed(start, "bad byte mask");
  for (std::size_t i = 0; i < input_bytes; ++i) {
    if (((mask >> i) & 1) == 0) continue;
    const std::size_t position = reader.position();
    const auto change = static_cast<std::byte>(reader.get<std::uint8_t>());
    if (!reader.ok()) return malformed(position, "inputs end early");
    if (change == std::byte{0}) return malformed(position, "a changed byte that does not change");
    slot.bytes[i] ^= change;
  }
  return {};
}

DecodeFault decode_slot(ByteReader& reader, SlotState& slot, std::size_t input_bytes) {
  const std::size_t start = reader.position();
  const auto head = reader.get<std::uint8_t>();
  if (!reader.ok()) return malformed(start, "inputs end early");
  if ((head & ~(k_origin_bits | k_bytes_changed)) != 0) return malformed(start, "bad slot head");
  const auto origin = static_cast<InputOrigin>(head & k_origin_bits);
  const bool bytes_changed = (head & k_bytes_changed) != 0;
  if (!bytes_changed && origin == slot.origin) {
    return malformed(start, "a changed slot that does not change");
  }
  slot.origin = origin;
  return bytes_changed ? decode_bytes(reader, slot, input_bytes) : DecodeFault{};
}

DecodeFault decode_change(ByteReader& reader, std::span<SlotState> slots, std::size_t input_bytes) {
  const std::size_t start = reader.position();
  const std::uint64_t mask = get_mask(reader, slots.size());
  if (!reader.ok()) return malformed(start, "inputs end early");
  if (mask == 0 || has_bit_beyond(mask, slots.size())) return malformed(start, "bad slot mask");
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (((mask >> i) & 1) == 0) continue;
    const DecodeFault fault = decode_slot(reader, slots[i], input_bytes);
    if (!fault.ok()) return fault;
  }
  return {};
}

}  // namespace

std::size_t InputEncoder::bytes_max(std::size_t ticks, std::size_t players,
                                    std::size_t input_bytes) {
  const std::size_t slot_bytes = 1 + mask_bytes(input_bytes) + input_bytes;
  return ticks * (1 + mask_bytes(players) + players * slot_bytes);
}

void InputEncoder::start(std::span<std::byte> out, std::size_t input_bytes) {
  writer_ = ByteWriter(out);
  last_.fill(SlotState{});
  input_bytes_ = input_bytes;
  run_ = 0;
}

void InputEncoder::add(std::span<const PlayerInput> inputs) {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const bool same =
        inputs[i].origin == last_[i].origin &&
        std::equal(inputs[i].bytes.begin(), inputs[i].bytes.end(), last_[i].bytes.begin());
    if (!same) mask |= std::uint64_t{1} << i;
  }
  if (mask == 0) {
    if (++run_ == k_run_full) {
      writer_.put(run_);
      run_ = 0;
    }
    return;
  }
  writer_.put(run_);
  run_ = 0;
  put_mask(writer_, mask, inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (((mask >> i) & 1) != 0) put_slot(last_[i], inputs[i]);
  }
}

void InputEncoder::put_slot(SlotState& slot, const PlayerInput& input) {
  const std::uint64_t mask = changed_bytes(slot, input.bytes);
  const auto origin = static_cast<std::uint8_t>(input.origin);
  writer_.put(static_cast<std::uint8_t>(origin | (mask != 0 ? k_bytes_changed : 0)));
  slot.origin = input.origin;
  if (mask == 0) return;
  put_mask(writer_, mask, input_bytes_);
  for (std::size_t i = 0; i < input.bytes.size(); ++i) {
    if (((mask >> i) & 1) != 0) writer_.put(slot.bytes[i] ^ input.bytes[i]);
    slot.bytes[i] = input.bytes[i];
  }
}

std::size_t InputEncoder::finish() {
  if (run_ != 0) writer_.put(run_);
  run_ = 0;
  LKS_CHECK(writer_.ok());
  return writer_.size();
}

DecodeFault InputBlock::decode(ByteView payload, std::size_t ticks, std::size_t players,
                               std::size_t input_bytes) {
  ticks_ = 0;
  players_ = players;
  input_bytes_ = input_bytes;
  bytes_.resize(ticks * players * input_bytes);
  inputs_.resize(ticks * players);
  std::array<SlotState, k_max_players> states;
  const std::span<SlotState> slots = std::span(states).first(players);
  ByteReader reader(payload);
  while (ticks_ < ticks) {
    const std::size_t position = reader.position();
    const auto run = reader.get<std::uint8_t>();
    if (!reader.ok()) return malformed(position, "inputs end early");
    if (run > ticks - ticks_) return malformed(position, "a run beyond the last tick");
    for (std::size_t i = 0; i < run; ++i)
      append(slots);
    if (run == k_run_full || ticks_ == ticks) continue;
    const DecodeFault fault = decode_change(reader, slots, input_bytes);
    if (!fault.ok()) return fault;
    append(slots);
  }
  if (reader.remaining() != 0) return malformed(reader.position(), "bytes after the last tick");
  return {};
}

void InputBlock::append(std::span<const SlotState> slots) {
  for (std::size_t i = 0; i < players_; ++i) {
    const std::size_t index = ticks_ * players_ + i;
    const std::span<std::byte> out = std::span(bytes_).subspan(index * input_bytes_, input_bytes_);
    std::copy_n(slots[i].bytes.begin(), input_bytes_, out.begin());
    inputs_[index] = {out, slots[i].origin};
  }
  ++ticks_;
}

}  // namespace lockstone::replay
