// Knows the correct course of a match, and checks every peer against it at every tick.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::simnet {

/// The server's confirmed ticks are the truth about inputs; a run of these inputs without any
/// network is the truth about states. The first violation stays.
class Oracle {
 public:
  /// `reference` stands at tick 0. Every this many ticks it is saved and loaded, so that whatever a
  /// snapshot forgets shows.
  Oracle(std::unique_ptr<Simulation> reference, std::uint64_t expected_ticks);

  /// Of the tick that is confirmed next.
  void commands_confirmed(std::span<const PlayerCommand> commands);
  void confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                 std::optional<std::uint64_t> hash);
  void stepped(std::size_t client, std::uint64_t tick, std::span<const PlayerInput> inputs,
               std::uint64_t hash);
  void fail(const std::string& what);
  /// This client is a control: it may go wrong from `tick` on.
  void excuse(std::size_t client, std::uint64_t tick) { excused_ = client, excused_tick_ = tick; }
  /// No further tick will be confirmed.
  void set_over() { over_ = true; }
  [[nodiscard]] bool over() const { return over_; }

  [[nodiscard]] const std::string& failure() const { return failure_; }
  [[nodiscard]] std::uint64_t ticks() const { return truth_.size(); }
  [[nodiscard]] std::uint64_t last_hash() const { return truth_.empty() ? 0 : truth_.back().hash; }
  [[nodiscard]] std::uint64_t comparisons() const { return comparisons_; }

 private:
  struct Tick {
    std::uint64_t inputs;  ///< a hash of all bytes and origins
    std::uint64_t hash;    ///< of the state after it
  };
  void reload();

  std::unique_ptr<Simulation> reference_;
  std::vector<std::byte> snapshot_;
  std::vector<Tick> truth_;
  std::uint64_t comparisons_ = 0;
  std::size_t excused_ = ~std::size_t{0};
  std::uint64_t excused_tick_ = 0;
  bool over_ = false;
  std::string failure_;
};

}  // namespace lockstone::simnet
