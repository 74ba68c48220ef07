#include "core/geometry/convex/rounded_solid.h"

#include <array>
#include <bit>

#include <lockstone/hull.h>

#include "core/math/principal_axes.h"
#include "core/math/soft_real.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

using SoftVec = std::array<SoftReal, 3>;
using SoftTensor = SymMat3<SoftReal>;

SoftVec operator+(const SoftVec& a, const SoftVec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
SoftVec operator-(const SoftVec& a, const SoftVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
SoftVec operator*(SoftReal s, const SoftVec& v) {
  return {s * v[0], s * v[1], s * v[2]};
}
SoftTensor operator*(SoftReal s, const SoftTensor& t) {
  return {s * t.xx, s * t.yy, s * t.zz, s * t.xy, s * t.xz, s * t.yz};
}
SoftReal dot(const SoftVec& a, const SoftVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
SoftVec cross(const SoftVec& a, const SoftVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// a bᵀ + b aᵀ.
SoftTensor both(const SoftVec& a, const SoftVec& b) {
  const auto entry = [&](std::size_t i, std::size_t j) { return a[i] * b[j] + b[i] * a[j]; };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}
SoftTensor square_of(const SoftVec& a) {
  return SoftReal::of(1, -1) * both(a, a);
}
SoftTensor diagonal(SoftReal x) {
  return {x, x, x, {}, {}, {}};
}
SoftReal share(std::int64_t numerator, std::int64_t denominator) {
  return SoftReal::of(numerator) / SoftReal::of(denominator);
}

/// The angle of (x, y) with y ≥ 0.
SoftReal angle_of(SoftReal y, SoftReal x) {
  const auto height = static_cast<std::uint64_t>(std::max<std::int64_t>(fixed_point(y, 60), 0));
  return SoftReal::of(fine_arc(height, fixed_point(x, 60)).raw, -RotationComponent::frac_bits);
}

/// ∫1, ∫x and ∫x xᵀ.
struct SoftMoments {
  SoftReal volume;
  SoftVec first{};
  SoftTensor second{};

  void add(SoftReal v, const SoftVec& f, const SoftTensor& s) {
    volume += v;
    first = first + f;
    second = second + s;
  }
  /// A part at `place`, whose integrals from there are given.
  void add_at(const SoftVec& place, SoftReal v, const SoftVec& f, const SoftTensor& s) {
    add(v, v * place + f, v * square_of(place) + both(place, f) + s);
  }
};

/// The angle between the normals beside an edge, and the integral of the unit vectors between them.
struct EdgeTurn {
  SoftVec along;  ///< from the half edge's origin
  SoftReal length;
  SoftReal angle;
  SoftReal sine;
  SoftVec arc;
};

class RoundedIntegrals {
 public:
  RoundedIntegrals(const Polytope& polytope, const Vec3<Length>& origin)
      : p_(polytope), origin_(origin), r_(SoftReal::of(polytope.radius.raw)) {}

  [[nodiscard]] SoftMoments sum() {
    for (const PolytopeFace& face : p_.faces)
      add_face(face);
    for (int edge = 0; edge < static_cast<int>(p_.edges.size()); ++edge)
      if (is_first_half(p_, edge)) add_edge(edge);
    for (std::size_t vertex = 0; vertex < p_.vertices.size(); ++vertex)
      add_vertex(static_cast<int>(vertex));
    return sum_;
  }

 private:
  [[nodiscard]] SoftVec place_of(const Vec3<Length>& v) const {
    const auto lane = [&](int i) { return SoftReal::of(std::int64_t{v[i].raw} - origin_[i].raw); };
    return {lane(0), lane(1), lane(2)};
  }
  [[nodiscard]] static SoftVec soft(const Vec3<Unit>& n) {
    const auto lane = [](Unit x) { return SoftReal::of(x.raw, -Unit::frac_bits); };
    return {lane(n.x), lane(n.y), lane(n.z)};
  }
  [[nodiscard]] SoftVec normal_at(int edge) const {
    return soft(p_.faces[p_.edges[static_cast<std::size_t>(edge)].face].normal);
  }

  /// The tetrahedra from the origin to the face, and the prism on it.
  void add_face(const PolytopeFace& face) {
    const SoftVec n = soft(face.normal);
    const SoftVec first = place_of(start_of(p_, face.first_edge));
    SoftMoments flat;
    for (int i = 1; i + 1 < face.edge_count; ++i) {
      const SoftVec b = place_of(start_of(p_, face.first_edge + i));
      const SoftVec c = place_of(start_of(p_, face.first_edge + i + 1));
      const SoftVec total = first + b + c;
      const SoftTensor squares = square_of(first) + square_of(b) + square_of(c) + square_of(total);
      const SoftReal volume = share(1, 6) * dot(first, cross(b, c));
      sum_.add(volume, share(1, 4) * volume * total, share(1, 20) * volume * squares);
      const SoftReal area = share(1, 2) * dot(n, cross(b - first, c - first));
      flat.add(area, share(1, 3) * area * total, share(1, 12) * area * squares);
    }
    const SoftReal half = share(1, 2) * r_ * r_;
    sum_.add(r_ * flat.volume, r_ * flat.first + half * flat.volume * n,
             r_ * flat.second + half * both(flat.first, n) +
                 share(1, 3) * r_ * r_ * r_ * flat.volume * square_of(n));
  }

  [[nodiscard]] EdgeTurn turn_of(int edge) const {
    const SoftVec way = place_of(end_of(p_, edge)) - place_of(start_of(p_, edge));
    const SoftReal length = root_of(dot(way, way));
    const SoftVec along = SoftReal::of(1) / length * way;
    const int twin = p_.edges[static_cast<std::size_t>(edge)].twin;
    const SoftVec here = normal_at(edge), there = normal_at(twin);
    const SoftVec turned = cross(here, there);
    const SoftReal sine = root_of(dot(turned, turned));
    return {along, length, angle_of(sine, dot(here, there)), sine, cross(along, here - there)};
  }

  /// A wedge of a cylinder.
  void add_edge(int edge) {
    const EdgeTurn turn = turn_of(edge);
    const SoftReal square = dot(turn.arc, turn.arc);
    if (turn.angle.mantissa == 0 || square.mantissa == 0) return;
    const SoftVec from = place_of(start_of(p_, edge)), to = place_of(end_of(p_, edge));
    const SoftVec middle = share(1, 2) * (from + to);
    // ∫u uᵀ = θ/2 (I − ê êᵀ) + sin θ/2 (2 b bᵀ − I + ê êᵀ), b the middle direction.
    const SoftTensor across = diagonal(SoftReal::of(1)) - square_of(turn.along);
    const SoftReal half = share(1, 2);
    const SoftTensor arcs =
        half * (turn.angle - turn.sine) * across + turn.sine / square * square_of(turn.arc);
    const SoftReal rr = r_ * r_;
    const SoftReal volume = half * rr * turn.angle * turn.length;
    sum_.add_at(middle, volume, share(1, 3) * rr * r_ * turn.length * turn.arc,
                share(1, 12) * volume * turn.length * turn.length * square_of(turn.along) +
                    share(1, 4) * rr * rr * turn.length * arcs);
  }

  /// A sector of a ball.
  void add_vertex(int vertex) {
    int first = 0;
    while (p_.edges[static_cast<std::size_t>(first)].origin != vertex)
      ++first;
    SoftVec ends{};
    SoftTensor arcs{};
    SoftReal solid_angle;
    int edge = first;
    do {
      const EdgeTurn turn = turn_of(edge);
      ends = ends + turn.angle * turn.along;
      arcs = arcs + both(turn.along, turn.arc);
      const int next = next_edge(p_, p_.edges[static_cast<std::size_t>(edge)].twin);
      solid_angle += triangle_angle(normal_at(first), normal_at(edge), normal_at(next));
      edge = next;
    } while (edge != first);
    const SoftReal rrr = r_ * r_ * r_;
    const SoftTensor squares = diagonal(share(1, 3) * solid_angle) - share(1, 6) * arcs;
    sum_.add_at(place_of(p_.vertices[static_cast<std::size_t>(vertex)]),
                share(1, 3) * rrr * solid_angle, share(-1, 8) * rrr * r_ * ends,
                share(1, 5) * rrr * r_ * r_ * squares);
  }

  /// A. van Oosterom and J. Strackee, The solid angle of a plane triangle.
  [[nodiscard]] static SoftReal triangle_angle(const SoftVec& a, const SoftVec& b,
                                               const SoftVec& c) {
    SoftReal volume = dot(a, cross(b, c));
    if (volume.mantissa < 0) volume = -volume;
    const SoftReal rest = SoftReal::of(1) + dot(a, b) + dot(b, c) + dot(c, a);
    return 2 * angle_of(SoftReal::of(1, -3) * volume, SoftReal::of(1, -3) * rest);
  }

  const Polytope& p_;
  const Vec3<Length>& origin_;
  SoftReal r_;
  SoftMoments sum_;
};

/// The greatest distance of a vertex, rounded up.
Length vertex_radius(const Polytope& polytope, const Vec3<Length>& centre) {
  std::uint64_t most = 0;
  for (const Vec3<Length>& vertex : polytope.vertices) {
    const auto lane = [&](int i) { return std::int64_t{vertex[i].raw} - centre[i].raw; };
    most = std::max(most, norm(lane(0), lane(1), lane(2)) + 1);
  }
  return Length::from_raw(raw::saturate<std::int32_t>(static_cast<std::int64_t>(most)));
}

/// ∫x xᵀ / V about the centre of mass, of the scale 2^scale_bits raw, as inertia with 60 bits.
SymMat3<std::int64_t> inertia_about(const SoftMoments& sum, const SoftVec& centre, int scale_bits) {
  const SoftTensor c = SoftReal::of(1) / sum.volume * sum.second - square_of(centre);
  const auto entry = [scale_bits](SoftReal x) {
    return fixed_point(x, k_tensor_bits - 2 * scale_bits);
  };
  return {entry(c.yy + c.zz), entry(c.zz + c.xx), entry(c.xx + c.yy),
          entry(-c.xy),       entry(-c.xz),       entry(-c.yz)};
}

}  // namespace

std::optional<Solid> rounded_solid_of(const Polytope& polytope) {
  LKS_ASSERT(polytope.radius > Length{} && !is_flat(polytope));
  const Vec3<Length> origin = polytope.interior;
  const SoftMoments sum = RoundedIntegrals(polytope, origin).sum();
  Solid solid;
  solid.volume = block_float(static_cast<std::uint64_t>(sum.volume.mantissa),
                             sum.volume.exponent - 3 * Length::frac_bits);
  const SoftVec centre = SoftReal::of(1) / sum.volume * sum.first;
  for (int axis = 0; axis < 3; ++axis) {
    const Fine arm = fixed_point(centre[static_cast<std::size_t>(axis)], k_fine_per_length);
    const std::int64_t whole = raw::round_shift(arm, k_fine_per_length);
    solid.centre[axis] = origin[axis] + Length::from_raw(static_cast<std::int32_t>(whole));
    solid.remainder[axis] = arm - whole * (Fine{1} << k_fine_per_length);
  }
  const Length vertices = vertex_radius(polytope, solid.centre);
  if (vertices > k_max_hull_radius - polytope.radius) return std::nullopt;
  solid.radius = vertices + polytope.radius;
  const auto scale_bits =
      static_cast<int>(std::bit_width(static_cast<std::uint32_t>(solid.radius.raw) - 1));
  solid.scale_exponent = scale_bits - Length::frac_bits;
  const PrincipalAxes principal = principal_axes(inertia_about(sum, centre, scale_bits));
  const auto& [x, y, z] = principal.moments;
  solid.inertia = {to_moment(x), to_moment(y), to_moment(z)};
  solid.set_axes(principal.axes);
  return solid;
}

}  // namespace lockstone::geometry
