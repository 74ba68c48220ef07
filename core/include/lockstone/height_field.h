// Height fields: terrains over a regular grid.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <lockstone/asset.h>

namespace lockstone {

inline constexpr std::uint32_t k_max_height_field_samples = 4096;  ///< along each axis

/// Definition of a height field; read during `HeightField::build` only. Sample (i, j) stands
/// at x = origin.x + i · cell_x, z = origin.z + j · cell_z. All coordinates are within ±512 m.
struct HeightFieldDef {
  std::uint32_t columns = 0;  ///< samples along x, 2 … k_max_height_field_samples
  std::uint32_t rows = 0;     ///< samples along z
  Vec3<Length> origin{};
  Length cell_x = Length::from_integer(1);  ///< at least k_min_shape_size
  Length cell_z = Length::from_integer(1);

  /// Heights above origin.y, row by row: sample (i, j) is number j · columns + i. Either `heights`,
  /// or `samples`, which count `sample_step`; the other is empty.
  std::span<const Length> heights;
  std::span<const std::uint16_t> samples;
  Length sample_step{};

  /// By cell, (columns − 1) · (rows − 1) of them, row by row, or empty: not 0 where there is a
  /// hole, and an index into `surfaces` or k_own_surface.
  std::span<const std::uint8_t> holes;
  std::span<const std::uint8_t> cell_surfaces;
  std::span<const Surface> surfaces;  ///< at most k_max_surfaces

  /// As MeshDef::flat_angle.
  Angle flat_angle = Angle::from_ratio(1, 50);
};

/// Why a height field was refused.
enum class HeightFieldFault : std::uint8_t {
  none = 0,
  empty,          ///< nothing but holes
  size_mismatch,  ///< columns, rows, or as many heights, holes or surfaces as they ask for
  coordinate_out_of_range,  ///< a sample beyond k_max_asset_coordinate
  surface_out_of_range,     ///< a cell names no surface, or too many surfaces
  invalid_surface,          ///< a property or rule outside the ranges of Surface
  invalid_option,           ///< cell_x, cell_z or flat_angle out of range
};

/// A short lower-case English text, for logs.
[[nodiscard]] std::string_view to_string(HeightFieldFault fault);

class HeightField;

struct [[nodiscard]] HeightFieldResult {
  std::shared_ptr<const HeightField> height_field;  ///< null when refused
  HeightFieldFault fault = HeightFieldFault::none;
  std::uint32_t index = 0;  ///< of the offending sample, cell or surface

  [[nodiscard]] bool ok() const { return height_field != nullptr; }
  [[nodiscard]] explicit operator bool() const { return ok(); }
};

/// Each cell is two triangles that face up, split from sample (i, j) to (i + 1, j + 1). With the
/// cell's number c = j · (columns − 1) + i, part 2c is the one at the lower x and higher z:
/// (i, j), (i, j+1), (i+1, j+1); part 2c + 1 is (i, j), (i+1, j+1), (i+1, j).
///
/// Memory: 4 bytes a sample and 0.7 a cell; a bit a cell where there are holes, a byte a cell where
/// there are surfaces.
class HeightField final : public Asset {
 public:
  [[nodiscard]] static HeightFieldResult build(const HeightFieldDef& def);

  /// From canonical bytes of any origin: truncated, malformed, unsupported_version, or the height
  /// field with exactly these canonical bytes.
  [[nodiscard]] static Result<std::shared_ptr<const HeightField>> from_bytes(ByteView bytes);

  [[nodiscard]] std::uint32_t columns() const;
  [[nodiscard]] std::uint32_t rows() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  [[nodiscard]] std::vector<std::byte> canonical_bytes() const override;

 private:
  HeightField(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);
};

}  // namespace lockstone
