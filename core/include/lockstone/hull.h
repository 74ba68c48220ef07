// Hull: the convex hull of points, an asset.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/bytes.h>
#include <lockstone/status.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Points that a hull may be built from, and vertices that it may have.
inline constexpr int k_max_hull_points = 65536;
inline constexpr int k_max_hull_vertices = 128;

/// Hulls are at least this thick, measured square to each of their faces. 0.98 mm
inline constexpr Length k_min_hull_thickness = k_min_shape_size;

/// No vertex is farther from the centre of mass.
inline constexpr Length k_max_hull_radius = Length::from_integer(1024);

struct HullOptions {
  /// How far a point may lie outside a face and yet be dropped, and a vertex below a face that it
  /// is merged into. Zero: 2^-13 … 2^-12 of the greatest extent. In any case at least 2
  /// µm and at most 1/16 of the thickness.
  Length tolerance{};
  /// 4 … 128. Points are taken in, farthest from the hull of the others first, until this many are
  /// vertices or none lies outside; the rest is cut off.
  int max_vertices = 64;
  /// The hull is all points within this radius of the convex hull of the points; its faces stay
  /// flat, its edges and vertices are round. 0, or k_min_shape_size … k_max_shape_size.
  Length radius{};

  /// Options of a rounded hull. A program links the code of rounded hulls when it names this
  /// function or `load_asset`; one that does not refuses them.
  [[nodiscard]] static HullOptions rounded(Length radius, int max_vertices = 64);
};

/// Why no hull was built.
enum class HullFault : std::uint8_t {
  none = 0,
  invalid_options,  ///< max_vertices outside 4 … 128, a negative tolerance, a wrong radius
  too_few_points,   ///< fewer than four
  too_many_points,  ///< more than k_max_hull_points
  coordinate_out_of_range,  ///< beyond k_max_asset_coordinate, with the radius
  coincident,               ///< all points within k_min_hull_thickness
  collinear,                ///< all points on a line, or nearly
  flat,                     ///< all points in a plane, or thinner than k_min_hull_thickness
  too_large,                ///< radius beyond k_max_hull_radius
};

/// A short lower-case English name, for logs.
[[nodiscard]] std::string_view to_string(HullFault fault);

struct HullResult;

/// A convex polyhedron, or all points within a radius of one, in the frame of the points it was
/// built from. It depends on the set of points and the options alone: not on the points' order, nor
/// on repetitions.
class Hull final : public Asset {
 public:
  /// Vertices are points given, bit for bit. Faces are polygons: triangles that lie in one plane,
  /// exactly or within the tolerance, are merged, and a vertex that then separates no three faces
  /// is dropped. Building from the vertices of a hull with the same options gives that hull again.
  [[nodiscard]] static HullResult build(std::span<const Vec3<Length>> points,
                                        const HullOptions& options = {});

  /// The hull that `canonical_bytes` came from; malformed when there is none.
  [[nodiscard]] static Result<std::shared_ptr<const Hull>> from_bytes(ByteView bytes);

  /// Of a rounded hull, else 0.
  [[nodiscard]] Length radius() const;
  /// As the options said.
  [[nodiscard]] Length tolerance() const;
  /// In ascending order of x, y, z.
  [[nodiscard]] std::span<const Vec3<Length>> vertices() const;
  [[nodiscard]] int face_count() const;
  /// Indices of the face's vertices, counter-clockwise seen from outside.
  [[nodiscard]] std::vector<int> face_vertices(int face) const;

  [[nodiscard]] std::vector<std::byte> canonical_bytes() const override;

 private:
  Hull(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);
};

/// A hull, or the reason why there is none.
struct [[nodiscard]] HullResult {
  std::shared_ptr<const Hull> hull;  ///< null exactly when there is a fault
  HullFault fault = HullFault::none;
  /// The most by which a point given lies beyond the plane of a face. As a rule within the
  /// tolerance; more where max_vertices cut, or a vertex between two merged faces was dropped from
  /// a slender edge.
  Length deviation{};

  [[nodiscard]] bool ok() const { return hull != nullptr; }
  [[nodiscard]] explicit operator bool() const { return ok(); }
};

}  // namespace lockstone
