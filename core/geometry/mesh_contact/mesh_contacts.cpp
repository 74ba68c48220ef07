#include "core/geometry/mesh_contact/mesh_contacts.h"

#include <algorithm>

#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/mesh_contact/face_plane.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/predicates.h"

namespace lockstone::geometry {
namespace {

/// Two normals that differ by less are one.
constexpr std::int32_t k_same_normal = 4;

/// The rounding error of the height of a vertex along a normal that is square to its edge, relative
/// to the sum of the edge's lanes: 2^-27.
constexpr std::int64_t k_flatness = 8;

struct Priority {
  Displacement separation;
  std::uint32_t part = 0;

  friend constexpr auto operator<=>(const Priority&, const Priority&) = default;
};

Priority priority_of(const TriangleContact& contact) {
  return {least_separation(contact.manifold), contact.part};
}

bool are_equal(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  const auto near = [](Unit x, Unit y) {
    return magnitude_of(std::int64_t{x.raw} - y.raw) <= k_same_normal;
  };
  return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z);
}

/// Whether `to` is higher than `from` along `normal`, by more than rounding explains.
bool rises(const Vec3<Unit>& normal, const Vec3<Length>& from, const Vec3<Length>& to) {
  const Vec3<Length> way = to - from;
  return lockstone::dot(normal, way).raw > k_flatness * sum_of_magnitudes(way);
}

int place_of(const TriangleVertices& triangle, const Vec3<Length>& vertex) {
  const auto at = std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin();
  return at == 3 ? -1 : static_cast<int>(at);
}

/// The judgement of one contact among the others.
class GhostTest {
 public:
  GhostTest(std::span<const TriangleContact> all, const TriangleContact& contact,
            const Vec3<Unit>& normal)
      : all_(all), contact_(contact), normal_(normal) {}

  /// The face normal is not this contact's; the feature is the highest one along the normal.
  [[nodiscard]] bool is_ghost() const {
    const TriangleVertices& t = contact_.vertices;
    int top = 0;
    for (int i = 1; i < 3; ++i)
      if (lockstone::dot(normal_, t[at(i)] - t[at(top)]).raw > 0) top = i;
    const int after = (top + 1) % 3;
    const int before = (top + 2) % 3;
    const bool after_level = !rises(normal_, t[at(after)], t[at(top)]);
    const bool before_level = !rises(normal_, t[at(before)], t[at(top)]);
    if (after_level && before_level) return true;  // along the face, and yet not its normal
    if (after_level) return is_edge_ghost(top);
    if (before_level) return is_edge_ghost(before);
    return is_vertex_ghost(top);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] bool is_edge_active(int edge) const {
    return ((contact_.active_edges >> edge) & 1) != 0;
  }

  /// The vertex of `other` that does not lie on the edge, or null when it is no neighbour there.
  [[nodiscard]] const Vec3<Length>* apex_beyond(const TriangleContact& other, int edge) const {
    if (&other == &contact_) return nullptr;
    const int from = place_of(other.vertices, contact_.vertices[at(edge)]);
    const int to = place_of(other.vertices, contact_.vertices[at((edge + 1) % 3)]);
    return from < 0 || to < 0 ? nullptr : &other.vertices[at(3 - from - to)];
  }

  /// A neighbour that carries on flat or upward leaves the edge no region of its own.
  [[nodiscard]] bool is_edge_ghost(int edge) const {
    const TriangleVertices& t = contact_.vertices;
    bool found = false;
    for (const TriangleContact& other : all_) {
      const Vec3<Length>* apex = apex_beyond(other, edge);
      if (apex == nullptr) continue;
      found = true;
      const int side = orient3d(lattice_point(t[0]), lattice_point(t[1]), lattice_point(t[2]),
                                lattice_point(*apex));
      if (side > 0 || rises(normal_, t[at(edge)], *apex)) return true;
      if (side == 0 && !is_edge_active(edge)) return true;
    }
    return !found && !is_edge_active(edge);
  }

  [[nodiscard]] bool has_neighbour(int edge) const {
    return std::any_of(all_.begin(), all_.end(), [&](const TriangleContact& other) {
      return apex_beyond(other, edge) != nullptr;
    });
  }

  [[nodiscard]] bool is_vertex_ghost(int vertex) const {
    const Vec3<Length>& tip = contact_.vertices[at(vertex)];
    for (const TriangleContact& other : all_) {
      if (&other == &contact_) continue;
      const int place = place_of(other.vertices, tip);
      if (place < 0) continue;
      if (rises(normal_, tip, other.vertices[at((place + 1) % 3)])) return true;
      if (rises(normal_, tip, other.vertices[at((place + 2) % 3)])) return true;
    }
    const auto continues_unseen = [&](int edge) {
      return !is_edge_active(edge) && !has_neighbour(edge);
    };
    return continues_unseen(vertex) || continues_unseen((vertex + 2) % 3);
  }

