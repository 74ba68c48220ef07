// The preparation of manifold_block.h for the target at hand.
#if defined(LKS_WIDE_MANIFOLD_PREPARE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_PREPARE_INL_H
#undef LKS_WIDE_MANIFOLD_PREPARE_INL_H
#else
#define LKS_WIDE_MANIFOLD_PREPARE_INL_H
#endif

#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/contact/manifold_divide_inl.h"
#include "core/kernels/contact/manifold_input_inl.h"
#include "core/kernels/contact/manifold_iterate_inl.h"
#include "core/kernels/contact/manifold_motion_inl.h"
#include "core/kernels/contact/manifold_quotients.h"
#include "core/kernels/contact/manifold_response_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

HWY_INLINE HWY_ATTR Lanes magnitude(Lanes x) {
  return max(x, subtract(broadcast(0), x));
}

/// 1/√q for q from 0.6 to 1, both Q30: a series, then two of Newton's steps.
HWY_INLINE HWY_ATTR Lanes reciprocal_root(Lanes q) {
  const Lanes d = subtract(broadcast(k_one), q);
  Lanes r = round_shift_low<30>(multiply(d, broadcast(k_one * 5 / 16)));
  r = round_shift_low<30>(multiply(d, add(r, broadcast(k_one * 3 / 8))));
  r = round_shift_low<30>(multiply(d, add(r, broadcast(k_one / 2))));
  r = add(r, broadcast(k_one));
  for (int i = 0; i < 2; ++i) {
    const Lanes square = round_shift_low<30>(multiply(r, r));
    const Lanes miss = subtract(broadcast(k_one), round_shift_low<30>(multiply(q, square)));
    r = add(r, round_shift_low<31>(multiply(r, miss)));
  }
  return r;
}

/// Tangents of a unit normal. The first lies across the coordinate axis that the normal is farthest
/// from (x before y before z), so that mirrored normals have mirrored tangents.
HWY_INLINE HWY_ATTR void make_axes(const Vector& n, Lanes shift, Axes& axes) {
  const Lanes none = broadcast(0), one = broadcast(1);
  const Lanes x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
  const Lanes after_x = select_less(y, x, one, select_less(z, x, one, none));
  const Lanes after_y = select_less(z, y, one, none);
  const Lanes minus_x = subtract(none, n.x), minus_y = subtract(none, n.y);
  const Lanes minus_z = subtract(none, n.z);
  // Across x: (0, z, −y); across y: (−z, 0, x); across z: (y, −x, 0).
  Vector t = {select_equal(after_y, none, minus_z, n.y), select_equal(after_y, none, none, minus_x),
              select_equal(after_y, none, n.x, none)};
  t = {select_equal(after_x, none, none, t.x), select_equal(after_x, none, n.z, t.y),
       select_equal(after_x, none, minus_y, t.z)};
  const Lanes length = reciprocal_root(round_shift_low<30>(dot(t, t)));
  axes.n = n;
  axes.t = round_shift_low<30>(multiply(t, length));
  axes.b = round_shift_low<30>(cross(n, axes.t));
  axes.by = each_shift(shift);
}

template <bool plain>
HWY_INLINE HWY_ATTR CenterResponse center_response(const SourceLanes& in, const Axes& axes) {
  CenterResponse k{};
  k.nn = k.tt = k.bb = k.tb = k.nx = k.ny = k.nw = k.tn = k.tx = k.ty = k.tw = k.bn = k.bx = k.by =
      k.bw = k.xx = k.yy = k.xy = k.xw = k.yw = k.ww = broadcast(0);
  add_response(in_axes<plain>(axes, in.inertia_a, in.arm_a, in.share_a, in.scale_a), k);
  add_response(in_axes<plain>(axes, in.inertia_b, in.arm_b, in.share_b, in.scale_b), k);
  finish(axes.by.shift, k);
  if constexpr (!plain) apply_axis_locks(in.locked, axes, k);
  return k;
}

