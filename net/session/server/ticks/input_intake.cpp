#include "net/session/server/ticks/input_intake.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {

bool InputIntake::on_inputs(Peer& peer, ByteView packet) {
  Inputs message;
  if (decode(packet, data_.info.input_bytes, message) != Status::ok) return false;
  const MatchStatus& match = data_.match;
  const std::uint64_t hash_end = message.first_hash_tick + message.hash_count;
  if (message.ticks_received > match.confirmed || hash_end > message.ticks_received) return false;
  if (!data_.roster.is_slot(peer.slot)) return take_progress(peer, message);
  Seat& seat = data_.roster.seat(peer.slot);
  const bool sane = message.first_tick + message.count <= match.confirmed + k_input_window_ticks &&
                    (message.first_tick <= seat.inputs_next || seat.active_tick == k_never);
  if (!sane) return false;
  seat.confirmed = true;
  if (match.state >= ServerState::closing || seat.loading) return true;
  seat.ticks_received = std::max(seat.ticks_received, message.ticks_received);
  take_inputs(seat, message);
  take_hashes(peer.slot, message);
  return true;
}

// Of a spectator: it reports neither inputs nor hashes.
bool InputIntake::take_progress(const Peer& peer, const Inputs& message) {
  Follower* follower = data_.roster.follower_of(peer);
  if (follower == nullptr || message.count > 0 || message.hash_count > 0) return false;
  if (!follower->loading) {
    follower->ticks_received = std::max(follower->ticks_received, message.ticks_received);
  }
  return true;
}

void InputIntake::take_inputs(Seat& seat, const Inputs& message) {
  RecordReader reader(message.coded, data_.info.input_bytes);
  for (std::uint64_t tick = message.first_tick; tick < message.first_tick + message.count; ++tick) {
    LKS_CHECK(reader.next());  // decode has walked through it
    const bool recent = tick + k_input_window_ticks > data_.match.confirmed;
    const bool own = tick >= data_.config.input_delay_ticks && tick >= seat.active_tick;
    if (!recent || !own || seat.inputs.has(tick)) continue;
    note_margin(seat, tick);
    if (tick < seat.inputs_next) ++seat.stats.late_inputs;
    seat.inputs.put(tick, reader.record());
    seat.inputs_next = std::max(seat.inputs_next, tick + 1);
  }
}

// How early an input came for its tick, by the schedule.
void InputIntake::note_margin(Seat& seat, std::uint64_t tick) const {
  if (data_.config.pacing == Pacing::fast) return;
  const std::int64_t early_us = data_.schedule.due_us(tick) - data_.match.now_us;
  const std::int64_t quarters = early_us * 4 / data_.tick_us;
  const auto margin = static_cast<std::int8_t>(std::clamp<std::int64_t>(quarters, -127, 127));
  seat.margin = seat.margin == k_no_margin ? margin : std::min(seat.margin, margin);
  seat.stats.margin_quarters = margin;
}

void InputIntake::take_hashes(std::uint8_t slot, const Inputs& message) {
  HashJudge& judge = data_.judge;
  for (std::size_t i = 0; i < message.hash_count; ++i) {
    if (message.first_hash_tick + i != judge.wanted(slot)) continue;
    if (!judge.can_push(slot)) return;  // not acknowledged, so it comes again
    judge.push(slot, message.hashes[i]);
  }
}

void InputIntake::fill_next(std::span<std::byte> record) {
  std::fill(record.begin(), record.end(), std::byte{0});  // bits that belong to no slot
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot)
    fill_slot(record, slot);
}

void InputIntake::fill_slot(std::span<std::byte> record, std::uint8_t slot) {
  constexpr std::array<std::byte, k_max_input_bytes> k_zeros{};
  const ByteView zeros = ByteView(k_zeros).first(data_.info.input_bytes);
  const TickShape shape = data_.shape;
  const std::uint64_t tick = data_.match.confirmed;
  Seat& seat = data_.roster.seat(slot);
  if (!seat.plays(tick)) return set_slot(record, shape, slot, InputOrigin::absent, zeros);
  if (tick < data_.config.input_delay_ticks) {
    return set_slot(record, shape, slot, InputOrigin::neutral, zeros);
  }
  if (seat.inputs_next > tick) {
    LKS_ASSERT(seat.inputs.has(tick));
    return set_slot(record, shape, slot, InputOrigin::received, seat.inputs.find(tick));
  }
  seat.inputs_next = tick + 1;
  ++seat.stats.substituted_inputs;
  if (data_.config.substitute == Substitute::neutral) {
    return set_slot(record, shape, slot, InputOrigin::neutral, zeros);
  }
  const ByteView before = tick == 0 ? ByteView{} : data_.records.find(tick - 1);
  const ByteView last = before.empty() ? zeros : get_slot(before, shape, slot).bytes;
  set_slot(record, shape, slot, InputOrigin::repeated, last);
}

}  // namespace lockstone::net
