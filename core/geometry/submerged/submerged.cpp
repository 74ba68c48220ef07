#include "core/geometry/submerged/submerged.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/geometry/convex/polytope_box.h"
#include "core/geometry/convex/rounded_facets.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/shapes/tapered_ends.h"
#include "core/geometry/submerged/clipped_solid.h"
#include "core/geometry/submerged/sliced_solid.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

bool is_rounded_box(const ConvexSolid& solid) {
  return solid.polytope == nullptr && solid.shape.kind == ShapeKind::rounded_box;
}

std::int64_t times_pi(std::int64_t x) {
  return saturated_product(x, k_pi_q60, 60);
}

std::int64_t size_of(const Polytope& polytope) {
  std::int64_t most = 1;
  for (const Vec3<Length>& v : polytope.vertices) {
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(std::int64_t{v[i].raw} - polytope.interior[i].raw));
  }
  return most;
}

// Every point of the solid is within 2^scale m of its reference point.
int scale_of(const ConvexSolid& solid) {
  if (solid.polytope == nullptr) return scale_exponent(solid.shape);
  const auto most =
      static_cast<std::uint64_t>(size_of(*solid.polytope) + solid.polytope->radius.raw);
  return static_cast<int>(std::bit_width(most)) + 1 - Length::frac_bits;
}

// In units of the scale, `bits` fraction bits.
std::int64_t scaled_length(Length x, int scale, int bits) {
  return raw::scale_binary(x.raw, bits - Length::frac_bits - scale);
}

// n · x ≤ offset of the reference point, 30 bits; beyond ±2 nothing changes.
std::int64_t scaled_offset(const SubmergedPart& part, const BelowPlane& plane) {
  std::int64_t offset = plane.offset.raw;
  for (int i = 0; i < 3; ++i)
    offset -= raw::round_shift(std::int64_t{plane.normal[i].raw} * part.reference[i].raw, 18);
  const std::int64_t most = std::int64_t{1} << (Position::frac_bits + 1 + part.scale);
  return raw::scale_binary(std::clamp(offset, -most, most), -2 - part.scale);
}

void add_ball(const Shape& ball, const Vec3<Unit>& n, std::int64_t offset, SubmergedPart& part) {
  const std::int64_t radius = scaled_length(ball.size.x, part.scale, 30);
  const std::int64_t height = std::clamp<std::int64_t>(radius + offset, 0, 2 * radius);
  const std::int64_t rest = 2 * radius - height;
  // π h² (3R − h) / 3, π/4 h² (2R − h)² and π h (2R − h).
  const std::int64_t square = product_q30(height, height);
  const Int128 volume = multiply_wide(height * height, 3 * radius - height);
  part.volume =
      raw::round_divide(times_pi(saturate_to_int64(round_shift(volume, 90 - k_submerged_bits))), 3);
  const std::int64_t moment = times_pi(raw::round_shift(square * product_q30(rest, rest), 14));
  for (int i = 0; i < 3; ++i)
    part.moment[static_cast<std::size_t>(i)] = -product_q30(moment, n[i].raw);
  part.plane_area = times_pi(raw::round_shift(height * rest, 12));
}

