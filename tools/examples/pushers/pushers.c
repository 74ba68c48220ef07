/* A game in C: every player pushes a ball over a plane. It uses liblockstone_c for the physics, and gives
 * the tools its functions: `lockstone --game libpushers_game.so serve`, `join`, `verify`, `bisect`, … */
#include <stdlib.h>
#include <string.h>

#include <lockstone.h>
#include <lockstone/game_abi.h>

enum { INPUT_BYTES = 2, MAX_PLAYERS = 16 };

typedef struct match {
  lks_world *world;
  lks_body balls[MAX_PLAYERS]; /* follow from the construction: not state */
  uint64_t config_hash, scene_hash;
  uint8_t players;
} match;

static void destroy(void *at) {
  match *m = at;
  lks_world_destroy(m->world);
  free(m);
}

static lks_status add_bodies(match *m) {
  lks_body_def def;
  lks_body ground;
  lks_body_def_init(&def, sizeof def);
  def.motion = LKS_STATIC;
  def.shape = lks_half_space();
  lks_status status = lks_create_body(m->world, &def, &ground);
  for (uint8_t slot = 0; slot < m->players && status == LKS_OK; ++slot) {
    lks_body_def_init(&def, sizeof def);
    def.shape = lks_sphere(lks_length_mm(500));
    def.position.x = lks_position_mm(1500 * slot);
    def.position.y = lks_position_mm(500);
    status = lks_create_body(m->world, &def, &m->balls[slot]);
  }
  return status;
}

/* The configuration is one byte: the number of players. */
static int32_t create(const uint8_t *config, size_t config_bytes, void **out) {
  if (config_bytes != 1) return LOCKSTONE_GAME_MALFORMED;
  if (config[0] < 1 || config[0] > MAX_PLAYERS) return LOCKSTONE_GAME_INVALID_ARGUMENT;
  lks_world_def def;
  lks_world_def_init(&def, sizeof def);
  def.body_capacity = MAX_PLAYERS + 1;
  match *m = calloc(1, sizeof *m);
  if (m == NULL) return LOCKSTONE_GAME_CAPACITY_EXHAUSTED;
  m->players = config[0];
  lks_status status = lks_world_create(&def, NULL, &m->world);
  if (status == LKS_OK) status = add_bodies(m);
  if (status == LKS_OK) status = lks_config_hash(&def, NULL, &m->config_hash);
  if (status == LKS_OK) status = lks_hash(m->world, &m->scene_hash);
  if (status != LKS_OK) {
    destroy(m);
    return LOCKSTONE_GAME_CAPACITY_EXHAUSTED;
  }
  *out = m;
  return LOCKSTONE_GAME_OK;
}

static void info(const void *at, lockstone_game_info *out) {
  const match *m = at;
  memset(out, 0, sizeof *out);
  out->abi = lks_simulation_abi();
  out->canary = lks_canary_hash();
  out->config_hash = m->config_hash + m->players;
  out->scene_hash = m->scene_hash;
  out->tick_rate = 60;
  out->player_count = m->players;
  out->input_bytes = INPUT_BYTES;
}

static uint64_t tick(const void *at) {
  uint64_t ticks = 0;
  lks_tick(((const match *)at)->world, &ticks);
  return ticks;
}

/* Any input bytes are legal: two signed numbers, a push along x and one along z, in N·s times 8. */
static void step(void *at, const lockstone_game_input *inputs, size_t count) {
  match *m = at;
  for (size_t slot = 0; slot < count && slot < m->players; ++slot) {
    lks_impulse3 push = {0, 0, 0};
    push.x = (int64_t)(int8_t)inputs[slot].bytes[0] * (1 << (LKS_IMPULSE_BITS - 3));
    push.z = (int64_t)(int8_t)inputs[slot].bytes[1] * (1 << (LKS_IMPULSE_BITS - 3));
    lks_apply_impulse(m->world, m->balls[slot], &push, LKS_FRAME_WORLD);
  }
  lks_step(m->world, NULL);
}

static size_t snapshot_bytes_max(const void *at, uint32_t kind) {
  size_t bytes = 0;
  lks_snapshot_bytes_max(((const match *)at)->world, kind, &bytes);
  return bytes;
}

static size_t save(const void *at, uint32_t kind, uint8_t *out, size_t capacity) {
  size_t bytes = 0;
  const lks_status status = lks_save(((const match *)at)->world, kind, out, capacity, &bytes);
  return status == LKS_OK ? bytes : 0;
}

static int32_t load(void *at, uint32_t kind, const uint8_t *bytes, size_t size) {
  return lks_load(((match *)at)->world, kind, bytes, size);
}

static void keep_history(void *at, uint32_t ticks) {
  match *m = at;
  (void)lks_world_keep_history(m->world, ticks);
}

static void forget_history(void *at) {
  match *m = at;
  (void)lks_world_forget_history(m->world);
}

static uint64_t hash(const void *at) {
  uint64_t value = 0;
  lks_hash(((const match *)at)->world, &value);
  return value;
}

static size_t part_hashes(const void *at, lockstone_game_hash *out) {
  lks_hashes parts;
  if (lks_part_hashes(((const match *)at)->world, &parts) != LKS_OK) return 0;
  const lockstone_game_hash all[] = {{"bodies", parts.bodies, 0}, {"contacts", parts.contacts, 0}};
  memcpy(out, all, sizeof all);
  return 2;
}

static int32_t describe(const void *at, const uint8_t *here, size_t here_bytes, const uint8_t *there,
                        size_t there_bytes, lockstone_game_difference *out) {
  uint32_t differs = 0;
  memset(out, 0, sizeof *out);
  memcpy(out->store, "world", sizeof "world");
  lks_describe_difference(((const match *)at)->world, here, here_bytes, there, there_bytes, &differs,
                          out->field, sizeof out->field);
  return differs != 0;
}

static int32_t configure(const lockstone_game_request *request, uint8_t *out, size_t *size) {
  if (*size < 1) return LOCKSTONE_GAME_CAPACITY_EXHAUSTED;
  if (request->players > MAX_PLAYERS) return LOCKSTONE_GAME_INVALID_ARGUMENT;
  out[0] = (uint8_t)(request->players == 0 ? 2 : request->players);
  *size = 1;
  return LOCKSTONE_GAME_OK;
}

LOCKSTONE_GAME_EXPORT const lockstone_game_table *lockstone_game(void) {
  static const lockstone_game_scene scenes[] = {{"plane", "balls on a plane", 120}};
  static const lockstone_game_table table = {
      .abi = LOCKSTONE_GAME_ABI,
      .bytes = sizeof(lockstone_game_table),
      .name = "pushers",
      .version = "0.1",
      .create = create,
      .destroy = destroy,
      .info = info,
      .tick = tick,
      .step = step,
      .snapshot_bytes_max = snapshot_bytes_max,
      .save = save,
      .load = load,
      .hash = hash,
      .part_hashes = part_hashes,
      .describe = describe,
      .configure = configure,
      .scenes = scenes,
      .scene_count = 1,
      .keep_history = keep_history,
      .forget_history = forget_history,
  };
  return &table;
}
