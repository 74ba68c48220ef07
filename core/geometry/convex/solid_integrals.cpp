#include "core/geometry/convex/solid_integrals.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/geometry/numeric/exact_plane.h"
#include "core/math/int192.h"
#include "core/math/principal_axes.h"

namespace lockstone::geometry {
namespace {

using Vertices = std::span<const Vec3<Length>>;
using Triangles = std::span<const Triangle>;

constexpr int k_remainder_bits = 31;

std::array<RawVec, 3> corners_of(Vertices vertices, const Triangle& t, const Vec3<Length>& apex) {
  return {difference(vertices[t[0]], apex), difference(vertices[t[1]], apex),
          difference(vertices[t[2]], apex)};
}

/// Six times the volume of the tetrahedron with the corners and the origin.
Int128 six_volumes(const std::array<RawVec, 3>& corner) {
  return dot_wide(cross(corner[0], corner[1]), corner[2]);
}

/// Volume V and first moments about the apex, exact.
struct FirstMoments {
  Int128 volume_6{};                  ///< 6·V, below 2^96
  std::array<Int192, 3> moment_24{};  ///< 24·∫x
};

FirstMoments first_moments(Vertices vertices, Triangles triangles, const Vec3<Length>& apex) {
  FirstMoments sums;
  for (const Triangle& triangle : triangles) {
    const auto corner = corners_of(vertices, triangle, apex);
    const Int128 volume = six_volumes(corner);
    sums.volume_6 = sums.volume_6 + volume;
    for (int axis = 0; axis < 3; ++axis) {
      Int192& moment = sums.moment_24[static_cast<std::size_t>(axis)];
      moment = moment + multiply(volume, corner[0][axis] + corner[1][axis] + corner[2][axis]);
    }
  }
  return sums;
}

/// Second moments 120·∫xy about the apex, exact. |coordinates| ≤ 2^30, so that a sum of three
/// products stays below 2^62, and a volume times a sum of three coordinates below 2^124.
SymMat3<Int192> second_moments(Vertices vertices, Triangles triangles, const Vec3<Length>& apex) {
  SymMat3<Int192> sums;
  for (const Triangle& triangle : triangles) {
    const auto corner = corners_of(vertices, triangle, apex);
    const Int128 volume = six_volumes(corner);
    const RawVec total = corner[0] + corner[1] + corner[2];
    const auto product = [&](int i, int j) {
      std::int64_t squares = 0;
      for (const RawVec& c : corner)
        squares += c[i] * c[j];
      return multiply(scaled(multiply(volume, total[i]), 0), total[j]) + multiply(volume, squares);
    };
    sums = sums + SymMat3<Int192>{product(0, 0), product(1, 1), product(2, 2),
                                  product(0, 1), product(0, 2), product(1, 2)};
  }
  return sums;
}

/// Numbers to divide by the volume: sixfold volume without its last `dropped` bits, below 2^57.
struct Divisor {
  std::int64_t volume_6 = 0;
  int dropped = 0;

  explicit Divisor(const Int128& exact)
      : dropped(std::max(0, 128 - 57 - countl_zero(exact.bits()))) {
    volume_6 = static_cast<std::int64_t>((exact >> dropped).low);
  }

