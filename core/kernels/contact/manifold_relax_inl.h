// The iteration of manifold_block.h with friction, for the target at hand.
#if defined(LKS_WIDE_MANIFOLD_RELAX_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_RELAX_INL_H
#undef LKS_WIDE_MANIFOLD_RELAX_INL_H
#else
#define LKS_WIDE_MANIFOLD_RELAX_INL_H
#endif

#include <bit>

#include "core/kernels/contact/friction_limit.h"
#include "core/kernels/contact/manifold_iterate_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// In Q17, within ±16384 m/s.
HWY_INLINE HWY_ATTR Vector surface_travel(const BodyLanes& went) {
  return round_shift_low<15>(Vector{went.spin[0], went.spin[1], went.spin[2]});
}

/// s = s₀ + h·(sum of the points' speeds apart): the Jacobian of velocities, applied to travel. Of
/// the first `count` points.
template <std::size_t count>
HWY_INLINE HWY_ATTR void move_separations(ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                          const std::int64_t* travel, const SolverParams& rules) {
  BodyPair went{};
  went.load_from(travel, block, lane);
  const Vector apart = {subtract(went.b.velocity[0], went.a.velocity[0]),
                        subtract(went.b.velocity[1], went.a.velocity[1]),
                        subtract(went.b.velocity[2], went.a.velocity[2])};
  const CenterMotion motion = motion_of_center(BlockSides<true>{block, lane}, shift_left<15>(apart),
                                               surface_travel(went.a), surface_travel(went.b));
  const Lanes along = dot(axes.n, round_shift_low<30>(motion.velocity));
  const Lanes about_t = round_shift_low<30>(dot(axes.t, motion.turning));
  const Lanes about_b = round_shift_low<30>(dot(axes.b, motion.turning));
  const EachShift by = each_shift(broadcast(rules.step_shift));
  const Lanes step = broadcast(rules.step_mantissa);
  for (std::size_t i = 0; i < count; ++i) {
    ManifoldBlock::Point& point = block.points[i];
    const Lanes x = load(&point.offset[lane]);
    const Lanes went_apart = speed_at<count>(x, upper(x), along, about_t, about_b);
    const Lanes start = load(&point.separation[lane]);
    const Lanes now = add(start, by.round(multiply(went_apart, step)));
    store(pack(start, now), &point.separation[lane]);
  }
}

/// ΣP of the first `count` points as an operand.
template <std::size_t count>
HWY_INLINE HWY_ATTR Lanes sum_of_pushes(const PointLanes& points) {
  Lanes sum = points.impulse[0];
  for (std::size_t i = 1; i < count; ++i)
    sum = add(sum, points.impulse[i]);
  return saturate(sum);
}

/// Friction impulses along t and b and, at the radius ρ, about n: as a whole at most μ·ΣP.
struct FrictionLanes {
  Lanes t, b, twist;
};

/// Shortens friction that exceeds its limit to the limit. Few lanes do, so that one at a time is
/// fast enough; only lanes whose limit is 0 are cleared together.
HWY_INLINE HWY_ATTR void limit_friction(Lanes limit, const SolverParams& rules, FrictionLanes& f) {
  const Lanes none = broadcast(0);
  f = {select_equal(limit, none, none, f.t), select_equal(limit, none, none, f.b),
       select_equal(limit, none, none, f.twist)};
  const Lanes size = multiply_add(multiply_add(multiply(f.t, f.t), f.b, f.b), f.twist, f.twist);
  const std::uint32_t beyond = bits_of_less(multiply(limit, limit), size);
  if (beyond == 0) return;
  std::int64_t limits[k_lanes], along_t[k_lanes], along_b[k_lanes], about_n[k_lanes];
  store(limit, limits);
  store(f.t, along_t);
  store(f.b, along_b);
  store(f.twist, about_n);
  for (std::uint32_t left = beyond; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    shorten_friction(limits[lane], rules.part_dither, along_t[lane], along_b[lane], about_n[lane]);
  }
  f = {load(along_t), load(along_b), load(about_n)};
}

/// The speed about n at the radius.
template <bool plain>
HWY_INLINE HWY_ATTR Lanes twist_speed_of(const ManifoldBlock& block, std::size_t lane,
                                         const Axes& axes, const CenterMotion& motion, Lanes radius,
                                         const Vector& row, const Vector& given) {
  Lanes spin = round_shift_low<30>(dot(axes.n, motion.turning));
  if constexpr (!plain) spin = add(spin, load(&block.turn[lane]));
  return add(round_shift_low<30>(multiply(radius, spin)), axes.by.round(dot(row, given)));
}

