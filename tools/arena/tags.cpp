#include "tools/arena/tags.h"

#include <array>
#include <string_view>

namespace lockstone::arena {

std::string Tag::name() const {
  constexpr std::array<std::string_view, 11> k_names{"scenery", "player",   "crate", "ball",
                                                     "barrel",  "snowball", "goal",  "hill",
                                                     "ferry",   "bar",      "buggy"};
  const auto index = static_cast<std::size_t>(kind);
  if (index >= k_names.size()) return {};
  return std::string(k_names[index]) + ' ' + std::to_string(number);
}

}  // namespace lockstone::arena
