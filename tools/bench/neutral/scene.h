// A scene in plain numbers that any engine can be given, so that nobody's scene is special.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::bench {

using Triple = std::array<double, 3>;

inline constexpr double k_scene_tick_rate = 60;  // Hz

/// A ball, or a box along the axes. Angles of a scene grow from these only by motion.
struct NeutralBody {
  std::string shape = "sphere";  ///< or "box"
  Triple size{0.5, 0.5, 0.5};    ///< m: radius thrice, or half extents
  bool fixed = false;
  bool collides = true;
  double density = 1000;  ///< kg/m³
  Triple position{};      ///< m
  Triple velocity{};      ///< m/s
  Triple angular_velocity{};

  [[nodiscard]] double mass() const;               ///< kg
  [[nodiscard]] Triple moments_over_mass() const;  ///< m², about the body's axes
  [[nodiscard]] bool is_box() const { return shape == "box"; }
};

/// Holds a point of one body to a point of another, each in its body's frame.
struct NeutralJoint {
  int a = 0;
  int b = 0;
  Triple anchor_a{};  ///< m
  Triple anchor_b{};
};

/// Sets a body's velocity before the tick that begins at a time.
struct NeutralKick {
  double time = 0;  ///< s
  int body = 0;
  Triple velocity{};  ///< m/s
};

/// Gravity leans towards +x by this angle at this time, evenly between two times.
struct NeutralTilt {
  double time = 0;  ///< s
  double degrees = 0;
};

struct NeutralScene {
  std::string name;
  std::string description;
  double seconds = 10;
  double gravity = 9.81;          ///< m/s², towards −y where nothing leans
  double friction = 0.5;          ///< of each pair in contact, as it acts between them
  double restitution = 0;         ///< likewise
  int record_every = 1;           ///< ticks
  std::vector<int> watched;       ///< bodies that are recorded
  std::vector<NeutralTilt> tilt;  ///< empty: none
  std::vector<NeutralKick> kicks;
  std::vector<NeutralBody> bodies;
  std::vector<NeutralJoint> joints;

  [[nodiscard]] int ticks() const;
  [[nodiscard]] Triple gravity_at(double time) const;
};

/// All of them.
[[nodiscard]] const std::vector<NeutralScene>& neutral_scenes();

/// Null for an unknown name.
[[nodiscard]] const NeutralScene* find_neutral_scene(std::string_view name);

/// The scenes of rows where bodies touch nothing but joints, where they touch, and large ones.
void add_flight_scenes(std::vector<NeutralScene>& scenes);
void add_joint_scenes(std::vector<NeutralScene>& scenes);
void add_contact_scenes(std::vector<NeutralScene>& scenes);
void add_large_scenes(std::vector<NeutralScene>& scenes);

[[nodiscard]] NeutralBody neutral_ball(double radius, Triple position, double density = 1000);
[[nodiscard]] NeutralBody neutral_box(Triple half_extents, Triple position, double density = 1000);
/// A fixed box of 200 m with its top at y = 0.
[[nodiscard]] NeutralBody neutral_ground();
/// A fixed ball that touches nothing, at the origin.
[[nodiscard]] NeutralBody neutral_pivot();

}  // namespace lockstone::bench
