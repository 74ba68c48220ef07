#include "tools/bench/speed/instructions.h"

#include <algorithm>
#include <charconv>

#include "tools/bench/support/machine.h"

namespace lockstone::bench {
namespace {

constexpr std::string_view k_columns = "scene,ticks,instructions,instructions_per_tick,hash";

// The number of the characters after a mark; 0 for none.
std::uint64_t number_after(std::string_view line, std::string_view mark) {
  const std::size_t at = line.find(mark);
  std::uint64_t number = 0;
  if (at == std::string_view::npos) return number;
  const std::string_view rest = line.substr(at + mark.size());
  (void)std::from_chars(rest.data(), rest.data() + rest.size(), number);
  return number;
}

std::string text_after(std::string_view line, std::string_view mark, std::size_t size) {
  const std::size_t at = line.find(mark);
  return at == std::string_view::npos ? "" : std::string(line.substr(at + mark.size(), size));
}

std::vector<std::string_view> split(std::string_view text, char mark) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(mark, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

bool can_count_instructions() {
  return for_lines_of("valgrind --version 2>&1", [](std::string&&) {}) == 0;
}

std::optional<InstructionCount> count_instructions(std::string_view scene, std::uint32_t ticks) {
  InstructionCount count{std::string(scene), ticks, 0, {}};
  const std::string command =
      "valgrind --tool=callgrind --callgrind-out-file=/dev/null "
      "--toggle-collect='*measured_step*' " +
      quoted(own_program()) + " bench speed --json --repeats 1 --threads 1 --scene " +
      quoted(count.scene) + " --ticks " + std::to_string(ticks) + " 2>&1";
  const int code = for_lines_of(command, [&](std::string&& line) {
    if (const std::uint64_t number = number_after(line, "Collected : "); number != 0)
      count.instructions = number;
    if (std::string hash = text_after(line, "\"final_hash\": \"", 16); !hash.empty())
      count.hash = std::move(hash);
  });
  if (code != 0 || count.instructions == 0 || count.hash.empty()) return std::nullopt;
  return count;
}

std::string counts_to_csv(const std::vector<InstructionCount>& counts) {
  std::string text = "# " + machine_text() + "; " + compiler_text() + "; commit " + commit_text() +
                     "; callgrind\n";
  text.append(k_columns).append("\n");
  for (const InstructionCount& count : counts)
    text += count.scene + "," + std::to_string(count.ticks) + "," +
            std::to_string(count.instructions) + "," +
            std::to_string(count.instructions / count.ticks) + "," + count.hash + "\n";
  return text;
}

std::vector<InstructionCount> counts_from_csv(std::string_view text) {
  std::vector<InstructionCount> counts;
  bool begun = false;
  for (const std::string_view line : split(text, '\n')) {
    const std::vector<std::string_view> parts = split(line, ',');
    const bool fits = begun && parts.size() == 5;
    begun = begun || line == k_columns;
    if (!fits) continue;
    counts.push_back({std::string(parts[0]), static_cast<std::uint32_t>(number_after(parts[1], "")),
                      number_after(parts[2], ""), std::string(parts[4])});
    if (counts.back().ticks == 0 || counts.back().instructions == 0) return {};
  }
  return counts;
}

}  // namespace lockstone::bench
