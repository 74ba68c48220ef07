// Rollback: the simulation runs ahead of the closed ticks on guesses, and goes back when one was
// wrong. Only closed ticks are hashed for the server and told as stepped.
//
// The scheme is that of GGPO (Tony Cannon, "Fight the Lag! The Trick Behind GGPO's Low-Latency
// Netcode", 2012), with a server that closes ticks instead of peers that confirm inputs.
#include <algorithm>

#include <lockstone/assert.h>

#include "net/session/client_impl.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {

// The state at `head`, to come back to.
void Client::Impl::keep_state() {
  if (!predicts()) return;
  const std::size_t size = simulation->save(SnapshotKind::native, states.claim(head));
  states.commit(head, size);
}

std::uint64_t Client::Impl::step_record(ByteView record) {
  simulation->step(RecordInputs(record, shape).view());
  ++head;
  note_parts();
  keep_state();
  return simulation->hash();
}

bool Client::Impl::guessed_right() const {
  if (stepped >= head) return false;
  const ByteView guess = guesses.find(stepped);
  const ByteView record = records.find(stepped);
  return std::equal(guess.begin(), guess.end(), record.begin(), record.end());
}

void Client::Impl::roll_back(std::uint64_t tick) {
  const ByteView kept = states.find(tick);
  LKS_CHECK(!kept.empty());
  LKS_CHECK(simulation->load(SnapshotKind::native, kept) == Status::ok);
  observer->rolled_back(tick, head - tick);
  ++stats.rollbacks;
  stats.ticks_stepped_again += head - tick;
  head = tick;
}

// Tick `stepped` is closed: either its inputs are as guessed, or all ticks since are stepped again.
void Client::Impl::confirm_one() {
  const ByteView record = records.find(stepped);
  if (guessed_right()) {
    after_step(guess_hashes[static_cast<std::size_t>(stepped % guess_hashes.size())]);
    return;
  }
  if (head > stepped) roll_back(stepped);
  after_step(step_record(record));
}

void Client::Impl::predict_ticks() {
  if (config.sync_test) test_sync();
  if (active_tick == k_never || paused) return;
  const std::uint64_t own = std::max(sampled, active_tick);
  std::uint64_t end = own - std::min<std::uint64_t>(own, config.prediction_delay_ticks);
  end = std::min(end, stepped + config.prediction_ticks);
  if (seat.tick_count > 0) end = std::min(end, seat.tick_count);
  while (head < end)
    predict_one();
}

void Client::Impl::predict_one() {
  const std::span<std::byte> record = guesses.claim(head);
  std::fill(record.begin(), record.end(), std::byte{0});
  for (std::uint8_t slot = 0; slot < info.player_count; ++slot)
    guess_slot(record, slot);
  guesses.commit(head, record.size());
  const std::uint64_t tick = head;
  const std::uint64_t hash = step_record(record);
  guess_hashes[static_cast<std::size_t>(tick % guess_hashes.size())] = hash;
  observer->tick_predicted(tick, RecordInputs(record, shape).view());
}

// The own input is known; others are taken to hold theirs, unless the predictor knows better.
void Client::Impl::guess_slot(std::span<std::byte> record, std::uint8_t slot) {
  std::array<std::byte, k_max_input_bytes> bytes{};
  const std::span<std::byte> input = std::span(bytes).first(info.input_bytes);
  const ByteView known = stepped == 0 ? ByteView{} : records.find(stepped - 1);
  const bool present = ((present_mask >> slot) & 1) != 0;
  InputOrigin origin = present ? InputOrigin::received : InputOrigin::absent;
  if (!known.empty()) {
    const PlayerInput last = get_slot(known, shape, slot);
    std::copy(last.bytes.begin(), last.bytes.end(), input.begin());
    const bool absent = last.origin == InputOrigin::absent;
    origin = absent ? InputOrigin::absent : InputOrigin::received;
  }
  if (head < seat.input_delay_ticks && origin != InputOrigin::absent) {
    origin = InputOrigin::neutral;
    std::fill(input.begin(), input.end(), std::byte{0});
  } else if (slot == seat.slot && head >= active_tick && own_inputs.has(head)) {
    const ByteView own = own_inputs.find(head);
    std::copy(own.begin(), own.end(), input.begin());
    origin = InputOrigin::received;
  } else if (origin == InputOrigin::received && parts.predictor != nullptr) {
    parts.predictor->predict(head, slot, input);
  }
  set_slot(record, shape, slot, origin, input);
}

// Steps the last closed ticks again, from a kept state, and expects the hashes that they had.
void Client::Impl::test_sync() {
  const std::uint64_t back = std::min<std::uint64_t>(config.prediction_ticks, stepped);
  const std::uint64_t from = stepped - back;
  if (back == 0 || sync_tested == stepped || !states.has(from) || !records.has(from)) return;
  sync_tested = stepped;
  const ByteView kept = states.find(from);
  LKS_CHECK(simulation->load(SnapshotKind::native, kept) == Status::ok);
  for (std::uint64_t tick = from; tick < stepped; ++tick) {
    simulation->step(RecordInputs(records.find(tick), shape).view());
    if (simulation->hash() == hashes.at(tick)) continue;
    return fail(ClientFailure::not_deterministic);
  }
  head = stepped;
  keep_state();
}

}  // namespace lockstone::net
