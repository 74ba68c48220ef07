// Changed tiles of height fields as they are stored, saved and hashed.
#pragma once

#include "core/dynamics/state/fields.h"
#include "core/geometry/assets/height_tile.h"

namespace lockstone {

/// Its owner is the body whose height field is changed; sorted by key. A tile that is as in the
/// asset has no record.
using TerrainTileRecord = geometry::HeightTile;

namespace geometry {

template <class F>
constexpr void visit_fields(HeightTile& record, F&& f) {
  constexpr const char* k_places[] = {"[0]", "[1]", "[2]",  "[3]",  "[4]",  "[5]",  "[6]",  "[7]",
                                      "[8]", "[9]", "[10]", "[11]", "[12]", "[13]", "[14]", "[15]"};
  visit_value("body", "", record.owner, f);
  visit_value("row", "", record.row, f);
  visit_value("column", "", record.column, f);
  for (std::size_t i = 0; i < HeightTile::k_samples; ++i)
    visit_value("height", k_places[i], record.heights[i], f);
  for (std::size_t i = 0; i < HeightTile::k_samples; ++i)
    visit_value("surface", k_places[i], record.surfaces[i], f);
  visit_value("holes", "", record.holes, f);
  visit_value("reserved", "", record.reserved, f);
}

}  // namespace geometry

static_assert(visited_bytes<TerrainTileRecord>() == sizeof(TerrainTileRecord),
              "a field is missing");

}  // namespace lockstone
