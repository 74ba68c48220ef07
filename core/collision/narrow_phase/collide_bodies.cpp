#include "core/collision/narrow_phase/collide_bodies.h"

#include <lockstone/assert.h>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/dispatch/collide.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/separation.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone {
namespace {

// Two placed shapes and how far apart they still count.
struct BodyPair {
  const PlacedShape& a;
  const PlacedShape& b;
  Length margin;
};

// From the origins of pieces to the centres of mass. Touching points stay one point for both.
void shift_anchors(const BodyPair& pair, const Vec3<Position>& origin_a,
                   const Vec3<Position>& origin_b, Manifold& manifold) {
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= k_max_manifold_points);
  const Vec3<Length> shift_a = saturated<Length>(origin_a - pair.a.centre);
  const Vec3<Length> shift_b = saturated<Length>(origin_b - pair.b.centre);
  if (shift_a == Vec3<Length>{} && shift_b == Vec3<Length>{}) return;
  const Vec3<Length> between = saturated<Length>(pair.b.centre - pair.a.centre);
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    point.anchor_a += shift_a;
    point.anchor_b = point.separation.raw > 0 ? point.anchor_b + shift_b : point.anchor_a - between;
  }
}

Manifold collide_pieces(const BodyPair& pair, const Piece& a, const Piece& b) {
  LKS_ASSERT(pair.margin >= Length{});
  return collide(a.posed(), b.posed(), saturated<Length>(b.origin - a.origin), pair.margin);
}

constexpr Length k_inside_slack = Length::from_ratio(1, 1000);  // far above all rounding errors

// Whether A is a ball that clearly holds a point inside B: then they overlap, whatever their
// surfaces do.
bool holds_inside(const Piece& a, const Piece& b) {
  if (a.shape.kind != ShapeKind::sphere || a.shape.size.x <= k_inside_slack) return false;
  if (b.polytope != nullptr && b.polytope->one_sided) return false;
  const std::int64_t reach = (a.shape.size.x - k_inside_slack).raw;
  LKS_ASSERT(reach > 0);
  const Vec3<Length> gap = saturated<Length>(middle_of(b) - a.origin);
  std::uint64_t square = 0;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t lane = gap[i].raw;
    if (lane > reach || lane < -reach) return false;
    square += static_cast<std::uint64_t>(lane * lane);  // each below 2^62
  }
  return square <= static_cast<std::uint64_t>(reach * reach);
}

bool pieces_overlap(const BodyPair& pair, const Piece& a, const Piece& b) {
  return holds_inside(a, b) || holds_inside(b, a) || collide_pieces(pair, a, b).count > 0;
}

void add_pieces(const BodyPair& pair, const Piece& a, const Piece& b, PartContacts& out) {
  Manifold manifold = collide_pieces(pair, a, b);
  if (manifold.count == 0) return;
  shift_anchors(pair, a.origin, b.origin, manifold);
  out.add({a.part, b.part, a.surface, b.surface, manifold});
}

PosedShape posed(const PlacedShape& single) {
  const geometry::AssetGeometry* asset = single.asset;
  return {single.shape, single.rotation, asset == nullptr ? nullptr : asset->polytope()};
}

// Two shapes without parts: the common case, without copies of them. `out` is empty.
void add_singles(const BodyPair& pair, const HeldFeatures& held, PartContacts& out) {
  LKS_ASSERT(out.count == 0 && is_single(pair.a) && is_single(pair.b));
  const Vec3<Length> offset = saturated<Length>(pair.b.origin - pair.a.origin);
  PartContact& contact = out.contacts.front();
  contact.part_a = contact.part_b = 0;
  contact.surface_a = contact.surface_b = nullptr;
  collide(posed(pair.a), posed(pair.b), offset, pair.margin, held, contact.manifold);
  if (contact.manifold.count == 0) {
    out.separating_axis = contact.manifold.normal;
    return;
  }
  shift_anchors(pair, pair.a.origin, pair.b.origin, contact.manifold);
  out.count = 1;
}

// One piece of A against the triangles of B. The kernels see the mesh as A.
void add_triangles(const BodyPair& pair, const Piece& a, TriangleScratch& scratch,
                   PartContacts& out) {
  const Piece mesh = {pair.b.shape, nullptr, pair.b.origin, pair.b.rotation, 0, nullptr, {}};
  LKS_ASSERT(pair.b.asset != nullptr && pair.b.asset->triangles() != nullptr);
  const geometry::AssetGeometry& triangles = *pair.b.asset->triangles();
  const PosedShape shape = a.posed();
  const Vec3<Length> offset = saturated<Length>(a.origin - mesh.origin);
  triangles.mesh_kernels()->collide(triangles, {mesh.rotation, shape, offset, pair.margin},
                                    local_region(pair.b, oriented_box(a), pair.margin),
                                    scratch.contacts, scratch.manifolds);
  out.overflowed =
      out.overflowed || scratch.contacts.left_out() != 0 || scratch.manifolds.left_out != 0;
  for (std::size_t i = 0; i < scratch.manifolds.count; ++i) {
    const geometry::MeshManifold& group = scratch.manifolds.manifolds[i];
    PartContact contact{a.part, group.key, a.surface, group.surface,
                        geometry::flipped(group.manifold)};
    shift_anchors(pair, a.origin, mesh.origin, contact.manifold);
    out.add(contact);
  }
}

