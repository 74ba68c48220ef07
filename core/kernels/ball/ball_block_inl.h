// The kernels of ball_block.h for the target at hand.
#if defined(LKS_WIDE_BALL_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_BALL_BLOCK_INL_H
#undef LKS_WIDE_BALL_BLOCK_INL_H
#else
#define LKS_WIDE_BALL_BLOCK_INL_H
#endif

#include "core/kernels/ball/ball_block.h"
#include "core/kernels/contact/manifold_divide_inl.h"
#include "core/kernels/contact/manifold_prepare_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// Where one body of each joint is.
struct PlaceLanes {
  Vector position;  // m, Q32
  Vector x, y, z;   // columns of the rotation, Q30
};

HWY_INLINE HWY_ATTR void load_places(const BodyPlace* places, const std::uint32_t* index,
                                     PlaceLanes& out) {
  // Offsets of bodies count words of BodyVelocity; a BodyPlace has as many.
  static_assert(sizeof(BodyPlace) == sizeof(BodyVelocity));
  using At = RecordsAt<const std::int64_t>;
  const std::int64_t* words = places->words.data();
  Lanes word_3, word_4, word_5, word_6, word_7;
  load_two(At{words, index, 1}, out.position.x, out.position.y);
  load_two(At{words + 2, index, 1}, out.position.z, word_3);
  load_two(At{words + 4, index, 1}, word_4, word_5);
  load_two(At{words + 6, index, 1}, word_6, word_7);
  out.x = {word_3, upper(word_3), word_4};
  out.y = {upper(word_4), word_5, upper(word_5)};
  out.z = {word_6, upper(word_6), word_7};
}

/// Q50, exact, from an anchor in Q20.
HWY_INLINE HWY_ATTR Vector turned(const PlaceLanes& at, const Vector& anchor) {
  return add(add(multiply(at.x, anchor.x), multiply(at.y, anchor.y)), multiply(at.z, anchor.z));
}

/// The speed along an axis that takes B's point a quarter of the way to A's in a substep. Bodies
/// count as no farther apart than 4096 m along it, so that all sums fit Q50.
HWY_INLINE HWY_ATTR Lanes closing(Lanes apart, Lanes arms, Lanes rate) {
  constexpr std::int64_t k_far = std::int64_t{1} << 44;   // 4096 m, Q32
  constexpr std::int64_t k_wide = std::int64_t{1} << 53;  // 8 m, Q50
  constexpr std::int64_t k_fast = k_most_closing << 8;
  const Lanes centres = shift_left<18>(clamp(apart, broadcast(-k_far), broadcast(k_far)));
  const Lanes gap = clamp(add(centres, arms), broadcast(-k_wide), broadcast(k_wide));
  const Lanes speed = multiply(round_shift_low<24>(gap), rate);  // Q26
  return round_shift_low<8>(clamp(speed, broadcast(-k_fast), broadcast(k_fast)));
}

/// Whether the bodies of all lanes at hand turn alike about all axes.
HWY_INLINE HWY_ATTR bool are_plain(const BallBlock& block, std::size_t lane) {
  if constexpr (!k_tells_plain) return false;
  return !any_less(load(&block.scale[lane]), broadcast(0));
}

/// Adds α·r̄×·M·r̄×ᵀ, whose entry of axes e and f is (r̄ × e)·M·(r̄ × f), in Q(shift + 30).
template <bool plain>
HWY_INLINE HWY_ATTR void add_body(const Tensor& m, const Vector& r, Lanes share, Tensor& k) {
  Vector diagonal{}, mixed{};
  if constexpr (plain) {  // M = m·1, and products that are negated round alike
    const Vector p = round_shift_low<30>(multiply(r, m.xx));
    const Lanes x = multiply(p.x, r.x), y = multiply(p.y, r.y), z = multiply(p.z, r.z);
    diagonal = round_shift_low<30>(Vector{add(y, z), add(x, z), add(x, y)});
    mixed = round_shift_low<30>(Vector{multiply(p.x, r.y), multiply(p.x, r.z), multiply(p.y, r.z)});
    k.xy = multiply_subtract(k.xy, mixed.x, share);
    k.xz = multiply_subtract(k.xz, mixed.y, share);
    k.yz = multiply_subtract(k.yz, mixed.z, share);
  } else {
    const auto [x, y, z] = turned_by_axes(m, r);
    diagonal =
        round_shift_low<30>(Vector{difference(x.y, r.z, x.z, r.y), difference(y.z, r.x, y.x, r.z),
                                   difference(z.x, r.y, z.y, r.x)});
    mixed =
        round_shift_low<30>(Vector{difference(y.y, r.z, y.z, r.y), difference(z.y, r.z, z.z, r.y),
                                   difference(z.z, r.x, z.x, r.z)});
    k.xy = multiply_add(k.xy, mixed.x, share);
    k.xz = multiply_add(k.xz, mixed.y, share);
    k.yz = multiply_add(k.yz, mixed.z, share);
  }
  k.xx = multiply_add(k.xx, diagonal.x, share);
  k.yy = multiply_add(k.yy, diagonal.y, share);
  k.zz = multiply_add(k.zz, diagonal.z, share);
}

