// The preparation of manifold_block.h for the target at hand.
#if defined(LKS_WIDE_MANIFOLD_PREPARE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_PREPARE_INL_H
#undef LKS_WIDE_MANIFOLD_PREPARE_INL_H
#else
#define LKS_WIDE_MANIFOLD_PREPARE_INL_H
#endif

#include "core/math/wide/manifold_block.h"
#include "core/math/wide/manifold_motion_inl.h"
#include "core/math/wide/manifold_quotients.h"
#include "core/math/wide/manifold_response_inl.h"
#include "core/math/wide/manifold_sweep_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

inline constexpr std::int64_t k_one = std::int64_t{1} << 30;  // Q30

/// The sources of as many manifolds as there are lanes.
struct SourceLanes {
  Vector normal, friction;
  Lanes twist, load, coefficient, soft;
  Lanes one_over_count, count;
  Vector point[4];  // from the centre, on B, m, Q20
  Lanes separation[4], impulse[4];
  Tensor inertia_a, inertia_b;  // Q(shift)
  Vector arm_a, arm_b;          // r̄ of the centre, Q30
  Lanes share_a, share_b, scale_a, scale_b;
  Lanes offset_shift, shift;
  Vector rolling, drive, held;
  Lanes rolling_limit, twist_drive;
};

/// Words 0 and 1 of each lane's record, from `word` operands on: four operands.
HWY_INLINE HWY_ATTR void load_operands(const RecordsAt<const std::int32_t>& at, std::size_t word,
                                       Lanes& first, Lanes& second) {
  load_two(RecordsAt<const std::int32_t>{at.base + word, at.index, at.stride}, first, second);
}

/// The part that the operands of one body contribute: M in the pair's format.
HWY_INLINE HWY_ATTR Tensor load_tensor(const SourceBody* inertias, const std::uint32_t* index,
                                       Lanes factor) {
  // Offsets of bodies count words of RowBody; a SourceBody has as many operands.
  static_assert(sizeof(SourceBody) == 8 * sizeof(std::int32_t) && row_body_offset(1) == 8);
  const RecordsAt<const std::int32_t> at{inertias->inertia.data(), index, 1};
  Lanes xx_yy, zz_xy, xz_yz, none;
  load_operands(at, 0, xx_yy, zz_xy);
  load_operands(at, 4, xz_yz, none);
  const Vector diagonal = round_shift_low<14>(multiply(Vector{xx_yy, upper(xx_yy), zz_xy}, factor));
  const Vector mixed =
      round_shift_low<14>(multiply(Vector{upper(zz_xy), xz_yz, upper(xz_yz)}, factor));
  return {diagonal.x, diagonal.y, diagonal.z, mixed.x, mixed.y, mixed.z};
}

/// r̄ = r/s in Q30 from r in Q20; beyond ±2 it is clamped, and counted.
HWY_INLINE HWY_ATTR Lanes normalized_arm(Lanes r, Lanes inverse_scale, Lanes& clamped) {
  constexpr std::int64_t k_bound = (std::int64_t{1} << 32) - 2;
  const Lanes wide = multiply(r, inverse_scale);
  const Lanes kept = clamp(wide, broadcast(-k_bound), broadcast(k_bound));
  clamped = add(clamped, select_equal(wide, kept, broadcast(0), broadcast(1)));
  return round_shift_low<1>(kept);
}
HWY_INLINE HWY_ATTR Vector normalized_arm(const Vector& r, Lanes inverse_scale, Lanes& clamped) {
  return {normalized_arm(r.x, inverse_scale, clamped), normalized_arm(r.y, inverse_scale, clamped),
          normalized_arm(r.z, inverse_scale, clamped)};
}

/// The geometry of each lane, from a word on.
struct GeometryAt {
  const std::int32_t* const* geometry;
  std::size_t word;

  HWY_INLINE HWY_ATTR const std::int32_t* operator()(std::size_t lane) const {
    return geometry[lane] + word;
  }
};

