#include "tools/lockstone/match/metrics.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

struct PlayerFigure {
  const char* name;
  const char* kind;
  std::int64_t (*value)(const net::PlayerStats&);
};

std::int64_t as_signed(std::uint64_t value) {
  return static_cast<std::int64_t>(value);
}

using Stats = net::PlayerStats;
constexpr std::array<PlayerFigure, 13> k_figures{
    {{"bytes_sent", "counter", [](const Stats& s) { return as_signed(s.bytes_sent); }},
     {"bytes_received", "counter", [](const Stats& s) { return as_signed(s.bytes_received); }},
     {"packets_sent", "counter", [](const Stats& s) { return as_signed(s.packets_sent); }},
     {"packets_received", "counter", [](const Stats& s) { return as_signed(s.packets_received); }},
     {"round_trip_us", "gauge", [](const Stats& s) { return s.round_trip_us; }},
     {"margin_quarters", "gauge", [](const Stats& s) { return std::int64_t{s.margin_quarters}; }},
     {"late_inputs", "counter", [](const Stats& s) { return as_signed(s.late_inputs); }},
     {"substituted_inputs", "counter",
      [](const Stats& s) { return as_signed(s.substituted_inputs); }},
     {"hashes_compared", "counter", [](const Stats& s) { return as_signed(s.hashes_compared); }},
     {"hashes_equal", "counter", [](const Stats& s) { return as_signed(s.hashes_equal); }},
     {"malformed_packets", "counter",
      [](const Stats& s) { return as_signed(s.malformed_packets); }},
     {"entries", "counter", [](const Stats& s) { return as_signed(s.entries); }},
     {"resends", "counter", [](const Stats& s) { return as_signed(s.resends); }}}};

// One line here, and a counter is in every format.
struct MatchFigure {
  const char* name;
  const char* kind;
  std::uint64_t (*value)(const MatchMetrics&);
};

using M = MatchMetrics;
constexpr std::array<MatchFigure, 29> k_match_figures{
    {{"ticks", "counter", [](const M& m) { return m.ticks; }},
     {"spectators", "gauge", [](const M& m) { return std::uint64_t{m.spectators}; }},
     {"desyncs", "counter", [](const M& m) { return m.desyncs; }},
     {"connections_greeting", "gauge",
      [](const M& m) { return std::uint64_t{m.connections.greeting}; }},
     {"connections_players", "gauge",
      [](const M& m) { return std::uint64_t{m.connections.players}; }},
     {"connections_condemned", "gauge",
      [](const M& m) { return std::uint64_t{m.connections.condemned}; }},
     {"resyncs", "counter", [](const M& m) { return m.server.resyncs; }},
     {"players_expelled", "counter", [](const M& m) { return m.server.expelled; }},
     {"malformed_packets", "counter", [](const M& m) { return m.server.malformed_packets; }},
     {"connections_turned_away", "counter", [](const M& m) { return m.server.turned_away; }},
     {"datagrams", "counter", [](const M& m) { return m.socket.datagrams; }},
     {"datagrams_malformed", "counter", [](const M& m) { return m.socket.malformed; }},
     {"datagrams_stray", "counter", [](const M& m) { return m.socket.strays; }},
     {"datagrams_forged", "counter", [](const M& m) { return m.socket.forged; }},
     {"datagrams_limited", "counter", [](const M& m) { return m.socket.limited; }},
     {"datagrams_too_far_ahead", "counter", [](const M& m) { return m.socket.too_far_ahead; }},
     {"datagrams_replayed", "counter", [](const M& m) { return m.socket.replayed; }},
     {"datagrams_oversized", "counter", [](const M& m) { return m.socket.oversized; }},
     {"connects_crowded", "counter", [](const M& m) { return m.socket.crowded; }},
     {"connects_repeated", "counter", [](const M& m) { return m.socket.repeated_connects; }},
     {"connects_refused", "counter", [](const M& m) { return m.socket.refusals; }},
     {"floods", "counter", [](const M& m) { return m.socket.floods; }},
     {"handshakes_completed", "counter",
      [](const M& m) { return m.security.handshakes_completed; }},
     {"handshakes_refused", "counter", [](const M& m) { return m.security.handshakes_refused; }},
     {"handshakes_timed_out", "counter",
      [](const M& m) { return m.security.handshakes_timed_out; }},
     {"handshakes_replaced", "counter", [](const M& m) { return m.security.handshakes_replaced; }},
     {"handshakes_limited", "counter", [](const M& m) { return m.security.handshakes_limited; }},
     {"packets_forged", "counter", [](const M& m) { return m.security.packets_forged; }},
     {"packets_replayed", "counter", [](const M& m) { return m.security.packets_replayed; }}}};

