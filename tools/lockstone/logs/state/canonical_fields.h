// The fields of a world's canonical snapshot, where they stand, for experiments on its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lockstone/simulation.h>
#include <lockstone/tool.h>
#include <lockstone/world.h>

namespace lockstone::tool {

struct FieldPlace {
  const char* store = "";  ///< "world", "body", "contact", "joint"
  std::uint64_t object = 0;
  std::string field;
  std::size_t offset = 0;  ///< within the world's snapshot
  std::size_t bytes = 0;
};

/// The world's part of a canonical snapshot that holds the world's own bytes somewhere; empty where
/// it does not.
[[nodiscard]] std::span<std::byte> world_part(const World& world, std::span<std::byte> canonical);

/// All fields of the header, the bodies, contacts and joints, in their order. `world` is well
/// formed.
[[nodiscard]] std::vector<FieldPlace> fields_of_world(ByteView world);

/// The canonical snapshot that differs from the simulation's in one bit of its world, and has this
/// hash; empty when there is none. Tries all, for a second or so; leaves the simulation as it was.
[[nodiscard]] std::vector<std::byte> find_flipped_bit(const GameDef& game, Simulation& simulation,
                                                      std::uint64_t hash);

/// Makes the checksum at the end right again.
void reseal(std::span<std::byte> world);

}  // namespace lockstone::tool
