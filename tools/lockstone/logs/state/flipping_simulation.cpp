#include "tools/lockstone/logs/state/flipping_simulation.h"

#include <utility>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/world.h>

#include "tools/tool/games.h"

namespace lockstone::tool {
namespace {

// The lowest bit of the position along x of the last dynamic body that is awake: the smallest error
// there is. It stays where a game sets velocities in every tick. A native copy makes the derived
// data fit again.
void disturb(const GameDef& game, Simulation& simulation) {
  World* world = world_of(game, simulation);
  if (world == nullptr) return;
  for (std::uint32_t index = world->body_limit(); index-- > 0;) {
    const BodyHandle body = world->body_at(index);
    if (body.is_null()) continue;
    const BodyView view = world->body(body);
    if (view.motion != MotionType::dynamic || view.is_asleep) continue;
    LKS_CHECK(world->flip_bit("body", index, "position.x", 0));
    std::vector<std::byte> bytes(world->snapshot_bytes_max(SnapshotKind::native));
    bytes.resize(world->save(SnapshotKind::native, bytes));
    LKS_CHECK(world->load(SnapshotKind::native, bytes) == Status::ok);
    return;
  }
}

class FlippingSimulation final : public Simulation {
 public:
  FlippingSimulation(const GameDef& game, std::unique_ptr<Simulation> inner, std::uint64_t tick)
      : game_(game), inner_(std::move(inner)), tick_(tick) {}

  [[nodiscard]] SimulationInfo info() const override { return inner_->info(); }
  [[nodiscard]] std::uint64_t tick() const override { return inner_->tick(); }
  void command(const PlayerCommand& command) override { inner_->command(command); }
  void step(std::span<const PlayerInput> inputs) override {
    const bool now = inner_->tick() == tick_;
    inner_->step(inputs);
    if (now) disturb(game_, *inner_);
  }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return inner_->snapshot_bytes_max(kind);
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    return inner_->save(kind, out);
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return inner_->load(kind, bytes); }
  void keep_history(std::uint32_t ticks) override { inner_->keep_history(ticks); }
  [[nodiscard]] IslandWork island_work() const override { return inner_->island_work(); }
  void forget_history() override { inner_->forget_history(); }
  [[nodiscard]] std::uint64_t hash() const override { return inner_->hash(); }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    return inner_->part_hashes(out);
  }
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return inner_->describe(here, there);
  }
  [[nodiscard]] const Simulation& inner() const { return *inner_; }

 private:
  const GameDef& game_;
  std::unique_ptr<Simulation> inner_;
  std::uint64_t tick_;
};

}  // namespace

std::unique_ptr<Simulation> make_flipping(const GameDef& game, std::unique_ptr<Simulation> inner,
                                          std::uint64_t tick) {
  return std::make_unique<FlippingSimulation>(game, std::move(inner), tick);
}

const Simulation& unwrapped(const Simulation& simulation) {
  const auto* flipping = dynamic_cast<const FlippingSimulation*>(&simulation);
  return flipping == nullptr ? simulation : flipping->inner();
}

}  // namespace lockstone::tool