/// Points and their centres on both bodies.
HWY_INLINE HWY_ATTR void load_source_points(const std::int32_t* const* geometry, SourceLanes& out,
                                            Vector& center_a, Vector& center_b) {
  constexpr std::int64_t k_farthest = std::int64_t{1} << 30;
  const Lanes none = broadcast(0);
  Vector sum_a = {none, none, none}, sum_b = {none, none, none};
  for (std::size_t i = 0; i < 4; ++i) {
    Lanes word_0, word_1, word_2, word_3;
    load_two(GeometryAt{geometry, 4 + 8 * i}, word_0, word_1);
    load_two(GeometryAt{geometry, 8 + 8 * i}, word_2, word_3);
    const Lanes number = broadcast(static_cast<std::int64_t>(i));
    for (Lanes* word : {&word_0, &word_1, &word_2, &word_3})
      *word = select_less(number, out.count, *word, none);
    const Vector on_a = {word_0, upper(word_0), word_1};
    out.point[i] = {upper(word_1), word_2, upper(word_2)};
    out.separation[i] =
        clamp(multiply(word_3, broadcast(1)), broadcast(-k_farthest), broadcast(k_farthest));
    sum_a = add(sum_a, multiply(on_a, out.one_over_count));
    sum_b = add(sum_b, multiply(out.point[i], out.one_over_count));
  }
  center_a = round_shift_low<30>(sum_a);
  center_b = round_shift_low<30>(sum_b);
  for (Vector& point : out.point)
    point = subtract(point, center_b);
}

/// Answers how many arms were clamped.
HWY_INLINE HWY_ATTR Lanes load_source(const ManifoldSources& in, std::size_t lane,
                                      const SourceBody* inertias, SourceLanes& out) {
  constexpr std::uint32_t k_index[] = {0, 1, 2, 3, 4, 5, 6, 7};
  const RecordsAt<const std::int32_t> at{in.lanes[lane].friction.data(), k_index,
                                         sizeof(ManifoldSource) / sizeof(std::int32_t)};
  Lanes word_0, word_1;
  load_two(GeometryAt{&in.geometry[lane], 0}, word_0, word_1);
  out.normal = {word_0, upper(word_0), word_1};
  out.normal = multiply(out.normal, broadcast(1));  // as whole words
  load_operands(at, 0, word_0, word_1);
  out.friction = {word_0, upper(word_0), word_1};
  out.twist = upper(word_1);
  load_operands(at, 4, word_0, word_1);
  out.impulse[0] = lower_part(word_0);
  out.impulse[1] = upper_part(word_0);
  out.impulse[2] = lower_part(word_1);
  out.impulse[3] = upper_part(word_1);
  load_operands(at, 8, word_0, word_1);
  out.share_b = word_0;
  out.share_a = subtract(broadcast(k_one), word_0);
  out.coefficient = upper(word_0);
  out.scale_a = word_1;
  out.scale_b = upper(word_1);
  load_operands(at, 12, out.soft, word_1);
  out.load = word_1;
  out.count = upper_part(word_1);
  load_operands(at, 20, word_0, out.one_over_count);
  out.offset_shift = lower_part(word_0);
  out.shift = upper_part(word_0);
  Vector center_a{}, center_b{};
  load_source_points(&in.geometry[lane], out, center_a, center_b);
  load_operands(at, 16, word_0, word_1);
  out.inertia_a = load_tensor(inertias, &in.body_a[lane], word_0);
  out.inertia_b = load_tensor(inertias, &in.body_b[lane], upper(word_0));
  Lanes clamped = broadcast(0);
  out.arm_a = normalized_arm(center_a, word_1, clamped);
  out.arm_b = normalized_arm(center_b, upper(word_1), clamped);
  load_operands(at, 24, word_0, word_1);
  out.rolling = {word_0, upper(word_0), word_1};
  out.rolling_limit = upper_part(word_1);
  load_operands(at, 28, word_0, word_1);
  out.drive = {word_0, upper(word_0), word_1};
  out.twist_drive = upper(word_1);
  load_operands(at, 32, word_0, word_1);
  out.held = {lower_part(word_0), upper_part(word_0), lower_part(word_1)};
  return clamped;
}

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

HWY_INLINE HWY_ATTR CenterResponse center_response(const SourceLanes& in, const Axes& axes) {
  CenterResponse k{};
  k.nn = k.tt = k.bb = k.tb = k.nx = k.ny = k.nw = k.tn = k.tx = k.ty = k.tw = k.bn = k.bx = k.by =
      k.bw = k.xx = k.yy = k.xy = k.xw = k.yw = k.ww = broadcast(0);
  add_response(in_axes(axes, in.inertia_a, in.arm_a, in.share_a, in.scale_a), k);
  add_response(in_axes(axes, in.inertia_b, in.arm_b, in.share_b, in.scale_b), k);
  finish(axes.by.shift, k);
  hold_axes(in.held, axes, k);
  return k;
}

