// Assets: immutable geometry, named by content, shared between worlds and threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/material.h>
#include <lockstone/shape.h>
#include <lockstone/status.h>
#include <lockstone/units.h>

namespace lockstone {

namespace geometry {
class AssetGeometry;
}

/// Coordinates of an asset in its own frame lie within ±512 m.
inline constexpr Length k_max_asset_coordinate = Length::from_integer(512);

/// Surfaces an asset may have, and the index that stands for the body's own material.
inline constexpr int k_max_surfaces = 255;
inline constexpr std::uint8_t k_own_surface = 255;

/// Geometry made once by a builder (Hull, Mesh, HeightField, Compound) and never changed.
class Asset {
 public:
  virtual ~Asset();
  Asset(const Asset&) = delete;
  Asset& operator=(const Asset&) = delete;

  [[nodiscard]] ShapeKind kind() const { return kind_; }
  [[nodiscard]] AssetId id() const { return id_; }

  /// The shape that names this asset.
  [[nodiscard]] Shape shape() const { return {kind_, {}, id_}; }

  /// The canonical form: little-endian, versioned, the same for the same geometry. The id is its
  /// hash. It holds no derived data: the builder derives that again.
  [[nodiscard]] virtual std::vector<std::byte> canonical_bytes() const = 0;

  /// For the engine alone: its type is no part of the interface.
  [[nodiscard]] const geometry::AssetGeometry& geometry() const { return *geometry_; }

 protected:
  Asset(ShapeKind kind, AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);

 private:
  ShapeKind kind_;
  AssetId id_;
  std::unique_ptr<const geometry::AssetGeometry> geometry_;
};

using AssetPtr = std::shared_ptr<const Asset>;

/// The assets that bodies of a world may use, sorted by id. Every peer must hold the same set: its
/// hash is part of the configuration.
class AssetSet {
 public:
  AssetSet() = default;

  /// Sorts and drops duplicates. No entry may be null.
  explicit AssetSet(std::vector<AssetPtr> assets);

  [[nodiscard]] const Asset* find(AssetId id) const;  ///< null when unknown
  [[nodiscard]] std::span<const AssetPtr> all() const { return assets_; }

  /// 0 for the empty set.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  std::vector<AssetPtr> assets_;
  std::uint64_t hash_ = 0;
};

}  // namespace lockstone