/// As `BlockSides`, for the warm start, from values that were just computed: reading them back from
/// the block would wait for the writes.
template <bool plain>
struct SourceSides {
  const SourceLanes& in;
  Vector gain_a, gain_b;
  Lanes turn_a, turn_b;

  HWY_INLINE HWY_ATTR Vector turned_a(const Vector& spin) const {
    return turned<plain>(in.inertia_a, spin);
  }
  HWY_INLINE HWY_ATTR Vector turned_b(const Vector& spin) const {
    return turned<plain>(in.inertia_b, spin);
  }
  HWY_INLINE HWY_ATTR Vector arm_a() const { return in.arm_a; }
  HWY_INLINE HWY_ATTR Vector arm_b() const { return in.arm_b; }
  HWY_INLINE HWY_ATTR Lanes scale_a() const { return in.scale_a; }
  HWY_INLINE HWY_ATTR Lanes scale_b() const { return in.scale_b; }
  HWY_INLINE HWY_ATTR Vector gain_arm_a() const { return gain_a; }
  HWY_INLINE HWY_ATTR Vector gain_arm_b() const { return gain_b; }
  HWY_INLINE HWY_ATTR Lanes gain_turn_a() const { return turn_a; }
  HWY_INLINE HWY_ATTR Lanes gain_turn_b() const { return turn_b; }
  HWY_INLINE HWY_ATTR Lanes share_b() const { return in.share_b; }
};

template <bool plain>
HWY_INLINE HWY_ATTR SourceSides<plain> sides_of(const SourceLanes& in) {
  return {in, round_shift_low<30>(multiply(in.arm_a, in.share_a)),
          round_shift_low<30>(multiply(in.arm_b, in.share_b)),
          round_shift_low<30>(multiply(in.share_a, in.scale_a)),
          round_shift_low<30>(multiply(in.share_b, in.scale_b))};
}

/// Stores the arms and other data of both bodies, as they are or times the bodies' shares.
template <bool plain>
HWY_INLINE HWY_ATTR void store_bodies_of(const SourceLanes& in, const SourceSides<plain>& sides,
                                         std::size_t lane, const Axes& axes, ManifoldBlock& out) {
  store_vector(pack(in.arm_a, in.arm_b), out.arm, lane);
  store_vector(pack(sides.gain_a, sides.gain_b), out.gain_arm, lane);
  store(pack(in.scale_a, in.scale_b), &out.scale[lane]);
  store(pack(sides.turn_a, sides.turn_b), &out.gain_turn[lane]);
  store(pack(in.share_b, in.coefficient), &out.share[lane]);
  store(in.soft, &out.soft[lane]);
  store(multiply(subtract(broadcast(k_one), upper(in.soft)), in.mean_impulse),
        &out.mean_part[lane]);
  store(pack(axes.n.x, axes.n.y), &out.axes[0][lane]);
  store(pack(axes.n.z, axes.t.x), &out.axes[1][lane]);
  store(pack(axes.t.y, axes.t.z), &out.axes[2][lane]);
  store(pack(axes.b.x, axes.b.y), &out.axes[3][lane]);
  store(pack(axes.b.z, add(axes.by.shift, in.kind)), &out.axes[4][lane]);
  const Tensor& a = in.inertia_a;
  const Tensor& b = in.inertia_b;
  store(pack(a.xx, b.xx), &out.moment[lane]);
  if constexpr (plain) return;
  store(pack(a.yy, b.yy), &out.inertia[0][lane]);
  store(pack(a.zz, b.zz), &out.inertia[1][lane]);
  store(pack(a.xy, b.xy), &out.inertia[2][lane]);
  store(pack(a.xz, b.xz), &out.inertia[3][lane]);
  store(pack(a.yz, b.yz), &out.inertia[4][lane]);
}

/// Offsets of the points, and the mean of their squares (Q28).
struct Offsets {
  Lanes x[4], y[4];
  Lanes square;
};

HWY_INLINE HWY_ATTR Lanes offset_along(const Vector& axis, const Vector& point, Lanes shift,
                                       const EachShift& by) {
  const Lanes bound = subtract(power_of_two(add(shift, broadcast(31))), power_of_two(shift));
  return by.round(clamp(dot(axis, point), subtract(broadcast(0), bound), bound));
}