/// What both bodies bring along, unchanged or times their shares.
HWY_INLINE HWY_ATTR void store_bodies_of(const SourceLanes& in, std::size_t lane, const Axes& axes,
                                         ManifoldBlock& out) {
  const Tensor& a = in.inertia_a;
  const Tensor& b = in.inertia_b;
  store(pack(a.xx, b.xx), &out.inertia[0][lane]);
  store(pack(a.yy, b.yy), &out.inertia[1][lane]);
  store(pack(a.zz, b.zz), &out.inertia[2][lane]);
  store(pack(a.xy, b.xy), &out.inertia[3][lane]);
  store(pack(a.xz, b.xz), &out.inertia[4][lane]);
  store(pack(a.yz, b.yz), &out.inertia[5][lane]);
  store_vector(pack(in.arm_a, in.arm_b), out.arm, lane);
  store_vector(pack(round_shift_low<30>(multiply(in.arm_a, in.share_a)),
                    round_shift_low<30>(multiply(in.arm_b, in.share_b))),
               out.gain_arm, lane);
  store(pack(in.scale_a, in.scale_b), &out.scale[lane]);
  store(pack(round_shift_low<30>(multiply(in.share_a, in.scale_a)),
             round_shift_low<30>(multiply(in.share_b, in.scale_b))),
        &out.gain_turn[lane]);
  store(pack(in.share_b, in.coefficient), &out.share[lane]);
  store(in.soft, &out.soft[lane]);
  store(multiply(subtract(broadcast(k_one), upper(in.soft)), in.load), &out.rest[lane]);
  store(pack(axes.n.x, axes.n.y), &out.axes[0][lane]);
  store(pack(axes.n.z, axes.t.x), &out.axes[1][lane]);
  store(pack(axes.t.y, axes.t.z), &out.axes[2][lane]);
  store(pack(axes.b.x, axes.b.y), &out.axes[3][lane]);
  store(pack(axes.b.z, axes.by.shift), &out.axes[4][lane]);
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

HWY_INLINE HWY_ATTR void find_offsets(const SourceLanes& in, const Axes& axes, Offsets& offsets) {
  // Q20 · Q30 / ℓ, to Q30.
  const Lanes shift = in.offset_shift;
  const EachShift by = each_shift(shift);
  offsets.square = broadcast(0);
  for (std::size_t i = 0; i < 4; ++i) {
    offsets.x[i] = offset_along(axes.t, in.point[i], shift, by);
    offsets.y[i] = offset_along(axes.b, in.point[i], shift, by);
    const Lanes square =
        multiply_add(multiply(offsets.x[i], offsets.x[i]), offsets.y[i], offsets.y[i]);
    const Lanes share = select_less(broadcast(static_cast<std::int64_t>(i)), in.count,
                                    in.one_over_count, broadcast(0));
    offsets.square = multiply_add(offsets.square, round_shift_low<32>(square), share);
  }
  offsets.square = round_shift_low<30>(offsets.square);
}

/// Responses of the points to each other: (1, xᵢ, yᵢ)·K·(1, xⱼ, yⱼ).
HWY_INLINE HWY_ATTR void point_responses(const CenterResponse& k, const Offsets& at, Lanes shift,
                                         Lanes (&of)[4][4]) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector own = {broadcast(k_one), at.x[i], at.y[i]};
    const Vector seen = round_shift_low<30>(Vector{
        dot({k.nn, k.nx, k.ny}, own), dot({k.nx, k.xx, k.xy}, own), dot({k.ny, k.xy, k.yy}, own)});
    for (std::size_t j = i; j < 4; ++j) {
      of[i][j] = round_shift_low<30>(dot(seen, {broadcast(k_one), at.x[j], at.y[j]}));
    }
    of[i][i] = max(lower_part(of[i][i]), power_of_two(shift));
  }
}

