/* Types that server and client share. */
#ifndef LOCKSTONE_C_SESSIONS_H
#define LOCKSTONE_C_SESSIONS_H

#include "games.h"
#include "recorders.h"
#include "transports.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LKS_NO_SLOT 255u        /* any seat, or none yet */
#define LKS_SPECTATOR_SLOT 254u /* only watches */
#define LKS_SERVER_SLOT 253u    /* of commands: the server itself */

/* Kinds of session events; new ones may be added. `tick`, `slot`, … name the fields that are used;
 * all others are 0. */
enum {
  LKS_SESSION_STARTED = 1,       /* the match begins */
  LKS_SESSION_TICK = 2,          /* tick, hash: closed by the server, stepped by a client */
  LKS_SESSION_FINISHED = 3,      /* reason, tick: how many were played; text */
  LKS_SESSION_DESYNC = 4,        /* tick, slot, reason (verdict), hash, other_hash; text */
  LKS_SESSION_SILENT = 5,        /* slot (server), value: since how many µs nothing came */
  LKS_SESSION_JOINED = 6,        /* slot; text: the player's name (server) */
  LKS_SESSION_PLAYER_ACTIVE = 7, /* slot, tick: from then on it plays */
  LKS_SESSION_NAMED = 8,         /* slot; text: the name of its player (client) */
  LKS_SESSION_COMMAND = 9,       /* tick, slot, value: its bytes, see lks_client_event_bytes */
  /* Of a server. */
  LKS_SESSION_LEFT = 16,    /* slot, reason; text */
  LKS_SESSION_REFUSED = 17, /* reason; text */
  LKS_SESSION_ASKED = 18,   /* slot, reason (LKS_ASK_…), value: topic · 256 + choice */
  /* Of a client. */
  LKS_SESSION_STATE_LOADED = 32,   /* tick: the state after that many came from the server */
  LKS_SESSION_PAUSED = 33,         /* value: 1 paused, 0 goes on */
  LKS_SESSION_INPUT_REPLACED = 34, /* tick: this player's input came too late */
  LKS_SESSION_PREDICTED = 35,      /* tick: stepped on guesses, and possibly again */
  LKS_SESSION_ROLLED_BACK = 36,    /* tick, value: that many guessed ticks from `tick` are void */
  LKS_SESSION_COMMAND_REFUSED = 37 /* value: its number */
};

typedef struct lks_session_event {
  uint32_t kind;
  uint32_t slot;
  uint64_t tick;
  uint64_t hash;
  uint64_t other_hash;
  int64_t value;
  uint32_t reason;
  uint32_t reserved; /* 0 */
} lks_session_event;

enum { LKS_ASK_PAUSE = 0, LKS_ASK_RESUME = 1, LKS_ASK_VOTE = 2 };

/* Reasons of LKS_SESSION_FINISHED. */
enum {
  LKS_FINISH_COMPLETED = 0,
  LKS_FINISH_STOPPED = 1,
  LKS_FINISH_DESYNC = 2,
  LKS_FINISH_NO_PLAYERS = 3
};

/* Counters of a client, or of a server's player. */
typedef struct lks_session_stats {
  uint32_t size;
  int32_t margin_quarters; /* how early the newest inputs came, in quarters of a tick */
  uint64_t bytes_sent;     /* by this side, payload */
  uint64_t bytes_received;
  uint64_t packets_sent;
  uint64_t packets_received;
  int64_t round_trip_us; /* -1: unknown */
  uint64_t substituted_inputs;
  uint64_t malformed_packets;
  uint64_t hashes_compared; /* of a server's player */
  uint64_t hashes_equal;
  uint64_t rollbacks; /* of a client */
  uint64_t ticks_stepped_again;
  uint64_t states_loaded;
  uint64_t commands_taken; /* of a server's player */
  uint64_t commands_refused;
  uint64_t islands_computed_again; /* of a client, in the ticks that it stepped again */
  uint64_t islands_recalled;       /* and those that its history remembered */
  int64_t jitter_us;               /* of a client: the depth of its jitter buffer */
} lks_session_stats;

#ifdef __cplusplus
}
#endif
#endif