template <std::size_t count>
HWY_INLINE HWY_ATTR void find_offsets(const SourceLanes& in, const SourcePoints& points,
                                      const Axes& axes, Offsets& offsets) {
  if constexpr (count == 1) {
    offsets.x[0] = offsets.y[0] = offsets.square = broadcast(0);
    return;
  }
  // Q20 · Q30 / ℓ, to Q30.
  const Lanes shift = in.offset_shift;
  const EachShift by = each_shift(shift);
  offsets.square = broadcast(0);
  for (std::size_t i = 0; i < count; ++i) {
    offsets.x[i] = offset_along(axes.t, points.from_center[i], shift, by);
    offsets.y[i] = offset_along(axes.b, points.from_center[i], shift, by);
    const Lanes square =
        multiply_add(multiply(offsets.x[i], offsets.x[i]), offsets.y[i], offsets.y[i]);
    const Lanes share = select_less(broadcast(static_cast<std::int64_t>(i)), in.count,
                                    in.one_over_count, broadcast(0));
    offsets.square = multiply_add(offsets.square, round_shift_low<32>(square), share);
  }
  offsets.square = round_shift_low<30>(offsets.square);
}

/// Responses of the points to each other: (1, xᵢ, yᵢ)·K·(1, xⱼ, yⱼ).
template <std::size_t count>
HWY_INLINE HWY_ATTR void point_responses(const CenterResponse& k, const Offsets& at, Lanes shift,
                                         Lanes (&of)[4][4]) {
  if constexpr (count == 1) {
    of[0][0] = max(lower_part(k.nn), power_of_two(shift));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vector own = {broadcast(k_one), at.x[i], at.y[i]};
    const Vector seen = round_shift_low<30>(Vector{
        dot({k.nn, k.nx, k.ny}, own), dot({k.nx, k.xx, k.xy}, own), dot({k.ny, k.xy, k.yy}, own)});
    for (std::size_t j = i; j < count; ++j) {
      of[i][j] = round_shift_low<30>(dot(seen, {broadcast(k_one), at.x[j], at.y[j]}));
    }
    of[i][i] = max(lower_part(of[i][i]), power_of_two(shift));
  }
}

/// The results of divisions and roots, Q30 but for the twist's mass in Q24.
struct Quotients {
  Lanes point[4];     // 1/Aᵢᵢ; 0: no point
  Lanes determinant;  // of the tangents' response, inverted
  Lanes radius;       // ρ, the root of the mean square of offsets
  Lanes twist;        // 1/(ρ²K_ww)
  Lanes rolling[3];   // tt, bb, tb, Q24; 0 where rolling is not resisted
};

HWY_INLINE HWY_ATTR void find_rolling_mass(const PrepareInput* in, const CenterResponse& k,
                                           Lanes (&mass)[3]) {
  bool any = false;
  for (std::size_t lane = 0; lane < k_lanes; ++lane)
    any = any || in[lane].rolling_limit > 0;
  mass[0] = mass[1] = mass[2] = broadcast(0);
  if (!any) return;
  std::int64_t words[3][k_lanes];
  store(k.xx, words[0]);
  store(k.yy, words[1]);
  store(k.xy, words[2]);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    const RollingMass m = in[lane].rolling_limit > 0 ? rolling_mass(in[lane].shift, words[0][lane],
                                                                    words[1][lane], words[2][lane])
                                                     : RollingMass{};
    words[0][lane] = m.tt;
    words[1][lane] = m.bb;
    words[2][lane] = m.tb;
  }
  for (std::size_t i = 0; i < 3; ++i)
    mass[i] = load(words[i]);
}

/// Radius and twist lane by lane: words go to memory once and come back once.
HWY_INLINE HWY_ATTR void find_twist(const PrepareInput* in, const CenterResponse& k,
                                    const Offsets& at, Quotients& q) {
  std::int64_t words[2][k_lanes];
  store(at.square, words[0]);
  store(lower_part(k.ww), words[1]);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    words[0][lane] = radius_of(words[0][lane]);
    words[1][lane] = twist_mass(in[lane].shift, words[1][lane], words[0][lane]);
  }
  q.radius = load(words[0]);
  q.twist = load(words[1]);
}

