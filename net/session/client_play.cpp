// Closed ticks in; inputs, hashes and, after a desync, snapshots out.
#include <algorithm>

#include <lockstone/assert.h>

#include "net/session/client_impl.h"
#include "net/session/parts_judge.h"
#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_fast_retry_us = 20'000;
constexpr std::int64_t k_resend_interval_us = 100'000;
constexpr std::int64_t k_gap_patience_us = 30'000;
constexpr std::uint64_t k_max_resend_ticks = 64;
constexpr std::uint64_t k_max_hash_packets = 4;
constexpr int k_dump_chunks_per_update = 8;
constexpr std::uint64_t k_queue_ticks = 4;

}  // namespace

bool Client::Impl::on_ticks(ByteView packet) {
  // Unreliable, so it may overtake the messages that it presupposes.
  if (!seated) return state == ClientState::handshaking;
  if (state != ClientState::running) return true;
  Ticks message;
  if (decode(packet, shape, message) != Status::ok) return false;
  const bool sane = message.hashes_received <= stepped &&
                    message.inputs_received <= message.ticks_closed + k_input_window_ticks;
  if (!sane) return false;
  waiting = message.waiting_mask;
  inputs_acked = std::max(inputs_acked, message.inputs_received);
  sampled = std::max(sampled, inputs_acked);  // no inputs for ticks that the server has replaced
  hashes_acked = std::max(hashes_acked, message.hashes_received);
  if (message.margin_quarters != k_no_margin && config.adapt_lead) {
    lead.note(message.margin_quarters, message.inputs_received, sampled, now_us);
  }
  take_records(message);
  return true;
}

void Client::Impl::take_records(const Ticks& message) {
  RecordReader reader(message.coded, shape.record_bytes());
  for (std::uint64_t tick = message.first_tick; tick < message.first_tick + message.count; ++tick) {
    LKS_CHECK(reader.next());  // decode has walked through it
    if (tick < received || tick >= stepped + config.history_ticks || records.has(tick)) continue;
    records.put(tick, reader.record());
    received_end = std::max(received_end, tick + 1);
    news = true;
  }
  while (records.has(received))
    playout.arrived(received++, now_us);
}

// A client whose hashes nobody acknowledges stops before it loses the snapshots that a report of a
// difference would need.
std::uint64_t Client::Impl::unacknowledged_limit() const {
  const bool keeps = snapshots.keeps_records() || (predicts() && config.snapshot_ticks > 0);
  const std::size_t kept = keeps ? config.snapshot_ticks : config.history_ticks;
  return std::min<std::uint64_t>(kept, config.history_ticks);
}

void Client::Impl::step_ticks(std::uint64_t limit) {
  for (std::uint32_t i = 0; i < config.max_steps_per_update; ++i) {
    const bool unheard = !spectates() && stepped - std::min(stepped, hashes_acked) >= limit;
    if (stepped == received || unheard || !due(stepped)) return;
    if (predicts()) {
      confirm_one();
    } else {
      step_one();
    }
  }
}

// The match is over: all that is here, at once.
void Client::Impl::step_rest() {
  for (std::uint64_t before = stepped + 1; before != stepped;) {
    before = stepped;
    step_ticks(config.history_ticks);
  }
}

// Ticks that queue up are not for an even flow: they are caught up with.
bool Client::Impl::due(std::uint64_t tick) const {
  const bool evenly = config.play_out_evenly && seat.pacing == Pacing::real_time && !predicts();
  const auto depth_ticks = static_cast<std::uint64_t>(playout.depth_us() / tick_us);
  if (!evenly || over || received - stepped > depth_ticks + k_queue_ticks) return true;
  return playout.due(tick, now_us);
}

void Client::Impl::step_one() {
  const RecordInputs inputs(records.find(stepped), shape);
  simulation->step(inputs.view());
  note_parts();
  after_step(simulation->hash());
}

// Called after every step.
void Client::Impl::note_parts() {
  if (simulation->tick() % k_parts_interval_ticks != 0 || spectates()) return;
  state_parts = parts_of(*simulation);
}

// The tick `stepped` has been stepped as it was closed; `hash` is the state after it.
void Client::Impl::after_step(std::uint64_t hash) {
  hashes.push(hash);
  state_hash = hash;
  if (snapshots.keeps_records()) {
    const std::size_t size = simulation->save(SnapshotKind::canonical, snapshots.claim(stepped));
    snapshots.commit(stepped, size);
  }
  news = true;
  const std::uint64_t tick = stepped++;
  if (state_parts.ticks == stepped && state_parts.count > 0 && !spectates()) send(state_parts);
  const RecordInputs inputs(records.find(tick), shape);
  observer->tick_stepped(tick, inputs.view(), hash);
  if (spectates() || tick < std::max<std::uint64_t>(seat.input_delay_ticks, active_tick)) return;
  const InputOrigin origin = inputs.view()[seat.slot].origin;
  if (origin == InputOrigin::received || origin == InputOrigin::absent) return;
  ++stats.substituted_inputs;
  observer->input_replaced(tick);
}

void Client::Impl::sample_inputs() {
  if (active_tick == k_never) return;
  const std::uint64_t target = sample_target();
  for (; sampled < target; ++sampled) {
    const std::span<std::byte> place = own_inputs.claim(sampled);
    std::fill(place.begin(), place.end(), std::byte{0});
    parts.inputs->sample(sampled, place);
    own_inputs.commit(sampled, place.size());
    news = true;
  }
}

