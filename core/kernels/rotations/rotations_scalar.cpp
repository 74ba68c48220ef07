#include "core/kernels/rotations/rotations.h"

namespace lockstone::lanes {

void compute_rotations_scalar(const QuatField& quats, const std::uint32_t* indices,
                              std::size_t count, Mat3* matrices) {
  for (std::size_t i = 0; i < count; ++i) {
    matrices[indices[i]] = to_matrix(*quats.at(indices[i]));
  }
}

}  // namespace lockstone::lanes
