#include "tools/simnet/oracle.h"

#include <fmt/format.h>

#include <lockstone/hash.h>

namespace lockstone::simnet {
namespace {

constexpr std::uint64_t k_reload_ticks = 64;

std::uint64_t digest(std::span<const PlayerInput> inputs) {
  std::uint64_t hash = inputs.size();
  for (const PlayerInput& input : inputs) {
    hash = hash64(input.bytes, hash + static_cast<std::uint64_t>(input.origin));
  }
  return hash;
}

}  // namespace

Oracle::Oracle(std::unique_ptr<Simulation> reference, std::uint64_t expected_ticks)
    : reference_(std::move(reference)),
      snapshot_(reference_->snapshot_bytes_max(SnapshotKind::canonical)) {
  truth_.reserve(static_cast<std::size_t>(expected_ticks));
}

void Oracle::commands_confirmed(std::span<const PlayerCommand> commands) {
  for (const PlayerCommand& command : commands)
    reference_->command(command);
}

void Oracle::confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                       std::optional<std::uint64_t> hash) {
  if (tick != truth_.size()) {
    return fail(fmt::format("tick {}: the server confirmed it after tick {}", tick, truth_.size()));
  }
  reference_->step(inputs);
  truth_.push_back({digest(inputs), reference_->hash()});
  if (tick % k_reload_ticks == k_reload_ticks - 1) reload();
  if (!hash) return;
  ++comparisons_;
  if (*hash != truth_.back().hash) {
    fail(fmt::format("tick {}: the server's state has {:016x}, without a network it has {:016x}",
                     tick, *hash, truth_.back().hash));
  }
}

void Oracle::reload() {
  const std::size_t size = reference_->save(SnapshotKind::canonical, snapshot_);
  if (reference_->load(SnapshotKind::canonical, ByteView(snapshot_).first(size)) != Status::ok) {
    return fail(fmt::format("tick {}: a snapshot does not load", truth_.size() - 1));
  }
  if (reference_->hash() != truth_.back().hash) {
    fail(fmt::format("tick {}: a snapshot lacks something: {:016x} saved, {:016x} loaded",
                     truth_.size() - 1, truth_.back().hash, reference_->hash()));
  }
}

void Oracle::stepped(std::size_t client, std::uint64_t tick, std::span<const PlayerInput> inputs,
                     std::uint64_t hash) {
  ++comparisons_;
  if (tick >= truth_.size()) {
    return fail(fmt::format("tick {}: client {} stepped it before it was confirmed", tick, client));
  }
  const Tick& truth = truth_[static_cast<std::size_t>(tick)];
  if (digest(inputs) != truth.inputs) {
    fail(fmt::format("tick {}: client {} stepped other inputs than the server confirmed", tick,
                     client));
  }
  const bool excused = client == excused_ && tick >= excused_tick_;
  if (hash != truth.hash && !excused) {
    fail(fmt::format("tick {}: client {} has {:016x}, without a network it is {:016x}", tick,
                     client, hash, truth.hash));
  }
}

void Oracle::fail(const std::string& what) {
  if (failure_.empty()) failure_ = what;
}

}  // namespace lockstone::simnet