constexpr std::array<std::array<std::size_t, 4>, 6> k_box_faces{
    {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

void add_box(const Shape& box, const Vec3<Unit>& n, std::int64_t offset, SubmergedPart& part) {
  ScaledPoint half;
  for (int i = 0; i < 3; ++i)
    half[static_cast<std::size_t>(i)] = scaled_length(box.size[i], part.scale, k_scaled_bits);
  ClippedSolid clipped(n, offset);
  for (const auto& face : k_box_faces) {
    std::array<ScaledPoint, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        corners[i][axis] = (face[i] >> axis & 1) != 0 ? half[axis] : -half[axis];
    }
    clipped.add_face(corners);
  }
  clipped.finish(part);
}

template <class F>
void for_each_face(const Polytope& polytope, const SubmergedPart& part, F&& f) {
  std::array<ScaledPoint, k_max_polytope_face_edges> corners;
  for (const PolytopeFace& face : polytope.faces) {
    LKS_ASSERT(face.edge_count >= 3 && face.edge_count <= k_max_polytope_face_edges);
    for (std::size_t i = 0; i < face.edge_count; ++i) {
      const Vec3<Length>& at = start_of(polytope, static_cast<int>(face.first_edge + i));
      for (int axis = 0; axis < 3; ++axis)
        corners[i][static_cast<std::size_t>(axis)] =
            raw::scale_binary(std::int64_t{at[axis].raw} - part.reference[axis].raw,
                              k_scaled_bits - Length::frac_bits - part.scale);
    }
    f(std::span<const ScaledPoint>(corners).first(face.edge_count));
  }
}

void add_rounded(const Polytope& polytope, const SubmergedPart& part, ClippedSolid& clipped) {
  const RawVec reference = fine(part.reference);
  RoundedFacets(polytope, FacetReach::volume).for_each([&](std::span<const RawVec> facet) {
    std::array<ScaledPoint, k_max_polytope_face_edges> corners;
    for (std::size_t i = 0; i < facet.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        corners[i][static_cast<std::size_t>(axis)] = raw::scale_binary(
            facet[i][axis] - reference[axis], k_scaled_bits - k_fine_bits - part.scale);
    }
    clipped.add_face(std::span<const ScaledPoint>(corners).first(facet.size()));
  });
}

/// The balls of a tapered capsule in units of the scale, 30 fraction bits.
struct ScaledEnds {
  std::int64_t low, high;
  std::int64_t low_radius, high_radius;
};

ScaledEnds scaled_ends(const TaperedEnds& ends, int scale) {
  const auto height = [&](Fine y) { return raw::scale_binary(y, 30 - k_fine_bits - scale); };
  return {height(ends.low), height(ends.high), scaled_length(ends.low_radius, scale, 30),
          scaled_length(ends.high_radius, scale, 30)};
}

void add_tapered(const Shape& shape, int scale, SlicedSolid& sliced) {
  const TaperedEnds ends = tapered_ends(shape.size);
  const ScaledEnds at = scaled_ends(ends, scale);
  const std::int64_t up = ends.slope().raw, out = ends.rise().raw;
  const std::int64_t first = at.low + product_q30(at.low_radius, up);
  const std::int64_t last = at.high + product_q30(at.high_radius, up);
  sliced.add({at.low - at.low_radius, first, 0, 0, at.low_radius, at.low});
  sliced.add({first, last, product_q30(at.low_radius, out), product_q30(at.high_radius, out)});
  sliced.add({last, at.high + at.high_radius, 0, 0, at.high_radius, at.high});
}

void add_round(const Shape& shape, const Vec3<Unit>& n, std::int64_t offset, SubmergedPart& part) {
  SlicedSolid sliced(n, offset);
  const auto scaled = [&](Length x) { return scaled_length(x, part.scale, 30); };
  if (shape.kind == ShapeKind::cylinder) {
    const std::int64_t r = scaled(shape.size.x), h = scaled(shape.size.y);
    sliced.add({-h, h, r, r});
  } else if (shape.kind == ShapeKind::cone) {
    const std::int64_t r = scaled(shape.size.x), h = scaled(shape.size.y), base = h / 4;
    sliced.add({-base, h - base, r, 0});
  } else if (shape.kind == ShapeKind::tapered_capsule) {
    add_tapered(shape, part.scale, sliced);
  } else {
    const std::int64_t r = scaled(shape.size.x), h = scaled(shape.size.y);
    sliced.add({-h - r, -h, 0, 0, r, -h});
    sliced.add({-h, h, r, r});
    sliced.add({h, h + r, 0, 0, r, h});
  }
  sliced.finish(part);
}

}  // namespace

namespace {

/// Volumes of slivers below this have too few digits to be corrected by: 2^-36 of the scale's cube.
constexpr std::int64_t k_least_corrected = 1 << 12;

void correct(const FacetCorrection& facets, SubmergedPart& part) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t aside = saturated_product(part.volume, facets.centre[i], k_submerged_bits);
    part.moment[i] = product_q30(part.moment[i] - aside, facets.volume);
  }
  part.volume = product_q30(part.volume, facets.volume);
}

/// The share of the facets that is below, of the exact volume.
SubmergedPart rounded_box_below(const Shape& shape, const BelowPlane& plane) {
  const BoxPolytope box(shape.size, shape.fourth_size());
  const Polytope view = box.view();
  SubmergedPart part = part_below({shape, &view}, plane);
  if (part.volume == 0) return part;
  const std::int64_t of_facets = whole({shape, &view}).volume;
  if (of_facets < k_least_corrected) return part;
  const BlockFloat exact = traits_of(shape).volume(shape);
  const std::int64_t volume =
      raw::scale_binary(exact.mantissa, exact.exponent - 3 * part.scale + k_submerged_bits);
  const auto scaled = [&](std::int64_t x) {
    return round_divide(multiply_wide(x, volume), of_facets);
  };
  part.volume = scaled(part.volume);
  for (std::int64_t& moment : part.moment)
    moment = scaled(moment);
  return part;
}

}  // namespace

