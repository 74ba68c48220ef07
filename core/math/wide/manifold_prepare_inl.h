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

/// Points of as many manifolds as there are lanes.
struct SourcePoints {
  Vector from_center[4];  // on B, m, Q20
  Lanes separation[4];    // m, Q24
  Vector center_a, center_b;
};

/// The sources of as many manifolds.
struct SourceLanes {
  Vector normal, friction;
  Lanes twist, load, coefficient, soft;
  Lanes one_over_count, count;
  Lanes impulse[4];
  Tensor inertia_a, inertia_b;  // Q(shift)
  Vector arm_a, arm_b;          // r̄ of the centre, Q30
  Lanes share_a, share_b, scale_a, scale_b;
  Lanes offset_shift, shift;
  Vector rolling, drive, held;
  Lanes rolling_limit, twist_drive;
  Lanes clamped;  // how many arms were
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

/// A point on both bodies; of a lane that has no such point all zero.
struct SourcePoint {
  Vector on_a, on_b;
  Lanes separation;
};

HWY_INLINE HWY_ATTR SourcePoint load_point(const std::int32_t* const* geometry, std::size_t i,
                                           Lanes count) {
  constexpr std::int64_t k_farthest = std::int64_t{1} << 30;
  Lanes word_0, word_1, word_2, word_3;
  load_two(GeometryAt{geometry, 4 + 8 * i}, word_0, word_1);
  load_two(GeometryAt{geometry, 8 + 8 * i}, word_2, word_3);
  const Lanes number = broadcast(static_cast<std::int64_t>(i)), none = broadcast(0);
  word_0 = select_less(number, count, word_0, none);
  word_1 = select_less(number, count, word_1, none);
  word_2 = select_less(number, count, word_2, none);
  word_3 = select_less(number, count, word_3, none);
  return {{word_0, upper(word_0), word_1},
          {upper(word_1), word_2, upper(word_2)},
          clamp(multiply(word_3, broadcast(1)), broadcast(-k_farthest), broadcast(k_farthest))};
}

/// The mean of the points that there are.
HWY_INLINE HWY_ATTR Vector mean_of(const Vector& a, const Vector& b, const Vector& c,
                                   const Vector& d, Lanes one_over_count) {
  return round_shift_low<30>(add(add(multiply(a, one_over_count), multiply(b, one_over_count)),
                                 add(multiply(c, one_over_count), multiply(d, one_over_count))));
}

HWY_INLINE HWY_ATTR SourcePoints load_source_points(const std::int32_t* const* geometry,
                                                    Lanes count, Lanes one_over_count) {
  const SourcePoint p = load_point(geometry, 0, count), q = load_point(geometry, 1, count);
  const SourcePoint r = load_point(geometry, 2, count), s = load_point(geometry, 3, count);
  const Vector center_a = mean_of(p.on_a, q.on_a, r.on_a, s.on_a, one_over_count);
  const Vector center_b = mean_of(p.on_b, q.on_b, r.on_b, s.on_b, one_over_count);
  return {{subtract(p.on_b, center_b), subtract(q.on_b, center_b), subtract(r.on_b, center_b),
           subtract(s.on_b, center_b)},
          {p.separation, q.separation, r.separation, s.separation},
          center_a,
          center_b};
}

/// Where the records of sources lie from a piece on.
HWY_INLINE HWY_ATTR RecordsAt<const std::int32_t> pieces_of(const ManifoldSource* in) {
  static constexpr std::uint32_t k_index[] = {0, 1, 2, 3, 4, 5, 6, 7};
  return {in->friction.data(), k_index, sizeof(ManifoldSource) / sizeof(std::int32_t)};
}

HWY_INLINE HWY_ATTR SourceLanes load_source(const ManifoldSources& in, std::size_t lane,
                                            const SourceBody* inertias, Lanes count,
                                            Lanes one_over_count, const SourcePoints& points) {
  const RecordsAt<const std::int32_t> at = pieces_of(&in.lanes[lane]);
  Lanes normal_0, normal_1, friction_0, friction_1, impulses_0, impulses_1, share, scale, soft,
      load_word, inertia, inverse_scale, shifts, unused, rolling_0, rolling_1, drive_0, drive_1,
      held_0, held_1;
  load_two(GeometryAt{&in.geometry[lane], 0}, normal_0, normal_1);
  load_operands(at, 0, friction_0, friction_1);
  load_operands(at, 4, impulses_0, impulses_1);
  load_operands(at, 8, share, scale);
  load_operands(at, 12, soft, load_word);
  load_operands(at, 16, inertia, inverse_scale);
  load_operands(at, 20, shifts, unused);
  load_operands(at, 24, rolling_0, rolling_1);
  load_operands(at, 28, drive_0, drive_1);
  load_operands(at, 32, held_0, held_1);
  Lanes clamped = broadcast(0);
  const Vector arm_a = normalized_arm(points.center_a, inverse_scale, clamped);
  const Vector arm_b = normalized_arm(points.center_b, upper(inverse_scale), clamped);
  return {multiply(Vector{normal_0, upper(normal_0), normal_1}, broadcast(1)),  // as whole words
          {friction_0, upper(friction_0), friction_1},
          upper(friction_1),
          load_word,
          upper(share),
          soft,
          one_over_count,
          count,
          {lower_part(impulses_0), upper_part(impulses_0), lower_part(impulses_1),
           upper_part(impulses_1)},
          load_tensor(inertias, &in.body_a[lane], inertia),
          load_tensor(inertias, &in.body_b[lane], upper(inertia)),
          arm_a,
          arm_b,
          subtract(broadcast(k_one), share),
          share,
          scale,
          upper(scale),
          lower_part(shifts),
          upper_part(shifts),
          {rolling_0, upper(rolling_0), rolling_1},
          {drive_0, upper(drive_0), drive_1},
          {lower_part(held_0), upper_part(held_0), lower_part(held_1)},
          upper_part(rolling_1),
          upper(drive_1),
          clamped};
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

/// What the impulses to start from ask of the bodies, at hand already: reading back what was just
/// written to a block would wait for the writes.
struct SourceSides {
  const SourceLanes& in;
  Vector gain_a, gain_b;
  Lanes turn_a, turn_b;

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

HWY_INLINE HWY_ATTR SourceSides sides_of(const SourceLanes& in) {
  return {in, round_shift_low<30>(multiply(in.arm_a, in.share_a)),
          round_shift_low<30>(multiply(in.arm_b, in.share_b)),
          round_shift_low<30>(multiply(in.share_a, in.scale_a)),
          round_shift_low<30>(multiply(in.share_b, in.scale_b))};
}

/// What both bodies bring along, unchanged or times their shares.
HWY_INLINE HWY_ATTR void store_bodies_of(const SourceLanes& in, const SourceSides& sides,
                                         std::size_t lane, const Axes& axes, ManifoldBlock& out) {
  const Tensor& a = in.inertia_a;
  const Tensor& b = in.inertia_b;
  store(pack(a.xx, b.xx), &out.inertia[0][lane]);
  store(pack(a.yy, b.yy), &out.inertia[1][lane]);
  store(pack(a.zz, b.zz), &out.inertia[2][lane]);
  store(pack(a.xy, b.xy), &out.inertia[3][lane]);
  store(pack(a.xz, b.xz), &out.inertia[4][lane]);
  store(pack(a.yz, b.yz), &out.inertia[5][lane]);
  store_vector(pack(in.arm_a, in.arm_b), out.arm, lane);
  store_vector(pack(sides.gain_a, sides.gain_b), out.gain_arm, lane);
  store(pack(in.scale_a, in.scale_b), &out.scale[lane]);
  store(pack(sides.turn_a, sides.turn_b), &out.gain_turn[lane]);
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

HWY_INLINE HWY_ATTR void find_offsets(const SourceLanes& in, const SourcePoints& points,
                                      const Axes& axes, Offsets& offsets) {
  // Q20 · Q30 / ℓ, to Q30.
  const Lanes shift = in.offset_shift;
  const EachShift by = each_shift(shift);
  offsets.square = broadcast(0);
  for (std::size_t i = 0; i < 4; ++i) {
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

HWY_INLINE HWY_ATTR void store_points_of(const SourceLanes& in, const SourcePoints& points,
                                         std::size_t lane, const Offsets& at, const Quotients& q,
                                         const Lanes (&of)[4][4], ManifoldBlock& out) {
  for (std::size_t i = 0; i < 4; ++i) {
    store(pack(at.x[i], at.y[i]), &out.points[i].offset[lane]);
    store(in.impulse[i], &out.points[i].impulse[lane]);
    store(pack(points.separation[i], points.separation[i]), &out.points[i].separation[lane]);
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

/// Impulses along t and b, and torques about them.
struct TangentImpulses {
  Lanes t, b, about_t, about_b;
};

HWY_INLINE HWY_ATTR TangentImpulses along_tangents(const SourceLanes& in, const Axes& axes) {
  return {
      round_shift_low<30>(dot(axes.t, in.friction)), round_shift_low<30>(dot(axes.b, in.friction)),
      round_shift_low<30>(dot(axes.t, in.rolling)), round_shift_low<30>(dot(axes.b, in.rolling))};
}

HWY_INLINE HWY_ATTR void store_friction_of(const SourceLanes& in, std::size_t lane,
                                           const Axes& axes, const TangentImpulses& tangents,
                                           const CenterResponse& k, const Quotients& q,
                                           ManifoldBlock& out) {
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
  store(pack(tangents.t, tangents.b), &out.friction[lane]);
  store(pack(in.twist, q.radius), &out.twist[lane]);
  store(
      pack(round_shift_low<30>(dot(axes.t, in.drive)), round_shift_low<30>(dot(axes.b, in.drive))),
      &out.drive[lane]);
  store(pack(in.twist_drive, in.rolling_limit), &out.turn[lane]);
  store(pack(tangents.about_t, tangents.about_b), &out.rolling[lane]);
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

/// How fast the points come in.
HWY_INLINE HWY_ATTR void find_approach(const SourceLanes& in, const SourceSides& sides,
                                       const Axes& axes, const BodyPair& bodies, PointLanes& points,
                                       std::size_t lane, ManifoldApproach& approach) {
  find_speeds(
      axes,
      motion_of_center(sides, bodies.apart(), axes.by.round(in.inertia_a.times(spin_of(bodies.a))),
                       axes.by.round(in.inertia_b.times(spin_of(bodies.b)))),
      points);
  for (std::size_t i = 0; i < 4; ++i)
    store(multiply(points.speed[i], broadcast(1)), &approach.speed[i][lane]);
}

/// The impulses of the tick before, added up by body.
HWY_INLINE HWY_ATTR void start_lanes(const SourceLanes& in, const SourceSides& sides,
                                     const Axes& axes, const TangentImpulses& tangents,
                                     Lanes radius, const PointLanes& points, BodyPair& bodies) {
  Impulse p = sum_of(points);
  p.t = tangents.t;
  p.b = tangents.b;
  p.about_n = round_shift_low<30>(multiply(in.twist, radius));
  p.about_t = add(p.about_t, tangents.about_t);
  p.about_b = add(p.about_b, tangents.about_b);
  apply(sides, axes, p, bodies);
}

HWY_INLINE HWY_ATTR void prepare_lanes(const ManifoldSources& in, std::size_t lane,
                                       const SourceBody* inertias, const std::int64_t* words,
                                       std::int64_t* warm, ManifoldBlock& block,
                                       ManifoldApproach& approach) {
  Lanes load_word, one_over_count;
  load_operands(pieces_of(&in.lanes[lane]), 12, one_over_count, load_word);
  const Lanes count = upper_part(load_word);
  load_operands(pieces_of(&in.lanes[lane]), 20, load_word, one_over_count);
  const SourcePoints source_points = load_source_points(&in.geometry[lane], count, one_over_count);
  const SourceLanes source = load_source(in, lane, inertias, count, one_over_count, source_points);
  store(source.clamped, &approach.clamped[lane]);
  Axes axes{};
  make_axes(source.normal, source.shift, axes);
  Offsets offsets{};
  find_offsets(source, source_points, axes, offsets);
  const CenterResponse response = center_response(source, axes);
  Lanes of[4][4];
  point_responses(response, offsets, axes.by.shift, of);
  const Quotients quotients = find_quotients(&in.lanes[lane], axes.by, response, offsets, of);
  const TangentImpulses tangents = along_tangents(source, axes);
  const SourceSides sides = sides_of(source);
  PointLanes points{};
  for (std::size_t i = 0; i < 4; ++i) {
    points.x[i] = offsets.x[i];
    points.y[i] = offsets.y[i];
    points.impulse[i] = source.impulse[i];
    points.start[i] = broadcast(0);
  }
  BodyPair bodies{};
  bodies.load_from(words, in, lane);
  find_approach(source, sides, axes, bodies, points, lane, approach);
  bodies.load_from(warm, in, lane);
  start_lanes(source, sides, axes, tangents, quotients.radius, points, bodies);
  bodies.store_to(warm, in, lane);
  store_bodies_of(source, sides, lane, axes, block);
  store_points_of(source, source_points, lane, offsets, quotients, of, block);
  store_friction_of(source, lane, axes, tangents, response, quotients, block);
}

HWY_ATTR inline void prepare_manifolds(const ManifoldSources& in, const SourceBody* inertias,
                                       const RowBody* bodies, RowBody* warm, ManifoldBlock& block,
                                       ManifoldApproach& approach) {
  block.body_a = in.body_a;
  block.body_b = in.body_b;
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    if (is_empty(in, lane)) {
      leave_empty(lane, block, approach);
    } else {
      prepare_lanes(in, lane, inertias, bodies->velocity.data(), warm->velocity.data(), block,
                    approach);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
