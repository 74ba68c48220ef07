// The counters of a match as text for people, as JSON and for Prometheus, on a port if asked.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>

namespace lockstone::tool {

struct MatchMetrics {
  std::uint16_t port = 0;       ///< of the match
  std::string_view state = {};  ///< of the server
  bool ready = true;            ///< players may come
  std::uint64_t ticks = 0;
  std::size_t spectators = 0;
  std::uint16_t present_mask = 0;
  std::uint64_t desyncs = 0;
  std::vector<net::PlayerStats> players;
  net::ServerCounters server;
  net::ConnectionCounts connections;
  net::EnetCounters socket;
  net::SecurityCounters security;  ///< zeros where a match is insecure
};

[[nodiscard]] std::string metrics_as_text(const MatchMetrics& metrics);
[[nodiscard]] std::string metrics_as_json(const MatchMetrics& metrics);
/// Prometheus' text format 0.0.4.
[[nodiscard]] std::string metrics_for_prometheus(const MatchMetrics& metrics);

/// A listening TCP socket that answers `GET /metrics`, `/stats.json`, `/livez` (200: the match's
/// loop runs), `/readyz` (200, or 503 where no player should be sent to) and everything else with a
/// text. Never blocks.
class MetricsPort {
 public:
  /// On a numeric IPv4 or IPv6 address. Null, with a complaint, when the system refuses. 0: the
  /// system chooses.
  [[nodiscard]] static std::unique_ptr<MetricsPort> open(std::uint16_t port,
                                                         const std::string& address = "127.0.0.1");
  ~MetricsPort();
  [[nodiscard]] std::uint16_t port() const;

  MetricsPort(const MetricsPort&) = delete;
  MetricsPort& operator=(const MetricsPort&) = delete;

  /// Serves the requests since the last call.
  void serve(const std::function<MatchMetrics()>& metrics);

 private:
  explicit MetricsPort(int socket) : socket_(socket) {}
  void answer(const std::function<MatchMetrics()>& metrics, std::string_view request);

  int socket_;
  int client_ = -1;  ///< has connected, and not yet sent its request
  std::string request_;
};

}  // namespace lockstone::tool
