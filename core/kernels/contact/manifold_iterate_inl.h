// The iteration of manifold_block.h without friction for the target at hand, and code that all
// iterations share.
#if defined(LKS_WIDE_MANIFOLD_ITERATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_ITERATE_INL_H
#undef LKS_WIDE_MANIFOLD_ITERATE_INL_H
#else
#define LKS_WIDE_MANIFOLD_ITERATE_INL_H
#endif

#include "core/kernels/contact/manifold_ahead_inl.h"
#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/contact/manifold_motion_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// The points of a manifold while they are being solved.
struct PointLanes {
  Lanes mass[4];       // Q30, clean; 0: no point
  Lanes x[4], y[4];    // Q30
  Lanes speed[4];      // v of each, operand, Q20
  Lanes bias[4];       // the speed to be added to it, operand, Q20
  Lanes gap[4];        // the word of separations: above that of `contact_slop` when apart
  Lanes widest;        // the greatest of them
  Lanes mean_part[4];  // (1 − κ)·mean impulse, Q50; 0: no point
  Lanes start[4];      // P at the beginning, clean
  Lanes impulse[4];    // P
};

/// The greatest word of a separation that counts as touching; its upper half decides.
HWY_INLINE HWY_ATTR Lanes touching_word(const SolverParams& rules) {
  return broadcast((std::int64_t{rules.contact_slop} << 32) | 0xffffffff);
}

/// How fast points go apart at their offsets.
HWY_INLINE HWY_ATTR void find_speeds(const Axes& axes, const CenterMotion& motion,
                                     PointLanes& points) {
  const Lanes along = dot(axes.n, round_shift_low<30>(motion.velocity));
  const Lanes about_t = round_shift_low<30>(dot(axes.t, motion.turning));
  const Lanes about_b = round_shift_low<30>(dot(axes.b, motion.turning));
  for (std::size_t i = 0; i < 4; ++i)
    points.speed[i] = round_shift_low<30>(
        multiply_subtract(multiply_add(along, points.y[i], about_t), points.x[i], about_b));
}

HWY_INLINE HWY_ATTR void load_points(const ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                     const CenterMotion& motion, PointLanes& points) {
  const Lanes mass_01 = load(&block.mass_01[lane]), mass_23 = load(&block.mass_23[lane]);
  points.mass[0] = lower_part(mass_01);
  points.mass[1] = upper_part(mass_01);
  points.mass[2] = lower_part(mass_23);
  points.mass[3] = upper_part(mass_23);
  for (std::size_t i = 0; i < 4; ++i) {
    points.x[i] = load(&block.points[i].offset[lane]);
    points.y[i] = load_upper(&block.points[i].offset[lane]);
    points.start[i] = lower_part(load(&block.points[i].impulse[lane]));
    points.impulse[i] = points.start[i];
  }
  find_speeds(axes, motion, points);
}

/// Whether any point of any lane is apart.
HWY_INLINE HWY_ATTR bool find_gaps(const ManifoldBlock& block, std::size_t lane,
                                   const SolverParams& rules, PointLanes& points) {
  for (std::size_t i = 0; i < 4; ++i)
    points.gap[i] = load(&block.points[i].separation[lane]);
  points.widest = max(max(points.gap[0], points.gap[1]), max(points.gap[2], points.gap[3]));
  return any_less(touching_word(rules), points.widest);
}

/// The bias speeds by separation. A point that is apart may close its gap in a substep, no more;
/// else, when `soft`, the spring pulls towards its rest, at most at the speed of pushing out.
template <bool soft, bool apart>
HWY_INLINE HWY_ATTR void load_biases(const ManifoldBlock& block, std::size_t lane,
                                     const SolverParams& rules, PointLanes& points) {
  constexpr std::int64_t k_fastest = std::int64_t{1} << 34;  // 1024 m/s, Q24
  for (std::size_t i = 0; i < 4; ++i) {
    const Lanes now = load_upper(&block.points[i].separation[lane]);
    Lanes bias = broadcast(0);
    if constexpr (soft) {
      const std::int64_t most = -(std::int64_t{rules.push_out} << 24);
      bias = round_shift_low<24>(max(
          multiply(add(now, broadcast(rules.overlap)), load(&block.soft[lane])), broadcast(most)));
      points.mean_part[i] =
          select_equal(points.mass[i], broadcast(0), broadcast(0), load(&block.mean_part[lane]));
    }
    if constexpr (apart) {
      const Lanes closing = round_shift_unsigned<4>(
          min(multiply(now, broadcast(rules.substep_rate)), broadcast(k_fastest)));
      bias = select_less(touching_word(rules), points.gap[i], closing, bias);
    }
    points.bias[i] = bias;
  }
}

