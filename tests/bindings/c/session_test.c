/* Games, sessions, recorders and logs from C, in one process: `session_test NAME` runs one test. */
#include <inttypes.h>
#include <lockstone.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

/* tools/examples/pushers: one byte of configuration, the number of players; two bytes of input. */
const struct lockstone_game_table* lockstone_game(void);

enum { PLAYERS = 2, TICKS = 240, MAX_EVENTS = 4096 };

static lks_game* make_game(void) {
  lks_game* game = NULL;
  OK(lks_game_create(lockstone_game(), &game));
  return game;
}

static lks_simulation* make_simulation(const lks_game* game) {
  const uint8_t players = PLAYERS;
  lks_simulation* simulation = NULL;
  OK(lks_simulation_create(game, &players, 1, &simulation));
  return simulation;
}

static void press(void* user, uint64_t tick, uint8_t* out, size_t bytes) {
  const uint64_t seed = *(const uint64_t*)user;
  size_t i;
  for (i = 0; i < bytes; ++i)
    out[i] = (uint8_t)((tick / 4) * 31 * seed + i * 17);
}

/* A match over a network within the process: a server that records, and players. */
typedef struct match {
  lks_game* game;
  lks_network* network;
  lks_transport* ends[1 + PLAYERS];
  lks_simulation* simulation;
  lks_server* server;
  lks_recorder* recorder;
  lks_client* clients[PLAYERS];
  uint64_t seeds[PLAYERS];
  uint64_t hashes[1 + PLAYERS][TICKS];
  uint64_t ticks[1 + PLAYERS];
  int64_t now_us;
} match;

static void add_server(match* m) {
  lks_server_def def;
  lks_recorder_def log;
  OK(lks_server_def_init(&def, sizeof def));
  def.insecure = 1;
  def.tick_count = TICKS;
  OK(lks_network_add(m->network, &m->ends[0]));
  m->simulation = make_simulation(m->game);
  OK(lks_server_create(&def, m->simulation, m->ends[0], &m->server));
  OK(lks_recorder_def_init(&log, sizeof log));
  log.match_id = 7;
  log.keyframe_interval_ticks = 60;
  strcpy(log.build, "session_test");
  OK(lks_recorder_create_in_memory(&log, m->simulation, &m->recorder));
  OK(lks_server_record(m->server, m->recorder));
}

static void add_client(match* m, uint32_t slot, uint32_t prediction) {
  lks_link_faults faults = {.size = sizeof faults, .loss_ppm = 50000, .delay_us = 30000};
  lks_connection connection = 0;
  lks_client_def def;
  OK(lks_client_def_init(&def, sizeof def));
  def.insecure = 1;
  def.wanted_slot = slot;
  def.prediction_ticks = prediction;
  strcpy(def.name, "player");
  OK(lks_network_add(m->network, &m->ends[1 + slot]));
  OK(lks_network_connect(m->network, m->ends[1 + slot], m->ends[0], &faults, &connection));
  OK(lks_client_create(&def, m->game, m->ends[1 + slot], connection, &m->clients[slot]));
  m->seeds[slot] = slot + 1;
  OK(lks_client_on_sample(m->clients[slot], press, &m->seeds[slot]));
}

static match* make_match(void) {
  match* m = calloc(1, sizeof *m);
  if (m == NULL) abort();
  m->game = make_game();
  OK(lks_network_create(5, &m->network));
  add_server(m);
  add_client(m, 0, 0);
  add_client(m, 1, 8);
  return m;
}

static void keep(match* m, size_t peer, const lks_session_event* events, size_t count) {
  size_t i;
  for (i = 0; i < count; ++i) {
    if (events[i].kind != LKS_SESSION_TICK) continue;
    CHECK(events[i].tick == m->ticks[peer]);
    if (m->ticks[peer] < TICKS) m->hashes[peer][m->ticks[peer]++] = events[i].hash;
  }
}

