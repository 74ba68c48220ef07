// The size of the library's code in programs that name more or less of it.
#pragma once

#include <cstdint>
#include <optional>

namespace lockstone::bench {

/// Of one program, as `nm` tells.
struct LinkedCode {
  std::uint64_t bytes = 0;   ///< of all functions
  std::uint64_t assets = 0;  ///< functions that make, read or collide hulls, meshes, height fields
};

struct LinkedPrograms {
  LinkedCode primitives;  ///< uses spheres and boxes alone
  LinkedCode assets;      ///< makes a hull too, and reads assets
};

/// Nothing where the two programs were not built (instrumented, shared or debug builds link
/// everything), or `nm` is not at hand.
[[nodiscard]] std::optional<LinkedPrograms> linked_programs();

}  // namespace lockstone::bench