/// x − y in Q(20 + bits), within ±1024 m/s, in Q20.
template <int bits>
HWY_INLINE HWY_ATTR Lanes limited_difference(Lanes x, Lanes y) {
  constexpr std::int64_t k_most = std::int64_t{1} << (30 + bits);
  const Lanes wide = subtract(multiply(x, broadcast(std::int64_t{1} << bits)), y);
  return round_shift_low<bits>(clamp(wide, broadcast(-k_most), broadcast(k_most)));
}

/// Rounds an impulse with 30 more fraction bits, and clamps it to 0 … k_most_impulse.
HWY_INLINE HWY_ATTR Lanes bounded_impulse(Lanes exact) {
  return round_shift_positive<30>(exact, k_most_impulse);
}

/// max(0, P − m·error)
struct HardRow {
  HWY_INLINE HWY_ATTR Lanes next(const PointLanes& points, std::size_t i, Lanes mass_error,
                                 Lanes) const {
    return bounded_impulse(subtract(shift_left<30>(points.impulse[i]), mass_error));
  }
};

/// max(0, κ·(P − m·error) + (1 − κ)·mean), unless `apart` and the gap is more than `touching`. The
/// impulse is 0 where a pull exceeds the point's share of the mean impulse.
template <bool apart>
struct SoftRow {
  Lanes keep, touching;

  HWY_INLINE HWY_ATTR Lanes next(const PointLanes& points, std::size_t i, Lanes mass_error,
                                 Lanes gap) const {
    constexpr std::int64_t k_most = std::int64_t{1} << 60;
    const Lanes hard = subtract(shift_left<30>(points.impulse[i]), mass_error);
    const Lanes bounded = round_shift_low<30>(clamp(hard, broadcast(-k_most), broadcast(k_most)));
    const Lanes soft = multiply_add(points.mean_part[i], keep, bounded);
    if constexpr (apart) return bounded_impulse(select_less(touching, gap, hard, soft));
    return bounded_impulse(soft);
  }
};

/// Responses of the points to each other, in Q(shift).
struct Responses {
  Lanes of[4][4];
};

HWY_INLINE HWY_ATTR void load_responses(const ManifoldBlock& block, std::size_t lane,
                                        Responses& r) {
  r.of[0][0] = load(&block.response_00_11[lane]);
  r.of[1][1] = load_upper(&block.response_00_11[lane]);
  r.of[2][2] = load(&block.response_22_33[lane]);
  r.of[3][3] = load_upper(&block.response_22_33[lane]);
  r.of[0][1] = r.of[1][0] = load(&block.response_01_23[lane]);
  r.of[2][3] = r.of[3][2] = load_upper(&block.response_01_23[lane]);
  r.of[0][2] = r.of[2][0] = load(&block.response_02_13[lane]);
  r.of[1][3] = r.of[3][1] = load_upper(&block.response_02_13[lane]);
  r.of[0][3] = r.of[3][0] = load(&block.response_03_12[lane]);
  r.of[1][2] = r.of[2][1] = load_upper(&block.response_03_12[lane]);
}

/// The points in turn; each tells those after it.
template <class Row>
HWY_INLINE HWY_ATTR void solve_points(const Responses& r, const EachShift& by, const Row& row,
                                      PointLanes& points) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Lanes error = add(points.speed[i], points.bias[i]);
    const Lanes next = row.next(points, i, multiply(points.mass[i], error), points.gap[i]);
    const Lanes moved = subtract(next, points.impulse[i]);
    points.impulse[i] = next;
    for (std::size_t j = i + 1; j < 4; ++j)
      points.speed[j] = add(points.speed[j], by.round(multiply(r.of[j][i], moved)));
  }
}

