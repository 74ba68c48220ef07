// Ticks of speed scenes counted in instructions, which noise does not move.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::bench {

/// Of `World::step` alone, on one thread, as valgrind's callgrind counts; it offers no AVX-512.
struct InstructionCount {
  std::string scene;
  std::uint32_t ticks = 0;
  std::uint64_t instructions = 0;
  std::string hash;  ///< of the final state
};

/// Whether callgrind is there.
[[nodiscard]] bool can_count_instructions();

/// Runs this program again under callgrind: some forty times slower than without. Nothing when that
/// fails.
[[nodiscard]] std::optional<InstructionCount> count_instructions(std::string_view scene,
                                                                 std::uint32_t ticks);

/// With a first line that names machine, compiler and commit.
[[nodiscard]] std::string counts_to_csv(const std::vector<InstructionCount>& counts);

/// None when `counts_to_csv` does not write such a text.
[[nodiscard]] std::vector<InstructionCount> counts_from_csv(std::string_view text);

}  // namespace lockstone::bench
