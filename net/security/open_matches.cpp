#include <algorithm>
#include <mutex>

#include <lockstone/assert.h>
#include <lockstone/net/open_matches.h>
#include <lockstone/net/token.h>

#include "net/security/crypto.h"

namespace lockstone::net {

OpenMatches::OpenMatches(const Key& backend_key, std::size_t capacity)
    : backend_key_(backend_key), capacity_(std::min(capacity, k_max_open_matches)) {
  LKS_ASSERT(capacity >= 1 && capacity <= k_max_open_matches);
  entries_.reserve(capacity_);
}

OpenMatches::~OpenMatches() {
  crypto::wipe(backend_key_.bytes);
}

Status OpenMatches::add(std::uint64_t match) {
  if (!security_available()) return Status::incompatible;
  const Entry entry{match, make_match_tag(match), make_link_key(backend_key_, match)};
  const std::lock_guard lock(mutex_);
  const bool taken = std::any_of(entries_.begin(), entries_.end(), [&entry](const Entry& other) {
    return other.match == entry.match || other.tag == entry.tag;
  });
  if (taken) return Status::invalid_argument;
  if (entries_.size() == capacity_) return Status::capacity_exhausted;
  entries_.push_back(entry);
  return Status::ok;
}

void OpenMatches::remove(std::uint64_t match) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [match](const Entry& entry) { return entry.match == match; });
}

bool OpenMatches::contains(std::uint64_t match) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(entries_.begin(), entries_.end(),
                     [match](const Entry& entry) { return entry.match == match; });
}

std::optional<LinkKey> OpenMatches::link_key_of(std::uint32_t tag) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [tag](const Entry& entry) { return entry.tag == tag; });
  if (found == entries_.end()) return std::nullopt;
  return found->link_key;
}

}  // namespace lockstone::net