/// The tangents as one row of two, after the twist; `pushed` is ΣP. About a single point, at the
/// radius 0, nothing resists a twist.
template <bool plain, std::size_t count>
HWY_INLINE HWY_ATTR void solve_friction(ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                        const CenterMotion& motion, Lanes pushed,
                                        const SolverParams& rules, Impulse& p) {
  const Lanes x = subtract(broadcast(0), p.about_b);
  const Vector given = {p.n, x, p.about_t};
  const Vector coupling = load_vector(block.coupling, lane);
  const Lanes twist_word = load(&block.twist[lane]), friction = load(&block.friction[lane]);
  const Lanes radius = upper(twist_word);
  const Vector u = round_shift_low<30>(motion.velocity);

  FrictionLanes f{};
  Lanes given_t, given_b;
  if constexpr (count == 1) {
    f.twist = limited_difference<24>(twist_word, broadcast(0));
    given_t = multiply(coupling.x, p.n);
    given_b = multiply(upper(coupling.x), p.n);
  } else {
    const Lanes row_0 = load(&block.twist_row[0][lane]), row_1 = load(&block.twist_row[1][lane]);
    const Lanes twist_speed = twist_speed_of<plain>(block, lane, axes, motion, radius,
                                                    {row_0, upper(row_0), row_1}, given);
    f.twist = limited_difference<24>(twist_word, multiply(upper(row_1), twist_speed));
    const Lanes response = load(&block.twist_response[lane]);
    const Lanes twist_change = subtract(f.twist, twist_word);
    given_t = multiply_add(dot(coupling, given), response, twist_change);
    given_b = multiply_add(dot(upper(coupling), given), upper(response), twist_change);
  }
  Lanes drive = broadcast(0);
  if constexpr (!plain) drive = load(&block.drive[lane]);
  const Lanes along_t =
      add(add(round_shift_low<30>(dot(axes.t, u)), drive), axes.by.round(given_t));
  const Lanes along_b =
      add(add(round_shift_low<30>(dot(axes.b, u)), upper(drive)), axes.by.round(given_b));
  const Lanes mass = load(&block.tangent_mass[0][lane]);
  const Lanes mixed = load(&block.tangent_mass[1][lane]);
  f.t = limited_difference<30>(friction, multiply_add(multiply(mass, along_t), mixed, along_b));
  f.b = limited_difference<30>(upper(friction),
                               multiply_add(multiply(upper(mass), along_b), mixed, along_t));

  const Lanes coefficient = upper(load(&block.share[lane]));
  const Lanes most = min(multiply(coefficient, pushed), broadcast(std::int64_t{1} << 60));
  limit_friction(round_shift_positive<30>(add(most, broadcast(rules.limit_dither)), 1 << 30), rules,
                 f);
  p.t = subtract(f.t, friction);
  p.b = subtract(f.b, upper(friction));
  if constexpr (count != 1)
    p.about_n = round_shift_low<30>(multiply(radius, subtract(f.twist, twist_word)));
  store(pack(f.t, f.b), &block.friction[lane]);
  store(with_upper_of(f.twist, twist_word), &block.twist[lane]);
}

/// Turning about the tangents, against a torque of at most the rolling limit times ΣP. A pass of
/// its own, for few ask for it.
HWY_INLINE HWY_ATTR void resist_rolling(ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                        Lanes pushed, const SolverParams& rules, BodyPair& bodies) {
  const Lanes none = broadcast(0);
  const Lanes factor = upper_part(load(&block.turn[lane]));
  if (!any_less(none, factor)) return;
  const Vector turning = read_motion(BlockSides<false>{block, lane}, axes, bodies).turning;
  const Lanes about_t = round_shift_low<30>(dot(axes.t, turning));
  const Lanes about_b = round_shift_low<30>(dot(axes.b, turning));
  const Lanes mass = load(&block.rolling_mass[0][lane]);
  const Lanes mixed = load(&block.rolling_mass[1][lane]);
  const Lanes rolling = load(&block.rolling[lane]);
  FrictionLanes f{};
  f.t = limited_difference<24>(rolling, multiply_add(multiply(mass, about_t), mixed, about_b));
  f.b = limited_difference<24>(upper(rolling),
                               multiply_add(multiply(upper(mass), about_b), mixed, about_t));
  f.twist = none;
  const Lanes limit = multiply(factor, pushed);
  limit_friction(round_shift_low<28>(min(limit, broadcast(std::int64_t{1} << 58))), rules, f);
  Impulse p = {none, none, none, none, none, none};
  p.about_t = subtract(f.t, rolling);
  p.about_b = subtract(f.b, upper(rolling));
  store(pack(f.t, f.b), &block.rolling[lane]);
  apply<true>(BlockSides<false>{block, lane}, axes, p, bodies);
}

/// Lanes of a block, and all that an iteration with friction reads of them.
template <bool plain>
struct RelaxLanes {
  ManifoldBlock& block;
  std::size_t lane;
  std::int64_t* words;
  const std::int64_t* travel;
  const SolverParams& rules;
  Ahead& ahead;
  static constexpr bool k_tells_two = true;

  template <std::size_t count>
  HWY_INLINE HWY_ATTR void run() const {
    BodyPair bodies{};
    bodies.load_from(words, block, lane);
    ahead.ask(k_friction_lines);
    const Axes axes = load_axes(block, lane);
    move_separations<count>(block, lane, axes, travel, rules);
    ahead.ask(k_friction_lines);
    const CenterMotion motion = read_motion(BlockSides<plain>{block, lane}, axes, bodies);
    ahead.ask(k_friction_lines);
    PointLanes points{};
    Impulse p = solve_normals<count, false>(block, lane, axes, motion, rules, ahead, points);
    const Lanes pushed = sum_of_pushes<count>(points);
    solve_friction<plain, count>(block, lane, axes, motion, pushed, rules, p);
    ahead.ask(k_friction_lines);
    apply<count != 1>(BlockSides<plain>{block, lane}, axes, p, bodies);
    ahead.ask(k_friction_lines);
    if constexpr (!plain) resist_rolling(block, lane, axes, pushed, rules, bodies);
    bodies.store_to(words, block, lane);
  }
};

HWY_ATTR inline void relax_manifolds(BodyVelocity* bodies, const DeltaPose* travel,
                                     ManifoldBlock* blocks, std::size_t count,
                                     const SolverParams& rules) {
  iterate<RelaxLanes>(blocks, count, rules, bodies->velocity.data(), travel->velocity.data());
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
