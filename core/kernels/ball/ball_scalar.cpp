// The kernels of ball_block.h on lanes of one word: the scalar twin.
#define LKS_SCALAR_TWIN
#include "core/kernels/ball/ball_block_inl.h"

namespace lockstone::lanes {

constexpr BallKernels k_scalar_balls{
    N_SCALAR_TWIN::begin_balls, N_SCALAR_TWIN::solve_ball_positions, N_SCALAR_TWIN::update_balls};

}  // namespace lockstone::lanes
