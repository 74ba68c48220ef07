// A scene of a family in plain numbers, for any engine, and the expected result.
//
// Metres, seconds, kilograms and radians; y is up and the floor, where there is one, is at y = 0.
// A pair's friction is the geometric mean of its bodies', its restitution the greater one.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::bench {

using Triple = std::array<double, 3>;
using Turn = std::array<double, 4>;  ///< a unit quaternion: x, y, z, w

enum class Form { sphere, box, capsule, hull, mesh, compound };
enum class Motion { fixed, kinematic, dynamic };

/// The points of a hull are about its own origin, which need not be its centre of mass.
struct GeneralShape {
  Form form = Form::box;
  Triple size{0.5, 0.5, 0.5};  ///< half extents; or radius, half the core along y, unused
  std::vector<Triple> points;  ///< of a hull or a mesh
  std::vector<std::array<int, 3>> triangles;  ///< of a mesh: points, counter-clockwise from outside

  friend auto operator<=>(const GeneralShape&, const GeneralShape&) = default;
};

/// Of a compound, in its body's frame.
struct GeneralPart : GeneralShape {
  Triple position{};
  Turn orientation{0, 0, 0, 1};
};

inline constexpr int k_for_ever = 1 << 30;

/// A mesh does not belong to a dynamic body.
struct GeneralBody : GeneralShape {
  std::vector<GeneralPart> parts;  ///< of a compound
  Motion motion = Motion::dynamic;
  int from = 0;            ///< the tick before which it is added
  int until = k_for_ever;  ///< the tick before which it is removed
  Triple position{};
  Turn orientation{0, 0, 0, 1};
  Triple velocity{};
  Triple angular_velocity{};
  Triple surface{};  ///< m/s in its own frame, of a belt: the surface of a fixed body that moves
  double density = 1000;
  double friction = 0.5;
  double restitution = 0;
  bool collides = true;
  bool trigger = false;  ///< counts who enters it, pushes nothing
  bool bullet = false;   ///< must not pass through dynamic bodies either

  [[nodiscard]] bool moves() const { return motion == Motion::dynamic; }
};

enum class Link { ball, hinge, slider, weld, rod };

/// Frames are in each body's frame. A hinge turns about x of its frames, a slider moves along it,
/// and a rod keeps two points at a distance. All but rods have their frames in one place when the
/// joint is at zero.
struct GeneralJoint {
  Link link = Link::ball;
  int a = 0;
  int b = 0;
  Triple anchor_a{};
  Triple anchor_b{};
  Turn frame_a{0, 0, 0, 1};
  Turn frame_b{0, 0, 0, 1};
  bool limited = false;  ///< a hinge's angle, a slider's way, a rod's length, a ball's twist
  double lower = 0;
  double upper = 0;
  double cone = 0;    ///< of a limited ball: the most that its x axes part, rad
  double speed = 0;   ///< of the motor of a hinge or slider
  double effort = 0;  ///< the most it can do, N or N·m; 0: no motor
  double target = 0;  ///< of the spring; a rod's length without one
  double hertz = 0;   ///< of the two bodies alone; 0: no spring
  double damping = 0;
  Triple turn{};  ///< target of a ball's spring: a rotation vector of frame b against frame a
};

/// Sets a body's velocities before the tick that begins at a time.
struct GeneralMove {
  int tick = 0;
  int body = 0;
  Triple velocity{};
  Triple angular_velocity{};
};

/// Gravity from the tick that begins at a time.
struct GeneralPull {
  int tick = 0;
  Triple gravity{};  ///< m/s²
};

/// The bodies that go and come before a tick, and the joints that come with them: their indices.
/// Joints go with their bodies.
struct GeneralChange {
  std::vector<int> gone;
  std::vector<int> come;
  std::vector<int> joints;
};

/// The kind of a family's error: the one figure that its scenes are judged by.
enum class Judge {
  displacement,  ///< m, of a watched body from where it began: at the end when `expected` is set,
                 ///< else the farthest ever
  gap,           ///< m, the widest gap of a joint
  rate,          ///< of a hinge's motor, off its speed after the first second, relative
  angle,         ///< rad, of a hinge's spring off its target at the end, rest included
  turn,          ///< rad, of a ball's spring off its target at the end, rest included
  amplitude,     ///< of a spring, lost at the end, relative
  energy,        ///< lost at the end, relative to the beginning
  gain,          ///< regained, relative to the beginning
  missed,        ///< share of watched bodies that ended within `expected` m of where they began
  entered,       ///< share of watched bodies that no trigger saw
  fallen,        ///< m, the deepest that a watched body ends below the floor
  sunk,          ///< m, the deepest that any point of a watched body ever is below the floor
  fastest,       ///< m/s, of any body at any time
  bounce,        ///< m, the highest that a watched body rises above its beginning
  slowed,        ///< speed lost at the end, relative to the beginning, beyond `expected`
  awake,         ///< share of dynamic bodies not asleep at the end
  outside,       ///< m, the farthest that a watched body ends beyond `expected` from the origin,
                 ///< along any axis
};
inline constexpr std::size_t k_judges = static_cast<std::size_t>(Judge::outside) + 1;

struct GeneralScene {
  std::string family;
  std::uint64_t seed = 0;
  int ticks = 600;  ///< of a sixtieth of a second
  double gravity = 9.81;
  double low = 0;  ///< height that potential energy counts from, along the gravity of the moment:
                   ///< nothing can fall below it
  bool may_sleep = false;
  bool passive = true;     ///< nothing adds energy: no motors, springs or moves
  bool must_rest = false;  ///< all of it, before the end
  Judge judge = Judge::displacement;
  double bound = 0.01;       ///< the error that passes
  double expected = 0;       ///< see `Judge`
  std::vector<int> watched;  ///< empty: all dynamic bodies
  std::vector<GeneralBody> bodies;
  std::vector<GeneralJoint> joints;
  std::vector<GeneralMove> moves;
  std::vector<GeneralPull> pulls;
};

class SceneMaker;

/// A generator of scenes that are alike.
struct Family {
  std::string_view name;
  std::string_view text;  ///< describes it and its variations
  void (*fill)(SceneMaker& maker);
};

/// In the order of the table.
[[nodiscard]] const std::vector<Family>& families();
/// One island each, with fixed numbers, whose cost a tick is told by itself.
[[nodiscard]] const std::vector<Family>& single_islands();

/// Among both.
[[nodiscard]] const Family* find_family(std::string_view name);

inline constexpr int k_no_cap = 1 << 20;

/// The same scene on every machine. `cap` bounds each count that the family draws.
[[nodiscard]] GeneralScene make_scene(const Family& family, std::uint64_t seed, int cap = k_no_cap);

/// The bodies and joints at the beginning, and the changes before each later tick.
[[nodiscard]] std::vector<GeneralChange> changes_of(const GeneralScene& scene);

/// Every number of the scene as bytes, in order: two scenes are one when these are equal.
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const GeneralScene& scene);

[[nodiscard]] double volume_of(const GeneralBody& body);
[[nodiscard]] double mass_of(const GeneralBody& body);
/// Of a hull from its points' box, of the others exact.
[[nodiscard]] Triple moments_of(const GeneralBody& body);

}  // namespace lockstone::bench
