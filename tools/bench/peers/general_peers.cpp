#include "tools/bench/peers/general_peers.h"

namespace lockstone::bench {
namespace {

[[maybe_unused]] constexpr std::string_view k_box3d_absent =
    "a build with -DLOCKSTONE_BENCH_BOX3D=DIR, a checkout of yours with its library built";
[[maybe_unused]] constexpr std::string_view k_jolt_absent =
    "a build with -DLOCKSTONE_BENCH_JOLT=DIR, a checkout of yours with its library built";

constexpr GeneralMaker k_peers[] = {
#if defined(LOCKSTONE_BENCH_BOX3D)
    {"Box3D", "", make_box3d_general},
#else
    {"Box3D", k_box3d_absent, nullptr},
#endif
#if defined(LOCKSTONE_BENCH_JOLT)
    {"Jolt", "", make_jolt_general},
#else
    {"Jolt", k_jolt_absent, nullptr},
#endif
};

}  // namespace

std::span<const GeneralMaker> general_peers() {
  return k_peers;
}

}  // namespace lockstone::bench
