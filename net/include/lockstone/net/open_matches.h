// The matches that one server process hosts at present, for sockets that all of them share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include <lockstone/net/keys.h>
#include <lockstone/status.h>

namespace lockstone::net {

inline constexpr std::size_t k_max_open_matches = 4096;

/// A list of matches with their link keys. Any thread may call it. Allocates when made only.
class OpenMatches {
 public:
  /// `capacity` matches at once, 1 … k_max_open_matches. `backend_key` seals the tokens.
  OpenMatches(const Key& backend_key, std::size_t capacity);
  ~OpenMatches();
  OpenMatches(const OpenMatches&) = delete;
  OpenMatches& operator=(const OpenMatches&) = delete;

  /// invalid_argument: it is open, or another open match has the same tag (make_match_tag), which
  /// happens to two matches in 2^32; capacity_exhausted; incompatible: not security_available.
  [[nodiscard]] Status add(std::uint64_t match);
  void remove(std::uint64_t match);

  [[nodiscard]] bool contains(std::uint64_t match) const;

  /// The link key of the open match with this tag.
  [[nodiscard]] std::optional<LinkKey> link_key_of(std::uint32_t tag) const;

 private:
  struct Entry {
    std::uint64_t match = 0;
    std::uint32_t tag = 0;
    LinkKey link_key;
  };

  Key backend_key_;
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace lockstone::net
