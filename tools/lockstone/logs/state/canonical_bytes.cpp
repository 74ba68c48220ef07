#include "tools/lockstone/logs/state/canonical_bytes.h"

namespace lockstone::tool {

std::vector<std::byte> canonical_bytes(const Simulation& simulation) {
  std::vector<std::byte> bytes(simulation.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(simulation.save(SnapshotKind::canonical, bytes));
  return bytes;
}

}  // namespace lockstone::tool