template <bool plain, std::size_t points>
HWY_INLINE HWY_ATTR Quotients find_quotients(const PrepareInput* in, Lanes count,
                                             const EachShift& by, const CenterResponse& k,
                                             const Offsets& at, const Lanes (&of)[4][4]) {
  const Lanes none = broadcast(0);
  const Lanes determinant = by.round(subtract(multiply(k.tt, k.bb), multiply(k.tb, k.tb)));
  Divisors<points + 1> d{};
  for (std::size_t i = 0; i < points; ++i)
    d.of[i] = of[i][i];
  d.of[points] = max(lower_part(determinant), power_of_two(by.shift));
  divide(in, by.shift, d);
  Quotients q{{none, none, none, none}, d.of[points], none, broadcast(INT32_MAX), {}};
  for (std::size_t i = 0; i < points; ++i)
    q.point[i] = select_less(broadcast(static_cast<std::int64_t>(i)), count, d.of[i], none);
  if constexpr (points != 1) find_twist(in, k, at, q);
  if constexpr (!plain) find_rolling_mass(in, k, q.rolling);
  return q;
}

template <std::size_t count>
HWY_INLINE HWY_ATTR void store_points_of(const SourceLanes& in, const SourcePoints& points,
                                         std::size_t lane, const Offsets& at, const Quotients& q,
                                         const Lanes (&of)[4][4], ManifoldBlock& out) {
  for (std::size_t i = 0; i < k_block_points; ++i)
    store(in.impulse[i], &out.points[i].impulse[lane]);
  for (std::size_t i = 0; i < count; ++i) {
    store(pack(at.x[i], at.y[i]), &out.points[i].offset[lane]);
    store(pack(points.separation[i], points.separation[i]), &out.points[i].separation[lane]);
  }
  store(pack(q.point[0], q.point[1]), &out.mass_01[lane]);
  store(pack(q.point[2], q.point[3]), &out.mass_23[lane]);
  store(subtract(power_of_two(in.count), broadcast(1)), &out.used[lane]);
  if constexpr (count == 1) return;
  store(pack(of[0][1], of[2][3]), &out.response_01_23[lane]);
  store(pack(of[0][2], of[1][3]), &out.response_02_13[lane]);
  store(pack(of[0][3], of[1][2]), &out.response_03_12[lane]);
}

/// Impulses along t and b, and torques about them.
struct TangentImpulses {
  Lanes t, b, about_t, about_b;
};

template <bool plain>
HWY_INLINE HWY_ATTR TangentImpulses along_tangents(const SourceLanes& in, const Axes& axes) {
  const Lanes t = round_shift_low<30>(dot(axes.t, in.friction));
  const Lanes b = round_shift_low<30>(dot(axes.b, in.friction));
  if constexpr (plain) return {t, b, broadcast(0), broadcast(0)};
  return {t, b, round_shift_low<30>(dot(axes.t, in.rolling)),
          round_shift_low<30>(dot(axes.b, in.rolling))};
}

/// The couplings and the row of the twist. A single point is the centre, about which nothing turns.
template <std::size_t count>
HWY_INLINE HWY_ATTR void store_twist_of(std::size_t lane, const CenterResponse& k,
                                        const Quotients& q, ManifoldBlock& out) {
  store(pack(k.tn, k.bn), &out.coupling[0][lane]);
  Vector twist = {q.radius, q.radius, q.radius};
  Lanes to_t = q.radius, to_b = q.radius;
  if constexpr (count != 1) {
    store(pack(k.tx, k.bx), &out.coupling[1][lane]);
    store(pack(k.ty, k.by), &out.coupling[2][lane]);
    twist = round_shift_low<30>(multiply(Vector{k.nw, k.xw, k.yw}, q.radius));
    to_t = round_shift_low<30>(multiply(k.tw, q.radius));
    to_b = round_shift_low<30>(multiply(k.bw, q.radius));
  }
  store(pack(twist.x, twist.y), &out.twist_row[0][lane]);
  store(pack(twist.z, q.twist), &out.twist_row[1][lane]);
  store(pack(to_t, to_b), &out.twist_response[lane]);
}

