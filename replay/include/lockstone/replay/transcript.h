// One value for all that was played, which server and clients can compare after a match.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <lockstone/simulation.h>

namespace lockstone::replay {

using TranscriptHash = std::array<std::byte, 32>;

/// 64 hexadecimal digits.
[[nodiscard]] std::string to_text(const TranscriptHash& hash);

/// SHA-256 over the confirmed inputs and commands of consecutive ticks, origins included
/// (docs/reference/replay-format.md, "Transcript"). Two sides that were given the same ticks have
/// the same value, and nobody can find other inputs that give it. The recorder puts it into the
/// END.
class Transcript {
 public:
  Transcript();
  ~Transcript();
  Transcript(Transcript&&) noexcept;
  Transcript& operator=(Transcript&&) noexcept;

  /// Adds the inputs that took the match from `tick` to `tick + 1`, in slot order, and the commands
  /// in theirs. Never allocates.
  void add(std::uint64_t tick, std::span<const PlayerInput> inputs,
           std::span<const PlayerCommand> commands = {});

  /// Of all ticks so far; more may follow.
  [[nodiscard]] TranscriptHash value() const;

 private:
  void add_commands(std::span<const PlayerCommand> commands);

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lockstone::replay
