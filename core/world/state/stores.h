// The stores of a state: the one list from which snapshots, hashes, comparison, flips and
// validation come. An addition to a record or to the list is in all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/world.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/fluid_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/rule_records.h"
#include "core/dynamics/state/terrain_record.h"
#include "core/dynamics/state/vehicle_record.h"
#include "core/world/state/record_codec.h"
#include "core/world/state/record_hash.h"
#include "core/world/state/world_header.h"

namespace lockstone {

/// A store: its records, the name of one for people, where the header counts them and the
/// definition bounds them, and the upper half of the seed of their hashes.
struct BodyStore {
  using Record = BodyRecord;
  static constexpr const char* k_name = "body";
  static constexpr auto k_count = &WorldHeader::body_limit;
  static constexpr auto k_capacity = &WorldDef::body_capacity;
  static constexpr std::uint64_t k_domain = k_body_domain;
  static constexpr bool k_has_key = false;  // a record's place is its index
};

struct ContactStore {
  using Record = ContactRecord;
  static constexpr const char* k_name = "contact";
  static constexpr auto k_count = &WorldHeader::contact_count;
  static constexpr auto k_capacity = &WorldDef::contact_capacity;
  static constexpr std::uint64_t k_domain = k_contact_domain;
  static constexpr bool k_has_key = true;  // sorted by it; no two are the same
};

struct JointStore {
  using Record = JointRecord;
  static constexpr const char* k_name = "joint";
  static constexpr auto k_count = &WorldHeader::joint_limit;
  static constexpr auto k_capacity = &WorldDef::joint_capacity;
  static constexpr std::uint64_t k_domain = k_joint_domain;
  static constexpr bool k_has_key = false;
};

/// Of an empty store nothing is hashed, so that a world without fluids is as it was before them.
struct FluidStore {
  using Record = FluidRecord;
  static constexpr const char* k_name = "fluid";
  static constexpr auto k_count = &WorldHeader::fluid_limit;
  static constexpr auto k_capacity = [](const WorldDef&) { return k_max_fluids; };
  static constexpr std::uint64_t k_domain = k_fluid_domain;
  static constexpr bool k_has_key = false;
};

/// The same holds of the rules about pairs, of vehicles and of tiles of terrain.
struct PairRuleStore {
  using Record = PairRuleRecord;
  static constexpr const char* k_name = "pair_rule";
  static constexpr auto k_count = &WorldHeader::pair_rule_count;
  static constexpr auto k_capacity = [](const WorldDef&) { return k_max_pair_rules; };
  static constexpr std::uint64_t k_domain = k_pair_rule_domain;
  static constexpr bool k_has_key = true;
};

struct SurfaceRuleStore {
  using Record = SurfaceRuleRecord;
  static constexpr const char* k_name = "surface_rule";
  static constexpr auto k_count = &WorldHeader::surface_rule_count;
  static constexpr auto k_capacity = [](const WorldDef&) { return k_max_surface_rules; };
  static constexpr std::uint64_t k_domain = k_surface_rule_domain;
  static constexpr bool k_has_key = true;
};

struct VehicleStore {
  using Record = VehicleRecord;
  static constexpr const char* k_name = "vehicle";
  static constexpr auto k_count = &WorldHeader::vehicle_count;
  static constexpr auto k_capacity = &WorldDef::vehicle_capacity;
  static constexpr std::uint64_t k_domain = k_vehicle_domain;
  static constexpr bool k_has_key = true;
};

struct TerrainTileStore {
  using Record = TerrainTileRecord;
  static constexpr const char* k_name = "terrain_tile";
  static constexpr auto k_count = &WorldHeader::terrain_tile_count;
  static constexpr auto k_capacity = &WorldDef::terrain_tile_capacity;
  static constexpr std::uint64_t k_domain = k_terrain_tile_domain;
  static constexpr bool k_has_key = true;
};

/// The most records that a store may have.
template <class Store>
[[nodiscard]] std::uint32_t capacity_of(const WorldDef& def) {
  return std::invoke(Store::k_capacity, def);
}

/// A state, as the templates below see it, has a `header`, and `visit(Store, f)`, which calls
/// `f(span of records)` for the records of a store in their order, in one or more spans.
template <class... Stores>
struct StoreList {
  static constexpr std::size_t k_size = sizeof...(Stores);

