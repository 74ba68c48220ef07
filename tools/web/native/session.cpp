// Bots in a browser, and a fault for tests.
#include <array>
#include <vector>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"
#include "tools/bindings/c/game_handles.h"
#include "tools/web/native/lockstone_web_session.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

arena::ArenaSimulation& arena_of(const lks_simulation* simulation) {
  Simulation* match = required(simulation, "simulation").simulation.get();
  auto* found = dynamic_cast<arena::ArenaSimulation*>(match);
  if (found == nullptr) throw_status(LKS_NOT_FOUND, "the match is not one of the arena");
  return *found;
}

// The lowest bit of the position along x of the last dynamic body that is awake: it stays where a
// game sets velocities in every tick. A native copy makes the derived data fit again.
bool flip(World& world) {
  for (std::uint32_t index = world.body_limit(); index-- > 0;) {
    const BodyHandle body = world.body_at(index);
    if (body.is_null()) continue;
    const BodyView view = world.body(body);
    if (view.motion != MotionType::dynamic || view.is_asleep) continue;
    std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::native));
    if (!world.flip_bit("body", index, "position.x", 0)) return false;
    bytes.resize(world.save(SnapshotKind::native, bytes));
    return world.load(SnapshotKind::native, bytes) == Status::ok;
  }
  return false;
}

}  // namespace

lks_status lks_web_bot(const lks_simulation* simulation, uint64_t seed, uint32_t slot, void* out,
                       size_t capacity, size_t* bytes) {
  return call([&] {
    const arena::Arena& arena = arena_of(simulation).arena();
    if (slot >= arena.config.players) throw_invalid("slot", "is no player's");
    std::array<std::byte, arena::k_input_bytes> input{};
    arena::bot_input(arena, seed, slot).encode(input);
    give_bytes(input, out, capacity, required(bytes, "bytes"), "the input");
  });
}

lks_status lks_web_flip(const lks_simulation* simulation) {
  return call([&] {
    if (!flip(arena_of(simulation).arena_for_tests().world))
      throw_status(LKS_NOT_FOUND, "no body moves");
  });
}
