#include "net/session/client/client_data.h"

#include <utility>

#include "net/session/parts_judge.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {

ClientData::ClientData(const ClientConfig& client_config, ClientParts client_parts)
    : config(client_config),
      parts(std::move(client_parts)),
      observer(parts.observer == nullptr ? &silent_observer : parts.observer),
      server(*parts.transport, parts.connection),
      commands(k_waiting_command_bytes) {
  place.rejoin_key = config.rejoin_key;
}

bool is_complete(const ClientData& data, std::uint64_t tick) {
  const ByteView record = data.ticks.find(tick);
  return !record.empty() && data.commands.has(tick, command_count(record));
}

void note_parts(ClientData& data) {
  const Simulation& simulation = *data.game.simulation;
  if (simulation.tick() % k_parts_interval_ticks != 0 || data.place.spectates()) return;
  data.progress.state_parts = parts_of(simulation);
}

ClientStats current_stats(const ClientData& data) {
  ClientStats current = data.stats;
  if (!data.status.active()) return current;
  const TransportStats traffic = data.server.stats();
  current.bytes_sent = traffic.bytes_sent;
  current.bytes_received = traffic.bytes_received;
  current.packets_sent = traffic.packets_sent;
  current.packets_received = traffic.packets_received;
  current.round_trip_us = traffic.round_trip_us;
  current.margin_quarters = data.lead.last_margin();
  current.lead_ticks = data.lead.lead_ticks();
  current.rate_trim_ppm = data.lead.trim_ppm();
  current.jitter_us = data.playout.depth_us();
  return current;
}

}  // namespace lockstone::net
