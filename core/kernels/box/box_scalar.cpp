// The kernels of box_block.h on lanes of one word: the scalar twin.
#define LKS_SCALAR_TWIN
#include "core/kernels/box/box_block_inl.h"

namespace lockstone::lanes {

constexpr BoxKernels k_scalar_boxes{N_SCALAR_TWIN::meet_boxes, N_SCALAR_TWIN::place_points};

}  // namespace lockstone::lanes
