// The impulses of two bodies that meet within a tick, and where they met.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Impulses are on B, as the pair's velocity jump λ·(1/mA + 1/mB): the change of the relative
/// velocity of their centres. Place and normal are those of the fastest approach.
struct ImpactTotal {
  Velocity approach{};
  Vec3<Velocity> jump{};  // the sum
  Vec3<Unit> normal{};
  Vec3<Position> point{};

  void add(Velocity speed, const Vec3<Velocity>& by, const Vec3<Unit>& along,
           const Vec3<Position>& at) {
    jump += by;
    if (speed <= approach) return;
    approach = speed;
    normal = along;
    point = at;
  }
};

}  // namespace lockstone
