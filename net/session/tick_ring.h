// The last records of a stream that has one record a tick: preallocated, oldest overwritten.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/bytes.h>

namespace lockstone::net {

/// Records of up to `record_bytes` bytes each; record `tick` is in place tick % capacity.
class TickRing {
 public:
  TickRing() = default;
  /// A capacity of 0 keeps nothing.
  TickRing(std::size_t capacity, std::size_t record_bytes);

  /// False for a capacity of 0.
  [[nodiscard]] bool keeps_records() const { return !entries_.empty(); }

  /// The place for `tick`'s record, of record_bytes bytes; the old record is dropped.
  [[nodiscard]] std::span<std::byte> claim(std::uint64_t tick);

  /// Ends a claim: the record has `size` bytes.
  void commit(std::uint64_t tick, std::size_t size);

  void put(std::uint64_t tick, ByteView record);
  void clear();

  [[nodiscard]] bool has(std::uint64_t tick) const;

  /// The record, or an empty view if it is not kept (any more).
  [[nodiscard]] ByteView find(std::uint64_t tick) const;

 private:
  struct Entry {
    std::uint64_t tick = ~std::uint64_t{0};
    std::size_t size = 0;
  };
  std::size_t record_bytes_ = 0;
  std::vector<Entry> entries_;
  std::unique_ptr<std::byte[]> bytes_;  ///< not initialised: unused pages cost no memory
};

/// The last hashes of a stream, contiguous from tick 0 or a later one.
class HashRing {
 public:
  HashRing() = default;
  explicit HashRing(std::size_t capacity) : hashes_(capacity) {}

  [[nodiscard]] std::uint64_t next_tick() const { return next_tick_; }
  /// Forgets all; `tick` is the next one.
  void restart(std::uint64_t tick) { next_tick_ = tick; }
  void push(std::uint64_t hash) { hashes_[next_tick_++ % hashes_.size()] = hash; }
  /// `tick` is one of the last `capacity` pushed ones.
  [[nodiscard]] std::uint64_t at(std::uint64_t tick) const {
    return hashes_[tick % hashes_.size()];
  }

 private:
  std::vector<std::uint64_t> hashes_;
  std::uint64_t next_tick_ = 0;
};

}  // namespace lockstone::net
