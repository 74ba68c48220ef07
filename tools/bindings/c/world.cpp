// Worlds: made, stepped, destroyed.
#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace lockstone::c {

const lks_world& saved(const lks_world* world) {
  if (handle(world).shown != nullptr)
    throw_status(LKS_READ_ONLY, "the world of a match is stepped and saved by its session");
  return *world;
}

World& write(lks_world* world) {
  required(world, "world");
  if (saved(world).scene) throw_status(LKS_READ_ONLY, "a built-in scene takes no command");
  return *world->own;
}

void order(lks_world* world, const Command& command) {
  World& target = write(world);
  const Status status = target.apply(command);
  if (status != Status::ok) throw_failure(status, target.explain(command));
}

BodyHandle existing_body(const World& world, lks_body body) {
  const auto handle = handle_of<BodyHandle>(body);
  if (!world.exists(handle)) throw_failure(Status::stale_handle);
  return handle;
}

namespace {

lks_world_def raw_def(const WorldDef& def) {
  lks_world_def raw{};
  raw.size = sizeof raw;
  raw.body_capacity = def.body_capacity;
  raw.pair_capacity = def.pair_capacity;
  raw.contact_capacity = def.contact_capacity;
  raw.joint_capacity = def.joint_capacity;
  raw.tick_rate = def.tick_rate;
  raw.substeps = def.substeps;
  raw.sleep_ms = def.sleep_ms;
  raw.sleep_distance = def.sleep_distance.raw;
  raw.broad_phase = static_cast<std::uint32_t>(def.broad_phase);
  raw.gravity = raw_of(def.gravity);
  raw.speed_limit = def.speed_limit.raw;
  raw.converged_contacts = def.converged_contacts;
  raw.vehicle_capacity = def.vehicle_capacity;
  raw.terrain_tile_capacity = def.terrain_tile_capacity;
  return raw;
}

WorldDef world_def_of(const lks_world_def* from) {
  const lks_world_def raw = take(from, raw_def(WorldDef{}), "def");
  WorldDef def;
  def.body_capacity = raw.body_capacity;
  def.pair_capacity = raw.pair_capacity;
  def.contact_capacity = raw.contact_capacity;
  def.joint_capacity = raw.joint_capacity;
  def.tick_rate = narrow<std::uint16_t>(raw.tick_rate, "world.tick_rate");
  def.substeps = narrow<std::uint8_t>(raw.substeps, "world.substeps");
  def.sleep_ms = narrow<std::uint16_t>(raw.sleep_ms, "world.sleep_ms");
  def.sleep_distance = Length::from_raw(raw.sleep_distance);
  def.broad_phase = enumerator(raw.broad_phase, BroadPhaseKind::tree,
                               BroadPhaseKind::sweep_and_prune, "world.broad_phase");
  def.gravity = vec<Acceleration>(raw.gravity);
  def.speed_limit = Velocity::from_raw(raw.speed_limit);
  def.converged_contacts = raw.converged_contacts;
  def.vehicle_capacity = raw.vehicle_capacity;
  def.terrain_tile_capacity = raw.terrain_tile_capacity;
  const Refusal refusal = World::explain(def);
  if (refusal) throw_failure(Status::invalid_argument, refusal);
  return def;
}

std::shared_ptr<const AssetSet> set_of(const lks_assets* assets) {
  return std::make_shared<AssetSet>(assets == nullptr ? std::vector<AssetPtr>() : assets->list);
}

lks_step_report raw_report(const StepReport& report) {
  lks_step_report raw{};
  raw.size = sizeof raw;
  raw.status = static_cast<lks_status>(report.status);
  raw.moving_bodies = report.moving_bodies;
  raw.asleep_bodies = report.asleep_bodies;
  raw.islands = report.islands;
  raw.free_bodies = report.free_bodies;
  raw.axis_turns = report.axis_turns;
  raw.pairs = report.pairs;
  raw.contacts = report.contacts;
  raw.contact_points = report.contact_points;
  raw.colors = report.colors;
  raw.overflow_contacts = report.overflow_contacts;
  raw.continuous_bodies = report.continuous_bodies;
  raw.impacts = report.impacts;
  raw.saturations = report.saturations;
  raw.energy_limits = report.energy_limits;
  raw.computed_islands = report.computed_islands;
  raw.recalled_islands = report.recalled_islands;
  raw.still_bodies = report.still_bodies;
  raw.still_contacts = report.still_contacts;
  return raw;
}

StepReport step(lks_world& world) {
  if (!world.scene) return world.history ? world.history->step() : world.own->step();
  world.scene->step();
  return world.scene->last_report();
}

void set_runner(lks_world& world, TaskRunner* runner) {
  if (world.scene)
    world.scene->set_task_runner(runner, TaskPieces::worthwhile);
  else
    world.own->set_task_runner(runner);
}

}  // namespace
}  // namespace lockstone::c

using namespace lockstone;
using namespace lockstone::c;

lks_status lks_world_def_init(lks_world_def* def, size_t size) {
  return call([&] { give(raw_def(WorldDef{}), def, size, "def"); });
}

lks_status lks_world_create(const lks_world_def* def, const lks_assets* assets, lks_world** out) {
  return call([&] {
    required(out, "out");
    auto world = std::make_unique<lks_world>();
    world->own = value_of(World::create(world_def_of(def), set_of(assets)));
    *out = world.release();
  });
}

void lks_world_destroy(lks_world* world) {
  delete world;
}

lks_status lks_world_get_def(const lks_world* world, lks_world_def* def) {
  return call([&] { give(raw_def(read(world).def()), def, required(def, "def").size, "def"); });
}

lks_status lks_config_hash(const lks_world_def* def, const lks_assets* assets, uint64_t* out) {
  return call(
      [&] { required(out, "out") = config_hash(world_def_of(def), set_of(assets)->hash()); });
}

lks_status lks_world_set_threads(lks_world* world, uint32_t threads) {
  return call([&] {
    static_cast<void>(saved(&required(world, "world")));
    if (threads < 1 || threads > k_max_workers) throw_invalid("threads", "must be 1 … 64");
    auto pool = threads > 1 ? std::make_unique<ThreadPool>(threads) : nullptr;
    set_runner(*world, pool.get());
    world->threads = std::move(pool);
  });
}

lks_status lks_step(lks_world* world, lks_step_report* report) {
  return call([&] {
    static_cast<void>(saved(&required(world, "world")));
    if (report != nullptr) check_size<lks_step_report>(report->size, "report");
    const StepReport done = step(*world);
    if (report != nullptr) give(raw_report(done), report, report->size, "report");
  });
}

lks_status lks_world_keep_history(lks_world* world, uint32_t ticks) {
  return call([&] {
    World& own = write(world);
    if (ticks > LKS_MAX_HISTORY_TICKS) throw_invalid("ticks", "must be 0 … 256");
    world->history.reset();
    if (ticks != 0) world->history.emplace(own, ticks);
  });
}

lks_status lks_world_forget_history(lks_world* world) {
  return call([&] {
    (void)write(world);
    if (world->history) world->history->forget();
  });
}

lks_status lks_tick(const lks_world* world, uint64_t* out) {
  return call([&] { required(out, "out") = read(world).tick(); });
}
