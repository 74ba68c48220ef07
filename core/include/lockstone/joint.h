// Joints hold two bodies together, limit their relative motion, and drive it.
//
// A joint has a frame on each body. Frame B moves against frame A in six ways: along the three axes
// of frame A, and about them. Each of the six is locked, free or limited, and may have a drive (a
// spring or a motor). All kinds but distance, pulley, gear and rack are settings of these six; a
// ratchet is a hinge besides, and the frame A of a path joint goes along a path.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <lockstone/body.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Names a joint. A handle whose joint was destroyed never names another one. Default: no joint.
struct JointHandle {
  std::uint32_t index = 0;       ///< in the store of joints
  std::uint32_t generation = 0;  ///< 0 only in the null handle

  friend constexpr auto operator<=>(const JointHandle&, const JointHandle&) = default;
  [[nodiscard]] constexpr bool is_null() const { return generation == 0; }
};

enum class JointKind : std::uint8_t {
  distance = 1,  ///< two points, kept at a distance: rod, rope or spring (linear[0])
  ball = 2,      ///< a point in common; swing in a cone and twist may be limited
  hinge = 3,     ///< turns about the x axis
  slider = 4,    ///< moves along the x axis
  weld = 5,      ///< nothing moves, or softly
  wheel = 6,     ///< axle x, suspension along y, steering about y; body a is the chassis
  motor = 7,     ///< drives one body towards a pose or a velocity against the other
  six_axis = 8,  ///< each axis as its settings say
  pulley = 9,  ///< length a + ratio · length b stays, each from a point to one fixed in the world
  gear = 10,   ///< turning about x of frame a + ratio · that about x of frame b stays 0
  rack = 11,   ///< turning about x of frame a + ratio · motion along x of frame b stays 0
  ratchet = 12,  ///< a hinge that turns one way: `ratio` teeth in a turn hold it
  path = 13,     ///< the point of frame b stays on a path that is fixed to frame a
};
inline constexpr JointKind k_last_joint_kind = JointKind::path;
[[nodiscard]] std::string_view to_string(JointKind kind);

/// Returns whether one equation of its own takes the place of the kind's six axes.
[[nodiscard]] constexpr bool has_own_equation(JointKind kind) {
  return kind == JointKind::pulley || kind == JointKind::gear || kind == JointKind::rack;
}

enum class AxisMode : std::uint8_t {
  locked = 0,   ///< stays at 0; with a spring (hertz > 0) softly
  free = 1,     ///< moves as it likes, or as its drive does
  limited = 2,  ///< stays within lower … upper
};
[[nodiscard]] std::string_view to_string(AxisMode mode);

/// One way to move. `Value` is a length or an angle.
///
/// The drive is on when `hertz` or `max_effort` is above 0. With `hertz` = 0 it is a motor that
/// holds `speed` with at most `max_effort`; speed 0 is friction. With `hertz` > 0 it is a spring of
/// the frequency and damping that the two bodies alone would have, towards `target`, damped against
/// `speed`, and `max_effort` = 0 means as strong as need be. Frequencies above a quarter of the
/// substep rate act as that.
///
/// Where all three angular axes are locked without hertz, frame B stays at the rotation vector of
/// their `target`s, and turns there within the coming tick: it arrives as the tick ends, with
/// `speed` in the axes of the target, and then `speed` is 0. As strong as need be. Without a speed
/// a new target closes as an opening of the lock does.
template <class Value, class Speed, class Effort>
struct JointAxis {
  AxisMode mode = AxisMode::free;  ///< locked, free or limited
  Value lower{};                   ///< limits, lower ≤ upper: for angles within ±π
  Value upper{};                   ///< as `lower`: m or rad
  Value target{};  ///< of the spring; of springs and locks about several axes: a rotation vector
  Speed speed{};   ///< of the motor, or of locks that turn
  Number hertz{};  ///< 0 … 1000
  Number damping_ratio = Number::from_integer(1);  ///< 0 … 100
  Effort max_effort{};                             ///< ≥ 0, N or N·m

  friend bool operator==(const JointAxis&, const JointAxis&) = default;
};
using LinearAxis = JointAxis<Length, SolverVelocity, Force>;
using AngularAxis = JointAxis<Angle, Rate, Torque>;

