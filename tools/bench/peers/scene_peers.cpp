#include "tools/bench/peers/scene_peers.h"

namespace lockstone::bench {
namespace {

#if !defined(LOCKSTONE_BENCH_BULLET) || !defined(LOCKSTONE_BENCH_ODE)
std::unique_ptr<NeutralEngine> absent(const NeutralScene&, int) {
  return nullptr;
}
#endif
#if !defined(LOCKSTONE_BENCH_BULLET)
constexpr auto k_bullet = absent;
#else
constexpr auto k_bullet = make_bullet_scene;
#endif
#if !defined(LOCKSTONE_BENCH_ODE)
constexpr auto k_ode = absent, k_ode_direct = absent;
#else
constexpr auto k_ode = make_ode_scene, k_ode_direct = make_ode_direct_scene;
#endif

constexpr NeutralMaker k_peers[] = {{"Bullet", "steps a tick", k_bullet},
                                    {"ODE", "steps a tick", k_ode},
                                    {"ODE direct", "steps a tick", k_ode_direct}};

}  // namespace

std::span<const NeutralMaker> scene_peers() {
  return k_peers;
}

}  // namespace lockstone::bench