static uint32_t advance(match* m) {
  static lks_session_event events[MAX_EVENTS];
  lks_server_view view = {.size = sizeof view};
  size_t count = 0;
  uint32_t slot;
  m->now_us += 4000;
  OK(lks_server_update(m->server, m->now_us));
  OK(lks_server_events(m->server, events, MAX_EVENTS, &count));
  keep(m, 0, events, count);
  for (slot = 0; slot < PLAYERS; ++slot) {
    OK(lks_client_update(m->clients[slot], m->now_us));
    OK(lks_client_events(m->clients[slot], events, MAX_EVENTS, &count));
    keep(m, 1 + slot, events, count);
  }
  OK(lks_server_get(m->server, &view));
  return view.state;
}

/* In an order that a garbage collector might choose: the ends first. */
static void end_match(match* m) {
  uint32_t i;
  lks_network_destroy(m->network);
  for (i = 0; i < 1 + PLAYERS; ++i)
    lks_transport_destroy(m->ends[i]);
  lks_game_destroy(m->game);
  lks_simulation_destroy(m->simulation);
  for (i = 0; i < PLAYERS; ++i)
    lks_client_destroy(m->clients[i]);
  lks_server_destroy(m->server);
  lks_recorder_destroy(m->recorder);
  free(m);
}

static void play(match* m) {
  int updates = 0;
  while (advance(m) != LKS_SERVER_OVER && ++updates < 10000) {
  }
  OK(lks_recorder_finish(m->recorder, "over"));
}

static lks_log* open_log(const match* m) {
  static uint8_t bytes[1 << 20];
  size_t count = 0;
  lks_log* log = NULL;
  OK(lks_recorder_bytes(m->recorder, bytes, sizeof bytes, &count));
  OK(lks_log_open_bytes(bytes, count, &log));
  return log;
}

static void all_peers_have_equal_hashes_at_every_tick(void) {
  match* m = make_match();
  lks_client_view view = {.size = sizeof view};
  lks_session_stats stats = {.size = sizeof stats};
  uint32_t peer, slot;
  play(m);
  for (peer = 0; peer < 1 + PLAYERS; ++peer) {
    CHECK(m->ticks[peer] == TICKS);
    CHECK(memcmp(m->hashes[peer], m->hashes[0], sizeof m->hashes[0]) == 0);
  }
  for (slot = 0; slot < PLAYERS; ++slot) {
    OK(lks_client_get(m->clients[slot], &view));
    CHECK(view.state == LKS_CLIENT_FINISHED && view.ticks_stepped == TICKS && view.slot == slot);
    OK(lks_server_stats(m->server, slot, &stats));
    CHECK(stats.hashes_equal == stats.hashes_compared && stats.hashes_equal > TICKS / 2);
  }
  OK(lks_client_stats(m->clients[1], &stats));
  CHECK(stats.rollbacks > 0 && stats.ticks_stepped_again > 0);
  end_match(m);
}

static void the_servers_log_verifies_and_is_read_tick_by_tick(void) {
  match* m = make_match();
  lks_log_info info = {.size = sizeof info};
  lks_log_report report = {.size = sizeof report};
  uint8_t inputs[2 * PLAYERS], config = 0;
  uint32_t origins[PLAYERS];
  uint64_t tick = 0, hash = 0, expected;
  size_t count = 0;
  lks_log* log;
  play(m);
  log = open_log(m);
  OK(lks_log_get_info(log, &info));
  CHECK(info.complete == 1 && info.ticks == TICKS && info.match_id == 7);
  CHECK(info.simulation.player_count == PLAYERS && info.simulation.input_bytes == 2);
  CHECK(strcmp(info.game, "pushers") == 0 && strcmp(info.build, "session_test") == 0);
  CHECK(strcmp(info.end_reason, "over") == 0);
  OK(lks_log_config(log, &config, 1, &count));
  CHECK(count == 1 && config == PLAYERS);
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_log_next(log, &tick, inputs, 1, origins, &hash));
  for (expected = 0; expected < TICKS; ++expected) {
    OK(lks_log_next(log, &tick, inputs, sizeof inputs, origins, &hash));
    CHECK(tick == expected && hash == m->hashes[0][expected]);
  }
  REFUSED(LKS_NOT_FOUND, lks_log_next(log, &tick, inputs, sizeof inputs, origins, &hash));
  OK(lks_log_verify(log, m->game, &report));
  CHECK(report.outcome == LKS_LOG_SAME && report.ticks_verified == TICKS);
  CHECK(report.final_hash == m->hashes[0][TICKS - 1]);
  lks_log_close(log);
  end_match(m);
}

