/* The server's side of a match: seats the players, closes tick after tick, compares states. */
#ifndef LOCKSTONE_C_SERVERS_H
#define LOCKSTONE_C_SERVERS_H

#include "sessions.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lks_server lks_server;

enum {
  LKS_SERVER_LOBBY = 0, /* waits for all players */
  LKS_SERVER_RUNNING = 1,
  LKS_SERVER_FINISHING = 2, /* all ticks closed; waits for the last hashes */
  LKS_SERVER_CLOSING = 3,
  LKS_SERVER_OVER = 4 /* nothing more will happen */
};

enum { LKS_LATE_DEADLINE = 0, LKS_LATE_STRICT = 1 }; /* replace a late input, or wait for it */
enum { LKS_SUBSTITUTE_REPEAT = 0, LKS_SUBSTITUTE_NEUTRAL = 1 };
enum { LKS_PACING_REAL_TIME = 0, LKS_PACING_FAST = 1 }; /* fast: as the inputs come */
enum { LKS_DESYNC_END = 0, LKS_DESYNC_KICK = 1, LKS_DESYNC_RESYNC = 2 };

typedef struct lks_server_def {
  uint32_t size;
  uint32_t insecure;          /* 1, and only then, for a transport that does not encrypt */
  uint32_t relay;             /* 1: does not simulate; the majority of the players judges states */
  uint32_t input_delay_ticks; /* 0 … 60 */
  uint32_t late_policy;
  uint32_t substitute;
  uint32_t pacing;
  uint32_t desync_policy;
  uint32_t history_ticks;  /* power of two, 256 … 65536 */
  uint32_t snapshot_ticks; /* 0 … 4096 */
  uint32_t late_join;      /* 1: a seat may be taken while the match runs */
  uint32_t start_players;  /* the match begins with this many; 0: with all */
  uint32_t max_spectators; /* 0 … 256 */
  uint32_t spectator_delay_ticks;
  uint64_t tick_count;               /* ticks to play; 0: until lks_server_stop */
  uint64_t rejoin_seed;              /* random bits: who guesses a key of it gets the seat */
  int64_t drop_us;                   /* a peer that is silent so long is gone */
  int64_t rejoin_us;                 /* so long a lost player's seat is kept */
  uint32_t command_bytes_max;        /* of one command of a player; 0: none are taken */
  uint32_t commands_per_second;      /* of each player; twice as many at once; 0: no limit */
  uint32_t command_bytes_per_second; /* likewise */
  uint32_t reserved;                 /* 0 */
} lks_server_def;
LKS_API lks_status lks_server_def_init(lks_server_def* def, size_t size);

/* The server steps `simulation`, which must stand at tick 0, and sends its configuration bytes to
 * the clients. Afterwards the simulation is for reading. */
LKS_API lks_status lks_server_create(const lks_server_def* def, lks_simulation* simulation,
                                     lks_transport* transport, lks_server** out);

/* Null is allowed. */
LKS_API void lks_server_destroy(lks_server* server);

/* Does all that is due; call it at least once a tick. `now_us` is 0 or above and never runs
 * backwards. Never blocks. LKS_IO_ERROR: the log could not be written; the match goes on. */
LKS_API lks_status lks_server_update(lks_server* server, int64_t now_us);

/* The events of the last update; `count` is their number. LKS_BUFFER_TOO_SMALL, with the first
 * `capacity` written, when that is more. */
LKS_API lks_status lks_server_events(const lks_server* server, lks_session_event* out,
                                     size_t capacity, size_t* count);

/* The text of one of them, for people: terminated, cut to the capacity. LKS_NOT_FOUND: no such
 * event. */
LKS_API lks_status lks_server_event_text(const lks_server* server, size_t index, char* out,
                                         size_t capacity);

/* As lks_client_event_bytes. */
LKS_API lks_status lks_server_event_bytes(const lks_server* server, size_t index, void* out,
                                          size_t capacity, size_t* count);

/* A command of the server's own, from LKS_SERVER_SLOT: as lks_client_send_command. */
LKS_API lks_status lks_server_send_command(lks_server* server, const void* bytes, size_t count);

/* From the next tick on each tick is written to this log, joins and leaves too. The log must be of
 * the server's simulation and stand at its tick. Not for a relay. */
LKS_API lks_status lks_server_record(lks_server* server, lks_recorder* recorder);

/* Ends the match after the ticks closed so far. */
LKS_API lks_status lks_server_stop(lks_server* server);

/* 1: no ticks close until 0. */
LKS_API lks_status lks_server_pause(lks_server* server, uint32_t paused);

typedef struct lks_server_view {
  uint32_t size;
  uint32_t state; /* LKS_SERVER_… */
  uint64_t ticks_closed;
  uint32_t finish_reason; /* from LKS_SERVER_CLOSING on */
  uint32_t present_mask;  /* the lower halves of `present` and `waiting` */
  uint32_t waiting_mask;
  uint32_t spectators;
  uint32_t paused;
  uint32_t reserved; /* 0 */
  uint64_t present;  /* bit n: slot n is seated */
  uint64_t waiting;  /* bit n: the match waits for slot n */
} lks_server_view;
LKS_API lks_status lks_server_get(const lks_server* server, lks_server_view* view);

/* As lks_client_player_name. */
LKS_API lks_status lks_server_player_name(const lks_server* server, uint32_t slot, char* out,
                                          size_t capacity);

/* Kept after the player left. */
LKS_API lks_status lks_server_stats(const lks_server* server, uint32_t slot,
                                    lks_session_stats* stats);

#ifdef __cplusplus
}
#endif
#endif
