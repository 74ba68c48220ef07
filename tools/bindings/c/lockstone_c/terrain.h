/* Terrain that changes: samples and cells of the height field of a static body, and groups of
 * triangles of a mesh, as part of the state; the asset stays as it is. */
#ifndef LOCKSTONE_C_TERRAIN_H
#define LOCKSTONE_C_TERRAIN_H

#include "bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A rectangle of samples from (column, row) on, and the cells between them: (columns − 1) ·
 * (rows − 1). */
typedef struct lks_height_rectangle {
  uint32_t column;
  uint32_t row;
  uint32_t columns; /* 1 or more */
  uint32_t rows;
} lks_height_rectangle;

/* Changes heights (one a sample, y in the frame of the asset, ±512 m), holes (one a cell, not 0
 * where there is a hole) and surfaces (one a cell, an index into those of the asset, or 255), all
 * row by row. Null leaves them as they are; not all are null. Wakes the bodies on these cells.
 * LKS_NOT_FOUND for a body without a height field; LKS_CAPACITY_EXHAUSTED beyond
 * lks_world_def.terrain_tile_capacity. */
LKS_API lks_status lks_set_heights(lks_world* world, lks_body body,
                                   const lks_height_rectangle* rectangle, const lks_length* heights,
                                   const uint8_t* holes, const uint8_t* surfaces);

/* A sample as it is now, and the cell from it to the next one along both axes. `is_hole` is 1 also
 * where there is no cell. Fails for a body without a height field, or beyond its grid. */
LKS_API lks_status lks_terrain_sample_get(const lks_world* world, lks_body body, uint32_t column,
                                          uint32_t row, lks_length* height, uint32_t* is_hole,
                                          uint32_t* surface);

/* Switches a group of triangles of the body's mesh on (1) or off (0): nothing meets those of a
 * group that is off. Wakes the bodies there. LKS_NOT_FOUND for a body without a mesh of groups;
 * LKS_CAPACITY_EXHAUSTED beyond lks_world_def.terrain_tile_capacity. */
LKS_API lks_status lks_set_mesh_group(lks_world* world, lks_body body, uint32_t group,
                                      uint32_t is_on);

/* Whether a group is on. Fails for a body without a mesh of groups, or a group without
 * triangles. */
LKS_API lks_status lks_mesh_group_get(const lks_world* world, lks_body body, uint32_t group,
                                      uint32_t* is_on);

/* Changed tiles of 4 × 4 samples, and of 16 groups of meshes, of all bodies. */
LKS_API lks_status lks_terrain_tile_count(const lks_world* world, uint32_t* out);

#ifdef __cplusplus
}
#endif

#endif
