// Entering a match that runs: late players, those who come back, those whose state was wrong.
//
// A player that enters gets the canonical snapshot of an agreed state, then the ticks since. A
// server that simulates takes it from itself, a relay from a donor. When the newcomer has caught
// up, the tick from which on it plays is announced. Nobody else waits.
#include <algorithm>

#include "net/session/server_impl.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_donor_patience_us = 1'000'000;
constexpr std::int64_t k_chunk_burst_us = 100'000;
constexpr unsigned k_max_bad_snapshots = 3;
constexpr std::uint64_t k_max_round_trip_ticks = 30;

}  // namespace

void Server::Impl::enter(std::uint8_t slot, const Link& link) {
  Seat& place = seats[slot];
  ++place.stats.entries;
  place.active_tick = k_never;
  place.inputs_next = 0;
  place.margin = k_no_margin;
  const std::uint64_t has = link.ticks_stepped;
  const bool ticks_alone = has <= closed && closed - has < config.history_ticks / 2 &&
                           (has == closed || records.has(has)) && may_go_on(link);
  send(link, welcome(slot, ticks_alone ? Entry::ticks : Entry::snapshot));
  if (ticks_alone) {
    place.ticks_received = has;
    judge.restart(slot, has);
  } else {
    load_anew(place, 0);
  }
  if (paused) send(link, Paused{true});
}

// Its state is the match's: not one that was wrong, nor one of ticks that a server closed which was
// killed before it had them in its log. A relay that knows no better believes it.
bool Server::Impl::may_go_on(const Link& link) const {
  if (link.ticks_stepped == 0) return true;
  const std::uint64_t last = link.ticks_stepped - 1;
  if (!judge.knows_right_hash(last)) return parts.simulation == nullptr;
  return judge.right_hash(last) == link.state_hash;
}

// The player goes on from the right state; until then its slot is absent.
void Server::Impl::resync(std::uint8_t slot) {
  Seat& place = seats[slot];
  place.condemned = false;
  ++counters.resyncs;
  load_anew(place, closed);
}

void Server::Impl::load_anew(Follower& follower, std::uint64_t oldest_ticks) {
  follower.loading = true;
  follower.offered = false;
  follower.oldest_entry = oldest_ticks;
}

bool Server::Impl::entry_in_use() const {
  const auto uses = [](const Follower& follower) {
    return follower.link != nullptr && follower.offered && !follower.keyframed;
  };
  return std::any_of(seats.begin(), seats.end(), uses) ||
         std::any_of(watchers.begin(), watchers.end(), uses);
}

void Server::Impl::advance_entries() {
  if (entry.fetching) take_fetched_entry();
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    Seat& place = seats[slot];
    if (place.link == nullptr || place.condemned) continue;
    if (place.loading && !place.offered) offer_entry(place, slot);
    if (place.loading && place.offered) send_entry_chunks(place);
    if (!place.loading && place.active_tick == k_never) try_activate(slot);
  }
}

// One state serves all who enter while it is young.
void Server::Impl::offer_entry(Follower& follower, std::uint8_t slot) {
  const bool young = entry.ready && entry.ticks >= follower.oldest_entry &&
                     closed - entry.ticks < config.history_ticks / 4;
  if (!young && entry_in_use()) return;
  const bool agreed = judge.judged_ticks() >= follower.oldest_entry;
  if (!young && parts.simulation == nullptr && !agreed) return;
  if (!young) capture_entry();
  if (!entry.ready || entry.ticks < follower.oldest_entry) return;
  follower.offered = true;
  follower.keyframed = false;
  follower.snapshot_sent = 0;
  follower.ticks_received = entry.ticks;
  follower.cursor = 0;
  if (slot < seats.size()) judge.restart(slot, entry.ticks);
}

void Server::Impl::capture_entry() {
  if (parts.simulation == nullptr) return fetch_entry();
  entry.ticks = closed;
  entry.hash = parts.simulation->hash();
  entry.size = parts.simulation->save(SnapshotKind::canonical, entry.bytes);
  entry.ready = true;
}

// Asks one player after another for the newest state that all agreed on.
void Server::Impl::fetch_entry() {
  entry.ready = false;
  const std::uint64_t agreed = judge.judged_ticks();
  if (entry.fetching || agreed == 0) return;
  for (std::size_t i = 0; i < seats.size(); ++i) {
    const auto donor = static_cast<std::uint8_t>(entry.next_donor++ % seats.size());
    const Seat& place = seats[donor];
    if (place.link == nullptr || place.active_tick > closed || dumps(donor)) continue;
    entry.fetching = true;
    entry.since_us = now_us;
    entry.ticks = agreed;
    entry.hash = judge.right_hash(agreed - 1);
    request_dump(entry.transfer, donor, agreed - 1);
    return;
  }
}