  /// Calls `f(Store{})` for each, in the order of the state.
  template <class F>
  static constexpr void for_each(F&& f) {
    (f(Stores{}), ...);
  }

  [[nodiscard]] static bool fits(const WorldHeader& header, const WorldDef& def) {
    return (... && (header.*Stores::k_count <= capacity_of<Stores>(def)));
  }
  [[nodiscard]] static std::size_t record_bytes(const WorldHeader& header) {
    return (std::size_t{0} + ... + bytes_of<Stores>(header.*Stores::k_count));
  }
  [[nodiscard]] static std::size_t record_bytes_max(const WorldDef& def) {
    return (std::size_t{0} + ... + bytes_of<Stores>(capacity_of<Stores>(def)));
  }

  /// Where a store stands in the list.
  template <class Store>
  [[nodiscard]] static constexpr std::size_t index_of() {
    std::size_t index = 0;
    static_cast<void>((... || (std::is_same_v<Stores, Store> || (++index, false))));
    return index;
  }

 private:
  template <class Store>
  static std::size_t bytes_of(std::uint32_t count) {
    return std::size_t{count} * sizeof(typename Store::Record);
  }
};

using WorldStores = StoreList<BodyStore, ContactStore, JointStore, FluidStore, PairRuleStore,
                              SurfaceRuleStore, VehicleStore, TerrainTileStore>;

/// The state as it lies in memory: header, then the stores. Returns the bytes written, 0 when `out`
/// is too small.
template <class List, class State>
[[nodiscard]] std::size_t write_native(const State& state, std::span<std::byte> out) {
  const std::size_t size = sizeof(WorldHeader) + List::record_bytes(state.header);
  if (size > out.size()) return 0;
  std::byte* to = out.data();
  std::memcpy(to, &state.header, sizeof(WorldHeader));
  to += sizeof(WorldHeader);
  List::for_each([&](auto store) {
    state.visit(store, [&](auto records) {
      if (records.empty()) return;
      std::memcpy(to, records.data(), records.size_bytes());
      to += records.size_bytes();
    });
  });
  return static_cast<std::size_t>(to - out.data());
}

/// The same field by field, for any machine.
template <class List, class State>
void write_canonical(const State& state, ByteWriter& writer) {
  encode(state.header, writer);
  List::for_each([&](auto store) {
    state.visit(store, [&](auto records) {
      for (const auto& record : records)
        encode(record, writer);
    });
  });
}

/// Where the records of a state begin that `write_native` or `write_canonical` wrote; a record
/// takes as many bytes in both.
template <class List>
class StoredRecords {
 public:
  StoredRecords() = default;

  /// `bytes`: all behind the header, at least List::record_bytes(header).
  StoredRecords(const WorldHeader& header, ByteView bytes) {
    std::size_t index = 0;
    List::for_each([&](auto store) {
      using Store = decltype(store);
      const std::size_t size = header.*Store::k_count * sizeof(typename Store::Record);
      parts_[index++] = bytes.first(size);
      bytes = bytes.subspan(size);
    });
  }

  template <class Store>
  [[nodiscard]] ByteView bytes_of() const {
    return parts_[List::template index_of<Store>()];
  }

  /// A record of canonical bytes.
  template <class Store>
  [[nodiscard]] typename Store::Record decoded(std::uint32_t index) const {
    using Record = typename Store::Record;
    ByteReader reader(bytes_of<Store>().subspan(index * sizeof(Record), sizeof(Record)));
    return decode<Record>(reader);
  }

 private:
  ByteView parts_[List::k_size];
};

/// The seed of a record's hash: a store's domain, and the index of a record without a key.
template <class Store>
[[nodiscard]] constexpr std::uint64_t hash_seed(std::uint32_t index) {
  return (Store::k_domain << 32) + (Store::k_has_key ? 0 : index);
}

/// Calls `f(index, record)` for each record of a store in order.
template <class Store, class State, class F>
void for_each_record(const State& state, F&& f) {
  std::uint32_t index = 0;
  state.visit(Store{}, [&](auto records) {
    for (const auto& record : records)
      f(index++, record);
  });
}

}  // namespace lockstone
