// Rollback that computes only the islands that a wrong guess touched.
//
// An island's next state depends on that island, on the bodies that its swept bounds meet, and on
// nothing else (docs/explanation/locality.md). So a tick can be remembered island by island: a
// history keeps the states before and after the last ticks. Where a tick is stepped again, it
// compares the state with the one before that tick, byte for byte; islands that nothing different
// can reach take their results from memory, and only the others are computed. Nothing is tracked
// from command to command, and a game may do anything between steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <lockstone/world.h>

namespace lockstone {

/// The most ticks that a RollbackHistory keeps.
inline constexpr std::uint32_t k_max_history_ticks = 256;

/// Steps a world, and remembers its last ticks. Derived: it is neither saved nor hashed, and may be
/// dropped at any time. A world that is stepped with a history has the same states and events as
/// one that is not, always.
class RollbackHistory {
 public:
  /// Keeps `ticks` ticks, at most k_max_history_ticks, of `world`, which must outlive this; moving
  /// the world is allowed. With 0 it only steps the world, and takes no memory. No function but
  /// this allocates. A tick takes the bytes of two native snapshots, and of events and pairs;
  /// `bytes_max` bounds all.
  explicit RollbackHistory(World& world, std::uint32_t ticks = 0);
  ~RollbackHistory();
  RollbackHistory(RollbackHistory&&) noexcept;
  RollbackHistory& operator=(RollbackHistory&&) noexcept;

  /// Advances the world by a tick, as World::step does. The report tells how many islands were
  /// computed and recalled; its counts of work are those of the computed islands. While a world
  /// traces or validates its stages, all is computed.
  StepReport step();

  /// Forgets all ticks: the next steps compute everything.
  void forget();

  /// The memory that a full history of such a world may take.
  [[nodiscard]] std::size_t bytes_max() const;

  /// Flips a bit of the state that is remembered before or after a tick, as a hardware fault would,
  /// to test the checks that must find it. False when there is no such tick or bit.
  enum class Side : std::uint8_t { before, after };
  bool flip_bit(std::uint64_t tick, Side side, std::size_t bit);

 private:
  struct Impl;
  World::Impl* world_;
  std::unique_ptr<Impl> impl_;  // null without memory
};

}  // namespace lockstone