/// 1/d in Q30 for a pivot in Q(shift) that is at least 1: side by side where there are lanes enough
/// and pivots as they should be, else lane by lane.
HWY_INLINE HWY_ATTR Lanes inverse_of_pivot(Lanes pivot, Lanes shift) {
  const Lanes one = power_of_two(shift), divisor = max(lower_part(pivot), one);
  if constexpr (k_lanes >= 4) {
    if (!any_less(broadcast(INT32_MAX), divisor))
      return quotient_of(divisor, shift, shift_left<30>(one));
  }
  std::int64_t words[k_lanes], shifts[k_lanes];
  store(divisor, words);
  store(shift, shifts);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    const int exponent = static_cast<int>(shifts[lane]) + 30;
    words[lane] = bounded_quotient(exponent, words[lane], k_one);
  }
  return load(words);
}

/// K⁻¹ in Q30 from K in Q(shift), by L·D·Lᵀ. Since K ≥ 1, so are the pivots.
HWY_INLINE HWY_ATTR Tensor inverse_of(const Tensor& k, const EachShift& by) {
  const Lanes none = broadcast(0);
  const Lanes i_1 = inverse_of_pivot(k.xx, by.shift);
  const Lanes l_21 = round_shift_low<30>(multiply(k.xy, i_1));
  const Lanes l_31 = round_shift_low<30>(multiply(k.xz, i_1));
  const Lanes i_2 = inverse_of_pivot(subtract(k.yy, by.round(multiply(l_21, k.xy))), by.shift);
  const Lanes below = subtract(k.yz, by.round(multiply(l_21, k.xz)));
  const Lanes l_32 = round_shift_low<30>(multiply(below, i_2));
  const Lanes i_3 = inverse_of_pivot(
      subtract(k.zz, add(by.round(multiply(l_31, k.xz)), by.round(multiply(l_32, below)))),
      by.shift);
  const Lanes m_31 = subtract(by.round(multiply(l_32, l_21)), l_31);  // of L⁻¹
  Tensor m{};
  m.zz = i_3;
  m.yz = subtract(none, by.round(multiply(l_32, i_3)));
  m.xz = by.round(multiply(m_31, i_3));
  m.yy = subtract(i_2, by.round(multiply(l_32, m.yz)));
  const Lanes first = by.round(multiply(l_21, i_2));
  m.xy = subtract(by.round(multiply(m_31, m.yz)), first);
  m.xx = add(i_1, add(by.round(multiply(l_21, first)), by.round(multiply(m_31, m.xz))));
  return m;
}

/// Data of a joint that depends on the bodies' places: M of each body, and the arms.
struct Setup {
  Tensor inertia_a, inertia_b;
  Vector arm_a, arm_b, gain_a, gain_b;
};

HWY_INLINE HWY_ATTR Vector normalised(const Vector& arm, Lanes shift) {
  return each_shift(shift).round(arm);
}

