// Assets scaled along their axes. The copy is built once, as an asset of its own with an id of its
// own: a scale costs nothing while a world steps.
#pragma once

#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

// Each coordinate of the copy is that of the asset times the factor of its axis, rounded once to
// the nearest 2^-20 m, ties away from zero. With all factors 1 the copy has the id of the asset. A
// coordinate that leaves ±512 m gives coordinate_out_of_range. Factors below 1/64 are coarse in
// steps of 2^-20: there, build from points in a better unit.

/// No factor may be 0; a negative one mirrors. A hull with a radius takes factors of one size
/// alone, by which the radius is scaled too: else the fault is invalid_options. The tolerance that
/// the hull was built with is scaled by the largest factor. Vertices that rounding brings into one
/// plane or together are merged as in `Hull::build`.
[[nodiscard]] HullResult scaled(const Hull& hull, const Vec3<Number>& factors);

/// No factor may be 0 (invalid_option); a negative one mirrors. The fronts of the triangles stay on
/// the side where they were: an odd number of negative factors turns their winding round. Vertices
/// that rounding brings together are welded, and triangles without area dropped, and counted. Parts
/// get new numbers; surfaces, groups and the flat angle stay.
[[nodiscard]] MeshResult scaled(const Mesh& mesh, const Vec3<Number>& factors);

/// All factors are above 0, else invalid_option: a mirrored cell would be split along its other
/// diagonal. The corner of the grid and the size of a cell are rounded, so sample (i, j) stands
/// within (i + 1) / 2 and (j + 1) / 2 steps of 2^-20 m of its scaled place; heights within one
/// half. Parts keep their numbers; holes, surfaces and the flat angle stay.
[[nodiscard]] HeightFieldResult scaled(const HeightField& field, const Vec3<Number>& factors);

}  // namespace lockstone
