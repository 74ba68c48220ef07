#include "net/session/client/tick_receiver.h"

#include <algorithm>
#include <optional>

#include <lockstone/assert.h>

#include "net/wire/record_coder.h"

namespace lockstone::net {

bool TickReceiver::on_ticks(ByteView packet) {
  // Unreliable, so it may overtake the messages that it presupposes.
  if (!data_.place.seated) return data_.status.state == ClientState::handshaking;
  if (data_.status.state != ClientState::running) return true;
  Ticks message;
  if (decode(packet, data_.game.shape, message) != Status::ok) return false;
  const bool sane = message.hashes_received <= data_.progress.stepped &&
                    message.inputs_received <= message.ticks_confirmed + k_input_window_ticks;
  if (!sane) return false;
  take_acknowledgements(message);
  take_records(message);
  return true;
}

void TickReceiver::take_acknowledgements(const Ticks& message) {
  data_.status.waiting = message.waiting_mask;
  data_.inputs.acknowledge(message.inputs_received);
  std::uint64_t& hashes = data_.progress.hashes_acknowledged;
  hashes = std::max(hashes, message.hashes_received);
  if (message.margin_quarters != k_no_margin && data_.config.adapt_lead) {
    data_.lead.note(message.margin_quarters, message.inputs_received, data_.inputs.sampled(),
                    data_.status.now_us);
  }
}

void TickReceiver::take_records(const Ticks& message) {
  TickBuffer& ticks = data_.ticks;
  const std::uint64_t end = data_.progress.stepped + data_.config.history_ticks;
  RecordReader reader(message.coded, data_.game.shape.record_bytes());
  for (std::uint64_t tick = message.first_tick; tick < message.first_tick + message.count; ++tick) {
    LKS_CHECK(reader.next());  // decode has walked through it
    if (tick < ticks.received() || tick >= end || ticks.has(tick)) continue;
    ticks.put(tick, reader.record());
    data_.progress.news = true;
  }
  for (std::uint64_t tick = ticks.received(); ticks.advance(); ++tick)
    data_.playout.arrived(tick, data_.status.now_us);
}

void TickReceiver::request_missing() {
  const std::int64_t round_trip_us = std::max<std::int64_t>(0, data_.server.stats().round_trip_us);
  const std::optional<Resend> request = data_.ticks.missing(data_.status.now_us, round_trip_us);
  if (!request) return;
  ++data_.stats.resends_requested;
  data_.server.send(*request);
}

}  // namespace lockstone::net
