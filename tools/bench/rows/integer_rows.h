// The benchmark's scene in the form of the integer kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/kernels/contact/contact_rows.h"
#include "tools/bench/rows/row_scene.h"

namespace lockstone::bench {

struct IntegerRows {
  explicit IntegerRows(const RowScene& scene);

  void sweep();

  /// Of all velocities and impulses.
  [[nodiscard]] std::uint64_t hash() const;

  std::vector<lanes::BodyVelocity> bodies;
  std::vector<lanes::ContactBlock> blocks;
  std::size_t colour_blocks;
};

}  // namespace lockstone::bench
