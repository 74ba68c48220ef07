#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include <lockstone/assert.h>
#include <lockstone/game_library.h>

#include "tools/lockstone/logs/bisect/stage_trace.h"
#include "tools/tool/games.h"

namespace lockstone {
namespace {

// The one game of this library, and the table that refers to its texts.
struct Library {
  GameDef game;
  std::vector<lockstone_game_scene> scenes;
  lockstone_game_table table{};
};

const Library* the_library = nullptr;

const Simulation& simulation_of(const void* match) {
  return *static_cast<const Simulation*>(match);
}
Simulation& simulation_of(void* match) {
  return *static_cast<Simulation*>(match);
}

ByteView view_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(bytes), size};
}

SnapshotKind kind_of(std::uint32_t kind) {
  return kind == LOCKSTONE_GAME_NATIVE ? SnapshotKind::native : SnapshotKind::canonical;
}

/// The inputs of a tick as the simulation takes them.
class Inputs {
 public:
  Inputs(const Simulation& simulation, const lockstone_game_input* inputs, std::size_t count)
      : count_(std::min(count, k_max_players)) {
    const std::size_t bytes = simulation.info().input_bytes;
    for (std::size_t slot = 0; slot < count_; ++slot) {
      inputs_[slot] = {view_of(inputs[slot].bytes, bytes),
                       static_cast<InputOrigin>(inputs[slot].origin)};
    }
  }
  [[nodiscard]] std::span<const PlayerInput> list() const { return {inputs_.data(), count_}; }

 private:
  std::array<PlayerInput, k_max_players> inputs_{};
  std::size_t count_;
};

std::int32_t create(const std::uint8_t* config, std::size_t bytes, void** match) noexcept {
  Result<std::unique_ptr<Simulation>> made = the_library->game.make(view_of(config, bytes));
  if (!made) return static_cast<std::int32_t>(made.status());
  *match = std::move(made).value().release();
  return LOCKSTONE_GAME_OK;
}

void destroy(void* match) noexcept {
  delete static_cast<Simulation*>(match);
}

void tell_info(const void* match, lockstone_game_info* out) noexcept {
  const SimulationInfo info = simulation_of(match).info();
  *out = {.config_hash = info.config_hash,
          .scene_hash = info.scene_hash,
          .canary = info.canary,
          .abi = info.abi,
          .tick_rate = info.tick_rate,
          .player_count = info.player_count,
          .input_bytes = info.input_bytes};
}

std::uint64_t tick_of(const void* match) noexcept {
  return simulation_of(match).tick();
}

void step(void* match, const lockstone_game_input* inputs, std::size_t count) noexcept {
  Simulation& simulation = simulation_of(match);
  simulation.step(Inputs(simulation, inputs, count).list());
}

void command(void* match, std::uint32_t slot, const std::uint8_t* bytes,
             std::size_t size) noexcept {
  simulation_of(match).command({static_cast<std::uint8_t>(slot), view_of(bytes, size)});
}

std::size_t snapshot_bytes_max(const void* match, std::uint32_t kind) noexcept {
  return simulation_of(match).snapshot_bytes_max(kind_of(kind));
}

std::size_t save(const void* match, std::uint32_t kind, std::uint8_t* out,
                 std::size_t capacity) noexcept {
  return simulation_of(match).save(kind_of(kind), {reinterpret_cast<std::byte*>(out), capacity});
}

std::int32_t load(void* match, std::uint32_t kind, const std::uint8_t* bytes,
                  std::size_t size) noexcept {
  return static_cast<std::int32_t>(simulation_of(match).load(kind_of(kind), view_of(bytes, size)));
}

std::uint64_t hash_of(const void* match) noexcept {
  return simulation_of(match).hash();
}

template <std::size_t N>
void put_text(char (&out)[N], const std::string& text) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(out, text.data(), length);
  out[length] = '\0';
}

// The names are views, so they get their final zeros here: for one call, which is all that is
// promised.
std::size_t part_hashes(const void* match, lockstone_game_hash* out) noexcept {
  static thread_local std::array<std::array<char, 32>, k_max_state_parts> names;
  std::array<PartHash, k_max_state_parts> parts{};
  const std::size_t count = simulation_of(match).part_hashes(parts);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t length = std::min(parts[i].name.size(), names[i].size() - 1);
    std::copy_n(parts[i].name.begin(), length, names[i].begin());
    names[i][length] = '\0';
    out[i] = {names[i].data(), parts[i].hash.low, parts[i].hash.high};
  }
  return count;
}