SubmergedPart part_below(const ConvexSolid& solid, const BelowPlane& plane) {
  if (is_rounded_box(solid)) return rounded_box_below(solid.shape, plane);
  SubmergedPart part;
  part.scale = scale_of(solid);
  if (solid.polytope != nullptr) part.reference = solid.polytope->interior;
  const std::int64_t offset = scaled_offset(part, plane);
  if (solid.polytope != nullptr) {
    ClippedSolid clipped(plane.normal, offset);
    if (solid.polytope->radius > Length{})
      add_rounded(*solid.polytope, part, clipped);
    else
      for_each_face(*solid.polytope, part,
                    [&](std::span<const ScaledPoint> face) { clipped.add_face(face); });
    clipped.finish(part);
  } else if (solid.shape.kind == ShapeKind::sphere) {
    add_ball(solid.shape, plane.normal, offset, part);
  } else if (solid.shape.kind == ShapeKind::box) {
    add_box(solid.shape, plane.normal, offset, part);
  } else {
    add_round(solid.shape, plane.normal, offset, part);
  }
  part.volume = std::max<std::int64_t>(part.volume, 0);
  if (solid.polytope != nullptr && solid.polytope->facets != nullptr)
    correct(*solid.polytope->facets, part);
  return part;
}

FacetCorrection facet_correction(const Polytope& polytope, BlockFloat volume) {
  LKS_ASSERT(polytope.radius > Length{} && polytope.facets == nullptr);
  const Shape shape{ShapeKind::hull, {}, {}};
  const SubmergedPart facets = whole({shape, &polytope});
  const std::int64_t exact =
      raw::scale_binary(volume.mantissa, volume.exponent - 3 * facets.scale + k_submerged_bits);
  FacetCorrection correction;
  if (facets.volume < k_least_corrected) return correction;
  correction.volume = round_divide(multiply_wide(exact, std::int64_t{1} << 30), facets.volume);
  for (std::size_t i = 0; i < 3; ++i)
    correction.centre[i] = round_divide(
        multiply_wide(facets.moment[i], std::int64_t{1} << k_submerged_bits), facets.volume);
  return correction;
}

SubmergedPart whole(const ConvexSolid& solid) {
  return part_below(solid, {{{}, Unit::from_integer(1), {}}, Position::from_integer(1 << 20)});
}

namespace {

// 30 bits.
std::int64_t box_shadow(const Shape& box, int scale, const Vec3<Unit>& u) {
  std::int64_t area = 0;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t a = scaled_length(box.size[(i + 1) % 3], scale, 30);
    const std::int64_t b = scaled_length(box.size[(i + 2) % 3], scale, 30);
    area += 4 * product_q30(product_q30(a, b), std::abs(std::int64_t{u[i].raw}));
  }
  return area;
}

// The base's ellipse, and beside it the triangle of the apex with tangents to it.
std::int64_t cone_shadow(std::int64_t r, std::int64_t h, std::int64_t along, std::int64_t across) {
  const std::int64_t minor = product_q30(r, along), apex = product_q30(h, across);
  if (apex <= minor) return times_pi(product_q30(r, minor));
  const auto side = static_cast<std::int64_t>(
      isqrt_rounded(static_cast<std::uint64_t>(apex * apex - minor * minor)));
  const std::int64_t angle =  // π − acos(minor / apex), 32 bits
      fine_arc(static_cast<std::uint64_t>(side), -minor).raw;
  return product_q30(r, raw::round_shift(product_q30(minor, angle), 2) + side);
}

// Of two discs and the part between the tangents to both, or of the greater disc that holds the
// other.
std::int64_t tapered_shadow(const TaperedEnds& ends, int scale, std::int64_t across) {
  const ScaledEnds at = scaled_ends(ends, scale);
  const std::int64_t r = at.low_radius, s = at.high_radius, greater = std::max(r, s);
  const std::int64_t apart = product_q30(at.high - at.low, across), fall = r - s;
  if (apart <= std::abs(fall)) return times_pi(product_q30(greater, greater));
  const auto side = static_cast<std::int64_t>(
      isqrt_rounded(static_cast<std::uint64_t>(apart * apart - fall * fall)));
  const auto sector = [&](std::int64_t radius, std::int64_t toward) {  // angles have 32 bits
    const std::int64_t angle = fine_arc(static_cast<std::uint64_t>(side), toward).raw;
    return raw::round_shift(product_q30(product_q30(radius, radius), angle), 2);
  };
  return sector(r, -fall) + sector(s, fall) + product_q30(r + s, side);
}

