#include "tools/lockstone/logs/state/canonical_fields.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/bytes.h>
#include <lockstone/hash.h>

#include "core/world/state/record_codec.h"
#include "core/world/state/snapshot_format.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/tool/games.h"

namespace lockstone::tool {
namespace {

constexpr std::size_t k_checksum_bytes = 8;
constexpr std::size_t k_front_bytes = k_snapshot_frame_bytes - k_checksum_bytes;

class Lister {
 public:
  template <class Record>
  void add(const char* store, std::uint64_t object) {
    Record record{};
    visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
      places_.push_back({store, object, std::string(name) + suffix, offset_, sizeof(integer)});
      offset_ += sizeof(integer);
    });
  }
  [[nodiscard]] std::vector<FieldPlace> take() { return std::move(places_); }

 private:
  std::vector<FieldPlace> places_;
  std::size_t offset_ = k_front_bytes;
};

}  // namespace

std::span<std::byte> world_part(const World& world, std::span<std::byte> canonical) {
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(world.save(SnapshotKind::canonical, bytes));
  const auto found = std::search(canonical.begin(), canonical.end(), bytes.begin(), bytes.end());
  if (found == canonical.end()) return {};
  return canonical.subspan(static_cast<std::size_t>(found - canonical.begin()), bytes.size());
}

std::vector<FieldPlace> fields_of_world(ByteView world) {
  ByteReader reader(world.subspan(k_front_bytes));
  const auto header = decode<WorldHeader>(reader);
  Lister lister;
  lister.add<WorldHeader>("world", 0);
  for (std::uint32_t i = 0; i < header.body_limit; ++i)
    lister.add<BodyRecord>("body", i);
  for (std::uint32_t i = 0; i < header.contact_count; ++i)
    lister.add<ContactRecord>("contact", i);
  for (std::uint32_t i = 0; i < header.joint_limit; ++i)
    lister.add<JointRecord>("joint", i);
  return lister.take();
}

std::vector<std::byte> find_flipped_bit(const GameDef& game, Simulation& simulation,
                                        std::uint64_t hash) {
  World* world = world_of(game, simulation);
  if (world == nullptr) return {};
  std::vector<std::byte> native(simulation.snapshot_bytes_max(SnapshotKind::native));
  native.resize(simulation.save(SnapshotKind::native, native));
  std::vector<std::byte> bytes = canonical_bytes(simulation);
  const std::span<std::byte> part = world_part(*world, bytes);
  if (part.empty()) return {};
  for (const FieldPlace& place : fields_of_world(part)) {
    for (unsigned bit = 0; bit < 8 * place.bytes; ++bit) {
      LKS_CHECK(world->flip_bit(place.store, place.object, place.field, bit));
      const bool found = simulation.hash() == hash;
      LKS_CHECK(world->flip_bit(place.store, place.object, place.field, bit));
      if (!found) continue;
      part[place.offset + bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      reseal(part);
      LKS_CHECK(simulation.load(SnapshotKind::native, native) == Status::ok);
      return bytes;
    }
  }
  LKS_CHECK(simulation.load(SnapshotKind::native, native) == Status::ok);
  return {};
}

void reseal(std::span<std::byte> world) {
  const std::span<std::byte> hashed = world.first(world.size() - k_checksum_bytes);
  ByteWriter(world.last(k_checksum_bytes)).put(hash64(hashed));
}

}  // namespace lockstone::tool
