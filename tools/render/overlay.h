// Bounds, centres of mass, contacts and joints of a world, as lines over its picture.
#pragma once

#include <functional>
#include <string>

#include <lockstone/world.h>

#include "tools/render/geometry.h"

namespace lockstone::render {

/// Where a place of the world is in the picture: "x,y" in pixels.
using PlaceInPicture = std::function<std::string(const Vec&)>;

/// SVG elements: bounds grey (of sleepers dotted), centres of mass with their principal axes,
/// contacts as an arrow along the normal for each point, as long as the force is in weights of a
/// tonne, and joints as their two frames with the gap between them.
[[nodiscard]] std::string overlay(const World& world, const PlaceInPicture& place);

}  // namespace lockstone::render
