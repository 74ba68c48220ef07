#include "core/collision/collide_bodies.h"

#include "core/collision/pieces.h"

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

// Calls `f(piece_a, piece_b)` for all pieces that come near each other.
template <class F>
class EachOfB final : public PieceVisitor {
 public:
  EachOfB(const Piece& a, F& f) : a_(a), f_(f) {}
  void visit(const Piece& b) override { f_(a_, b); }

 private:
  const Piece& a_;
  F& f_;
};

template <class F>
class EachOfA final : public PieceVisitor {
 public:
  EachOfA(const BodyPair& pair, F& f) : pair_(pair), f_(f) {}
  void visit(const Piece& a) override {
    EachOfB<F> inner(a, f_);
    visit_pieces(pair_.b, oriented_box(a), pair_.margin, inner);
  }

 private:
  const BodyPair& pair_;
  F& f_;
};

template <class F>
void for_each_pair_of_pieces(const BodyPair& pair, F&& f) {
  EachOfA<F> outer(pair, f);
  if (is_single(pair.a)) return outer.visit(single_piece(pair.a));
  const bool unbounded = pair.b.shape.kind == ShapeKind::half_space;
  visit_pieces(pair.a, oriented_box(unbounded ? pair.a : pair.b), pair.margin, outer);
}

}  // namespace

void collide_bodies(const PlacedShape& a, const PlacedShape& b, Length margin, PartContacts& out) {
  out.clear();
  const BodyPair pair{a, b, margin};
  if (is_single(a) && is_single(b)) {
    add_pieces(pair, single_piece(a), single_piece(b), out);
    return;
  }
  for_each_pair_of_pieces(pair,
                          [&](const Piece& pa, const Piece& pb) { add_pieces(pair, pa, pb, out); });
}

bool bodies_overlap(const PlacedShape& a, const PlacedShape& b) {
  const BodyPair pair{a, b, {}};
  bool found = false;
  for_each_pair_of_pieces(pair, [&](const Piece& pa, const Piece& pb) {
    found = found || collide_pieces(pair, pa, pb).count > 0;
  });
  return found;
}

}  // namespace lockstone
