// The workload of `lockstone bench queries`: a still world of many bodies, and rows of queries to
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/world.h>

#include "tools/arena/integers.h"

namespace lockstone::bench {

struct QueryBody {
  Shape shape{};
  Transform pose{};
  bool is_static = false;
};

/// The kinds of bodies in a scene.
enum class QueryWorld : std::uint8_t {
  primitives,  ///< spheres, capsules and boxes
  hulls,       ///< these and, as often as each of them, hulls
  mesh,        ///< primitives above, in and below a terrain of about 100,000 triangles
};

/// Bodies are named by their place in the list, in every engine.
struct QueryScene {
  std::vector<QueryBody> bodies;
  std::vector<std::shared_ptr<const Hull>> hulls;  ///< among the bodies' shapes
  std::vector<Vec3<Length>> terrain_vertices;      ///< of the mesh among them, as it was built
  std::vector<TriangleIndices> terrain;
  std::shared_ptr<const AssetSet> assets;  ///< all of these; null: none
  Position half_width{};                   ///< of the cube that holds the bodies' centres
};

/// Bodies of random size and orientation, as dense whatever their number; two in five are static
/// and larger. A mesh is the last of them.
[[nodiscard]] QueryScene make_query_scene(QueryWorld kind, std::uint32_t bodies,
                                          std::uint64_t seed);

/// In a cube about the origin.
[[nodiscard]] Vec3<Position> random_place(arena::Random& random, Position half_width);

[[nodiscard]] World make_query_world(const QueryScene& scene,
                                     BroadPhaseKind broad_phase = BroadPhaseKind::tree);

enum class QueryKind : std::uint8_t {
  closest_ray,   ///< the first body along a ray
  blocked_ray,   ///< whether there is any
  all_rays,      ///< how many there are
  overlap,       ///< how many bodies overlap a sphere or box
  point,         ///< how many bodies hold a point
  near_point,    ///< the body nearest to a point, within a reach
  closest_cast,  ///< the first body that a shape meets on its way
};

/// Questions of one kind. Rays have an origin and a translation; an overlap has a shape and a pose,
/// a cast moreover a translation: that of the ray of its number; a point is a ray's origin.
struct QueryRow {
  std::string_view name;
  QueryKind kind{};
  std::vector<Ray> rays;
  Shape shape{};
  std::vector<Transform> poses;
  Length reach{};

  [[nodiscard]] std::size_t size() const { return shape_asked() ? poses.size() : rays.size(); }
  [[nodiscard]] bool shape_asked() const {
    return kind == QueryKind::overlap || kind == QueryKind::closest_cast;
  }
  [[nodiscard]] ShapeCast cast(std::size_t i) const {
    return {shape, poses[i], rays[i].translation};
  }
  /// Whether an answer names the fraction of a way where something is met.
  [[nodiscard]] bool names_fraction() const {
    return kind == QueryKind::closest_ray || kind == QueryKind::closest_cast;
  }
};

/// All rows. No ray or cast begins inside a body: engines disagree about the meaning of that.
[[nodiscard]] std::vector<QueryRow> make_query_rows(const QueryScene& scene, const World& world,
                                                    std::size_t count, std::uint64_t seed);

}  // namespace lockstone::bench
