/* Hashes and snapshots. */
#ifndef LOCKSTONE_C_STATE_H
#define LOCKSTONE_C_STATE_H

#include "world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A hash over everything that can change the future. */
LKS_API lks_status lks_hash(const lks_world* world, uint64_t* out);

/* The hash of the world and of its parts. Of a scene with players `total` is the world's alone. */
typedef struct lks_hashes {
  uint64_t total;
  uint64_t header;
  uint64_t bodies;
  uint64_t contacts;
  uint64_t joints;
} lks_hashes;
LKS_API lks_status lks_part_hashes(const lks_world* world, lks_hashes* out);

enum {
  LKS_NATIVE = 0,   /* for rollback: only for worlds of this process, as fast as a copy */
  LKS_CANONICAL = 1 /* for files and other machines: loading checks every byte */
};

/* An upper bound on the bytes that lks_save writes, constant over the world's life. */
LKS_API lks_status lks_snapshot_bytes_max(const lks_world* world, uint32_t kind, size_t* out);

/* Writes the state. LKS_BUFFER_TOO_SMALL when it does not fit. */
LKS_API lks_status lks_save(const lks_world* world, uint32_t kind, void* out, size_t capacity,
                            size_t* bytes);

/* Replaces the state. Canonical bytes may come from anywhere. Native bytes must be unchanged since
 * lks_save wrote them in this process. A built-in scene goes back to an earlier state so. */
LKS_API lks_status lks_load(lks_world* world, uint32_t kind, const void* bytes, size_t count);

/* The first difference between two canonical snapshots of this world or of one with the same
 * definition, for people: `body 17 "crate", velocity.y: …`. Writes a terminated string, and 1 to
 * `differs` or 0. The text is cut where it does not fit. */
LKS_API lks_status lks_describe_difference(const lks_world* world, const void* here,
                                           size_t here_bytes, const void* there, size_t there_bytes,
                                           uint32_t* differs, char* text, size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
