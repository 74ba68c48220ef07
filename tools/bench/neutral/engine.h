// The interface of an engine that is compared with others.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "tools/bench/neutral/scene.h"

namespace lockstone::bench {

/// In metres, seconds and radians, in the world's frame; orientation x, y, z, w.
struct BodyState {
  Triple position{};
  std::array<double, 4> orientation{0, 0, 0, 1};
  Triple velocity{};
  Triple angular_velocity{};
};

/// Holds one scene. Nothing in it sleeps or is damped.
class NeutralEngine {
 public:
  virtual ~NeutralEngine() = default;

  /// A sixtieth of a second, in as many parts as the setting says.
  virtual void step() = 0;
  virtual void set_gravity(const Triple& gravity) = 0;
  virtual void set_velocity(int body, const Triple& velocity) = 0;
  [[nodiscard]] virtual BodyState state(int body) const = 0;
  /// Of the whole state; 0 where an engine has none.
  [[nodiscard]] virtual std::uint64_t hash() const { return 0; }
};

/// An engine, in this build or not.
struct NeutralMaker {
  std::string_view name;
  std::string_view knob;  ///< the unit of a setting
  /// Null when the engine is not in this build, or cannot do the scene.
  std::unique_ptr<NeutralEngine> (*make)(const NeutralScene& scene, int setting);
};

/// Ours.
[[nodiscard]] NeutralMaker lockstone_maker();

}  // namespace lockstone::bench
