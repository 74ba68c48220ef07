// Continuous collision: bodies that move farther in a tick than half their thickness stop at the
// obstacles on their way, and so do bodies that fast kinematic bodies run into (sweepers.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/event.h>
#include <lockstone/world.h>

#include "core/collision/broad_phase/bounds.h"
#include "core/collision/continuous/first_impact.h"
#include "core/dynamics/state/body_record.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/hit_events.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/narrow/narrow_phase.h"
#include "core/world/sleep/waking.h"

namespace lockstone {

class TriggerPasses;

/// A ball in a corner meets three walls; a body with this many impacts in a tick stays where it is.
inline constexpr int k_max_impacts = 4;

/// Marks of a body that moved in this tick.
enum FarMover : std::uint8_t {
  k_far_mover = 1,     // moved farther than half its thickness
  k_joined_mover = 2,  // joints connect it to one that did
  k_swept_over = 4,    // near the way of a sweeper
  k_sweeper = 8,
};

/// The next impact on a body's way (continuous.cpp).
struct NextImpact {
  std::uint32_t body = 0;
  Impact impact{};
};

/// A body that sweeps over others (sweepers.cpp).
struct Sweeper {
  std::uint32_t body = 0;
  RotationVector rotation{};  // in the tick
  Bounds way{};
};

/// The bodies that were stopped on their way in a tick, in the order of their impacts.
struct Stops {
  std::vector<ContactEvent> impacts;
  std::vector<HitEvent> hits;
  /// Still bodies that others were stopped at, each once: they did not move, but have a velocity.
  std::vector<std::uint32_t> still;
};

class ContinuousCollision {
 public:
  /// No function but this allocates. All outlive this.
  ContinuousCollision(WorldData& world, MovedBodies& moved, NarrowPhase& narrow, Waking& waking,
                      TriggerPasses& passes);

  /// Marks a body that moved far, after its move. Again when an impact changes its turning before
  /// its own way is examined.
  void note_far_mover(std::uint32_t body);
  /// Moves bodies back to their first impacts, resolves these and moves them on.
  void run(StepReport& report);
  /// Before a tick: wakes the sleepers that kinematic bodies will run into, and stirs still bodies
  /// that kinematic bodies and triggers may.
  void wake_struck();

  [[nodiscard]] const Stops& stops() const { return stops_; }
  [[nodiscard]] std::span<const Sweeper> sweepers() const { return sweepers_; }
  [[nodiscard]] std::uint8_t marks(std::uint32_t body) const { return far_movers_[body]; }
  [[nodiscard]] bool is_sweeper(std::uint32_t body) const;
  [[nodiscard]] Bounds bounds_on_way(std::uint32_t body, const Sweep& motion) const;
  /// The body's motion from `done` to the end of the tick.
  [[nodiscard]] Sweep motion_of(std::uint32_t body, Unit done) const;

 private:
  /// From a pose to that of `end`.
  [[nodiscard]] bool goes_far(std::uint32_t body, const Transform& start,
                              const BodyRecord& end) const;
  void sweep_body(std::uint32_t body, StepReport& report);
  void sweep_joined(std::uint32_t body, StepReport& report);
  void list_joined(std::uint32_t body);
  template <class F>
  void visit_sweepers(std::uint32_t body, const Bounds& way, F&& f) const;
  template <class F>
  void visit_obstacles(std::uint32_t body, const Bounds& way, F&& f) const;
  [[nodiscard]] NextImpact find_impact(std::uint32_t body, const Sweep& motion, Unit done) const;
  void resolve(std::uint32_t body, const NextImpact& next, Unit done);
  [[nodiscard]] Sweep motion_in_tick(std::uint32_t body) const;
  [[nodiscard]] Sweep go_on(BodyRecord& record, Unit left) const;
  void list_sweepers();
  void find_struck(std::uint32_t sweeper);
  [[nodiscard]] bool carries(std::uint32_t body) const;
  void push_out(std::uint32_t body, std::uint32_t sweeper);
  void carry_joined(std::uint32_t body, const Sweep& by);

  WorldData& world_;
  MovedBodies& moved_;
  NarrowPhase& narrow_;
  Waking& waking_;
  TriggerPasses& passes_;
  std::vector<std::uint8_t> far_movers_;      // FarMover, by body that moved
  std::vector<std::uint32_t> joined_movers_;  // bodies that stop together
  std::vector<Sweeper> sweepers_;             // of this tick, by body
  std::vector<std::uint32_t> struck_;         // sleepers
  Stops stops_;                               // of this tick
};

}  // namespace lockstone
