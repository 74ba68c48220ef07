// Polygons to triangles, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::assets {

/// Corners of one polygon, counter-clockwise seen from the front.
using Corners = std::span<const Vec3<Length>>;
using CornerTriple = std::array<std::uint32_t, 3>;

/// Triangles over the corners of a polygon that may be concave and need not be quite flat: it is
/// seen along the axis that its normal is nearest to, and there every triangle turns as the polygon
/// does. Coordinates within ±512 m. Nothing without area, or when no ear is left, which is so only
/// where it crosses itself. The order of corners decides between several ways to cut.
///
/// Ear clipping: G. Meisters, "Polygons have ears", American Mathematical Monthly 82 (1975).
[[nodiscard]] std::optional<std::vector<CornerTriple>> triangulate(Corners corners);

}  // namespace lockstone::assets