static void a_log_is_sought_to_any_tick(void) {
  match* m = make_match();
  lks_simulation* simulation = NULL;
  uint64_t tick = 0, hash = 0;
  uint8_t inputs[2 * PLAYERS];
  lks_log* log;
  play(m);
  log = open_log(m);
  OK(lks_log_seek(log, m->game, 100, &simulation));
  OK(lks_simulation_hash(simulation, &hash));
  CHECK(hash == m->hashes[0][99]);
  OK(lks_log_next(log, &tick, inputs, sizeof inputs, NULL, &hash));
  CHECK(tick == 100 && hash == m->hashes[0][100]);
  OK(lks_simulation_step(simulation, inputs, sizeof inputs, NULL));
  REFUSED(LKS_NOT_FOUND, lks_log_seek(log, m->game, TICKS + 1, &simulation));
  lks_simulation_destroy(simulation);
  lks_log_close(log);
  end_match(m);
}

/* One match twice, with another push at tick 90 the second time. */
static lks_log* record_with_a_push(const lks_game* game, uint8_t push) {
  static uint8_t bytes[1 << 20];
  lks_simulation* simulation = make_simulation(game);
  lks_recorder* recorder = NULL;
  lks_recorder_def def;
  lks_log* log = NULL;
  size_t count = 0;
  int tick;
  OK(lks_recorder_def_init(&def, sizeof def));
  OK(lks_recorder_create_in_memory(&def, simulation, &recorder));
  for (tick = 0; tick < 120; ++tick) {
    const uint8_t inputs[2 * PLAYERS] = {10, 0, tick == 90 ? push : 1, 0};
    OK(lks_simulation_step(simulation, inputs, sizeof inputs, NULL));
    OK(lks_recorder_step(recorder, inputs, sizeof inputs, NULL));
    if (tick == 60) OK(lks_recorder_note(recorder, "half of it"));
  }
  OK(lks_recorder_finish(recorder, "enough"));
  OK(lks_recorder_bytes(recorder, bytes, sizeof bytes, &count));
  OK(lks_log_open_bytes(bytes, count, &log));
  lks_recorder_destroy(recorder);
  lks_simulation_destroy(simulation);
  return log;
}

static void logs_that_differ_are_bisected(void) {
  lks_game* game = make_game();
  lks_log* here = record_with_a_push(game, 1);
  lks_log* there = record_with_a_push(game, 100);
  lks_bisect_report report = {.size = sizeof report};
  OK(lks_log_bisect(here, here, game, &report));
  CHECK(report.found == 0);
  report.size = sizeof report;
  OK(lks_log_bisect(here, there, game, &report));
  CHECK(report.found == 1 && report.tick == 90 && report.in_inputs == 1 && report.slot == 1);
  CHECK(report.hash_here != report.hash_there && report.difference_tick == 91);
  CHECK(strstr(report.line, "inputs of player 1") && strstr(report.line, "position.x"));
  lks_log_close(here);
  lks_log_close(there);
  lks_game_destroy(game);
}

static void a_damaged_log_is_corrupt(void) {
  static uint8_t bytes[1 << 20];
  match* m = make_match();
  lks_log_report report = {.size = sizeof report};
  lks_log* log = NULL;
  size_t count = 0;
  play(m);
  OK(lks_recorder_bytes(m->recorder, bytes, sizeof bytes, &count));
  bytes[count / 2] ^= 1;
  OK(lks_log_open_bytes(bytes, count, &log));
  OK(lks_log_verify(log, m->game, &report));
  CHECK(report.outcome == LKS_LOG_CORRUPT);
  lks_log_close(log);
  bytes[1] ^= 1;
  CHECK(lks_log_open_bytes(bytes, count, &log) != LKS_OK && strlen(lks_last_error()) > 0);
  end_match(m);
}

