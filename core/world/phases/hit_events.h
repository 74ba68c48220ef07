// Hit events of a tick: contacts and stops on the way that came together faster than the bodies'
// hit speeds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/event.h>

#include "core/dynamics/impact/impact_total.h"
#include "core/dynamics/state/limits.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/step_records.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

struct ImpulseTotal;
class ImpulseTotals;

/// The hit speed that counts for two bodies; 0: they have no hit events.
[[nodiscard]] SolverVelocity hit_speed_of(const BodyRecord& a, const BodyRecord& b);

/// The parts of an event that follow from the bodies and the impulses of an impact.
[[nodiscard]] HitEvent hit_of(const WorldData& world, const Pair& pair, const ImpactTotal& total);

/// The part of a body that is nearest to a point on its surface: a triangle or cell of a mesh or
/// height field; `part` of any other body.
[[nodiscard]] std::uint32_t part_at(const WorldData& world, std::uint32_t body,
                                    const Vec3<Position>& point, std::uint32_t part);

/// The most hits of a tick: those of contacts, and stops.
[[nodiscard]] constexpr std::size_t most_listed(const WorldDef& def) {
  return most_hits(def.body_capacity) + def.body_capacity;
}

/// Costs nothing where no body has a hit speed.
class HitEvents {
 public:
  /// No function but this allocates. Both outlive this.
  HitEvents(WorldData& world, TickContacts& found);

  /// Before the solver: forgets the last tick's events, and lists the contacts that it watches.
  void begin();
  [[nodiscard]] std::span<const WatchedContact> watched() const { return watched_; }

  /// After the solver, before bodies move.
  void add_solved(const ImpulseTotals& totals);
  /// The contacts that bounced within the tick, while `found` still has their manifolds. None are
  /// given where none are watched.
  void add_bounced(std::span<const BouncingContact> contacts, std::span<const ImpactTotal> totals);
  /// Once all contacts were added: brings them in order. `stops` follow.
  void finish(std::span<const HitEvent> stops);

  /// Whether some may have been left out in the last tick, because there are too many: which ones
  /// depends on the whole world.
  [[nodiscard]] bool has_left_out() const { return left_out_; }

  [[nodiscard]] const std::vector<HitEvent>& list() const { return events_; }
  void set(std::span<const HitEvent> events) { events_.assign(events.begin(), events.end()); }

 private:
  [[nodiscard]] bool is_full();
  void add_solved(const ImpulseTotal& total);
  void name_parts(const ContactRecord& record, const ContactSurface& surface,
                  HitEvent& event) const;

  WorldData& world_;
  TickContacts& found_;
  std::vector<WatchedContact> watched_;
  std::vector<HitEvent> events_;
  bool left_out_ = false;
};

}  // namespace lockstone
