// The contacts and joints of a body at any time, and the hits of a step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/body.h>
#include <lockstone/event.h>
#include <lockstone/joint.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

class World;

/// A point of a contact between two bodies.
struct TouchingPoint {
  Vec3<Position> point{};     ///< m, in the middle between both surfaces
  Displacement separation{};  ///< m; negative when overlapping
  Force normal_force{};       ///< N, ≥ 0, in the last substep; 0 of a point that is new since

  friend bool operator==(const TouchingPoint&, const TouchingPoint&) = default;
};

/// A contact of a body with another. Forces are those of the last substep of the last step: divided
/// by the tick rate they are the impulse of a tick.
struct BodyContact {
  BodyHandle other{};
  Vec3<Unit> normal{};   ///< from the body to the other; zero without points
  Force normal_force{};  ///< N, ≥ 0: pushes the other along the normal, at all points; 0 in a
                         ///< tick in which the solver gives the island up
  Vec3<Force> friction{};   ///< N, on the other
  std::uint32_t count = 0;  ///< of points: 0 where the two parted within the step
  std::array<TouchingPoint, 4> points{};
  std::uint32_t part = 0;  ///< triangle, cell or child of the body's asset
  std::uint32_t other_part = 0;
  std::uint32_t tag = 0;  ///< Surface::tag of the body where they meet
  std::uint32_t other_tag = 0;

  friend bool operator==(const BodyContact&, const BodyContact&) = default;
};

/// The contacts in which a body touches others as of the last step, by the other's index and parts,
/// as many as `out` holds; returns how many were written, 0 for a body that does not exist. Follows
/// from the state. Takes a look at every contact of an awake body.
std::size_t contacts_of(const World& world, BodyHandle body, std::span<BodyContact> out);

/// The joints of a body, by index, as many as `out` holds; returns how many were written.
std::size_t joints_of(const World& world, BodyHandle body, std::span<JointHandle> out);

/// The hits of the last step between bodies that ask for them; empty after `load`. Read them before
/// the next step: they are not state.
[[nodiscard]] std::span<const HitEvent> hit_events(const World& world);

}  // namespace lockstone