template <bool plain, std::size_t count>
HWY_INLINE HWY_ATTR void store_friction_of(const SourceLanes& in, std::size_t lane,
                                           const Axes& axes, const TangentImpulses& tangents,
                                           const CenterResponse& k, const Quotients& q,
                                           ManifoldBlock& out) {
  const EachShift& by = axes.by;
  store(pack(by.round(multiply(k.bb, q.determinant)), by.round(multiply(k.tt, q.determinant))),
        &out.tangent_mass[0][lane]);
  store(lower_part(subtract(broadcast(0), by.round(multiply(k.tb, q.determinant)))),
        &out.tangent_mass[1][lane]);
  store_twist_of<count>(lane, k, q, out);
  store(pack(tangents.t, tangents.b), &out.friction[lane]);
  store(pack(in.twist, q.radius), &out.twist[lane]);
  if constexpr (plain) return;
  store(
      pack(round_shift_low<30>(dot(axes.t, in.drive)), round_shift_low<30>(dot(axes.b, in.drive))),
      &out.drive[lane]);
  store(pack(in.twist_drive, in.rolling_limit), &out.turn[lane]);
  store(pack(tangents.about_t, tangents.about_b), &out.rolling[lane]);
  store(pack(q.rolling[0], q.rolling[1]), &out.rolling_mass[0][lane]);
  store(lower_part(q.rolling[2]), &out.rolling_mass[1][lane]);
}

/// As of a block, before it is filled.
HWY_INLINE HWY_ATTR std::int64_t used_points(const PrepareInputs& in, std::size_t lane) {
  std::int64_t used = 0;
  for (std::size_t i = lane; i < lane + k_lanes; ++i)
    used |= (1 << in.lanes[i].count) - 1;
  return used;
}

HWY_INLINE HWY_ATTR bool are_plain(const PrepareInputs& in, std::size_t lane) {
  if constexpr (!k_tells_plain) return false;
  std::int32_t kinds = 0;
  for (std::size_t i = lane; i < lane + k_lanes; ++i)
    kinds |= in.lanes[i].kind;
  return kinds == 0;
}

HWY_INLINE HWY_ATTR void leave_empty(std::size_t lane, ManifoldBlock& block,
                                     ManifoldApproach& approach) {
  store(broadcast(0), &block.used[lane]);
  store(broadcast(0), &approach.summary[lane]);
}

HWY_INLINE HWY_ATTR bool are_elastic(const PrepareInputs& in, std::size_t lane) {
  std::int32_t elastic = 0;
  for (std::size_t i = lane; i < lane + k_lanes; ++i)
    elastic |= in.lanes[i].is_elastic;
  return elastic != 0;
}

/// How fast the points come in, and whether they touch.
template <std::size_t count>
HWY_INLINE HWY_ATTR void store_approach(const SourceLanes& in, const SourcePoints& source,
                                        const PointLanes& points, bool elastic, std::size_t lane,
                                        ManifoldApproach& approach) {
  const Lanes none = broadcast(0), one = broadcast(1);
  Lanes least = none, nearest = one;
  for (std::size_t i = 0; i < count; ++i) {
    const Lanes number = broadcast(static_cast<std::int64_t>(i));
    const Lanes speed = multiply(points.speed[i], one);
    if (elastic) store(speed, &approach.speed[i][lane]);
    least = min(least, select_less(number, in.count, speed, none));
    nearest = min(nearest, select_less(number, in.count, source.separation[i], one));
  }
  const Lanes fastest = min(subtract(none, least), broadcast(INT32_MAX));
  const Lanes touching = select_less(nearest, one, broadcast(k_touching_lane), none);
  store(pack(fastest, add(in.clamped, touching)), &approach.summary[lane]);
}

