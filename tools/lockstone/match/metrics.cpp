#include "tools/lockstone/match/metrics.h"

#include <array>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/net/player_name.h>

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
constexpr std::size_t k_own_figures = 10;  // the others are of the socket

using M = MatchMetrics;
constexpr std::array<MatchFigure, 43> k_match_figures{
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
     {"web_callers", "counter", [](const M& m) { return m.web.callers; }},
     {"web_opened", "counter", [](const M& m) { return m.web.opened; }},
     {"web_messages", "counter", [](const M& m) { return m.web.messages; }},
     {"web_crowded", "counter", [](const M& m) { return m.web.crowded; }},
     {"web_full", "counter", [](const M& m) { return m.web.full; }},
     {"web_wrong_origin", "counter", [](const M& m) { return m.web.wrong_origin; }},
     {"web_wrong_protocol", "counter", [](const M& m) { return m.web.wrong_protocol; }},
     {"web_handshakes_late", "counter", [](const M& m) { return m.web.handshakes_late; }},
     {"web_malformed", "counter", [](const M& m) { return m.web.malformed; }},
     {"web_limited", "counter", [](const M& m) { return m.web.limited; }},
     {"web_floods", "counter", [](const M& m) { return m.web.floods; }},
     {"web_slow", "counter", [](const M& m) { return m.web.slow; }},
     {"web_idle", "counter", [](const M& m) { return m.web.idle; }},
     {"web_unreliable_dropped", "counter", [](const M& m) { return m.web.unreliable_dropped; }},
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

std::uint64_t number_of(const MatchMetrics& metrics) {
  return metrics.room.value_or(metrics.port);
}

std::string type_line(std::string_view name, std::string_view kind) {
  return fmt::format("# TYPE lockstone_{} {}\n", name, kind);
}

// The socket of one in a room is its host's.
std::span<const MatchFigure> figures_of(bool in_room) {
  return std::span(k_match_figures).first(in_room ? k_own_figures : k_match_figures.size());
}

void add_figures(const MatchMetrics& metrics, std::span<const MatchFigure> figures,
                 nlohmann::ordered_json& json) {
  for (const MatchFigure& figure : figures)
    json[figure.name] = figure.value(metrics);
  for (const ReasonFigure& figure : k_reason_figures) {
    nlohmann::ordered_json& counts = json[figure.name] = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < figure.count; ++i) {
      if (figure.value(metrics, i) > 0)
        counts[std::string(figure.text(i))] = figure.value(metrics, i);
    }
  }
}

nlohmann::ordered_json json_of(const MatchMetrics& metrics) {
  nlohmann::ordered_json players = nlohmann::ordered_json::array();
  for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
    nlohmann::ordered_json player{{"slot", slot},
                                  {"present", net::has_slot(metrics.present_mask, slot)}};
    if (slot < metrics.names.size()) player["name"] = metrics.names[slot];
    for (const PlayerFigure& figure : k_figures)
      player[figure.name] = figure.value(metrics.players[slot]);
    players.push_back(std::move(player));
  }
  nlohmann::ordered_json json{{metrics.room ? "match" : "port", number_of(metrics)},
                              {"state", metrics.state},
                              {"ready", metrics.ready}};
  add_figures(metrics, figures_of(metrics.room.has_value()), json);
  json["players"] = std::move(players);
  return json;
}

bool is_counter(const PlayerFigure& figure) {
  return std::string_view(figure.kind) == "counter";
}

struct HostFigure {
  const char* name;
  const char* kind;
  std::uint64_t (*value)(const RoomsMetrics&);
};

using R = RoomsMetrics;
constexpr std::array<HostFigure, 6> k_host_figures{
    {{"matches_open", "gauge", [](const R& r) { return std::uint64_t{r.matches.size()}; }},
     {"matches_running", "gauge", [](const R& r) { return r.running; }},
     {"matches_ended", "counter", [](const R& r) { return r.ended; }},
     {"connections_homeless", "counter", [](const R& r) { return r.router.homeless; }},
     {"packets_lost_in_queues", "counter", [](const R& r) { return r.router.lost; }},
     {"connections_broken_by_queues", "counter", [](const R& r) { return r.router.broken; }}}};

