// All that a world needs before it can take states: bytes that a viewer makes the same world from.
#pragma once

#include <cstddef>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/status.h>
#include <lockstone/world.h>

namespace lockstone::watch {

/// First byte of a message to viewers.
enum class ViewMessage : std::uint8_t { description = 1, state = 2 };

/// Every packet to a viewer begins with one of them; a message may take several packets.
enum class ViewPart : std::uint8_t { last = 0, more = 1 };

/// The message of this world: definition and assets.
[[nodiscard]] std::vector<std::byte> describe_world(const World& world);

/// An empty world that takes the states of the described one. The bytes may come from anywhere:
/// truncated, malformed; incompatible: of another simulation ABI; or the refusal of a part.
[[nodiscard]] Result<World> described_world(ByteView message);

}  // namespace lockstone::watch
