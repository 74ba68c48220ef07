/* The client's side of a match: sends inputs, steps the ticks that the server closed. */
#ifndef LOCKSTONE_C_CLIENTS_H
#define LOCKSTONE_C_CLIENTS_H

#include "sessions.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lks_client lks_client;

enum {
  LKS_CLIENT_CONNECTING = 0,
  LKS_CLIENT_HANDSHAKING = 1,
  LKS_CLIENT_LOBBY = 2,   /* seated; waits for the others */
  LKS_CLIENT_JOINING = 3, /* seated in a match that runs; gets its state */
  LKS_CLIENT_RUNNING = 4,
  LKS_CLIENT_FINISHED = 5, /* the server ended the match, or this player left */
  LKS_CLIENT_REFUSED = 6,
  LKS_CLIENT_FAILED = 7
};

typedef struct lks_client_def {
  uint32_t size;
  uint32_t insecure;    /* 1 for a transport that does not encrypt; the server must say so too */
  uint32_t wanted_slot; /* LKS_NO_SLOT, LKS_SPECTATOR_SLOT or a seat */
  uint32_t prediction_ticks;       /* rollback: ticks stepped on guesses, 0 … 15; 0: lockstep */
  uint32_t prediction_delay_ticks; /* own inputs show that much later */
  uint32_t sync_test;              /* 1: roll back every tick and compare; for tests */
  uint32_t history_ticks;          /* power of two, 256 … 65536 */
  uint32_t snapshot_ticks;         /* 0 … 4096 */
  uint32_t adapt_lead;             /* 1: send inputs earlier when they come late */
  uint32_t play_out_evenly;        /* 1: keep ticks back as long as their arrival jitters */
  uint64_t rejoin_key;             /* of a former process: the same seat again */
  int64_t handshake_us;
  int64_t drop_us;
  char name[40];  /* UTF-8, at most 32 bytes, no control characters; terminated */
  char build[72]; /* of the game and the machine, for reports; terminated */
} lks_client_def;
LKS_API lks_status lks_client_def_init(lks_client_def* def, size_t size);

/* `game` makes the simulation from the configuration bytes that the server sends. */
LKS_API lks_status lks_client_create(const lks_client_def* def, const lks_game* game,
                                     lks_transport* transport, lks_connection connection,
                                     lks_client** out);

/* Null is allowed. Handles from lks_client_simulation keep the simulation alive. */
LKS_API void lks_client_destroy(lks_client* client);

/* The input of this player for each tick sampled from here on; zeros before the first call.
 * `bytes` is at most 64; a game whose inputs are longer gets zeros behind them, and one whose
 * inputs are shorter their beginning. */
LKS_API lks_status lks_client_set_input(lks_client* client, const void* input, size_t bytes);

/* Or a function that is asked for the input of each tick, from within lks_client_update, in order
 * and once each; `out` comes as the input that was set. It must not call the client. Null: none. */
typedef void (*lks_sample_function)(void* user, uint64_t tick, uint8_t* out, size_t bytes);
LKS_API lks_status lks_client_on_sample(lks_client* client, lks_sample_function sample, void* user);

/* Guesses the input of another player; `out` comes as its last known one. Null: that is the guess.
 */
typedef void (*lks_predict_function)(void* user, uint64_t tick, uint32_t slot, uint8_t* out,
                                     size_t bytes);
LKS_API lks_status lks_client_on_predict(lks_client* client, lks_predict_function predict,
                                         void* user);

/* As lks_server_update, …_events, …_event_text. */
LKS_API lks_status lks_client_update(lks_client* client, int64_t now_us);
LKS_API lks_status lks_client_events(const lks_client* client, lks_session_event* out,
                                     size_t capacity, size_t* count);
LKS_API lks_status lks_client_event_text(const lks_client* client, size_t index, char* out,
                                         size_t capacity);

/* The bytes of a command (LKS_SESSION_COMMAND). `count` is their number. */
LKS_API lks_status lks_client_event_bytes(const lks_client* client, size_t index, void* out,
                                          size_t capacity, size_t* count);

/* Gives a command: 1 … 65536 bytes, which are copied. The server binds it to a tick, at which
 * everybody's simulation gets it. `number` (may be null) is named where the server refuses it.
 * LKS_CAPACITY_EXHAUSTED: too many are on their way; LKS_NOT_FOUND: not seated. */
LKS_API lks_status lks_client_send_command(lks_client* client, const void* bytes, size_t count,
                                           uint64_t* number);

typedef struct lks_client_view {
  uint32_t size;
  uint32_t state;           /* LKS_CLIENT_… */
  uint64_t ticks_stepped;   /* closed ones */
  uint64_t ticks_predicted; /* guessed ones included */
  uint64_t rejoin_key;      /* opens the same seat again; 0 before being seated */
  uint32_t slot;            /* LKS_NO_SLOT before being seated */
  uint32_t finish_reason;
  uint32_t may_reconnect; /* 1: lks_client_reconnect may help */
  uint32_t paused;
  uint32_t waiting_mask; /* the lower half of `waiting` */
  uint32_t reserved;     /* 0 */
  uint64_t waiting;      /* bit n: the match waits for slot n */
} lks_client_view;
LKS_API lks_status lks_client_get(const lks_client* client, lks_client_view* view);

/* Why the client was refused or failed, for people; empty otherwise. */
LKS_API lks_status lks_client_reason(const lks_client* client, char* out, size_t capacity);

/* The name of a slot's player, terminated; empty where it gave none, or before the server told it.
 * Kept after the player left. 33 bytes hold every name. */
LKS_API lks_status lks_client_player_name(const lks_client* client, uint32_t slot, char* out,
                                          size_t capacity);

/* The simulation, for reading; LKS_NOT_FOUND before the server's offer was understood. */
LKS_API lks_status lks_client_simulation(const lks_client* client, lks_simulation** out);

LKS_API lks_status lks_client_stats(const lks_client* client, lks_session_stats* stats);

/* Asks the server's owner: LKS_ASK_…; topic and choice, 0 … 255, of a vote. */
LKS_API lks_status lks_client_ask(lks_client* client, uint32_t kind, uint32_t topic,
                                  uint32_t choice);

/* Goes on over a new connection of the same transport. LKS_INCOMPATIBLE: not in this state. */
LKS_API lks_status lks_client_reconnect(lks_client* client, lks_connection connection);

LKS_API lks_status lks_client_leave(lks_client* client);

/* Begins a log in memory of this client's ticks, at the present one; once, after the server's offer
 * was understood. It ends where the client loads a state, and holds keyframes only of a client that
 * does not predict. LKS_INCOMPATIBLE: the client predicts, and has stepped ticks. */
LKS_API lks_status lks_client_record(lks_client* client, const lks_recorder_def* def,
                                     lks_recorder** out);

#ifdef __cplusplus
}
#endif
#endif
