// Creates, breaks and destroys joints, and keeps the joint graph in step with their records.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/event.h>
#include <lockstone/joint.h>
#include <lockstone/status.h>
#include <lockstone/transform.h>

#include "core/dynamics/state/joint_record.h"
#include "core/world/data/world_data.h"
#include "core/world/sleep/waking.h"

namespace lockstone {

class JointRegistry {
 public:
  /// No function but this allocates. Both outlive this.
  JointRegistry(WorldData& world, Waking& waking);

  Result<JointHandle> create(const JointDef& def);
  void destroy(std::uint32_t joint);
  void destroy_all_of(std::uint32_t body);
  /// Destroys the joints whose load exceeds their limits, by index, and notes an event for each.
  void break_overloaded();
  /// The teeth of ratchets and places on paths follow the bodies after a step.
  void advance();
  /// The joints of awake bodies may have changed in a step.
  void mark_awake();

  /// Whether the joints of a body may sit where they do once it becomes `changed`.
  [[nodiscard]] bool fits(std::uint32_t body, const BodyRecord& changed) const;

  /// Whether each joint of a body would still hold a dynamic one.
  [[nodiscard]] bool hold_dynamic(std::uint32_t body, const BodyRecord& changed) const;
  /// Whether the joints of a body may sit where they do once it becomes `changed`, and its centre
  /// of mass and principal axes move `from` … `to`, both in the frame of its shape.
  [[nodiscard]] bool fit_moved(std::uint32_t body, const BodyRecord& changed, const Transform& from,
                               const Transform& to) const;
  /// Moves them there.
  void move_frames(std::uint32_t body, const Transform& from, const Transform& to);
  /// A body is somewhere else: teeth of ratchets and places on paths begin as of new joints.
  void restart_joints_of(std::uint32_t body);
  /// The impulses of the last tick are none of the body as it is now.
  void forget_impulses_of(std::uint32_t body);

  /// Derives the graph from the records.
  void rebuild();

  /// Joints that broke in the last step.
  [[nodiscard]] const std::vector<JointEvent>& events() const { return events_; }
  void clear_events() { events_.clear(); }
  void set_events(std::span<const JointEvent> events) {
    events_.assign(events.begin(), events.end());
  }

 private:
  WorldData& world_;
  Waking& waking_;
  std::uint32_t free_hint_ = 0;  // no index below this is free
  std::vector<JointEvent> events_;
};

/// A joint as a game sees it, with the forces of the last step.
[[nodiscard]] JointView view_of(const WorldData& world, const JointRecord& joint);

}  // namespace lockstone