/// The impulses of the tick before, added up by body.
template <bool plain, std::size_t count>
HWY_INLINE HWY_ATTR void start_lanes(const SourceLanes& in, const SourceSides<plain>& sides,
                                     const Axes& axes, const TangentImpulses& tangents,
                                     Lanes radius, const PointLanes& points, BodyPair& bodies) {
  Impulse p = sum_of<count>(points);
  p.t = tangents.t;
  p.b = tangents.b;
  if constexpr (count != 1) p.about_n = round_shift_low<30>(multiply(in.twist, radius));
  p.about_t = add(p.about_t, tangents.about_t);
  p.about_b = add(p.about_b, tangents.about_b);
  apply<count != 1 || !plain>(sides, axes, p, bodies);
}

/// Lanes of a block, and all that preparation reads and writes of them.
template <bool plain>
struct PrepareLanes {
  const PrepareInputs& in;
  std::size_t lane;
  const BodyInertia* inertias;
  const std::int64_t* words;
  std::int64_t* warm;
  ManifoldBlock& block;
  ManifoldApproach& approach;
  static constexpr bool k_tells_two = false;  ///< most time goes into bodies

  template <std::size_t most>
  HWY_INLINE HWY_ATTR void run() const {
    Lanes load_word, one_over_count;
    load_operands(pieces_of(&in.lanes[lane]), 12, one_over_count, load_word);
    const Lanes count = upper_part(load_word);
    load_operands(pieces_of(&in.lanes[lane]), 20, load_word, one_over_count);
    const SourcePoints source_points =
        load_source_points<most>(&in.geometry[lane], count, one_over_count);
    const SourceLanes source =
        load_source<plain>(in, lane, inertias, count, one_over_count, source_points);
    Axes axes{};
    make_axes(source.normal, source.shift, axes);
    Offsets offsets{};
    find_offsets<most>(source, source_points, axes, offsets);
    const CenterResponse response = center_response<plain>(source, axes);
    Lanes of[4][4];
    point_responses<most>(response, offsets, axes.by.shift, of);
    const Quotients quotients =
        find_quotients<plain, most>(&in.lanes[lane], count, axes.by, response, offsets, of);
    const TangentImpulses tangents = along_tangents<plain>(source, axes);
    const SourceSides<plain> sides = sides_of<plain>(source);
    PointLanes points{};
    for (std::size_t i = 0; i < most; ++i) {
      points.x[i] = offsets.x[i];
      points.y[i] = offsets.y[i];
      points.impulse[i] = source.impulse[i];
      points.start[i] = broadcast(0);
    }
    BodyPair bodies{};
    bodies.load_from(words, in, lane);
    find_speeds<most>(axes, read_motion(sides, axes, bodies), points);
    store_approach<most>(source, source_points, points, are_elastic(in, lane), lane, approach);
    bodies.load_from(warm, in, lane);
    start_lanes<plain, most>(source, sides, axes, tangents, quotients.radius, points, bodies);
    bodies.store_to(warm, in, lane);
    store_bodies_of(source, sides, lane, axes, block);
    store_points_of<most>(source, source_points, lane, offsets, quotients, of, block);
    store_friction_of<plain, most>(source, lane, axes, tangents, response, quotients, block);
  }
};

HWY_ATTR inline void prepare_manifolds(const PrepareInputs& in, const BodyInertia* inertias,
                                       const BodyVelocity* bodies, BodyVelocity* warm,
                                       ManifoldBlock& block, ManifoldApproach& approach) {
  block.body_a = in.body_a;
  block.body_b = in.body_b;
  const std::int64_t* words = bodies->velocity.data();
  std::int64_t* all = warm->velocity.data();
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    const std::int64_t used = used_points(in, lane);
    if (used == 0) {
      leave_empty(lane, block, approach);
    } else if (are_plain(in, lane)) {
      run_for_points(used, PrepareLanes<true>{in, lane, inertias, words, all, block, approach});
    } else {
      run_for_points(used, PrepareLanes<false>{in, lane, inertias, words, all, block, approach});
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
