/* The library's memory and messages, in the hands of the program. */
#ifndef LOCKSTONE_C_HOOKS_H
#define LOCKSTONE_C_HOOKS_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Called from any thread. `alignment` is a power of two; null when there is no memory. `bytes` of a
 * release are those that were asked for. */
typedef void* (*lks_allocate_function)(void* user, size_t bytes, size_t alignment);
typedef void (*lks_release_function)(void* user, void* memory, size_t bytes, size_t alignment);

/* All memory that the library takes from here on comes from `allocate`; each block goes back to the
 * functions that it came from, which must therefore stay callable. Both null: the C library again.
 * LKS_UNSUPPORTED where the library was not built for it: with sanitizers, or not by GNU's linker.
 */
LKS_API lks_status lks_set_allocator(lks_allocate_function allocate, lks_release_function release,
                                     void* user);

enum { LKS_LEVEL_DEBUG = 0, LKS_LEVEL_INFO = 1, LKS_LEVEL_WARNING = 2, LKS_LEVEL_ERROR = 3 };

/* Called from any thread that uses the library. `text` is one line of UTF-8, valid for the call. */
typedef void (*lks_log_function)(void* user, uint32_t level, const char* text);

/* Messages go to `write`: calls that failed (debug), joins and leaves (info), refusals and late
 * logs (warning), states that differ (error). Null, as at first: nowhere. */
LKS_API lks_status lks_set_log(lks_log_function write, void* user);

#ifdef __cplusplus
}
#endif
#endif
