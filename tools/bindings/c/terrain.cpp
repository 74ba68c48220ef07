// Terrain that changes.
#include <algorithm>
#include <optional>
#include <vector>

#include <lockstone/height_field.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

template <class T>
std::span<const T> list_or_none(const T* first, std::size_t count) {
  return {first, first == nullptr ? 0 : count};
}

}  // namespace

lks_status lks_set_heights(lks_world* world, lks_body body, const lks_height_rectangle* rectangle,
                           const lks_length* heights, const uint8_t* holes,
                           const uint8_t* surfaces) {
  return call([&] {
    const lks_height_rectangle& r = required(rectangle, "rectangle");
    SetHeights command{.body = handle_of<BodyHandle>(body),
                       .column = r.column,
                       .row = r.row,
                       .columns = r.columns,
                       .rows = r.rows};
    const std::size_t samples = std::size_t{r.columns} * r.rows;
    const bool has_cells = r.columns > 1 && r.rows > 1;
    const std::size_t cells = has_cells ? std::size_t{r.columns - 1} * (r.rows - 1) : 0;
    std::vector<Length> values;
    if (heights != nullptr && std::max(r.columns, r.rows) <= k_max_height_field_samples) {
      for (std::size_t i = 0; i < samples; ++i)
        values.push_back(Length::from_raw(heights[i]));
    }
    command.heights = values;
    command.holes = list_or_none(holes, cells);
    command.cell_surfaces = list_or_none(surfaces, cells);
    order(world, command);
  });
}

lks_status lks_terrain_sample_get(const lks_world* world, lks_body body, uint32_t column,
                                  uint32_t row, lks_length* height, uint32_t* is_hole,
                                  uint32_t* surface) {
  return call([&] {
    const World& from = read(world);
    const auto sample = terrain_sample_of(from, existing_body(from, body), column, row);
    if (!sample) throw_failure(Status::invalid_argument);
    required(height, "height") = sample->height.raw;
    required(is_hole, "is_hole") = sample->is_hole ? 1 : 0;
    required(surface, "surface") = sample->surface;
  });
}

lks_status lks_set_mesh_group(lks_world* world, lks_body body, uint32_t group, uint32_t is_on) {
  return call([&] {
    order(world, SetMeshGroup{handle_of<BodyHandle>(body), group, flag(is_on, "is_on")});
  });
}

lks_status lks_mesh_group_get(const lks_world* world, lks_body body, uint32_t group,
                              uint32_t* is_on) {
  return call([&] {
    const World& from = read(world);
    const std::optional<bool> found = is_mesh_group_on(from, existing_body(from, body), group);
    if (!found) throw_failure(Status::invalid_argument);
    required(is_on, "is_on") = *found ? 1 : 0;
  });
}

lks_status lks_terrain_tile_count(const lks_world* world, uint32_t* out) {
  return call([&] { required(out, "out") = terrain_tile_count(read(world)); });
}
