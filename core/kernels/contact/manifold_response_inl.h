// How the centre of a manifold answers impulses there: see manifold_block.h.
#if defined(LKS_WIDE_MANIFOLD_RESPONSE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_RESPONSE_INL_H
#undef LKS_WIDE_MANIFOLD_RESPONSE_INL_H
#else
#define LKS_WIDE_MANIFOLD_RESPONSE_INL_H
#endif

#include "core/kernels/contact/manifold_motion_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// The response of the six motions at the centre to the six impulses there, as far as it is used:
/// n, t, b; x and y for the points' offsets (turning about −b and t); w for the twist about n.
/// Sums of both bodies in Q(shift + 30), then in Q(shift).
struct CenterResponse {
  Lanes nn, tt, bb, tb;
  Lanes nx, ny, nw, tn, tx, ty, tw, bn, bx, by, bw;
  Lanes xx, yy, xy, xw, yw, ww;
};

/// One body: with r and M in the manifold's axes and H_u = M·(r × u), the entry of u and v is
/// α·(r × u)·H_v, of u and an axis e it is αℓ/s·e·H_u, of two axes α(ℓ/s)²·e·M·f.
struct BodyResponse {
  Vector arm;  // r̄ along n, t, b
  Tensor m;    // in these axes: xx is nn, xy is nt …
  Lanes share, turn, turn_scale;
};

template <bool plain>
HWY_INLINE HWY_ATTR Vector turned(const Tensor& m, const Vector& v) {
  if constexpr (plain) return multiply(v, m.xx);
  return m.times(v);
}

template <bool plain>
HWY_INLINE HWY_ATTR BodyResponse in_axes(const Axes& axes, const Tensor& m, const Vector& arm,
                                         Lanes share, Lanes scale) {
  const Vector n = round_shift_low<30>(turned<plain>(m, axes.n));
  const Vector t = round_shift_low<30>(turned<plain>(m, axes.t));
  const Vector b = round_shift_low<30>(turned<plain>(m, axes.b));
  const Lanes turn = round_shift_low<30>(multiply(share, scale));
  const Vector along = {dot(axes.n, arm), dot(axes.t, arm), dot(axes.b, arm)};
  const Vector diagonal =
      round_shift_low<30>(Vector{dot(axes.n, n), dot(axes.t, t), dot(axes.b, b)});
  const Vector mixed = round_shift_low<30>(Vector{dot(axes.n, t), dot(axes.n, b), dot(axes.t, b)});
  return {round_shift_low<30>(along),
          {diagonal.x, diagonal.y, diagonal.z, mixed.x, mixed.y, mixed.z},
          share,
          turn,
          round_shift_low<30>(multiply(turn, scale))};
}

/// a·b − c·d
HWY_INLINE HWY_ATTR Lanes difference(Lanes a, Lanes b, Lanes c, Lanes d) {
  return multiply_subtract(multiply(a, b), c, d);
}

/// Surface speeds by unit impulses at r along x, y and z: M·(r × x), M·(r × y), M·(r × z).
struct AxisTurns {
  Vector x, y, z;
};

HWY_INLINE HWY_ATTR AxisTurns turned_by_axes(const Tensor& m, const Vector& r) {
  // r × x = (0, r.z, −r.y), r × y = (−r.z, 0, r.x), r × z = (r.y, −r.x, 0).
  return {
      round_shift_low<30>(Vector{difference(m.xy, r.z, m.xz, r.y), difference(m.yy, r.z, m.yz, r.y),
                                 difference(m.yz, r.z, m.zz, r.y)}),
      round_shift_low<30>(Vector{difference(m.xz, r.x, m.xx, r.z), difference(m.yz, r.x, m.xy, r.z),
                                 difference(m.zz, r.x, m.xz, r.z)}),
      round_shift_low<30>(Vector{difference(m.xx, r.y, m.xy, r.x), difference(m.xy, r.y, m.yy, r.x),
                                 difference(m.xz, r.y, m.yz, r.x)})};
}

