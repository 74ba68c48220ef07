/* Transports carry the packets of a session: UDP by ENet, a WebSocket of the program's, or a network
 * within the process. */
#ifndef LOCKSTONE_C_TRANSPORTS_H
#define LOCKSTONE_C_TRANSPORTS_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Used by one thread, with the one session that it carries. */
typedef struct lks_transport lks_transport;

/* Names one connection of one transport; 0 is none. */
typedef uint32_t lks_connection;

/* Null is allowed. A session keeps its transport alive. */
LKS_API void lks_transport_destroy(lks_transport* transport);

/* Settings of a UDP socket that others call. */
typedef struct lks_enet_def {
  uint32_t size;
  uint32_t port;                        /* 0: the system chooses, see lks_enet_port */
  uint32_t max_connections;             /* 1 … 4095 */
  uint32_t max_connections_per_address; /* players behind one router share an address */
  uint32_t
      unlimited; /* 1: no limits on a peer's traffic, for a match that runs as fast as it can */
  uint32_t timeout_ms;
  uint64_t match_id; /* of the tokens, where `key` is given */
} lks_enet_def;
LKS_API lks_status lks_enet_def_init(lks_enet_def* def, size_t size);

/* LKS_UNSUPPORTED where the library was built without ENet, for this and the functions below.
 * `address` is numeric, IPv4 or IPv6; "::" stands for all addresses. `key` is the backend's key of
 * 32 bytes for an encrypted match, whose session must go by the clock of lks_now_us; null: the
 * match is insecure. */
LKS_API lks_status lks_enet_listen(const lks_enet_def* def, const char* address, const void* key,
                                   lks_transport** out);

/* A socket that calls a server, at a numeric address, and the connection for the session. */
LKS_API lks_status lks_enet_connect(const char* address, uint32_t port, lks_transport** out,
                                    lks_connection* connection);

/* The same with the text of a token, which also names the servers: encrypted. */
LKS_API lks_status lks_enet_join(const char* token, lks_transport** out,
                                 lks_connection* connection);

/* Calls again, after the connection was lost: see lks_client_reconnect. */
LKS_API lks_status lks_enet_connect_again(lks_transport* transport, lks_connection* connection);

/* The UDP port of this side. */
LKS_API lks_status lks_enet_port(const lks_transport* transport, uint32_t* out);

/* Sleeps until a datagram has come, at most `limit_us`. For a loop that has nothing else to do. */
LKS_API lks_status lks_enet_wait(lks_transport* transport, int64_t limit_us);

/* A token for one seat of one match, from the backend's key of 32 bytes. `address` and `port` are
 * the server's. Writes a terminated text; LKS_BUFFER_TOO_SMALL when it does not fit: 1,029 bytes
 * are always enough. */
LKS_API lks_status lks_issue_token(const void* key, uint64_t match_id, uint64_t player, uint32_t slot,
                                   uint64_t expires_unix_s, const char* address, uint32_t port,
                                   char* out, size_t capacity);

/* A client's end whose packets the program carries itself, as messages of a WebSocket that it has
 * opened with the subprotocol "lockstone": in a browser, which lets nobody else open one. `token`: its
 * text, for an encrypted match; null: insecure. */
LKS_API lks_status lks_carried_create(const char* token, lks_transport** out);

/* A new connection for the session; a former one has ended. Open a WebSocket for it. */
LKS_API lks_status lks_carried_call(lks_transport* transport, lks_connection* connection);

/* The WebSocket is open. */
LKS_API lks_status lks_carried_opened(lks_transport* transport);

/* A binary message came. LKS_MALFORMED: it breaks the format, or too much waits for lks_client_update:
 * close the WebSocket. */
LKS_API lks_status lks_carried_receive(lks_transport* transport, const void* message, size_t bytes);

/* The next message to send. `bytes` is 0 when there is none; LKS_BUFFER_TOO_SMALL when it is longer
 * than the capacity: 49,217 bytes are always enough. */
LKS_API lks_status lks_carried_take(lks_transport* transport, void* out, size_t capacity,
                                    size_t* bytes);

/* The WebSocket was closed, with this code. */
LKS_API lks_status lks_carried_closed(lks_transport* transport, uint32_t code);

/* 0 once the connection has ended: when all messages are taken, close its WebSocket. */
LKS_API lks_status lks_carried_is_open(const lks_transport* transport, uint32_t* out);

/* A network within the process, in the sessions' own time: the same calls give the same packets. */
typedef struct lks_network lks_network;

/* Faults of a link, in both directions. */
typedef struct lks_link_faults {
  uint32_t size;
  uint32_t loss_ppm; /* of a million packets */
  uint32_t duplicate_ppm;
  uint32_t reorder_ppm;
  int64_t delay_us; /* one way */
  int64_t jitter_us;
} lks_link_faults;

LKS_API lks_status lks_network_create(uint64_t seed, lks_network** out);

/* Null is allowed. Its transports keep the network alive. */
LKS_API void lks_network_destroy(lks_network* network);

/* A new end of the network. One thread uses all of them. */
LKS_API lks_status lks_network_add(lks_network* network, lks_transport** out);

/* Connects a client's end to a server's. `faults` may be null: none. */
LKS_API lks_status lks_network_connect(lks_network* network, lks_transport* from, lks_transport* to,
                                       const lks_link_faults* faults, lks_connection* connection);

/* Microseconds of a clock that never runs backwards, for the sessions' `update`. */
LKS_API int64_t lks_now_us(void);

#ifdef __cplusplus
}
#endif
#endif
