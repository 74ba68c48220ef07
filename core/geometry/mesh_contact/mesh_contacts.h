// From the contacts of a convex shape with many triangles to the few that matter: ghost edges
// removed, the triangles of one plane joined.
//
// Ghosts. A triangle does not know that its neighbour carries on where it ends: the contact with
// its edge or vertex may have a normal that no shape could feel there. A contact counts as it is
// when its normal is the face's, or when no other triangle rises above the plane that the normal
// and the contact's edge or vertex span: the normal then lies in the Voronoi region of that feature
// in the surface. Otherwise it is a ghost. A ghost within 60° of the face normal is measured again
// along that normal, and kept where the shape's point lies over the face; all others are dropped,
// because a neighbour that rises there is nearer and has a contact of its own. If ghosts are all
// there is and they overlap, the deepest stays as it is, so that nothing falls through. Sources of
// the idea: Pierre Terdiman, "Contact generation for meshes"; Jolt Physics, ActiveEdges.h and
// InternalEdgeRemovingCollector.h; Box3D, mesh_contact.c.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/geometry/convex/parts.h"
#include "core/geometry/distance/manifold.h"
#include "core/geometry/mesh_contact/triangle_polytope.h"

namespace lockstone::geometry {

/// One triangle near the shape, and how they meet: also where they do not, because it is a
/// neighbour of others.
struct TriangleContact {
  std::uint32_t part = 0;
  TriangleVertices vertices{};  ///< asset frame; neighbours have equal ones
  Vec3<Unit> face_normal{};     ///< triangle_normal(vertices)
  std::uint8_t active_edges = 0;
  const Surface* surface = nullptr;
  Manifold manifold{};   ///< from the triangle (A) to the shape (B)
  bool on_face = false;  ///< found by remove_ghosts: the normal is the face's
};

/// Triangles of one shape, up to a capacity. Beyond it the shallowest are left out, of equals the
/// one with the highest part: whatever the order of arrival.
class TriangleContacts {
 public:
  static constexpr std::size_t k_capacity = 256;

  void clear() { count_ = 0, left_out_ = 0; }
  void add(const TriangleContact& contact);
  void add(const Part& part, const Manifold& manifold);

  /// Ascending by part.
  [[nodiscard]] std::span<TriangleContact> sorted();
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }

 private:
  std::array<TriangleContact, k_capacity> contacts_;
  std::size_t count_ = 0;
  std::uint32_t left_out_ = 0;
};

/// Where the triangles and the shape are: the arguments of `collide`.
struct MeshContactFrame {
  const Mat3& rotation;        ///< of the triangles: asset frame to world axes
  const PosedShape& shape;     ///< B
  const Vec3<Length>& offset;  ///< from the origin of the triangles' frame to B's centre
  Length margin;
};

/// The triangles of about one plane and of one surface.
struct MeshManifold {
  /// Names the group: the normal in the asset's frame to 1/64, and the surface. Unique among the
  /// manifolds of a shape, and the same on the next triangle of the plane.
  std::uint32_t key = 0;
  std::uint32_t part = 0;  ///< the deepest triangle, the first of equals
  const Surface* surface = nullptr;
  /// Four points at most. The features of points at a vertex of the shape, an end of a capsule's
  /// core, or of a sphere are the shape's own, below 2^31: they stay as it slides from triangle to
  /// triangle. Others come from the triangle. Normals of a group differ by at most 1.6°: that of
  /// `part` is given.
  Manifold manifold{};
};

struct MeshManifolds {
  static constexpr std::size_t k_capacity = 8;

  std::array<MeshManifold, k_capacity> manifolds{};  ///< ascending by key
  std::size_t count = 0;
  std::uint32_t left_out = 0;  ///< groups beyond the capacity: the shallowest
};

/// Works on the contacts in place. Depends on nothing but its arguments, and not on the order in
/// which contacts were added.
void join_triangle_contacts(TriangleContacts& contacts, const MeshContactFrame& frame,
                            MeshManifolds& out);

// The two steps; for tests ------------------------------------------------------------------------

/// Turns ghosts to their faces; a manifold may become empty. `contacts` ascend by part.
void remove_ghosts(std::span<TriangleContact> contacts, const MeshContactFrame& frame);

/// Groups the remaining contacts, and adds the vertices of the shape that lie over the faces.
void merge_planes(std::span<const TriangleContact> contacts, const MeshContactFrame& frame,
                  MeshManifolds& out);

/// The least separation; the greatest possible when there is no point.
[[nodiscard]] Displacement least_separation(const Manifold& manifold);

/// B's witness of a point, relative to A's centre, world axes, within 2 µm.
[[nodiscard]] RawVec witness_on_b(const Manifold& manifold, const ManifoldPoint& point,
                                  const Shape& b, const Vec3<Length>& offset);

/// The radius by which a shape surrounds its core, 0 of shapes with edges.
[[nodiscard]] Length core_radius(const PosedShape& posed);

/// The coordinates of a world vector along the columns of `m`, each rounded thrice.
[[nodiscard]] constexpr RawVec along_columns(const Mat3& m, const RawVec& v) {
  return {dot(v, m.x), dot(v, m.y), dot(v, m.z)};
}

}  // namespace lockstone::geometry
