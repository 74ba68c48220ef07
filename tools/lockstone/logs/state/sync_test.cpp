#include "tools/lockstone/logs/state/sync_test.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <lockstone/world.h>

#include "tools/lockstone/logs/state/canonical_fields.h"
#include "tools/tool/games.h"

namespace lockstone::tool {
namespace {

std::span<std::byte> save_into(const Simulation& simulation, std::span<std::byte> bytes) {
  return bytes.first(simulation.save(SnapshotKind::canonical, bytes));
}

}  // namespace

SyncTest::SyncTest(const GameDef& game, Simulation& first, std::unique_ptr<Simulation> second,
                   std::string forget)
    : game_(game),
      first_(first),
      second_(std::move(second)),
      forget_(std::move(forget)),
      bytes_(first.snapshot_bytes_max(SnapshotKind::canonical)),
      other_bytes_(bytes_.size()),
      native_(first.snapshot_bytes_max(SnapshotKind::native)) {}

std::string SyncTest::step(std::span<const PlayerInput> inputs) {
  const std::span<std::byte> saved = save_into(first_, bytes_);
  if (!forget_.empty()) forget(saved);
  Status status = second_->load(SnapshotKind::canonical, saved);
  if (status != Status::ok) return fmt::format("load: {}", to_string(status));
  const std::string lost = loss();
  second_->step(inputs);
  const std::size_t native = first_.save(SnapshotKind::native, native_);
  status = first_.load(SnapshotKind::native, std::span(native_).first(native));
  if (status != Status::ok) return fmt::format("load of a native copy: {}", to_string(status));
  if (World* world = world_of(game_, first_)) world->drop_derived();
  first_.step(inputs);
  const ByteView here = save_into(first_, bytes_), there = save_into(*second_, other_bytes_);
  const bool same = std::equal(here.begin(), here.end(), there.begin(), there.end());
  if (same && first_.hash() == second_->hash()) return lost;
  return first_.describe(here, there).to_line();
}

// The part of the first's state that the second lacks, for fields that no tick reads.
std::string SyncTest::loss() {
  if (first_.hash() == second_->hash()) return {};
  return first_.describe(save_into(first_, bytes_), save_into(*second_, other_bytes_)).to_line();
}

// As a `save` would that leaves the field out.
void SyncTest::forget(std::span<std::byte> saved) {
  const World* whole = world_of(game_, first_);
  const std::span<std::byte> world =
      whole == nullptr ? std::span<std::byte>() : world_part(*whole, saved);
  if (world.empty()) return;
  for (const FieldPlace& place : fields_of_world(world)) {
    if (place.store + ('.' + place.field) != forget_) continue;
    const std::span<std::byte> field = world.subspan(place.offset, place.bytes);
    for (std::byte& byte : field)
      forgotten_ += std::exchange(byte, std::byte{0}) != std::byte{0} ? 1U : 0U;
  }
  reseal(world);
}

}  // namespace lockstone::tool
