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

#ifdef __cplusplus
}
#endif
#endif
