// Inputs in, closed ticks out.
#include <algorithm>

#include <lockstone/assert.h>

#include "net/session/server_impl.h"
#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr std::uint64_t k_max_closes_per_update = 256;
constexpr std::int64_t k_max_catch_up_us = 250'000;  // a longer pause is not played faster after
constexpr int k_resends_per_update = 4;
constexpr std::uint64_t k_owed_hashes = 64;  // more than these are not merely on their way

}  // namespace

bool Server::Impl::on_inputs(Link& link, ByteView packet) {
  Inputs message;
  if (decode(packet, info.input_bytes, message) != Status::ok) return false;
  const std::uint64_t hash_end = message.first_hash_tick + message.hash_count;
  if (message.ticks_received > closed || hash_end > message.ticks_received) return false;
  if (link.slot >= seats.size()) return take_spectators_word(link, message);
  Seat& place = seats[link.slot];
  const bool sane = message.first_tick + message.count <= closed + k_input_window_ticks &&
                    (message.first_tick <= place.inputs_next || place.active_tick == k_never);
  if (!sane) return false;
  place.confirmed = true;
  if (state >= ServerState::closing || place.loading) return true;
  place.ticks_received = std::max(place.ticks_received, message.ticks_received);
  take_inputs(place, message);
  take_hashes(link.slot, message);
  return true;
}

bool Server::Impl::take_spectators_word(const Link& link, const Inputs& message) {
  Follower* follower = follower_of(link);
  if (follower == nullptr || message.count > 0 || message.hash_count > 0) return false;
  if (!follower->loading) {
    follower->ticks_received = std::max(follower->ticks_received, message.ticks_received);
  }
  return true;
}

void Server::Impl::take_inputs(Seat& place, const Inputs& message) {
  RecordReader reader(message.coded, info.input_bytes);
  for (std::uint64_t tick = message.first_tick; tick < message.first_tick + message.count; ++tick) {
    LKS_CHECK(reader.next());  // decode has walked through it
    const bool recent = tick + k_input_window_ticks > closed;
    const bool own = tick >= config.input_delay_ticks && tick >= place.active_tick;
    if (!recent || !own || place.inputs.has(tick)) continue;
    note_margin(place, tick);
    if (tick < place.inputs_next) ++place.stats.late_inputs;
    place.inputs.put(tick, reader.record());
    place.inputs_next = std::max(place.inputs_next, tick + 1);
  }
}

// How early an input came for its tick, by the schedule.
void Server::Impl::note_margin(Seat& place, std::uint64_t tick) {
  if (config.pacing == Pacing::fast) return;
  const auto ahead = static_cast<std::int64_t>(tick) - static_cast<std::int64_t>(schedule_tick);
  const std::int64_t due = schedule_due_us + ahead * 1'000'000 / info.tick_rate;
  const std::int64_t quarters = (due - now_us) * 4 / tick_us;
  const auto margin = static_cast<std::int8_t>(std::clamp<std::int64_t>(quarters, -127, 127));
  place.margin = place.margin == k_no_margin ? margin : std::min(place.margin, margin);
  place.stats.margin_quarters = margin;
}

void Server::Impl::take_hashes(std::uint8_t slot, const Inputs& message) {
  for (std::size_t i = 0; i < message.hash_count; ++i) {
    if (message.first_hash_tick + i != judge.wanted(slot)) continue;
    if (!judge.can_push(slot)) return;  // not acknowledged, so it comes again
    judge.push(slot, message.hashes[i]);
  }
}

bool Server::Impl::on_resend(Link& link, ByteView packet) {
  Resend message;
  if (decode(packet, message) != Status::ok) return false;
  if (message.first_tick + message.count > closed) return false;
  Follower* follower = follower_of(link);
  if (follower == nullptr) return false;
  if (link.slot < seats.size()) ++seats[link.slot].stats.resends;
  follower->resend_next = std::max(message.first_tick, follower->ticks_received);
  follower->resend_end = message.first_tick + message.count;
  return true;
}

void Server::Impl::close_due_ticks() {
  for (std::uint64_t i = 0; i < k_max_closes_per_update && !frozen(); ++i) {
    if (closed == end_tick) return begin_finishing();
    if (!may_close_next()) break;
    close_tick();
    if (state != ServerState::running) return;
  }
  if (waiting != 0 && now_us - waiting_since_us > config.timeouts.drop_us) drop_waited_for();
}

// Notes the missing players, if only the wait for them keeps the next tick open.
bool Server::Impl::may_close_next() {
  const bool fast = config.pacing == Pacing::fast;
  if (paused || !anybody_plays() || awaits_players()) return false;
  if (!fast && now_us < due_us()) return false;
  const bool waits = fast || config.late_policy == LatePolicy::strict;
  const auto missing =
      static_cast<std::uint16_t>(waits ? missing_inputs_mask() | laggards_mask() : 0);
  if (missing != 0 && waiting == 0) waiting_since_us = now_us;
  waiting = missing;
  if (missing != 0) return false;
  if (!fast && now_us - due_us() > k_max_catch_up_us) rebase_schedule(now_us);
  return true;
}

