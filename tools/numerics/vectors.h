// Golden vectors: lines `function inputs… = outputs…` in whole numbers, which another
// implementation of docs/explanation/numerics.md can be checked by. Words above 2^63 are printed as
// negative ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::numerics {

using Words = std::vector<std::int64_t>;

/// The range of an input, both ends included.
struct Domain {
  std::int64_t low = 0;
  std::int64_t high = 0;
};

struct Function {
  const char* name = "";
  std::vector<Domain> inputs;
  Words (*evaluate)(const Words&) = nullptr;
  /// Brings independent inputs into the function's domain, when that is no box.
  void (*prepare)(Words&) = nullptr;
};

/// All functions, in the order of the file.
[[nodiscard]] const std::vector<Function>& functions();

[[nodiscard]] std::vector<Function> arithmetic_functions();
[[nodiscard]] std::vector<Function> root_functions();
[[nodiscard]] std::vector<Function> angle_functions();
[[nodiscard]] std::vector<Function> structure_functions();
[[nodiscard]] std::vector<Function> predicate_functions();
[[nodiscard]] std::vector<Function> game_functions();

/// The file's text: the same on every machine.
[[nodiscard]] std::string golden_text();

struct CheckResult {
  std::size_t lines = 0;  ///< vectors compared
  std::size_t different = 0;
  std::size_t malformed = 0;
  std::size_t first_line = 0;  ///< of a difference or a line that cannot be read; from 1
  std::string expected;        ///< that line
  std::string found;           ///< the correct line, or why it cannot be read
};

[[nodiscard]] CheckResult check(std::string_view text);

}  // namespace lockstone::numerics
