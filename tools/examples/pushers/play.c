/* A server and a player of the game over the network, by liblockstone_c alone:
 *
 *   pushers_play serve PLAYERS TICKS LOG   prints "port N", then "tick hash" of each tick
 *   pushers_play join PORT [PREDICTION]    the same of a player; PREDICTION ticks of rollback
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lockstone.h>
#include <lockstone/game_abi.h>

static void must(lks_status status) {
  if (status == LKS_OK) return;
  fprintf(stderr, "%s: %s\n", lks_status_name(status), lks_last_error());
  exit(1);
}

static void print_ticks(const lks_session_event *events, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    if (events[i].kind == LKS_SESSION_TICK)
      printf("%" PRIu64 " %016" PRIx64 "\n", events[i].tick, events[i].hash);
  }
}

static int serve(uint8_t players, uint64_t ticks, const char *path) {
  lks_game *game;
  lks_simulation *simulation;
  lks_transport *transport;
  lks_recorder *recorder;
  lks_server *server;
  uint32_t port;
  must(lks_game_create(lockstone_game(), &game));
  must(lks_simulation_create(game, &players, 1, &simulation));

  lks_enet_def socket;
  must(lks_enet_def_init(&socket, sizeof socket));
  socket.unlimited = 1; /* this match runs as fast as it can */
  must(lks_enet_listen(&socket, "127.0.0.1", NULL, &transport));
  must(lks_enet_port(transport, &port));
  printf("port %" PRIu32 "\n", port);
  fflush(stdout);

  lks_server_def def;
  must(lks_server_def_init(&def, sizeof def));
  def.insecure = 1;
  def.pacing = LKS_PACING_FAST;
  def.tick_count = ticks;
  must(lks_server_create(&def, simulation, transport, &server));
  lks_recorder_def log;
  must(lks_recorder_def_init(&log, sizeof log));
  log.replace = 1;
  must(lks_recorder_create(&log, simulation, path, &recorder));
  must(lks_server_record(server, recorder));

  lks_server_view view = {.size = sizeof view};
  do {
    lks_session_event events[256];
    size_t count;
    must(lks_server_update(server, lks_now_us()));
    must(lks_server_events(server, events, 256, &count));
    print_ticks(events, count);
    must(lks_server_get(server, &view));
    must(lks_enet_wait(transport, 1000));
  } while (view.state != LKS_SERVER_OVER);

  must(lks_recorder_finish(recorder, "the match is over"));
  lks_server_destroy(server);
  lks_recorder_destroy(recorder);
  lks_transport_destroy(transport);
  lks_simulation_destroy(simulation);
  lks_game_destroy(game);
  return view.finish_reason == LKS_FINISH_COMPLETED ? 0 : 1;
}

/* A bot: pushes that follow from the tick. */
static void press(void *user, uint64_t tick, uint8_t *out, size_t bytes) {
  (void)user;
  for (size_t i = 0; i < bytes; ++i) out[i] = (uint8_t)(tick / 8 * 37 + i * 101);
}

static int join(uint32_t port, uint32_t prediction) {
  lks_game *game;
  lks_transport *transport;
  lks_client *client;
  lks_connection connection;
  must(lks_game_create(lockstone_game(), &game));
  must(lks_enet_connect("127.0.0.1", port, &transport, &connection));
  lks_client_def def;
  must(lks_client_def_init(&def, sizeof def));
  def.insecure = 1;
  def.prediction_ticks = prediction;
  strcpy(def.name, "C");
  must(lks_client_create(&def, game, transport, connection, &client));
  must(lks_client_on_sample(client, press, NULL));

  lks_client_view view = {.size = sizeof view};
  do {
    lks_session_event events[256];
    size_t count;
    must(lks_client_update(client, lks_now_us()));
    must(lks_client_events(client, events, 256, &count));
    print_ticks(events, count);
    must(lks_client_get(client, &view));
    must(lks_enet_wait(transport, 1000));
  } while (view.state < LKS_CLIENT_FINISHED);

  char reason[256];
  must(lks_client_reason(client, reason, sizeof reason));
  if (view.state != LKS_CLIENT_FINISHED) fprintf(stderr, "%s\n", reason);
  lks_client_destroy(client);
  lks_transport_destroy(transport);
  lks_game_destroy(game);
  return view.state == LKS_CLIENT_FINISHED ? 0 : 1;
}

int main(int argc, char **argv) {
  if (argc == 5 && strcmp(argv[1], "serve") == 0)
    return serve((uint8_t)atoi(argv[2]), strtoull(argv[3], NULL, 10), argv[4]);
  if ((argc == 3 || argc == 4) && strcmp(argv[1], "join") == 0)
    return join((uint32_t)atoi(argv[2]), argc == 4 ? (uint32_t)atoi(argv[3]) : 0);
  fprintf(stderr, "usage: %s serve PLAYERS TICKS LOG | join PORT [PREDICTION]\n", argv[0]);
  return 64;
}
