#include "net/session/tick_ring.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {

TickRing::TickRing(std::size_t capacity, std::size_t record_bytes)
    : record_bytes_(record_bytes),
      entries_(capacity),
      bytes_(new std::byte[capacity * record_bytes]) {}

std::span<std::byte> TickRing::claim(std::uint64_t tick) {
  LKS_CHECK(!entries_.empty());
  const auto place = static_cast<std::size_t>(tick % entries_.size());
  entries_[place] = {};
  return {bytes_.get() + place * record_bytes_, record_bytes_};
}

void TickRing::commit(std::uint64_t tick, std::size_t size) {
  LKS_CHECK(size <= record_bytes_);
  entries_[static_cast<std::size_t>(tick % entries_.size())] = {tick, size};
}

void TickRing::put(std::uint64_t tick, ByteView record) {
  const std::span<std::byte> place = claim(tick);
  LKS_CHECK(record.size() <= place.size());
  std::copy(record.begin(), record.end(), place.begin());
  commit(tick, record.size());
}

void TickRing::clear() {
  std::fill(entries_.begin(), entries_.end(), Entry{});
}

bool TickRing::has(std::uint64_t tick) const {
  if (entries_.empty()) return false;
  return entries_[static_cast<std::size_t>(tick % entries_.size())].tick == tick;
}

ByteView TickRing::find(std::uint64_t tick) const {
  if (!has(tick)) return {};
  const auto place = static_cast<std::size_t>(tick % entries_.size());
  return {bytes_.get() + place * record_bytes_, entries_[place].size};
}

}  // namespace lockstone::net
