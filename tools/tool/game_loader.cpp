#include "tools/tool/game_loader.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#if defined(LOCKSTONE_WITH_GAME_LIBRARIES)
#include <dlfcn.h>
#endif

#include "tools/lockstone/logs/stage_trace.h"
#include "tools/tool/games.h"

namespace lockstone::tool {
namespace {

constexpr std::size_t k_most_stages = 64;
constexpr std::size_t k_most_config_bytes = 64U << 10;

const std::uint8_t* bytes_of(ByteView view) {
  return reinterpret_cast<const std::uint8_t*>(view.data());
}

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

// A library's own statuses have the numbers of ours; another number is none.
Status status_of(std::int32_t code) {
  const bool known = code >= 0 && code <= static_cast<std::int32_t>(Status::not_found);
  return known ? static_cast<Status>(code) : Status::malformed;
}

std::uint32_t number_of(SnapshotKind kind) {
  return kind == SnapshotKind::native ? LOCKSTONE_GAME_NATIVE : LOCKSTONE_GAME_CANONICAL;
}

template <std::size_t N>
std::string field_text(const char (&text)[N]) {
  return {text, std::find(text, text + N, '\0')};
}

/// A match inside a game's library.
class LoadedSimulation final : public Simulation, public SelfTracing {
 public:
  LoadedSimulation(const lockstone_game_table& table, void* match) : table_(table), match_(match) {
    lockstone_game_info info{};
    table_.info(match_, &info);
    info_ = {.abi = info.abi,
             .config_hash = info.config_hash,
             .scene_hash = info.scene_hash,
             .canary = info.canary,
             .tick_rate = info.tick_rate,
             .player_count = info.player_count,
             .input_bytes = info.input_bytes};
  }
  ~LoadedSimulation() override { table_.destroy(match_); }
  LoadedSimulation(const LoadedSimulation&) = delete;
  LoadedSimulation& operator=(const LoadedSimulation&) = delete;

  [[nodiscard]] bool in_range() const {
    return info_.tick_rate > 0 && info_.player_count > 0 && info_.player_count <= k_max_players &&
           info_.input_bytes > 0 && info_.input_bytes <= k_max_input_bytes;
  }

  [[nodiscard]] SimulationInfo info() const override { return info_; }
  [[nodiscard]] std::uint64_t tick() const override { return table_.tick(match_); }
  void step(std::span<const PlayerInput> inputs) override {
    table_.step(match_, pass(inputs), inputs.size());
  }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return table_.snapshot_bytes_max(match_, number_of(kind));
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    auto* bytes = reinterpret_cast<std::uint8_t*>(out.data());
    return std::min(table_.save(match_, number_of(kind), bytes, out.size()), out.size());
  }
  Status load(SnapshotKind kind, ByteView bytes) override {
    return status_of(table_.load(match_, number_of(kind), bytes_of(bytes), bytes.size()));
  }
  [[nodiscard]] std::uint64_t hash() const override { return table_.hash(match_); }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override;
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override;
  [[nodiscard]] StageTrace step_traced(std::span<const PlayerInput> inputs) override;

  [[nodiscard]] const void* match() const { return match_; }

 private:
  [[nodiscard]] const lockstone_game_input* pass(std::span<const PlayerInput> inputs) {
    for (std::size_t slot = 0; slot < inputs.size(); ++slot)
      passed_[slot] = {bytes_of(inputs[slot].bytes),
                       static_cast<std::uint32_t>(inputs[slot].origin)};
    return passed_.data();
  }

