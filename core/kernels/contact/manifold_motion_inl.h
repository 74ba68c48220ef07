// The relative motion of a manifold's bodies, and its impulses on them: see manifold_block.h.
#if defined(LKS_WIDE_MANIFOLD_MOTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_MOTION_INL_H
#undef LKS_WIDE_MANIFOLD_MOTION_INL_H
#else
#define LKS_WIDE_MANIFOLD_MOTION_INL_H
#endif

#include "core/kernels/contact/body_velocities_inl.h"
#include "core/kernels/contact/manifold_block.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// A bit for each point that a lane at hand has. Where there is none, lanes can be skipped.
HWY_INLINE HWY_ATTR std::int64_t used_points(const ManifoldBlock& block, std::size_t lane) {
  std::int64_t used = 0;
  for (std::size_t i = lane; i < lane + k_lanes; ++i)
    used |= block.used[i];
  return used;
}

// Where few run it, one text serves plain manifolds and others: programs are smaller by a
// twentieth. Likewise one text serves any number of points, also where programs are downloaded.
#if defined(LKS_SCALAR_TWIN)
constexpr bool k_tells_plain = false;
constexpr bool k_tells_points = false;
#else
constexpr bool k_tells_plain = HWY_TARGET != HWY_SSE4;
constexpr bool k_tells_points = k_tells_plain && HWY_TARGET != HWY_WASM;
#endif

/// Calls `work.run<points>()` for the points of these bits: one, two where the work has a text for
/// them, or four.
template <class Work>
HWY_INLINE HWY_ATTR void run_for_points(std::int64_t used, const Work& work) {
  if constexpr (k_tells_points) {
    if (used == 1) return work.template run<1>();
    if constexpr (Work::k_tells_two)
      if (used <= 3) return work.template run<2>();
  }
  work.template run<k_block_points>();
}

/// Whether all lanes at hand are plain.
HWY_INLINE HWY_ATTR bool are_plain(const ManifoldBlock& block, std::size_t lane) {
  if constexpr (!k_tells_plain) return false;
  return !any_less(broadcast(k_special_lane - 1), upper_part(load(&block.axes[4][lane])));
}

struct Vector {
  Lanes x, y, z;
};

HWY_INLINE HWY_ATTR Lanes dot(const Vector& a, const Vector& b) {
  return multiply_add(multiply_add(multiply(a.x, b.x), a.y, b.y), a.z, b.z);
}
HWY_INLINE HWY_ATTR Vector cross(const Vector& a, const Vector& b) {
  return {multiply_subtract(multiply(a.y, b.z), a.z, b.y),
          multiply_subtract(multiply(a.z, b.x), a.x, b.z),
          multiply_subtract(multiply(a.x, b.y), a.y, b.x)};
}
HWY_INLINE HWY_ATTR Vector add(const Vector& a, const Vector& b) {
  return {add(a.x, b.x), add(a.y, b.y), add(a.z, b.z)};
}
HWY_INLINE HWY_ATTR Vector subtract(const Vector& a, const Vector& b) {
  return {subtract(a.x, b.x), subtract(a.y, b.y), subtract(a.z, b.z)};
}
HWY_INLINE HWY_ATTR Vector multiply(const Vector& a, Lanes factor) {
  return {multiply(a.x, factor), multiply(a.y, factor), multiply(a.z, factor)};
}
template <int shift>
HWY_INLINE HWY_ATTR Vector shift_left(const Vector& a) {
  return {shift_left<shift>(a.x), shift_left<shift>(a.y), shift_left<shift>(a.z)};
}
template <int shift>
HWY_INLINE HWY_ATTR Vector round_shift_low(const Vector& a) {
  return {round_shift_low<shift>(a.x), round_shift_low<shift>(a.y), round_shift_low<shift>(a.z)};
}
template <int bits>
HWY_INLINE HWY_ATTR Vector round_to_multiple(const Vector& a) {
  return {round_to_multiple<bits>(a.x), round_to_multiple<bits>(a.y), round_to_multiple<bits>(a.z)};
}
HWY_INLINE HWY_ATTR Vector upper(const Vector& a) {
  return {upper(a.x), upper(a.y), upper(a.z)};
}
HWY_INLINE HWY_ATTR Vector load_vector(const BlockWord (&words)[3], std::size_t lane) {
  return {load(&words[0][lane]), load(&words[1][lane]), load(&words[2][lane])};
}
HWY_INLINE HWY_ATTR Vector load_upper_vector(const BlockWord (&words)[3], std::size_t lane) {
  return {load_upper(&words[0][lane]), load_upper(&words[1][lane]), load_upper(&words[2][lane])};
}
HWY_INLINE HWY_ATTR Vector pack(const Vector& low, const Vector& high) {
  return {pack(low.x, high.x), pack(low.y, high.y), pack(low.z, high.z)};
}
HWY_INLINE HWY_ATTR void store_vector(const Vector& v, BlockWord (&words)[3], std::size_t lane) {
  store(v.x, &words[0][lane]);
  store(v.y, &words[1][lane]);
  store(v.z, &words[2][lane]);
}

