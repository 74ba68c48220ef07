// Surface materials of bodies and of parts of assets, and how two surfaces combine.
#pragma once

#include <cstdint>
#include <string_view>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// How a property of two surfaces becomes one of the pair. Where the two ask for different rules
/// the later of this list decides, so that `standard` yields to every other.
enum class CombineRule : std::uint8_t {
  standard = 0,  ///< friction: geometric mean; restitution and rolling resistance: maximum
  average = 1,
  geometric_mean = 2,  ///< √(a·b)
  minimum = 3,
  multiply = 4,
  maximum = 5,
};
[[nodiscard]] std::string_view to_string(CombineRule rule);

/// The surface of a body, or of a part of an asset where that differs from the body's own.
struct Surface {
  Coefficient friction = Coefficient::from_ratio(1, 2);  ///< 0 … 1.99
  Coefficient restitution{};                             ///< 0 … 1

  /// 0 … 1: a torque of up to this times radius times normal force works against rolling. The
  /// radius is that of the sphere or capsule that rolls (of the smaller of two), of other shapes
  /// that of the largest sphere inside the body.
  Coefficient rolling_resistance{};

  CombineRule friction_rule{};     ///< with the other surface
  CombineRule restitution_rule{};  ///< with the other surface
  CombineRule rolling_rule{};      ///< with the other surface
  std::uint32_t tag = 0;  ///< the game's own: which sound, say. Found in events and queries

  friend constexpr bool operator==(const Surface&, const Surface&) = default;
};

/// Surface and substance.
struct Material {
  Coefficient friction = Coefficient::from_ratio(1, 2);  ///< as in Surface
  Coefficient restitution{};                             ///< as in Surface
  Density density = Density::from_integer(1000);         ///< > 0
  Coefficient rolling_resistance{};                      ///< as in Surface
  CombineRule friction_rule{};                           ///< as in Surface
  CombineRule restitution_rule{};                        ///< as in Surface
  CombineRule rolling_rule{};                            ///< as in Surface
  std::uint32_t tag = 0;                                 ///< as in Surface

  [[nodiscard]] constexpr Surface surface() const {
    return {friction,     restitution, rolling_resistance, friction_rule, restitution_rule,
            rolling_rule, tag};
  }
};

/// The motion of a surface that stays in place, as of a conveyor belt or a turntable: in the axes
/// of the body's shape, about the shape's origin. Friction drives touching bodies towards it.
struct SurfaceMotion {
  Vec3<SolverVelocity> velocity{};  ///< each component within ±500 m/s
  Vec3<Rate> turning{};             ///< rad/s, each component within ±500

  friend constexpr bool operator==(const SurfaceMotion&, const SurfaceMotion&) = default;
};

}  // namespace lockstone
