// Games and simulations.
#include "tools/bindings/c/game_handles.h"
#include "tools/bindings/c/handles.h"
#include "tools/scenes/play.h"
#include "tools/tool/loaded_simulation.h"

namespace lockstone::c {

std::unique_ptr<lks_simulation> make_handle(std::shared_ptr<const Game> game,
                                            std::vector<std::byte> config,
                                            std::unique_ptr<Simulation> simulation) {
  auto match = std::make_shared<Match>();
  match->game = std::move(game);
  match->config = std::move(config);
  match->simulation = std::move(simulation);
  auto handle = std::make_unique<lks_simulation>();
  handle->simulation = {match, match->simulation.get()};
  handle->match = std::move(match);
  return handle;
}

FlatInputs::FlatInputs(const SimulationInfo& info, const void* inputs, std::size_t bytes,
                       const std::uint32_t* origins)
    : count_(info.player_count) {
  const std::size_t expected = std::size_t{info.player_count} * info.input_bytes;
  if (bytes != expected) {
    throw_invalid("bytes", "is " + std::to_string(bytes) + "; the players' inputs have " +
                               std::to_string(expected));
  }
  const ByteView all = bytes_of(inputs, bytes, "inputs");
  for (std::size_t slot = 0; slot < count_; ++slot) {
    inputs_[slot].bytes = all.subspan(slot * info.input_bytes, info.input_bytes);
    if (origins == nullptr) continue;
    inputs_[slot].origin =
        enumerator(origins[slot], InputOrigin::received, InputOrigin::absent, "origins");
  }
}

void give_bytes(ByteView bytes, void* out, std::size_t capacity, std::size_t& count,
                std::string_view name) {
  array(out, capacity, "out");
  count = bytes.size();
  if (bytes.size() > capacity) {
    throw_status(LKS_BUFFER_TOO_SMALL,
                 std::string(name) + " has " + std::to_string(bytes.size()) + " bytes");
  }
  if (!bytes.empty()) std::memcpy(out, bytes.data(), bytes.size());
}

namespace {

Simulation& read(const lks_simulation* simulation) {
  return *required(simulation, "simulation").simulation;
}

Simulation& write(lks_simulation* simulation) {
  const std::shared_ptr<Match>& match = required(simulation, "simulation").match;
  if (match == nullptr || match->in_session)
    throw_status(LKS_READ_ONLY, "a session steps this simulation");
  return *match->simulation;
}

SnapshotKind kind_of(std::uint32_t kind) {
  return enumerator(kind, SnapshotKind::native, SnapshotKind::canonical, "kind");
}

}  // namespace
}  // namespace lockstone::c

using namespace lockstone;
using namespace lockstone::c;

lks_status lks_game_create(const lockstone_game_table* table, lks_game** out) {
  return call([&] {
    required(table, "table");
    required(out, "out");
    std::string why;
    auto full = tool::full_table(table, why);
    if (!full.ok()) throw_status(static_cast<lks_status>(full.status()), why);
    auto game = std::make_shared<Game>();
    game->name = full.value()->name;
    if (full.value()->version != nullptr) game->version = full.value()->version;
    game->make = [table = full.value()](ByteView config) {
      return tool::make_loaded(table, config);
    };
    *out = new lks_game{std::move(game)};
  });
}

lks_status lks_game_builtin(lks_game** out) {
  return call([&] {
    required(out, "out");
    auto game = std::make_shared<Game>();
    game->make = scenes::make_simulation;
    *out = new lks_game{std::move(game)};
  });
}

void lks_game_destroy(lks_game* game) {
  delete game;
}

lks_status lks_simulation_create(const lks_game* game, const void* config, size_t config_bytes,
                                 lks_simulation** out) {
  return call([&] {
    const auto& shared = required(game, "game").game;
    required(out, "out");
    const ByteView bytes = bytes_of(config, config_bytes, "config");
    auto made = shared->make(bytes);
    if (!made.ok()) {
      throw_status(static_cast<lks_status>(made.status()),
                   "the game refuses the configuration: " + std::string(to_string(made.status())));
    }
    *out = make_handle(shared, {bytes.begin(), bytes.end()}, std::move(made).value()).release();
  });
}

