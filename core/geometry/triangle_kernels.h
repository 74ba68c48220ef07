// What is done with triangles.
#pragma once

#include "core/geometry/polytope_kernels.h"

namespace lockstone::geometry {

/// The kernels that triangles carry; null where the polytope kernels are not part of the build.
[[nodiscard]] const PolytopeKernels* triangle_kernels();

}  // namespace lockstone::geometry
