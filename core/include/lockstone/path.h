// Path: a smooth curve through points, an asset for joints: a track, a lift, a camera's rail.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

inline constexpr int k_max_path_points = 4096;
/// Of the distance from a point of a path to the next one.
inline constexpr Length k_min_path_chord = Length::from_ratio(1, 32);
inline constexpr Length k_max_path_chord = Length::from_integer(128);
/// Of a whole path.
inline constexpr Length k_max_path_length = Length::from_integer(2000);

/// A point that a path goes through, and which way is up there: a track banks where that turns.
struct PathPoint {
  Vec3<Length> position{};                       ///< m, in the path's frame, within ±512
  Vec3<Unit> up{{}, Unit::from_integer(1), {}};  ///< any length but 0, not along the path
};

/// Why no path was built.
enum class PathFault : std::uint8_t {
  none = 0,
  too_few_points,           ///< fewer than 2, of a closed path 3
  too_many_points,          ///< more than k_max_path_points
  coordinate_out_of_range,  ///< beyond k_max_asset_coordinate
  chord_out_of_range,       ///< the next point is nearer or farther than allowed
  no_direction_up,  ///< of length 0, or nearly along the path, here or on the way to the next
  too_sharp,        ///< the path turns back on the way to the next point
  too_long,         ///< more than k_max_path_length
};

/// A short lower-case English name, for logs.
[[nodiscard]] std::string_view to_string(PathFault fault);

struct PathResult;

/// A curve of continuous curvature through points: a cubic spline by the length of the chords. A
/// path has a direction, and a frame everywhere: x along it, z up. No body has the shape of a path.
class Path final : public Asset {
 public:
  /// `closed`: goes on from the last point to the first.
  [[nodiscard]] static PathResult build(std::span<const PathPoint> points, bool closed);

  /// The same track, banked: at each point its frame is turned about the direction of the path, to
  /// the right side as one looks along it, by one of `banks`, rad. As many banks as points, or
  /// none.
  [[nodiscard]] static PathResult build(std::span<const PathPoint> points,
                                        std::span<const Angle> banks, bool closed);

  /// The path that `canonical_bytes` came from; malformed when there is no such path.
  [[nodiscard]] static Result<std::shared_ptr<const Path>> from_bytes(ByteView bytes);

  [[nodiscard]] std::span<const PathPoint> points() const;
  [[nodiscard]] bool is_closed() const;
  /// m, rounded.
  [[nodiscard]] Length length() const;
  /// The frame at a distance from the first point, m. An open path ends at its points; a closed one
  /// goes round.
  [[nodiscard]] Transform at(Length distance) const;

  [[nodiscard]] std::vector<std::byte> canonical_bytes() const override;

 private:
  Path(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);
};

/// A path, or the reason why there is none and the point that is to blame.
struct [[nodiscard]] PathResult {
  std::shared_ptr<const Path> path;  ///< null exactly when there is a fault
  PathFault fault = PathFault::none;
  std::uint32_t point = 0;

  [[nodiscard]] bool ok() const { return path != nullptr; }
  [[nodiscard]] explicit operator bool() const { return ok(); }
};

}  // namespace lockstone
