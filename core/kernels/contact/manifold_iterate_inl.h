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

/// How fast points go apart at their offsets, as the tangents see the turning. A single point is
/// the centre.
template <std::size_t count>
HWY_INLINE HWY_ATTR Lanes speed_at(Lanes x, Lanes y, Lanes along, Lanes about_t, Lanes about_b) {
  if constexpr (count == 1) return round_shift_low<30>(along);
  return round_shift_low<30>(multiply_subtract(multiply_add(along, y, about_t), x, about_b));
}

/// How fast the first `count` points go apart.
template <std::size_t count>
HWY_INLINE HWY_ATTR void find_speeds(const Axes& axes, const CenterMotion& motion,
                                     PointLanes& points) {
  const Lanes along = dot(axes.n, round_shift_low<30>(motion.velocity));
  const Lanes about_t = round_shift_low<30>(dot(axes.t, motion.turning));
  const Lanes about_b = round_shift_low<30>(dot(axes.b, motion.turning));
  for (std::size_t i = 0; i < count; ++i)
    points.speed[i] = speed_at<count>(points.x[i], points.y[i], along, about_t, about_b);
}

template <std::size_t count>
HWY_INLINE HWY_ATTR void load_points(const ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                     const CenterMotion& motion, PointLanes& points) {
  const Lanes mass_01 = load(&block.mass_01[lane]);
  points.mass[0] = lower_part(mass_01);
  if constexpr (count > 1) points.mass[1] = upper_part(mass_01);
  if constexpr (count > 2) {
    const Lanes mass_23 = load(&block.mass_23[lane]);
    points.mass[2] = lower_part(mass_23);
    points.mass[3] = upper_part(mass_23);
  }
  for (std::size_t i = 0; i < count; ++i) {
    points.x[i] = load(&block.points[i].offset[lane]);
    points.y[i] = load_upper(&block.points[i].offset[lane]);
    points.start[i] = lower_part(load(&block.points[i].impulse[lane]));
    points.impulse[i] = points.start[i];
  }
  find_speeds<count>(axes, motion, points);
}

/// Whether any point of any lane is apart.
template <std::size_t count>
HWY_INLINE HWY_ATTR bool find_gaps(const ManifoldBlock& block, std::size_t lane,
                                   const SolverParams& rules, PointLanes& points) {
  for (std::size_t i = 0; i < count; ++i)
    points.gap[i] = load(&block.points[i].separation[lane]);
  points.widest = points.gap[0];
  for (std::size_t i = 1; i < count; ++i)
    points.widest = max(points.widest, points.gap[i]);
  return any_less(touching_word(rules), points.widest);
}

