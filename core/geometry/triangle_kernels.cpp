#include "core/geometry/triangle_kernels.h"

namespace lockstone::geometry {

const PolytopeKernels* triangle_kernels() {
  return nullptr;
}

}  // namespace lockstone::geometry
