// Steps a world, and remembers its last ticks.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <lockstone/rollback_history.h>

#include "core/dynamics/step/contact_solver.h"
#include "core/world/history/computed_bodies.h"
#include "core/world/history/island_groups.h"
#include "core/world/history/next_state.h"
#include "core/world/history/tick_memory.h"
#include "core/world/state/state_loader.h"
#include "core/world/world_impl.h"

namespace lockstone {

struct RollbackHistory::Impl {
  Impl(World::Impl& of, std::uint32_t ticks);

  StepReport step();
  [[nodiscard]] TickMemory& memory_of(std::uint64_t tick) {
    return memories[static_cast<std::size_t>(tick % memories.size())];
  }

  World::Impl& world;
  std::vector<TickMemory> memories;  // by tick, modulo their number
  TickMemory fresh;                  // of the tick at hand
  ComputedBodies computed;
  IslandGroups groups;

 private:
  StepReport recall_all(const TickMemory& known);
  std::optional<StepReport> recall_some(const TickMemory& known);
  StepReport compute_all();
  void begin();
  void note_groups();
  [[nodiscard]] PoolUse pools_in_use() const;
  [[nodiscard]] bool add_known_shares(const TickMemory& known);
  void remember(const StepReport& report, const PoolUse& pools);
};

RollbackHistory::Impl::Impl(World::Impl& of, std::uint32_t ticks)
    : world(of), fresh(of.def), computed(of.def), groups(of.def.body_capacity) {
  memories.reserve(ticks);
  for (std::uint32_t i = 0; i < ticks; ++i)
    memories.emplace_back(of.def);
}

// A joint may wake a body before anything else happens in a tick: such a body is then a part of the
// state before it.
StepReport RollbackHistory::Impl::step() {
  if (world.trace.is_on()) return world.step();
  world.waking.wake_joined();
  const TickMemory& known = memory_of(world.header.tick);
  if (!known.is_known || known.tick != world.header.tick) return compute_all();
  computed.choose(world, world.sleep_flags.asleep_count() != 0, known);
  if (computed.are_none()) return recall_all(known);
  if (!computed.are_most())
    if (const std::optional<StepReport> report = recall_some(known)) return *report;
  return compute_all();
}

StepReport RollbackHistory::Impl::recall_all(const TickMemory& known) {
  StepReport report;
  report.recalled_islands = known.islands;
  LKS_CHECK(StateLoader(world).load_native(known.after.bytes()) == Status::ok);
  world.events.list().assign(known.events.begin(), known.events.end());
  world.events.hits().set(known.hit_events);
  world.joint_registry.set_events(known.joint_events);
  report.asleep_bodies = world.sleep_flags.asleep_count();
  return report;
}

StepReport RollbackHistory::Impl::compute_all() {
  begin();
  StepReport report = world.step();
  groups.join(world.pairs);
  note_groups();
  report.computed_islands = fresh.islands;
  fresh.after.save(world);
  const std::vector<ContactEvent>& events = world.events.list();
  fresh.events.assign(events.begin(), events.end());
  const std::vector<HitEvent>& hits = world.events.hits().list();
  fresh.hit_events.assign(hits.begin(), hits.end());
  const std::vector<JointEvent>& joint_events = world.joint_registry.events();
  fresh.joint_events.assign(joint_events.begin(), joint_events.end());
  fresh.pairs.assign(world.pairs.begin(), world.pairs.end());
  world.solver->list_shares(fresh.shares);
  remember(report, pools_in_use());
  return report;
}

// A tick of the computed bodies alone. Nothing if they met others after all, or if others would
// have taken their places in a pool: then the world is where it was.
std::optional<StepReport> RollbackHistory::Impl::recall_some(const TickMemory& known) {
  begin();
  computed.leave_out_others(world);
  StepReport report = world.step(&computed);
  world.pairs = {};
  computed.bring_back_others(world);
  const PoolUse pools = known.pools.beside(pools_in_use());
  const bool holds = report.status == Status::ok && !pools.is_exhausted() &&
                     add_known_shares(known) && !world.moved.has_lost_looks() &&
                     !world.events.hits().has_left_out() &&
                     known.hit_events.size() + world.events.hits().list().size() <=
                         most_hits(world.def.body_capacity) &&
                     computed.kept_to_themselves(world, fresh.before, world.moved.looks()) &&
                     write_next_state(world, computed, known, fresh);
  if (!holds) {
    LKS_CHECK(StateLoader(world).load_native(fresh.before.bytes()) == Status::ok);
    return {};
  }
  merge_events(world.events.list(), computed, known, fresh.events);
  merge_events(world.events.hits().list(), computed, known, fresh.hit_events);
  merge_events(world.joint_registry.events(), computed, known, fresh.joint_events);
  LKS_CHECK(StateLoader(world).load_native(fresh.after.bytes()) == Status::ok);
  world.events.list().assign(fresh.events.begin(), fresh.events.end());
  world.events.hits().set(fresh.hit_events);
  world.joint_registry.set_events(fresh.joint_events);
  groups.join(computed.all_pairs());
  for (std::uint32_t body = 0; body < known.groups.size(); ++body)
    if (!computed.has(body)) groups.join(body, known.groups[body]);
  note_groups();
  report.computed_islands =
      groups.count_awake(fresh.groups, [&](std::uint32_t body) { return computed.has(body); });
  report.recalled_islands = fresh.islands - report.computed_islands;
  report.asleep_bodies = world.sleep_flags.asleep_count();
  fresh.pairs.assign(computed.all_pairs().begin(), computed.all_pairs().end());
  remember(report, pools);
  return report;
}

void RollbackHistory::Impl::begin() {
  fresh.tick = world.header.tick;
  fresh.had_sleepers = world.sleep_flags.asleep_count() != 0;
  fresh.before.save(world);
  groups.begin(world);
}

// Once the pairs are joined.
void RollbackHistory::Impl::note_groups() {
  fresh.lookers.clear();
  for (const Pair& look : world.moved.looks()) {
    groups.join(look.a, look.b);
    if (look.a == look.b) fresh.lookers.push_back(look.a);
  }
  groups.join_woken(world, fresh.before);
  groups.write(fresh.groups);
  fresh.islands = groups.count_awake(fresh.groups, [](std::uint32_t) { return true; });
}

// Of all pools that islands share but those of converged ones, and of the places for contacts.
PoolUse RollbackHistory::Impl::pools_in_use() const {
  PoolUse pools = world.solver->counts().pools;
  pools.add(world.narrow.found_at_first(), world.def.contact_capacity);
  return pools;
}

// Of converged islands, those of the computed bodies and of the others. Whether all found room.
bool RollbackHistory::Impl::add_known_shares(const TickMemory& known) {
  world.solver->list_shares(fresh.shares);
  for (const IslandShare& each : known.shares)
    if (!computed.has(each.body)) fresh.shares.push_back(each);
  PoolShare sum;
  for (const IslandShare& each : fresh.shares)
    sum.add(each.share);
  return sum.fits(world.solver->room());
}

void RollbackHistory::Impl::remember(const StepReport& report, const PoolUse& pools) {
  fresh.pools = pools;
  fresh.is_known = report.status == Status::ok && !pools.is_exhausted() &&
                   !world.moved.has_lost_looks() && !world.events.hits().has_left_out();
  std::swap(fresh, memory_of(fresh.tick));
}

RollbackHistory::RollbackHistory(World& world, std::uint32_t ticks) : world_(world.impl_.get()) {
  LKS_ASSERT(ticks <= k_max_history_ticks);
  if (ticks != 0) impl_ = std::make_unique<Impl>(*world_, std::min(ticks, k_max_history_ticks));
}

RollbackHistory::~RollbackHistory() = default;
RollbackHistory::RollbackHistory(RollbackHistory&&) noexcept = default;
RollbackHistory& RollbackHistory::operator=(RollbackHistory&&) noexcept = default;

StepReport RollbackHistory::step() {
  return impl_ == nullptr ? world_->step() : impl_->step();
}

void RollbackHistory::forget() {
  if (impl_ == nullptr) return;
  for (TickMemory& memory : impl_->memories)
    memory.is_known = false;
}

std::size_t RollbackHistory::bytes_max() const {
  return impl_ == nullptr ? 0
                          : (impl_->memories.size() + 1) * TickMemory::bytes_max(impl_->world.def);
}

bool RollbackHistory::flip_bit(std::uint64_t tick, Side side, std::size_t bit) {
  if (impl_ == nullptr) return false;
  TickMemory& memory = impl_->memory_of(tick);
  if (!memory.is_known || memory.tick != tick) return false;
  StateCopy& state = side == Side::before ? memory.before : memory.after;
  if (bit / 8 >= state.bytes().size()) return false;
  state.out()[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
  return true;
}

}  // namespace lockstone
