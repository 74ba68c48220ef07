#include "tools/lockstone/metrics.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/lockstone/console.h"

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

void close_socket(int& socket) {
  if (socket >= 0) ::close(socket);
  socket = -1;
}

}  // namespace

std::string metrics_as_text(const MatchMetrics& metrics) {
  std::string text = fmt::format("port {}: {} ticks, {} spectators, {} desyncs\n", metrics.port,
                                 metrics.ticks, metrics.spectators, metrics.desyncs);
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
  const nlohmann::ordered_json json{{"port", metrics.port},
                                    {"ticks", metrics.ticks},
                                    {"spectators", metrics.spectators},
                                    {"desyncs", metrics.desyncs},
                                    {"players", players}};
  return json.dump(2) + '\n';
}

std::string metrics_for_prometheus(const MatchMetrics& metrics) {
  std::string text = fmt::format(
      "# TYPE lockstone_ticks counter\nlockstone_ticks{{match=\"{0}\"}} {1}\n"
      "# TYPE lockstone_spectators gauge\nlockstone_spectators{{match=\"{0}\"}} {2}\n"
      "# TYPE lockstone_desyncs counter\nlockstone_desyncs{{match=\"{0}\"}} {3}\n",
      metrics.port, metrics.ticks, metrics.spectators, metrics.desyncs);
  for (const PlayerFigure& figure : k_figures) {
    text += fmt::format("# TYPE lockstone_player_{} {}\n", figure.name, figure.kind);
    for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
      text += fmt::format("lockstone_player_{}{{match=\"{}\",player=\"{}\"}} {}\n", figure.name,
                          metrics.port, slot, figure.value(metrics.players[slot]));
    }
  }
  return text;
}

std::unique_ptr<MetricsPort> MetricsPort::open(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int yes = 1;
  const bool ok =
      socket >= 0 && ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(socket, 4) == 0 && ::fcntl(socket, F_SETFL, O_NONBLOCK) == 0;
  if (ok) return std::unique_ptr<MetricsPort>(new MetricsPort(socket));
  complain(fmt::format("no metrics on 127.0.0.1:{}: {}", port, std::strerror(errno)));
  if (socket >= 0) ::close(socket);
  return nullptr;
}

std::uint16_t MetricsPort::port() const {
  sockaddr_in address{};
  socklen_t bytes = sizeof address;
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &bytes);
  return ntohs(address.sin_port);
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

// What does not fit the system's buffer at once is cut: a scraper asks again.
void MetricsPort::answer(const std::function<MatchMetrics()>& metrics, std::string_view request) {
  std::string body;
  const char* type = "text/plain; charset=utf-8";
  if (request.rfind("GET /metrics", 0) == 0) {
    body = metrics_for_prometheus(metrics());
    type = "text/plain; version=0.0.4";
  } else if (request.rfind("GET /stats.json", 0) == 0) {
    body = metrics_as_json(metrics());
    type = "application/json";
  } else {
    body = metrics_as_text(metrics());
  }
  const std::string head = fmt::format(
      "HTTP/1.0 200 OK\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
      type, body.size());
  const std::string all = head + body;
  static_cast<void>(::send(client_, all.data(), all.size(), MSG_NOSIGNAL));
}

}  // namespace lockstone::tool