// Counters by reason; value 0 of an enumeration that means "none" stays 0.
struct ReasonFigure {
  const char* name;
  const char* label;
  std::size_t count;
  std::uint64_t (*value)(const MatchMetrics&, std::size_t);
  std::string_view (*text)(std::size_t);
};

template <class E>
std::string_view text_of(std::size_t value) {
  return to_string(static_cast<E>(value));
}

constexpr std::array<ReasonFigure, 3> k_reason_figures{
    {{"refused", "reason", net::k_refuse_reasons,
      [](const M& m, std::size_t i) { return m.server.refused[i]; }, text_of<net::RefuseReason>},
     {"left", "reason", net::k_leave_reasons,
      [](const M& m, std::size_t i) { return m.server.left[i]; }, text_of<net::LeaveReason>},
     {"wrong_states", "verdict", net::k_verdicts,
      [](const M& m, std::size_t i) { return m.server.verdicts[i]; }, text_of<net::Verdict>}}};

void close_socket(int& socket) {
  if (socket >= 0) ::close(socket);
  socket = -1;
}

}  // namespace

std::string metrics_as_text(const MatchMetrics& metrics) {
  std::string text = fmt::format("port {}: {} ticks, {} spectators, {} desyncs\n", metrics.port,
                                 metrics.ticks, metrics.spectators, metrics.desyncs);
  for (const ReasonFigure& figure : k_reason_figures) {
    for (std::size_t i = 0; i < figure.count; ++i) {
      if (figure.value(metrics, i) == 0) continue;
      text += fmt::format("{} ({}): {}\n", figure.name, figure.text(i), figure.value(metrics, i));
    }
  }
  for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
    const bool present = ((metrics.present_mask >> slot) & 1) != 0;
    text += fmt::format("player {} ({}):", slot, present ? "here" : "away");
    for (const PlayerFigure& figure : k_figures)
      text += fmt::format(" {} {}", figure.name, figure.value(metrics.players[slot]));
    text += '\n';
  }
  return text;
}

std::string metrics_as_json(const MatchMetrics& metrics) {
  nlohmann::ordered_json players = nlohmann::ordered_json::array();
  for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
    nlohmann::ordered_json player{{"slot", slot},
                                  {"present", ((metrics.present_mask >> slot) & 1) != 0}};
    for (const PlayerFigure& figure : k_figures)
      player[figure.name] = figure.value(metrics.players[slot]);
    players.push_back(std::move(player));
  }
  nlohmann::ordered_json json{
      {"port", metrics.port}, {"state", metrics.state}, {"ready", metrics.ready}};
  for (const MatchFigure& figure : k_match_figures)
    json[figure.name] = figure.value(metrics);
  for (const ReasonFigure& figure : k_reason_figures) {
    nlohmann::ordered_json& counts = json[figure.name] = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < figure.count; ++i) {
      if (figure.value(metrics, i) > 0)
        counts[std::string(figure.text(i))] = figure.value(metrics, i);
    }
  }
  json["players"] = std::move(players);
  return json.dump(2) + '\n';
}

