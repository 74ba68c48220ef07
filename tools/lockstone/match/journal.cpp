#include "tools/lockstone/match/journal.h"

#include <chrono>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lockstone::tool {
namespace {

std::string_view level_of(std::string_view event) {
  if (event == "desync") return "error";
  return event == "player_refused" || event == "player_silent" ? "warning" : "info";
}

std::string time_text(std::int64_t unix_ms) {
  const auto seconds = static_cast<std::time_t>(unix_ms / 1000);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", parts.tm_year + 1900,
                     parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec,
                     unix_ms % 1000);
}

}  // namespace

std::string journal_line(const JournalEntry& entry, std::uint64_t match, std::int64_t unix_ms) {
  nlohmann::ordered_json json{{"time", time_text(unix_ms)},
                              {"level", level_of(entry.event)},
                              {"event", entry.event},
                              {"match", match}};
  if (entry.slot) json["player"] = *entry.slot;
  if (entry.tick) json["tick"] = *entry.tick;
  json["text"] = entry.text;
  // A player's name may hold any bytes.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void Journal::write(const JournalEntry& entry) const {
  if (!json_) {
    fmt::print("{}\n", entry.text);
  } else {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto unix_ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
    fmt::print("{}\n", journal_line(entry, match_, unix_ms));
  }
  std::fflush(stdout);
}

}  // namespace lockstone::tool
