// Refers to every row as a program that names all kinds does.
#define LKS_LINKS_ALL_ROWS
#include "core/geometry/shapes/shape_table.h"

namespace lockstone {

bool link_all_shapes() {
  bool all = true;
#define LKS_LINKED(kind, name) \
  all = all && geometry::find_traits(ShapeKind::kind) == &geometry::k_##kind;
  LKS_LATER_SHAPES(LKS_LINKED)
#undef LKS_LINKED
  return all;
}

}  // namespace lockstone
