// Poses to draw, in floating point: between ticks, at any display rate, and smooth over the
// corrections of a rollback. Nothing here may find its way back into a simulation.
//
// A frame lies between the last two ticks and is interpolated, so a picture is up to one tick late.
// When a rollback computes the last tick again, the picture stays where it is: the offset between
// the shown pose and the true one is kept, and fades from tick to tick. So neither a tick nor a
// correction makes a jump. docs/how-to/render.md shows the use.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <lockstone/world.h>

namespace lockstone {

struct ViewSettings {
  /// Seconds in which the offset of a correction falls to 37 %; 0: corrections are shown at once.
  double time_constant = 0.1;
  /// Metres: greater corrections are shown at once, and so is a body that got farther in a tick
  /// than its speed explains (it was teleported).
  double snap_distance = 2;
  double snap_angle = 1.5;  ///< radians: greater corrections of an orientation are shown at once
};

/// A pose to draw.
template <std::floating_point Real>
struct ViewPose {
  std::array<Real, 3> position{};               ///< metres from the origin that was asked for
  std::array<Real, 4> orientation{0, 0, 0, 1};  ///< x, y, z, w: a unit quaternion
};

/// A pose of the simulation after a tick. The velocity serves to recognise teleports.
struct TickPose {
  Vec3<Position> position{};
  Quat orientation{};
  Vec3<Velocity> velocity{};

  friend bool operator==(const TickPose&, const TickPose&) = default;
};

namespace view_detail {

using Offset = std::array<double, 3>;  // metres
using Turn = std::array<double, 4>;    // x, y, z, w

/// a − b, exact in integers before it becomes a float.
inline Offset metres(const Vec3<Position>& a, const Vec3<Position>& b) {
  const auto part = [](Position difference) {
    return static_cast<double>(difference.raw) * 0x1p-32;
  };
  return {part(a.x - b.x), part(a.y - b.y), part(a.z - b.z)};
}

inline double length(const Offset& v) {
  return std::hypot(v[0], v[1], v[2]);
}

inline double speed(const Vec3<Velocity>& v) {
  const auto part = [](Velocity component) { return static_cast<double>(component.raw) * 0x1p-32; };
  return length({part(v.x), part(v.y), part(v.z)});
}

/// weight_a · a + weight_b · b, made a unit.
inline Turn blend(const Turn& a, double weight_a, const Turn& b, double weight_b) {
  Turn sum{};
  double square = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum[i] = weight_a * a[i] + weight_b * b[i];
    square += sum[i] * sum[i];
  }
  for (double& part : sum)
    part /= std::sqrt(square);
  return sum;
}

inline Turn turn_of(const Quat& q) {
  const auto part = [](Unit component) { return static_cast<double>(component.raw) * 0x1p-30; };
  return blend({part(q.x), part(q.y), part(q.z), part(q.w)}, 1, {}, 0);
}

/// a · b*: the turn from b to a.
inline Turn from_to(const Turn& b, const Turn& a) {
  return {-a[3] * b[0] + a[0] * b[3] - a[1] * b[2] + a[2] * b[1],
          -a[3] * b[1] + a[0] * b[2] + a[1] * b[3] - a[2] * b[0],
          -a[3] * b[2] - a[0] * b[1] + a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]};
}

/// a · b: first b, then a.
inline Turn product(const Turn& a, const Turn& b) {
  return from_to({-b[0], -b[1], -b[2], b[3]}, a);
}

/// The angle of a turn, 0 … π.
inline double angle(const Turn& turn) {
  return 2 * std::atan2(std::hypot(turn[0], turn[1], turn[2]), std::abs(turn[3]));
}

/// The part t of the turn from a to b, the shorter way round, at constant speed.
inline Turn slerp(const Turn& a, const Turn& b, double t) {
  const Turn way = from_to(a, b);
  const double half = angle(way) / 2, sign = way[3] < 0 ? -1 : 1;
  if (half < 1e-6) return blend(a, 1 - t, b, sign * t);
  return blend(a, std::sin((1 - t) * half), b, sign * std::sin(t * half));
}

}  // namespace view_detail

