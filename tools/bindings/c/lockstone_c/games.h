/* Games: a table of your functions, or the built-in ones; and matches of them. */
#ifndef LOCKSTONE_C_GAMES_H
#define LOCKSTONE_C_GAMES_H

#include "world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* <lockstone/game_abi.h>: the functions of a game, as `lockstone --game` takes them too. */
struct lockstone_game_table;

typedef struct lks_game lks_game;

/* A game of your own. The table is copied; its functions and texts must outlive the game and
 * all objects made with it. LKS_UNSUPPORTED_VERSION: a table of another LOCKSTONE_GAME_ABI;
 * LKS_MALFORMED: a required function is null. */
LKS_API lks_status lks_game_create(const struct lockstone_game_table* table, lks_game** out);

/* The arena and the built-in scenes, by their configuration bytes. */
LKS_API lks_status lks_game_builtin(lks_game** out);

/* Null is allowed. Objects made with the game keep the parts of it that they need. */
LKS_API void lks_game_destroy(lks_game* game);

/* Two peers must agree on all of this before they play. */
typedef struct lks_simulation_info {
  uint64_t config_hash;
  uint64_t scene_hash;
  uint64_t canary;
  uint32_t abi;
  uint32_t tick_rate;
  uint32_t player_count;
  uint32_t input_bytes; /* of one player, for one tick */
} lks_simulation_info;

/* A match of a game. */
typedef struct lks_simulation lks_simulation;

/* At tick 0. The configuration bytes are the game's own. */
LKS_API lks_status lks_simulation_create(const lks_game* game, const void* config,
                                         size_t config_bytes, lks_simulation** out);

/* Null is allowed. A session that uses the simulation keeps it alive. */
LKS_API void lks_simulation_destroy(lks_simulation* simulation);

LKS_API lks_status lks_simulation_get_info(const lks_simulation* simulation,
                                           lks_simulation_info* out);

/* Ticks stepped. */
LKS_API lks_status lks_simulation_tick(const lks_simulation* simulation, uint64_t* out);

/* The match that the table's `create` made; null for a built-in game. Do not step it yourself. */
LKS_API lks_status lks_simulation_match(const lks_simulation* simulation, void** out);

/* The world of a match of a built-in game, to be looked at and drawn: it takes no command and is
 * not stepped, saved or loaded by itself (LKS_READ_ONLY). LKS_NOT_FOUND: the game is another. It
 * keeps the simulation alive. */
LKS_API lks_status lks_simulation_world(const lks_simulation* simulation, lks_world** out);

enum {
  LKS_INPUT_RECEIVED = 0,
  LKS_INPUT_REPEATED = 1, /* late: the player's last input was repeated */
  LKS_INPUT_NEUTRAL = 2,  /* late: all zero */
  LKS_INPUT_ABSENT = 3    /* nobody sits in this slot; all zero */
};

/* Advances by one tick. `inputs` holds the players' inputs one after another, `bytes` in all;
 * `origins`, one for each slot, may be null: all were received. LKS_READ_ONLY for the simulation
 * of a session, which steps it itself. */
LKS_API lks_status lks_simulation_step(lks_simulation* simulation, const void* inputs, size_t bytes,
                                       const uint32_t* origins);

/* A command of the next tick, from a slot or LKS_SERVER_SLOT; right before its step. */
LKS_API lks_status lks_simulation_command(lks_simulation* simulation, uint32_t slot,
                                          const void* bytes, size_t count);

/* A hash over everything that can change the future. */
LKS_API lks_status lks_simulation_hash(const lks_simulation* simulation, uint64_t* out);

/* As lks_snapshot_bytes_max, lks_save, lks_load of a world. */
LKS_API lks_status lks_simulation_snapshot_bytes_max(const lks_simulation* simulation,
                                                     uint32_t kind, size_t* out);
LKS_API lks_status lks_simulation_save(const lks_simulation* simulation, uint32_t kind, void* out,
                                       size_t capacity, size_t* bytes);
LKS_API lks_status lks_simulation_load(lks_simulation* simulation, uint32_t kind, const void* bytes,
                                       size_t count);

#ifdef __cplusplus
}
#endif
#endif
