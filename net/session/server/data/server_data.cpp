#include "net/session/server/data/server_data.h"

namespace lockstone::net {
namespace {

std::size_t snapshot_bytes(const Simulation* simulation) {
  return simulation == nullptr ? 0 : simulation->snapshot_bytes_max(SnapshotKind::canonical);
}

constexpr std::size_t k_spare_places = 4;  // for those who are refused

}  // namespace

ServerData::ServerData(const ServerConfig& server_config, const ServerParts& server_parts)
    : config(server_config),
      parts(server_parts),
      observer(parts.observer == nullptr ? &silent_observer : parts.observer),
      info(parts.simulation == nullptr ? config.info : parts.simulation->info()),
      shape{info.player_count, info.input_bytes},
      tick_us(1'000'000 / info.tick_rate),
      schedule(info.tick_rate),
      records(config.history_ticks, shape.record_bytes()),
      snapshots(simulates() ? config.snapshot_ticks : 0, snapshot_bytes(parts.simulation)),
      own_commands(k_waiting_command_bytes, k_max_waiting_commands),
      peers(*parts.transport, info.player_count + config.max_spectators + k_spare_places),
      roster(info, config),
      judge(info.player_count, config.history_ticks, simulates()),
      parts_judge(simulates()) {
  match.end_tick = config.tick_count == 0 ? k_max_tick : config.tick_count;
}

std::uint64_t ServerData::visible_ticks() const {
  if (match.state >= ServerState::closing) return match.confirmed;
  return match.confirmed - std::min<std::uint64_t>(match.confirmed, config.spectator_delay_ticks);
}

PlayerStats player_stats(const ServerData& data, std::uint8_t slot) {
  if (!data.roster.is_slot(slot)) misused("Server: the slot must be below the player count");
  const Seat& seat = data.roster.seat(slot);
  PlayerStats stats = seat.stats;
  stats.hashes_compared = data.judge.player(slot).compared;
  stats.hashes_equal = data.judge.player(slot).equal;
  stats.parts_equal = data.parts_judge.equal(slot);
  if (seat.peer == nullptr) return stats;
  const TransportStats traffic = data.parts.transport->stats(seat.peer->connection);
  stats.bytes_sent = traffic.bytes_sent;
  stats.bytes_received = traffic.bytes_received;
  stats.packets_sent = traffic.packets_sent;
  stats.packets_received = traffic.packets_received;
  stats.round_trip_us = traffic.round_trip_us;
  return stats;
}

ConnectionCounts connection_counts(const ServerData& data) {
  ConnectionCounts counts;
  for (const Peer& peer : data.peers.all()) {
    const bool condemned = peer.stage == Stage::seated && data.roster.seat(peer.slot).condemned;
    if (peer.stage == Stage::connected || peer.stage == Stage::offered) ++counts.greeting;
    if (peer.stage == Stage::seated && !condemned) ++counts.players;
    if (condemned) ++counts.condemned;
    if (peer.stage == Stage::watching) ++counts.spectators;
  }
  return counts;
}

std::optional<std::uint64_t> final_hash(const ServerData& data) {
  const std::uint64_t ticks = data.match.confirmed;
  if (ticks == 0 || data.judge.right().end() != ticks) return std::nullopt;
  return data.judge.right().at(ticks - 1);
}

void tell_names(ServerData& data, const Peer& peer) {
  for (std::uint8_t slot = 0; slot < data.roster.seats().size(); ++slot) {
    const PlayerName& name = data.roster.seat(slot).name;
    if (!name.view().empty()) data.peers.tell(peer, Named{slot, name});
  }
}

Welcome welcome_of(const ServerData& data, std::uint8_t slot, Entry way) {
  const bool plays = data.roster.is_slot(slot);
  const std::uint64_t key = plays ? data.roster.seat(slot).rejoin_key : 0;
  return {slot,
          data.info.player_count,
          data.config.input_delay_ticks,
          data.config.late_policy,
          data.config.pacing,
          data.config.tick_count,
          way,
          key,
          plays ? data.roster.seat(slot).own_commands.taken : 0};
}

}  // namespace lockstone::net
