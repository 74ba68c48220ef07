// Memory for the geometry of assets as worlds have changed them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/assets/height_tile.h"
#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

class EditedAssets {
 public:
  virtual ~EditedAssets() = default;
  EditedAssets(const EditedAssets&) = delete;
  EditedAssets& operator=(const EditedAssets&) = delete;

  [[nodiscard]] virtual std::uint32_t slots() const = 0;
  /// Makes the one in a slot, in place of another: `base` with these tiles, of one owner, by key,
  /// and at least one. Both must outlive it. Allocates nothing.
  virtual const AssetGeometry* set(std::uint32_t slot, const AssetGeometry& base,
                                   std::span<const HeightTile> tiles) = 0;

 protected:
  EditedAssets() = default;
};

/// Of one kind, whose `whole` is the geometry of a body.
template <class Edited>
class EditedSlots final : public EditedAssets {
 public:
  explicit EditedSlots(std::uint32_t capacity) : slots_(capacity) {}

  [[nodiscard]] std::uint32_t slots() const override {
    return static_cast<std::uint32_t>(slots_.size());
  }
  const AssetGeometry* set(std::uint32_t slot, const AssetGeometry& base,
                           std::span<const HeightTile> tiles) override {
    return slots_[slot].emplace(base, tiles).whole();
  }

 private:
  std::vector<std::optional<Edited>> slots_;
};

}  // namespace lockstone::geometry
