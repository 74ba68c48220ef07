#include "net/session/server/data/tick_sender.h"

#include <algorithm>
#include <span>

#include <lockstone/assert.h>

#include "net/wire/record_coder.h"

namespace lockstone::net {
namespace {

constexpr int k_resends_per_update = 4;

}  // namespace

void TickSender::send_to_players() {
  const MatchStatus& match = data_.match;
  if (match.state >= ServerState::closing) return;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    Seat& seat = data_.roster.seat(slot);
    if (seat.peer == nullptr || seat.loading) continue;
    Ticks message;
    message.inputs_received = seat.inputs_next;
    message.hashes_received = data_.judge.wanted(slot);
    message.margin_quarters = seat.margin;
    send_resends(seat, message);
    if (!is_due(seat)) continue;
    seat.last_sent_confirmed = match.confirmed;
    seat.last_sent_us = match.now_us;
    seat.margin = k_no_margin;
    send_unconfirmed(seat, message);
  }
}

void TickSender::send_to(Watcher& watcher) {
  watcher.last_sent_us = data_.match.now_us;
  Ticks message;
  send_resends(watcher, message);
  send_unconfirmed(watcher, message);
}

bool TickSender::on_resend(const Peer& peer, ByteView packet) {
  Resend message;
  if (decode(packet, message) != Status::ok) return false;
  if (message.first_tick + message.count > data_.match.confirmed) return false;
  Follower* follower = data_.roster.follower_of(peer);
  if (follower == nullptr) return false;
  if (data_.roster.is_slot(peer.slot)) ++data_.roster.seat(peer.slot).stats.resends;
  follower->resend_next = std::max(message.first_tick, follower->ticks_received);
  follower->resend_end = message.first_tick + message.count;
  return true;
}

// All ticks that the follower has not confirmed. Those that do not fit into one datagram are spread
// over the next ones in turn, and the newest ticks go along, so that they wait for nothing. If
// ticks still lack between others, the client asks for them.
void TickSender::send_unconfirmed(Follower& follower, Ticks& message) {
  const std::uint64_t all = end_for(follower);
  const std::uint64_t first = std::min(all, std::max(follower.cursor, follower.ticks_received));
  const std::uint64_t end = send_ticks(follower, first, Channel::unreliable, message);
  follower.cursor = end < all ? end : 0;
  if (end == all) return;
  message.margin_quarters = k_no_margin;
  send_ticks(follower, std::max(end, all - (end - first)), Channel::unreliable, message);
}

// The ticks below are for it to see.
std::uint64_t TickSender::end_for(const Follower& follower) const {
  const bool watches = follower.peer->stage == Stage::watching;
  return watches ? std::max(data_.visible_ticks(), follower.ticks_received) : data_.match.confirmed;
}

// A player that has fallen silent gets less: its connection may be down, and nothing confirms the
// packets that it got.
bool TickSender::is_due(const Seat& seat) const {
  const MatchStatus& match = data_.match;
  const std::int64_t since_us = match.now_us - seat.last_sent_us;
  const bool silent = seat.peer->watch.silent_us(match.now_us) > k_keepalive_us;
  if (match.state == ServerState::lobby || silent) return since_us >= k_keepalive_us;
  return seat.last_sent_confirmed != match.confirmed || since_us >= data_.tick_us;
}

// Sends ticks from `first_tick` on, as many as one datagram holds; returns the first not sent.
std::uint64_t TickSender::send_ticks(const Follower& follower, std::uint64_t first_tick,
                                     Channel channel, Ticks& message) {
  const std::uint64_t all = end_for(follower);
  const std::span<std::byte> space = std::span(coded_).first(coded_.size() - k_ticks_header_bytes);
  RecordWriter writer(space, data_.shape.record_bytes());
  std::uint64_t end = first_tick;
  while (end < all && end - first_tick < k_max_ticks_per_message) {
    const ByteView record = data_.records.find(end);
    if (record.empty() || !writer.add(record)) break;
    ++end;
  }
  message.first_tick = first_tick;
  message.count = static_cast<std::uint8_t>(end - first_tick);
  message.ticks_confirmed = all;
  message.waiting_mask = data_.match.waiting;
  message.coded = writer.written();
  // A datagram that the transport does not take is lost like any other.
  static_cast<void>(data_.peers.send(*follower.peer, message, channel));
  return end;
}

void TickSender::send_resends(Follower& follower, Ticks& message) {
  for (int i = 0; i < k_resends_per_update && follower.resend_next < follower.resend_end; ++i) {
    const std::uint64_t end =
        send_ticks(follower, follower.resend_next, Channel::reliable, message);
    if (end == follower.resend_next) follower.resend_end = end;  // gone from the ring
    follower.resend_next = end;
    message.margin_quarters = k_no_margin;
  }
}

}  // namespace lockstone::net
