#include "net/session/command_buffer.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

const CommandBuffer::Entry& CommandBuffer::entry(std::uint64_t number) const {
  LKS_ASSERT(number >= begin_ && number < end_);
  return entries_[static_cast<std::size_t>(number % entries_.size())];
}

CommandBuffer::Entry& CommandBuffer::place(std::uint64_t number) {
  return entries_[static_cast<std::size_t>(number % entries_.size())];
}

ByteView CommandBuffer::bytes(std::uint64_t number) const {
  const Entry& found = entry(number);
  return {bytes_.get() + found.at, found.filled};
}

std::uint64_t CommandBuffer::first_of(std::uint64_t tick) const {
  std::uint64_t number = begin_;
  while (number < end_ && entry(number).tick < tick)
    ++number;
  return number;
}

// Behind the last command, or, where the ring ends too early, at its beginning; never up to the
// first command, so that a full ring is told from an empty one by the numbers alone.
bool CommandBuffer::find_room(std::size_t size, std::size_t& at) const {
  if (empty()) {
    at = 0;
    return size <= capacity_;
  }
  const std::size_t head = last().at + last().size;
  const std::size_t tail = first().at;
  const bool wrapped = last().at < tail;
  at = head;
  if (wrapped) return size <= tail - head;
  if (size <= capacity_ - head) return true;
  at = 0;
  return size <= tail;
}

bool CommandBuffer::open(std::uint64_t tick, std::uint8_t slot, std::size_t size) {
  std::size_t at = 0;
  LKS_ASSERT(size > 0 && (empty() || last().complete()));
  if (end_ - begin_ == entries_.size() || !find_room(size, at)) return false;
  place(end_++) = {tick, slot, at, size, 0};
  return true;
}

void CommandBuffer::append(ByteView piece) {
  LKS_ASSERT(!empty());
  Entry& open = place(end_ - 1);
  LKS_CHECK(piece.size() <= open.size - open.filled);
  std::copy(piece.begin(), piece.end(), bytes_.get() + open.at + open.filled);
  open.filled += piece.size();
}

bool CommandBuffer::push(std::uint64_t tick, const PlayerCommand& command) {
  if (!open(tick, command.slot, command.bytes.size())) return false;
  append(command.bytes);
  return true;
}

void CommandBuffer::pop() {
  LKS_ASSERT(!empty());
  ++begin_;
}

void CommandBuffer::drop_incomplete() {
  if (!empty() && !last().complete()) --end_;
}

void CommandBuffer::restart(std::uint64_t next) {
  begin_ = end_ = next;
}

TickCommands::TickCommands(std::size_t spare_bytes)
    : ring_(k_ring_bytes + spare_bytes, k_ring_commands) {
  found_.reserve(k_max_tick_commands);
}

std::span<const PlayerCommand> TickCommands::of(std::uint64_t tick) const {
  found_.clear();
  for (std::uint64_t number = ring_.first_of(tick); number < ring_.end(); ++number) {
    const CommandBuffer::Entry& entry = ring_.entry(number);
    if (entry.tick != tick || !entry.complete()) break;
    found_.push_back({entry.slot, ring_.bytes(number)});
  }
  return found_;
}

bool TickCommands::has(std::uint64_t tick, std::size_t count) const {
  return count == 0 || of(tick).size() >= count;
}

void TickCommands::forget_before(std::uint64_t tick) {
  while (!ring_.empty() && ring_.first().tick < tick && ring_.first().complete())
    ring_.pop();
}

}  // namespace lockstone::net
