// What `lockstone bench queries` asks: a still world of many bodies, and rows of questions to it.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <lockstone/world.h>

namespace lockstone::bench {

struct QueryBody {
  Shape shape{};
  Transform pose{};
  bool is_static = false;
};

/// Bodies are named by their place in the list, in every engine.
struct QueryScene {
  std::vector<QueryBody> bodies;
  std::shared_ptr<const AssetSet> assets;  ///< of hulls and meshes among the bodies; null: none
  Position half_width{};                   ///< of the cube that holds the bodies' centres
};

/// Spheres, capsules and boxes of random size and orientation, as dense whatever their number; two
/// in five are static and larger.
[[nodiscard]] QueryScene make_query_scene(std::uint32_t bodies, std::uint64_t seed);

[[nodiscard]] World make_query_world(const QueryScene& scene,
                                     BroadPhaseKind broad_phase = BroadPhaseKind::tree);

enum class QueryKind : std::uint8_t {
  closest_ray,  ///< the first body along a ray
  blocked_ray,  ///< whether there is any
  all_rays,     ///< how many there are
  overlap,      ///< how many bodies overlap a sphere or box
  point,        ///< how many bodies hold a point
  near_point,   ///< the body nearest to a point, within a reach
};

/// Questions of one kind. Rays have an origin and a translation; an overlap has a shape and a pose;
/// a point is a ray's origin.
struct QueryRow {
  std::string_view name;
  QueryKind kind{};
  std::vector<Ray> rays;
  Shape shape{};
  std::vector<Transform> poses;
  Length reach{};

  [[nodiscard]] std::size_t size() const { return shape_asked() ? poses.size() : rays.size(); }
  [[nodiscard]] bool shape_asked() const { return kind == QueryKind::overlap; }
};

/// All rows. No ray begins inside a body: engines disagree about what that means.
[[nodiscard]] std::vector<QueryRow> make_query_rows(const QueryScene& scene, const World& world,
                                                    std::size_t count, std::uint64_t seed);

}  // namespace lockstone::bench
