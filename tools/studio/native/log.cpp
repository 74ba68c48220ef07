// Logs in memory, and their simulations, stepped with the recorded inputs.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/source.h>
#include <lockstone/world.h>

#include "tools/arena/arena_simulation.h"
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/scenes/play.h"
#include "tools/scenes/scene_simulation.h"
#include "tools/studio/native/lockstone_studio.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

struct TickCommand {
  std::uint64_t tick = 0;
  std::uint8_t slot = 0;
  std::vector<std::byte> bytes;
};

struct EventPlace {
  std::uint32_t tick = 0, kind = 0, slot = 0;
};

}  // namespace

struct lks_studio_log {
  replay::LogHeader header;
  std::vector<std::byte> config;
  std::vector<std::byte> inputs;
  std::vector<InputOrigin> origins;
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint64_t> keyframe_ticks;
  std::vector<std::vector<std::byte>> keyframes;
  std::vector<EventPlace> event_places;
  std::vector<std::string> event_texts;
  std::vector<TickCommand> commands;
  std::string end;
  std::string damage;
  bool complete = false;
};

namespace {

/// The simulation of a log. Its inputs come from the log, tick by tick.
class LogPlay final : public scenes::ScenePlay {
 public:
  explicit LogPlay(std::unique_ptr<Simulation> simulation) : simulation_(std::move(simulation)) {}

  void set_inputs(const lks_studio_log& log, std::size_t tick) {
    const SimulationInfo& info = log.header.info;
    for (std::size_t slot = 0; slot < info.player_count; ++slot) {
      const std::size_t at = tick * info.player_count + slot;
      inputs_[slot] = {ByteView(log.inputs).subspan(at * info.input_bytes, info.input_bytes),
                       log.origins[at]};
    }
    players_ = info.player_count;
  }

  [[nodiscard]] std::span<const PlayerInput> next_inputs() override {
    return std::span(inputs_).first(players_);
  }
  [[nodiscard]] Simulation& simulation() override { return *simulation_; }
  [[nodiscard]] const World& world() const override { return *scenes::world_of(*simulation_); }
  [[nodiscard]] const StepReport& last_report() const override {
    if (const auto* scene = dynamic_cast<const scenes::SceneSimulation*>(simulation_.get()))
      return scene->last_report();
    return dynamic_cast<const arena::ArenaSimulation&>(*simulation_).last_report();
  }
  void drop_derived() override {}
  void set_task_runner(TaskRunner*, TaskPieces) override {}

 private:
  std::unique_ptr<Simulation> simulation_;
  std::array<PlayerInput, k_max_players> inputs_{};
  std::size_t players_ = 0;
};

template <class T>
void append(std::vector<T>& all, std::span<const T> more) {
  all.insert(all.end(), more.begin(), more.end());
}

void add_ticks(const replay::LogReader& reader, lks_studio_log& log) {
  const std::span<const std::uint64_t> hashes = reader.hashes();
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    for (const PlayerInput& input : reader.tick_inputs(i)) {
      append(log.inputs, input.bytes);
      log.origins.push_back(input.origin);
    }
    for (const PlayerCommand& command : reader.tick_commands(i)) {
      log.commands.push_back({reader.chunk().first_tick + i,
                              command.slot,
                              {command.bytes.begin(), command.bytes.end()}});
    }
  }
  append(log.hashes, hashes);
}

void add_events(const replay::LogReader& reader, lks_studio_log& log) {
  for (const replay::LogEvent& event : reader.events()) {
    log.event_places.push_back({static_cast<std::uint32_t>(event.tick),
                                static_cast<std::uint32_t>(event.kind), event.slot});
    log.event_texts.push_back(event.text);
  }
}

void add_item(const replay::LogReader& reader, replay::LogItem item, lks_studio_log& log) {
  switch (item) {
    case replay::LogItem::scene:
      return append(log.config, reader.config());
    case replay::LogItem::hashes:
      return add_ticks(reader, log);
    case replay::LogItem::keyframe:
      log.keyframe_ticks.push_back(reader.chunk().first_tick);
      log.keyframes.emplace_back(reader.snapshot().begin(), reader.snapshot().end());
      return;
    case replay::LogItem::events:
      return add_events(reader, log);
    case replay::LogItem::end:
      log.end = reader.end().reason;
      return;
    default:
      return;
  }
}

std::unique_ptr<lks_studio_log> read_log(ByteView bytes) {
  auto log = std::make_unique<lks_studio_log>();
  replay::MemorySource source(bytes);
  replay::LogReader reader(source);
  const Status opened = reader.open();
  if (opened != Status::ok) throw_status(static_cast<lks_status>(opened), reader.damage().what);
  log->header = reader.header();
  replay::LogItem item = reader.next();
  for (; !replay::is_last(item); item = reader.next())
    add_item(reader, item, *log);
  log->complete = reader.complete();
  if (item == replay::LogItem::finished) return log;
  log->damage = reader.damage().what;
  const bool nothing = log->config.empty() || log->hashes.empty();
  if (nothing) throw_status(static_cast<lks_status>(reader.damage().status), log->damage);
  return log;
}

bool is_arena(const lks_studio_log& log) {
  return ByteReader(log.config).get<std::uint32_t>() != scenes::k_config_magic;
}

std::uint32_t address(const void* place) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(place));
}

