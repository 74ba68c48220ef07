// Compound: several convex shapes that make one rigid body, an asset.
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

/// One of the shapes. Where children overlap, the shared volume counts twice in the mass.
struct CompoundChild {
  Shape shape = Shape::sphere(Length::from_ratio(1, 2));  ///< primitive or hull
  AssetPtr asset{};                          ///< the hull that `shape` names; null for the others
  Vec3<Length> position{};                   ///< of the shape's frame in the compound's
  Quat orientation{};                        ///< is normalised
  Number density = Number::from_integer(1);  ///< relative to the body's, 1/1024 … 1024
  std::optional<Surface> surface{};          ///< the body's own when not given
};

/// Why no compound was built.
enum class CompoundFault : std::uint8_t {
  none = 0,
  no_children,
  too_many_children,        ///< more than k_max_compound_children
  invalid_shape,            ///< not one of the four kinds, or a size outside its range
  missing_asset,            ///< a hull without its asset, or with another one
  invalid_orientation,      ///< too near to zero
  invalid_density,          ///< outside 1/1024 … 1024
  invalid_surface,          ///< a property or rule outside the ranges of Surface
  coordinate_out_of_range,  ///< a child reaches beyond k_max_asset_coordinate
};

/// A short lower-case English name, for logs.
[[nodiscard]] std::string_view to_string(CompoundFault fault);

struct CompoundResult;

/// Parts are numbered as the children were given.
class Compound final : public Asset {
 public:
  [[nodiscard]] static CompoundResult build(std::span<const CompoundChild> children);

  /// The compound that `canonical_bytes` came from. Its hulls must be in `hulls`: not_found when
  /// one is not; malformed when there is no such compound.
  [[nodiscard]] static Result<std::shared_ptr<const Compound>> from_bytes(ByteView bytes,
                                                                          const AssetSet& hulls);

  [[nodiscard]] std::span<const CompoundChild> children() const;

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
