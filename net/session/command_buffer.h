// Player commands in the order in which they came, in memory that never grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

/// The commands of one side that wait: for their way over the network, or for a tick.
inline constexpr std::size_t k_waiting_command_bytes = 2 * k_max_command_bytes;
inline constexpr std::size_t k_max_waiting_commands = 64;

/// A ring of commands, each in one piece. They are numbered from 0 on; a number is never used
/// again. The last one may still be incomplete. Allocates when made only.
class CommandBuffer {
 public:
  /// A command of the ring.
  struct Entry {
    std::uint64_t tick = 0;
    std::uint8_t slot = 0;
    std::size_t at = 0;  ///< within the ring
    std::size_t size = 0;
    std::size_t filled = 0;  ///< bytes that have come
    [[nodiscard]] bool complete() const { return filled == size; }
  };

  CommandBuffer() = default;
  CommandBuffer(std::size_t bytes, std::size_t commands)
      : capacity_(bytes), entries_(commands), bytes_(new std::byte[bytes]) {}

  /// The numbers of the commands that are here: begin() … end() - 1.
  [[nodiscard]] std::uint64_t begin() const { return begin_; }
  [[nodiscard]] std::uint64_t end() const { return end_; }
  [[nodiscard]] bool empty() const { return begin_ == end_; }

  [[nodiscard]] const Entry& entry(std::uint64_t number) const;
  [[nodiscard]] ByteView bytes(std::uint64_t number) const;
  /// The oldest or newest one; there is one.
  [[nodiscard]] const Entry& first() const { return entry(begin_); }
  [[nodiscard]] const Entry& last() const { return entry(end_ - 1); }

  /// The number of the first command of `tick` or later.
  [[nodiscard]] std::uint64_t first_of(std::uint64_t tick) const;

  /// Makes room for a command of `size` bytes, above 0. False, and nothing changes, without it.
  [[nodiscard]] bool open(std::uint64_t tick, std::uint8_t slot, std::size_t size);
  /// More bytes of the last command; no more than it lacks.
  void append(ByteView piece);
  /// Both at once.
  [[nodiscard]] bool push(std::uint64_t tick, const PlayerCommand& command);

  /// Forgets the oldest one.
  void pop();
  /// Forgets the last one if it is incomplete; its number is used for the next one.
  void drop_incomplete();
  /// Forgets all; `next` is the number of the next one.
  void restart(std::uint64_t next);

 private:
  [[nodiscard]] Entry& place(std::uint64_t number);
  [[nodiscard]] bool find_room(std::size_t size, std::size_t& at) const;

  std::size_t capacity_ = 0;
  std::vector<Entry> entries_;
  std::unique_ptr<std::byte[]> bytes_;  ///< not initialised: unused pages cost no memory
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
};

/// The commands of consecutive ticks, in the order in which they act.
class TickCommands {
 public:
  /// So much of a match's commands is kept; those of a full ring wait for their tick.
  static constexpr std::size_t k_ring_bytes = 4 << 20;
  static constexpr std::size_t k_ring_commands = 1024;

  /// `spare_bytes`: room for more than another one's ring holds.
  explicit TickCommands(std::size_t spare_bytes = 0);

  [[nodiscard]] CommandBuffer& ring() { return ring_; }
  [[nodiscard]] const CommandBuffer& ring() const { return ring_; }

  /// Whole commands of a tick, until the next call.
  [[nodiscard]] std::span<const PlayerCommand> of(std::uint64_t tick) const;

  /// Whether `count` commands of `tick` are here.
  [[nodiscard]] bool has(std::uint64_t tick, std::size_t count) const;

  /// Commands of ticks below are not needed any more.
  void forget_before(std::uint64_t tick);
  void clear() { ring_.restart(ring_.end()); }

 private:
  CommandBuffer ring_;
  mutable std::vector<PlayerCommand> found_;
};

}  // namespace lockstone::net
