/* A game as a shared library: `lockstone --game libsumo.so verify match.lks`.
 *
 * The library exports one function, lockstone_game(), which returns a table of functions of C. It
 * may be written in any language; from C++, <lockstone/game_library.h> makes the table of a
 * GameDef.
 *
 * Rules
 *  - The table, its texts and lists live as long as the process. No function of it keeps a pointer
 * that it was given, and none throws or jumps across this border.
 *  - Several matches may be used on several threads at a time, one match on one thread at a time.
 *  - Configuration bytes, canonical snapshots and inputs may come from a stranger: check, then
 * apply. Any input bytes are legal.
 *  - step, save, load and hash allocate nothing; only inputs, state and tick decide about a result.
 *  - <lockstone/simulation.h> and <lockstone/tool.h> say the same of each function at more length.
 */
#ifndef LOCKSTONE_GAME_ABI_H
#define LOCKSTONE_GAME_ABI_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this table. A tool loads games of its own number alone; new optional functions at the end do
 * not change it. */
#define LOCKSTONE_GAME_ABI 1

#define LOCKSTONE_GAME_MAX_PARTS 8
#define LOCKSTONE_GAME_TEXT_BYTES 96

#if defined(_WIN32)
#define LOCKSTONE_GAME_EXPORT __declspec(dllexport)
#else
#define LOCKSTONE_GAME_EXPORT __attribute__((visibility("default")))
#endif

/* Results of functions that can fail. */
enum lockstone_game_status {
  LOCKSTONE_GAME_OK = 0,
  LOCKSTONE_GAME_CAPACITY_EXHAUSTED = 1,
  LOCKSTONE_GAME_INVALID_ARGUMENT = 3, /* a value lies outside its range */
  LOCKSTONE_GAME_TRUNCATED = 4,        /* the bytes end too early */
  LOCKSTONE_GAME_MALFORMED = 5,        /* the bytes break their format */
  LOCKSTONE_GAME_UNSUPPORTED_VERSION =
      7,                           /* of another version of the format, or no such function */
  LOCKSTONE_GAME_INCOMPATIBLE = 8, /* of another configuration */
  LOCKSTONE_GAME_NOT_FOUND = 10    /* no scene of that name */
};

enum lockstone_game_snapshot { LOCKSTONE_GAME_NATIVE = 0, LOCKSTONE_GAME_CANONICAL = 1 };

/* SimulationInfo. */
typedef struct lockstone_game_info {
  uint64_t config_hash;
  uint64_t scene_hash;
  uint64_t canary; /* 0: none */
  uint32_t abi;
  uint16_t tick_rate;
  uint8_t player_count; /* 1 ... 64 */
  uint8_t input_bytes;  /* 1 ... 64 */
} lockstone_game_info;

/* PlayerInput; origin: 0 received, 1 repeated, 2 neutral, 3 absent. */
typedef struct lockstone_game_input {
  const uint8_t* bytes; /* info.input_bytes */
  uint32_t origin;
} lockstone_game_input;

/* PartHash: 128 bits of a part of the state; stages of a tick use `low` alone. The name is read
 * before the next call. */
typedef struct lockstone_game_hash {
  const char* name;
  uint64_t low;
  uint64_t high;
} lockstone_game_hash;

/* StateDifference; texts end with a zero. */
typedef struct lockstone_game_difference {
  uint64_t object;
  char store[LOCKSTONE_GAME_TEXT_BYTES];
  char name[LOCKSTONE_GAME_TEXT_BYTES];
  char field[LOCKSTONE_GAME_TEXT_BYTES];
  char here[LOCKSTONE_GAME_TEXT_BYTES];
  char there[LOCKSTONE_GAME_TEXT_BYTES];
} lockstone_game_difference;

/* SceneDef. */
typedef struct lockstone_game_scene {
  const char* name;
  const char* description;
  uint32_t ticks;
} lockstone_game_scene;

/* MatchRequest. */
typedef struct lockstone_game_request {
  const char* scene; /* never null; empty: the first */
  uint64_t seed;
  int64_t bodies;   /* -1: not asked for */
  uint32_t players; /* 0: the usual number */
} lockstone_game_request;

/* GameDef. The functions up to `hash` are required, all others may be null. */
typedef struct lockstone_game_table {
  uint32_t abi;   /* LOCKSTONE_GAME_ABI */
  uint32_t bytes; /* sizeof(lockstone_game_table): later members are taken for null */
  const char* name;
  const char* version;
  const char* build;

  int32_t (*create)(const uint8_t* config, size_t config_bytes, void** match);
  void (*destroy)(void* match);
  void (*info)(const void* match, lockstone_game_info* out);
  uint64_t (*tick)(const void* match);
  void (*step)(void* match, const lockstone_game_input* inputs, size_t count);
  size_t (*snapshot_bytes_max)(const void* match, uint32_t kind);
  size_t (*save)(const void* match, uint32_t kind, uint8_t* out, size_t capacity);
  int32_t (*load)(void* match, uint32_t kind, const uint8_t* bytes, size_t size);
  uint64_t (*hash)(const void* match);

  /* Writes at most LOCKSTONE_GAME_MAX_PARTS, returns their number. */
  size_t (*part_hashes)(const void* match, lockstone_game_hash* out);
  /* Returns 1 and the first difference of two canonical snapshots, or 0. */
  int32_t (*describe)(const void* match, const uint8_t* here, size_t here_bytes,
                      const uint8_t* there, size_t there_bytes, lockstone_game_difference* out);
  /* Writes the configuration bytes of a match. `*size` holds the capacity, then the bytes written.
   */
  int32_t (*configure)(const lockstone_game_request* request, uint8_t* out, size_t* size);
  /* Returns 1 and a bot's input (info.input_bytes, zeros so far), or 0: nobody plays this slot. */
  int32_t (*bot)(const void* match, uint64_t seed, uint32_t slot, uint64_t tick, uint8_t* out);
  /* As step, with the hashes after the stages of the tick; returns their number, at most
   * `capacity`. */
  size_t (*step_traced)(void* match, const lockstone_game_input* inputs, size_t count,
                        lockstone_game_hash* out, size_t capacity);
  /* A picture as SVG: returns its bytes, and writes them when they fit. */
  size_t (*draw)(const void* match, char* out, size_t capacity);

  const lockstone_game_scene* scenes;
  size_t scene_count;

  /* Simulation::keep_history and forget_history: remembers the last `ticks` ticks, so that stepping
   * them again costs as much as differs; no result depends on it. keep_history may allocate. A
   * client that predicts calls them. */
  void (*keep_history)(void* match, uint32_t ticks);
  void (*forget_history)(void* match);

  /* Simulation::command: a command of the next tick, right before its step. `slot` is a player's,
   * or 253: the server's own. `size` is 1 ... 65536. Any bytes are legal. */
  void (*command)(void* match, uint32_t slot, const uint8_t* bytes, size_t size);
} lockstone_game_table;

/* The one symbol of the library. */
LOCKSTONE_GAME_EXPORT const lockstone_game_table* lockstone_game(void);

/* In lockstone::tool, for a program that is the tool of this one game: runs the command that the
 * arguments name, and returns the exit code. See lockstone::tool_main. */
int lockstone_tool_main(int argc, char** argv, const lockstone_game_table* table);

#ifdef __cplusplus
}
#endif

#endif
