/* Poses in floating point, to be drawn: the npm package needs them besides the C interface. They
 * must never find their way back into a world. */
#ifndef LOCKSTONE_WEB_H
#define LOCKSTONE_WEB_H

#include "lockstone_c/bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The poses of a world after a tick, a row for each index of a body: its number (0: no body), the
 * place of its shape in metres from `origin`, and a unit quaternion x, y, z, w. Each array has
 * `rows` rows: the body capacity of the world. `used`: every body has a row below it. */
LKS_API lks_status lks_web_poses(const lks_world* world, const lks_position3* origin,
                                 lks_body* bodies, float* positions, float* orientations,
                                 uint32_t rows, uint32_t* used);

/* Poses between two ticks: `fraction` 0 … 1 of the way from `before` to `now`, rotations the shorter
 * way round. A body that is new, or that moved farther than `snap` metres, is shown where it is. */
typedef struct lks_web_poses_at {
  const lks_body* bodies;
  const float* positions;
  const float* orientations;
} lks_web_poses_at;
LKS_API void lks_web_blend(const lks_web_poses_at* before, const lks_web_poses_at* now,
                           float fraction, float snap, uint32_t rows, float* positions,
                           float* orientations);

/* A part of a body's shape that is a sphere, capsule, box, cylinder or cone, in the frame of the
 * shape: sizes as of lks_shape, the place of its origin, and the unit vectors of its axes. */
typedef struct lks_web_part {
  uint32_t kind;
  float size[3];
  float place[3];
  float axes[9];
} lks_web_part;

/* The shape of a body, to be drawn: parts, and the triangles of its hulls and meshes, nine numbers
 * each, counter-clockwise seen from outside. A half-space is a part without a size. The counts are
 * those that there are; LKS_BUFFER_TOO_SMALL when that is more than the capacities. */
LKS_API lks_status lks_web_outline(const lks_world* world, lks_body body, lks_web_part* parts,
                                   size_t part_capacity, size_t* part_count, float* triangles,
                                   size_t triangle_capacity, size_t* triangle_count);

#ifdef __cplusplus
}
#endif
#endif