std::string metrics_for_prometheus(const MatchMetrics& metrics) {
  std::string text;
  for (const MatchFigure& figure : k_match_figures) {
    text += fmt::format("# TYPE lockstone_{0} {1}\nlockstone_{0}{{match=\"{2}\"}} {3}\n",
                        figure.name, figure.kind, metrics.port, figure.value(metrics));
  }
  for (const ReasonFigure& figure : k_reason_figures) {
    text += fmt::format("# TYPE lockstone_{} counter\n", figure.name);
    for (std::size_t i = 0; i < figure.count; ++i) {
      text += fmt::format("lockstone_{}{{match=\"{}\",{}=\"{}\"}} {}\n", figure.name, metrics.port,
                          figure.label, figure.text(i), figure.value(metrics, i));
    }
  }
  for (const PlayerFigure& figure : k_figures) {
    text += fmt::format("# TYPE lockstone_player_{} {}\n", figure.name, figure.kind);
    for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
      text += fmt::format("lockstone_player_{}{{match=\"{}\",player=\"{}\"}} {}\n", figure.name,
                          metrics.port, slot, figure.value(metrics.players[slot]));
    }
  }
  return text;
}

std::unique_ptr<MetricsPort> MetricsPort::open(std::uint16_t port, const std::string& address) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    complain(fmt::format("no metrics: {} is no numeric address", address));
    return nullptr;
  }
  const int socket = ::socket(found->ai_family, SOCK_STREAM, 0);
  const int yes = 1;
  const bool ok = socket >= 0 &&
                  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                  ::bind(socket, found->ai_addr, found->ai_addrlen) == 0 &&
                  ::listen(socket, 4) == 0 && ::fcntl(socket, F_SETFL, O_NONBLOCK) == 0;
  const int error = errno;
  ::freeaddrinfo(found);
  if (ok) return std::unique_ptr<MetricsPort>(new MetricsPort(socket));
  complain(fmt::format("no metrics on {} port {}: {}", address, port, std::strerror(error)));
  if (socket >= 0) ::close(socket);
  return nullptr;
}

// The port is in the same place for both families.
std::uint16_t MetricsPort::port() const {
  sockaddr_storage address{};
  socklen_t bytes = sizeof address;
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &bytes);
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

MetricsPort::~MetricsPort() {
  close_socket(client_);
  close_socket(socket_);
}

void MetricsPort::serve(const std::function<MatchMetrics()>& metrics) {
  constexpr std::size_t k_longest_request = 4096;
  if (const int next = ::accept(socket_, nullptr, nullptr); next >= 0) {
    close_socket(client_);  // has been silent until now: the next in line shall not wait for it
    client_ = next;
    ::fcntl(client_, F_SETFL, O_NONBLOCK);
    request_.clear();
  }
  if (client_ < 0) return;
  std::array<char, 1024> bytes{};
  const ssize_t count = ::recv(client_, bytes.data(), bytes.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
  if (count > 0) request_.append(bytes.data(), static_cast<std::size_t>(count));
  const bool whole = request_.find("\r\n\r\n") != std::string::npos;
  if (whole) answer(metrics, request_);
  if (whole || count <= 0 || request_.size() > k_longest_request) close_socket(client_);
}

// An answer that does not fit into the system's buffer at once is cut: a scraper asks again.
void MetricsPort::answer(const std::function<MatchMetrics()>& metrics, std::string_view request) {
  std::string body;
  const char* status = "200 OK";
  const char* type = "text/plain; charset=utf-8";
  if (request.rfind("GET /metrics", 0) == 0) {
    body = metrics_for_prometheus(metrics());
    type = "text/plain; version=0.0.4";
  } else if (request.rfind("GET /stats.json", 0) == 0) {
    body = metrics_as_json(metrics());
    type = "application/json";
  } else if (request.rfind("GET /livez", 0) == 0) {
    body = "ok\n";
  } else if (request.rfind("GET /readyz", 0) == 0) {
    const MatchMetrics now = metrics();
    body = fmt::format("{}\n", now.state);
    if (!now.ready) status = "503 Service Unavailable";
  } else {
    body = metrics_as_text(metrics());
  }
  const std::string head = fmt::format(
      "HTTP/1.0 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n", status,
      type, body.size());
  const std::string all = head + body;
  static_cast<void>(::send(client_, all.data(), all.size(), MSG_NOSIGNAL));
}

}  // namespace lockstone::tool
