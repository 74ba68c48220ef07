#include <algorithm>
#include <bit>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/fit.h>

#include "core/math/int128.h"
#include "core/math/principal_axes.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

using FitPoint = Vec3<std::int64_t>;  // raws of lengths

constexpr int k_circle_steps = 256;
constexpr std::int64_t k_fit_slack = 4;  // of turned points and rounded sizes, raw

bool can_fit(std::span<const Vec3<Length>> points) {
  if (points.empty() || points.size() > k_max_fit_points) return false;
  return std::ranges::all_of(points, [](const Vec3<Length>& point) {
    for (int axis = 0; axis < 3; ++axis)
      if (abs(point[axis]) > k_max_asset_coordinate) return false;
    return true;
  });
}

std::uint64_t distance_between(const FitPoint& a, const FitPoint& b) {
  return norm(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// The centre of a ball about the points, nearly the least: towards the farthest point, by ever
/// smaller parts. M. Bădoiu and K. Clarkson, "Smaller core-sets for balls", 2003.
struct FittedBall {
  FitPoint centre{};
  std::uint64_t radius = 0;
};

FittedBall ball_about(std::span<const FitPoint> points) {
  FittedBall best;
  FitPoint centre = points[0];
  for (std::int64_t step = 1; step <= k_circle_steps; ++step) {
    const FitPoint* farthest = &points[0];
    std::uint64_t radius = 0;
    for (const FitPoint& point : points) {
      const std::uint64_t distance = distance_between(point, centre);
      if (distance <= radius) continue;
      radius = distance;
      farthest = &point;
    }
    if (step == 1 || radius < best.radius) best = {centre, radius};
    for (int axis = 0; axis < 3; ++axis)
      centre[axis] += raw::round_divide((*farthest)[axis] - centre[axis], step + 1);
  }
  return best;
}

std::vector<FitPoint> raws_of(std::span<const Vec3<Length>> points) {
  std::vector<FitPoint> raws;
  raws.reserve(points.size());
  for (const Vec3<Length>& point : points)
    raws.push_back({point.x.raw, point.y.raw, point.z.raw});
  return raws;
}

// In the frame of the axes, rounded.
std::vector<FitPoint> turned(std::span<const FitPoint> points, const Mat3& axes) {
  std::vector<FitPoint> result;
  result.reserve(points.size());
  for (const FitPoint& p : points) {
    FitPoint q;
    for (int i = 0; i < 3; ++i) {
      const Vec3<Unit>& axis = axes.column(i);
      q[i] = raw::round_shift(p.x * axis.x.raw + p.y * axis.y.raw + p.z * axis.z.raw, 30);
    }
    result.push_back(q);
  }
  return result;
}

struct FitRange {
  std::int64_t low = 0, high = 0;

  [[nodiscard]] std::int64_t middle() const { return (low + high) >> 1; }
};

FitRange range_of(std::span<const FitPoint> points, int axis) {
  FitRange range{points[0][axis], points[0][axis]};
  for (const FitPoint& point : points) {
    range.low = std::min(range.low, point[axis]);
    range.high = std::max(range.high, point[axis]);
  }
  return range;
}

struct FittedBox {
  Quat orientation{};
  FitPoint centre{};  // along its own axes
  FitPoint half{};

  [[nodiscard]] Int128 volume() const { return multiply_wide(half.x * half.y, half.z); }
};

FittedBox box_along(std::span<const FitPoint> points, const Quat& orientation) {
  FittedBox box{orientation};
  const std::vector<FitPoint> local = turned(points, to_matrix(orientation));
  for (int axis = 0; axis < 3; ++axis) {
    const FitRange range = range_of(local, axis);
    box.centre[axis] = range.middle();
    box.half[axis] = (range.high - range.low + 1) / 2;
  }
  return box;
}

// Of the covariance, whose entries are brought below 2^59.
Quat axes_of(std::span<const FitPoint> points) {
  FitPoint mean;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t sum = 0;
    for (const FitPoint& point : points)
      sum += point[axis];
    mean[axis] = raw::round_divide(sum, static_cast<std::int64_t>(points.size()));
  }
  std::int64_t widest = 1;
  for (const FitPoint& point : points)
    for (int axis = 0; axis < 3; ++axis)
      widest = std::max(widest, std::abs(point[axis] - mean[axis]));
  // 20 bits for a deviation, 16 for their number.
  const int shift = 20 - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(widest)));
  SymMat3<std::int64_t> sum;
  for (const FitPoint& point : points) {
    FitPoint d;
    for (int axis = 0; axis < 3; ++axis)
      d[axis] = raw::scale_binary(point[axis] - mean[axis], shift);
    sum = sum +
          SymMat3<std::int64_t>{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
  }
  const auto greatest =
      static_cast<std::uint64_t>(std::max({sum.xx, sum.yy, sum.zz, std::int64_t{1}}));
  const int up = 59 - static_cast<int>(std::bit_width(greatest));
  for (std::int64_t* entry : {&sum.xx, &sum.yy, &sum.zz, &sum.xy, &sum.xz, &sum.yz})
    *entry *= std::int64_t{1} << up;
  return principal_axes(sum).axes;
}

