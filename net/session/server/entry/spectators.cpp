#include "net/session/server/entry/spectators.h"

#include <algorithm>
#include <optional>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::int64_t k_send_interval_us = 100'000;

}  // namespace

Refusal Spectators::judge() const {
  const ServerState state = data_.match.state;
  const bool open = state == ServerState::lobby || state == ServerState::running;
  if (!open) return {RefuseReason::match_running, RefuseField::none, 0, 0};
  const std::size_t places = data_.roster.watchers().size();
  if (data_.roster.watching() < places) return {};
  return {RefuseReason::match_full, RefuseField::slot, places, places + 1};
}

void Spectators::admit(Peer& peer) {
  Watcher* watcher = data_.roster.free_watcher();
  LKS_CHECK(watcher != nullptr);
  *watcher = {};
  watcher->peer = &peer;
  watcher->last_sent_us = data_.match.now_us;
  peer.slot = k_spectator_slot;
  peer.stage = Stage::watching;
  data_.parts.transport->trust(peer.connection);
  if (data_.match.state == ServerState::lobby) {
    data_.peers.tell(peer, welcome_of(data_, k_spectator_slot, Entry::lobby));
  } else {
    welcome_to_running_match(*watcher);
  }
  tell_names(data_, peer);
}

// From where it was, or the first tick, where all ticks since are still there and not too many.
void Spectators::welcome_to_running_match(Watcher& watcher) {
  const Peer& peer = *watcher.peer;
  const ServerConfig& config = data_.config;
  const std::uint64_t has = peer.ticks_stepped;
  const std::uint64_t confirmed = data_.match.confirmed;
  const std::uint64_t visible = data_.visible_ticks();
  const bool kept = has == confirmed ||
                    (confirmed - has < config.history_ticks / 2 + config.spectator_delay_ticks &&
                     data_.records.has(has));
  const std::uint64_t worth =
      std::max<std::uint64_t>(keyframe_ticks_of(config), config.history_ticks / 4);
  const bool ticks_alone =
      has <= visible && visible - has < worth && kept && uses_.entry.has_right_state(peer);
  const Entry way = ticks_alone ? Entry::ticks : Entry::snapshot;
  data_.peers.tell(peer, welcome_of(data_, k_spectator_slot, way));
  if (ticks_alone) {
    watcher.ticks_received = has;
  } else {
    watcher.await_state(0);
  }
}

void Spectators::offer_state(Watcher& watcher) {
  if (uses_.states.keyframes().is_used()) {
    uses_.states.offer_keyframe(watcher);
  } else {
    uses_.states.offer(watcher, k_spectator_slot);
  }
}

bool Spectators::is_too_far_behind(const Watcher& watcher) const {
  const std::uint64_t bound = data_.config.spectator_queue_ticks + keyframe_ticks_of(data_.config);
  const std::uint64_t visible = data_.visible_ticks();
  const std::uint64_t lack = visible - std::min(visible, watcher.ticks_received);
  return watcher.needs_ticks() && lack > bound && data_.match.state < ServerState::closing;
}

void Spectators::serve() {
  const MatchStatus& match = data_.match;
  if (match.state == ServerState::lobby || match.state == ServerState::over) return;
  for (Watcher& watcher : data_.roster.watchers()) {
    if (watcher.peer == nullptr) continue;
    if (watcher.loading && !watcher.offered) offer_state(watcher);
    if (watcher.loading && watcher.offered) uses_.states.send_pieces(watcher);
    if (is_too_far_behind(watcher)) {
      uses_.departures.drop(*watcher.peer, LeaveReason::too_far_behind);
      continue;
    }
    const bool due = match.now_us - watcher.last_sent_us >= k_send_interval_us;
    if (!watcher.loading && due) uses_.sender.send_to(watcher);
  }
  if (match.state == ServerState::closing) tell_end();
}

// They see the end before they hear of it.
void Spectators::tell_end() {
  const std::uint64_t confirmed = data_.match.confirmed;
  const std::optional<std::uint64_t> hash = final_hash(data_);
  for (Watcher& watcher : data_.roster.watchers()) {
    const bool all_seen = watcher.loading || (watcher.ticks_received == confirmed &&
                                              watcher.commands.next == data_.commands.ring().end());
    if (watcher.peer == nullptr || watcher.finish_sent || !all_seen) continue;
    watcher.finish_sent = true;
    data_.peers.tell(*watcher.peer, Finish{data_.match.finish_reason, confirmed, hash.has_value(),
                                           hash.value_or(0)});
  }
}

}  // namespace lockstone::net