// One piece of A against the convex parts of B, if it has some beside its triangles.
void add_solids(const BodyPair& pair, const Piece& a, PartContacts& out) {
  LKS_ASSERT(pair.b.asset != nullptr);
  if (pair.b.asset->solids() == nullptr) return;
  PlacedShape solids = pair.b;
  solids.asset = pair.b.asset->solids();
  auto add = [&](const Piece& b) { add_pieces(pair, a, b, out); };
  EachPiece<decltype(add)> visitor(add);
  visit_pieces(solids, oriented_box(a), pair.margin, visitor);
}

// More than pieces reach from the centre of their body, and so little that offsets of pieces stay
// within their range.
constexpr Position k_farthest_plane = Position::from_integer(1500);

// `brought_near`, and no farther than that from the plane: nothing touches it from there above, and
// overlaps have saturated there below.
PlacedShape met_near(const PlacedShape& placed, const Vec3<Position>& point) {
  PlacedShape near = brought_near(placed, point);
  if (placed.shape.kind != ShapeKind::half_space) return near;
  LKS_ASSERT(placed.asset == nullptr);
  const Position height = rotate_inverse(placed.rotation, point - near.origin).y;
  const Position excess = height - clamp(height, -k_farthest_plane, k_farthest_plane);
  if (excess == Position{}) return near;
  near.origin += rotate(placed.rotation, Vec3<Position>{{}, excess, {}});
  near.centre = near.origin;
  return near;
}

template <class F>
void for_each_piece_of_a(const BodyPair& pair, F&& f) {
  if (is_single(pair.a)) return f(single_piece(pair.a));
  EachPiece<F> visitor(f);
  const bool unbounded = pair.b.shape.kind == ShapeKind::half_space;
  visit_pieces(pair.a, oriented_box(unbounded ? pair.a : pair.b), pair.margin, visitor);
}

// Calls `f(piece_a, piece_b)` for all pieces that come near each other.
template <class F>
void for_each_pair_of_pieces(const BodyPair& pair, F&& f) {
  for_each_piece_of_a(pair, [&](const Piece& a) {
    auto with_a = [&](const Piece& b) { f(a, b); };
    EachPiece<decltype(with_a)> visitor(with_a);
    visit_pieces(pair.b, oriented_box(a), pair.margin, visitor);
  });
}

// As `collide_bodies`, with B brought near.
void collide_near(const BodyPair& pair, const HeldFeatures& held, TriangleScratch* scratch,
                  PartContacts& out) {
  if (is_single(pair.a) && is_single(pair.b)) return add_singles(pair, held, out);
  if (pair.b.asset != nullptr && pair.b.asset->mesh_kernels() != nullptr) {
    LKS_CHECK(scratch != nullptr);
    for_each_piece_of_a(pair, [&](const Piece& pa) {
      add_solids(pair, pa, out);
      add_triangles(pair, pa, *scratch, out);
    });
    return;
  }
  for_each_pair_of_pieces(pair,
                          [&](const Piece& pa, const Piece& pb) { add_pieces(pair, pa, pb, out); });
}

}  // namespace

void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin,
                    TriangleScratch* scratch, PartContacts& out, const HeldFeatures& held) {
  out.clear();
  LKS_ASSERT(margin >= Length{});
  if (b.shape.kind != ShapeKind::half_space)
    return collide_near({a, b, margin}, held, scratch, out);
  const PlacedShape near_b = met_near(b, a.centre);
  collide_near({a, near_b, margin}, held, scratch, out);
}

void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin, PartContacts& out) {
  LKS_ASSERT(margin >= Length{});
  if (b.asset == nullptr || b.asset->mesh_kernels() == nullptr)
    return collide_bodies(a, b, margin, nullptr, out);
  TriangleScratch scratch;
  collide_bodies(a, b, margin, &scratch, out);
}

bool separated_along(const PlacedShape& a, const PlacedShape& b, Length margin,
                     const Vec3<Unit>& axis) {
  if (!is_single(a) || !is_single(b) || b.shape.kind == ShapeKind::half_space) return false;
  return separated_along(posed(a), posed(b), saturated<Length>(b.origin - a.origin), margin, axis);
}

bool bodies_overlap(const PlacedShape& a, const PlacedShape& b) {
  const PlacedShape near_a = met_near(a, b.centre), near_b = met_near(b, a.centre);
  const BodyPair pair{near_a, near_b, {}};
  bool found = false;
  for_each_pair_of_pieces(pair, [&](const Piece& pa, const Piece& pb) {
    found = found || pieces_overlap(pair, pa, pb);
  });
  return found;
}

}  // namespace lockstone
