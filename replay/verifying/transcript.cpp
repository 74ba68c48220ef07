#include <lockstone/bytes.h>
#include <lockstone/replay/transcript.h>

#include "replay/bytes/sha256.h"
#include "replay/bytes/text.h"

namespace lockstone::replay {
namespace {

// Set in the number of players where commands follow.
constexpr std::uint8_t k_has_commands = 0x80;
static_assert(k_max_players < k_has_commands);

}  // namespace

struct Transcript::Parts {
  Sha256 hash;
};

Transcript::Transcript() : parts_(std::make_unique<Parts>()) {}
Transcript::~Transcript() = default;
Transcript::Transcript(Transcript&&) noexcept = default;
Transcript& Transcript::operator=(Transcript&&) noexcept = default;

void Transcript::add(std::uint64_t tick, std::span<const PlayerInput> inputs,
                     std::span<const PlayerCommand> commands) {
  std::array<std::byte, sizeof(tick) + 1> head{};
  ByteWriter writer(head);
  writer.put(tick);
  const std::uint8_t mark = commands.empty() ? 0 : k_has_commands;
  writer.put(static_cast<std::uint8_t>(inputs.size() | mark));
  parts_->hash.update(head);
  for (const PlayerInput& input : inputs) {
    const std::array<std::byte, 2> front{static_cast<std::byte>(input.origin),
                                         static_cast<std::byte>(input.bytes.size())};
    parts_->hash.update(front);
    parts_->hash.update(input.bytes);
  }
  if (!commands.empty()) add_commands(commands);
}

void Transcript::add_commands(std::span<const PlayerCommand> commands) {
  const std::array<std::byte, 1> count{static_cast<std::byte>(commands.size())};
  parts_->hash.update(count);
  for (const PlayerCommand& command : commands) {
    std::array<std::byte, 5> front{};
    ByteWriter writer(front);
    writer.put(command.slot);
    writer.put(static_cast<std::uint32_t>(command.bytes.size()));
    parts_->hash.update(front);
    parts_->hash.update(command.bytes);
  }
}

TranscriptHash Transcript::value() const {
  return parts_->hash.value();
}

std::string to_text(const TranscriptHash& hash) {
  return hex_digits(hash);
}

}  // namespace lockstone::replay