  std::span<const TriangleContact> all_;
  const TriangleContact& contact_;
  const Vec3<Unit>& normal_;  ///< of the contact, asset frame
};

/// Measures the points along the face normal; keeps those over the face.
Manifold turned_to_face(const TriangleContact& contact, const Vec3<Unit>& world_normal,
                        const MeshContactFrame& frame) {
  const FacePlane plane(contact.vertices, contact.face_normal);
  const Length radius = core_radius(frame.shape);
  const RawVec roll = along(contact.manifold.normal - world_normal, radius);
  Manifold turned;
  turned.normal = world_normal;
  for (int i = 0; i < contact.manifold.count; ++i) {
    const ManifoldPoint& point = contact.manifold.points[static_cast<std::size_t>(i)];
    const RawVec on_b =
        witness_on_b(contact.manifold, point, frame.shape.shape, frame.offset) + roll;
    const RawVec local = along_columns(frame.rotation, on_b);
    if (!plane.has_beside(local)) continue;
    const Fine height = plane.height(local);
    const RawVec on_a = on_b - along(world_normal, height);
    add_point_on(frame.shape.shape, turned, {on_a, on_b}, frame.offset, height, frame.margin,
                 point.feature);
  }
  return turned;
}

bool is_within_sixty_degrees(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  return lockstone::dot(a, b).raw >= std::int64_t{1} << 59;
}

/// Makes a ghost a contact with the face, as far as it is one.
void judge(std::span<const TriangleContact> all, TriangleContact& contact,
           const MeshContactFrame& frame) {
  Manifold& manifold = contact.manifold;
  const Vec3<Unit> world_normal = unit_axis(rotate(frame.rotation, contact.face_normal));
  contact.on_face = are_equal(manifold.normal, world_normal);
  if (contact.on_face) return;
  const Vec3<Unit> normal = rotate_inverse(frame.rotation, manifold.normal);
  if (!GhostTest(all, contact, normal).is_ghost()) return;
  contact.on_face = true;
  if (!is_within_sixty_degrees(manifold.normal, world_normal)) manifold.count = 0;
  manifold = turned_to_face(contact, world_normal, frame);
}

}  // namespace

Displacement least_separation(const Manifold& manifold) {
  Displacement least = Displacement::max();
  for (int i = 0; i < manifold.count; ++i)
    least = min(least, manifold.points[static_cast<std::size_t>(i)].separation);
  return least;
}

Length core_radius(const PosedShape& posed) {
  if (posed.polytope != nullptr) return posed.polytope->radius;
  const ShapeTraits& traits = traits_of(posed.shape);
  return traits.core_radius != nullptr ? traits.core_radius(posed.shape) : Length{};
}

RawVec witness_on_b(const Manifold& manifold, const ManifoldPoint& point, const Shape& b,
                    const Vec3<Length>& offset) {
  if (point.separation.raw > 0 || is_round(b)) return fine(point.anchor_b) + fine(offset);
  const Fine half = Fine{point.separation.raw} * (Fine{1} << (k_fine_per_displacement - 1));
  return fine(point.anchor_a) + along(manifold.normal, half);
}

void TriangleContacts::add(const TriangleContact& contact) {
  if (count_ < k_capacity) {
    contacts_[count_++] = contact;
    return;
  }
  ++left_out_;
  const auto last = std::ranges::max_element(contacts_, {}, priority_of);
  if (priority_of(contact) < priority_of(*last)) *last = contact;
}

void TriangleContacts::add(const Part& part, const Manifold& manifold) {
  const auto& v = part.polytope->vertices;
  add({part.index,
       {v[0], v[1], v[2]},
       part.polytope->faces[0].normal,
       part.triangle.active_edges,
       part.surface,
       manifold});
}

std::span<TriangleContact> TriangleContacts::sorted() {
  const std::span<TriangleContact> used = std::span(contacts_).first(count_);
  if (!std::ranges::is_sorted(used, {}, &TriangleContact::part))
    std::ranges::sort(used, {}, &TriangleContact::part);
  return used;
}

void remove_ghosts(std::span<TriangleContact> contacts, const MeshContactFrame& frame) {
  for (TriangleContact& contact : contacts) {
    contact.on_face = false;
    if (contact.manifold.count > 0) judge(contacts, contact, frame);
  }
}

namespace {

/// The deepest of the overlapping, the first of equals; null when none overlaps.
const TriangleContact* deepest_overlap(std::span<const TriangleContact> contacts) {
  const TriangleContact* deepest = nullptr;
  for (const TriangleContact& contact : contacts) {
    const Displacement separation = least_separation(contact.manifold);
    if (separation.raw > 0) continue;
    if (deepest == nullptr || separation < least_separation(deepest->manifold)) deepest = &contact;
  }
  return deepest;
}

}  // namespace

void join_triangle_contacts(TriangleContacts& contacts, const MeshContactFrame& frame,
                            MeshManifolds& out) {
  const std::span<TriangleContact> sorted = contacts.sorted();
  const TriangleContact* deepest = deepest_overlap(sorted);
  const TriangleContact last_resort = deepest == nullptr ? TriangleContact{} : *deepest;
  remove_ghosts(sorted, frame);
  merge_planes(sorted, frame, out);
  if (out.count == 0 && deepest != nullptr) merge_planes({&last_resort, 1}, frame, out);
}

}  // namespace lockstone::geometry
