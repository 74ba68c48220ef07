#include "net/session/client/prediction.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "net/wire/tick_record.h"

namespace lockstone::net {

void Prediction::reserve(bool keeps_states) {
  const std::size_t guessed = std::size_t{data_.config.prediction_ticks} + 2;
  states_ = TickRing((keeps_states ? data_.config.snapshot_ticks : 0) + guessed,
                     data_.game.simulation->snapshot_bytes_max(SnapshotKind::native));
  guesses_ = TickRing(guessed, data_.game.shape.record_bytes());
  guess_hashes_.resize(guessed);
  if (data_.config.keep_history)
    data_.game.simulation->keep_history(static_cast<std::uint32_t>(guessed));
}

void Prediction::restart(std::uint64_t ticks) {
  head_ = stepped_before_ = ticks;
  keep_state();
}

// The state at `head_`, to come back to.
void Prediction::keep_state() {
  if (!data_.predicts()) return;
  const Simulation& simulation = *data_.game.simulation;
  states_.commit(head_, simulation.save(SnapshotKind::native, states_.claim(head_)));
}

std::uint64_t Prediction::step(ByteView record, std::span<const PlayerCommand> commands) {
  Simulation& simulation = *data_.game.simulation;
  step_tick(simulation, RecordInputs(record, data_.game.shape).view(), commands);
  ++head_;
  if (head_ <= stepped_before_) {
    const IslandWork work = simulation.island_work();
    data_.stats.islands_computed_again += work.computed;
    data_.stats.islands_recalled += work.recalled;
  }
  note_parts(data_);
  keep_state();
  return simulation.hash();
}

bool Prediction::guessed_right() const {
  const std::uint64_t tick = data_.progress.stepped;
  if (tick >= head_) return false;
  const ByteView guess = guesses_.find(tick);
  const ByteView record = data_.ticks.find(tick);
  return std::equal(guess.begin(), guess.end(), record.begin(), record.end());
}

void Prediction::roll_back(std::uint64_t tick) {
  const ByteView kept = states_.find(tick);
  LKS_CHECK(!kept.empty());
  LKS_CHECK(data_.game.simulation->load(SnapshotKind::native, kept) == Status::ok);
  data_.observer->rolled_back(tick, head_ - tick);
  ++data_.stats.rollbacks;
  data_.stats.ticks_stepped_again += head_ - tick;
  stepped_before_ = std::max(stepped_before_, head_);
  head_ = tick;
}

void Prediction::drop_guesses() {
  if (head_ > data_.progress.stepped) roll_back(data_.progress.stepped);
}

std::uint64_t Prediction::confirm_next() {
  const std::uint64_t tick = data_.progress.stepped;
  LKS_ASSERT(data_.predicts() && data_.ticks.has(tick));
  if (guessed_right()) return guess_hashes_[static_cast<std::size_t>(tick % guess_hashes_.size())];
  drop_guesses();
  LKS_ASSERT(head_ == tick);
  return step(data_.ticks.find(tick), data_.commands.of(tick));
}

void Prediction::advance() {
  if (!data_.place.plays() || data_.status.paused) return;
  const std::uint64_t own = std::max(data_.inputs.sampled(), data_.place.active_tick);
  std::uint64_t end = own - std::min<std::uint64_t>(own, data_.config.prediction_delay_ticks);
  end = std::min(end, data_.progress.stepped + data_.config.prediction_ticks);
  const std::uint64_t tick_count = data_.place.welcome.tick_count;
  if (tick_count > 0) end = std::min(end, tick_count);
  while (head_ < end)
    predict_one();
}

void Prediction::predict_one() {
  const std::span<std::byte> record = guesses_.claim(head_);
  std::fill(record.begin(), record.end(), std::byte{0});
  for (std::uint8_t slot = 0; slot < data_.game.info.player_count; ++slot)
    guess_slot(record, slot);
  guesses_.commit(head_, record.size());
  const std::uint64_t tick = head_;
  const std::uint64_t hash = step(record, {});  // commands are never guessed
  guess_hashes_[static_cast<std::size_t>(tick % guess_hashes_.size())] = hash;
  data_.observer->tick_predicted(tick, RecordInputs(record, data_.game.shape).view());
}

// The own input is known; others are taken to hold theirs, unless the predictor knows better.
void Prediction::guess_slot(std::span<std::byte> record, std::uint8_t slot) {
  const TickShape shape = data_.game.shape;
  const ClientPlace& place = data_.place;
  std::array<std::byte, k_max_input_bytes> bytes{};
  const std::span<std::byte> input = std::span(bytes).first(shape.input_bytes);
  const std::uint64_t stepped = data_.progress.stepped;
  const ByteView known = stepped == 0 ? ByteView{} : data_.ticks.find(stepped - 1);
  const bool present = has_slot(place.present_mask, slot);
  InputOrigin origin = present ? InputOrigin::received : InputOrigin::absent;
  if (!known.empty()) {
    const PlayerInput last = get_slot(known, shape, slot);
    std::copy(last.bytes.begin(), last.bytes.end(), input.begin());
    const bool absent = last.origin == InputOrigin::absent;
    origin = absent ? InputOrigin::absent : InputOrigin::received;
  }
  const bool own = slot == place.welcome.slot && head_ >= place.active_tick;
  if (head_ < place.welcome.input_delay_ticks && origin != InputOrigin::absent) {
    origin = InputOrigin::neutral;
    std::fill(input.begin(), input.end(), std::byte{0});
  } else if (own && data_.inputs.has(head_)) {
    const ByteView sampled = data_.inputs.find(head_);
    std::copy(sampled.begin(), sampled.end(), input.begin());
    origin = InputOrigin::received;
  } else if (origin == InputOrigin::received && data_.parts.predictor != nullptr) {
    data_.parts.predictor->predict(head_, slot, input);
  }
  set_slot(record, shape, slot, origin, input);
}

bool Prediction::passes_sync_test() {
  const std::uint64_t stepped = data_.progress.stepped;
  const std::uint64_t back = std::min<std::uint64_t>(data_.config.prediction_ticks, stepped);
  const std::uint64_t from = stepped - back;
  const bool kept = states_.has(from) && data_.ticks.has(from);
  if (back == 0 || sync_tested_ == stepped || !kept) return true;
  sync_tested_ = stepped;
  data_.game.simulation->forget_history();
  if (!repeats(from)) return false;  // in full
  if (data_.config.keep_history && !repeats(from)) return false;
  head_ = stepped;
  keep_state();
  return true;
}

// Steps the confirmed ticks from `from` on again. Whether they come to the same states.
bool Prediction::repeats(std::uint64_t from) {
  Simulation& simulation = *data_.game.simulation;
  LKS_CHECK(simulation.load(SnapshotKind::native, states_.find(from)) == Status::ok);
  for (std::uint64_t tick = from; tick < data_.progress.stepped; ++tick) {
    step_tick(simulation, RecordInputs(data_.ticks.find(tick), data_.game.shape).view(),
              data_.commands.of(tick));
    if (simulation.hash() != data_.progress.hashes.at(tick)) return false;
  }
  return true;
}

std::size_t Prediction::save_kept_state(std::uint64_t ticks, std::span<std::byte> out) {
  const ByteView kept = states_.find(ticks);
  if (kept.empty() || out.empty()) return 0;
  Simulation& simulation = *data_.game.simulation;
  LKS_CHECK(simulation.load(SnapshotKind::native, kept) == Status::ok);
  const std::size_t size = simulation.save(SnapshotKind::canonical, out);
  LKS_CHECK(simulation.load(SnapshotKind::native, states_.find(head_)) == Status::ok);
  return size;
}

}  // namespace lockstone::net
