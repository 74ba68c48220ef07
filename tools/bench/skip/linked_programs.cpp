#include "tools/bench/skip/linked_programs.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "tools/bench/support/machine.h"

namespace lockstone::bench {

#if defined(LOCKSTONE_LINKED_PRIMITIVES)
namespace {

// Names of types alone (a mesh's kernels are a null pointer to a program without meshes) are no
// code.
bool serves_assets(std::string_view function) {
  constexpr std::string_view k_marks[] = {
      "::Hull::", "::Mesh::",        "::HeightField::",  "::Compound::",   "load_asset",
      "MeshData", "HeightFieldData", "collide_polytope", "MeshContacts::", "StaticTree::",
  };
  return std::ranges::any_of(k_marks, [&](std::string_view mark) {
    return function.find(mark) != std::string_view::npos;
  });
}

// A line of `nm -C -S`: address, size, kind, name.
void count(std::string_view line, LinkedCode& code) {
  const std::size_t size = line.find(' '), kind = line.find(' ', size + 1);
  if (kind == std::string_view::npos || kind + 3 > line.size()) return;
  if (std::string_view("tTwW").find(line[kind + 1]) == std::string_view::npos) return;
  std::uint64_t bytes = 0;
  const char* end = line.data() + kind;
  if (std::from_chars(line.data() + size + 1, end, bytes, 16).ptr != end) return;
  code.bytes += bytes;
  const std::string_view name = line.substr(kind + 3);
  if (name.find("lockstone::") != std::string_view::npos && serves_assets(name)) ++code.assets;
}

LinkedCode code_of(const char* program) {
  LinkedCode code;
  (void)for_lines_of("nm -C -S --defined-only " + quoted(program) + " 2>/dev/null",
                     [&](std::string&& line) { count(line, code); });
  return code;
}

}  // namespace

std::optional<LinkedPrograms> linked_programs() {
  const LinkedPrograms programs{code_of(LOCKSTONE_LINKED_PRIMITIVES),
                                code_of(LOCKSTONE_LINKED_ASSETS)};
  if (programs.primitives.bytes == 0 || programs.assets.bytes == 0) return std::nullopt;
  return programs;
}
#else
std::optional<LinkedPrograms> linked_programs() {
  return std::nullopt;
}
#endif

}  // namespace lockstone::bench