HWY_INLINE HWY_ATTR void add_response(const BodyResponse& body, CenterResponse& k) {
  const Vector& r = body.arm;
  const auto [n, t, b] = turned_by_axes(body.m, r);
  const Lanes share = body.share, turn = body.turn, both = body.turn_scale;
  k.nn = multiply_add(k.nn, share, round_shift_low<30>(difference(r.z, n.y, r.y, n.z)));
  k.tt = multiply_add(k.tt, share, round_shift_low<30>(difference(r.x, t.z, r.z, t.x)));
  k.bb = multiply_add(k.bb, share, round_shift_low<30>(difference(r.y, b.x, r.x, b.y)));
  k.tb = multiply_add(k.tb, share, round_shift_low<30>(difference(r.x, b.z, r.z, b.x)));
  k.tn = multiply_add(k.tn, share, round_shift_low<30>(difference(r.z, t.y, r.y, t.z)));
  k.bn = multiply_add(k.bn, share, round_shift_low<30>(difference(r.z, b.y, r.y, b.z)));
  k.nx = multiply_subtract(k.nx, turn, n.z);
  k.ny = multiply_add(k.ny, turn, n.y);
  k.nw = multiply_add(k.nw, turn, n.x);
  k.tx = multiply_subtract(k.tx, turn, t.z);
  k.ty = multiply_add(k.ty, turn, t.y);
  k.tw = multiply_add(k.tw, turn, t.x);
  k.bx = multiply_subtract(k.bx, turn, b.z);
  k.by = multiply_add(k.by, turn, b.y);
  k.bw = multiply_add(k.bw, turn, b.x);
  k.xx = multiply_add(k.xx, both, body.m.zz);
  k.yy = multiply_add(k.yy, both, body.m.yy);
  k.xy = multiply_subtract(k.xy, both, body.m.yz);
  k.xw = multiply_subtract(k.xw, both, body.m.xz);
  k.yw = multiply_add(k.yw, both, body.m.xy);
  k.ww = multiply_add(k.ww, both, body.m.xx);
}

HWY_INLINE HWY_ATTR void finish(Lanes shift, CenterResponse& k) {
  const Lanes one = power_of_two(shift);
  for (Lanes* entry : {&k.nn, &k.tt, &k.bb, &k.tb, &k.nx, &k.ny, &k.nw, &k.tn, &k.tx, &k.ty, &k.tw,
                       &k.bn, &k.bx, &k.by, &k.bw, &k.xx, &k.yy, &k.xy, &k.xw, &k.yw, &k.ww})
    *entry = round_shift_low<30>(*entry);
  k.nn = lower_part(add(k.nn, one));
  k.tt = lower_part(add(k.tt, one));
  k.bb = lower_part(add(k.bb, one));
}

/// Along a locked axis a body does not answer: takes uᵀ·H·v from the entry of u and v. H is
/// zero but for bodies with axis locks.
HWY_INLINE HWY_ATTR void apply_axis_locks(const Vector& locked, const Axes& axes,
                                          CenterResponse& k) {
  const Lanes none = broadcast(0);
  const Lanes sum = add(add(locked.x, locked.y), locked.z);
  if (!any_less(none, sum)) return;
  const auto times_held = [&](const Vector& u) {
    return round_shift_low<30>(
        Vector{multiply(locked.x, u.x), multiply(locked.y, u.y), multiply(locked.z, u.z)});
  };
  const EachShift by = each_shift(subtract(broadcast(60), axes.by.shift));
  const Vector n = times_held(axes.n), t = times_held(axes.t), b = times_held(axes.b);
  const auto take = [&](Lanes& entry, const Vector& u, const Vector& v) {
    entry = subtract(entry, by.round(dot(u, v)));
  };
  take(k.nn, n, axes.n);
  take(k.tt, t, axes.t);
  take(k.bb, b, axes.b);
  take(k.tb, t, axes.b);
  take(k.tn, t, axes.n);
  take(k.bn, b, axes.n);
  const Lanes least = power_of_two(subtract(axes.by.shift, broadcast(6)));
  for (Lanes* entry : {&k.nn, &k.tt, &k.bb})
    *entry = select_equal(sum, none, *entry, max(*entry, least));
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