/// Rounds by a shift of each lane's own.
struct EachShift {
  Lanes shift, half;

  HWY_INLINE HWY_ATTR Lanes round(Lanes x) const { return round_shift_low(x, shift, half); }
  HWY_INLINE HWY_ATTR Vector round(const Vector& v) const {
    return {round(v.x), round(v.y), round(v.z)};
  }
};

HWY_INLINE HWY_ATTR EachShift each_shift(Lanes shift) {
  return {shift, power_of_two(subtract(shift, broadcast(1)))};
}

/// A symmetric tensor times a vector: xx, yy, zz, xy, xz, yz.
struct Tensor {
  Lanes xx, yy, zz, xy, xz, yz;

  HWY_INLINE HWY_ATTR Vector times(const Vector& v) const {
    return {multiply_add(multiply_add(multiply(xx, v.x), xy, v.y), xz, v.z),
            multiply_add(multiply_add(multiply(xy, v.x), yy, v.y), yz, v.z),
            multiply_add(multiply_add(multiply(xz, v.x), yz, v.y), zz, v.z)};
  }
};

/// A manifold's axes in the world, Q30.
struct Axes {
  Vector n, t, b;
  EachShift by;
};

HWY_INLINE HWY_ATTR Axes load_axes(const ManifoldBlock& block, std::size_t lane) {
  const auto low = [&](std::size_t word) HWY_ATTR { return load(&block.axes[word][lane]); };
  const auto high = [&](std::size_t word) HWY_ATTR { return load_upper(&block.axes[word][lane]); };
  return {{low(0), high(0), low(1)},
          {high(1), low(2), high(2)},
          {low(3), high(3), low(4)},
          each_shift(low_byte(upper_part(low(4))))};
}

/// The tensors of both bodies, which stand side by side in six words.
struct TensorPair {
  Tensor a, b;
};

HWY_INLINE HWY_ATTR TensorPair load_tensors(const BlockWord& xx, const BlockWord* words,
                                            std::size_t lane) {
  const auto low = [&](std::size_t word) HWY_ATTR { return load(&words[word][lane]); };
  const auto high = [&](std::size_t word) HWY_ATTR { return load_upper(&words[word][lane]); };
  return {{load(&xx[lane]), low(0), low(1), low(2), low(3), low(4)},
          {load_upper(&xx[lane]), high(0), high(1), high(2), high(3), high(4)}};
}

/// Both bodies of each manifold or joint.
struct BodyPair {
  BodyLanes a, b;

  template <class Block>
  HWY_INLINE HWY_ATTR void load_from(const std::int64_t* bodies, const Block& block,
                                     std::size_t lane) {
    load_bodies(bodies, &block.body_a[lane], a);
    load_bodies(bodies, &block.body_b[lane], b);
  }
  template <class Block>
  HWY_INLINE HWY_ATTR void store_to(std::int64_t* bodies, const Block& block,
                                    std::size_t lane) const {
    store_bodies(a, bodies, &block.body_a[lane]);
    store_bodies(b, bodies, &block.body_b[lane]);
  }
  /// vB − vA
  [[nodiscard]] HWY_INLINE HWY_ATTR Vector apart() const {
    return {subtract(b.velocity[0], a.velocity[0]), subtract(b.velocity[1], a.velocity[1]),
            subtract(b.velocity[2], a.velocity[2])};
  }
};

/// As an operand, 30 bits lower.
HWY_INLINE HWY_ATTR Vector spin_of(const BodyLanes& body) {
  return round_shift_low<30>(Vector{body.spin[0], body.spin[1], body.spin[2]});
}

HWY_INLINE HWY_ATTR void add_to(Lanes (&sum)[3], const Vector& by) {
  sum[0] = add(sum[0], by.x);
  sum[1] = add(sum[1], by.y);
  sum[2] = add(sum[2], by.z);
}
HWY_INLINE HWY_ATTR void take_from(Lanes (&sum)[3], const Vector& by) {
  sum[0] = subtract(sum[0], by.x);
  sum[1] = subtract(sum[1], by.y);
  sum[2] = subtract(sum[2], by.z);
}

/// The motion of B relative to A at the centre: velocity (Q50) and turning as ℓ·ω (Q20, operands).
struct CenterMotion {
  Vector velocity;
  Vector turning;
};

