// The inputs of manifolds' preparation, read into lanes: see manifold_block.h.
#if defined(LKS_WIDE_MANIFOLD_SOURCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_SOURCE_INL_H
#undef LKS_WIDE_MANIFOLD_SOURCE_INL_H
#else
#define LKS_WIDE_MANIFOLD_SOURCE_INL_H
#endif

#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/contact/manifold_motion_inl.h"

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
  Lanes twist, mean_impulse, coefficient, soft;
  Lanes one_over_count, count;
  Lanes impulse[4];
  Tensor inertia_a, inertia_b;  // Q(shift)
  Vector arm_a, arm_b;          // r̄ of the centre, Q30
  Lanes share_a, share_b, scale_a, scale_b;
  Lanes offset_shift, shift;
  Vector rolling, drive, locked;
  Lanes rolling_limit, twist_drive;
  Lanes kind;
  Lanes clamped;  // how many arms were
};

/// Words 0 and 1 of each lane's record, from `word` operands on: four operands.
HWY_INLINE HWY_ATTR void load_operands(const RecordsAt<const std::int32_t>& at, std::size_t word,
                                       Lanes& first, Lanes& second) {
  load_two(RecordsAt<const std::int32_t>{at.base + word, at.index, at.stride}, first, second);
}

/// The part that the operands of one body contribute: M in the pair's format.
template <bool plain = false>
HWY_INLINE HWY_ATTR Tensor load_tensor(const BodyInertia* inertias, const std::uint32_t* index,
                                       Lanes factor) {
  // Offsets of bodies count words of BodyVelocity; a BodyInertia has as many operands.
  static_assert(sizeof(BodyInertia) == 8 * sizeof(std::int32_t) && body_velocity_offset(1) == 8);
  const RecordsAt<const std::int32_t> at{inertias->inertia.data(), index, 1};
  Lanes xx_yy, zz_xy, xz_yz, none;
  load_operands(at, 0, xx_yy, zz_xy);
  if constexpr (plain) {
    const Lanes m = round_shift_low<14>(multiply(xx_yy, factor));
    const Lanes zero = broadcast(0);
    return {m, m, m, zero, zero, zero};
  }
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

/// The first `most` points. The centre is the mean of those that there are.
template <std::size_t most>
HWY_INLINE HWY_ATTR SourcePoints load_source_points(const std::int32_t* const* geometry,
                                                    Lanes count, Lanes one_over_count) {
  SourcePoints points{};
  Vector sum_a{}, sum_b{};
  for (std::size_t i = 0; i < most; ++i) {
    const SourcePoint point = load_point(geometry, i, count);
    const Vector part_a = multiply(point.on_a, one_over_count);
    const Vector part_b = multiply(point.on_b, one_over_count);
    sum_a = i == 0 ? part_a : add(sum_a, part_a);
    sum_b = i == 0 ? part_b : add(sum_b, part_b);
    points.from_center[i] = point.on_b;
    points.separation[i] = point.separation;
  }
  points.center_a = round_shift_low<30>(sum_a);
  points.center_b = round_shift_low<30>(sum_b);
  for (std::size_t i = 0; i < most; ++i)
    points.from_center[i] = subtract(points.from_center[i], points.center_b);
  return points;
}

/// Where the records of sources lie from a piece on.
HWY_INLINE HWY_ATTR RecordsAt<const std::int32_t> pieces_of(const PrepareInput* in) {
  static constexpr std::uint32_t k_index[] = {0, 1, 2, 3, 4, 5, 6, 7};
  return {in->friction.data(), k_index, sizeof(PrepareInput) / sizeof(std::int32_t)};
}

template <bool plain>
HWY_INLINE HWY_ATTR SourceLanes load_source(const PrepareInputs& in, std::size_t lane,
                                            const BodyInertia* inertias, Lanes count,
                                            Lanes one_over_count, const SourcePoints& points) {
  const RecordsAt<const std::int32_t> at = pieces_of(&in.lanes[lane]);
  Lanes normal_0, normal_1, friction_0, friction_1, impulses_0, impulses_1, share, scale, soft,
      load_word, inertia, inverse_scale, shifts, count_kind, rolling_0, rolling_1, drive_0, drive_1,
      held_0, held_1;
  load_two(GeometryAt{&in.geometry[lane], 0}, normal_0, normal_1);
  load_operands(at, 0, friction_0, friction_1);
  load_operands(at, 4, impulses_0, impulses_1);
  load_operands(at, 8, share, scale);
  load_operands(at, 12, soft, load_word);
  load_operands(at, 16, inertia, inverse_scale);
  load_operands(at, 20, shifts, count_kind);
  rolling_0 = rolling_1 = drive_0 = drive_1 = held_0 = held_1 = broadcast(0);
  if constexpr (!plain) {
    load_operands(at, 24, rolling_0, rolling_1);
    load_operands(at, 28, drive_0, drive_1);
    load_operands(at, 32, held_0, held_1);
  }
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
          load_tensor<plain>(inertias, &in.body_a[lane], inertia),
          load_tensor<plain>(inertias, &in.body_b[lane], upper(inertia)),
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
          upper_part(count_kind),
          clamped};
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
