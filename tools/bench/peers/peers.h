// Other engines that run beside ours. Each is a file here that only a build with
// LOCKSTONE_BENCH_PEERS and that engine's headers has.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "tools/bench/queries/query_engine.h"

namespace lockstone::bench {

/// Makes a peer that holds the scene; null when it is not in this build or cannot hold the scene.
struct PeerMaker {
  std::string_view name;
  std::unique_ptr<QueryEngine> (*make)(const QueryScene& scene);
};

/// All that the project knows of, in this build or not.
[[nodiscard]] std::span<const PeerMaker> peer_makers();

/// bullet_queries.cpp
[[nodiscard]] std::unique_ptr<QueryEngine> make_bullet_engine(const QueryScene& scene);

}  // namespace lockstone::bench