/// The bias speeds by separation. A point that is apart may close its gap in a substep, no more;
/// else, when `soft`, the spring pulls towards its rest, at most at the speed of pushing out.
template <std::size_t count, bool soft, bool apart>
HWY_INLINE HWY_ATTR void load_biases(const ManifoldBlock& block, std::size_t lane,
                                     const SolverParams& rules, PointLanes& points) {
  constexpr std::int64_t k_fastest = std::int64_t{1} << 34;  // 1024 m/s, Q24
  for (std::size_t i = 0; i < count; ++i) {
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

template <std::size_t count>
HWY_INLINE HWY_ATTR void load_responses(const ManifoldBlock& block, std::size_t lane,
                                        Responses& r) {
  if constexpr (count == 1) return;
  r.of[0][1] = r.of[1][0] = load(&block.response_01_23[lane]);
  if constexpr (count == 2) return;
  r.of[2][3] = r.of[3][2] = load_upper(&block.response_01_23[lane]);
  r.of[0][2] = r.of[2][0] = load(&block.response_02_13[lane]);
  r.of[1][3] = r.of[3][1] = load_upper(&block.response_02_13[lane]);
  r.of[0][3] = r.of[3][0] = load(&block.response_03_12[lane]);
  r.of[1][2] = r.of[2][1] = load_upper(&block.response_03_12[lane]);
}

/// The points in turn; each tells those after it.
template <std::size_t count, class Row>
HWY_INLINE HWY_ATTR void solve_points(const Responses& r, const EachShift& by, const Row& row,
                                      PointLanes& points) {
  for (std::size_t i = 0; i < count; ++i) {
    const Lanes error = add(points.speed[i], points.bias[i]);
    const Lanes next = row.next(points, i, multiply(points.mass[i], error), points.gap[i]);
    const Lanes moved = subtract(next, points.impulse[i]);
    points.impulse[i] = next;
    for (std::size_t j = i + 1; j < count; ++j)
      points.speed[j] = add(points.speed[j], by.round(multiply(r.of[j][i], moved)));
  }
}

/// Changes of the normal impulses as one at the centre: (1, x, y)·ΔP.
template <std::size_t count>
HWY_INLINE HWY_ATTR Impulse sum_of(const PointLanes& points) {
  const Lanes none = broadcast(0);
  if constexpr (count == 1) {
    const Lanes moved = saturate(subtract(points.impulse[0], points.start[0]));
    return {moved, none, none, none, none, none};
  }
  Lanes push = none, x = none, y = none;
  for (std::size_t i = 0; i < count; ++i) {
    const Lanes moved = subtract(points.impulse[i], points.start[i]);
    push = add(push, moved);
    x = multiply_add(x, points.x[i], moved);
    y = multiply_add(y, points.y[i], moved);
  }
  const Lanes about_b = subtract(none, x);
  return {saturate(push), none, none, none, round_shift_low<30>(y), round_shift_low<30>(about_b)};
}

template <std::size_t count>
HWY_INLINE HWY_ATTR void store_points(const PointLanes& points, std::size_t lane,
                                      ManifoldBlock& block) {
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t* word = &block.points[i].impulse[lane];
    const Lanes greatest = max(upper_part(load(word)), points.impulse[i]);
    store(add(points.impulse[i], shift_left<32>(greatest)), word);
  }
}

template <std::size_t count, class Row>
HWY_INLINE HWY_ATTR void solve_rows(const ManifoldBlock& block, std::size_t lane,
                                    const EachShift& by, const Row& row, PointLanes& points) {
  Responses responses{};
  load_responses<count>(block, lane, responses);
  solve_points<count>(responses, by, row, points);
}

/// Most blocks have no point that is apart, and skip the work for such points.
template <std::size_t count, bool soft, bool apart>
HWY_INLINE HWY_ATTR void solve_biased(const ManifoldBlock& block, std::size_t lane,
                                      const EachShift& by, const SolverParams& rules,
                                      PointLanes& points) {
  load_biases<count, soft, apart>(block, lane, rules, points);
  if constexpr (soft) {
    const SoftRow<apart> row = {load_upper(&block.soft[lane]), touching_word(rules)};
    solve_rows<count>(block, lane, by, row, points);
  } else {
    solve_rows<count>(block, lane, by, HardRow{}, points);
  }
}

template <std::size_t count, bool soft>
HWY_INLINE HWY_ATTR Impulse solve_normals(ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                          const CenterMotion& motion, const SolverParams& rules,
                                          Ahead& ahead, PointLanes& points) {
  constexpr std::size_t lines = soft ? k_normal_lines : k_friction_lines;
  load_points<count>(block, lane, axes, motion, points);
  ahead.ask(lines);
  if (find_gaps<count>(block, lane, rules, points)) {
    solve_biased<count, soft, true>(block, lane, axes.by, rules, points);
  } else {
    solve_biased<count, soft, false>(block, lane, axes.by, rules, points);
  }
  ahead.ask(lines);
  store_points<count>(points, lane, block);
  return sum_of<count>(points);
}

/// An iteration over blocks: `Work<plain>` for the lanes at hand, with the records of bodies that
/// it reads. Memory is asked for ahead.
template <template <bool> class Work, class... Words>
HWY_INLINE HWY_ATTR void iterate(ManifoldBlock* blocks, std::size_t count,
                                 const SolverParams& rules, Words*... words) {
  for (std::size_t i = 0; i < count; ++i) {
    const ManifoldBlock& next = block_at(blocks, i + 1, count);
    Ahead(&block_at(blocks, i + 2, count)).ask(1);
    Ahead ahead(&next.axes);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const std::int64_t used = used_points(blocks[i], lane);
      if (used == 0) continue;
      (ask_for_bodies(words, next, lane), ...);
      if (are_plain(blocks[i], lane)) {
        run_for_points(used, Work<true>{blocks[i], lane, words..., rules, ahead});
      } else {
        run_for_points(used, Work<false>{blocks[i], lane, words..., rules, ahead});
      }
    }
  }
}

/// Lanes of a block, and all that an iteration without friction reads of them.
template <bool plain>
struct SolveLanes {
  ManifoldBlock& block;
  std::size_t lane;
  std::int64_t* words;
  const SolverParams& rules;
  Ahead& ahead;
  static constexpr bool k_tells_two = true;

  template <std::size_t count>
  HWY_INLINE HWY_ATTR void run() const {
    BodyPair bodies{};
    bodies.load_from(words, block, lane);
    ahead.ask(k_normal_lines);
    const Axes axes = load_axes(block, lane);
    const CenterMotion motion = read_motion(BlockSides<plain>{block, lane}, axes, bodies);
    ahead.ask(k_normal_lines);
    PointLanes points{};
    const Impulse p = solve_normals<count, true>(block, lane, axes, motion, rules, ahead, points);
    apply<count != 1>(BlockSides<plain>{block, lane}, axes, p, bodies);
    ahead.ask(k_normal_lines);
    bodies.store_to(words, block, lane);
  }
};

HWY_ATTR inline void solve_manifolds(BodyVelocity* bodies, ManifoldBlock* blocks, std::size_t count,
                                     const SolverParams& rules) {
  iterate<SolveLanes>(blocks, count, rules, bodies->velocity.data());
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