HWY_INLINE HWY_ATTR void find_arms(BallBlock& block, std::size_t lane, const BodyPlace* places,
                                   Lanes share_a, Lanes share_b, std::int32_t substep_rate,
                                   Setup& out) {
  PlaceLanes a{}, b{};
  load_places(places, &block.body_a[lane], a);
  load_places(places, &block.body_b[lane], b);
  const Vector anchor = load_vector(block.anchor, lane);
  const Lanes scale = load(&block.scale[lane]), rate = broadcast(substep_rate);
  const Vector arm_a = turned(a, anchor), arm_b = turned(b, upper(anchor));
  const Vector apart = subtract(b.position, a.position), arms = subtract(arm_b, arm_a);
  store(pack(closing(apart.x, arms.x, rate), closing(apart.y, arms.y, rate)), &block.bias[0][lane]);
  store(lower_part(closing(apart.z, arms.z, rate)), &block.bias[1][lane]);
  out.arm_a = normalised(arm_a, lower_part(scale));
  out.arm_b = normalised(arm_b, low_byte(upper_part(scale)));
  out.gain_a = round_shift_low<30>(multiply(out.arm_a, share_a));
  out.gain_b = round_shift_low<30>(multiply(out.arm_b, share_b));
}

HWY_INLINE HWY_ATTR void store_inertias(const Tensor& a, const Tensor& b, std::size_t lane,
                                        BallBlock& block) {
  store(pack(a.xx, b.xx), &block.inertia[0][lane]);
  store(pack(a.yy, b.yy), &block.inertia[1][lane]);
  store(pack(a.zz, b.zz), &block.inertia[2][lane]);
  store(pack(a.xy, b.xy), &block.inertia[3][lane]);
  store(pack(a.xz, b.xz), &block.inertia[4][lane]);
  store(pack(a.yz, b.yz), &block.inertia[5][lane]);
}

HWY_INLINE HWY_ATTR void store_setup(const Setup& in, const Tensor& mass, std::size_t lane,
                                     BallBlock& block) {
  store_vector(pack(in.arm_a, in.arm_b), block.arm, lane);
  store_vector(pack(in.gain_a, in.gain_b), block.gain_arm, lane);
  store(pack(mass.xx, mass.yy), &block.mass[0][lane]);
  store(pack(mass.zz, mass.xy), &block.mass[1][lane]);
  store(pack(mass.xz, mass.yz), &block.mass[2][lane]);
}

/// M of both bodies in the pair's format. That of plain lanes stays as it is in a tick.
template <bool plain, bool again>
HWY_INLINE HWY_ATTR void place_inertias(BallBlock& block, std::size_t lane,
                                        const BodyInertia* inertias, Setup& setup) {
  if constexpr (plain && again) {
    const Lanes moments = load(&block.inertia[0][lane]), none = broadcast(0);
    setup.inertia_a = {moments, moments, moments, none, none, none};
    const Lanes of_b = upper(moments);
    setup.inertia_b = {of_b, of_b, of_b, none, none, none};
    return;
  }
  const Lanes factor = load(&block.factor[lane]);
  setup.inertia_a = load_tensor<plain>(inertias, &block.body_a[lane], factor);
  setup.inertia_b = load_tensor<plain>(inertias, &block.body_b[lane], upper(factor));
  store_inertias(setup.inertia_a, setup.inertia_b, lane, block);
}

/// Everything that depends on where the bodies are; `again` after they have moved.
template <bool plain, bool again>
HWY_INLINE HWY_ATTR void place_lanes(BallBlock& block, std::size_t lane, const BodyPlace* places,
                                     const BodyInertia* inertias, std::int32_t substep_rate,
                                     Setup& setup) {
  const Lanes share = load(&block.share[lane]);
  const Lanes share_b = share, share_a = subtract(broadcast(k_one), share);
  const EachShift by = each_shift(upper_part(share));
  find_arms(block, lane, places, share_a, share_b, substep_rate, setup);
  place_inertias<plain, again>(block, lane, inertias, setup);
  const Lanes none = broadcast(0), one = power_of_two(by.shift);
  Tensor k{none, none, none, none, none, none};
  add_body<plain>(setup.inertia_a, setup.arm_a, share_a, k);
  add_body<plain>(setup.inertia_b, setup.arm_b, share_b, k);
  k = {add(round_shift_low<30>(k.xx), one), add(round_shift_low<30>(k.yy), one),
       add(round_shift_low<30>(k.zz), one), round_shift_low<30>(k.xy),
       round_shift_low<30>(k.xz),           round_shift_low<30>(k.yz)};
  store_setup(setup, inverse_of(k, by), lane, block);
}

