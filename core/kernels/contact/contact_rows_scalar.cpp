#include "core/kernels/contact/contact_rows.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone::lanes {
namespace {

using scalar::Lane;

// m/s, Q20.
Lane read_velocity(Lane velocity) {
  return scalar::round_shift_low(velocity, k_velocity_bits - 20);
}

Lane relative_velocity(const ContactBlock& block, const RowPoint& point, std::size_t lane,
                       const BodyVelocity& a, const BodyVelocity& b) {
  Lane sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane along = read_velocity(scalar::subtract(b.velocity[i], a.velocity[i]));
    sum = scalar::multiply_add(sum, block.normal[i][lane], along);
    sum = scalar::multiply_add(sum, point.b[i][lane], read_velocity(b.spin[i]));
    sum = scalar::multiply_subtract(sum, point.a[i][lane], read_velocity(a.spin[i]));
  }
  return scalar::round_shift_low(sum, static_cast<int>(block.shift[lane]));
}

void apply(const ContactBlock& block, const RowPoint& point, std::size_t lane, Lane change,
           BodyVelocity& a, BodyVelocity& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane turn_a = scalar::high(point.a[i][lane]);
    const Lane turn_b = scalar::high(point.b[i][lane]);
    a.velocity[i] = scalar::multiply_subtract(a.velocity[i], block.gain_a[i][lane], change);
    b.velocity[i] = scalar::multiply_add(b.velocity[i], block.gain_b[i][lane], change);
    a.spin[i] = scalar::multiply_subtract(a.spin[i], turn_a, change);
    b.spin[i] = scalar::multiply_add(b.spin[i], turn_b, change);
  }
}

void solve_point(const ContactBlock& block, RowPoint& point, std::size_t lane, BodyVelocity& a,
                 BodyVelocity& b) {
  const Lane mass_keep = point.mass_keep[lane];
  const Lane impulse_bias = point.impulse_bias[lane];
  const Lane bias = scalar::high(impulse_bias);
  const Lane error = scalar::add(relative_velocity(block, point, lane, a, b), bias);
  const Lane kept = scalar::multiply(scalar::high(mass_keep), impulse_bias);
  const Lane total = scalar::multiply_subtract(kept, mass_keep, error);
  const Lane impulse = scalar::round_shift_positive(total, 30, INT32_MAX);
  apply(block, point, lane, scalar::subtract(impulse, impulse_bias), a, b);
  point.impulse_bias[lane] = scalar::pack(impulse, bias);
}

}  // namespace

void solve_contact_rows_scalar(BodyVelocity* bodies, ContactBlock* blocks, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
      BodyVelocity& a = bodies[blocks[i].body_a[lane] / body_velocity_offset(1)];
      BodyVelocity& b = bodies[blocks[i].body_b[lane] / body_velocity_offset(1)];
      for (RowPoint& point : blocks[i].points)
        solve_point(blocks[i], point, lane, a, b);
    }
  }
}

}  // namespace lockstone::lanes
