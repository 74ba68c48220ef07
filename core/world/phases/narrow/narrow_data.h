// The data of the narrow phase that its parts share: the pairs of a tick, where their contacts are
// kept, and the tick before as far as it is remembered.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/data/world_data.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/narrow/manifold_ids.h"
#include "core/world/phases/narrow/separating_axes.h"
#include "core/world/phases/step_records.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

/// The inputs of manifolds and the separations found, by manifold id.
struct ManifoldNotes {
  std::vector<ManifoldInput> inputs;
  std::vector<FoundSeparations> separations;
};

struct NarrowData {
  NarrowData(WorldData& of, TickContacts& contacts) : world(of), found(contacts) {}

  WorldData& world;
  TickContacts& found;
  std::span<const Pair> pairs;               // of the tick, ascending
  ManifoldIds ids;                           // gives out manifold ids
  bool knows_turning_speeds = false;         // of the bodies that are awake
  std::vector<std::int64_t> turning_speeds;  // by body: `turning_speed`
  std::vector<FoundContacts> of_pair;        // by pair
  std::vector<ContactOrigin> origins;        // by manifold id
  ManifoldNotes notes;                       // of this tick
  ManifoldNotes notes_before;                // of the tick before
  std::vector<Manifold> manifolds_before;    // by manifold id of the tick before
  SeparatingAxes separating_axes;
};

/// Whether it is a box or a hull: faces, edges and vertices keep their numbers from tick to tick.
[[nodiscard]] inline bool has_faces(const BodyRecord& body) {
  const auto kind = static_cast<ShapeKind>(body.shape_kind);
  return kind == ShapeKind::box || kind == ShapeKind::hull;
}

/// Where pairs are collided whose bodies may move away from their recycling poses: faces and edges
/// of boxes and hulls stay where they are while their bodies move so little; round shapes touch
/// elsewhere at once, and are soon collided.
[[nodiscard]] inline bool is_found_at_recycling_poses(const WorldData& world, const Pair& pair) {
  return has_faces(world.bodies[pair.a]) && has_faces(world.bodies[pair.b]);
}

/// Whether contacts with the body may lie on seams: it stands, or is a mesh that moves as one.
[[nodiscard]] inline bool has_seams(const WorldData& world, std::uint32_t body) {
  return !world.bodies[body].moves() || is_surface(world.bodies[body], world.cache.asset(body));
}

/// Whether the body has one part, 0: no compound and no mesh.
[[nodiscard]] inline bool has_one_piece(const WorldData& world, std::uint32_t body) {
  const geometry::AssetGeometry* asset = world.cache.asset(body);
  return asset == nullptr || asset->polytope() != nullptr;
}

/// Whether the body is one mesh, which finds the ghosts among its own edges itself.
[[nodiscard]] inline bool is_one_mesh(const WorldData& world, std::uint32_t body) {
  const geometry::AssetGeometry* asset = world.cache.asset(body);
  return asset != nullptr && asset->triangles() == asset;
}

/// From A's recycling pose to B's.
[[nodiscard]] inline Vec3<Length> recycling_offset(const BodyRecord& a, const BodyRecord& b) {
  return saturated<Length>(recycling_position(b) - recycling_position(a));
}

}  // namespace lockstone
