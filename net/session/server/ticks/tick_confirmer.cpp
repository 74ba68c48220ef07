#include "net/session/server/ticks/tick_confirmer.h"

#include <span>

#include <lockstone/assert.h>

#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr std::uint64_t k_max_ticks_per_update = 256;
constexpr std::int64_t k_max_catch_up_us = 250'000;  // a longer pause is not played faster after

}  // namespace

void TickConfirmer::resume() {
  MatchStatus& match = data_.match;
  match.confirmed = data_.parts.simulation->tick();
  data_.judge.begin_after(match.confirmed, data_.parts.simulation->hash());
  resumed_.begin(*data_.config.resume_mask);
  match.state = ServerState::running;
  match.expected_until_us = match.now_us + data_.config.timeouts.rejoin_us;
}

void TickConfirmer::advance() {
  MatchStatus& match = data_.match;
  for (std::uint64_t i = 0; i < k_max_ticks_per_update && !uses_.cases.freeze_match(); ++i) {
    LKS_ASSERT(match.confirmed <= match.end_tick);
    if (match.confirmed == match.end_tick) return uses_.end.begin_finishing();
    if (!may_confirm_next()) break;
    confirm_next();
    if (match.state != ServerState::running) return;
  }
  const bool waits_long =
      match.waiting != 0 && match.now_us - match.waiting_since_us > data_.config.timeouts.drop_us;
  if (waits_long) uses_.laggards.drop_waited_for();
}

// Notes the missing players, if only the wait for them holds the next tick up. A match in which
// nobody has a say stands still.
bool TickConfirmer::may_confirm_next() {
  MatchStatus& match = data_.match;
  const bool fast = data_.config.pacing == Pacing::fast;
  if (match.paused || data_.roster.active_mask() == 0 || awaits_return()) return false;
  const std::int64_t due_us = data_.schedule.due_us(match.confirmed);
  if (!fast && match.now_us < due_us) return false;
  const bool waits = fast || data_.config.late_policy == LatePolicy::strict;
  const Laggards& laggards = uses_.laggards;
  const SlotMask missing = waits ? laggards.missing_inputs_mask() | laggards.behind_mask() : 0;
  if (missing != 0 && match.waiting == 0) match.waiting_since_us = match.now_us;
  match.waiting = missing;
  if (missing != 0) return false;
  const bool late = !fast && match.now_us - due_us > k_max_catch_up_us;
  if (late) data_.schedule.rebase(match.confirmed, match.now_us);
  return true;
}

// After a resumption.
bool TickConfirmer::awaits_return() {
  const bool ends = resumed_.advance(data_.roster.active_mask(), data_.match.now_us);
  if (ends) data_.schedule.rebase(data_.match.confirmed, data_.match.now_us);
  return !resumed_.is_over();
}

void TickConfirmer::confirm_next() {
  MatchStatus& match = data_.match;
  uses_.laggards.drop_behind();
  if (match.state != ServerState::running) return;
  const std::span<std::byte> record = data_.records.claim(match.confirmed);
  uses_.inputs.fill_next(record);
  set_command_count(record, uses_.commands.bind_to_next_tick());
  data_.records.commit(match.confirmed, record.size());
  const std::optional<std::uint64_t> hash = step_simulation(record);
  const std::uint64_t tick = match.confirmed++;
  if (data_.simulates()) uses_.states.keyframes().note(*data_.parts.simulation);
  const std::span<const PlayerCommand> commands = data_.commands.of(tick);
  if (!commands.empty()) data_.observer->commands_confirmed(tick, commands);
  data_.observer->tick_confirmed(tick, RecordInputs(record, data_.shape).view(), hash);
}

std::optional<std::uint64_t> TickConfirmer::step_simulation(ByteView record) {
  if (!data_.simulates()) return std::nullopt;
  Simulation& simulation = *data_.parts.simulation;
  const std::uint64_t tick = data_.match.confirmed;
  step_tick(simulation, RecordInputs(record, data_.shape).view(), data_.commands.of(tick));
  const bool checks_parts = simulation.tick() % k_parts_interval_ticks == 0;
  if (checks_parts) data_.parts_judge.note_own(parts_of(simulation));
  const std::uint64_t hash = simulation.hash();
  data_.judge.push_own(hash);
  TickRing& snapshots = data_.snapshots;
  if (snapshots.keeps_records()) {
    const std::size_t size = simulation.save(SnapshotKind::canonical, snapshots.claim(tick));
    snapshots.commit(tick, size);
  }
  return hash;
}

}  // namespace lockstone::net
