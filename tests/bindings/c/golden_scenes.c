/* Plays built-in scenes through the C interface: golden_scenes (SCENE TICKS)… prints, for each, its
 * name and the hashes of every tenth tick and of the last, on one line. */
#include <inttypes.h>
#include <lockstone.h>
#include <stdio.h>
#include <stdlib.h>

static void must(lks_status status) {
  if (status == LKS_OK) return;
  fprintf(stderr, "%s: %s\n", lks_status_name(status), lks_last_error());
  exit(1);
}

static void play(const char* name, uint64_t ticks) {
  lks_world* world = NULL;
  uint64_t tick = 0;
  uint64_t hash = 0;
  must(lks_world_create_scene(name, 1, &world));
  printf("%s", name);
  while (tick < ticks) {
    must(lks_step(world, NULL));
    must(lks_tick(world, &tick));
    if (tick % 10 != 0 && tick != ticks) continue;
    must(lks_hash(world, &hash));
    printf(" %016" PRIx64, hash);
  }
  printf("\n");
  lks_world_destroy(world);
}

int main(int argc, char** argv) {
  int i;
  for (i = 1; i + 1 < argc; i += 2)
    play(argv[i], strtoull(argv[i + 1], NULL, 10));
  return 0;
}
