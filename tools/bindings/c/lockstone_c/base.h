/* Versions, status codes and messages. */
#ifndef LOCKSTONE_C_BASE_H
#define LOCKSTONE_C_BASE_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(LKS_BUILDS_LIBRARY)
#define LKS_API __declspec(dllexport)
#elif defined(_WIN32)
#define LKS_API __declspec(dllimport)
#elif defined(__GNUC__)
#define LKS_API __attribute__((visibility("default")))
#else
#define LKS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The number of this interface. It changes when a program that was compiled with an older header
 * can no longer use the library; the library's SONAME has the same number. */
#define LKS_C_ABI 0

/* Outcome of a call. Values never change; new ones may be added. */
typedef int32_t lks_status;
enum {
  LKS_OK = 0,
  LKS_CAPACITY_EXHAUSTED = 1,  /* a store of the world is full; nothing was changed */
  LKS_STALE_HANDLE = 2,        /* the body or joint does not exist, or no longer */
  LKS_INVALID_ARGUMENT = 3,    /* a value lies outside its documented range */
  LKS_TRUNCATED = 4,           /* the bytes end too early */
  LKS_MALFORMED = 5,           /* the bytes break their format */
  LKS_CHECKSUM_MISMATCH = 6,   /* the bytes were damaged */
  LKS_UNSUPPORTED_VERSION = 7, /* the bytes are of another format version */
  LKS_INCOMPATIBLE = 8,        /* the bytes belong to another configuration */
  LKS_IO_ERROR = 9,            /* the operating system refused to read or write */
  LKS_NOT_FOUND = 10,          /* the named thing does not exist */
  LKS_NULL_ARGUMENT = 64,      /* a pointer is null that must not be */
  LKS_WRONG_SIZE = 65,         /* `size` is not that of a structure this library knows */
  LKS_BUFFER_TOO_SMALL = 66,   /* the `count` or `bytes` written to `out` says how much is needed */
  LKS_READ_ONLY = 67,          /* a built-in scene plays by itself: it takes no command */
  LKS_OUT_OF_MEMORY = 68,
  LKS_INTERNAL = 69,   /* a fault of the library; please report it */
  LKS_UNSUPPORTED = 70 /* the library was built without it */
};

/* "stale handle", …; "unknown status" for other values. Never null. */
LKS_API const char* lks_status_name(lks_status status);

/* Why the last call on this thread failed that did: "body.shape.radius: 0 m, must be 0.000977 …
 * 512 m". UTF-8, for people: the text may change. Valid until the next failing call on this thread;
 * empty before the first. Never null. */
LKS_API const char* lks_last_error(void);

/* LKS_C_ABI of the library, to be compared with that of the header. */
LKS_API uint32_t lks_c_abi(void);

/* "0.1.0". */
LKS_API const char* lks_version(void);

/* Changes whenever the same commands may give another state: peers of a match must agree on it. */
LKS_API uint32_t lks_simulation_abi(void);

/* This build's hash of a short built-in scene. Peers must agree on it too. */
LKS_API uint64_t lks_canary_hash(void);

#ifdef __cplusplus
}
#endif
#endif
