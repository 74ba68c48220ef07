#include "core/world/phases/motion/moved_bodies.h"

#include <lockstone/assert.h>

#include "core/kernels/rotations/rotations.h"

namespace lockstone {

MovedBodies::MovedBodies(WorldData& world)
    : world_(world),
      starts_(world.def.body_capacity),
      start_speeds_(world.def.joint_capacity == 0 ? 0 : world.def.body_capacity),
      leaves_fat_box_(world.def.body_capacity) {
  bodies_.reserve(world.def.body_capacity);
  looks_.reserve(most_looks(world.def));
}

void MovedBodies::list_awake(std::span<const std::uint32_t> still) {
  bodies_.clear();
  for (const std::uint32_t body : world_.awake.list()) {
    if (!still.empty() && still.front() == body) {
      still = still.subspan(1);
      note_start(body);
      continue;
    }
    bodies_.push_back(body);
    world_.hashes.bodies.mark(body);
  }
  LKS_ASSERT(still.empty());
}

Loop MovedBodies::pieces() const {
  constexpr std::uint32_t k_body_grain = 32;
  return {static_cast<std::uint32_t>(bodies_.size()), k_body_grain};
}

// As `WorldData::refresh` does for each, with the rotations all at once. Only a body that leaves
// its fat box changes more of the broad phase than its own bounds.
void MovedBodies::refresh() {
  std::atomic<bool> changed{false};
  world_.parallel.for_each(pieces(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    refresh_piece(first, end, changed);
  });
  if (changed) world_.broad_phase.note_change();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (leaves_fat_box_[i] != 0) world_.refresh_bounds(bodies_[i]);
  }
  if (!bodies_.empty()) world_.broad_phase.settle();
}

void MovedBodies::refresh_piece(std::uint32_t first, std::uint32_t end,
                                std::atomic<bool>& changed) {
  LKS_ASSERT(first < end && end <= bodies_.size());
  const lanes::QuatField orientations{&world_.bodies.front().orientation, sizeof(BodyRecord)};
  lanes::compute_rotations(orientations, std::span(bodies_).subspan(first, end - first),
                           world_.cache.rotations_out());
  bool any = false;
  for (std::uint32_t i = first; i < end; ++i) {
    const std::uint32_t body = bodies_[i];
    world_.cache.refresh_turned(body, world_.bodies[body]);
    const Bounds bounds = world_.bounds_of(body);
    any = any || bounds != world_.broad_phase.bounds(body);
    leaves_fat_box_[i] = world_.broad_phase.update(body, bounds) ? 0 : 1;
  }
  if (any) changed.store(true, std::memory_order_relaxed);
}

}  // namespace lockstone
