// The arena as a lockstone::Simulation: an example for a game of your own.
#pragma once

#include <memory>

#include <lockstone/rollback_history.h>
#include <lockstone/simulation.h>
#include <lockstone/world.h>

#include "tools/arena/arena.h"

namespace lockstone::arena {

class ArenaSimulation final : public Simulation {
 public:
  /// `config` is within its documented ranges.
  explicit ArenaSimulation(const ArenaConfig& config,
                           BroadPhaseKind broad_phase = BroadPhaseKind::tree);

  [[nodiscard]] SimulationInfo info() const override { return info_; }
  [[nodiscard]] std::uint64_t tick() const override { return arena_.world.tick(); }
  void step(std::span<const PlayerInput> inputs) override;
  void command(const PlayerCommand& command) override;
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override;
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override;
  Status load(SnapshotKind kind, ByteView bytes) override;
  void keep_history(std::uint32_t ticks) override {
    arena_.history = RollbackHistory(arena_.world, ticks);
  }
  void forget_history() override { arena_.history.forget(); }
  [[nodiscard]] IslandWork island_work() const override {
    return {last_report_.computed_islands, last_report_.recalled_islands};
  }
  [[nodiscard]] std::uint64_t hash() const override;
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override;
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override;

  /// To look at: for rendering, statistics and the bots.
  [[nodiscard]] const Arena& arena() const { return arena_; }
  [[nodiscard]] const StepReport& last_report() const { return last_report_; }

  /// Test hooks: derived data may be dropped, and state changed behind the game's back, at any
  /// time.
  [[nodiscard]] Arena& arena_for_tests() { return arena_; }

 private:
  struct Parts;
  [[nodiscard]] Result<Parts> split(ByteView canonical) const;
  [[nodiscard]] std::string name_of_body(ByteView world_bytes, std::uint64_t index) const;

  Arena arena_;
  SimulationInfo info_;
  StepReport last_report_{};
};

/// Makes the arena from ArenaConfig::encode's bytes.
[[nodiscard]] Result<std::unique_ptr<Simulation>> make_arena(ByteView config);

}  // namespace lockstone::arena
