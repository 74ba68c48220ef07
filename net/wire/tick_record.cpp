#include "net/wire/tick_record.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

bool all_zero(ByteView bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace

void set_slot(std::span<std::byte> record, TickShape shape, std::size_t slot, InputOrigin origin,
              ByteView bytes) {
  LKS_CHECK(record.size() == shape.record_bytes() && bytes.size() == shape.input_bytes);
  const std::size_t shift = 2 * (slot % 4);
  std::byte& origins = record[slot / 4];
  origins &= ~(std::byte{3} << shift);
  origins |= static_cast<std::byte>(origin) << shift;
  const std::size_t at = shape.origin_bytes() + slot * shape.input_bytes;
  std::copy(bytes.begin(), bytes.end(), record.subspan(at).begin());
}

PlayerInput get_slot(ByteView record, TickShape shape, std::size_t slot) {
  const std::byte origin = (record[slot / 4] >> (2 * (slot % 4))) & std::byte{3};
  const std::size_t at = shape.origin_bytes() + slot * shape.input_bytes;
  return {record.subspan(at, shape.input_bytes), static_cast<InputOrigin>(origin)};
}

void set_command_count(std::span<std::byte> record, std::uint8_t count) {
  record.back() = std::byte{count};
}

std::uint8_t command_count(ByteView record) {
  return std::to_integer<std::uint8_t>(record.back());
}

bool valid_record(ByteView record, TickShape shape) {
  if (record.size() != shape.record_bytes()) return false;
  for (std::size_t slot = 0; slot < shape.player_count; ++slot) {
    const PlayerInput input = get_slot(record, shape, slot);
    const bool must_be_zero =
        input.origin == InputOrigin::neutral || input.origin == InputOrigin::absent;
    if (must_be_zero && !all_zero(input.bytes)) return false;
  }
  const std::size_t used = shape.player_count % 4;
  if (used == 0) return true;
  return (record[shape.origin_bytes() - 1] >> (2 * used)) == std::byte{0};
}

}  // namespace lockstone::net