  /// x · 2^bits / (factor · 6·V) to nearest.
  [[nodiscard]] std::int64_t quotient(const Int192& x, int bits, int factor) const {
    return round_divide(scaled(x, bits - dropped), factor * volume_6);
  }
};

Vec3<Length> middle_of(Vertices vertices) {
  Vec3<Length> middle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto by_axis = [axis](const Vec3<Length>& a, const Vec3<Length>& b) {
      return a[axis] < b[axis];
    };
    const auto [low, high] = std::ranges::minmax_element(vertices, by_axis);
    middle[axis] = (*low)[axis] + ((*high)[axis] - (*low)[axis]) / 2;
  }
  return middle;
}

/// The greatest distance of a vertex, rounded up, raw.
std::uint64_t radius_about(Vertices vertices, const Vec3<Length>& centre) {
  UInt128 most{};
  for (const Vec3<Length>& vertex : vertices) {
    const RawVec arm = difference(vertex, centre);
    most = std::max(most, dot_wide(arm, arm).bits());
  }
  const std::uint64_t root = isqrt128(most);
  return root + (multiply_wide(root, root) < most ? 1 : 0);
}

/// 6·V in raw lengths cubed as a volume.
BlockFloat volume_of(const Int128& volume_6) {
  const int zeros = countl_zero(volume_6.bits());
  const std::uint64_t leading = (volume_6.bits() << zeros).high;
  return block_float(leading / 6, 64 - zeros - 3 * Length::frac_bits);
}

/// ∫xy / V about the centre of mass, in squares of the scale 2^scale_bits raw, 60 bits. The apex is
/// off the centre of mass by `remainder`, 31 bits.
SymMat3<std::int64_t> covariance(const SymMat3<Int192>& moments, const Divisor& divisor,
                                 const RawVec& remainder, int scale_bits) {
  const auto entry = [&](const Int192& moment, int i, int j) {
    const std::int64_t about_apex = divisor.quotient(moment, k_tensor_bits - 2 * scale_bits, 20);
    const int shift = 2 * k_remainder_bits - k_tensor_bits + 2 * scale_bits;
    return about_apex - raw::round_shift(remainder[i] * remainder[j], shift);
  };
  return {entry(moments.xx, 0, 0), entry(moments.yy, 1, 1), entry(moments.zz, 2, 2),
          entry(moments.xy, 0, 1), entry(moments.xz, 0, 2), entry(moments.yz, 1, 2)};
}

SymMat3<std::int64_t> inertia_of(const SymMat3<std::int64_t>& c) {
  return {c.yy + c.zz, c.zz + c.xx, c.xx + c.yy, -c.xy, -c.xz, -c.yz};
}

}  // namespace

std::optional<Solid> solid_of(Vertices vertices, Triangles triangles) {
  const Vec3<Length> middle = middle_of(vertices);
  const FirstMoments about_middle = first_moments(vertices, triangles, middle);
  const Divisor divisor(about_middle.volume_6);
  LKS_CHECK(divisor.volume_6 > 0);
  Solid solid;
  solid.volume = volume_of(about_middle.volume_6);
  for (int axis = 0; axis < 3; ++axis) {
    const auto& moment = about_middle.moment_24[static_cast<std::size_t>(axis)];
    const auto arm = static_cast<std::int32_t>(divisor.quotient(moment, 0, 4));
    solid.centre[axis] = middle[axis] + Length::from_raw(arm);
  }
  const std::uint64_t radius = radius_about(vertices, solid.centre);
  if (radius > static_cast<std::uint64_t>(k_max_hull_radius.raw)) return std::nullopt;
  solid.radius = Length::from_raw(static_cast<std::int32_t>(radius));
  const auto scale_bits = static_cast<int>(std::bit_width(radius - 1));
  solid.scale_exponent = scale_bits - Length::frac_bits;

  RawVec remainder;
  const FirstMoments about_centre = first_moments(vertices, triangles, solid.centre);
  for (int axis = 0; axis < 3; ++axis) {
    const auto& moment = about_centre.moment_24[static_cast<std::size_t>(axis)];
    remainder[axis] = divisor.quotient(moment, k_remainder_bits, 4);
    solid.remainder[axis] = raw::round_shift(remainder[axis], k_remainder_bits - k_fine_per_length);
  }
  const SymMat3<Int192> moments = second_moments(vertices, triangles, solid.centre);
  const PrincipalAxes principal =
      principal_axes(inertia_of(covariance(moments, divisor, remainder, scale_bits)));
  const auto& [x, y, z] = principal.moments;
  solid.inertia = {to_moment(x), to_moment(y), to_moment(z)};
  solid.set_axes(principal.axes);
  return solid;
}

}  // namespace lockstone::geometry
