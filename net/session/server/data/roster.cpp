#include "net/session/server/data/roster.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::size_t k_input_ring_ticks = 4 * k_input_window_ticks;

// Two seconds' worth may come at once, and one of the longest always.
SeatCommands commands_within(const CommandLimits& limits) {
  SeatCommands commands;
  if (limits.max_bytes > 0) {
    commands.waiting = CommandBuffer(k_waiting_command_bytes, k_max_waiting_commands);
  }
  commands.rate = RateLimit(limits.per_second, 2 * limits.per_second);
  commands.bytes_rate =
      RateLimit(limits.bytes_per_second, std::max(2 * limits.bytes_per_second, limits.max_bytes));
  return commands;
}

}  // namespace

void Follower::await_state(std::uint64_t oldest_ticks) {
  loading = true;
  offered = false;
  commands = {};
  oldest_entry = oldest_ticks;
}

void Follower::begin_snapshot(std::uint64_t ticks, bool is_keyframe) {
  LKS_ASSERT(loading && !offered);
  offered = true;
  keyframed = is_keyframe;
  snapshot_sent = 0;
  ticks_received = ticks;
}

void Seat::occupy(Peer& player, std::int64_t now_us) {
  LKS_ASSERT(peer == nullptr);
  static_cast<Follower&>(*this) = {};
  peer = &player;
  last_sent_us = now_us;
  condemned = false;
  expelled = false;
  dump_bytes_allowed = 0;
  hashes_since_us = now_us;
  own_commands.waiting.drop_incomplete();
  own_commands.refused_bytes = 0;
}

Roster::Roster(const SimulationInfo& info, const ServerConfig& config)
    : seats_(info.player_count), watchers_(config.max_spectators) {
  for (Seat& place : seats_) {
    place.inputs = TickRing(k_input_ring_ticks, info.input_bytes);
    place.own_commands = commands_within(config.commands);
  }
}

SlotMask Roster::present_mask() const {
  SlotMask mask = 0;
  for (std::size_t slot = 0; slot < seats_.size(); ++slot) {
    if (seats_[slot].peer != nullptr) mask |= slot_bit(slot);
  }
  return mask;
}

SlotMask Roster::active_mask() const {
  SlotMask mask = 0;
  for (std::size_t slot = 0; slot < seats_.size(); ++slot) {
    if (seats_[slot].peer != nullptr && seats_[slot].active_tick != k_never) mask |= slot_bit(slot);
  }
  return mask;
}

Follower* Roster::follower_of(const Peer& peer) {
  if (is_slot(peer.slot)) return &seats_[peer.slot];
  const auto found = std::find_if(watchers_.begin(), watchers_.end(),
                                  [&](const Watcher& watcher) { return watcher.peer == &peer; });
  return found == watchers_.end() ? nullptr : &*found;
}

Watcher* Roster::free_watcher() {
  const auto found = std::find_if(watchers_.begin(), watchers_.end(),
                                  [](const Watcher& watcher) { return watcher.peer == nullptr; });
  return found == watchers_.end() ? nullptr : &*found;
}

std::size_t Roster::watching() const {
  return static_cast<std::size_t>(
      std::count_if(watchers_.begin(), watchers_.end(),
                    [](const Watcher& watcher) { return watcher.peer != nullptr; }));
}

void Roster::forget(const Peer& peer) {
  if (is_slot(peer.slot)) seats_[peer.slot].peer = nullptr;
  for (Watcher& watcher : watchers_) {
    if (watcher.peer == &peer) watcher.peer = nullptr;
  }
}

}  // namespace lockstone::net
