// The configuration bytes of scenes and of the arena.

#include <lockstone/assert.h>

#include "tests/fuzz/target.h"
#include "tools/arena/config.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone::fuzz {
namespace {

std::vector<Bytes> seeds() {
  const auto scene = scenes::encode_config("pile", 3);
  const auto arena = arena::ArenaConfig{.loose_bodies = 20}.encode();
  return {Bytes(scene.begin(), scene.end()), Bytes(arena.begin(), arena.end())};
}

bool run(ByteView bytes) {
  const Result<arena::ArenaConfig> match = arena::ArenaConfig::decode(bytes);
  if (match.ok()) {
    const auto again = match.value().encode();
    LKS_CHECK(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
  }
  return scenes::make_scene(bytes).ok() || match.ok();
}

const Registration k_registration{{.name = "config", .seeds = seeds, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
