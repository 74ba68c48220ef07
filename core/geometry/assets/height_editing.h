// The operations of worlds that change height fields, behind a pointer that a height field gives: a
// program that makes none links none of this.
#pragma once

#include <memory>
#include <span>

#include "core/geometry/assets/height_tile.h"

namespace lockstone::geometry {

/// Memory for changed height fields.
class EditedHeightFields {
 public:
  virtual ~EditedHeightFields() = default;
  EditedHeightFields(const EditedHeightFields&) = delete;
  EditedHeightFields& operator=(const EditedHeightFields&) = delete;

  [[nodiscard]] virtual std::uint32_t slots() const = 0;
  /// Makes the one in a slot, in place of another: `base` with these tiles (EditedCells). Both must
  /// outlive it. Allocates nothing.
  virtual const Asset* set(std::uint32_t slot, const Asset& base,
                           std::span<const HeightTile> tiles) = 0;

 protected:
  EditedHeightFields() = default;
};

/// The asset of each function is a HeightField.
struct HeightEditing {
  std::unique_ptr<EditedHeightFields> (*make_edited)(std::uint32_t capacity);
  const HeightFieldData& (*data_of)(const Asset& asset);
  HeightTile (*original)(const HeightFieldData& field, const HeightTileKey& key);
  bool (*is_tile)(const HeightFieldData& field, const HeightTile& tile);
};

/// The one table.
[[nodiscard]] const HeightEditing& height_editing();

}  // namespace lockstone::geometry
