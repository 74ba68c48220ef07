// Rough energies are as near to the exact ones as their bound says: by them islands are found that
// surely gain nothing.

#include "core/dynamics/body/rough_energy.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/principal_inverse.h"
#include "core/math/trig.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

// Of any size up to 2^bits.
std::int64_t random_of_any_size(test::Random& random, int bits) {
  const std::int64_t most = std::int64_t{1} << random.between(1, bits);
  return random.between(-most, most);
}

InverseInertia random_inertia(test::Random& random) {
  const auto moment = [&] {
    return Unit::from_raw(static_cast<std::int32_t>(
        random.between(k_min_inertia.raw, std::int64_t{1} << random.between(19, 30))));
  };
  const auto part = [&] {
    return Unit::from_raw(static_cast<std::int32_t>(random.between(-(1 << 29), 1 << 29)));
  };
  Vec3<Unit> moments;
  for (int i = 0; i < 3; ++i)
    moments[i] = moment();
  Quat turned;
  for (Unit* x : {&turned.x, &turned.y, &turned.z, &turned.w})
    *x = part();
  return inverse_inertia(principal_inverse(moments), to_matrix(normalized(turned)));
}

lanes::BodyVelocity random_row(test::Random& random) {
  const int bits = static_cast<int>(random.between(8, 61));
  lanes::BodyVelocity row{};
  for (std::size_t i = 0; i < 3; ++i) {
    row.velocity[i] = random_of_any_size(random, bits);
    row.spin[i] = random_of_any_size(random, bits);
  }
  return row;
}

TEST(RoughEnergy, IsWithinItsBoundOfTheExactOne) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 20'000; ++run) {
    const InverseInertia inertia = random_inertia(random);
    const lanes::BodyVelocity row = random_row(random);
    const BlockFloat mass = block_float(static_cast<std::uint64_t>(random.between(1, 1 << 30)),
                                        static_cast<int>(random.between(-30, -10)));
    const std::int64_t each =
        twice_energy(velocity_of_row(row.velocity), velocity_of_row(row.spin), inertia);
    std::int64_t exact = 0;
    add_energy(exact, each, mass);
    const std::uint64_t rough = rough_twice_energy(row, inertia, mass);
    ASSERT_LE(rough, k_most_rough_energy);
    if (rough == k_most_rough_energy) {
      EXPECT_GT(std::max(exact, each), std::int64_t{1} << 59) << "run " << run;
      continue;
    }
    const auto off =
        static_cast<std::uint64_t>(std::llabs(static_cast<std::int64_t>(rough) - exact));
    const std::uint64_t units =
        rough_shift(static_cast<std::uint64_t>(mass.mantissa), mass.exponent + 4) + 1;
    EXPECT_LE(off, (rough >> 9) + units) << "run " << run << ", " << rough << " for " << exact;
  }
}

TEST(RoughEnergy, IsNothingOfABodyAtRestAndAsGreatAsItCanBeOfAHugeOne) {
  constexpr BlockFloat one{1 << 30, -30};
  const InverseInertia inertia = inverse_inertia(principal_inverse({1_r, 1_r, 1_r}), Mat3{});
  EXPECT_EQ(rough_twice_energy({}, inertia, one), 0U);
  lanes::BodyVelocity fast{};
  fast.velocity[0] = k_greatest_velocity;
  EXPECT_EQ(rough_twice_energy(fast, inertia, one), std::uint64_t{1} << (32 + 22));
  EXPECT_EQ(rough_twice_energy(fast, inertia, {1 << 30, -10}), k_most_rough_energy);
}

}  // namespace
}  // namespace lockstone
