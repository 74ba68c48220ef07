#include "net/session/client/playback.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr std::uint64_t k_queue_ticks = 4;

}  // namespace

std::uint64_t Playback::unacknowledged_limit() const {
  const ClientConfig& config = data_.config;
  const bool keeps =
      data_.progress.snapshots.keeps_records() || (data_.predicts() && config.snapshot_ticks > 0);
  const std::size_t kept = keeps ? config.snapshot_ticks : config.history_ticks;
  return std::min<std::uint64_t>(kept, config.history_ticks);
}

void Playback::step_ticks(std::uint64_t limit) {
  const ClientProgress& progress = data_.progress;
  for (std::uint32_t i = 0; i < data_.config.max_steps_per_update; ++i) {
    const std::uint64_t stepped = progress.stepped;
    LKS_ASSERT(stepped <= data_.ticks.received());
    const std::uint64_t unheard = stepped - std::min(stepped, progress.hashes_acknowledged);
    const bool stalls = !data_.place.spectates() && unheard >= limit;
    if (stepped == data_.ticks.received() || stalls || !is_due(stepped)) return;
    if (!is_complete(data_, stepped)) return;
    note_stepped(data_.predicts() ? prediction_.confirm_next() : step_next());
  }
}

void Playback::step_rest() {
  const std::uint64_t& stepped = data_.progress.stepped;
  for (std::uint64_t before = stepped + 1; before != stepped;) {
    before = stepped;
    step_ticks(data_.config.history_ticks);
  }
}

// Ticks that queue up are not for an even flow: they are caught up with.
bool Playback::is_due(std::uint64_t tick) const {
  const bool evenly = data_.config.play_out_evenly && !data_.predicts() &&
                      data_.place.welcome.pacing == Pacing::real_time;
  const PlayoutClock& playout = data_.playout;
  const auto depth_ticks = static_cast<std::uint64_t>(playout.depth_us() / data_.game.tick_us);
  const std::uint64_t queued = data_.ticks.received() - data_.progress.stepped;
  if (!evenly || data_.status.over || queued > depth_ticks + k_queue_ticks) return true;
  return playout.due(tick, data_.status.now_us);
}

std::uint64_t Playback::step_next() {
  const RecordInputs inputs(data_.ticks.find(data_.progress.stepped), data_.game.shape);
  Simulation& simulation = *data_.game.simulation;
  step_tick(simulation, inputs.view(), data_.commands.of(data_.progress.stepped));
  note_parts(data_);
  return simulation.hash();
}

// The next tick has been stepped with its confirmed inputs; `hash` is the state after it.
void Playback::note_stepped(std::uint64_t hash) {
  ClientProgress& progress = data_.progress;
  progress.hashes.push(hash);
  progress.state_hash = hash;
  const std::uint64_t tick = progress.stepped++;
  TickRing& snapshots = progress.snapshots;
  if (snapshots.keeps_records()) {
    const Simulation& simulation = *data_.game.simulation;
    snapshots.commit(tick, simulation.save(SnapshotKind::canonical, snapshots.claim(tick)));
  }
  progress.news = true;
  const Parts& parts = progress.state_parts;
  const bool reports = parts.ticks == progress.stepped && parts.count > 0;
  if (reports && !data_.place.spectates()) data_.server.send(parts);
  const RecordInputs inputs(data_.ticks.find(tick), data_.game.shape);
  const std::span<const PlayerCommand> commands = data_.commands.of(tick);
  if (!commands.empty()) data_.observer->commands_stepped(tick, commands);
  data_.observer->tick_stepped(tick, inputs.view(), hash);
  // The test of prediction steps the last ticks again.
  data_.commands.forget_before(
      progress.stepped - std::min<std::uint64_t>(progress.stepped, data_.config.prediction_ticks));
  if (!data_.place.spectates()) {
    note_replaced_input(tick, inputs.view()[data_.place.welcome.slot].origin);
  }
}

// `origin`: of this player's own input.
void Playback::note_replaced_input(std::uint64_t tick, InputOrigin origin) {
  const ClientPlace& place = data_.place;
  if (tick < std::max<std::uint64_t>(place.welcome.input_delay_ticks, place.active_tick)) return;
  if (origin == InputOrigin::received || origin == InputOrigin::absent) return;
  ++data_.stats.substituted_inputs;
  data_.observer->input_replaced(tick);
}

}  // namespace lockstone::net
