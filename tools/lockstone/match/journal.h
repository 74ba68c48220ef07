// The lines that a hosted match prints: text for people, or JSON, one object a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lockstone::tool {

struct JournalEntry {
  std::string_view event;  ///< "player_joined", …: stays the same over versions
  std::string text;        ///< for people
  std::optional<std::uint8_t> slot = {};
  std::optional<std::uint64_t> tick = {};
};

/// `{"time": "2026-11-25T12:00:00.123Z", "level": "info", "event": …, "match": 7777, "text": …}`
[[nodiscard]] std::string journal_line(const JournalEntry& entry, std::uint64_t match,
                                       std::int64_t unix_ms);

class Journal {
 public:
  explicit Journal(bool json = false, std::uint64_t match = 0) : json_(json), match_(match) {}

  /// Prints the line at once.
  void write(const JournalEntry& entry) const;

 private:
  bool json_;
  std::uint64_t match_;  ///< its port, or, of one in a room, the number of its tokens
};

}  // namespace lockstone::tool
