// The counters of a match as text for people, as JSON and for Prometheus.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/net/match_router.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>
#include <lockstone/net/transport_websocket.h>

#include "tools/lockstone/match/metrics_port.h"

namespace lockstone::tool {

struct MatchMetrics {
  std::uint16_t port = 0;                  ///< of the match
  std::optional<std::uint64_t> room = {};  ///< one of many on a socket: the number of its tokens
  std::string_view state = {};             ///< of the server
  bool ready = true;                       ///< players may come
  std::uint64_t ticks = 0;
  std::size_t spectators = 0;
  net::SlotMask present_mask = 0;
  std::uint64_t desyncs = 0;
  std::vector<net::PlayerStats> players;
  std::vector<std::string> names = {};  ///< of the players; empty: not told
  net::ServerCounters server;
  net::ConnectionCounts connections;
  net::EnetCounters socket;
  net::WebSocketCounters web;      ///< zeros where there are no browsers
  net::SecurityCounters security;  ///< zeros where a match is insecure
};

[[nodiscard]] std::string metrics_as_text(const MatchMetrics& metrics);
[[nodiscard]] std::string metrics_as_json(const MatchMetrics& metrics);
/// Prometheus' text format 0.0.4.
[[nodiscard]] std::string metrics_for_prometheus(const MatchMetrics& metrics);

/// `GET /metrics`, `/stats.json`, `/livez` (200: the match's loop runs), `/readyz` (200, or 503
/// where no player should be sent to), and for everything else a text.
[[nodiscard]] HttpAnswer answer_about(std::string_view request, const MatchMetrics& metrics);

/// Of a process that hosts many matches on one socket.
struct RoomsMetrics {
  std::string_view state = {};  ///< "open" or "draining"
  bool ready = true;            ///< new matches begin
  bool alive = true;            ///< its threads run
  std::uint64_t running = 0;
  std::uint64_t ended = 0;
  std::vector<MatchMetrics> matches;  ///< that are open
  /// Over all matches, ended ones included; its one player stands for all. The counters of socket
  /// and handshakes are the process's.
  MatchMetrics sum;
  net::RouterCounters router;
};

/// Adds a match's counters to a sum; `add_up_present` its gauges too.
void add_up(MatchMetrics& sum, const MatchMetrics& one);
void add_up_present(MatchMetrics& sum, const MatchMetrics& one);

/// `lockstone_host_…`: the process; `lockstone_…{match="N"}`: each open match.
[[nodiscard]] std::string rooms_for_prometheus(const RoomsMetrics& rooms);
[[nodiscard]] std::string rooms_as_json(const RoomsMetrics& rooms);
/// The same paths as of one match.
[[nodiscard]] HttpAnswer answer_about(std::string_view request, const RoomsMetrics& rooms);

}  // namespace lockstone::tool