// All that is the process's: sums over its matches, and its socket.
std::string host_for_prometheus(const RoomsMetrics& rooms) {
  std::string text;
  const auto figure_line = [&text](const std::string& name, std::string_view kind,
                                   std::uint64_t value) {
    text += type_line("host_" + name, kind) + fmt::format("lockstone_host_{} {}\n", name, value);
  };
  for (const HostFigure& figure : k_host_figures)
    figure_line(figure.name, figure.kind, figure.value(rooms));
  for (const MatchFigure& figure : k_match_figures)
    figure_line(figure.name, figure.kind, figure.value(rooms.sum));
  for (const ReasonFigure& figure : k_reason_figures) {
    text += type_line(fmt::format("host_{}", figure.name), "counter");
    for (std::size_t i = 0; i < figure.count; ++i) {
      text += fmt::format("lockstone_host_{}{{{}=\"{}\"}} {}\n", figure.name, figure.label,
                          figure.text(i), figure.value(rooms.sum, i));
    }
  }
  for (const PlayerFigure& figure : k_figures) {
    if (!is_counter(figure) || rooms.sum.players.empty()) continue;
    figure_line(fmt::format("player_{}", figure.name), figure.kind,
                static_cast<std::uint64_t>(figure.value(rooms.sum.players[0])));
  }
  return text;
}

template <class Metrics>
struct Pages {
  std::string (*for_prometheus)(const Metrics&);
  std::string (*as_json)(const Metrics&);
  std::string (*as_text)(const Metrics&);
  bool is_alive;
};

template <class Metrics>
HttpAnswer answer_with(std::string_view request, const Metrics& metrics,
                       const Pages<Metrics>& pages) {
  HttpAnswer answer;
  if (request.starts_with("GET /metrics")) {
    answer.body = pages.for_prometheus(metrics);
    answer.type = "text/plain; version=0.0.4";
  } else if (request.starts_with("GET /stats.json")) {
    answer.body = pages.as_json(metrics);
    answer.type = "application/json";
  } else if (request.starts_with("GET /livez")) {
    answer.body = pages.is_alive ? "ok\n" : "a thread hangs\n";
    if (!pages.is_alive) answer.status = "503 Service Unavailable";
  } else if (request.starts_with("GET /readyz")) {
    answer.body = fmt::format("{}\n", metrics.state);
    if (!metrics.ready) answer.status = "503 Service Unavailable";
  } else {
    answer.body = pages.as_text(metrics);
  }
  return answer;
}

}  // namespace

std::string metrics_as_text(const MatchMetrics& metrics) {
  std::string text =
      fmt::format("{} {}: {} ticks, {} spectators, {} desyncs\n", metrics.room ? "match" : "port",
                  number_of(metrics), metrics.ticks, metrics.spectators, metrics.desyncs);
  for (const ReasonFigure& figure : k_reason_figures) {
    for (std::size_t i = 0; i < figure.count; ++i) {
      if (figure.value(metrics, i) == 0) continue;
      text += fmt::format("{} ({}): {}\n", figure.name, figure.text(i), figure.value(metrics, i));
    }
  }
  for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
    const bool present = net::has_slot(metrics.present_mask, slot);
    const std::string name = slot < metrics.names.size() ? metrics.names[slot] : std::string();
    text += fmt::format("{} ({}):", net::player_text(static_cast<unsigned>(slot), name),
                        present ? "here" : "away");
    for (const PlayerFigure& figure : k_figures)
      text += fmt::format(" {} {}", figure.name, figure.value(metrics.players[slot]));
    text += '\n';
  }
  return text;
}

std::string metrics_as_json(const MatchMetrics& metrics) {
  return json_of(metrics).dump(2) + '\n';
}

