// Principal axes of a symmetric tensor.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/vec3.h>

#include "core/math/sym_mat3.h"

namespace lockstone {

struct PrincipalAxes {
  Vec3<std::int64_t> moments{};  ///< along the axes, in the tensor's unit
  Quat axes{};                   ///< its columns are the axes; w ≥ 0
};

/// Eigenvalues and eigenvectors of a positive semi-definite tensor with 60 fraction bits, whose
/// entries are at most 1 in size. Moments err by at most 2^-22 of themselves and 2^-38 together.
///
/// Each axis stays the one nearest to its own: a diagonal tensor gives the identity, and two
/// moments that agree within 2^-18 are not told apart by a product below 2^-22 of them. Jacobi's
/// method: Golub and Van Loan, Matrix computations, 8.5.
[[nodiscard]] PrincipalAxes principal_axes(const SymMat3<std::int64_t>& tensor);

}  // namespace lockstone