std::int64_t round_shadow(const Shape& shape, int scale, const Vec3<Unit>& u) {
  const std::int64_t r = scaled_length(shape.size.x, scale, 30);
  const std::int64_t h = scaled_length(shape.size.y, scale, 30);
  const std::int64_t along = std::abs(std::int64_t{u.y.raw});
  const auto across = static_cast<std::int64_t>(isqrt_rounded(static_cast<std::uint64_t>(
      std::int64_t{u.x.raw} * u.x.raw + std::int64_t{u.z.raw} * u.z.raw)));
  const std::int64_t disc = times_pi(product_q30(r, r)),
                     side = 4 * product_q30(product_q30(r, h), across);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return disc;
    case ShapeKind::capsule:
      return disc + side;
    case ShapeKind::cylinder:
      return product_q30(disc, along) + side;
    case ShapeKind::tapered_capsule:
      return tapered_shadow(tapered_ends(shape.size), scale, across);
    default:
      return cone_shadow(r, h, along, across);
  }
}

// By how much a radius makes the shadow greater: its circumference times the radius, and a disc.
// 30 bits.
std::int64_t rounded_rim(const Polytope& polytope, int scale, const Vec3<Unit>& u) {
  const auto looks_along = [&](int edge) {
    const std::size_t face = polytope.edges[static_cast<std::size_t>(edge)].face;
    return lockstone::dot(polytope.faces[face].normal, u).raw >= 0;
  };
  std::int64_t circumference = 0;
  for (int edge = 0; edge < static_cast<int>(polytope.edges.size()); ++edge) {
    const int twin = polytope.edges[static_cast<std::size_t>(edge)].twin;
    if (!is_first_half(polytope, edge) || looks_along(edge) == looks_along(twin)) continue;
    const Vec3<Length> way = edge_vector(polytope, edge);
    const auto side = [&](int i, int j) {
      return scaled_length(way[i], scale, 30) * u[j].raw -
             scaled_length(way[j], scale, 30) * u[i].raw;
    };
    circumference += static_cast<std::int64_t>(norm(side(1, 2), side(2, 0), side(0, 1)) >> 30);
  }
  const std::int64_t radius = scaled_length(polytope.radius, scale, 30);
  return product_q30(circumference, radius) + times_pi(product_q30(radius, radius));
}

// Half the sum of the faces' areas along the direction. 30 bits.
std::int64_t polytope_shadow(const Polytope& polytope, int scale, const Vec3<Unit>& u) {
  SubmergedPart frame;
  frame.scale = scale;
  frame.reference = polytope.interior;
  std::int64_t sum = 0;
  for_each_face(polytope, frame, [&](std::span<const ScaledPoint> face) {
    ScaledPoint twice{};
    for (std::size_t i = 0; i < face.size(); ++i) {
      const ScaledPoint area = cross(face[i], face[(i + 1) % face.size()]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        twice[axis] += area[axis] >> 2;
    }
    std::int64_t along = 0;  // 54 bits, to 30
    for (int axis = 0; axis < 3; ++axis)
      along += product_q30(twice[static_cast<std::size_t>(axis)], u[axis].raw);
    sum += std::abs(along) >> 24;
  });
  return sum / 4 + (polytope.radius > Length{} ? rounded_rim(polytope, scale, u) : 0);
}

}  // namespace

Shadow shadow_of(const ConvexSolid& solid, const Vec3<Unit>& direction) {
  if (is_rounded_box(solid)) {
    const BoxPolytope box(solid.shape.size, solid.shape.fourth_size());
    const Polytope view = box.view();
    return shadow_of({solid.shape, &view}, direction);
  }
  const int scale = scale_of(solid);
  std::int64_t area = 0;
  if (solid.polytope != nullptr)
    area = polytope_shadow(*solid.polytope, scale, direction);
  else if (solid.shape.kind == ShapeKind::box)
    area = box_shadow(solid.shape, scale, direction);
  else
    area = round_shadow(solid.shape, scale, direction);
  return {scale, area * (std::int64_t{1} << (k_submerged_bits - 30))};
}

}  // namespace lockstone::geometry
