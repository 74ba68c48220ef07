// A scene on a bare world as a lockstone::Simulation. Where nobody plays it has one slot, whose
// single input byte is not looked at.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

#include <lockstone/rollback_history.h>
#include <lockstone/simulation.h>
#include <lockstone/world.h>

#include "tools/scenes/scene.h"

namespace lockstone::scenes {

inline constexpr std::uint32_t k_config_magic = 0x43534b4c;  // "LKSC"
inline constexpr std::uint16_t k_config_version = 1;
inline constexpr std::size_t k_config_bytes = 32;

/// The configuration bytes of a scene: magic, version, seed, name (padded with zeros).
[[nodiscard]] std::array<std::byte, k_config_bytes> encode_config(std::string_view name,
                                                                  std::uint64_t seed);

class SceneSimulation final : public Simulation {
 public:
  /// `spare_bodies`: room for more bodies than the scene asks for, which changes none of its
  /// states. `values`: some that scene_values takes.
  SceneSimulation(const Scene& scene, std::uint64_t seed,
                  BroadPhaseKind broad_phase = BroadPhaseKind::tree, std::uint32_t spare_bodies = 0,
                  std::span<const std::int32_t> values = {});

  [[nodiscard]] SimulationInfo info() const override { return info_; }
  [[nodiscard]] std::uint64_t tick() const override { return world_.tick(); }
  void step(std::span<const PlayerInput> inputs) override;
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return world_.snapshot_bytes_max(kind);
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    return world_.save(kind, out);
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return world_.load(kind, bytes); }
  void keep_history(std::uint32_t ticks) override { history_ = RollbackHistory(world_, ticks); }
  void forget_history() override { history_.forget(); }
  [[nodiscard]] IslandWork island_work() const override {
    return {last_report_.computed_islands, last_report_.recalled_islands};
  }
  [[nodiscard]] std::uint64_t hash() const override { return world_.hash().total; }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override;
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return world_.describe_difference(here, there);
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] World& world_for_tests() { return world_; }
  [[nodiscard]] const StepReport& last_report() const { return last_report_; }

 private:
  const Scene& scene_;
  std::uint64_t seed_;
  World world_;
  RollbackHistory history_{world_};
  SimulationInfo info_;
  StepReport last_report_{};
};

/// Makes a scene from encode_config's bytes.
[[nodiscard]] Result<std::unique_ptr<Simulation>> make_scene(ByteView config);

}  // namespace lockstone::scenes
