/* The studio's own functions: worlds that a person plays with, logs that are watched, and the state
 * of a world as numbers to draw. They come on top of the C interface, in WebAssembly alone. Numbers
 * in floating point must never find their way back into a world. */
#ifndef LOCKSTONE_STUDIO_H
#define LOCKSTONE_STUDIO_H

#include "lockstone_c/bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Testbed ---------------------------------------------------------------------------------------
 */

/* A built-in scene that takes actions, with room for more bodies. `values`: of its first
 * parameters; the others have their usual ones. Until the first action its states are those of the
 * scene itself. LKS_INVALID_ARGUMENT for a value out of its range. */
LKS_API lks_status lks_studio_scene(const char* name, uint64_t seed, const int32_t* values,
                                    uint32_t count, lks_world** out);

/* A whole number that a scene can be made with. */
typedef struct lks_studio_parameter {
  const char* name; /* holds until the next call */
  int32_t usual;
  int32_t least;
  int32_t most;
} lks_studio_parameter;

/* A parameter of a built-in scene, both by number. LKS_NOT_FOUND behind the last one. */
LKS_API lks_status lks_studio_scene_parameter(uint32_t scene, uint32_t index,
                                              lks_studio_parameter* out);

/* The description of a built-in scene, terminated. */
LKS_API const char* lks_studio_scene_text(uint32_t index);

enum {
  LKS_STUDIO_PULL = 0,   /* a spring pulls a point of a body towards a place, for one tick */
  LKS_STUDIO_SPAWN = 1,  /* makes a body, which flies off with a velocity */
  LKS_STUDIO_REMOVE = 2, /* destroys a body */
  LKS_STUDIO_PUSH = 3    /* adds a velocity to a body */
};

/* An action of the person at the page: whole numbers, so that a link repeats it bit for bit. */
typedef struct lks_studio_action {
  int64_t kind;
  int64_t body;     /* pull, remove, push */
  int64_t shape;    /* spawn: LKS_SPHERE, LKS_BOX, LKS_CAPSULE, LKS_CYLINDER, LKS_CONE,
                       LKS_TAPERED_CAPSULE or LKS_ROUNDED_BOX */
  int64_t size;     /* spawn: 2^-20 m */
  int64_t point[3]; /* pull: the point in the frame of the shape, 2^-32 m */
  int64_t place[3]; /* pull: the place; spawn: the position; 2^-32 m */
  int64_t speed[3]; /* spawn, push: 2^-32 m/s */
} lks_studio_action;

/* Acts now, before the next step. */
LKS_API lks_status lks_studio_act(lks_world* world, const lks_studio_action* action);

/* Pictures --------------------------------------------------------------------------------------
 */

/* Numbers of several items, one after another. They hold until the next call. */
typedef struct lks_studio_list {
  const float* numbers;
  uint32_t count; /* of numbers */
} lks_studio_list;

enum {
  LKS_STUDIO_BODIES = 1,   /* row, DebugState, row of the island or -1, mark of the shape */
  LKS_STUDIO_BOUNDS = 2,   /* row, lower corner, upper corner */
  LKS_STUDIO_MASSES = 4,   /* row, centre, axes (three columns), kg */
  LKS_STUDIO_CONTACTS = 8, /* rows a and b, point, normal, N, separation */
  LKS_STUDIO_JOINTS = 16   /* index, rows a and b, kind, place a, place b, N, N·m */
};

/* Draws into five lists, in the order above, those whose bits are set in `wanted`. */
LKS_API lks_status lks_studio_draw(const lks_world* world, uint32_t wanted, lks_studio_list* lists);

/* Figures of a world after a step. */
typedef struct lks_studio_figures {
  double kinetic;   /* J */
  double potential; /* J, against the height 0 */
  uint32_t bodies;
  uint32_t awake; /* dynamic bodies */
  uint32_t asleep;
  uint32_t contacts; /* as the last step counted them */
  uint32_t points;
  uint32_t islands; /* of awake bodies, by contacts and joints */
  uint32_t joints;
  uint32_t reserved;
} lks_studio_figures;
LKS_API lks_status lks_studio_measure(const lks_world* world, lks_studio_figures* out);