/// Where a joint sits on a body: in the frame of its shape. Within k_max_anchor_ratio; the
/// orientation is normalised.
struct JointFrame {
  Vec3<Length> position{};  ///< m, in the frame of the shape
  Quat orientation{};       ///< any length but 0
};

/// Anchors are at most this many times the body's radius (rounded up to a power of two) from its
/// centre of mass, along each axis; of a body that does not turn at most 1024 m.
inline constexpr int k_max_anchor_ratio = 64;

/// A joint to be made. At least one body must be dynamic, and they must differ. To fasten something
/// to the world, give a static body.
///
/// Angles: [0] is the twist, the turn of B about its x axis; [1] and [2] are the swing, the tilts
/// of that axis about y and z of frame A. The swing of a ball joint is a cone about x: its half
/// angle is angular[1].upper, when that is limited.
///
/// A ratchet turns up about x, and not back over the last tooth that it passed; a tick in which it
/// turns by more than a half turn may lose count. angular[0] limits it so, whatever its lower and
/// upper; free lifts the pawl. The teeth are at whole parts of a turn from frame A; where it
/// begins, the tooth at or below it holds.
///
/// A path joint has its x axis along the path, its z axis up: linear[0] is the distance from the
/// path's beginning, free or limited, and limited to the whole path by JointDef::of; free, it may
/// go straight on beyond the ends. linear[1] and [2] stay locked. The angular axes are free, unless
/// settings have the body follow the path's direction. It begins at the nearest point of the path.
struct JointDef {
  JointKind kind = JointKind::ball;        ///< fixed for the joint's life
  BodyHandle body_a{};                     ///< must exist
  BodyHandle body_b{};                     ///< must exist; not body_a
  JointFrame frame_a{};                    ///< on body_a
  JointFrame frame_b{};                    ///< on body_b
  std::array<LinearAxis, 3> linear{};      ///< along x, y, z of frame a
  std::array<AngularAxis, 3> angular{};    ///< twist, tilts about y and z
  Vec3<Position> ground_a{};               ///< pulley: the fixed points
  Vec3<Position> ground_b{};               ///< of body_b's side
  AssetId path{};                          ///< path joint: its curve, in frame a
  Number ratio = Number::from_integer(1);  ///< pulley, gear: ±1000; rack: rad of a for each m of b;
                                           ///< ratchet: teeth in a turn, whole, 2 … 1000
  Force break_force{};          ///< the joint is destroyed beyond it; 0: never
  Torque break_torque{};        ///< N·m, as break_force
  bool collide = false;         ///< whether the two bodies may touch
  std::uint64_t user_data = 0;  ///< the game's own; part of the state

  /// A joint of a kind with its axes locked and free as the kind says, and no drives. Begin with
  /// it: a ball, hinge, slider, weld or wheel whose axes are all free holds nothing and is refused.
  [[nodiscard]] static JointDef of(JointKind kind, BodyHandle a, BodyHandle b);

  /// A distance joint that holds two points no farther apart than `length`, m, and lets them come
  /// nearer. Set the anchors: frame_a.position, frame_b.position.
  [[nodiscard]] static JointDef rope(BodyHandle a, BodyHandle b, Length length);
};

/// A joint as it stands after the last step.
struct JointView {
  JointKind kind{};             ///< as in JointDef
  BodyHandle body_a{};          ///< as in JointDef
  BodyHandle body_b{};          ///< as in JointDef
  std::uint64_t user_data = 0;  ///< as in JointDef
  Vec3<Length> offset{};        ///< of frame B against frame A, along the axes of frame A; of a
                                ///< path joint x is the distance along the path
  Vec3<Angle> angle{};          ///< twist and swing, in (−π, π]
  Vec3<Force> force{};          ///< on body b in the last substep, along the joint's axes
  Vec3<Torque> torque{};        ///< N·m, as `force`
};

/// A joint gave way: it is no more.
struct JointEvent {
  JointHandle joint{};          ///< names no joint any more
  BodyHandle a{};               ///< its body_a
  BodyHandle b{};               ///< its body_b
  std::uint64_t user_data = 0;  ///< the joint's
};

}  // namespace lockstone