std::string metrics_for_prometheus(const MatchMetrics& metrics) {
  std::string text;
  for (const MatchFigure& figure : k_match_figures) {
    text += type_line(figure.name, figure.kind) + fmt::format("lockstone_{}{{match=\"{}\"}} {}\n",
                                                              figure.name, number_of(metrics),
                                                              figure.value(metrics));
  }
  for (const ReasonFigure& figure : k_reason_figures) {
    text += type_line(figure.name, "counter");
    for (std::size_t i = 0; i < figure.count; ++i) {
      text +=
          fmt::format("lockstone_{}{{match=\"{}\",{}=\"{}\"}} {}\n", figure.name,
                      number_of(metrics), figure.label, figure.text(i), figure.value(metrics, i));
    }
  }
  for (const PlayerFigure& figure : k_figures) {
    text += type_line(fmt::format("player_{}", figure.name), figure.kind);
    for (std::size_t slot = 0; slot < metrics.players.size(); ++slot) {
      text += fmt::format("lockstone_player_{}{{match=\"{}\",player=\"{}\"}} {}\n", figure.name,
                          number_of(metrics), slot, figure.value(metrics.players[slot]));
    }
  }
  return text;
}

void add_up(MatchMetrics& sum, const MatchMetrics& one) {
  sum.ticks += one.ticks;
  sum.desyncs += one.desyncs;
  sum.server.malformed_packets += one.server.malformed_packets;
  sum.server.turned_away += one.server.turned_away;
  sum.server.resyncs += one.server.resyncs;
  sum.server.expelled += one.server.expelled;
  const auto add = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < from.size(); ++i)
      to[i] += from[i];
  };
  add(sum.server.refused, one.server.refused);
  add(sum.server.left, one.server.left);
  add(sum.server.verdicts, one.server.verdicts);
  sum.players.resize(1);
  net::PlayerStats& all = sum.players[0];
  for (const net::PlayerStats& player : one.players) {
    all.bytes_sent += player.bytes_sent;
    all.bytes_received += player.bytes_received;
    all.packets_sent += player.packets_sent;
    all.packets_received += player.packets_received;
    all.late_inputs += player.late_inputs;
    all.substituted_inputs += player.substituted_inputs;
    all.hashes_compared += player.hashes_compared;
    all.hashes_equal += player.hashes_equal;
    all.malformed_packets += player.malformed_packets;
    all.entries += player.entries;
    all.resends += player.resends;
  }
}

void add_up_present(MatchMetrics& sum, const MatchMetrics& one) {
  add_up(sum, one);
  sum.spectators += one.spectators;
  sum.connections.greeting += one.connections.greeting;
  sum.connections.players += one.connections.players;
  sum.connections.condemned += one.connections.condemned;
}

std::string rooms_for_prometheus(const RoomsMetrics& rooms) {
  std::string text = host_for_prometheus(rooms);
  for (const MatchFigure& figure : figures_of(true)) {
    text += type_line(figure.name, figure.kind);
    for (const MatchMetrics& match : rooms.matches) {
      text += fmt::format("lockstone_{}{{match=\"{}\"}} {}\n", figure.name, number_of(match),
                          figure.value(match));
    }
  }
  return text;
}

std::string rooms_as_json(const RoomsMetrics& rooms) {
  nlohmann::ordered_json json{{"state", rooms.state}, {"ready", rooms.ready}};
  for (const HostFigure& figure : k_host_figures)
    json[figure.name] = figure.value(rooms);
  nlohmann::ordered_json& sum = json["sum"] = nlohmann::ordered_json::object();
  add_figures(rooms.sum, k_match_figures, sum);
  for (const PlayerFigure& figure : k_figures) {
    if (!is_counter(figure) || rooms.sum.players.empty()) continue;
    sum[fmt::format("player_{}", figure.name)] = figure.value(rooms.sum.players[0]);
  }
  nlohmann::ordered_json& matches = json["matches"] = nlohmann::ordered_json::array();
  for (const MatchMetrics& match : rooms.matches)
    matches.push_back(json_of(match));
  return json.dump(2) + '\n';
}

HttpAnswer answer_about(std::string_view request, const RoomsMetrics& rooms) {
  const auto as_text = [](const RoomsMetrics& all) {
    std::string text;
    for (const MatchMetrics& match : all.matches)
      text += metrics_as_text(match);
    return text;
  };
  return answer_with(
      request, rooms,
      Pages<RoomsMetrics>{rooms_for_prometheus, rooms_as_json, as_text, rooms.alive});
}

HttpAnswer answer_about(std::string_view request, const MatchMetrics& metrics) {
  return answer_with(
      request, metrics,
      Pages<MatchMetrics>{metrics_for_prometheus, metrics_as_json, metrics_as_text, true});
}

}  // namespace lockstone::tool
