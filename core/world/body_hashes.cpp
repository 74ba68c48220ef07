#include "core/world/body_hashes.h"

#include "core/world/record_hash.h"

namespace lockstone {

BodyHashes::BodyHashes(std::uint32_t body_capacity)
    : hashes_(body_capacity), is_stale_(body_capacity) {
  stale_.reserve(body_capacity);
}

void BodyHashes::clear() {
  for (const std::uint32_t body : stale_)
    is_stale_[body] = 0;
  stale_.clear();
  known_ = 0;
  sum_ = 0;
}

std::uint64_t BodyHashes::sum(std::span<const BodyRecord> records) {
  LKS_ASSERT(known_ <= records.size());
  for (; known_ < records.size(); ++known_) {
    hashes_[known_] = 0;
    mark(known_);
  }
  for (const std::uint32_t body : stale_) {
    const std::uint64_t hash = hash_record(records[body], (k_body_domain << 32) + body);
    sum_ += hash - hashes_[body];
    hashes_[body] = hash;
    is_stale_[body] = 0;
  }
  hashed_ += stale_.size();
  stale_.clear();
  return sum_;
}

}  // namespace lockstone
