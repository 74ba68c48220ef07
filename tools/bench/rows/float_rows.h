// The yardstick of the integer kernel: the same iteration in single precision, four lanes of
// SSE2, the structure that float engines use. See core/kernels/contact/contact_rows.h for the
// equations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/bench/rows/row_scene.h"

#if defined(__SSE2__)

namespace lockstone::bench {

struct alignas(32) FloatBody {
  float velocity[3];
  float spin[3];
  float unused[2];
};

struct FloatPoint {
  float read_a[3][4], read_b[3][4], gain_a[3][4], gain_b[3][4];
  float mass[4], keep[4], bias[4], impulse[4];
};

struct alignas(64) FloatBlock {
  std::uint32_t body_a[4], body_b[4];
  float normal[3][4], gain_a[3][4], gain_b[3][4];
  FloatPoint points[4];
};

struct FloatRows {
  explicit FloatRows(const RowScene& scene);

  void sweep();

  /// Two blocks at a time, row by row in turns, as the integer kernel does where it has few lanes.
  void sweep_in_twos();

  std::vector<FloatBody> bodies;
  std::vector<FloatBlock> blocks;
};

}  // namespace lockstone::bench

#endif
