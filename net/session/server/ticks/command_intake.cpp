#include "net/session/server/ticks/command_intake.h"

#include <lockstone/assert.h>

namespace lockstone::net {

bool CommandIntake::on_command(const Peer& peer, ByteView packet) {
  CommandPiece piece;
  if (decode(packet, piece) != Status::ok) return false;
  SeatCommands& own = data_.roster.seat(peer.slot).own_commands;
  const bool open = !own.waiting.empty() && !own.waiting.last().complete();
  if (own.refused_bytes > 0) {
    if (piece.total_bytes - piece.offset_bytes != own.refused_bytes) return false;
    own.refused_bytes -= piece.chunk.size();
    return true;
  }
  const std::size_t expected = open ? own.waiting.last().filled : 0;
  if (piece.offset_bytes != expected) return false;
  if (open && piece.total_bytes != own.waiting.last().size) return false;
  if (!open && !begin(data_.roster.seat(peer.slot), piece.total_bytes)) {
    own.refused_bytes = piece.total_bytes - piece.chunk.size();
    conclude(peer, false);
    return true;
  }
  own.waiting.append(piece.chunk);
  if (own.waiting.last().complete()) conclude(peer, true);
  return true;
}

// Within the limits, and with room for it.
bool CommandIntake::begin(Seat& seat, std::size_t total_bytes) {
  SeatCommands& own = seat.own_commands;
  const std::int64_t now_us = data_.match.now_us;
  return total_bytes <= data_.config.commands.max_bytes &&
         data_.match.state <= ServerState::running && !seat.condemned && own.rate.take(now_us, 1) &&
         own.bytes_rate.take(now_us, static_cast<std::uint32_t>(total_bytes)) &&
         own.waiting.open(0, seat.peer->slot, total_bytes);
}

void CommandIntake::conclude(const Peer& peer, bool taken) {
  Seat& seat = data_.roster.seat(peer.slot);
  ++(taken ? seat.stats.commands_taken : seat.stats.commands_refused);
  data_.peers.tell(peer, CommandResult{seat.own_commands.taken++, taken});
}

Status CommandIntake::give(ByteView bytes) {
  const bool fits = !bytes.empty() && bytes.size() <= k_max_command_bytes;
  if (!fits || data_.match.state > ServerState::running) return Status::invalid_argument;
  return data_.own_commands.push(0, {k_server_slot, bytes}) ? Status::ok
                                                            : Status::capacity_exhausted;
}

std::uint8_t CommandIntake::bind_to_next_tick() {
  const std::uint64_t tick = data_.match.confirmed;
  const std::uint64_t kept_ticks = std::min<std::uint64_t>(tick, data_.config.history_ticks);
  data_.commands.forget_before(tick - kept_ticks);
  Bound bound;
  bind(data_.own_commands, k_server_slot, bound);
  const std::size_t count = data_.roster.seats().size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto slot = static_cast<std::uint8_t>((tick + i) % count);
    bind(data_.roster.seat(slot).own_commands.waiting, slot, bound);
  }
  return static_cast<std::uint8_t>(bound.commands);
}

void CommandIntake::bind(CommandBuffer& waiting, std::uint8_t slot, Bound& bound) {
  while (!waiting.empty() && waiting.first().complete()) {
    const std::size_t bytes = bound.bytes + waiting.first().size;
    const bool full = bound.commands == k_max_tick_commands || bytes > k_max_tick_command_bytes;
    const PlayerCommand command{slot, waiting.bytes(waiting.begin())};
    if (full || !data_.commands.ring().push(data_.match.confirmed, command)) return;
    waiting.pop();
    ++bound.commands;
    bound.bytes = bytes;
  }
}

}  // namespace lockstone::net
