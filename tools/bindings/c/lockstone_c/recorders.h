/* Recorders write the log of a match. */
#ifndef LOCKSTONE_C_RECORDERS_H
#define LOCKSTONE_C_RECORDERS_H

#include "games.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lks_recorder lks_recorder;

typedef struct lks_recorder_def {
  uint32_t size;
  uint32_t keyframe_interval_ticks; /* 0: no keyframes but a first one that is needed */
  uint64_t match_id;
  uint64_t seed;     /* for people and tools */
  uint32_t compress; /* 1: states are compressed where the library can */
  uint32_t replace;  /* 1: an existing file is replaced */
  char build[136];   /* which program writes it; terminated */
} lks_recorder_def;
LKS_API lks_status lks_recorder_def_init(lks_recorder_def* def, size_t size);

/* Begins the log of a simulation at its tick, with its game and configuration. */
LKS_API lks_status lks_recorder_create(const lks_recorder_def* def,
                                       const lks_simulation* simulation, const char* path,
                                       lks_recorder** out);

/* The same in memory, see lks_recorder_bytes. */
LKS_API lks_status lks_recorder_create_in_memory(const lks_recorder_def* def,
                                                 const lks_simulation* simulation,
                                                 lks_recorder** out);

/* Null is allowed. A log that was not finished stays incomplete, as after a kill; it still
 * verifies. A server that records keeps the recorder alive. */
LKS_API void lks_recorder_destroy(lks_recorder* recorder);

/* Records the tick that the simulation was just stepped by, with the same arguments. */
LKS_API lks_status lks_recorder_step(lks_recorder* recorder, const void* inputs, size_t bytes,
                                     const uint32_t* origins);

/* Notes something for people at the present tick. */
LKS_API lks_status lks_recorder_note(lks_recorder* recorder, const char* text);

/* Writes the end of the log. */
LKS_API lks_status lks_recorder_finish(lks_recorder* recorder, const char* reason);

/* The log so far of a recorder in memory; `count` is its size. LKS_BUFFER_TOO_SMALL when it does
 * not fit; LKS_NOT_FOUND for one that writes a file. */
LKS_API lks_status lks_recorder_bytes(const lks_recorder* recorder, void* out, size_t capacity,
                                      size_t* count);

#ifdef __cplusplus
}
#endif
#endif
