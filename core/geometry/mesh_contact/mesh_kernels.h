// The operations on triangles, behind a pointer that meshes and height fields give: a program that
// makes none of them links none of this.
#pragma once

#include <lockstone/asset.h>

#include "core/geometry/mesh_contact/front_crossing.h"
#include "core/geometry/mesh_contact/mesh_contacts.h"

namespace lockstone::geometry {

struct MeshKernels {
  /// The contacts of a convex shape with an asset's triangles, from the asset (A) to the shape (B).
  /// `region`, in the asset's frame, holds all that can come within the margin.
  void (*collide)(const AssetGeometry& asset, const MeshContactFrame& frame,
                  const LocalBounds& region, TriangleContacts& scratch, MeshManifolds& out);

  /// See first_front_crossing.
  FrontCrossing (*first_crossing)(const AssetGeometry& asset, const PointWay& way);
};

/// The one table.
[[nodiscard]] const MeshKernels& mesh_kernels();

}  // namespace lockstone::geometry