/// The shown poses of one thing: of a body, by `View`, or of a thing of the game's own, such as a
/// character. The first pose that it gets is shown at once.
class PoseTrack {
 public:
  /// Shows a pose at once, without a way from the one before.
  void restart(const TickPose& pose) {
    true_ = pose;
    now_ = {pose.position, {}, view_detail::turn_of(pose.orientation)};
    before_ = now_;
    started_ = true;
  }

  /// The pose after the next tick, or after several; `seconds` have passed in the simulation.
  void advance(const TickPose& pose, double seconds, const ViewSettings& settings = {}) {
    if (!started_ || leaps(pose, seconds, settings)) return restart(pose);
    before_ = now_;
    const double left = std::exp(-seconds / std::max(settings.time_constant, 1e-9));
    for (double& part : now_.offset)
      part *= left;
    const view_detail::Turn off = view_detail::from_to(true_turn(), now_.turn);
    now_.position = pose.position;
    true_ = pose;
    now_.turn = view_detail::product(view_detail::slerp({0, 0, 0, 1}, off, left), true_turn());
  }

  /// The pose after the same tick, computed again: the shown one stays where it is.
  void correct(const TickPose& pose, const ViewSettings& settings = {}) {
    if (pose == true_ && started_) return;
    if (!started_ || !(settings.time_constant > 0)) return restart(pose);
    const view_detail::Offset moved = view_detail::metres(now_.position, pose.position);
    for (std::size_t i = 0; i < 3; ++i)
      now_.offset[i] += moved[i];
    now_.position = pose.position;
    true_ = pose;
    const double turned = view_detail::angle(view_detail::from_to(true_turn(), now_.turn));
    if (view_detail::length(now_.offset) > settings.snap_distance || turned > settings.snap_angle)
      restart(pose);
  }

  /// Shows the true pose at once.
  void cut() { restart(true_); }

  /// The pose to draw at a part of the tick since the last pose, 0 … 1; beyond, as at the ends.
  /// The origin is subtracted in integers, so that pictures are as steady far out as at 0.
  template <std::floating_point Real = float>
  [[nodiscard]] ViewPose<Real> at(double fraction, const Vec3<Position>& origin = {}) const {
    const double t = std::clamp(fraction, 0.0, 1.0);
    const view_detail::Offset from = view_detail::metres(before_.position, origin);
    const view_detail::Offset to = view_detail::metres(now_.position, origin);
    const view_detail::Turn turn = view_detail::slerp(before_.turn, now_.turn, t);
    ViewPose<Real> pose;
    for (std::size_t i = 0; i < 3; ++i) {
      const double start = from[i] + before_.offset[i], end = to[i] + now_.offset[i];
      pose.position[i] = static_cast<Real>(start + (end - start) * t);
    }
    for (std::size_t i = 0; i < 4; ++i)
      pose.orientation[i] = static_cast<Real>(turn[i]);
    return pose;
  }

 private:
  /// Shown at position + offset.
  struct Shown {
    Vec3<Position> position{};
    view_detail::Offset offset{};
    view_detail::Turn turn{0, 0, 0, 1};
  };

  [[nodiscard]] view_detail::Turn true_turn() const {
    return view_detail::turn_of(true_.orientation);
  }

  /// Whether the way is too long for the greater of the speeds at its ends.
  [[nodiscard]] bool leaps(const TickPose& pose, double seconds,
                           const ViewSettings& settings) const {
    const double speed =
        std::max(view_detail::speed(true_.velocity), view_detail::speed(pose.velocity));
    const double way = view_detail::length(view_detail::metres(pose.position, true_.position));
    return way > settings.snap_distance + 1.5 * speed * seconds;
  }

  TickPose true_;
  Shown before_;
  Shown now_;
  bool started_ = false;
};

/// The shown poses of all bodies of a world. A plain value: copy it to hand it to another thread.
class View {
 public:
  explicit View(const ViewSettings& settings = {}) : settings_(settings) {}