/// Changes of the normal impulses as one at the centre: (1, x, y)·ΔP.
HWY_INLINE HWY_ATTR Impulse sum_of(const PointLanes& points) {
  Lanes push = broadcast(0), x = broadcast(0), y = broadcast(0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Lanes moved = subtract(points.impulse[i], points.start[i]);
    push = add(push, moved);
    x = multiply_add(x, points.x[i], moved);
    y = multiply_add(y, points.y[i], moved);
  }
  const Lanes none = broadcast(0);
  const Lanes about_b = subtract(none, x);
  return {saturate(push), none, none, none, round_shift_low<30>(y), round_shift_low<30>(about_b)};
}

HWY_INLINE HWY_ATTR void store_points(const PointLanes& points, std::size_t lane,
                                      ManifoldBlock& block) {
  for (std::size_t i = 0; i < 4; ++i) {
    std::int64_t* word = &block.points[i].impulse[lane];
    const Lanes greatest = max(upper_part(load(word)), points.impulse[i]);
    store(add(points.impulse[i], shift_left<32>(greatest)), word);
  }
}

template <class Row>
HWY_INLINE HWY_ATTR void solve_rows(const ManifoldBlock& block, std::size_t lane,
                                    const EachShift& by, const Row& row, PointLanes& points) {
  Responses responses{};
  load_responses(block, lane, responses);
  solve_points(responses, by, row, points);
}

/// Most blocks have no point that is apart, and skip the work for such points.
template <bool soft, bool apart>
HWY_INLINE HWY_ATTR void solve_biased(const ManifoldBlock& block, std::size_t lane,
                                      const EachShift& by, const SolverParams& rules,
                                      PointLanes& points) {
  load_biases<soft, apart>(block, lane, rules, points);
  if constexpr (soft) {
    const SoftRow<apart> row = {load_upper(&block.soft[lane]), touching_word(rules)};
    solve_rows(block, lane, by, row, points);
  } else {
    solve_rows(block, lane, by, HardRow{}, points);
  }
}

template <bool soft>
HWY_INLINE HWY_ATTR Impulse solve_normals(ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                          const CenterMotion& motion, const SolverParams& rules,
                                          Ahead& ahead, PointLanes& points) {
  constexpr std::size_t lines = soft ? k_normal_lines : k_friction_lines;
  load_points(block, lane, axes, motion, points);
  ahead.ask(lines);
  if (find_gaps(block, lane, rules, points)) {
    solve_biased<soft, true>(block, lane, axes.by, rules, points);
  } else {
    solve_biased<soft, false>(block, lane, axes.by, rules, points);
  }
  ahead.ask(lines);
  store_points(points, lane, block);
  return sum_of(points);
}

template <bool plain>
HWY_INLINE HWY_ATTR void solve_lanes(ManifoldBlock& block, std::size_t lane, std::int64_t* words,
                                     const SolverParams& rules, Ahead& ahead) {
  BodyPair bodies{};
  bodies.load_from(words, block, lane);
  ahead.ask(k_normal_lines);
  const Axes axes = load_axes(block, lane);
  const CenterMotion motion = read_motion(BlockSides<plain>{block, lane}, axes, bodies);
  ahead.ask(k_normal_lines);
  PointLanes points{};
  const Impulse p = solve_normals<true>(block, lane, axes, motion, rules, ahead, points);
  apply(BlockSides<plain>{block, lane}, axes, p, bodies);
  ahead.ask(k_normal_lines);
  bodies.store_to(words, block, lane);
}

HWY_ATTR inline void solve_manifolds(BodyVelocity* bodies, ManifoldBlock* blocks, std::size_t count,
                                     const SolverParams& rules) {
  std::int64_t* words = bodies->velocity.data();
  for (std::size_t i = 0; i < count; ++i) {
    const ManifoldBlock& next = block_at(blocks, i + 1, count);
    Ahead(&block_at(blocks, i + 2, count)).ask(1);
    Ahead ahead(&next.axes);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      if (is_empty(blocks[i], lane)) continue;
      ask_for_bodies(words, next, lane);
      if (are_plain(blocks[i], lane)) {
        solve_lanes<true>(blocks[i], lane, words, rules, ahead);
      } else {
        solve_lanes<false>(blocks[i], lane, words, rules, ahead);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