/// The arms, gains and inertias of a manifold's two bodies, each read from the block when needed.
template <bool plain>
struct BlockSides {
  const ManifoldBlock& block;
  std::size_t lane;

  /// M·spin of each body, before rounding.
  HWY_INLINE HWY_ATTR Vector turned_a(const Vector& spin) const {
    if constexpr (plain) return multiply(spin, load(&block.moment[lane]));
    return load_tensors(block.moment, block.inertia, lane).a.times(spin);
  }
  HWY_INLINE HWY_ATTR Vector turned_b(const Vector& spin) const {
    if constexpr (plain) return multiply(spin, load_upper(&block.moment[lane]));
    return load_tensors(block.moment, block.inertia, lane).b.times(spin);
  }

  HWY_INLINE HWY_ATTR Vector arm_a() const { return load_vector(block.arm, lane); }
  HWY_INLINE HWY_ATTR Vector arm_b() const { return load_upper_vector(block.arm, lane); }
  HWY_INLINE HWY_ATTR Lanes scale_a() const { return load(&block.scale[lane]); }
  HWY_INLINE HWY_ATTR Lanes scale_b() const { return load_upper(&block.scale[lane]); }
  HWY_INLINE HWY_ATTR Vector gain_arm_a() const { return load_vector(block.gain_arm, lane); }
  HWY_INLINE HWY_ATTR Vector gain_arm_b() const { return load_upper_vector(block.gain_arm, lane); }
  HWY_INLINE HWY_ATTR Lanes gain_turn_a() const { return load(&block.gain_turn[lane]); }
  HWY_INLINE HWY_ATTR Lanes gain_turn_b() const { return load_upper(&block.gain_turn[lane]); }
  HWY_INLINE HWY_ATTR Lanes share_b() const { return load(&block.share[lane]); }
};

/// u = vB − vA + wB × r̄B − wA × r̄A, Ω = wB·ℓ/sB − wA·ℓ/sA, from w in Q(n), v in Q(n + 30).
template <class Sides>
HWY_INLINE HWY_ATTR CenterMotion motion_of_center(const Sides& sides, const Vector& apart,
                                                  const Vector& surface_a,
                                                  const Vector& surface_b) {
  const Vector around = subtract(cross(surface_b, sides.arm_b()), cross(surface_a, sides.arm_a()));
  const Vector turned =
      subtract(multiply(surface_b, sides.scale_b()), multiply(surface_a, sides.scale_a()));
  return {add(apart, around), round_shift_low<30>(turned)};
}

template <class Sides>
HWY_INLINE HWY_ATTR CenterMotion read_motion(const Sides& sides, const Axes& axes,
                                             const BodyPair& bodies) {
  return motion_of_center(sides, bodies.apart(), axes.by.round(sides.turned_a(spin_of(bodies.a))),
                          axes.by.round(sides.turned_b(spin_of(bodies.b))));
}

/// Six changes of impulse, operands in Q20: along n, t, b, and ℓ⁻¹ times the torques about them.
struct Impulse {
  Lanes n, t, b;
  Lanes about_n, about_t, about_b;
};

/// vB += αB·J, vA += αB·J − J, LB += (αB r̄B) × J + αB(ℓ/sB)·T, LA −= the same of A. The torques
/// are 0 unless `turns`, as those of a single point at the centre.
template <bool turns, class Sides>
HWY_INLINE HWY_ATTR void apply(const Sides& sides, const Axes& axes, const Impulse& p,
                               BodyPair& bodies) {
  constexpr int k_below_grid = k_velocity_bits - k_grid_bits;
  const Vector push = round_shift_low<30>(
      add(add(multiply(axes.n, p.n), multiply(axes.t, p.t)), multiply(axes.b, p.b)));
  const Vector to_b = round_to_multiple<k_below_grid>(multiply(push, sides.share_b()));
  const Vector to_a = subtract(multiply(push, broadcast(std::int64_t{1} << 30)), to_b);
  Vector spin_b = cross(sides.gain_arm_b(), push), spin_a = cross(sides.gain_arm_a(), push);
  if constexpr (turns) {
    const Vector torque =
        round_shift_low<30>(add(add(multiply(axes.n, p.about_n), multiply(axes.t, p.about_t)),
                                multiply(axes.b, p.about_b)));
    spin_b = add(spin_b, multiply(torque, sides.gain_turn_b()));
    spin_a = add(spin_a, multiply(torque, sides.gain_turn_a()));
  }
  add_to(bodies.b.velocity, to_b);
  add_to(bodies.b.spin, round_to_multiple<k_below_grid>(spin_b));
  take_from(bodies.a.velocity, to_a);
  take_from(bodies.a.spin, round_to_multiple<k_below_grid>(spin_a));
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
