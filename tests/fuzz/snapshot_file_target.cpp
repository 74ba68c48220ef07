// Snapshot files, as `lockstone seek --state` writes them.

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/hash.h>
#include <lockstone/replay/snapshot_file.h>

#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

std::vector<Bytes> seeds() {
  Bytes varied(400);
  for (std::size_t i = 0; i < varied.size(); ++i)
    varied[i] = static_cast<std::byte>(i * i & 0xff);
  return {replay::pack_snapshot(varied), replay::pack_snapshot(Bytes(5000)),
          replay::pack_snapshot({})};
}

void mend(Bytes& bytes) {
  if (bytes.size() < 8) return;
  const std::span<std::byte> all(bytes);
  ByteWriter(all.last(8)).put(hash64(all.first(all.size() - 8)));
}

bool run(ByteView bytes) {
  const Result<Bytes> canonical = replay::unpack_snapshot(bytes);
  if (!canonical.ok()) return false;
  const Result<Bytes> again = replay::unpack_snapshot(replay::pack_snapshot(canonical.value()));
  LKS_CHECK(again.ok() && again.value() == canonical.value());
  return true;
}

const Registration k_registration{
    {.name = "snapshot_file", .seeds = seeds, .mend = mend, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
