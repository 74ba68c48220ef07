// The kernel of contact_rows.h for the target at hand.
#if defined(LKS_WIDE_CONTACT_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_CONTACT_ROWS_INL_H
#undef LKS_WIDE_CONTACT_ROWS_INL_H
#else
#define LKS_WIDE_CONTACT_ROWS_INL_H
#endif

#include "core/kernels/contact/body_velocities_inl.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/math/wide/lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

HWY_INLINE HWY_ATTR Lanes read_velocity(Lanes x) {
  return round_shift_low<k_velocity_bits - 20>(x);
}

HWY_INLINE HWY_ATTR void solve_point(const ContactBlock& block, RowPoint& point, std::size_t lane,
                                     BodyLanes& a, BodyLanes& b) {
  const Lanes impulse_bias = load(&point.impulse_bias[lane]);
  const Lanes mass_keep = load(&point.mass_keep[lane]);
  Lanes row_a[3], row_b[3], normal[3];
  for (int i = 0; i < 3; ++i) {
    row_a[i] = load(&point.a[i][lane]);
    row_b[i] = load(&point.b[i][lane]);
    normal[i] = load(&block.normal[i][lane]);
  }
  Lanes along = broadcast(0), of_a = broadcast(0), of_b = broadcast(0);
  for (int i = 0; i < 3; ++i) {
    along = multiply_add(along, normal[i], read_velocity(subtract(b.velocity[i], a.velocity[i])));
    of_a = multiply_add(of_a, row_a[i], read_velocity(a.spin[i]));
    of_b = multiply_add(of_b, row_b[i], read_velocity(b.spin[i]));
  }
  const Lanes sum = add(along, subtract(of_b, of_a));
  const Lanes v = round_shift_low(sum, load(&block.shift[lane]), load(&block.half[lane]));
  const Lanes error = add(v, upper(impulse_bias));
  const Lanes kept = multiply(upper(mass_keep), impulse_bias);
  const Lanes impulse =
      round_shift_positive<30>(multiply_subtract(kept, mass_keep, error), INT32_MAX);
  const Lanes change = subtract(impulse, impulse_bias);
  store(with_upper_of(impulse, impulse_bias), &point.impulse_bias[lane]);
  for (int i = 0; i < 3; ++i) {
    a.velocity[i] = multiply_subtract(a.velocity[i], load(&block.gain_a[i][lane]), change);
    b.velocity[i] = multiply_add(b.velocity[i], load(&block.gain_b[i][lane]), change);
    a.spin[i] = multiply_subtract(a.spin[i], upper(row_a[i]), change);
    b.spin[i] = multiply_add(b.spin[i], upper(row_b[i]), change);
  }
}

/// Contacts of one block from `lane` on, as many as there are lanes.
struct Group {
  ContactBlock& block;
  std::size_t lane;
  BodyLanes a, b;

  HWY_INLINE HWY_ATTR void load_from(const std::int64_t* bodies) {
    load_bodies(bodies, &block.body_a[lane], a);
    load_bodies(bodies, &block.body_b[lane], b);
  }
  HWY_INLINE HWY_ATTR void solve(std::size_t point) {
    solve_point(block, block.points[point], lane, a, b);
  }
  HWY_INLINE HWY_ATTR void store_to(std::int64_t* bodies) const {
    store_bodies(a, bodies, &block.body_a[lane]);
    store_bodies(b, bodies, &block.body_b[lane]);
  }
};

HWY_INLINE HWY_ATTR void solve_group(ContactBlock& block, std::int64_t* bodies) {
  Group group{block, 0, {}, {}};
  group.load_from(bodies);
  for (std::size_t point = 0; point < 4; ++point)
    group.solve(point);
  group.store_to(bodies);
}

/// Two groups in turns. A row must wait for the row before; the other group fills that time.
HWY_INLINE HWY_ATTR void solve_two_groups(ContactBlock& block, std::size_t lane,
                                          ContactBlock& next_block, std::size_t next_lane,
                                          std::int64_t* bodies) {
  Group group{block, lane, {}, {}};
  Group next{next_block, next_lane, {}, {}};
  group.load_from(bodies);
  next.load_from(bodies);
  for (std::size_t point = 0; point < 4; ++point) {
    group.solve(point);
    next.solve(point);
  }
  group.store_to(bodies);
  next.store_to(bodies);
}

HWY_ATTR void solve_contact_rows(BodyVelocity* bodies, ContactBlock* blocks, std::size_t count) {
  if (count == 0) return;
  std::int64_t* words = bodies->velocity.data();
  if constexpr (k_lanes == k_block_lanes) {
    std::size_t i = 0;
    for (; i + 2 <= count; i += 2)
      solve_two_groups(blocks[i], 0, blocks[i + 1], 0, words);
    if (i < count) solve_group(blocks[i], words);
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t lane = 0; lane < k_block_lanes; lane += 2 * k_lanes) {
        solve_two_groups(blocks[i], lane, blocks[i], lane + k_lanes, words);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
