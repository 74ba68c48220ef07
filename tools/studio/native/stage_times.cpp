// Where the time of a world's steps goes, by the clock of the page.
#include <algorithm>
#include <cstdint>

#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/studio/native/lockstone_studio.h"

// Milliseconds of `performance.now`.
extern "C" __attribute__((import_module("lockstone_studio"), import_name("now"))) double
lks_studio_now();

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr double k_ticks_a_ms = 1e6;

static_assert(k_step_stages == LKS_STUDIO_STAGES);

std::uint64_t clock_of_page() {
  return static_cast<std::uint64_t>(lks_studio_now() * k_ticks_a_ms);
}

}  // namespace

lks_status lks_studio_watch_stages(lks_world* world) {
  return call([&] {
    required(world, "world");
    // A scene is built by itself, so its world is no constant.
    World& watched = world->scene ? const_cast<World&>(world->scene->world()) : *world->own;
    watched.set_clock(clock_of_page);
  });
}

lks_status lks_studio_stage_times(const lks_world* world, double* sums) {
  return call([&] {
    required(sums, "sums");
    const StepProfile& profile = read(world).profile();
    std::ranges::transform(profile.stage_ticks, sums, [](std::uint64_t ticks) {
      return static_cast<double>(ticks) * 1000 / k_ticks_a_ms;
    });
  });
}
