// A game given by a table of functions, as a Simulation: see lockstone/game_abi.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <lockstone/game_abi.h>
#include <lockstone/simulation.h>

#include "tools/lockstone/logs/bisect/stage_trace.h"

namespace lockstone::tool {

/// The same table with null for the members that an older game does not have. Its texts are the
/// caller's. On an error, `why` names the fault: unsupported_version, a table of another ABI;
/// malformed, a required function is missing.
[[nodiscard]] Result<std::shared_ptr<const lockstone_game_table>> full_table(
    const lockstone_game_table* table, std::string& why);

/// A status by its number; a number that is none is malformed.
[[nodiscard]] Status game_status(std::int32_t code);

/// A match inside a game.
class LoadedSimulation final : public Simulation, public SelfTracing {
 public:
  LoadedSimulation(std::shared_ptr<const lockstone_game_table> table, void* match);
  ~LoadedSimulation() override { table_->destroy(match_); }
  LoadedSimulation(const LoadedSimulation&) = delete;
  LoadedSimulation& operator=(const LoadedSimulation&) = delete;

  /// Whether the game's tick rate, players and input bytes are those of a session.
  [[nodiscard]] bool in_range() const;

  [[nodiscard]] SimulationInfo info() const override { return info_; }
  [[nodiscard]] std::uint64_t tick() const override { return table_->tick(match_); }
  void step(std::span<const PlayerInput> inputs) override;
  void command(const PlayerCommand& command) override;
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override;
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override;
  Status load(SnapshotKind kind, ByteView bytes) override;
  void keep_history(std::uint32_t ticks) override {
    if (table_->keep_history != nullptr) table_->keep_history(match_, ticks);
  }
  void forget_history() override {
    if (table_->forget_history != nullptr) table_->forget_history(match_);
  }
  [[nodiscard]] std::uint64_t hash() const override { return table_->hash(match_); }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override;
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override;
  [[nodiscard]] StageTrace step_traced(std::span<const PlayerInput> inputs) override;

  [[nodiscard]] void* match() const { return match_; }

 private:
  [[nodiscard]] const lockstone_game_input* pass(std::span<const PlayerInput> inputs);

  std::shared_ptr<const lockstone_game_table> table_;
  void* match_;
  SimulationInfo info_{};
  std::array<lockstone_game_input, k_max_players> passed_{};
};

/// The game's match for these configuration bytes.
[[nodiscard]] Result<std::unique_ptr<Simulation>> make_loaded(
    const std::shared_ptr<const lockstone_game_table>& table, ByteView config);

}  // namespace lockstone::tool
