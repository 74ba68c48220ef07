// Spectators: they get the same packets as players, later and less often, and nobody waits for
// them.
#include <algorithm>

#include "net/session/server_impl.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_send_interval_us = 100'000;

}  // namespace

Refusal Server::Impl::judge_spectator() const {
  const bool open = state == ServerState::lobby || state == ServerState::running;
  if (!open) return {RefuseReason::match_running, RefuseField::none, 0, 0};
  const bool room = std::any_of(watchers.begin(), watchers.end(),
                                [](const Watcher& watcher) { return watcher.link == nullptr; });
  if (room) return {};
  return {RefuseReason::match_full, RefuseField::slot, watchers.size(), watchers.size() + 1};
}

void Server::Impl::welcome_spectator(Link& link) {
  Watcher& watcher = *std::find_if(watchers.begin(), watchers.end(), [](const Watcher& candidate) {
    return candidate.link == nullptr;
  });
  watcher = {};
  watcher.link = &link;
  watcher.last_sent_us = now_us;
  link.slot = k_spectator_slot;
  link.stage = Stage::watching;
  parts.transport->trust(link.connection);
  if (state == ServerState::lobby) {
    send(link, welcome(k_spectator_slot, Entry::lobby));
  } else {
    begin_watching(watcher, link.ticks_stepped);
  }
}

// The newest tick that spectators may see, plus one. After the end there is nothing left to hide.
std::uint64_t Server::Impl::visible_ticks() const {
  if (state >= ServerState::closing) return closed;
  return closed - std::min<std::uint64_t>(closed, config.spectator_delay_ticks);
}

// Called after `closed` ticks.
void Server::Impl::keep_keyframe() {
  const std::uint64_t interval = keyframe_ticks_of(config);
  if (keyframes.capacity() == 0 || closed % interval != 0) return;
  const std::uint64_t number = closed / interval;
  const std::size_t size = parts.simulation->save(SnapshotKind::canonical, keyframes.claim(number));
  keyframes.commit(number, size);
  keyframe_hashes[static_cast<std::size_t>(number % keyframe_hashes.size())] =
      parts.simulation->hash();
}

// From where it was, or the first tick, where all ticks since are still there and not too many.
void Server::Impl::begin_watching(Watcher& watcher, std::uint64_t has) {
  const std::uint64_t visible = visible_ticks();
  const bool kept =
      has == closed ||
      (closed - has < config.history_ticks / 2 + config.spectator_delay_ticks && records.has(has));
  const std::uint64_t worth =
      std::max<std::uint64_t>(keyframe_ticks_of(config), config.history_ticks / 4);
  const bool ticks_alone =
      has <= visible && visible - has < worth && kept && may_go_on(*watcher.link);
  send(*watcher.link, welcome(k_spectator_slot, ticks_alone ? Entry::ticks : Entry::snapshot));
  if (ticks_alone) {
    watcher.ticks_received = has;
  } else {
    load_anew(watcher, 0);
  }
}

void Server::Impl::offer_keyframe(Watcher& watcher) {
  const std::uint64_t number = visible_ticks() / keyframe_ticks_of(config);
  if (!keyframes.has(number)) return;
  watcher.offered = true;
  watcher.keyframed = true;
  watcher.snapshot_sent = 0;
  watcher.ticks_received = number * keyframe_ticks_of(config);
}

void Server::Impl::serve_spectators() {
  if (state == ServerState::lobby || state == ServerState::over) return;
  const std::uint64_t bound = config.spectator_queue_ticks + keyframe_ticks_of(config);
  for (Watcher& watcher : watchers) {
    if (watcher.link == nullptr) continue;
    if (watcher.loading && !watcher.offered) {
      if (keyframes.capacity() > 0) {
        offer_keyframe(watcher);
      } else {
        offer_entry(watcher, k_spectator_slot);
      }
    }
    if (watcher.loading && watcher.offered) send_entry_chunks(watcher);
    const std::uint64_t visible = visible_ticks();
    const std::uint64_t lack = visible - std::min(visible, watcher.ticks_received);
    const bool follows = !watcher.loading || watcher.offered;
    if (follows && lack > bound && state < ServerState::closing) {
      drop(*watcher.link, LeaveReason::too_far_behind);
      continue;
    }
    if (watcher.loading || now_us - watcher.last_sent_us < k_send_interval_us) continue;
    watcher.last_sent_us = now_us;
    Ticks message;
    send_resends(watcher, message);
    send_unconfirmed(watcher, message);
  }
  if (state == ServerState::closing) end_spectators();
}

// They see the end before they hear of it.
void Server::Impl::end_spectators() {
  const std::optional<std::uint64_t> hash = final_hash();
  for (Watcher& watcher : watchers) {
    const bool all_seen = watcher.loading || watcher.ticks_received == closed;
    if (watcher.link == nullptr || watcher.finish_sent || !all_seen) continue;
    watcher.finish_sent = true;
    send(*watcher.link, Finish{finish_reason, closed, hash.has_value(), hash.value_or(0)});
  }
}

}  // namespace lockstone::net
