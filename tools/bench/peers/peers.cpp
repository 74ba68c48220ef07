#include "tools/bench/peers/peers.h"

namespace lockstone::bench {
namespace {

#if !defined(LOCKSTONE_BENCH_BULLET)
std::unique_ptr<QueryEngine> absent(const QueryScene&) {
  return nullptr;
}
constexpr PeerMaker k_peers[] = {{"Bullet", absent}};
#else
constexpr PeerMaker k_peers[] = {{"Bullet", make_bullet_engine}};
#endif

}  // namespace

std::span<const PeerMaker> peer_makers() {
  return k_peers;
}

}  // namespace lockstone::bench