std::uint16_t Server::Impl::missing_inputs_mask() const {
  unsigned mask = 0;
  for (std::size_t slot = 0; slot < seats.size(); ++slot) {
    const Seat& place = seats[slot];
    const bool plays = place.link != nullptr && place.active_tick <= closed;
    if (plays && place.inputs_next <= closed) mask |= 1U << slot;
  }
  return static_cast<std::uint16_t>(mask);
}

// A match in which nobody has a say stands still.
bool Server::Impl::anybody_plays() const {
  return std::any_of(seats.begin(), seats.end(), [](const Seat& place) {
    return place.link != nullptr && place.active_tick != k_never;
  });
}

// Where the match may wait, it does so before a player loses ticks or snapshots. For newcomers it
// waits only if nothing else would slow it down. A player that holds it without a sign of progress
// is dropped in the end, as one that sends no inputs is.
std::uint16_t Server::Impl::laggards_mask() const {
  unsigned mask = 0;
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    if (!follows(seats[slot])) continue;
    const bool plays = seats[slot].active_tick <= closed;
    if (!plays && config.pacing != Pacing::fast) continue;
    const std::uint64_t has = std::min(seats[slot].ticks_received, judge.wanted(slot));
    if (closed - has >= config.history_ticks / 2) mask |= 1U << slot;
  }
  return static_cast<std::uint16_t>(mask);
}

// It has a state, or is being sent one, and so needs every tick from there on.
bool Server::Impl::follows(const Seat& place) const {
  return place.link != nullptr && (!place.loading || place.offered);
}

void Server::Impl::drop_waited_for() {
  const std::uint16_t mask = waiting;
  waiting = 0;
  for (Seat& place : seats) {
    if (place.link == nullptr || ((mask >> place.link->slot) & 1) == 0) continue;
    // A state that is still being sent is no fault of its receiver.
    if (place.loading && place.snapshot_sent < entry_bytes(place).size()) continue;
    drop(*place.link, LeaveReason::timed_out);
  }
}

void Server::Impl::close_tick() {
  drop_laggards();
  if (state != ServerState::running) return;
  const std::span<std::byte> record = records.claim(closed);
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot)
    fill_slot(record, slot);
  records.commit(closed, record.size());
  const std::optional<std::uint64_t> hash = step_simulation(record);
  const std::uint64_t tick = closed++;
  if (parts.simulation != nullptr) keep_keyframe();
  observer->tick_closed(tick, RecordInputs(record, shape).view(), hash);
}

// The server never waits for them (deadline), so they would ask for ticks that are gone.
void Server::Impl::drop_laggards() {
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    if (!follows(seats[slot])) continue;
    const std::uint64_t has = std::min(seats[slot].ticks_received, judge.wanted(slot));
    if (closed - has + 1 < config.history_ticks) continue;
    if (closed - seats[slot].ticks_received < config.history_ticks / 4) {
      expel(slot, LeaveReason::no_hashes);  // it has the ticks, but does not report their hashes
    } else {
      drop(*seats[slot].link, LeaveReason::too_far_behind);
    }
  }
}

// A player that takes ticks owes the hashes of the states after them: without these nobody could be
// judged, and in a relay nobody else either.
void Server::Impl::drop_secretive() {
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    Seat& place = seats[slot];
    if (place.link == nullptr || place.loading) continue;
    const std::uint64_t had = judge.wanted(slot);
    const bool owes = place.ticks_received > had + k_owed_hashes && judge.can_push(slot);
    if (!owes || had != place.hashes_had) {
      place.hashes_had = had;
      place.hashes_since_us = now_us;
    } else if (now_us - place.hashes_since_us > config.timeouts.drop_us) {
      expel(slot, LeaveReason::no_hashes);
    }
  }
}

void Server::Impl::fill_slot(std::span<std::byte> record, std::uint8_t slot) {
  constexpr std::array<std::byte, k_max_input_bytes> k_zeros{};
  const ByteView zeros = ByteView(k_zeros).first(info.input_bytes);
  Seat& place = seats[slot];
  if (place.link == nullptr || closed < place.active_tick)
    return set_slot(record, shape, slot, InputOrigin::absent, zeros);
  if (closed < config.input_delay_ticks) {
    return set_slot(record, shape, slot, InputOrigin::neutral, zeros);
  }
  if (place.inputs_next > closed) {
    return set_slot(record, shape, slot, InputOrigin::received, place.inputs.find(closed));
  }
  place.inputs_next = closed + 1;
  ++place.stats.substituted_inputs;
  if (config.substitute == Substitute::neutral) {
    return set_slot(record, shape, slot, InputOrigin::neutral, zeros);
  }
  const ByteView before = closed == 0 ? ByteView{} : records.find(closed - 1);
  const ByteView last = before.empty() ? zeros : get_slot(before, shape, slot).bytes;
  set_slot(record, shape, slot, InputOrigin::repeated, last);
}