  const lockstone_game_table& table_;
  void* match_;
  SimulationInfo info_{};
  std::array<lockstone_game_input, k_max_players> passed_{};
};

// Interned: a PartHash is a view of a name that lives as long as the program.
std::string_view lasting(const char* name) {
  static thread_local std::array<std::unique_ptr<std::string>, 64> names;
  const std::string_view wanted = name == nullptr ? "" : name;
  for (std::unique_ptr<std::string>& kept : names) {
    if (kept == nullptr) kept = std::make_unique<std::string>(wanted);
    if (*kept == wanted) return *kept;
  }
  return "part";
}

std::size_t LoadedSimulation::part_hashes(std::span<PartHash, k_max_state_parts> out) const {
  static_assert(LOCKSTONE_GAME_MAX_PARTS == k_max_state_parts);
  if (table_.part_hashes == nullptr) return 0;
  std::array<lockstone_game_hash, k_max_state_parts> parts{};
  const std::size_t count = std::min(table_.part_hashes(match_, parts.data()), parts.size());
  for (std::size_t i = 0; i < count; ++i)
    out[i] = {lasting(parts[i].name), {.low = parts[i].low, .high = parts[i].high}};
  return count;
}

StateDifference LoadedSimulation::describe(ByteView here, ByteView there) const {
  StateDifference difference;
  if (table_.describe == nullptr) return difference;
  lockstone_game_difference found{};
  difference.differs = table_.describe(match_, bytes_of(here), here.size(), bytes_of(there),
                                       there.size(), &found) != 0;
  difference.object = found.object;
  difference.store = field_text(found.store);
  difference.name = field_text(found.name);
  difference.field = field_text(found.field);
  difference.here = field_text(found.here);
  difference.there = field_text(found.there);
  return difference;
}

StageTrace LoadedSimulation::step_traced(std::span<const PlayerInput> inputs) {
  StageTrace trace;
  if (table_.step_traced == nullptr) {
    step(inputs);
    return trace;
  }
  std::array<lockstone_game_hash, k_most_stages> stages{};
  const std::size_t count =
      table_.step_traced(match_, pass(inputs), inputs.size(), stages.data(), stages.size());
  for (std::size_t i = 0; i < std::min(count, stages.size()); ++i)
    trace.push_back({text_of(stages[i].name), stages[i].low});
  return trace;
}

Result<std::unique_ptr<Simulation>> make_loaded(const lockstone_game_table& table,
                                                ByteView config) {
  void* match = nullptr;
  const Status status = status_of(table.create(bytes_of(config), config.size(), &match));
  if (status != Status::ok) return status;
  if (match == nullptr) return Status::malformed;
  auto made = std::make_unique<LoadedSimulation>(table, match);
  if (!made->in_range()) return Status::malformed;
  return std::unique_ptr<Simulation>(std::move(made));
}

Result<std::vector<std::byte>> configure_loaded(const lockstone_game_table& table,
                                                const MatchRequest& request) {
  const std::string scene(request.scene);
  const lockstone_game_request asked{
      .scene = scene.c_str(),
      .seed = request.seed,
      .bodies = request.bodies ? std::int64_t{*request.bodies} : std::int64_t{-1},
      .players = request.players};
  std::vector<std::byte> bytes(k_most_config_bytes);
  std::size_t size = bytes.size();
  const Status status =
      status_of(table.configure(&asked, reinterpret_cast<std::uint8_t*>(bytes.data()), &size));
  if (status != Status::ok) return status;
  bytes.resize(std::min(size, bytes.size()));
  return bytes;
}

// The match behind a simulation of this library.
const void* match_of(const Simulation& simulation) {
  const auto* loaded = dynamic_cast<const LoadedSimulation*>(&simulation);
  return loaded == nullptr ? nullptr : loaded->match();
}

bool press_loaded(const lockstone_game_table& table, const BotView& view,
                  std::span<std::byte> out) {
  const void* match = match_of(view.simulation);
  return match != nullptr && table.bot(match, view.seed, static_cast<std::uint32_t>(view.slot),
                                       view.tick, reinterpret_cast<std::uint8_t*>(out.data())) != 0;
}

std::string draw_loaded(const lockstone_game_table& table, const Simulation& simulation) {
  const void* match = match_of(simulation);
  if (match == nullptr) return {};
  std::string picture(table.draw(match, nullptr, 0), '\0');
  picture.resize(std::min(table.draw(match, picture.data(), picture.size()), picture.size()));
  return picture;
}

// The members that every table of this ABI has, up to the last required one.
constexpr std::size_t k_required_bytes = offsetof(lockstone_game_table, part_hashes);

bool is_complete(const lockstone_game_table& table) {
  return table.name != nullptr && *table.name != '\0' && table.create != nullptr &&
         table.destroy != nullptr && table.info != nullptr && table.tick != nullptr &&
         table.step != nullptr && table.snapshot_bytes_max != nullptr && table.save != nullptr &&
         table.load != nullptr && table.hash != nullptr;
}

// The table of this build, with null for the members that an older library does not have.
const lockstone_game_table* full_table(const lockstone_game_table& table) {
  static std::vector<std::unique_ptr<lockstone_game_table>> tables;  // for the process
  tables.push_back(std::make_unique<lockstone_game_table>());
  const std::size_t bytes = std::min<std::size_t>(table.bytes, sizeof(lockstone_game_table));
  std::copy_n(reinterpret_cast<const std::byte*>(&table), bytes,
              reinterpret_cast<std::byte*>(tables.back().get()));
  return tables.back().get();
}

}  // namespace