// One past the last tick to have an input for. In real time the local clock drives it, so that a
// late packet from the server does not make this player's inputs late as well.
std::uint64_t Client::Impl::sample_target() {
  std::uint64_t reached = received;
  if (seat.pacing == Pacing::real_time) {
    const std::int64_t passed_us = now_us - clock_set_us;
    clock_set_us = now_us;
    clock_us += passed_us + passed_us * lead.trim_ppm() / 1'000'000;
    const auto elapsed_us = static_cast<std::uint64_t>(clock_us - clock_origin_us);
    const std::uint64_t local = clock_tick + elapsed_us * info.tick_rate / 1'000'000;
    if (local > received + config.max_lead_ticks) {
      // The match stalls: keep the sampled inputs, and count again from this tick.
      clock_origin_us = clock_us;
      clock_tick = received;
    } else {
      reached = std::max(reached, local);
    }
  }
  const std::uint64_t target = reached + seat.input_delay_ticks + lead.lead_ticks() + 1;
  return seat.tick_count == 0 ? target : std::min(target, seat.tick_count);
}

// Asks at once for all that lacks between others: one request for each gap would cost as many round
// trips as there are gaps. Packets that were merely overtaken get a moment to arrive. `received`
// itself lacks, so the range that is asked for is never empty.
void Client::Impl::request_missing() {
  if (gap_tick != received || received == received_end) {
    gap_tick = received;
    gap_since_us = now_us;
    return;
  }
  const std::int64_t round_trip_us =
      std::max<std::int64_t>(0, parts.transport->stats(parts.connection).round_trip_us);
  if (now_us - gap_since_us < k_gap_patience_us) return;
  if (now_us - last_resend_us < k_resend_interval_us + round_trip_us) return;
  std::uint64_t end = std::min(received_end, received + k_max_resend_ticks);
  while (records.has(end - 1))
    --end;
  last_resend_us = now_us;
  ++stats.resends_requested;
  send(Resend{received, static_cast<std::uint16_t>(end - received)});
}

void Client::Impl::send_due_inputs() {
  const bool fast = seat.pacing == Pacing::fast;
  const std::int64_t since_us = now_us - last_sent_us;
  const std::int64_t soonest_us = fast ? 0 : tick_us / 2;
  const std::int64_t retry_us = fast ? k_fast_retry_us : tick_us;
  const std::int64_t latest_us = state == ClientState::running ? retry_us : k_keepalive_us;
  if (since_us < soonest_us || (!news && since_us < latest_us)) return;
  last_sent_us = now_us;
  news = false;
  // Of a match that it is not in yet, it knows nothing for certain.
  if (state != ClientState::running) return send(Inputs{}, Channel::unreliable);
  if (spectates()) return send_inputs(stepped);
  std::uint64_t first_hash_tick = hashes_acked;
  for (std::uint64_t i = 0; i < k_max_hash_packets; ++i) {
    send_inputs(first_hash_tick);
    first_hash_tick += k_max_hashes_per_message;
    if (first_hash_tick >= stepped) return;
  }
}

void Client::Impl::send_inputs(std::uint64_t first_hash_tick) {
  Inputs message;
  message.ticks_received = received;
  message.first_hash_tick = first_hash_tick;
  const std::uint64_t hash_end = std::min(stepped, first_hash_tick + k_max_hashes_per_message);
  for (std::uint64_t tick = first_hash_tick; tick < hash_end; ++tick) {
    message.hashes[message.hash_count++] = hashes.at(tick);
  }
  const std::size_t room_bytes =
      coded.size() - k_inputs_header_bytes - std::size_t{message.hash_count} * 8;
  RecordWriter writer(std::span<std::byte>(coded).first(room_bytes), info.input_bytes);
  message.first_tick = inputs_acked;
  const std::uint64_t end = active_tick == k_never ? inputs_acked : sampled;
  for (std::uint64_t tick = inputs_acked; tick < end; ++tick) {
    const bool full = message.count == k_max_ticks_per_message;
    if (full || !own_inputs.has(tick) || !writer.add(own_inputs.find(tick))) break;
    ++message.count;
  }
  message.coded = writer.written();
  send(message, Channel::unreliable);
}

bool Client::Impl::on_dump_request(ByteView packet) {
  DumpRequest request;
  if (decode(packet, request) != Status::ok || state != ClientState::running) return false;
  if (request.tick >= stepped) return false;
  dump_tick = request.tick;
  dump_sent = 0;
  dump_size = predicts() ? dump_kept_state(request.tick + 1) : 0;
  const ByteView kept = snapshots.find(request.tick);
  if (!kept.empty()) {
    std::copy(kept.begin(), kept.end(), dump.begin());
    dump_size = kept.size();
  }
  if (dump_size == 0) send(Dump{request.tick, 0, 0, {}});
  return true;
}

// The canonical form of the state that was kept after this many ticks; 0: not kept.
std::size_t Client::Impl::dump_kept_state(std::uint64_t ticks) {
  const ByteView kept = states.find(ticks);
  if (kept.empty() || dump.empty()) return 0;
  LKS_CHECK(simulation->load(SnapshotKind::native, kept) == Status::ok);
  const std::size_t size = simulation->save(SnapshotKind::canonical, dump);
  LKS_CHECK(simulation->load(SnapshotKind::native, states.find(head)) == Status::ok);
  return size;
}

void Client::Impl::send_dump_chunks() {
  for (int i = 0; i < k_dump_chunks_per_update && dump_sent < dump_size; ++i) {
    const std::size_t size = std::min(k_max_chunk_bytes, dump_size - dump_sent);
    send(Dump{dump_tick, static_cast<std::uint32_t>(dump_size),
              static_cast<std::uint32_t>(dump_sent), ByteView(dump).subspan(dump_sent, size)});
    dump_sent += size;
  }
}

}  // namespace lockstone::net