std::int32_t describe(const void* match, const std::uint8_t* here, std::size_t here_bytes,
                      const std::uint8_t* there, std::size_t there_bytes,
                      lockstone_game_difference* out) noexcept {
  const StateDifference difference =
      simulation_of(match).describe(view_of(here, here_bytes), view_of(there, there_bytes));
  out->object = difference.object;
  put_text(out->store, difference.store);
  put_text(out->name, difference.name);
  put_text(out->field, difference.field);
  put_text(out->here, difference.here);
  put_text(out->there, difference.there);
  return difference.differs ? 1 : 0;
}

std::int32_t configure(const lockstone_game_request* request, std::uint8_t* out,
                       std::size_t* size) noexcept {
  MatchRequest asked{.scene = request->scene,
                     .seed = request->seed,
                     .players = static_cast<std::uint8_t>(std::min(request->players, 255U))};
  if (request->bodies >= 0) asked.bodies = static_cast<std::uint32_t>(request->bodies);
  const Result<std::vector<std::byte>> config = the_library->game.configure(asked);
  if (!config) return static_cast<std::int32_t>(config.status());
  const std::vector<std::byte>& bytes = config.value();
  if (bytes.size() > *size) return LOCKSTONE_GAME_CAPACITY_EXHAUSTED;
  if (!bytes.empty()) std::memcpy(out, bytes.data(), bytes.size());
  *size = bytes.size();
  return LOCKSTONE_GAME_OK;
}

std::int32_t press_bot(const void* match, std::uint64_t seed, std::uint32_t slot,
                       std::uint64_t tick, std::uint8_t* out) noexcept {
  const Simulation& simulation = simulation_of(match);
  const std::span<std::byte> bytes(reinterpret_cast<std::byte*>(out),
                                   simulation.info().input_bytes);
  return the_library->game.bot({simulation, seed, slot, tick}, bytes) ? 1 : 0;
}

std::size_t step_traced(void* match, const lockstone_game_input* inputs, std::size_t count,
                        lockstone_game_hash* out, std::size_t capacity) noexcept {
  Simulation& simulation = simulation_of(match);
  static thread_local tool::StageTrace trace;
  trace =
      tool::step_traced(the_library->game, simulation, Inputs(simulation, inputs, count).list());
  const std::size_t stages = std::min(trace.size(), capacity);
  for (std::size_t i = 0; i < stages; ++i)
    out[i] = {trace[i].name.c_str(), trace[i].digest, 0};
  return stages;
}

std::size_t draw(const void* match, char* out, std::size_t capacity) noexcept {
  const std::string picture = the_library->game.draw(simulation_of(match));
  if (picture.size() <= capacity) std::copy(picture.begin(), picture.end(), out);
  return picture.size();
}

void keep_history(void* match, std::uint32_t ticks) noexcept {
  simulation_of(match).keep_history(ticks);
}

void forget_history(void* match) noexcept {
  simulation_of(match).forget_history();
}

void fill_table(Library& library) {
  const GameDef& game = library.game;
  for (const SceneDef& scene : game.scenes)
    library.scenes.push_back({scene.name.c_str(), scene.description.c_str(), scene.ticks});
  library.table = {.abi = LOCKSTONE_GAME_ABI,
                   .bytes = sizeof(lockstone_game_table),
                   .name = game.name.c_str(),
                   .version = game.version.c_str(),
                   .build = game.build.c_str(),
                   .create = create,
                   .destroy = destroy,
                   .info = tell_info,
                   .tick = tick_of,
                   .step = step,
                   .snapshot_bytes_max = snapshot_bytes_max,
                   .save = save,
                   .load = load,
                   .hash = hash_of,
                   .part_hashes = part_hashes,
                   .describe = describe,
                   .configure = game.configure ? configure : nullptr,
                   .bot = game.bot ? press_bot : nullptr,
                   .step_traced = game.world ? step_traced : nullptr,
                   .draw = game.draw ? draw : nullptr,
                   .scenes = library.scenes.data(),
                   .scene_count = library.scenes.size(),
                   .keep_history = keep_history,
                   .forget_history = forget_history,
                   .command = command};
}

}  // namespace

const lockstone_game_table* game_table(GameDef (*make)()) {
  static const Library* const k_library = [make] {
    static Library library;
    library.game = make();
    LKS_CHECK(library.game.make != nullptr && !library.game.name.empty());
    fill_table(library);
    the_library = &library;
    return &library;
  }();
  return &k_library->table;
}

}  // namespace lockstone
