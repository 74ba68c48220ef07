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

}  // namespace lockstone::lanes
