// The kernel of rotations.h for the target at hand.
#if defined(LKS_WIDE_ROTATIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_ROTATIONS_INL_H
#undef LKS_WIDE_ROTATIONS_INL_H
#else
#define LKS_WIDE_ROTATIONS_INL_H
#endif

#include "core/kernels/rotations/rotations.h"
#include "core/math/wide/lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

// A quaternion is two words, (x, y) and (z, w); the first eight entries of a matrix are four, in
// the order of its columns: (xx, xy), (xz, yx), (yy, yz), (zx, zy). The ninth is written alone.
static_assert(sizeof(Quat) == 16 && sizeof(Mat3) == 36);

struct QuatsAt {
  QuatField quats;
  const std::uint32_t* index;

  HWY_INLINE HWY_ATTR const std::int32_t* operator()(std::size_t lane) const {
    return &quats.at(index[lane])->x.raw;
  }
};

/// A matrix from its first or fifth entry on.
struct MatricesAt {
  Mat3* matrices;
  const std::uint32_t* index;
  std::size_t entry;

  HWY_INLINE HWY_ATTR std::int32_t* operator()(std::size_t lane) const {
    return &matrices[index[lane]].x.x.raw + entry;
  }
};

HWY_INLINE HWY_ATTR Lanes entry(Lanes sum) {
  return round_shift_low<29>(sum);
}  // 2·sum, Q30

/// As many rotations as there are lanes.
HWY_INLINE HWY_ATTR void rotate_lanes(const QuatField& quats, const std::uint32_t* index,
                                      Mat3* matrices) {
  Lanes x, z;
  load_two(QuatsAt{quats, index}, x, z);
  const Lanes y = upper(x), w = upper(z);
  const Lanes half = broadcast(std::int64_t{1} << 59);
  const Lanes xx = multiply(x, x), yy = multiply(y, y), zz = multiply(z, z);
  const Lanes xy = multiply(x, y), yz = multiply(y, z), zx = multiply(z, x);
  const Lanes wx = multiply(w, x), wy = multiply(w, y), wz = multiply(w, z);
  const Lanes rest = subtract(half, zz);
  const Lanes word_0 = pack(entry(subtract(rest, yy)), entry(add(xy, wz)));
  const Lanes word_1 = pack(entry(subtract(zx, wy)), entry(subtract(xy, wz)));
  const Lanes word_2 = pack(entry(subtract(rest, xx)), entry(add(yz, wx)));
  const Lanes word_3 = pack(entry(add(zx, wy)), entry(subtract(yz, wx)));
  store_two(word_0, word_1, MatricesAt{matrices, index, 0});
  store_two(word_2, word_3, MatricesAt{matrices, index, 4});
  std::int64_t last[k_lanes];
  store(entry(subtract(subtract(half, xx), yy)), last);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    matrices[index[lane]].z.z.raw = static_cast<std::int32_t>(last[lane]);
  }
}

HWY_ATTR void compute_rotations(const QuatField& quats, const std::uint32_t* indices,
                                std::size_t count, Mat3* matrices) {
  std::size_t done = 0;
  for (; done + k_lanes <= count; done += k_lanes)
    rotate_lanes(quats, indices + done, matrices);
  compute_rotations_scalar(quats, indices + done, count - done, matrices);
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
