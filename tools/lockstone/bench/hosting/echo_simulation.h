// Simulations for players that cost next to nothing: the server's one tells its hashes, the
// players' ones repeat them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <lockstone/hash.h>
#include <lockstone/simulation.h>

namespace lockstone::tool {

/// The hashes of one match's last ticks.
class HashBoard {
 public:
  struct Tick {
    std::uint64_t hash = 0;
    std::array<PartHash, k_max_state_parts> parts{};
    std::size_t part_count = 0;
  };

  explicit HashBoard(const SimulationInfo& info) : info_(info), ticks_(k_ticks) {}

  [[nodiscard]] const SimulationInfo& info() const { return info_; }
  void note(std::uint64_t tick, const Tick& state) {
    const std::lock_guard lock(mutex_);
    ticks_[tick % k_ticks] = state;
  }
  [[nodiscard]] Tick at(std::uint64_t tick) const {
    const std::lock_guard lock(mutex_);
    return ticks_[tick % k_ticks];
  }

 private:
  static constexpr std::size_t k_ticks = 512;
  SimulationInfo info_;
  mutable std::mutex mutex_;
  std::vector<Tick> ticks_;
};

/// By the configuration of the match, which no two matches share.
class HashBoards {
 public:
  std::shared_ptr<HashBoard> make(ByteView config, const SimulationInfo& info) {
    const std::lock_guard lock(mutex_);
    return boards_[hash64(config)] = std::make_shared<HashBoard>(info);
  }
  [[nodiscard]] std::shared_ptr<HashBoard> find(ByteView config) const {
    const std::lock_guard lock(mutex_);
    const auto found = boards_.find(hash64(config));
    return found == boards_.end() ? nullptr : found->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<HashBoard>> boards_;
};

/// The server's: a real one, whose hashes go to the board.
class TellingSimulation final : public Simulation {
 public:
  TellingSimulation(std::unique_ptr<Simulation> real, std::shared_ptr<HashBoard> board)
      : real_(std::move(real)), board_(std::move(board)) {
    tell();
  }
  [[nodiscard]] SimulationInfo info() const override { return real_->info(); }
  [[nodiscard]] std::uint64_t tick() const override { return real_->tick(); }
  void command(const PlayerCommand& command) override { real_->command(command); }
  void step(std::span<const PlayerInput> inputs) override {
    real_->step(inputs);
    tell();
  }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return real_->snapshot_bytes_max(kind);
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    return real_->save(kind, out);
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return real_->load(kind, bytes); }
  [[nodiscard]] std::uint64_t hash() const override { return told_.hash; }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    return real_->part_hashes(out);
  }
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return real_->describe(here, there);
  }

 private:
  // The session asks for parts every 64 ticks.
  void tell() {
    constexpr std::uint64_t k_parts_every = 64;
    told_.hash = real_->hash();
    told_.part_count = real_->tick() % k_parts_every == 0 ? real_->part_hashes(told_.parts) : 0;
    board_->note(real_->tick(), told_);
  }

  std::unique_ptr<Simulation> real_;
  std::shared_ptr<HashBoard> board_;
  HashBoard::Tick told_;
};

/// A player's: it has no state but the tick.
class EchoSimulation final : public Simulation {
 public:
  explicit EchoSimulation(std::shared_ptr<HashBoard> board) : board_(std::move(board)) {}
  [[nodiscard]] SimulationInfo info() const override { return board_->info(); }
  [[nodiscard]] std::uint64_t tick() const override { return tick_; }
  void step(std::span<const PlayerInput>) override { ++tick_; }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind) const override { return 0; }
  [[nodiscard]] std::size_t save(SnapshotKind, std::span<std::byte>) const override { return 0; }
  Status load(SnapshotKind, ByteView) override { return Status::malformed; }
  [[nodiscard]] std::uint64_t hash() const override { return board_->at(tick_).hash; }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    const HashBoard::Tick state = board_->at(tick_);
    std::copy(state.parts.begin(), state.parts.end(), out.begin());
    return state.part_count;
  }
  [[nodiscard]] StateDifference describe(ByteView, ByteView) const override { return {}; }

 private:
  std::shared_ptr<HashBoard> board_;
  std::uint64_t tick_ = 0;
};

}  // namespace lockstone::tool