  /// Takes the poses of a world. Call it after every tick that was stepped, also after those that a
  /// rollback steps again; to call it more often does no harm. Bodies that are new since the tick
  /// before are shown at once, bodies that are gone no longer.
  void update(const World& world) {
    const std::uint64_t tick = world.tick();
    if (started_ && tick < tick_) return;  // again on the way to the tick that is shown
    const std::uint64_t ticks = started_ ? tick - tick_ : 0;
    const double seconds = static_cast<double>(ticks) / world.def().tick_rate;
    entries_.resize(world.body_limit());
    for (std::uint32_t i = 0; i < world.body_limit(); ++i)
      update(entries_[i], world, world.body_at(i), seconds);
    tick_ = tick;
    started_ = true;
  }

  /// Forgets all poses: the next ones are shown at once. Call it after a state from elsewhere was
  /// loaded, and before another world is shown.
  void reset() {
    entries_.clear();
    started_ = false;
  }

  /// Shows a body where it is, without a way from the tick before: after a teleport that is too
  /// short to be recognised.
  void cut(BodyHandle body) {
    if (shows(body)) entries_[body.index].track.cut();
  }

  [[nodiscard]] bool shows(BodyHandle body) const {
    return !body.is_null() && body.index < entries_.size() && entries_[body.index].body == body;
  }

  /// The pose of the body's shape to draw; see `PoseTrack::at`. Nothing for a body that is not
  /// there.
  template <std::floating_point Real = float>
  [[nodiscard]] std::optional<ViewPose<Real>> pose(BodyHandle body, double fraction,
                                                   const Vec3<Position>& origin = {}) const {
    if (!shows(body)) return std::nullopt;
    return entries_[body.index].track.template at<Real>(fraction, origin);
  }

  /// The tick whose poses are shown at a fraction of 1.
  [[nodiscard]] std::uint64_t tick() const { return tick_; }

 private:
  struct Entry {
    BodyHandle body{};
    PoseTrack track;
  };

  void update(Entry& entry, const World& world, BodyHandle body, double seconds) const {
    if (entry.body != body) entry = {body, {}};
    if (body.is_null()) return;
    const Transform now = pose_of(world, body);
    const TickPose pose{now.position, now.orientation, world.velocity(body)};
    if (seconds > 0)
      entry.track.advance(pose, seconds, settings_);
    else
      entry.track.correct(pose, settings_);
  }

  ViewSettings settings_;
  std::vector<Entry> entries_;
  std::uint64_t tick_ = 0;
  bool started_ = false;
};

/// The part of a tick that has passed, for a world that steps when a session says so
/// (`Client::update`). A frame sees a tick up to a frame late, the network adds its own: this clock
/// runs evenly, and keeps to the ticks that were seen soonest. While a tick is late it holds at 1.
class TickClock {
 public:
  explicit TickClock(std::uint32_t tick_rate) : tick_rate_(tick_rate) {}

  /// Call it once a frame, after the ticks of the frame: with the tick that is shown
  /// (`View::tick`), and with the time that `Client::update` got.
  void update(std::uint64_t tick, std::int64_t now_us) {
    if (started_) fraction_ += static_cast<double>(now_us - now_us_) * 1e-6 * tick_rate_;
    if (started_ && tick > tick_) fraction_ -= static_cast<double>(tick - tick_) * (1 + k_drift);
    if (!started_ || tick < tick_) fraction_ = 0;
    fraction_ = std::clamp(fraction_, 0.0, 1.0);
    tick_ = tick;
    now_us_ = now_us;
    started_ = true;
  }

  [[nodiscard]] double fraction() const { return fraction_; }

 private:
  static constexpr double k_drift = 0.002;  // back to 0, from where early ticks push it on

  double tick_rate_;
  double fraction_ = 0;
  std::uint64_t tick_ = 0;
  std::int64_t now_us_ = 0;
  bool started_ = false;
};

}  // namespace lockstone