static void a_sessions_simulation_is_for_reading(void) {
  match* m = make_match();
  const uint8_t inputs[2 * PLAYERS] = {0};
  lks_simulation* view = NULL;
  lks_server* second = NULL;
  lks_server_def def;
  void* own = NULL;
  uint64_t tick = 0;
  REFUSED(LKS_READ_ONLY, lks_simulation_step(m->simulation, inputs, sizeof inputs, NULL));
  REFUSED(LKS_NOT_FOUND, lks_client_simulation(m->clients[0], &view));
  OK(lks_server_def_init(&def, sizeof def));
  REFUSED(LKS_INVALID_ARGUMENT, lks_server_create(&def, m->simulation, m->ends[0], &second));
  play(m);
  OK(lks_client_simulation(m->clients[0], &view));
  REFUSED(LKS_READ_ONLY, lks_simulation_step(view, inputs, sizeof inputs, NULL));
  OK(lks_simulation_match(view, &own));
  CHECK(own != NULL);
  end_match(m);
  OK(lks_simulation_tick(view, &tick)); /* it outlives its client */
  CHECK(tick == TICKS);
  lks_simulation_destroy(view);
}

static void a_session_that_cannot_be_made_says_why(void) {
  match* m = make_match();
  lks_simulation* simulation = make_simulation(m->game);
  lks_transport* end = NULL;
  lks_server* server = NULL;
  lks_server_def def;
  const uint8_t nobody = 0;
  lks_simulation* none = NULL;
  OK(lks_network_add(m->network, &end));
  OK(lks_server_def_init(&def, sizeof def));
  REFUSED(LKS_INVALID_ARGUMENT, lks_server_create(&def, simulation, end, &server));
  CHECK(strstr(lks_last_error(), "insecure") != NULL);
  def.insecure = 1;
  def.input_delay_ticks = 61;
  REFUSED(LKS_INVALID_ARGUMENT, lks_server_create(&def, simulation, end, &server));
  def.input_delay_ticks = 300;
  REFUSED(LKS_INVALID_ARGUMENT, lks_server_create(&def, simulation, end, &server));
  def.input_delay_ticks = 4;
  OK(lks_server_create(&def, simulation, end, &server));
  REFUSED(LKS_INVALID_ARGUMENT, lks_server_record(server, m->recorder));
  REFUSED(LKS_INVALID_ARGUMENT, lks_simulation_create(m->game, &nobody, 1, &none));
  CHECK(strstr(lks_last_error(), "refuses the configuration") != NULL);
  lks_server_destroy(server);
  lks_transport_destroy(end);
  lks_simulation_destroy(simulation);
  end_match(m);
}

static void a_relay_leaves_the_states_to_the_players(void) {
  match* m = calloc(1, sizeof *m);
  lks_server_def def;
  lks_session_stats stats = {.size = sizeof stats};
  int updates = 0;
  if (m == NULL) abort();
  m->game = make_game();
  OK(lks_network_create(9, &m->network));
  OK(lks_network_add(m->network, &m->ends[0]));
  OK(lks_server_def_init(&def, sizeof def));
  def.insecure = 1;
  def.relay = 1;
  def.tick_count = TICKS;
  m->simulation = make_simulation(m->game);
  OK(lks_server_create(&def, m->simulation, m->ends[0], &m->server));
  add_client(m, 0, 0);
  add_client(m, 1, 4);
  while (advance(m) != LKS_SERVER_OVER && ++updates < 10000) {
  }
  CHECK(m->ticks[1] == TICKS && m->ticks[2] == TICKS && m->hashes[0][0] == 0);
  CHECK(memcmp(m->hashes[1], m->hashes[2], sizeof m->hashes[1]) == 0);
  OK(lks_server_stats(m->server, 0, &stats));
  CHECK(stats.hashes_equal == stats.hashes_compared);
  end_match(m);
}

