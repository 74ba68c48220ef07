// The hash of all bodies, of which only the changed ones are hashed again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body_record.h"

namespace lockstone {

/// Derived: a sum over the hashes of the records, each seeded with its index. What it answers
/// follows from the records alone, provided that each change was marked.
class BodyHashes {
 public:
  /// No function but this allocates.
  explicit BodyHashes(std::uint32_t body_capacity);

  /// Forgets everything: the next sum hashes all.
  void clear();

  /// The record changes, or did.
  void mark(std::uint32_t body) {
    if (is_stale_[body] != 0) return;
    is_stale_[body] = 1;
    stale_.push_back(body);
  }

  /// Hashes what was marked. There are never fewer records than before, but for `clear`.
  [[nodiscard]] std::uint64_t sum(std::span<const BodyRecord> records);

  /// Records that were hashed since the world began, for tests and measurements.
  [[nodiscard]] std::uint64_t hashed() const { return hashed_; }

 private:
  std::vector<std::uint64_t> hashes_;   // by body, of the first known_
  std::vector<std::uint8_t> is_stale_;  // by body
  std::vector<std::uint32_t> stale_;
  std::uint32_t known_ = 0;
  std::uint64_t sum_ = 0;
  std::uint64_t hashed_ = 0;
};

}  // namespace lockstone
