/* Worlds: made, stepped, destroyed. */
#ifndef LOCKSTONE_C_WORLD_H
#define LOCKSTONE_C_WORLD_H

#include "assets.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lks_world lks_world;

/* Capacities and rules of a world, fixed for its life. */
typedef struct lks_world_def {
  uint32_t size;
  uint32_t body_capacity;    /* 1 … 2^20 */
  uint32_t pair_capacity;    /* pairs with overlapping bounds, 1 … 2^24 */
  uint32_t contact_capacity; /* touching pairs, 1 … 2^24 */
  uint32_t joint_capacity;   /* 0 … 2^20 */
  uint32_t tick_rate;        /* ticks per second, 10 … 480 */
  uint32_t substeps;         /* solver steps a tick, 1 … 16 */
  uint32_t sleep_ms;         /* rest before a body sleeps, to 60,000; 0: none ever does */
  lks_length sleep_distance; /* a body that moves less rests, 1 mm … 1 m */
  uint32_t broad_phase;      /* 0: trees, 1: sweep and prune. Changes no result */
  lks_acceleration3 gravity;
  lks_velocity speed_limit;       /* of every body, 1 … 500 m/s */
  uint32_t converged_contacts;    /* of islands solved to convergence, 0 … 65,536; 0: none is */
  uint32_t vehicle_capacity;      /* 0 … 64 */
  uint32_t terrain_tile_capacity; /* changed tiles of height fields, 0 … 65,536 */
  uint32_t reserved;              /* 0 */
} lks_world_def;

/* Sets the defaults: `lks_world_def_init(&def, sizeof def)`. */
LKS_API lks_status lks_world_def_init(lks_world_def* def, size_t size);

/* Makes an empty world; takes all memory that steps need. `assets` may be null. */
LKS_API lks_status lks_world_create(const lks_world_def* def, const lks_assets* assets,
                                    lks_world** out);

/* Makes a built-in scene, by the names of `lockstone scenes`: with these one checks a port or a
 * binding against known hashes. It plays by itself and takes no command: LKS_READ_ONLY.
 * LKS_NOT_FOUND for an unknown name. */
LKS_API lks_status lks_world_create_scene(const char* name, uint64_t seed, lks_world** out);

/* How many scenes there are; the name of one, null beyond the last. */
LKS_API uint32_t lks_scene_count(void);
LKS_API const char* lks_scene_name(uint32_t index);

/* Null is allowed. */
LKS_API void lks_world_destroy(lks_world* world);

/* The definition that the world was made with. `def->size` must be set. */
LKS_API lks_status lks_world_get_def(const lks_world* world, lks_world_def* def);

/* A hash over everything in `def` that can change a result, and the assets: peers compare it before
 * they play. `assets` may be null. */
LKS_API lks_status lks_config_hash(const lks_world_def* def, const lks_assets* assets,
                                   uint64_t* out);

/* Steps on this many threads from here on, 1 … 64, the calling one included. Changes no result. */
LKS_API lks_status lks_world_set_threads(lks_world* world, uint32_t threads);

/* The result of one step. The same on every peer. */
typedef struct lks_step_report {
  uint32_t size;
  lks_status status; /* LKS_CAPACITY_EXHAUSTED: pairs were left out, alike everywhere */
  uint32_t moving_bodies;
  uint32_t asleep_bodies;
  uint32_t islands;
  uint32_t free_bodies;
  uint32_t axis_turns;
  uint32_t pairs;
  uint32_t contacts;
  uint32_t contact_points;
  uint32_t colors;
  uint32_t overflow_contacts;
  uint32_t continuous_bodies;
  uint32_t impacts;
  uint32_t saturations;
  uint32_t energy_limits;
  uint32_t computed_islands; /* with a history alone: groups of bodies that were stepped, */
  uint32_t recalled_islands; /* and those whose results came from memory */
  uint32_t still_bodies;     /* awake, of islands that stand still and are not solved, */
  uint32_t still_contacts;   /* and the contacts of these islands */
} lks_step_report;

/* Advances by 1 / tick_rate seconds. `report` may be null; else `report->size` must be set. */
LKS_API lks_status lks_step(lks_world* world, lks_step_report* report);

/* The most ticks of lks_world_keep_history. */
#define LKS_MAX_HISTORY_TICKS 256

/* From here on the world remembers its last `ticks` ticks, at most LKS_MAX_HISTORY_TICKS; 0, as at
 * first: none. A tick that is stepped again after lks_load then costs as much as differs. No result
 * depends on it. Allocates; a tick takes the bytes of two native snapshots, and of events and
 * pairs. For worlds of one's own, not for scenes. */
LKS_API lks_status lks_world_keep_history(lks_world* world, uint32_t ticks);

/* Forgets the remembered ticks: the next steps compute everything. */
LKS_API lks_status lks_world_forget_history(lks_world* world);

/* Ticks stepped. */
LKS_API lks_status lks_tick(const lks_world* world, uint64_t* out);

#ifdef __cplusplus
}
#endif
#endif
