#include "net/session/server/data/keyframe_store.h"

namespace lockstone::net {

void KeyframeStore::note(const Simulation& simulation) {
  const std::uint64_t ticks = simulation.tick();
  if (!is_used() || ticks % interval_ != 0) return;
  const std::uint64_t number = ticks / interval_;
  states_.commit(number, simulation.save(SnapshotKind::canonical, states_.claim(number)));
  hashes_[static_cast<std::size_t>(number % hashes_.size())] = simulation.hash();
}

}  // namespace lockstone::net