HWY_INLINE HWY_ATTR Vector load_impulse(const BlockWord (&words)[2], std::size_t lane) {
  const Lanes word = load(&words[0][lane]);
  return {word, upper(word), load(&words[1][lane])};
}
HWY_INLINE HWY_ATTR void store_impulse(const Vector& p, BlockWord (&words)[2], std::size_t lane) {
  store(pack(p.x, p.y), &words[0][lane]);
  store(p.z, &words[1][lane]);
}

/// Both bodies of each joint.
struct BallPair : BodyPair {
  /// Bodies of equal mass gain and lose exactly the same velocity.
  HWY_INLINE HWY_ATTR void push(const Vector& impulse, Lanes share_b, const Vector& gain_a,
                                const Vector& gain_b) {
    constexpr int k_below_grid = k_velocity_bits - k_grid_bits;
    const Vector to_b = round_to_multiple<k_below_grid>(multiply(impulse, share_b));
    add_to(b.velocity, to_b);
    take_from(a.velocity, subtract(multiply(impulse, broadcast(k_one)), to_b));
    add_to(b.spin, round_to_multiple<k_below_grid>(cross(gain_b, impulse)));
    take_from(a.spin, round_to_multiple<k_below_grid>(cross(gain_a, impulse)));
  }
};

template <bool plain>
HWY_INLINE HWY_ATTR void begin_ball_lanes(BallBlock& block, std::size_t lane,
                                          const BodyPlace* places, const BodyInertia* inertias,
                                          std::int64_t* warm, std::int32_t substep_rate) {
  Setup setup{};
  place_lanes<plain, false>(block, lane, places, inertias, substep_rate, setup);
  const Lanes none = broadcast(0);
  BallPair bodies{};
  bodies.load_from(warm, block, lane);
  bodies.push(load_impulse(block.impulse, lane), load(&block.share[lane]), setup.gain_a,
              setup.gain_b);
  bodies.store_to(warm, block, lane);
  store_impulse({none, none, none}, block.position_impulse, lane);
}

HWY_ATTR inline void begin_balls(BallBlock* blocks, std::size_t count, const BodyPlace* places,
                                 const BodyInertia* inertias, BodyVelocity* warm,
                                 std::int32_t substep_rate) {
  std::int64_t* words = warm->velocity.data();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      if (are_plain(blocks[i], lane)) {
        begin_ball_lanes<true>(blocks[i], lane, places, inertias, words, substep_rate);
      } else {
        begin_ball_lanes<false>(blocks[i], lane, places, inertias, words, substep_rate);
      }
    }
  }
}

/// M·spin of both bodies, before rounding.
template <bool plain>
HWY_INLINE HWY_ATTR void turn_both(const BallBlock& block, std::size_t lane, Vector& a, Vector& b) {
  if constexpr (plain) {
    a = multiply(a, load(&block.inertia[0][lane]));
    b = multiply(b, load_upper(&block.inertia[0][lane]));
  } else {
    const TensorPair inertia = load_tensors(block.inertia[0], block.inertia + 1, lane);
    a = inertia.a.times(a);
    b = inertia.b.times(b);
  }
}

/// u in Q20.
template <bool plain>
HWY_INLINE HWY_ATTR Vector speed_of(const BallBlock& block, std::size_t lane, const EachShift& by,
                                    const BallPair& bodies) {
  Vector a = spin_of(bodies.a), b = spin_of(bodies.b);
  turn_both<plain>(block, lane, a, b);
  const Vector arm = load_vector(block.arm, lane);
  const Vector around = subtract(cross(by.round(b), upper(arm)), cross(by.round(a), arm));
  return round_shift_low<30>(add(bodies.apart(), around));
}

/// The impulse less K⁻¹·u, within its bounds: as whole words.
HWY_INLINE HWY_ATTR Vector next_impulse(const BallBlock& block, std::size_t lane, const Vector& old,
                                        const Vector& u) {
  const Lanes m_0 = load(&block.mass[0][lane]), m_1 = load(&block.mass[1][lane]);
  const Lanes m_2 = load(&block.mass[2][lane]);
  const Tensor mass{m_0, upper(m_0), m_1, upper(m_1), m_2, upper(m_2)};
  const Vector change = round_shift_low<30>(mass.times(u));
  const Lanes one = broadcast(1);
  const Vector next = subtract(multiply(old, one), multiply(change, one));
  const Lanes most = broadcast(k_most_impulse), least = broadcast(-k_most_impulse);
  return {clamp(next.x, least, most), clamp(next.y, least, most), clamp(next.z, least, most)};
}

