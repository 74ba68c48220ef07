#include "core/geometry/contact/polytope/polytope_edges.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/polytope/polytope_face.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Of a half edge in a feature.
constexpr int k_edge_index_bits = 10;
static_assert(k_max_polytope_edges <= 1 << k_edge_index_bits);

/// Half edges by index.
struct EdgeList {
  std::array<std::uint16_t, k_max_polytope_edges / 2> at;
  int count;
};

/// Of a polytope's half edges.
using EdgeBits = std::array<std::uint64_t, (k_max_polytope_edges + 63) / 64>;

/// The faces that the witnesses are not above by more than the bound.
class WitnessedFaces {
 public:
  WitnessedFaces(const Polytope& own, const Witness& witness, Fine bound)
      : own_(own), witness_(witness), bound_(bound - k_witness_slack) {
    FaceHeights heights;
    (void)measure_heights(own, witness.points[0], heights);
    mark_faces(own, heights, bound_ + 1, above_first_);
    std::fill_n(masks_.begin(), own.faces.size(), k_first);
    for_each_marked(above_first_, [this](int face) { masks_[static_cast<std::size_t>(face)] = 0; });
  }

  /// The faces that the first witness is above.
  [[nodiscard]] const FaceBits& above_first() const { return above_first_; }

  /// Whether one witness is above neither face.
  [[nodiscard]] bool share(std::size_t face, std::size_t other) {
    return (mask_of(face) & mask_of(other)) != 0;
  }

 private:
  static constexpr std::uint8_t k_first = 1;       // and nothing is known of the others
  static constexpr std::uint8_t k_complete = 128;  // bit i: witness i

  [[nodiscard]] bool is_below(std::size_t i, std::size_t face) const {
    const PolytopeFace& plane = own_.faces[face];
    return lean_of(witness_.points[i], plane.normal) <= bound_ + plane.offset;
  }

  std::uint8_t mask_of(std::size_t face) {
    unsigned mask = masks_[face];
    if ((mask & k_complete) != 0) return static_cast<std::uint8_t>(mask ^ k_complete);
    for (std::size_t i = 1; i < witness_.points.size(); ++i)
      mask |= static_cast<unsigned>(is_below(i, face)) << i;
    masks_[face] = static_cast<std::uint8_t>(mask | k_complete);
    return static_cast<std::uint8_t>(mask);
  }

  const Polytope& own_;
  const Witness& witness_;
  Fine bound_;
  FaceBits above_first_;
  std::array<std::uint8_t, k_max_polytope_faces> masks_;
};

/// The edges around faces that the first witness is above; each by its first half.
void mark_edges(const Polytope& own, const WitnessedFaces& faces, EdgeBits& marks) {
  for_each_marked(faces.above_first(), [&](int index) {
    const PolytopeFace& face = own.faces[static_cast<std::size_t>(index)];
    for (unsigned k = face.first_edge; k < unsigned{face.first_edge} + face.edge_count; ++k) {
      const unsigned first = std::min<unsigned>(k, own.edges[k].twin);
      marks[first / 64] |= std::uint64_t{1} << (first % 64);
    }
  });
}

/// How high a witness may be over both faces of an edge whose axes separate by no more than the
/// threshold. Such an axis is a mean of the two normals, made a unit vector; the witness is as high
/// along it as the mean of both heights, divided by the length of the mean normal.
Fine bound_of(const Polytope& own, Fine threshold) {
  if (threshold <= 0) return threshold;  // the division only lowers it
  const Fine height = raw::multiply_shift(threshold, own.least_mean_normal.raw, Unit::frac_bits);
  return std::max(height - own.unevenness - k_witness_slack, Fine{0});
}

void collect_edges(const Polytope& own, const Witness& witness, Fine threshold, EdgeList& list) {
  WitnessedFaces faces(own, witness, bound_of(own, threshold));
  EdgeBits marks{};
  mark_edges(own, faces, marks);
  list.count = 0;
  for (std::size_t word = 0; word < marks.size(); ++word) {
    for (std::uint64_t bits = marks[word]; bits != 0; bits &= bits - 1) {
      const std::size_t edge = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
      const HalfEdge& half = own.edges[edge];
      if (faces.share(half.face, own.edges[half.twin].face)) continue;
      LKS_ASSERT(edge < own.edges.size() && list.count < static_cast<int>(list.at.size()));
      list.at[static_cast<std::size_t>(list.count++)] = static_cast<std::uint16_t>(edge);
    }
  }
}

/// An edge with the normals on its left and right, seen from outside.
struct GaussArc {
  RawVec edge;  ///< narrow; left × right points along it
  Vec3<Unit> left;
  Vec3<Unit> right;
};

GaussArc arc_of(const Polytope& p, int edge) {
  const HalfEdge& half = p.edges[static_cast<std::size_t>(edge)];
  return {raws_of(edge_vector(p, edge)), p.faces[half.face].normal,
          p.faces[p.edges[half.twin].face].normal};
}

/// B's arc as a vertex of A sees it: normals reversed, in A's axes.
GaussArc opposed_arc(const PolytopeView& view, int edge) {
  const GaussArc arc = arc_of(view.other, edge);
  const RawVec along_edge = turned(view.axes, edge_vector(view.other, edge));
  return {narrowed(along_edge, 30), -lockstone::rotate(view.axes, arc.left),
          -lockstone::rotate(view.axes, arc.right)};
}

