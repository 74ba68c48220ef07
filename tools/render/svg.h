// Pictures of a world, as SVG.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <lockstone/world.h>

#include "tools/render/solid.h"

namespace lockstone::render {

/// How one body is drawn.
struct Look {
  Color color;
  bool visible = true;
  std::string label;  ///< drawn above the body; empty for none
};
using Style = std::function<Look(BodyHandle, const BodyView&)>;

/// By motion type and shape; the color varies a little with the index.
[[nodiscard]] Look plain_look(BodyHandle handle, const BodyView& view);

/// The look by the arena's tags: players in their colors, goals as glass.
[[nodiscard]] Look arena_look(BodyHandle handle, const BodyView& view);

struct Picture {
  int width = 1200;  ///< pixels
  int height = 800;
  std::string caption = {};  ///< at the lower left
  Style style = plain_look;
  bool overlay = false;  ///< bounds, centres of mass, contacts and joints too
};

/// The part of the picture plane that shows the moving bodies and the scenery near them, in metres.
[[nodiscard]] Frame framing(const World& world, const Picture& picture);

/// One picture of the world as it stands. Pictures with one frame have one camera.
[[nodiscard]] std::string draw(const World& world, const Picture& picture, const Frame& frame);

/// The same, framed on the moving bodies.
[[nodiscard]] std::string draw(const World& world, const Picture& picture);

/// Several pictures (each from `draw`, of one size) in rows beneath each other, as one.
[[nodiscard]] std::string strip(const std::vector<std::string>& pictures, const Picture& picture,
                                int columns);

}  // namespace lockstone::render