FittedBox box_about(std::span<const FitPoint> points) {
  const FittedBox level = box_along(points, Quat{});
  const FittedBox own = box_along(points, normalized(axes_of(points)));
  return own.volume() < level.volume() ? own : level;
}

// The shape's y axis along the longest axis of the box.
Quat along_longest(const FittedBox& box) {
  constexpr Unit k_half = Unit::from_raw(759250125);  // √½
  if (box.half.y >= box.half.x && box.half.y >= box.half.z) return box.orientation;
  const Quat quarter =
      box.half.x >= box.half.z ? Quat{{}, {}, -k_half, k_half} : Quat{k_half, {}, {}, k_half};
  return normalized(multiply(box.orientation, quarter));
}

Length size_of(std::int64_t raw) {
  const std::int64_t least = k_min_shape_size.raw;
  return Length::from_raw(
      static_cast<std::int32_t>(std::clamp<std::int64_t>(raw, least, INT32_MAX)));
}

Result<FittedShape> placed(const Shape& shape, const FitPoint& local, const Quat& orientation) {
  if (validate(shape) != Status::ok) return Status::invalid_argument;
  const auto length = [](std::int64_t raw) {
    return Length::from_raw(static_cast<std::int32_t>(raw));
  };
  const Vec3<Length> centre{length(local.x), length(local.y), length(local.z)};
  return FittedShape{shape, rounded<Length>(rotate(to_matrix(orientation), centre)), orientation};
}

}  // namespace

Result<FittedShape> fit_sphere(std::span<const Vec3<Length>> points) {
  if (!can_fit(points)) return Status::invalid_argument;
  const FittedBall ball = ball_about(raws_of(points));
  const auto radius = static_cast<std::int64_t>(ball.radius) + 1;
  return placed(Shape::sphere(size_of(radius)), ball.centre, Quat{});
}

Result<FittedShape> fit_box(std::span<const Vec3<Length>> points) {
  if (!can_fit(points)) return Status::invalid_argument;
  const FittedBox box = box_about(raws_of(points));
  const auto half = [&](int axis) { return size_of(box.half[axis] + k_fit_slack); };
  return placed(Shape::box(half(0), half(1), half(2)), box.centre, box.orientation);
}

Result<FittedShape> fit_capsule(std::span<const Vec3<Length>> points) {
  if (!can_fit(points)) return Status::invalid_argument;
  const std::vector<FitPoint> raws = raws_of(points);
  const Quat orientation = along_longest(box_about(raws));
  std::vector<FitPoint> local = turned(raws, to_matrix(orientation));
  const std::int64_t middle = range_of(local, 1).middle();
  std::vector<FitPoint> across = local;
  for (FitPoint& point : across)
    point.y = 0;
  const FittedBall ring = ball_about(across);
  const auto radius = static_cast<std::int64_t>(ring.radius) + k_fit_slack;
  std::int64_t half = 0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    const std::uint64_t aside = distance_between(across[i], ring.centre);
    const auto cap = static_cast<std::uint64_t>(radius * radius) - aside * aside;
    half = std::max(half, std::abs(local[i].y - middle) - std::int64_t{isqrt(cap)});
  }
  return placed(Shape::capsule(size_of(half + k_fit_slack), size_of(radius)),
                {ring.centre.x, middle, ring.centre.z}, orientation);
}

}  // namespace lockstone
