// Events of sessions, kept from one update to the next.
#pragma once

#include <string>
#include <vector>

#include <lockstone/net/session.h>

#include "tools/bindings/c/game_handles.h"

namespace lockstone::c {

/// Before it counted islands.
template <>
inline constexpr std::size_t k_first_size<lks_session_stats> = 120;

class SessionEvents {
 public:
  SessionEvents() { events_.reserve(256); }

  void clear() {
    events_.clear();
    texts_.clear();
  }

  /// Keeps the event, and the text for people where there is one.
  void add(lks_session_event event, std::string text = {});

  void give(lks_session_event* out, std::size_t capacity, std::size_t* count) const;
  void give_text(std::size_t index, char* out, std::size_t capacity) const;
  void give_command(std::size_t index, void* out, std::size_t capacity, std::size_t* count) const;

  /// Keeps the commands of a tick.
  void add_commands(std::uint64_t tick, std::span<const PlayerCommand> commands);

 private:
  [[nodiscard]] std::string_view text_of(std::size_t index) const;

  struct Text {
    std::size_t index;
    std::string text;
  };
  std::vector<lks_session_event> events_;
  std::vector<Text> texts_;
};

/// Marks a session while its `update` runs: callbacks must not call it.
class Updating {
 public:
  explicit Updating(bool& mark) : mark_(mark) { mark_ = true; }
  ~Updating() { mark_ = false; }
  Updating(const Updating&) = delete;
  Updating& operator=(const Updating&) = delete;

 private:
  bool& mark_;
};

/// An event of this kind; all else zero.
[[nodiscard]] inline lks_session_event event_of(std::uint32_t kind) {
  lks_session_event event{};
  event.kind = kind;
  return event;
}

/// A desync as an event; its text is the report's line.
[[nodiscard]] lks_session_event event_of(const net::DesyncReport& report);

/// The figures that servers keep of a player and clients of themselves; all else zero.
template <class Stats>
[[nodiscard]] lks_session_stats traffic_of(const Stats& stats) {
  lks_session_stats raw{};
  raw.size = sizeof raw;
  raw.margin_quarters = stats.margin_quarters;
  raw.bytes_sent = stats.bytes_sent;
  raw.bytes_received = stats.bytes_received;
  raw.packets_sent = stats.packets_sent;
  raw.packets_received = stats.packets_received;
  raw.round_trip_us = stats.round_trip_us;
  raw.substituted_inputs = stats.substituted_inputs;
  raw.malformed_packets = stats.malformed_packets;
  return raw;
}

/// A time-out of a session; throws unless it is above 0.
[[nodiscard]] std::int64_t timeout_of(std::int64_t value_us, std::string_view field);

}  // namespace lockstone::c
