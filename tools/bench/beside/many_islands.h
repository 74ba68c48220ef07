// Worlds of many small islands of one kind on level ground, by their number of bodies.
#pragma once

#include <span>
#include <string_view>

#include "tools/bench/general/scene.h"

namespace lockstone::bench {

struct IslandKind {
  std::string_view name;
  std::string_view text;  ///< describes one island
  int bodies = 0;         ///< of one island
  GeneralScene (*make)(int islands) = nullptr;
};

[[nodiscard]] std::span<const IslandKind> island_kinds();

/// Whole islands: as many as `bodies` bodies make, at least one. Nothing sleeps.
[[nodiscard]] GeneralScene make_islands(const IslandKind& kind, int bodies);

}  // namespace lockstone::bench
