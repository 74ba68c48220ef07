// The interface of an engine that plays the scenes of families.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tools/bench/general/scene.h"

namespace lockstone::bench {

/// In the world's frame; the position is that of the body's own frame.
struct GeneralState {
  Triple position{};
  Turn orientation{0, 0, 0, 1};
  Triple velocity{};
  Triple angular_velocity{};
};

/// With which a body comes.
[[nodiscard]] inline GeneralState coming(const GeneralBody& body) {
  return {body.position, body.orientation, body.velocity, body.angular_velocity};
}

/// Plays one scene, which must outlive it. Sleep is off unless the scene asks for it.
class GeneralEngine {
 public:
  virtual ~GeneralEngine() = default;

  /// Before a step: those at the beginning are there already.
  virtual void change(const GeneralChange& change) = 0;
  /// A sixtieth of a second.
  virtual void step() = 0;
  virtual void set_motion(int body, const Triple& velocity, const Triple& angular_velocity) = 0;
  virtual void set_gravity(const Triple& gravity) = 0;
  /// Of an absent body: with which it comes.
  [[nodiscard]] virtual GeneralState state(int body) const = 0;
  [[nodiscard]] virtual bool asleep(int body) const = 0;
  /// Whether any trigger saw the body in the last step.
  [[nodiscard]] virtual bool entered(int body) const = 0;
  /// Pairs with contact points in the last step; 0 where an engine does not count them.
  [[nodiscard]] virtual std::uint32_t contacts() const { return 0; }
  /// Whether every step so far had room for all contacts.
  [[nodiscard]] virtual bool had_room() const { return true; }
  /// Of the whole state; 0 where an engine has none.
  [[nodiscard]] virtual std::uint64_t hash() const { return 0; }
  /// SVG; empty where an engine draws nothing.
  [[nodiscard]] virtual std::string picture(const std::string&) const { return {}; }
};

struct GeneralMaker {
  std::string_view name;
  std::string_view absent;  ///< why it is not in this build; empty when it is
  /// Null when the engine cannot do the scene.
  std::unique_ptr<GeneralEngine> (*make)(const GeneralScene& scene, int substeps) = nullptr;
};

/// Ours; and with contacts that are only iterated, as in a world of 0 `converged_contacts`.
[[nodiscard]] GeneralMaker lockstone_general();
[[nodiscard]] GeneralMaker lockstone_iterated();

/// Those that the project knows of, in this build or not.
[[nodiscard]] std::span<const GeneralMaker> general_peers();

}  // namespace lockstone::bench