/* Over UDP in this process; left out of builds without ENet or libsodium. */
static void a_token_opens_a_seat_of_an_encrypted_match(void) {
  static const char key[] = "0123456789abcdef0123456789abcdef";
  lks_enet_def socket;
  lks_server_def server_def;
  lks_client_def client_def;
  lks_server_view view = {.size = sizeof view};
  lks_client_view seat = {.size = sizeof seat};
  lks_game* game = make_game();
  const uint8_t players = 1;
  lks_simulation* simulation = NULL;
  lks_transport *listening = NULL, *calling = NULL;
  lks_connection connection = 0, again = 0;
  lks_server* server = NULL;
  lks_client* client = NULL;
  uint32_t port = 0;
  char token[1029];
  int64_t begin = lks_now_us();
  lks_status status = lks_enet_def_init(&socket, sizeof socket);
  if (status == LKS_OK) {
    socket.match_id = 42;
    status = lks_enet_listen(&socket, "127.0.0.1", key, &listening);
  }
  if (status == LKS_UNSUPPORTED) return;
  OK(status);
  OK(lks_enet_port(listening, &port));
  OK(lks_issue_token(key, 42, 1000, 0, 4000000000U, "127.0.0.1", port, token, sizeof token));
  REFUSED(LKS_BUFFER_TOO_SMALL,
          lks_issue_token(key, 42, 1, 0, 4000000000U, "127.0.0.1", port, token, 1028));
  OK(lks_enet_join(token, &calling, &connection));
  OK(lks_simulation_create(game, &players, 1, &simulation));
  OK(lks_server_def_init(&server_def, sizeof server_def));
  server_def.tick_count = 30;
  server_def.pacing = LKS_PACING_FAST;
  OK(lks_server_create(&server_def, simulation, listening, &server));
  OK(lks_client_def_init(&client_def, sizeof client_def));
  OK(lks_client_create(&client_def, game, calling, connection, &client));
  do {
    OK(lks_server_update(server, lks_now_us()));
    OK(lks_client_update(client, lks_now_us()));
    OK(lks_enet_wait(calling, 1000));
    OK(lks_server_get(server, &view));
  } while (view.state != LKS_SERVER_OVER && lks_now_us() - begin < 20000000);
  OK(lks_client_get(client, &seat));
  CHECK(view.finish_reason == LKS_FINISH_COMPLETED && seat.ticks_stepped == 30);
  REFUSED(LKS_INCOMPATIBLE, lks_client_reconnect(client, connection));
  OK(lks_enet_connect_again(calling, &again));
  lks_client_destroy(client);
  lks_server_destroy(server);
  lks_transport_destroy(calling);
  lks_transport_destroy(listening);
  lks_simulation_destroy(simulation);
  lks_game_destroy(game);
}

static int messages = 0;
static void count_message(void* user, uint32_t level, const char* text) {
  if (user == &messages && level <= LKS_LEVEL_ERROR && *text != '\0') ++messages;
}

static void messages_go_to_the_programs_function(void) {
  match* m;
  OK(lks_set_log(count_message, &messages));
  m = make_match();
  play(m);
  CHECK(messages >= 4); /* two players, each on both sides */
  OK(lks_set_log(NULL, NULL));
  end_match(m);
}

/* Counts the bytes in use, and refuses more than a limit. */
typedef struct heap {
  size_t in_use, calls, limit;
} heap;

