#include <algorithm>

#include <lockstone/height_field.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/height_field_geometry.h"

namespace lockstone {
namespace geometry {
namespace {

struct HeightFieldRefusal {
  HeightFieldFault fault = HeightFieldFault::none;
  std::uint32_t index = 0;
};

bool is_size(std::uint32_t samples) {
  return samples >= 2 && samples <= k_max_height_field_samples;
}

HeightFieldRefusal check_sizes(const HeightFieldDef& def) {
  if (!is_size(def.columns) || !is_size(def.rows)) return {HeightFieldFault::size_mismatch};
  const std::size_t samples = std::size_t{def.columns} * def.rows;
  const std::size_t cells = (std::size_t{def.columns} - 1) * (def.rows - 1);
  const auto fits = [cells](std::span<const std::uint8_t> by_cell) {
    return by_cell.empty() || by_cell.size() == cells;
  };
  const bool one_of_both = def.heights.empty() != def.samples.empty() &&
                           def.heights.size() + def.samples.size() == samples;
  if (!one_of_both || !fits(def.holes) || !fits(def.cell_surfaces))
    return {HeightFieldFault::size_mismatch};
  const bool options = def.cell_x >= k_min_shape_size && def.cell_z >= k_min_shape_size &&
                       def.flat_angle >= Angle{} && def.flat_angle <= k_max_flat_angle;
  return {options ? HeightFieldFault::none : HeightFieldFault::invalid_option};
}

HeightFieldRefusal check_surfaces(const HeightFieldDef& def) {
  if (def.surfaces.size() > k_max_surfaces) return {HeightFieldFault::surface_out_of_range};
  for (std::uint32_t i = 0; i < def.surfaces.size(); ++i)
    if (!is_valid(def.surfaces[i])) return {HeightFieldFault::invalid_surface, i};
  for (std::uint32_t i = 0; i < def.cell_surfaces.size(); ++i) {
    const std::uint8_t surface = def.cell_surfaces[i];
    if (surface != k_own_surface && surface >= def.surfaces.size())
      return {HeightFieldFault::surface_out_of_range, i};
  }
  return {};
}

/// Whether origin + steps · step is a coordinate of an asset.
bool is_coordinate(Length origin, Length step, std::uint32_t steps) {
  const std::int64_t x = origin.raw + std::int64_t{step.raw} * steps;
  return x >= -k_max_asset_coordinate.raw && x <= k_max_asset_coordinate.raw;
}

bool is_coordinate_of(const HeightFieldDef& def, std::uint32_t sample) {
  if (def.heights.empty()) return is_coordinate(def.origin.y, def.sample_step, def.samples[sample]);
  return is_coordinate(def.origin.y, def.heights[sample], 1);
}

HeightFieldRefusal check_coordinates(const HeightFieldDef& def) {
  const bool grid = is_asset_coordinate(def.origin) &&
                    is_coordinate(def.origin.x, def.cell_x, def.columns - 1) &&
                    is_coordinate(def.origin.z, def.cell_z, def.rows - 1);
  if (!grid) return {HeightFieldFault::coordinate_out_of_range};
  for (std::uint32_t i = 0; i < def.columns * def.rows; ++i)
    if (!is_coordinate_of(def, i)) return {HeightFieldFault::coordinate_out_of_range, i};
  return {};
}

HeightFieldRefusal check(const HeightFieldDef& def) {
  HeightFieldRefusal refusal = check_sizes(def);
  if (refusal.fault == HeightFieldFault::none) refusal = check_surfaces(def);
  if (refusal.fault == HeightFieldFault::none) refusal = check_coordinates(def);
  const bool nothing = !def.holes.empty() && std::ranges::count(def.holes, 0) == 0;
  if (refusal.fault == HeightFieldFault::none && nothing) refusal.fault = HeightFieldFault::empty;
  return refusal;
}

std::vector<Length> absolute_heights(const HeightFieldDef& def) {
  std::vector<Length> heights;
  heights.reserve(std::size_t{def.columns} * def.rows);
  for (const Length height : def.heights)
    heights.push_back(def.origin.y + height);
  for (const std::uint16_t sample : def.samples)
    heights.push_back(def.origin.y + def.sample_step * sample);
  return heights;
}

std::vector<std::uint8_t> hole_bits(std::span<const std::uint8_t> holes) {
  if (std::ranges::all_of(holes, [](std::uint8_t hole) { return hole == 0; })) return {};
  std::vector<std::uint8_t> bits((holes.size() + 7) / 8);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const unsigned bit = holes[i] != 0 ? 1U << (i % 8) : 0U;
    bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | bit);
  }
  return bits;
}

/// A hole has no surface; where no cell has one, there are none.
std::vector<std::uint8_t> surfaces_of_cells(const HeightFieldDef& def) {
  std::vector<std::uint8_t> surfaces(def.cell_surfaces.begin(), def.cell_surfaces.end());
  for (std::size_t i = 0; i < surfaces.size() && !def.holes.empty(); ++i)
    if (def.holes[i] != 0) surfaces[i] = k_own_surface;
  const bool plain =
      std::ranges::all_of(surfaces, [](std::uint8_t surface) { return surface == k_own_surface; });
  return plain ? std::vector<std::uint8_t>{} : surfaces;
}

HeightFieldData make_data(const HeightFieldDef& def) {
  HeightFieldData data;
  data.columns = static_cast<std::int32_t>(def.columns);
  data.rows = static_cast<std::int32_t>(def.rows);
  data.origin_x = def.origin.x;
  data.origin_z = def.origin.z;
  data.cell_x = def.cell_x;
  data.cell_z = def.cell_z;
  data.flat_angle = def.flat_angle;
  data.heights = absolute_heights(def);
  data.holes = hole_bits(def.holes);
  data.cell_surfaces = surfaces_of_cells(def);
  data.surfaces.assign(def.surfaces.begin(), def.surfaces.end());
  data.derive();
  return data;
}

}  // namespace
}  // namespace geometry