/// What only divisions and roots give, Q30 but for the twist's mass in Q24.
struct Quotients {
  Lanes point[4];     // 1/Aᵢᵢ; 0: no point
  Lanes all;          // 1/K_nn
  Lanes determinant;  // of the tangents' response, inverted
  Lanes radius;       // ρ, the root of the mean square of offsets
  Lanes twist;        // 1/(ρ²K_ww)
  Lanes rolling[3];   // tt, bb, tb, Q24; 0 where rolling is not resisted
};

HWY_INLINE HWY_ATTR void find_rolling_mass(const ManifoldSource* in, const CenterResponse& k,
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

/// All lanes of all quotients one by one: words go to memory once and come back once.
HWY_INLINE HWY_ATTR Quotients find_quotients(const ManifoldSource* in, const EachShift& by,
                                             const CenterResponse& k, const Offsets& at,
                                             const Lanes (&of)[4][4]) {
  std::int64_t words[8][k_lanes];
  const Lanes determinant = by.round(subtract(multiply(k.tt, k.bb), multiply(k.tb, k.tb)));
  for (std::size_t i = 0; i < 4; ++i)
    store(of[i][i], words[i]);
  store(k.nn, words[4]);
  store(max(lower_part(determinant), power_of_two(by.shift)), words[5]);
  store(at.square, words[6]);
  store(lower_part(k.ww), words[7]);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    const int shift = in[lane].shift;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_point = static_cast<std::int32_t>(i) < in[lane].count;
      words[i][lane] = is_point ? bounded_quotient(shift + 30, words[i][lane], k_one) : 0;
    }
    words[4][lane] = bounded_quotient(shift + 30, words[4][lane], k_one);
    words[5][lane] = bounded_quotient(shift + 30, words[5][lane], k_one);
    words[6][lane] = radius_of(words[6][lane]);
    words[7][lane] = twist_mass(shift, words[7][lane], words[6][lane]);
  }
  Quotients q{{load(words[0]), load(words[1]), load(words[2]), load(words[3])},
              load(words[4]),
              load(words[5]),
              load(words[6]),
              load(words[7]),
              {}};
  find_rolling_mass(in, k, q.rolling);
  return q;
}

HWY_INLINE HWY_ATTR void store_points_of(const SourceLanes& in, std::size_t lane, const Offsets& at,
                                         const Quotients& q, const Lanes (&of)[4][4],
                                         ManifoldBlock& out) {
  for (std::size_t i = 0; i < 4; ++i) {
    store(pack(at.x[i], at.y[i]), &out.points[i].offset[lane]);
    store(in.impulse[i], &out.points[i].impulse[lane]);
    store(pack(in.separation[i], in.separation[i]), &out.points[i].separation[lane]);
  }
  store(pack(q.point[0], q.point[1]), &out.mass_01[lane]);
  store(pack(q.point[2], q.point[3]), &out.mass_23[lane]);
  store(pack(of[0][0], of[1][1]), &out.response_00_11[lane]);
  store(pack(of[2][2], of[3][3]), &out.response_22_33[lane]);
  store(pack(of[0][1], of[2][3]), &out.response_01_23[lane]);
  store(pack(of[0][2], of[1][3]), &out.response_02_13[lane]);
  store(pack(of[0][3], of[1][2]), &out.response_03_12[lane]);
  // The centre is the points' mean, where all at once feel K_nn.
  const Lanes share = in.one_over_count;
  store(pack(round_shift_low<30>(multiply(q.all, share)), share), &out.common[lane]);
}

