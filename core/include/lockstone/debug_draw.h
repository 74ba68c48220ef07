// Debug drawing: the present state of every body, contact and joint of a world, in the order of the
// state, in integers and metres.
//
// A game derives from DebugDraw and overrides the calls it wants to see. Drawing reads the state
// alone, changes nothing and allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/joint.h>
#include <lockstone/transform.h>

namespace lockstone {

/// The activity of a body, for its colour.
enum class DebugState : std::uint8_t {
  static_body,
  kinematic,
  awake,
  asleep,
  trigger,
};
[[nodiscard]] std::string_view to_string(DebugState state);

/// A body's shape where it is. Hulls, meshes, height fields and compounds name their asset, whose
/// geometry `Hull::vertices` and `Compound::children` tell, or `Asset::canonical_bytes` of any.
struct DebugShape {
  BodyHandle body{};             ///< whose shape it is
  DebugState state{};            ///< for a colour
  Shape shape{};                 ///< as in BodyView
  Transform pose{};              ///< of the shape's frame
  Mat3 rotation{};               ///< the same orientation
  const Asset* asset = nullptr;  ///< null: a shape complete in itself

  /// The least body of those that contacts and joints tie together, this one among them; null for
  /// bodies that are not dynamic.
  BodyHandle island{};
  std::uint64_t user_data = 0;  ///< the body's
};

/// The bounds that the broad phase has of a body: where it may go in the next tick.
struct DebugBounds {
  BodyHandle body{};       ///< whose bounds they are
  Vec3<Position> lower{};  ///< m
  Vec3<Position> upper{};  ///< m
};

/// The centre of mass and the principal axes of a dynamic body.
struct DebugMass {
  BodyHandle body{};        ///< a dynamic one
  Vec3<Position> centre{};  ///< m
  Mat3 axes{};              ///< the columns
  Mass mass{};              ///< kg
};

struct DebugContactPoint {
  Vec3<Position> point{};     ///< in the middle between the surfaces
  Displacement separation{};  ///< negative when overlapping
  Force force{};              ///< along the normal in the last substep, ≥ 0
};

/// The contact of two convex parts, or of one with the triangles of one plane.
struct DebugContact {
  BodyHandle a{};                             ///< the body with the lower index
  BodyHandle b{};                             ///< the other one
  Vec3<Unit> normal{};                        ///< from a to b
  bool touching = false;                      ///< in the last step
  Vec3<Force> friction{};                     ///< on b in the last substep, of all points
  std::uint32_t count = 0;                    ///< of points, 0 … 4
  std::array<DebugContactPoint, 4> points{};  ///< the first `count`
};

/// A joint with its two frames where they are.
struct DebugJoint {
  JointHandle joint{};                   ///< whose frames they are
  JointView view{};                      ///< its displacement, force and torque
  Vec3<Position> place_a{};              ///< m, of frame a
  Vec3<Position> place_b{};              ///< m, of frame b
  Mat3 frame_a{};                        ///< its axes are the columns
  Mat3 frame_b{};                        ///< as frame_a
  std::array<AxisMode, 6> modes{};       ///< linear, then angular
  std::array<Length, 3> linear_lower{};  ///< m
  std::array<Length, 3> linear_upper{};  ///< m
  std::array<Angle, 3> angular_lower{};  ///< rad
  std::array<Angle, 3> angular_upper{};  ///< rad
  Vec3<Position> ground_a{};             ///< of a pulley
  Vec3<Position> ground_b{};             ///< of a pulley
};

/// Called by `World::draw`, whose world it must not change.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;

  virtual void draw_shape(const DebugShape&) {}      ///< each body; wheels as spheres
  virtual void draw_bounds(const DebugBounds&) {}    ///< each body
  virtual void draw_mass(const DebugMass&) {}        ///< each dynamic body
  virtual void draw_contact(const DebugContact&) {}  ///< each contact
  virtual void draw_joint(const DebugJoint&) {}      ///< each joint
};

/// The items to draw. Contacts are found again from the bodies' poses, which takes as long as the
/// narrow phase of a tick does.
struct DebugDrawOptions {
  bool shapes = true;     ///< call draw_shape
  bool bounds = false;    ///< call draw_bounds
  bool masses = false;    ///< call draw_mass
  bool contacts = false;  ///< call draw_contact
  bool joints = false;    ///< call draw_joint
};

}  // namespace lockstone
