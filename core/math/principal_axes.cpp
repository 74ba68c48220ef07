#include "core/math/principal_axes.h"

#include <algorithm>
#include <array>

#include "core/math/divide.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr int k_bits = 62;                                    // of sines, cosines and axes
constexpr int k_most_sweeps = 12;                             // four suffice as a rule
constexpr std::int64_t k_negligible = std::int64_t{1} << 20;  // 2^-40

using Index = std::size_t;
using Raw3 = std::array<std::int64_t, 3>;

/// a · b · 2^-62.
std::int64_t product(std::int64_t a, std::int64_t b) {
  return saturated_product(a, b, k_bits);
}

struct Jacobi {
  std::array<Raw3, 3> tensor{};
  std::array<Raw3, 3> axes{};  // columns

  [[nodiscard]] bool is_settled(Index p, Index q) const {
    const std::int64_t mixed = std::abs(tensor[p][q]);
    const std::int64_t gap = std::abs(tensor[p][p] - tensor[q][q]);
    const std::int64_t least = std::min(tensor[p][p], tensor[q][q]);
    return mixed <= k_negligible || (mixed <= least >> 22 && gap <= least >> 18);
  }

  /// Turns the axes p and q by the angle, at most 45 degrees, that makes entry (p, q) vanish.
  void turn(Index p, Index q) {
    const Index r = 3 - p - q;
    const std::int64_t mixed = tensor[p][q];
    const std::int64_t gap = tensor[q][q] - tensor[p][p];
    const auto hypotenuse = static_cast<std::int64_t>(norm(gap, 2 * mixed, 0));
    const std::int64_t size = divide_raw_saturating(2 * mixed, std::abs(gap) + hypotenuse, k_bits);
    const std::int64_t tangent = gap < 0 ? -size : size;
    const UInt128 one{std::uint64_t{1} << (2 * k_bits - 64), 0};
    const std::uint64_t secant = isqrt128(one + multiply_wide(tangent, tangent).bits());
    const auto cosine = static_cast<std::int64_t>(round_divide(one, secant));
    const std::int64_t sine = product(tangent, cosine);
    const auto mix = [cosine, sine](std::int64_t& a, std::int64_t& b) {
      const std::int64_t turned = product(cosine, a) - product(sine, b);
      b = product(sine, a) + product(cosine, b);
      a = turned;
    };
    tensor[p][p] -= product(tangent, mixed);
    tensor[q][q] += product(tangent, mixed);
    tensor[p][q] = tensor[q][p] = 0;
    mix(tensor[r][p], tensor[r][q]);
    tensor[p][r] = tensor[r][p];
    tensor[q][r] = tensor[r][q];
    for (Index row = 0; row < 3; ++row)
      mix(axes[p][row], axes[q][row]);
  }

  /// Whether anything was turned.
  bool sweep() {
    bool turned = false;
    for (const auto& [p, q] : {std::array<Index, 2>{0, 1}, {0, 2}, {1, 2}}) {
      if (is_settled(p, q)) continue;
      turn(p, q);
      turned = true;
    }
    return turned;
  }
};

/// The quaternion of a rotation matrix, w ≥ 0. S. W. Shepperd, Quaternion from rotation matrix:
/// the four products with the greatest component, then brought to norm 1.
Quat rotation_of(const std::array<Raw3, 3>& columns) {
  const auto entry = [&columns](Index row, Index column) {
    return raw::round_shift(columns[column][row], 30);  // 32 bits
  };
  constexpr std::int64_t one = std::int64_t{1} << 32;
  const std::int64_t xx = entry(0, 0), yy = entry(1, 1), zz = entry(2, 2);
  const std::int64_t wx = entry(2, 1) - entry(1, 2), wy = entry(0, 2) - entry(2, 0);
  const std::int64_t wz = entry(1, 0) - entry(0, 1), xy = entry(0, 1) + entry(1, 0);
  const std::int64_t zx = entry(0, 2) + entry(2, 0), yz = entry(1, 2) + entry(2, 1);
  const std::int64_t trace = xx + yy + zz;
  std::array<std::int64_t, 4> q{wx, wy, wz, one + trace};
  if (xx > std::max({yy, zz, trace})) {
    q = {one + xx - yy - zz, xy, zx, wx};
  } else if (yy > std::max(zz, trace)) {
    q = {xy, one + yy - zz - xx, yz, wy};
  } else if (zz > trace) {
    q = {zx, yz, one + zz - xx - yy, wz};
  }
  const int sign = q[3] < 0 ? -1 : 1;
  const auto component = [&q, sign](Index i) {  // a quarter, 30 bits
    return Unit::from_raw(raw::saturate<std::int32_t>(raw::round_shift(sign * q[i], 4)));
  };
  return normalized({component(0), component(1), component(2), component(3)});
}

}  // namespace

PrincipalAxes principal_axes(const SymMat3<std::int64_t>& s) {
  constexpr std::int64_t one = std::int64_t{1} << k_bits;
  Jacobi jacobi{{{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}},
                {{{one, 0, 0}, {0, one, 0}, {0, 0, one}}}};
  for (int i = 0; i < k_most_sweeps && jacobi.sweep(); ++i) {
  }
  const auto& t = jacobi.tensor;
  return {{t[0][0], t[1][1], t[2][2]}, rotation_of(jacobi.axes)};
}

}  // namespace lockstone
