/* Recorded matches, computed again. */
#ifndef LOCKSTONE_C_LOGS_H
#define LOCKSTONE_C_LOGS_H

#include "games.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  LKS_LOG_SAME = 0,        /* every whole tick gave its recorded hash */
  LKS_LOG_DIVERGED = 1,    /* a tick gave another hash */
  LKS_LOG_CORRUPT = 2,     /* the log is damaged */
  LKS_LOG_INCOMPATIBLE = 3 /* the log is of another simulation, configuration or format */
};

typedef struct lks_log_report {
  uint32_t size;
  uint32_t outcome;
  uint64_t start_tick;
  uint64_t ticks_verified;
  uint64_t final_hash;    /* of the last verified tick */
  uint64_t diverged_tick; /* of LKS_LOG_DIVERGED: the first tick, its recorded and its own hash */
  uint64_t expected;
  uint64_t actual;
  uint32_t complete;  /* 1: the log's end was read */
  uint32_t torn_tail; /* 1: the log ends inside a chunk, as after a kill */
  char line[512];     /* for people, terminated */
} lks_log_report;

/* Re-simulates a log of the arena or of a built-in scene and compares every hash. The status says
 * whether the file could be judged, `outcome` the verdict. `report->size` must be set. */
LKS_API lks_status lks_verify_log(const char* path, lks_log_report* report);

/* The same for a log in memory. */
LKS_API lks_status lks_verify_log_bytes(const void* bytes, size_t count, lks_log_report* report);

typedef struct lks_log lks_log;

/* Opens a log. LKS_NOT_FOUND, LKS_IO_ERROR, or the damage of its header. */
LKS_API lks_status lks_log_open(const char* path, lks_log** out);

/* The same of a log in memory, which is copied. */
LKS_API lks_status lks_log_open_bytes(const void* bytes, size_t count, lks_log** out);

/* Null is allowed. */
LKS_API void lks_log_close(lks_log* log);

typedef struct lks_log_info {
  uint32_t size;
  uint32_t complete;  /* 1: the log's end was read */
  uint32_t torn_tail; /* 1: the log ends inside a chunk */
  uint32_t damaged;   /* 1: only the part before the damage is counted */
  lks_simulation_info simulation;
  uint64_t match_id;
  uint64_t seed;
  uint64_t start_tick;
  uint64_t ticks; /* with a recorded hash */
  uint64_t last_hash;
  uint64_t keyframes;
  char game[72]; /* terminated, as all texts here */
  char game_version[72];
  char build[136];
  char end_reason[264];
} lks_log_info;

/* Reads the whole log, without simulating anything. `info->size` must be set. */
LKS_API lks_status lks_log_get_info(lks_log* log, lks_log_info* info);

/* Reads the whole log for the last name of a slot's player; terminated, empty where it tells none.
 * 257 bytes hold every name. */
LKS_API lks_status lks_log_player_name(lks_log* log, uint32_t slot, char* out, size_t capacity);

/* The configuration bytes, for the game. `count` is their number. */
LKS_API lks_status lks_log_config(lks_log* log, void* out, size_t capacity, size_t* count);

/* Reads the next tick: its number, the players' inputs one after another, their origins (may be
 * null) and the hash after it. LKS_NOT_FOUND: no more whole tick; the damage where there is one.
 * LKS_BUFFER_TOO_SMALL, and the tick comes again: `bytes` is less than all inputs take. */
LKS_API lks_status lks_log_next(lks_log* log, uint64_t* tick, void* inputs, size_t bytes,
                                uint32_t* origins, uint64_t* hash);

/* The command `index`, from 0 on, of the tick that was read last: its slot and its bytes, whose
 * number is `count`. LKS_NOT_FOUND: the tick has no more. */
LKS_API lks_status lks_log_command(lks_log* log, size_t index, uint32_t* slot, void* out,
                                   size_t capacity, size_t* count);

/* The simulation at a tick: from the last keyframe before it, with the log's inputs. lks_log_next
 * goes on from there. LKS_NOT_FOUND: the log does not reach so far; LKS_INCOMPATIBLE: it is of
 * another simulation. */
LKS_API lks_status lks_log_seek(lks_log* log, const lks_game* game, uint64_t tick,
                                lks_simulation** out);

/* As lks_verify_log, for any game. */
LKS_API lks_status lks_log_verify(lks_log* log, const lks_game* game, lks_log_report* report);

typedef struct lks_bisect_report {
  uint32_t size;
  uint32_t found;     /* 1: the logs differ */
  uint64_t tick;      /* the first whose inputs or hash differ */
  uint64_t hash_here; /* after it; equal where only the inputs differ */
  uint64_t hash_there;
  uint64_t difference_tick; /* the state that `line` is about is that before this tick */
  uint32_t in_inputs;       /* 1: the inputs of the tick differ */
  uint32_t slot;            /* then: whose */
  char line[512];           /* for people: tick, body and field; terminated */
} lks_bisect_report;

/* The first tick at which two logs of one match differ, and the first field of the state that does.
 * `report->size` must be set. LKS_INCOMPATIBLE: the logs are of different matches. */
LKS_API lks_status lks_log_bisect(lks_log* here, lks_log* there, const lks_game* game,
                                  lks_bisect_report* report);

#ifdef __cplusplus
}
#endif
#endif
