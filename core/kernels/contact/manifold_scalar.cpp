// The kernels of manifold_block.h on lanes of one word: the scalar twin.
#define LKS_SCALAR_TWIN
#include "core/kernels/contact/manifold_bounce_inl.h"
#include "core/kernels/contact/manifold_iterate_inl.h"
#include "core/kernels/contact/manifold_prepare_inl.h"
#include "core/kernels/contact/manifold_relax_inl.h"

namespace lockstone::lanes {

constexpr ManifoldKernels k_scalar_manifolds{
    N_SCALAR_TWIN::prepare_manifolds, N_SCALAR_TWIN::solve_manifolds,
    N_SCALAR_TWIN::relax_manifolds, N_SCALAR_TWIN::bounce_manifolds};

void move_separations(const DeltaPose* travel, ManifoldBlock& block, std::size_t lane,
                      const SolverParams& rules) {
  N_SCALAR_TWIN::move_separations<k_block_points>(
      block, lane, N_SCALAR_TWIN::load_axes(block, lane), travel->velocity.data(), rules);
}

}  // namespace lockstone::lanes
