// The kernels of proximal_block.h on lanes of one word: the scalar twin.
#define LKS_SCALAR_TWIN
#include "core/kernels/proximal/proximal_inl.h"
#include "core/kernels/proximal/proximal_matrix_inl.h"

namespace lockstone::lanes {

constexpr ProximalKernels k_scalar_proximal{
    N_SCALAR_TWIN::magnitudes,     N_SCALAR_TWIN::begin_phase,      N_SCALAR_TWIN::pass,
    N_SCALAR_TWIN::find_residuals, N_SCALAR_TWIN::add_right_sides,  N_SCALAR_TWIN::propose,
    N_SCALAR_TWIN::add_changes,    N_SCALAR_TWIN::update_residuals, N_SCALAR_TWIN::couple,
    N_SCALAR_TWIN::add_to_matrix,  N_SCALAR_TWIN::add_rows,         N_SCALAR_TWIN::subtract_rows,
    N_SCALAR_TWIN::row_products,   N_SCALAR_TWIN::eliminate,        N_SCALAR_TWIN::solve_down,
    N_SCALAR_TWIN::solve_up};

}  // namespace lockstone::lanes