// A donor that is gone, too slow, or no longer has it: the next one is asked.
void Server::Impl::take_fetched_entry() {
  const bool gone = seats[entry.transfer.slot].link == nullptr;
  const bool late = now_us - entry.since_us > k_donor_patience_us + config.timeouts.dump_us;
  if (!entry.transfer.done && !gone && !late) return;
  entry.fetching = false;
  entry.ready = entry.transfer.done && !entry.transfer.bytes.empty();
  if (!entry.ready) return;
  entry.bytes = std::move(entry.transfer.bytes);
  entry.size = entry.bytes.size();
  entry.transfer = {};
}

ByteView Server::Impl::entry_bytes(const Follower& follower) const {
  if (follower.keyframed) {
    return keyframes.find(follower.ticks_received / keyframe_ticks_of(config));
  }
  const bool same = entry.ready && entry.ticks == follower.ticks_received;
  return same ? ByteView(entry.bytes).first(entry.size) : ByteView{};
}

// As fast as configured, all newcomers together.
void Server::Impl::send_entry_chunks(Follower& follower) {
  const ByteView bytes = entry_bytes(follower);
  if (bytes.empty()) return load_anew(follower, 0);
  chunks_until_us = std::max(chunks_until_us, now_us - k_chunk_burst_us);
  while (chunks_until_us <= now_us && follower.snapshot_sent < bytes.size()) {
    Snapshot message;
    message.ticks = follower.ticks_received;
    message.hash = follower.keyframed
                       ? keyframe_hashes[static_cast<std::size_t>(
                             message.ticks / keyframe_ticks_of(config) % keyframe_hashes.size())]
                       : entry.hash;
    message.total_bytes = static_cast<std::uint32_t>(bytes.size());
    message.offset_bytes = static_cast<std::uint32_t>(follower.snapshot_sent);
    message.chunk = bytes.subspan(
        follower.snapshot_sent, std::min(k_max_chunk_bytes, bytes.size() - follower.snapshot_sent));
    const std::size_t size = encode(message, out);
    const Status status = parts.transport->send(follower.link->connection, Channel::reliable,
                                                ByteView(out).first(size));
    if (status != Status::ok) return;  // its queue is full: later
    follower.snapshot_sent += message.chunk.size();
    chunks_until_us += static_cast<std::int64_t>(message.chunk.size() * std::uint64_t{1'000'000} /
                                                 config.entry_bytes_per_s);
  }
}

Server::Impl::Follower* Server::Impl::follower_of(const Link& link) {
  if (link.slot < seats.size()) return &seats[link.slot];
  const auto found =
      std::find_if(watchers.begin(), watchers.end(),
                   [&link](const Watcher& watcher) { return watcher.link == &link; });
  return found == watchers.end() ? nullptr : &*found;
}

bool Server::Impl::on_snapshot_taken(Link& link, ByteView packet) {
  SnapshotTaken message;
  if (decode(packet, message) != Status::ok) return false;
  Follower* follower = follower_of(link);
  if (follower == nullptr || !follower->offered) return false;
  if (message.ticks != follower->ticks_received) return true;  // an earlier one
  follower->offered = false;
  if (message.good) {
    follower->loading = false;
    return true;
  }
  // The server's own snapshot is good, whatever one player says.
  const bool own = parts.simulation != nullptr;
  if (!own) entry.ready = false;
  if (++follower->bad_snapshots < k_max_bad_snapshots) {
    load_anew(*follower, entry.ticks + 1);
  } else if (own && link.slot < seats.size()) {
    expel(link.slot, LeaveReason::desync);
  } else {
    drop(link, LeaveReason::desync);
  }
  return true;
}

// Caught up: there will be time for its first input to arrive.
void Server::Impl::try_activate(std::uint8_t slot) {
  Seat& place = seats[slot];
  const std::uint64_t lag = std::max<std::uint64_t>(info.tick_rate / 4, 2);
  const std::int64_t round_trip_us = parts.transport->stats(place.link->connection).round_trip_us;
  const auto trip_ticks =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, round_trip_us) / tick_us);
  if (closed - place.ticks_received > lag + trip_ticks) return;
  place.active_tick =
      closed + config.input_delay_ticks + lag + std::min(trip_ticks, k_max_round_trip_ticks);
  place.inputs_next = place.active_tick;
  place.inputs.clear();  // of a former life, which was ahead
  judge.set_present(slot, true);
  for (const Link& link : links) {
    if (link.stage >= Stage::seated) send(link, Activate{slot, place.active_tick});
  }
  observer->player_active(slot, place.active_tick);
}

void Server::Impl::set_paused(bool pause) {
  if (state > ServerState::running || pause == paused) return;
  paused = pause;
  waiting = 0;
  if (state == ServerState::running) rebase_schedule(now_us + tick_us);
  for (const Link& link : links) {
    if (link.stage >= Stage::seated) send(link, Paused{paused});
  }
}

bool Server::Impl::on_ask(const Link& link, ByteView packet) {
  Ask ask;
  if (decode(packet, ask) != Status::ok) return false;
  if (state <= ServerState::running && !seats[link.slot].condemned) {
    observer->player_asks(link.slot, ask.kind, ask.topic, ask.choice);
  }
  return true;
}

}  // namespace lockstone::net
