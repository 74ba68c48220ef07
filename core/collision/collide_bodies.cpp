#include "core/collision/collide_bodies.h"

#include "core/collision/pieces.h"
#include "core/geometry/contact_point.h"
#include "core/geometry/mesh_kernels.h"

namespace lockstone {
namespace {

// Two placed shapes and how far apart they still count.
struct BodyPair {
  const PlacedShape& a;
  const PlacedShape& b;
  Length margin;
};

// From the origins of pieces to the centres of mass. Touching points stay one point for both.
void shift_anchors(const BodyPair& pair, const Piece& piece_a, const Piece& piece_b,
                   Manifold& manifold) {
  const Vec3<Length> shift_a = saturated<Length>(piece_a.origin - pair.a.centre);
  const Vec3<Length> shift_b = saturated<Length>(piece_b.origin - pair.b.centre);
  if (shift_a == Vec3<Length>{} && shift_b == Vec3<Length>{}) return;
  const Vec3<Length> between = saturated<Length>(pair.b.centre - pair.a.centre);
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    point.anchor_a += shift_a;
    point.anchor_b = point.separation.raw > 0 ? point.anchor_b + shift_b : point.anchor_a - between;
  }
}

Manifold collide_pieces(const BodyPair& pair, const Piece& a, const Piece& b) {
  return collide(a.posed(), b.posed(), saturated<Length>(b.origin - a.origin), pair.margin);
}

void add_pieces(const BodyPair& pair, const Piece& a, const Piece& b, PartContacts& out) {
  Manifold manifold = collide_pieces(pair, a, b);
  if (manifold.count == 0) return;
  shift_anchors(pair, a, b, manifold);
  out.add({a.part, b.part, a.surface, b.surface, manifold});
}

// One piece of A against the triangles of B. The kernels see the mesh as A.
void add_triangles(const BodyPair& pair, const Piece& a, TriangleScratch& scratch,
                   PartContacts& out) {
  const Piece mesh = {pair.b.shape, nullptr, pair.b.origin, pair.b.rotation, 0, nullptr, {}};
  const PosedShape shape = a.posed();
  const Vec3<Length> offset = saturated<Length>(a.origin - mesh.origin);
  pair.b.asset->mesh_kernels()->collide(*pair.b.asset, {mesh.rotation, shape, offset, pair.margin},
                                        local_region(pair.b, oriented_box(a), pair.margin),
                                        scratch.contacts, scratch.manifolds);
  out.overflowed =
      out.overflowed || scratch.contacts.left_out() != 0 || scratch.manifolds.left_out != 0;
  for (std::size_t i = 0; i < scratch.manifolds.count; ++i) {
    const geometry::MeshManifold& group = scratch.manifolds.manifolds[i];
    PartContact contact{a.part, group.key, a.surface, group.surface,
                        geometry::flipped(group.manifold)};
    shift_anchors(pair, a, mesh, contact.manifold);
    out.add(contact);
  }
}

// Calls `f(piece)` for every piece of A near B.
template <class F>
class EachPiece final : public PieceVisitor {
 public:
  explicit EachPiece(F& f) : f_(f) {}
  void visit(const Piece& piece) override { f_(piece); }

 private:
  F& f_;
};

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

}  // namespace

void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin,
                    TriangleScratch* scratch, PartContacts& out) {
  out.clear();
  const PlacedShape near_b = brought_near(b, a.centre);
  const BodyPair pair{a, near_b, margin};
  if (is_single(a) && is_single(b)) {
    add_pieces(pair, single_piece(a), single_piece(near_b), out);
    return;
  }
  if (b.asset != nullptr && b.asset->mesh_kernels() != nullptr) {
    LKS_CHECK(scratch != nullptr);
    for_each_piece_of_a(pair, [&](const Piece& pa) { add_triangles(pair, pa, *scratch, out); });
    return;
  }
  for_each_pair_of_pieces(pair,
                          [&](const Piece& pa, const Piece& pb) { add_pieces(pair, pa, pb, out); });
}

bool bodies_overlap(const PlacedShape& a, const PlacedShape& b) {
  const PlacedShape near_a = brought_near(a, b.centre), near_b = brought_near(b, a.centre);
  const BodyPair pair{near_a, near_b, {}};
  bool found = false;
  for_each_pair_of_pieces(pair, [&](const Piece& pa, const Piece& pb) {
    found = found || collide_pieces(pair, pa, pb).count > 0;
  });
  return found;
}

}  // namespace lockstone
