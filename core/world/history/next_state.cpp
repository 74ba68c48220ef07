#include "core/world/history/next_state.h"

#include <compare>
#include <cstring>

namespace lockstone {
namespace {

// Writes records one behind the other.
class RecordWriter {
 public:
  explicit RecordWriter(std::span<std::byte> out) : out_(out) {}

  template <class Record>
  void put(const Record& record) {
    std::memcpy(out_.data() + size_, &record, sizeof(record));
    size_ += sizeof(record);
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::span<std::byte> out_;
  std::size_t size_ = 0;
};

// Bodies that do not move stay as they are.
void write_bodies(const WorldData& world, const ComputedBodies& computed,
                  const NativeState<WorldStores>& after, RecordWriter& to) {
  BodyRecord record;
  for (std::uint32_t i = 0; i < world.header.body_limit; ++i) {
    if (computed.has(i) || !links_others(world.bodies[i])) {
      to.put(world.bodies[i]);
    } else {
      after.read<BodyStore>(i, record);
      to.put(record);
    }
  }
}

void write_joints(const WorldData& world, const ComputedBodies& computed,
                  const NativeState<WorldStores>& before, const NativeState<WorldStores>& after,
                  RecordWriter& to) {
  JointRecord record;
  for (std::uint32_t i = 0; i < world.header.joint_limit; ++i) {
    before.read<JointStore>(i, record);
    if (!record.exists() || computed.has_any(record.body_a, record.body_b)) {
      to.put(world.joints[i]);
    } else {
      after.read<JointStore>(i, record);
      to.put(record);
    }
  }
}

// The contacts from memory that are not computed, in their order.
class KnownContacts {
 public:
  KnownContacts(const NativeState<WorldStores>& after, const ComputedBodies& computed)
      : after_(after), computed_(computed) {
    find();
  }

  [[nodiscard]] bool is_before(const ContactKey& key) const {
    return at_ < after_.header.contact_count && record_.key() < key;
  }
  [[nodiscard]] bool is_done() const { return at_ == after_.header.contact_count; }
  [[nodiscard]] const ContactRecord& record() const { return record_; }
  void next() {
    ++at_;
    find();
  }

 private:
  void find() {
    for (; at_ < after_.header.contact_count; ++at_) {
      after_.read<ContactStore>(at_, record_);
      if (!computed_.has_any(record_.body_a, record_.body_b)) return;
    }
  }

  const NativeState<WorldStores>& after_;
  const ComputedBodies& computed_;
  std::uint32_t at_ = 0;
  ContactRecord record_;
};

// Returns how many there are; beyond the capacity none is written.
std::uint32_t write_contacts(const WorldData& world, const ComputedBodies& computed,
                             const NativeState<WorldStores>& after, RecordWriter& to) {
  std::uint32_t count = 0;
  const auto put = [&](const ContactRecord& record) {
    if (count++ < world.def.contact_capacity) to.put(record);
  };
  KnownContacts known(after, computed);
  world.for_each_contact([&](const ContactRecord& record) {
    if (!computed.has_any(record.body_a, record.body_b)) return;
    for (; known.is_before(record.key()); known.next())
      put(known.record());
    put(record);
  });
  for (; !known.is_done(); known.next())
    put(known.record());
  return count;
}

// Events come in three parts: pairs of bodies, in their order; impacts; bodies that fell asleep or
// woke.
struct EventPlace {
  int part = 0;
  Pair bodies;

  friend auto operator<=>(const EventPlace&, const EventPlace&) = default;
};

EventPlace place_of(const ContactEvent& event) {
  switch (event.kind) {
    case EventKind::impact:
      return {1, {}};
    case EventKind::sleep:
    case EventKind::wake:
      return {2, {event.a.index, 0}};
    default:
      return {0, {event.a.index, event.b.index}};
  }
}
EventPlace place_of(const HitEvent& event) {
  if (event.was_stopped) return {1, {}};
  return {0, {event.a.index, event.b.index}};
}
std::uint32_t place_of(const JointEvent& event) {
  return event.joint.index;
}

bool is_computed(const ContactEvent& event, const ComputedBodies& computed) {
  return computed.has(event.a.index) || (!event.b.is_null() && computed.has(event.b.index));
}
bool is_computed(const HitEvent& event, const ComputedBodies& computed) {
  return computed.has_any(event.a.index, event.b.index);
}
bool is_computed(const JointEvent& event, const ComputedBodies& computed) {
  return computed.has_any(event.a.index, event.b.index);
}

template <class Event>
void merge(std::span<const Event> now, std::span<const Event> known, const ComputedBodies& computed,
           std::vector<Event>& events) {
  events.clear();
  for (const Event& event : known) {
    if (is_computed(event, computed)) continue;
    for (; !now.empty() && place_of(now.front()) < place_of(event); now = now.subspan(1))
      events.push_back(now.front());
    events.push_back(event);
  }
  events.insert(events.end(), now.begin(), now.end());
}

}  // namespace

bool write_next_state(const WorldData& world, const ComputedBodies& computed,
                      const TickMemory& known, TickMemory& next) {
  const NativeState<WorldStores> before = next.before.open(world.def);
  const NativeState<WorldStores> after = known.after.open(world.def);
  RecordWriter to(next.after.out());
  WorldHeader header = world.header;
  to.put(header);
  write_bodies(world, computed, after, to);
  header.contact_count = write_contacts(world, computed, after, to);
  if (header.contact_count > world.def.contact_capacity) return false;
  write_joints(world, computed, before, after, to);
  for (std::uint32_t i = 0; i < header.fluid_limit; ++i)
    to.put(world.fluids[i]);
  for (const PairRuleRecord& rule : pair_rules_of(world, header))
    to.put(rule);
  for (const SurfaceRuleRecord& rule : surface_rules_of(world, header))
    to.put(rule);
  for (const VehicleRecord& vehicle : std::span(world.vehicles).first(header.vehicle_count))
    to.put(vehicle);
  world.visit(TerrainTileStore{}, [&](auto tiles) {
    for (const TerrainTileRecord& tile : tiles)
      to.put(tile);
  });
  next.after.set_size(to.size());
  std::memcpy(next.after.out().data(), &header, sizeof(header));
  return true;
}

void merge_events(std::span<const ContactEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<ContactEvent>& events) {
  merge(now, std::span<const ContactEvent>(known.events), computed, events);
}

void merge_events(std::span<const HitEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<HitEvent>& events) {
  merge(now, std::span<const HitEvent>(known.hit_events), computed, events);
}

void merge_events(std::span<const JointEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<JointEvent>& events) {
  merge(now, std::span<const JointEvent>(known.joint_events), computed, events);
}

}  // namespace lockstone
