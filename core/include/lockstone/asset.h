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
struct HeightEditing;
class Curve;
struct LocalBounds;
struct MeshEditing;
struct MeshKernels;
struct Polytope;
struct Solid;
class PartVisitor;
class NearPartVisitor;
class WayPartVisitor;
}  // namespace geometry

/// Coordinates of an asset in its own frame lie within ±512 m.
inline constexpr Length k_max_asset_coordinate = Length::from_integer(512);

/// Surfaces an asset may have, and the index that stands for the body's own material.
inline constexpr int k_max_surfaces = 255;
inline constexpr std::uint8_t k_own_surface = 255;

/// Geometry made once by a builder (Hull, Mesh, HeightField, Compound) and never changed.
class Asset {
 public:
  virtual ~Asset() = default;
  Asset(const Asset&) = delete;
  Asset& operator=(const Asset&) = delete;

  [[nodiscard]] ShapeKind kind() const { return kind_; }
  [[nodiscard]] AssetId id() const { return id_; }

  /// The shape that names this asset.
  [[nodiscard]] Shape shape() const { return {kind_, {}, id_}; }

  /// The canonical form: little-endian, versioned, the same for the same geometry. The id is its
  /// hash. It holds no derived data: the builder derives that again.
  [[nodiscard]] virtual std::vector<std::byte> canonical_bytes() const = 0;

  // For the engine alone, in types that are no part of the interface
  // -----------------------------------------------------------------------------------------------

  [[nodiscard]] virtual const geometry::LocalBounds& bounds() const = 0;

  /// Mass distribution; null for assets that no dynamic body can have.
  [[nodiscard]] virtual const geometry::Solid* solid() const { return nullptr; }

  /// The polyhedron when the asset is a single convex one.
  [[nodiscard]] virtual const geometry::Polytope* polytope() const { return nullptr; }

  /// The kernels that collide with its triangles; null for an asset without triangles.
  [[nodiscard]] virtual const geometry::MeshKernels* mesh_kernels() const { return nullptr; }

  /// The functions that change its heights in a world; null for an asset that is no height field.
  [[nodiscard]] virtual const geometry::HeightEditing* height_editing() const { return nullptr; }

  /// The functions that switch its groups in a world; null for an asset that is no mesh of groups.
  [[nodiscard]] virtual const geometry::MeshEditing* mesh_editing() const { return nullptr; }

  /// The curve of a path; null for other assets.
  [[nodiscard]] virtual const geometry::Curve* curve() const { return nullptr; }

  /// Calls the visitor for every part whose bounds meet `region` (asset frame, closed), in
  /// ascending order of part.
  virtual void visit_parts(const geometry::LocalBounds& region,
                           geometry::PartVisitor& visitor) const = 0;

  /// Calls the visitor for parts whose bounds a box meets within the fraction of its way that the
  /// visitor still asks for; order not promised. The box, of half extents `reach`, goes from
  /// `origin` by `translation`, asset frame; without extents it is a ray.
  virtual void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                                  const Vec3<Length>& reach,
                                  geometry::WayPartVisitor& visitor) const = 0;

  /// Calls the visitor for parts whose bounds come as near to `point` (asset frame) as `reach`, and
  /// then as near as the visitor still asks for; order not promised.
  virtual void visit_parts_near(const Vec3<Length>& point, Length reach,
                                geometry::NearPartVisitor& visitor) const = 0;

 protected:
  Asset(ShapeKind kind, AssetId id) : kind_(kind), id_(id) {}

 private:
  ShapeKind kind_;
  AssetId id_;
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