void lks_simulation_destroy(lks_simulation* simulation) {
  delete simulation;
}

lks_status lks_simulation_get_info(const lks_simulation* simulation, lks_simulation_info* out) {
  return call([&] {
    const SimulationInfo info = read(simulation).info();
    required(out, "out") = {info.config_hash, info.scene_hash,   info.canary,     info.abi,
                            info.tick_rate,   info.player_count, info.input_bytes};
  });
}

lks_status lks_simulation_tick(const lks_simulation* simulation, uint64_t* out) {
  return call([&] {
    const Simulation& source = read(simulation);
    required(out, "out") = source.tick();
  });
}

lks_status lks_simulation_match(const lks_simulation* simulation, void** out) {
  return call([&] {
    const auto* loaded = dynamic_cast<const tool::LoadedSimulation*>(&read(simulation));
    required(out, "out") = loaded == nullptr ? nullptr : loaded->match();
  });
}

lks_status lks_simulation_world(const lks_simulation* simulation, lks_world** out) {
  return call([&] {
    const std::shared_ptr<Simulation>& match = required(simulation, "simulation").simulation;
    required(out, "out");
    const World* seen = scenes::world_of(*match);
    if (seen == nullptr) throw_status(LKS_NOT_FOUND, "the game is not one of the built-in ones");
    auto world = std::make_unique<lks_world>();
    world->shown = {match, seen};
    *out = world.release();
  });
}

lks_status lks_simulation_step(lks_simulation* simulation, const void* inputs, size_t bytes,
                               const uint32_t* origins) {
  return call([&] {
    Simulation& target = write(simulation);
    target.step(FlatInputs(target.info(), inputs, bytes, origins).list());
  });
}

lks_status lks_simulation_command(lks_simulation* simulation, uint32_t slot, const void* bytes,
                                  size_t count) {
  return call([&] {
    Simulation& target = write(simulation);
    if (slot >= target.info().player_count && slot != k_server_slot)
      throw_invalid("slot", "there is no such slot");
    if (count == 0 || count > k_max_command_bytes) throw_invalid("count", "must be 1 … 65536");
    target.command({static_cast<std::uint8_t>(slot), bytes_of(bytes, count, "bytes")});
  });
}

lks_status lks_simulation_hash(const lks_simulation* simulation, uint64_t* out) {
  return call([&] {
    const Simulation& source = read(simulation);
    required(out, "out") = source.hash();
  });
}

lks_status lks_simulation_snapshot_bytes_max(const lks_simulation* simulation, uint32_t kind,
                                             size_t* out) {
  return call([&] {
    const Simulation& source = read(simulation);
    required(out, "out") = source.snapshot_bytes_max(kind_of(kind));
  });
}

// A simulation demands room for the largest state there can be.
lks_status lks_simulation_save(const lks_simulation* simulation, uint32_t kind, void* out,
                               size_t capacity, size_t* bytes) {
  return call([&] {
    const Simulation& source = read(simulation);
    const SnapshotKind form = kind_of(kind);
    required(bytes, "bytes");
    auto* room = static_cast<std::byte*>(array(out, capacity, "out"));
    const std::size_t most = source.snapshot_bytes_max(form);
    if (capacity < most) {
      *bytes = most;
      throw_status(LKS_BUFFER_TOO_SMALL, "a snapshot has up to " + std::to_string(most) + " bytes");
    }
    *bytes = source.save(form, {room, most});
  });
}

lks_status lks_simulation_load(lks_simulation* simulation, uint32_t kind, const void* bytes,
                               size_t count) {
  return call([&] {
    Simulation& target = write(simulation);
    const Status status = target.load(kind_of(kind), bytes_of(bytes, count, "bytes"));
    if (status != Status::ok) throw_failure(status);
  });
}