HWY_INLINE HWY_ATTR void store_friction_of(const SourceLanes& in, std::size_t lane,
                                           const Axes& axes, const CenterResponse& k,
                                           const Quotients& q, ManifoldBlock& out) {
  const EachShift& by = axes.by;
  store_vector(pack(Vector{k.tn, k.tx, k.ty}, Vector{k.bn, k.bx, k.by}), out.coupling, lane);
  store(pack(by.round(multiply(k.bb, q.determinant)), by.round(multiply(k.tt, q.determinant))),
        &out.tangent_mass[0][lane]);
  store(lower_part(subtract(broadcast(0), by.round(multiply(k.tb, q.determinant)))),
        &out.tangent_mass[1][lane]);
  const Vector twist = round_shift_low<30>(multiply(Vector{k.nw, k.xw, k.yw}, q.radius));
  const Lanes to_t = round_shift_low<30>(multiply(k.tw, q.radius));
  const Lanes to_b = round_shift_low<30>(multiply(k.bw, q.radius));
  store(pack(twist.x, twist.y), &out.twist_row[0][lane]);
  store(pack(twist.z, q.twist), &out.twist_row[1][lane]);
  store(pack(to_t, to_b), &out.twist_response[lane]);
  store(pack(round_shift_low<30>(dot(axes.t, in.friction)),
             round_shift_low<30>(dot(axes.b, in.friction))),
        &out.friction[lane]);
  store(pack(in.twist, q.radius), &out.twist[lane]);
  store(
      pack(round_shift_low<30>(dot(axes.t, in.drive)), round_shift_low<30>(dot(axes.b, in.drive))),
      &out.drive[lane]);
  store(pack(in.twist_drive, in.rolling_limit), &out.turn[lane]);
  store(pack(round_shift_low<30>(dot(axes.t, in.rolling)),
             round_shift_low<30>(dot(axes.b, in.rolling))),
        &out.rolling[lane]);
  store(pack(q.rolling[0], q.rolling[1]), &out.rolling_mass[0][lane]);
  store(lower_part(q.rolling[2]), &out.rolling_mass[1][lane]);
}

/// As `is_empty`, before the block is filled.
HWY_INLINE HWY_ATTR bool is_empty(const ManifoldSources& in, std::size_t lane) {
  if constexpr (k_lanes == k_block_lanes) return false;
  std::int32_t used = 0;
  for (std::size_t i = lane; i < lane + k_lanes; ++i)
    used |= in.lanes[i].one_over_count;
  return used == 0;
}

HWY_INLINE HWY_ATTR void leave_empty(std::size_t lane, ManifoldBlock& block,
                                     ManifoldApproach& approach) {
  store(broadcast(0), &block.common[lane]);
  store(broadcast(0), &approach.clamped[lane]);
}

/// The impulses of the tick before, added up by body; and how fast the points come in.
HWY_INLINE HWY_ATTR void start_lanes(const ManifoldBlock& block, std::size_t lane, const Axes& axes,
                                     const std::int64_t* words, std::int64_t* warm,
                                     ManifoldApproach& approach) {
  BodyPair bodies{};
  bodies.load_from(words, block, lane);
  PointLanes points{};
  load_points(block, lane, axes, read_motion(block, lane, axes, bodies), points);
  for (std::size_t i = 0; i < 4; ++i) {
    store(multiply(points.speed[i], broadcast(1)), &approach.speed[i][lane]);
    points.start[i] = broadcast(0);
  }
  Impulse p = sum_of(points);
  const Lanes friction = load(&block.friction[lane]), twist = load(&block.twist[lane]);
  p.t = friction;
  p.b = upper(friction);
  p.about_n = round_shift_low<30>(multiply(twist, upper(twist)));
  const Lanes rolling = load(&block.rolling[lane]);
  p.about_t = add(p.about_t, rolling);
  p.about_b = add(p.about_b, upper(rolling));
  bodies.load_from(warm, block, lane);
  apply(block, lane, axes, p, bodies);
  bodies.store_to(warm, block, lane);
}

HWY_ATTR inline void prepare_manifolds(const ManifoldSources& in, const SourceBody* inertias,
                                       const RowBody* bodies, RowBody* warm, ManifoldBlock& block,
                                       ManifoldApproach& approach) {
  block.body_a = in.body_a;
  block.body_b = in.body_b;
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    if (is_empty(in, lane)) {
      leave_empty(lane, block, approach);
      continue;
    }
    SourceLanes source{};
    store(load_source(in, lane, inertias, source), &approach.clamped[lane]);
    Axes axes{};
    make_axes(source.normal, source.shift, axes);
    Offsets offsets{};
    find_offsets(source, axes, offsets);
    const CenterResponse response = center_response(source, axes);
    Lanes of[4][4];
    point_responses(response, offsets, axes.by.shift, of);
    const Quotients quotients = find_quotients(&in.lanes[lane], axes.by, response, offsets, of);
    store_bodies_of(source, lane, axes, block);
    store_points_of(source, lane, offsets, quotients, of, block);
    store_friction_of(source, lane, axes, response, quotients, block);
    start_lanes(block, lane, axes, bodies->velocity.data(), warm->velocity.data(), approach);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