std::string_view to_string(HeightFieldFault fault) {
  switch (fault) {
    case HeightFieldFault::none:
      return "none";
    case HeightFieldFault::empty:
      return "nothing but holes";
    case HeightFieldFault::size_mismatch:
      return "sizes out of range or not matching";
    case HeightFieldFault::coordinate_out_of_range:
      return "coordinate out of range";
    case HeightFieldFault::surface_out_of_range:
      return "cell names no surface";
    case HeightFieldFault::invalid_surface:
      return "surface out of range";
    case HeightFieldFault::invalid_option:
      return "option out of range";
  }
  return "unknown";
}

HeightField::HeightField(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : Asset(ShapeKind::height_field, id, std::move(geometry)) {}

HeightFieldResult HeightField::build(const HeightFieldDef& def) {
  HeightFieldResult result;
  const geometry::HeightFieldRefusal refusal = geometry::check(def);
  result.fault = refusal.fault;
  result.index = refusal.index;
  if (result.fault != HeightFieldFault::none) return result;
  auto made = std::make_unique<const geometry::HeightFieldGeometry>(geometry::make_data(def));
  const AssetId id = geometry::id_of(geometry::encode_height_field(made->data()));
  result.height_field.reset(new HeightField(id, std::move(made)));
  return result;
}

std::uint32_t HeightField::columns() const {
  return static_cast<std::uint32_t>(geometry::height_field_data(geometry()).columns);
}

std::uint32_t HeightField::rows() const {
  return static_cast<std::uint32_t>(geometry::height_field_data(geometry()).rows);
}

std::size_t HeightField::memory_bytes() const {
  const geometry::HeightFieldData& data = geometry::height_field_data(geometry());
  return sizeof(*this) + sizeof(geometry::HeightFieldGeometry) +
         data.heights.size() * sizeof(Length) + data.holes.size() + data.cell_surfaces.size() +
         data.surfaces.size() * sizeof(Surface) + data.pyramid.memory_bytes();
}

std::vector<std::byte> HeightField::canonical_bytes() const {
  return geometry::encode_height_field(geometry::height_field_data(geometry()));
}

}  // namespace lockstone
