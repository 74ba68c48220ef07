// The built-in scenes, in a file of its own: a program that names none links none.
#include "tools/bindings/c/handles.h"
#include "tools/scenes/play.h"

namespace lockstone::c {
namespace {

const std::vector<scenes::SceneSummary>& all_scenes() {
  static const std::vector<scenes::SceneSummary> list = scenes::list_scenes();
  return list;
}

}  // namespace
}  // namespace lockstone::c

using namespace lockstone;
using namespace lockstone::c;

lks_status lks_world_create_scene(const char* name, uint64_t seed, lks_world** out) {
  return call([&] {
    required(out, "out");
    auto scene = scenes::make_play(&required(name, "name"), seed);
    if (!scene.ok()) throw_status(LKS_NOT_FOUND, std::string("no scene is called ") + name);
    auto world = std::make_unique<lks_world>();
    world->scene = std::move(scene).value();
    *out = world.release();
  });
}

uint32_t lks_scene_count(void) {
  return static_cast<uint32_t>(all_scenes().size());
}

const char* lks_scene_name(uint32_t index) {
  return index < all_scenes().size() ? all_scenes()[index].name.data() : nullptr;
}