/// One step of either iteration: `total` are the impulses that it adds to.
template <bool plain>
HWY_INLINE HWY_ATTR void solve_lanes(const BallBlock& block, std::size_t lane, const Vector& bias,
                                     BallPair& bodies, BlockWord (&total)[2]) {
  const Lanes share = load(&block.share[lane]);
  const EachShift by = each_shift(upper_part(share));
  const Vector u = add(speed_of<plain>(block, lane, by, bodies), bias);
  const Vector old = load_impulse(total, lane);
  const Vector next = next_impulse(block, lane, old, u);
  const Vector gain = load_vector(block.gain_arm, lane);
  bodies.push(subtract(next, old), share, gain, upper(gain));
  store_impulse(next, total, lane);
}

HWY_ATTR inline void solve_ball_positions(BodyVelocity* bodies, BallBlock* blocks,
                                          std::size_t count) {
  std::int64_t* words = bodies->velocity.data();
  for (std::size_t i = 0; i < count; ++i) {
    BallBlock& block = blocks[i];
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Vector bias = load_impulse(block.bias, lane);
      BallPair pair{};
      pair.load_from(words, block, lane);
      if (are_plain(block, lane)) {
        solve_lanes<true>(block, lane, bias, pair, block.position_impulse);
      } else {
        solve_lanes<false>(block, lane, bias, pair, block.position_impulse);
      }
      pair.store_to(words, block, lane);
    }
  }
}

/// Keeps seven eighths of the impulses, along the new arms: `before` gains the velocities that the
/// next substep must not repeat.
HWY_INLINE HWY_ATTR void renew_impulses(BallBlock& block, std::size_t lane, const Vector& old,
                                        const Setup& setup, std::int64_t* before) {
  const Lanes none = broadcast(0), share = load(&block.share[lane]);
  const Vector impulse = load_impulse(block.impulse, lane);
  const Vector kept = round_shift_low<3>(multiply(impulse, broadcast(7)));
  BallPair pair{};
  pair.load_from(before, block, lane);
  pair.push(impulse, share, old, upper(old));
  pair.push(subtract(Vector{none, none, none}, kept), share, setup.gain_a, setup.gain_b);
  pair.store_to(before, block, lane);
  store_impulse(kept, block.impulse, lane);
}

template <bool plain>
HWY_INLINE HWY_ATTR void update_ball_lanes(BallBlock& block, std::size_t lane,
                                           const BodyPlace* places, const BodyInertia* inertias,
                                           std::int64_t* words, std::int64_t* before,
                                           std::int32_t substep_rate) {
  const Lanes none = broadcast(0);
  const Vector old = load_vector(block.gain_arm, lane);
  Setup setup{};
  place_lanes<plain, true>(block, lane, places, inertias, substep_rate, setup);
  renew_impulses(block, lane, old, setup, before);
  BallPair pair{};
  pair.load_from(words, block, lane);
  const Vector position_impulse = load_impulse(block.position_impulse, lane);
  pair.push(subtract(Vector{none, none, none}, position_impulse), load(&block.share[lane]), old,
            upper(old));
  store_impulse({none, none, none}, block.position_impulse, lane);
  solve_lanes<plain>(block, lane, {none, none, none}, pair, block.impulse);
  pair.store_to(words, block, lane);
}

HWY_ATTR inline void update_balls(BodyVelocity* bodies, BodyVelocity* before, BallBlock* blocks,
                                  std::size_t count, const BodyPlace* places,
                                  const BodyInertia* inertias, std::int32_t substep_rate) {
  std::int64_t* words = bodies->velocity.data();
  std::int64_t* start = before->velocity.data();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      if (are_plain(blocks[i], lane)) {
        update_ball_lanes<true>(blocks[i], lane, places, inertias, words, start, substep_rate);
      } else {
        update_ball_lanes<false>(blocks[i], lane, places, inertias, words, start, substep_rate);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
