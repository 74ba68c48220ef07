// The hash of all records of a store, of which only the changed ones are hashed again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/state/record_hash.h"

namespace lockstone {

/// Derived: a sum over the hashes of the records, each seeded with its index. The sum follows from
/// the records alone, provided that each change was marked.
template <class Record, std::uint64_t Domain>
class RecordHashes {
 public:
  /// No function but this allocates.
  explicit RecordHashes(std::uint32_t capacity) : hashes_(capacity), is_stale_(capacity) {
    stale_.reserve(capacity);
  }

  /// Forgets everything: the next sum hashes all.
  void clear() {
    for (const std::uint32_t index : stale_)
      is_stale_[index] = 0;
    stale_.clear();
    known_ = 0;
    sum_ = 0;
  }

  /// The record changes, or did.
  void mark(std::uint32_t index) {
    if (is_stale_[index] != 0) return;
    is_stale_[index] = 1;
    stale_.push_back(index);
  }

  /// Hashes the marked records. There are never fewer records than before, but for `clear`.
  [[nodiscard]] std::uint64_t sum(std::span<const Record> records) {
    LKS_ASSERT(known_ <= records.size());
    for (; known_ < records.size(); ++known_) {
      hashes_[known_] = 0;
      mark(known_);
    }
    for (const std::uint32_t index : stale_) {
      const std::uint64_t hash = hash_record(records[index], (Domain << 32) + index);
      sum_ += hash - hashes_[index];
      hashes_[index] = hash;
      is_stale_[index] = 0;
    }
    hashed_ = static_cast<std::uint32_t>(stale_.size());
    stale_.clear();
    return sum_;
  }

  /// Records that the last sum hashed.
  [[nodiscard]] std::uint32_t hashed() const { return hashed_; }

 private:
  std::vector<std::uint64_t> hashes_;   // by index, of the first known_
  std::vector<std::uint8_t> is_stale_;  // by index
  std::vector<std::uint32_t> stale_;
  std::uint32_t known_ = 0;
  std::uint64_t sum_ = 0;
  std::uint32_t hashed_ = 0;
};

}  // namespace lockstone
