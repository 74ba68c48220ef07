/* Functions for matches in a browser, besides the C interface: bots, and a fault for tests. */
#ifndef LOCKSTONE_WEB_SESSION_H
#define LOCKSTONE_WEB_SESSION_H

#include "lockstone_c/games.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The input that the bot of `lockstone join` would press in this slot of the arena now; `bytes` is its
 * size. LKS_NOT_FOUND: the match is another game's. */
LKS_API lks_status lks_web_bot(const lks_simulation* simulation, uint64_t seed, uint32_t slot,
                               void* out, size_t capacity, size_t* bytes);

/* For tests of the comparison of states: changes the lowest bit of a position in the arena.
 * LKS_NOT_FOUND: there is no body that moves. */
LKS_API lks_status lks_web_flip(const lks_simulation* simulation);

#ifdef __cplusplus
}
#endif
#endif