static void* take(void* user, size_t bytes, size_t alignment) {
  heap* h = user;
  if (h->in_use + bytes > h->limit) return NULL;
  h->in_use += bytes;
  ++h->calls;
  return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void give_back(void* user, void* memory, size_t bytes, size_t alignment) {
  heap* h = user;
  (void)alignment;
  h->in_use -= bytes;
  free(memory);
}

static void memory_comes_from_the_programs_functions(void) {
  static heap h = {0, 0, (size_t)1 << 30};
  lks_world_def def;
  lks_world *before = NULL, *world = NULL;
  lks_status status;
  OK(lks_world_def_init(&def, sizeof def));
  OK(lks_world_create(&def, NULL, &before));
  status = lks_set_allocator(take, give_back, &h);
  if (status == LKS_UNSUPPORTED) {
    lks_world_destroy(before);
    return;
  }
  OK(status);
  REFUSED(LKS_NULL_ARGUMENT, lks_set_allocator(take, NULL, &h));
  h.in_use = 0; /* a message of an error may stay */
  lks_world_destroy(before); /* goes back to the C library */
  OK(lks_world_create(&def, NULL, &world));
  CHECK(h.calls > 10 && h.in_use > 100000);
  OK(lks_step(world, NULL));
  lks_world_destroy(world);
  CHECK(h.in_use < 1000);
  h.limit = 50000;
  REFUSED(LKS_OUT_OF_MEMORY, lks_world_create(&def, NULL, &world));
  OK(lks_set_allocator(NULL, NULL, NULL));
  OK(lks_world_create(&def, NULL, &world));
  lks_world_destroy(world);
}

static void null_pointers_are_refused(void) {
  match* m = make_match();
  lks_server_def server_def;
  lks_client_def client_def;
  lks_recorder_def recorder_def;
  lks_enet_def enet_def;
  lks_game* game = NULL;
  lks_simulation* simulation = NULL;
  lks_transport* transport = NULL;
  lks_connection connection = 0;
  lks_network* network = NULL;
  lks_server* server = NULL;
  lks_client* client = NULL;
  lks_recorder* recorder = NULL;
  lks_log* log = NULL;
  lks_server_view server_view = {.size = sizeof server_view};
  lks_client_view client_view = {.size = sizeof client_view};
  lks_session_stats stats = {.size = sizeof stats};
  lks_log_info info = {.size = sizeof info};
  lks_log_report report = {.size = sizeof report};
  lks_bisect_report bisect = {.size = sizeof bisect};
  lks_simulation_info simulation_info;
  void* own = NULL;
  uint64_t number = 0;
  uint32_t small = 0;
  size_t count = 0;
  char text[8];
  OK(lks_server_def_init(&server_def, sizeof server_def));
  OK(lks_client_def_init(&client_def, sizeof client_def));
  OK(lks_recorder_def_init(&recorder_def, sizeof recorder_def));
  play(m);
  log = open_log(m);

#define NULLED(call) REFUSED(LKS_NULL_ARGUMENT, call)
  NULLED(lks_game_create(NULL, &game));
  NULLED(lks_game_create(lockstone_game(), NULL));
  NULLED(lks_game_builtin(NULL));
  NULLED(lks_simulation_create(NULL, text, 1, &simulation));
  NULLED(lks_simulation_create(m->game, NULL, 1, &simulation));
  NULLED(lks_simulation_create(m->game, text, 1, NULL));
  NULLED(lks_simulation_get_info(NULL, &simulation_info));
  NULLED(lks_simulation_get_info(m->simulation, NULL));
  NULLED(lks_simulation_tick(NULL, &number));
  NULLED(lks_simulation_tick(m->simulation, NULL));
  NULLED(lks_simulation_match(NULL, &own));
  NULLED(lks_simulation_match(m->simulation, NULL));
  NULLED(lks_simulation_step(NULL, text, 1, NULL));
  NULLED(lks_simulation_hash(NULL, &number));
  NULLED(lks_simulation_hash(m->simulation, NULL));
  NULLED(lks_simulation_snapshot_bytes_max(NULL, 0, &count));
  NULLED(lks_simulation_snapshot_bytes_max(m->simulation, 0, NULL));
  NULLED(lks_simulation_save(NULL, 0, text, 8, &count));
  NULLED(lks_simulation_save(m->simulation, 0, NULL, 8, &count));
  NULLED(lks_simulation_save(m->simulation, 0, text, 8, NULL));
  NULLED(lks_simulation_load(NULL, 0, text, 8));
  NULLED(lks_network_create(1, NULL));
  NULLED(lks_network_add(NULL, &transport));
  NULLED(lks_network_add(m->network, NULL));
  NULLED(lks_network_connect(NULL, m->ends[0], m->ends[1], NULL, &connection));
  NULLED(lks_network_connect(m->network, NULL, m->ends[1], NULL, &connection));
  NULLED(lks_network_connect(m->network, m->ends[0], NULL, NULL, &connection));
  NULLED(lks_network_connect(m->network, m->ends[0], m->ends[1], NULL, NULL));
  NULLED(lks_server_def_init(NULL, sizeof server_def));
  NULLED(lks_server_create(NULL, m->simulation, m->ends[0], &server));
  NULLED(lks_server_create(&server_def, NULL, m->ends[0], &server));
  NULLED(lks_server_create(&server_def, m->simulation, m->ends[0], NULL));
  NULLED(lks_server_update(NULL, 0));
  NULLED(lks_server_events(NULL, NULL, 0, &count));
  NULLED(lks_server_events(m->server, NULL, 0, NULL));
  NULLED(lks_server_events(m->server, NULL, 1, &count));
  NULLED(lks_server_event_text(NULL, 0, text, 8));
  NULLED(lks_server_event_text(m->server, 0, NULL, 8));
  NULLED(lks_server_record(NULL, m->recorder));
  NULLED(lks_server_record(m->server, NULL));
  NULLED(lks_server_stop(NULL));
  NULLED(lks_server_pause(NULL, 0));
  NULLED(lks_server_get(NULL, &server_view));
  NULLED(lks_server_get(m->server, NULL));
  NULLED(lks_server_stats(NULL, 0, &stats));
  NULLED(lks_server_stats(m->server, 0, NULL));
  NULLED(lks_client_def_init(NULL, sizeof client_def));
  NULLED(lks_client_create(NULL, m->game, m->ends[1], 1, &client));
  NULLED(lks_client_create(&client_def, NULL, m->ends[1], 1, &client));
  NULLED(lks_client_create(&client_def, m->game, NULL, 1, &client));
  NULLED(lks_client_create(&client_def, m->game, m->ends[1], 1, NULL));
  NULLED(lks_client_set_input(NULL, text, 1));
  NULLED(lks_client_set_input(m->clients[0], NULL, 1));
  NULLED(lks_client_on_sample(NULL, NULL, NULL));
  NULLED(lks_client_on_predict(NULL, NULL, NULL));
  NULLED(lks_client_update(NULL, 0));
  NULLED(lks_client_events(NULL, NULL, 0, &count));
  NULLED(lks_client_events(m->clients[0], NULL, 0, NULL));
  NULLED(lks_client_event_text(NULL, 0, text, 8));
  NULLED(lks_client_get(NULL, &client_view));
  NULLED(lks_client_get(m->clients[0], NULL));
  NULLED(lks_client_reason(NULL, text, 8));
  NULLED(lks_client_reason(m->clients[0], NULL, 8));
  NULLED(lks_client_simulation(NULL, &simulation));
  NULLED(lks_client_simulation(m->clients[0], NULL));
  NULLED(lks_client_stats(NULL, &stats));
  NULLED(lks_client_stats(m->clients[0], NULL));
  NULLED(lks_client_ask(NULL, 0, 0, 0));
  NULLED(lks_client_reconnect(NULL, 1));
  NULLED(lks_client_leave(NULL));
  NULLED(lks_recorder_def_init(NULL, sizeof recorder_def));
  NULLED(lks_recorder_create(NULL, m->simulation, "x", &recorder));
  NULLED(lks_recorder_create(&recorder_def, NULL, "x", &recorder));
  NULLED(lks_recorder_create(&recorder_def, m->simulation, NULL, &recorder));
  NULLED(lks_recorder_create(&recorder_def, m->simulation, "x", NULL));
  NULLED(lks_recorder_create_in_memory(NULL, m->simulation, &recorder));
  NULLED(lks_recorder_create_in_memory(&recorder_def, NULL, &recorder));
  NULLED(lks_recorder_create_in_memory(&recorder_def, m->simulation, NULL));
  NULLED(lks_recorder_step(NULL, text, 1, NULL));
  NULLED(lks_recorder_note(NULL, "x"));
  NULLED(lks_recorder_note(m->recorder, NULL));
  NULLED(lks_recorder_finish(NULL, "x"));
  NULLED(lks_recorder_finish(m->recorder, NULL));
  NULLED(lks_recorder_bytes(NULL, text, 8, &count));
  NULLED(lks_recorder_bytes(m->recorder, NULL, 8, &count));
  NULLED(lks_recorder_bytes(m->recorder, text, 8, NULL));
  NULLED(lks_log_open(NULL, &log));
  NULLED(lks_log_open("x", NULL));
  NULLED(lks_log_open_bytes(NULL, 1, &log));
  NULLED(lks_log_open_bytes(text, 1, NULL));
  NULLED(lks_log_get_info(NULL, &info));
  NULLED(lks_log_get_info(log, NULL));
  NULLED(lks_log_config(NULL, text, 8, &count));
  NULLED(lks_log_config(log, NULL, 8, &count));
  NULLED(lks_log_config(log, text, 8, NULL));
  NULLED(lks_log_next(NULL, &number, text, 8, NULL, &number));
  NULLED(lks_log_next(log, NULL, text, 8, NULL, &number));
  NULLED(lks_log_next(log, &number, NULL, 8, NULL, &number));
  NULLED(lks_log_next(log, &number, text, 8, NULL, NULL));
  NULLED(lks_log_seek(NULL, m->game, 1, &simulation));
  NULLED(lks_log_seek(log, NULL, 1, &simulation));
  NULLED(lks_log_seek(log, m->game, 1, NULL));
  NULLED(lks_log_verify(NULL, m->game, &report));
  NULLED(lks_log_verify(log, NULL, &report));
  NULLED(lks_log_verify(log, m->game, NULL));
  NULLED(lks_log_bisect(NULL, log, m->game, &bisect));
  NULLED(lks_log_bisect(log, NULL, m->game, &bisect));
  NULLED(lks_log_bisect(log, log, NULL, &bisect));
  NULLED(lks_log_bisect(log, log, m->game, NULL));
  if (lks_enet_def_init(&enet_def, sizeof enet_def) == LKS_OK) {
    NULLED(lks_enet_def_init(NULL, sizeof enet_def));
    NULLED(lks_enet_listen(NULL, "::1", NULL, &transport));
    NULLED(lks_enet_listen(&enet_def, NULL, NULL, &transport));
    NULLED(lks_enet_listen(&enet_def, "::1", NULL, NULL));
    NULLED(lks_enet_connect(NULL, 1, &transport, &connection));
    NULLED(lks_enet_connect("::1", 1, NULL, &connection));
    NULLED(lks_enet_connect("::1", 1, &transport, NULL));
    NULLED(lks_enet_join(NULL, &transport, &connection));
    NULLED(lks_enet_join("x", NULL, &connection));
    NULLED(lks_enet_join("x", &transport, NULL));
    NULLED(lks_enet_connect_again(NULL, &connection));
    NULLED(lks_enet_port(NULL, &small));
    NULLED(lks_enet_wait(NULL, 0));
    NULLED(lks_issue_token(NULL, 1, 1, 0, 1, "::1", 1, text, 8));
    NULLED(lks_issue_token("0123456789abcdef0123456789abcdef", 1, 1, 0, 1, NULL, 1, text, 8));
    NULLED(lks_issue_token("0123456789abcdef0123456789abcdef", 1, 1, 0, 1, "::1", 1, NULL, 8));
    REFUSED(LKS_INVALID_ARGUMENT, lks_enet_port(m->ends[0], &small));
    REFUSED(LKS_INVALID_ARGUMENT, lks_enet_wait(m->ends[0], 0));
  }
#undef NULLED

  lks_game_destroy(NULL);
  lks_simulation_destroy(NULL);
  lks_transport_destroy(NULL);
  lks_network_destroy(network);
  lks_server_destroy(NULL);
  lks_client_destroy(NULL);
  lks_recorder_destroy(NULL);
  lks_log_close(NULL);
  lks_log_close(log);
  end_match(m);
}

typedef struct test {
  const char* name;
  void (*run)(void);
} test;

#define TEST(name) {#name, name}
static const test tests[] = {
    TEST(all_peers_have_equal_hashes_at_every_tick),
    TEST(the_servers_log_verifies_and_is_read_tick_by_tick),
    TEST(a_log_is_sought_to_any_tick),
    TEST(logs_that_differ_are_bisected),
    TEST(a_damaged_log_is_corrupt),
    TEST(a_sessions_simulation_is_for_reading),
    TEST(a_session_that_cannot_be_made_says_why),
    TEST(a_relay_leaves_the_states_to_the_players),
    TEST(a_token_opens_a_seat_of_an_encrypted_match),
    TEST(messages_go_to_the_programs_function),
    TEST(memory_comes_from_the_programs_functions),
    TEST(null_pointers_are_refused),
};

int main(int argc, char** argv) {
  size_t i;
  for (i = 0; i < sizeof tests / sizeof *tests; ++i) {
    if (argc < 2 || strcmp(argv[1], tests[i].name) != 0) continue;
    tests[i].run();
    return failures == 0 ? 0 : 1;
  }
  fprintf(stderr, "usage: session_test NAME\n");
  return 64;
}
