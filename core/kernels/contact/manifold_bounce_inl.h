// Restitution, the last iteration of manifold_block.h, for the target at hand.
#if defined(LKS_WIDE_MANIFOLD_BOUNCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_BOUNCE_INL_H
#undef LKS_WIDE_MANIFOLD_BOUNCE_INL_H
#else
#define LKS_WIDE_MANIFOLD_BOUNCE_INL_H
#endif

#include "core/kernels/contact/manifold_iterate_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// P ← max(0, P − m·(v + e·approach)) for the points that came in fast and were pushed.
template <bool plain>
HWY_INLINE HWY_ATTR void bounce_lanes(ManifoldBlock& block, std::size_t lane, std::int64_t* words,
                                      const ManifoldApproach& approach,
                                      const BlockWord& restitution, std::int32_t threshold) {
  BodyPair bodies{};
  bodies.load_from(words, block, lane);
  const Axes axes = load_axes(block, lane);
  const CenterMotion motion = read_motion(BlockSides<plain>{block, lane}, axes, bodies);
  PointLanes points{};
  load_points<k_block_points>(block, lane, axes, motion, points);
  Responses responses{};
  load_responses<k_block_points>(block, lane, responses);
  const Lanes none = broadcast(0), elasticity = load(&restitution[lane]);
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const Lanes came = load(&approach.speed[i][lane]);
    const Lanes wanted = round_shift_low<30>(multiply(elasticity, came));
    const Lanes error = add(points.speed[i], wanted);
    const Lanes next = HardRow{}.next(points, i, multiply(points.mass[i], error), none);
    Lanes bounced = select_less(came, broadcast(-std::int64_t{threshold}), next, points.impulse[i]);
    bounced = select_equal(elasticity, none, points.impulse[i], bounced);
    bounced = select_equal(upper_part(load(&block.points[i].impulse[lane])), none,
                           points.impulse[i], bounced);
    const Lanes moved = subtract(bounced, points.impulse[i]);
    points.impulse[i] = bounced;
    for (std::size_t j = i + 1; j < k_block_points; ++j)
      points.speed[j] = add(points.speed[j], axes.by.round(multiply(responses.of[j][i], moved)));
  }
  store_points<k_block_points>(points, lane, block);
  apply<true>(BlockSides<plain>{block, lane}, axes, sum_of<k_block_points>(points), bodies);
  bodies.store_to(words, block, lane);
}

HWY_ATTR inline void bounce_manifolds(BodyVelocity* bodies, ManifoldBlock& block,
                                      const ManifoldApproach& approach,
                                      const BlockWord& restitution, std::int32_t threshold) {
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    if (used_points(block, lane) == 0) continue;
    std::int64_t* words = bodies->velocity.data();
    if (are_plain(block, lane)) {
      bounce_lanes<true>(block, lane, words, approach, restitution, threshold);
    } else {
      bounce_lanes<false>(block, lane, words, approach, restitution, threshold);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
