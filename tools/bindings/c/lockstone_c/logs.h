/* Recorded matches, computed again. */
#ifndef LOCKSTONE_C_LOGS_H
#define LOCKSTONE_C_LOGS_H

#include "base.h"

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

#ifdef __cplusplus
}
#endif
#endif
