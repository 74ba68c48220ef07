// Compound: several shapes that make one rigid body, an asset.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

inline constexpr int k_max_compound_children = 256;
/// The triangles of a compound's meshes are parts from this number on.
inline constexpr std::uint32_t k_first_compound_triangle = k_max_compound_children;

/// One of the shapes. Where children overlap, the shared volume counts twice in the mass. A mesh
/// has no mass, and a compound that has one is for static and kinematic bodies alone.
struct CompoundChild {
  Shape shape = Shape::sphere(Length::from_ratio(1, 2));  ///< primitive, hull or mesh
  AssetPtr asset{};         ///< the hull or mesh that `shape` names; null for the others
  Vec3<Length> position{};  ///< of the shape's frame in the compound's
  Quat orientation{};       ///< is normalised
  Number density = Number::from_integer(1);  ///< relative to the body's, 1/1024 … 1024
  /// The body's own when not given. Triangles with a surface of their mesh keep it.
  std::optional<Surface> surface{};
};

/// Why no compound was built.
enum class CompoundFault : std::uint8_t {
  none = 0,
  no_children,
  too_many_children,        ///< more than k_max_compound_children
  invalid_shape,            ///< no primitive, hull or mesh, or a size outside its range
  missing_asset,            ///< a hull or mesh without its asset, or with another one
  invalid_orientation,      ///< too near to zero
  invalid_density,          ///< outside 1/1024 … 1024
  invalid_surface,          ///< a property or rule outside the ranges of Surface
  coordinate_out_of_range,  ///< a child reaches beyond k_max_asset_coordinate
  no_triangles,             ///< meshes whose triangles have no area once they are rounded
  too_many_triangles,       ///< more than k_max_mesh_triangles in all meshes
  too_many_surfaces,        ///< more than k_max_surfaces different ones in all meshes
};

/// A short lower-case English name, for logs.
[[nodiscard]] std::string_view to_string(CompoundFault fault);

struct CompoundResult;

/// The origin of a part of a compound.
struct CompoundPart {
  std::uint32_t child = 0;
  std::uint32_t triangle = 0;  ///< its number as a part of the child's mesh; else 0

  friend constexpr bool operator==(const CompoundPart&, const CompoundPart&) = default;
};

/// Convex parts are numbered as the children were given, triangles from k_first_compound_triangle
/// on.
///
/// The triangles of all meshes are joined to one surface: in the compound's frame, vertices rounded
/// to 2^-20 m, equal ones one. So edges at which meshes meet are met as those of one mesh, and
/// repeated triangles are there once. Groups of triangles are those of the whole body: a number
/// that two meshes have is one group; a mesh without groups stays on. The smallest flat
/// angle of the meshes counts for all. Memory as for a mesh of all the triangles, and 8 bytes more
/// for each.
class Compound final : public Asset {
 public:
  [[nodiscard]] static CompoundResult build(std::span<const CompoundChild> children);

  /// The compound that `canonical_bytes` came from. Its hulls and meshes must be in `known`:
  /// not_found when one is not; malformed when there is no such compound.
  [[nodiscard]] static Result<std::shared_ptr<const Compound>> from_bytes(ByteView bytes,
                                                                          const AssetSet& known);

  [[nodiscard]] std::span<const CompoundChild> children() const;

  /// The child that a part of an event or query belongs to; nothing when there is no such part.
  [[nodiscard]] std::optional<CompoundPart> find_part(std::uint32_t part) const;

  [[nodiscard]] std::vector<std::byte> canonical_bytes() const override;

 private:
  Compound(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);
};

/// A compound, or the reason why there is none and the child that is to blame.
struct [[nodiscard]] CompoundResult {
  std::shared_ptr<const Compound> compound;  ///< null exactly when there is a fault
  CompoundFault fault = CompoundFault::none;
  std::uint32_t child = 0;

  [[nodiscard]] bool ok() const { return compound != nullptr; }
  [[nodiscard]] explicit operator bool() const { return ok(); }
};

}  // namespace lockstone