/* Two worlds, row by row: LKS_STUDIO_DIFFERS and others, m between the places, m/s between the
 * velocities, degrees between the orientations. `differing` counts the rows. */
enum {
  LKS_STUDIO_DIFFERS = 1, /* in at least one bit of pose, velocities, mass or activity */
  LKS_STUDIO_ONLY_A = 2,
  LKS_STUDIO_ONLY_B = 4
};
LKS_API lks_status lks_studio_compare(const lks_world* a, const lks_world* b, lks_studio_list* list,
                                      uint32_t* differing);

/* Stage times -----------------------------------------------------------------------------------
 */

enum { LKS_STUDIO_STAGES = 10 }; /* of a tick: StepStage of lockstone/profile.h */

/* Begins to take the times of the world's stages by the page's clock. They are no part of its
 * state. */
LKS_API lks_status lks_studio_watch_stages(lks_world* world);

/* Microseconds that each stage took, summed over all steps since then. */
LKS_API lks_status lks_studio_stage_times(const lks_world* world, double* sums);

/* Games that run elsewhere ----------------------------------------------------------------------
 */

/* An empty world that takes the states of the one that a WorldServer
 * (lockstone/watch/world_server.h) describes by the message. */
LKS_API lks_status lks_studio_described_world(const void* bytes, size_t count, lks_world** out);

/* Logs ------------------------------------------------------------------------------------------
 */

typedef struct lks_studio_log lks_studio_log;

/* Reads a whole log into memory, and simulates nothing. LKS_UNSUPPORTED_VERSION for one that is
 * compressed: `lockstone studio` gives the page plain ones. */
LKS_API lks_status lks_studio_log_open(const void* bytes, size_t count, lks_studio_log** out);
LKS_API void lks_studio_log_close(lks_studio_log* log);

typedef struct lks_studio_log_facts {
  uint64_t seed;
  uint64_t match_id;
  uint32_t start_tick;
  uint32_t ticks; /* with a recorded hash */
  uint32_t players;
  uint32_t input_bytes;
  uint32_t tick_rate;
  uint32_t keyframes;
  uint32_t events;
  uint32_t complete; /* 1: the log's end was read */
  uint32_t arena;    /* 1: the inputs are those of the arena */
  uint32_t same_canary;
  uint32_t hashes;      /* addresses: 64 bits a tick, */
  uint32_t inputs;      /* all players' inputs a tick, */
  uint32_t origins;     /* a byte a player and tick, */
  uint32_t keyframe_at; /* 64 bits a keyframe, */
  uint32_t event_at;    /* tick, kind, slot: 32 bits each */
  uint32_t reserved;
} lks_studio_log_facts;
LKS_API lks_status lks_studio_log_describe(const lks_studio_log* log, lks_studio_log_facts* out);

enum {
  LKS_STUDIO_LOG_GAME = 0,
  LKS_STUDIO_LOG_BUILD = 1,
  LKS_STUDIO_LOG_END = 2,
  LKS_STUDIO_LOG_DAMAGE = 3,
  LKS_STUDIO_LOG_EVENT = 4 /* the text of event `index` */
};
LKS_API lks_status lks_studio_log_text(const lks_studio_log* log, uint32_t which, uint32_t index,
                                       char* text, size_t capacity);

/* The log's simulation at its start tick. LKS_INCOMPATIBLE where this build plays another one. */
LKS_API lks_status lks_studio_log_world(const lks_studio_log* log, lks_world** out);

/* Loads a keyframe of the log into its world. */
LKS_API lks_status lks_studio_log_keyframe(const lks_studio_log* log, uint32_t index,
                                           lks_world* world);

/* Steps the world with the log's inputs of its tick; `same` says whether it comes to the recorded
 * hash; null: not asked. LKS_NOT_FOUND beyond the log. */
LKS_API lks_status lks_studio_log_step(const lks_studio_log* log, lks_world* world, uint32_t* same);

#ifdef __cplusplus
}
#endif
#endif
