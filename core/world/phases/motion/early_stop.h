// Keeps bodies from gaining energy that continuous collision stops before a tick's end.
//
// Bodies connected by joints stop together and lose the rest of the tick, but their velocities are
// those of its end. So the work that gravity and forces did on the ways that they lose is taken
// from their kinetic energy, as far as they have more than the tick's beginning and the ways that
// they went account for: all velocities shrink alike, so that joints hold as before.
#pragma once

#include <cstdint>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/math/block_float.h"
#include "core/world/phases/motion/moved_bodies.h"

namespace lockstone {

class EarlyStop {
 public:
  EarlyStop(const Vec3<Acceleration>& gravity, const TimeStep& step)
      : gravity_(gravity), step_(step) {}

  /// A dynamic body as it is at the tick's end, as it was at its beginning, and the place in
  /// between where it will stop.
  void add(const BodyRecord& body, const Transform& start, const BodySpeeds& start_speeds,
           const Vec3<Position>& stop);

  /// Once all have been added: shrinks a body's velocities.
  void slow(BodyRecord& body) const;

 private:
  [[nodiscard]] std::int64_t work_on(const Vec3<Velocity>& gain, const Vec3<Position>& from,
                                     const Vec3<Position>& to) const;

  Vec3<Acceleration> gravity_;
  const TimeStep& step_;
  BlockFloat unit_{};  // inverse mass of the first body
  // Twice, by the first body's mass.
  std::int64_t energy_ = 0;  // kinetic
  std::int64_t gain_ = 0;    // of it, besides the work on the ways that are gone
  std::int64_t lost_ = 0;    // the work on those that are lost
};

}  // namespace lockstone
