// The parts of a picture of a world: the pieces of its bodies and the shadows they throw.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <lockstone/world.h>

#include "tools/render/svg.h"

namespace lockstone::render {

/// A piece of a body and the shadows that fall onto it.
struct Item {
  Solid solid;
  std::vector<std::size_t> shadows = {};  ///< items that cast one onto this
  bool over_own_shadow = false;  ///< whose shadow falls onto many pieces: drawn just before it
  std::string label = {};
  BodyHandle body{};
  bool moves = false;
};

/// The pieces of all visible bodies: one for each plain shape and hull, child of a compound, and
/// triangle. Of half-spaces as much as lies below and around the others.
[[nodiscard]] std::vector<Item> collect_items(const World& world, const Style& style);

/// Each moving piece throws a shadow onto whatever a ray straight down finds first.
void cast_shadows(const World& world, std::vector<Item>& items);

}  // namespace lockstone::render