std::optional<std::uint64_t> Server::Impl::step_simulation(ByteView record) {
  if (parts.simulation == nullptr) return std::nullopt;
  parts.simulation->step(RecordInputs(record, shape).view());
  note_own_parts();
  const std::uint64_t hash = parts.simulation->hash();
  judge.push_own(hash);
  if (snapshots.capacity() > 0) {
    const std::size_t size =
        parts.simulation->save(SnapshotKind::canonical, snapshots.claim(closed));
    snapshots.commit(closed, size);
  }
  return hash;
}

// From now on `closed` is due at `due_us`, and the ticks after it by the tick rate.
void Server::Impl::rebase_schedule(std::int64_t due_us) {
  schedule_tick = closed;
  schedule_due_us = due_us;
}

std::int64_t Server::Impl::due_us() const {
  const std::uint64_t ticks = closed - schedule_tick;
  return schedule_due_us + static_cast<std::int64_t>(ticks * 1'000'000 / info.tick_rate);
}

void Server::Impl::send_due_ticks() {
  if (state >= ServerState::closing) return;
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    Seat& place = seats[slot];
    if (place.link == nullptr || place.loading) continue;
    Ticks message;
    message.inputs_received = place.inputs_next;
    message.hashes_received = judge.wanted(slot);
    message.margin_quarters = place.margin;
    send_resends(place, message);
    if (!ticks_due(place)) continue;
    place.last_sent_closed = closed;
    place.last_sent_us = now_us;
    place.margin = k_no_margin;
    send_unconfirmed(place, message);
  }
}

// All ticks that the player has not confirmed. Those that do not fit into one datagram are spread
// over the next ones in turn, and the newest ticks go along, so that they wait for nothing. If
// ticks still lack between others, the client asks for them.
void Server::Impl::send_unconfirmed(Follower& follower, Ticks& message) {
  const std::uint64_t all = end_for(follower);
  const std::uint64_t first = std::min(all, std::max(follower.cursor, follower.ticks_received));
  const std::uint64_t end = send_ticks(follower, first, Channel::unreliable, message);
  follower.cursor = end < all ? end : 0;
  if (end == all) return;
  message.margin_quarters = k_no_margin;
  send_ticks(follower, std::max(end, all - (end - first)), Channel::unreliable, message);
}

// The ticks below are for it to see.
std::uint64_t Server::Impl::end_for(const Follower& follower) const {
  const bool watches = follower.link->stage == Stage::watching;
  return watches ? std::max(visible_ticks(), follower.ticks_received) : closed;
}

// A player that has fallen silent gets less: its link may be down, and nothing confirms the packets
// that it got.
bool Server::Impl::ticks_due(const Seat& place) const {
  const std::int64_t since_us = now_us - place.last_sent_us;
  const bool quiet =
      state == ServerState::lobby || place.link->watch.silent_us(now_us) > k_keepalive_us;
  if (quiet) return since_us >= k_keepalive_us;
  return place.last_sent_closed != closed || since_us >= tick_us;
}

// Sends ticks from `first_tick` on, as many as one datagram holds; returns the first not sent.
std::uint64_t Server::Impl::send_ticks(const Follower& follower, std::uint64_t first_tick,
                                       Channel channel, Ticks& message) {
  const std::uint64_t all = end_for(follower);
  const std::span<std::byte> room = std::span(coded).first(coded.size() - k_ticks_header_bytes);
  RecordWriter writer(room, shape.record_bytes());
  std::uint64_t end = first_tick;
  while (end < all && end - first_tick < k_max_ticks_per_message) {
    const ByteView record = records.find(end);
    if (record.empty() || !writer.add(record)) break;
    ++end;
  }
  message.first_tick = first_tick;
  message.count = static_cast<std::uint8_t>(end - first_tick);
  message.ticks_closed = all;
  message.waiting_mask = waiting;
  message.coded = writer.written();
  const std::size_t size = encode(message, out);
  static_cast<void>(
      parts.transport->send(follower.link->connection, channel, ByteView(out).first(size)));
  return end;
}

void Server::Impl::send_resends(Follower& follower, Ticks& message) {
  for (int i = 0; i < k_resends_per_update && follower.resend_next < follower.resend_end; ++i) {
    const std::uint64_t end =
        send_ticks(follower, follower.resend_next, Channel::reliable, message);
    if (end == follower.resend_next) follower.resend_end = end;  // gone from the ring
    follower.resend_next = end;
    message.margin_quarters = k_no_margin;
  }
}

}  // namespace lockstone::net
