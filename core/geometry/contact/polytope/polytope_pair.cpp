#include "core/geometry/contact/polytope/polytope_pair.h"

#include <lockstone/assert.h>

namespace lockstone::geometry {
namespace {

/// B's axes in A's, each entry rounded once.
Mat3 relative(const Mat3& a, const Mat3& b) {
  return {to_local(a, b.x), to_local(a, b.y), to_local(a, b.z)};
}

Fine coarse_dot(const RawVec& point, const Vec3<Unit>& n) {
  return point.x * n.x.raw + point.y * n.y.raw + point.z * n.z.raw;
}

/// The state of the search for the best face.
struct FaceSearch {
  const PolytopeView& view;
  Witness& witness;
  FaceSupport best{};

  [[nodiscard]] Fine height(int face, const RawVec& point) const {
    const PolytopeFace& f = view.own.faces[static_cast<std::size_t>(face)];
    return coarse_dot(point, f.normal) - f.offset;
  }

  /// Whether some witness shows that the face is worse than the best.
  [[nodiscard]] bool is_worse(int face) const {
    for (int i = 0; i < witness.count; ++i) {
      const Fine bound = height(face, witness.points[static_cast<std::size_t>(i)]);
      if (bound + k_witness_slack < best.separation) return true;
    }
    return false;
  }

  void look_at(int face) {
    LKS_ASSERT(face >= 0 && face < static_cast<int>(view.own.faces.size()));
    const PolytopeFace& f = view.own.faces[static_cast<std::size_t>(face)];
    const Vec3<Unit> n = view.to_other(f.normal);
    const Fine base = dot(view.origin, f.normal) - f.offset;
    const Support deepest = support_of(view.other, -n);
    const Fine separation = base - deepest.height;
    witness.add(view.to_own_coarse(view.other.vertices[static_cast<std::size_t>(deepest.vertex)]));
    if (best.face >= 0 && separation < best.separation) return;
    if (best.face >= 0 && separation == best.separation && face > best.face) return;
    best = {face, deepest.vertex, separation};
  }
};

}  // namespace

SplitVec split(const RawVec& v) {
  const RawVec coarse{raw::round_shift(v.x, k_fine_per_length),
                      raw::round_shift(v.y, k_fine_per_length),
                      raw::round_shift(v.z, k_fine_per_length)};
  constexpr std::int64_t unit = std::int64_t{1} << k_fine_per_length;
  return {coarse, {v.x - coarse.x * unit, v.y - coarse.y * unit, v.z - coarse.z * unit}};
}

RawVec PolytopeView::to_own(const Vec3<Length>& v) const {
  const RawVec turn = turned(axes, v);
  constexpr std::int64_t unit = std::int64_t{1} << k_fine_per_length;
  return {turn.x + (origin.coarse.x * unit + origin.remainder.x),
          turn.y + (origin.coarse.y * unit + origin.remainder.y),
          turn.z + (origin.coarse.z * unit + origin.remainder.z)};
}

RawVec PolytopeView::to_own_coarse(const Vec3<Length>& v) const {
  const RawVec turn = turned(axes, v);
  return {origin.coarse.x + raw::round_shift(turn.x, k_fine_per_length),
          origin.coarse.y + raw::round_shift(turn.y, k_fine_per_length),
          origin.coarse.z + raw::round_shift(turn.z, k_fine_per_length)};
}

PolytopePair make_polytope_pair(const Polytope& a, const Mat3& rotation_a, const Polytope& b,
                                const Mat3& rotation_b, const Vec3<Length>& offset, Length margin) {
  const Mat3 b_in_a = relative(rotation_a, rotation_b);
  return {rotation_a,
          rotation_b,
          offset,
          margin,
          {a, b, rotation_a, b_in_a, split(to_local(rotation_a, offset))},
          {b, a, rotation_b, transposed(b_in_a), split(-to_local(rotation_b, offset))}};
}

Fine separation_on(const PolytopePair& pair, const Vec3<Unit>& normal_in_a) {
  const PolytopeView& view = pair.from_a;
  return dot(view.origin, normal_in_a) - support_of(view.own, normal_in_a).height -
         support_of(view.other, -view.to_other(normal_in_a)).height;
}

void Witness::add(const RawVec& point) {
  if (count == 0) points.fill(point);
  points[static_cast<std::size_t>(next)] = point;
  next = next + 1 < static_cast<int>(points.size()) ? next + 1 : 0;
  count = std::min(count + 1, static_cast<int>(points.size()));
}

namespace {

/// Of the faces that are allowed, the one that the point is highest above, the first of equals.
int highest_allowed(const Polytope& own, const FaceHeights& heights, const Facing& facing) {
  int first = -1;
  const int count = static_cast<int>(own.faces.size());
  for (int face = 0; face < count; ++face) {
    const auto i = static_cast<std::size_t>(face);
    if (first >= 0 && heights[i] <= heights[static_cast<std::size_t>(first)]) continue;
    if (facing.allows(own.faces[i].normal)) first = face;
  }
  return first;
}

}  // namespace

FaceSupport best_face(const PolytopeView& view, const Facing& facing, Fine enough,
                      Witness& witness) {
  FaceSearch search{view, witness};
  // The plane highest below the other's inside is the likeliest to be the best.
  FaceHeights heights;
  int first = measure_heights(view.own, view.to_own_coarse(view.other.interior), heights);
  if (!facing.allows(view.own.faces[static_cast<std::size_t>(first)].normal))
    first = highest_allowed(view.own, heights, facing);
  if (first < 0) return {};
  search.look_at(first);
  FaceBits marks;
  mark_faces(view.own, heights, search.best.separation - k_witness_slack, marks);
  for_each_marked(marks, [&](int face) {
    const Fine height = heights[static_cast<std::size_t>(face)];
    if (face == first || search.best.separation > enough) return;
    if (height + k_witness_slack < search.best.separation || search.is_worse(face)) return;
    if (facing.allows(view.own.faces[static_cast<std::size_t>(face)].normal)) search.look_at(face);
  });
  LKS_ASSERT(search.best.face >= 0 && search.best.support >= 0);
  return search.best;
}

}  // namespace lockstone::geometry