/// +1 or −1 when the arcs cross, the sign of the crossing along a.edge × b.edge; else 0.
int crossing_sign(const GaussArc& a, const GaussArc& b) {
  const std::int64_t left = lean_of(b.edge, a.left);
  const std::int64_t right = lean_of(b.edge, a.right);
  if (left == 0 || right == 0 || (left < 0) == (right < 0)) return 0;
  const std::int64_t b_left = lean_of(a.edge, b.left);
  const std::int64_t b_right = lean_of(a.edge, b.right);
  if (b_left == 0 || b_right == 0 || (b_left < 0) == (b_right < 0)) return 0;
  if ((b_left < 0) != (right < 0)) return 0;  // they cross on opposite hemispheres
  return left > 0 ? 1 : -1;
}

struct EdgeSearch {
  const PolytopePair& pair;
  const Facing& front;
  Fine threshold;
  EdgeSupport best{};

  /// Where the edges' arcs cross.
  void look_at(int edge_a, const GaussArc& a, int edge_b, const GaussArc& b) {
    const int sign = crossing_sign(a, b);
    if (sign == 0) return;
    const RawVec k = cross_narrow(a.edge, b.edge);
    if (k != RawVec{}) look_at(edge_a, edge_b, signed_axis(direction_of(k.x, k.y, k.z), sign));
  }
  void look_at(int edge_a, int edge_b, const Vec3<Unit>& normal) {
    LKS_ASSERT(is_unit(normal));
    const PolytopeView& view = pair.from_a;
    const RawVec gap =
        view.to_own_coarse(start_of(view.other, edge_b)) - raws_of(start_of(view.own, edge_a));
    // Of any two points; that of the supports is not above it.
    if (lean_of(gap, normal) + k_witness_slack <= threshold) return;
    const Fine separation = separation_on(pair, normal);
    if (separation <= threshold) return;
    if (separation <= 0 && !front.allows(-normal)) return;
    best = {true, edge_a, edge_b, normal, separation};
    threshold = separation;
  }
};

}  // namespace

RawVec narrowed(const RawVec& v, int bits) {
  const auto size =
      static_cast<std::uint64_t>(magnitude_of(v.x) | magnitude_of(v.y) | magnitude_of(v.z));
  const int shift = static_cast<int>(std::bit_width(size)) - bits;
  if (shift <= 0) return v;
  // Rounding may reach 2^bits itself, which the users of the lanes have room for.
  return {raw::round_shift(v.x, shift), raw::round_shift(v.y, shift), raw::round_shift(v.z, shift)};
}

EdgeSupport best_edge(const PolytopePair& pair, Fine threshold, const Facing& front,
                      const Witness& of_a, const Witness& of_b) {
  EdgeList edges_a;
  EdgeList edges_b;
  collect_edges(pair.from_a.own, of_b, threshold, edges_a);
  if (edges_a.count == 0) return {};
  collect_edges(pair.from_b.own, of_a, threshold, edges_b);
  EdgeSearch search{pair, front, threshold};
  for (int j = 0; j < edges_b.count; ++j) {
    const int edge_b = edges_b.at[static_cast<std::size_t>(j)];
    const GaussArc b = opposed_arc(pair.from_a, edge_b);
    for (int i = 0; i < edges_a.count; ++i) {
      const int edge_a = edges_a.at[static_cast<std::size_t>(i)];
      search.look_at(edge_a, arc_of(pair.from_a.own, edge_a), edge_b, b);
    }
  }
  LKS_ASSERT(!search.best.found || search.best.separation > threshold);
  return search.best;
}

std::uint32_t feature_of_edges(int edge_a, int edge_b) {
  LKS_ASSERT(edge_a >= 0 && edge_a < 1 << k_edge_index_bits && edge_b >= 0 &&
             edge_b < 1 << k_edge_index_bits);
  return k_hull_edge_bits | static_cast<std::uint32_t>(edge_a) << k_edge_index_bits |
         static_cast<std::uint32_t>(edge_b);
}

bool is_of_hull_edges(std::uint32_t feature) {
  return feature >> 28 == k_hull_edge_bits >> 28;
}

EdgeSupport held_edge(const PolytopePair& pair, std::uint32_t feature, const Facing& front) {
  LKS_ASSERT(is_of_hull_edges(feature));
  const auto index = [](std::uint32_t x) {
    return static_cast<int>(x % (1U << k_edge_index_bits));
  };
  const int edge_a = index(feature >> k_edge_index_bits), edge_b = index(feature);
  const auto has = [](const Polytope& polytope, int edge) {
    return edge < static_cast<int>(polytope.edges.size());
  };
  if (!has(pair.from_a.own, edge_a) || !has(pair.from_b.own, edge_b)) return {};
  EdgeSearch search{pair, front, -k_any_separation};
  search.look_at(edge_a, arc_of(pair.from_a.own, edge_a), edge_b, opposed_arc(pair.from_a, edge_b));
  return search.best;
}

Segment edge_segment(const Polytope& polytope, int edge, const Mat3& rotation,
                     const RawVec& origin) {
  const RawVec from = turned(rotation, start_of(polytope, edge));
  const RawVec to = turned(rotation, end_of(polytope, edge));
  const RawVec way = to - from;
  const Direction d = direction(way.x, way.y, way.z);
  const auto half = raw::round_shift(static_cast<Fine>(d.length), k_fine_per_length + 1);
  const RawVec middle{from.x + way.x / 2, from.y + way.y / 2, from.z + way.z / 2};
  return {origin + middle, d.unit, Length::from_raw(static_cast<std::int32_t>(half))};
}

}  // namespace lockstone::geometry