lks_studio_log_facts facts_of(const lks_studio_log& log) {
  const auto count = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  lks_studio_log_facts facts{};
  facts.seed = log.header.match.seed;
  facts.match_id = log.header.match.match_id;
  facts.start_tick = static_cast<std::uint32_t>(log.header.match.start_tick);
  facts.ticks = count(log.hashes.size());
  facts.players = log.header.info.player_count;
  facts.input_bytes = log.header.info.input_bytes;
  facts.tick_rate = log.header.info.tick_rate;
  facts.keyframes = count(log.keyframes.size());
  facts.events = count(log.event_places.size());
  facts.complete = log.complete ? 1 : 0;
  facts.arena = is_arena(log) ? 1 : 0;
  facts.same_canary = log.header.info.canary == canary_hash() ? 1 : 0;
  facts.hashes = address(log.hashes.data());
  facts.inputs = address(log.inputs.data());
  facts.origins = address(log.origins.data());
  facts.keyframe_at = address(log.keyframe_ticks.data());
  facts.event_at = address(log.event_places.data());
  return facts;
}

std::string text_of(const lks_studio_log& log, std::uint32_t which, std::uint32_t index) {
  switch (which) {
    case LKS_STUDIO_LOG_GAME:
      return log.header.match.game + ' ' + log.header.match.game_version;
    case LKS_STUDIO_LOG_BUILD:
      return log.header.match.build;
    case LKS_STUDIO_LOG_END:
      return log.end;
    case LKS_STUDIO_LOG_DAMAGE:
      return log.damage;
    case LKS_STUDIO_LOG_EVENT:
      return index < log.event_texts.size() ? log.event_texts[index] : std::string();
    default:
      throw_invalid("which", "there is no such text");
  }
}

void load_keyframe(const lks_studio_log& log, std::uint32_t index, lks_world& world) {
  if (index >= log.keyframes.size()) throw_failure(Status::not_found);
  Simulation& simulation = required(world.scene.get(), "world").simulation();
  const Status status = simulation.load(SnapshotKind::canonical, log.keyframes[index]);
  if (status != Status::ok) throw_failure(status);
}

// The canary may differ: the states of another build can be looked at, and do not agree.
void check_same(const SimulationInfo& log, const SimulationInfo& here) {
  if (log.abi == here.abi && log.config_hash == here.config_hash &&
      log.scene_hash == here.scene_hash && log.player_count == here.player_count &&
      log.input_bytes == here.input_bytes)
    return;
  throw_status(LKS_INCOMPATIBLE, "the log is of simulation " + std::to_string(log.abi) +
                                     ", this build plays " + std::to_string(here.abi) +
                                     ", or its rules and scene are others");
}

std::unique_ptr<lks_world> world_of(const lks_studio_log& log) {
  auto made = scenes::make_simulation(log.config);
  if (!made.ok()) {
    throw_status(LKS_INCOMPATIBLE,
                 "the log's game is neither the arena nor a built-in scene: " + text_of(log, 0, 0));
  }
  check_same(log.header.info, made.value()->info());
  auto world = std::make_unique<lks_world>();
  world->scene = std::make_unique<LogPlay>(std::move(made).value());
  if (log.header.match.start_tick > 0) load_keyframe(log, 0, *world);
  return world;
}

}  // namespace

lks_status lks_studio_log_open(const void* bytes, size_t count, lks_studio_log** out) {
  return call([&] {
    array(bytes, count, "bytes");
    required(out, "out") = read_log({static_cast<const std::byte*>(bytes), count}).release();
  });
}

void lks_studio_log_close(lks_studio_log* log) {
  delete log;
}

lks_status lks_studio_log_describe(const lks_studio_log* log, lks_studio_log_facts* out) {
  return call([&] { required(out, "out") = facts_of(required(log, "log")); });
}

lks_status lks_studio_log_text(const lks_studio_log* log, uint32_t which, uint32_t index,
                               char* text, size_t capacity) {
  return call([&] { write_text(text_of(required(log, "log"), which, index), text, capacity); });
}

lks_status lks_studio_log_world(const lks_studio_log* log, lks_world** out) {
  return call([&] { required(out, "out") = world_of(required(log, "log")).release(); });
}

lks_status lks_studio_log_keyframe(const lks_studio_log* log, uint32_t index, lks_world* world) {
  return call([&] { load_keyframe(required(log, "log"), index, required(world, "world")); });
}

lks_status lks_studio_log_step(const lks_studio_log* log, lks_world* world, uint32_t* same) {
  return call([&] {
    const lks_studio_log& from = required(log, "log");
    auto* play = dynamic_cast<LogPlay*>(required(world, "world").scene.get());
    required(play, "world");
    const auto tick =
        static_cast<std::size_t>(play->simulation().tick() - from.header.match.start_tick);
    if (tick >= from.hashes.size()) throw_failure(Status::not_found);
    play->set_inputs(from, tick);
    const std::uint64_t now = play->simulation().tick();
    auto command = std::ranges::lower_bound(from.commands, now, {}, &TickCommand::tick);
    for (; command != from.commands.end() && command->tick == now; ++command)
      play->simulation().command({command->slot, command->bytes});
    play->step();
    if (same != nullptr) *same = play->simulation().hash() == from.hashes[tick] ? 1 : 0;
  });
}
