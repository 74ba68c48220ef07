#include "net/session/server/data/command_sender.h"

#include <algorithm>

namespace lockstone::net {

void CommandSender::send() {
  if (data_.match.state == ServerState::lobby || data_.match.state == ServerState::over) return;
  const std::size_t count = data_.roster.seats().size();
  first_ = (first_ + 1) % count;
  for (std::size_t i = 0; i < count; ++i)
    send_to(data_.roster.seats()[(first_ + i) % count], data_.match.confirmed);
  for (Watcher& watcher : data_.roster.watchers())
    send_to(watcher, std::max(data_.visible_ticks(), watcher.ticks_received));
}

void CommandSender::send_to(Follower& follower, std::uint64_t end_tick) {
  if (follower.peer == nullptr || follower.loading) return;
  const CommandBuffer& ring = data_.commands.ring();
  CommandCursor& cursor = follower.commands;
  if (!cursor.found) cursor = {true, ring.first_of(follower.ticks_received), 0};
  if (cursor.next < ring.begin()) cursor = {true, ring.begin(), 0};
  while (cursor.next < ring.end()) {
    const CommandBuffer::Entry& entry = ring.entry(cursor.next);
    if (entry.tick >= end_tick) return;
    const std::size_t size = std::min(k_max_chunk_bytes, entry.size - cursor.sent);
    const TickCommand piece{entry.tick, entry.slot, static_cast<std::uint32_t>(entry.size),
                            static_cast<std::uint32_t>(cursor.sent),
                            ring.bytes(cursor.next).subspan(cursor.sent, size)};
    if (!pace_.take(data_.match.now_us, static_cast<std::uint32_t>(size))) return;
    if (data_.peers.send(*follower.peer, piece) != Status::ok) return;  // its queue is full
    cursor.sent += size;
    if (cursor.sent == entry.size) cursor = {true, cursor.next + 1, 0};
  }
}

}  // namespace lockstone::net
