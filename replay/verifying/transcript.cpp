#include <lockstone/bytes.h>
#include <lockstone/replay/transcript.h>

#include "replay/bytes/sha256.h"
#include "replay/bytes/text.h"

namespace lockstone::replay {

struct Transcript::Parts {
  Sha256 hash;
};

Transcript::Transcript() : parts_(std::make_unique<Parts>()) {}
Transcript::~Transcript() = default;
Transcript::Transcript(Transcript&&) noexcept = default;
Transcript& Transcript::operator=(Transcript&&) noexcept = default;

void Transcript::add(std::uint64_t tick, std::span<const PlayerInput> inputs) {
  std::array<std::byte, sizeof(tick) + 1> head{};
  ByteWriter writer(head);
  writer.put(tick);
  writer.put(static_cast<std::uint8_t>(inputs.size()));
  parts_->hash.update(head);
  for (const PlayerInput& input : inputs) {
    const std::array<std::byte, 2> front{static_cast<std::byte>(input.origin),
                                         static_cast<std::byte>(input.bytes.size())};
    parts_->hash.update(front);
    parts_->hash.update(input.bytes);
  }
}

TranscriptHash Transcript::value() const {
  return parts_->hash.value();
}

std::string to_text(const TranscriptHash& hash) {
  return hex_digits(hash);
}

}  // namespace lockstone::replay