Result<GameDef> game_of_table(const lockstone_game_table* table, std::string& why) {
  if (table == nullptr || table->abi != LOCKSTONE_GAME_ABI) {
    why = "it is a game of ABI " + std::to_string(table == nullptr ? 0 : table->abi) +
          "; this tool loads ABI " + std::to_string(LOCKSTONE_GAME_ABI) +
          ": build the game with the lockstone/game_abi.h of this tool";
    return Status::unsupported_version;
  }
  if (table->bytes < k_required_bytes || !is_complete(*table)) {
    why = "its table of functions lacks a required one: see lockstone/game_abi.h";
    return Status::malformed;
  }
  const lockstone_game_table& full = *full_table(*table);
  GameDef game;
  game.name = text_of(full.name).substr(0, replay::k_max_game_bytes);
  game.version = text_of(full.version).substr(0, replay::k_max_game_bytes);
  game.build = text_of(full.build);
  game.make = [&full](ByteView config) { return make_loaded(full, config); };
  if (full.configure != nullptr) {
    game.configure = [&full](const MatchRequest& asked) { return configure_loaded(full, asked); };
  }
  for (std::size_t i = 0; full.scenes != nullptr && i < full.scene_count; ++i) {
    const lockstone_game_scene& scene = full.scenes[i];
    game.scenes.push_back({text_of(scene.name), text_of(scene.description), scene.ticks});
  }
  if (full.bot != nullptr) {
    game.bot = [&full](const BotView& view, std::span<std::byte> out) {
      return press_loaded(full, view, out);
    };
  }
  if (full.draw != nullptr) {
    game.draw = [&full](const Simulation& simulation) { return draw_loaded(full, simulation); };
  }
  return game;
}

#if defined(LOCKSTONE_WITH_GAME_LIBRARIES)

Result<GameDef> load_game(const std::string& path, std::string& why) {
  using Entry = const lockstone_game_table* (*)();
  // A bare name is a file here, not one of the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    why = text_of(dlerror());
    return Status::io_error;
  }
  const auto entry = reinterpret_cast<Entry>(dlsym(library, "lockstone_game"));
  if (entry == nullptr) {
    why = "it exports no lockstone_game: see LOCKSTONE_GAME_LIBRARY in lockstone/game_library.h";
    return Status::io_error;
  }
  return game_of_table(entry(), why);
}

#else

Result<GameDef> load_game(const std::string&, std::string& why) {
  why = "this build loads no libraries; use the game's own tool";
  return Status::incompatible;
}

#endif

}  // namespace lockstone::tool
