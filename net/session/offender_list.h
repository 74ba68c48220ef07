// Players found wrong in this match: who was sent away stays out, and nobody is corrected twice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net {

/// With a token a player is known by its account, or, where the backend gives no accounts (0), by
/// account and seat. Without one nothing but the seat is known. Allocates when made only.
class OffenderList {
 public:
  static constexpr std::size_t k_capacity = 256;

  OffenderList() { entries_.reserve(k_capacity); }

  [[nodiscard]] bool is_banned(const PeerIdentity& who, std::uint8_t slot) const {
    const Entry* entry = find(key_of(who, slot));
    return entry != nullptr && entry->banned;
  }
  [[nodiscard]] bool was_resynced(const PeerIdentity& who, std::uint8_t slot) const {
    const Entry* entry = find(key_of(who, slot));
    return entry != nullptr && entry->resynced;
  }
  void ban(const PeerIdentity& who, std::uint8_t slot) { entry_of(who, slot).banned = true; }
  void note_resync(const PeerIdentity& who, std::uint8_t slot) {
    entry_of(who, slot).resynced = true;
  }

 private:
  struct Key {
    bool authenticated = false;
    std::uint64_t player = 0;
    std::uint8_t slot = 0;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Entry {
    Key key;
    bool banned = false;
    bool resynced = false;
  };

  static Key key_of(const PeerIdentity& who, std::uint8_t slot) {
    const bool by_account = who.authenticated && who.player != 0;
    return {who.authenticated, who.player, by_account ? std::uint8_t{0} : slot};
  }
  [[nodiscard]] const Entry* find(const Key& key) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&key](const Entry& entry) { return entry.key == key; });
    return found == entries_.end() ? nullptr : &*found;
  }
  // A full list forgets its oldest entry.
  Entry& entry_of(const PeerIdentity& who, std::uint8_t slot) {
    const Key key = key_of(who, slot);
    for (Entry& entry : entries_) {
      if (entry.key == key) return entry;
    }
    if (entries_.size() < k_capacity) return entries_.emplace_back(Entry{key});
    return entries_[oldest_++ % k_capacity] = Entry{key};
  }

  std::vector<Entry> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace lockstone::net
