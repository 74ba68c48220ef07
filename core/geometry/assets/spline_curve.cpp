#include "core/geometry/assets/spline_curve.h"

#include <algorithm>
#include <functional>

#include <lockstone/assert.h>

#include "core/math/product_sum.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

using Raw3 = std::array<std::int64_t, 3>;

constexpr std::int64_t k_piece_end = std::int64_t{1} << 30;  // u at the end of a piece
constexpr int k_slope_bits = 40;

// Each sweep leaves at most half of the error.
constexpr int k_sweeps = 64;

// a · 2^bits / b, within ±2^52.
std::int64_t curve_quotient(std::int64_t a, std::int64_t b, int bits) {
  LKS_ASSERT(b > 0 && bits < 61);
  constexpr std::int64_t k_bound = std::int64_t{1} << 52;
  if (magnitude(a) >> (61 - bits) > static_cast<std::uint64_t>(b))
    return a < 0 ? -k_bound : k_bound;
  return std::clamp(round_divide(multiply_wide(a, std::int64_t{1} << bits), b), -k_bound, k_bound);
}

Raw3 raw3(const Vec3<Position>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}
Raw3 raw3(const Vec3<Unit>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

std::int64_t curve_dot(const Raw3& a, const Raw3& b, int shift) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(a[i], b[i]);
  return sum.rounded(shift);
}

// v − n · (n·v), n in Q30
Raw3 curve_across(const Raw3& v, const Raw3& n) {
  const std::int64_t along = curve_dot(v, n, 30);
  Raw3 rest;
  for (std::size_t i = 0; i < 3; ++i)
    rest[i] = v[i] - product_rounded(n[i], along, 30);
  return rest;
}

Raw3 curve_cross(const Raw3& a, const Raw3& b) {
  const auto part = [](std::int64_t p, std::int64_t y, std::int64_t q, std::int64_t z) {
    ProductSum sum;
    sum.add(p, y);
    sum.subtract(q, z);
    return sum.rounded(30);
  };
  return {part(a[1], b[2], a[2], b[1]), part(a[2], b[0], a[0], b[2]), part(a[0], b[1], a[1], b[0])};
}

Position curve_length(const Vec3<Position>& v) {
  return Position::from_raw(static_cast<std::int64_t>(norm(v.x.raw, v.y.raw, v.z.raw)));
}

// The slopes of a spline of natural ends, or closed, at its points: per m, Q40. `chords` are the
// lengths of the pieces; value i is where piece i begins.
std::vector<std::int64_t> spline_slopes(std::span<const std::int64_t> values,
                                        std::span<const std::int64_t> chords, bool closed) {
  const std::size_t count = values.size(), pieces = chords.size();
  std::vector<std::int64_t> secants(pieces), slopes(count);
  for (std::size_t i = 0; i < pieces; ++i) {
    secants[i] = curve_quotient(values[(i + 1) % count] - values[i], chords[i], k_slope_bits);
    slopes[i] = secants[i];
  }
  const auto settle = [&](std::size_t i) {
    if (!closed && i == 0) return (3 * secants[0] - slopes[1]) / 2;
    if (!closed && i + 1 == count) return (3 * secants[pieces - 1] - slopes[count - 2]) / 2;
    const std::size_t before = (i + pieces - 1) % pieces;
    const std::int64_t part = curve_quotient(chords[i], chords[before] + chords[i], 30);
    const std::int64_t wanted =
        product_rounded(3 * secants[before] - slopes[before], part, 30) +
        product_rounded(3 * secants[i] - slopes[(i + 1) % count], k_piece_end - part, 30);
    return wanted / 2;
  };
  for (int sweep = 0; sweep < k_sweeps; ++sweep)
    for (std::size_t i = 0; i < count; ++i)
      slopes[i] = settle(i);
  return slopes;
}

}  // namespace

Vec3<Position> SplineCurve::Cubic::value(std::int64_t u) const {
  Vec3<Position> v = a[3];
  for (int k = 2; k >= 0; --k)
    for (int i = 0; i < 3; ++i)
      v[i].raw = product_rounded(v[i].raw, u, 30) + a[k][i].raw;
  return v;
}

Vec3<Position> SplineCurve::Cubic::slope(std::int64_t u) const {
  Vec3<Position> v;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t inner = product_rounded(3 * a[3][i].raw, u, 30) + 2 * a[2][i].raw;
    v[i].raw = product_rounded(inner, u, 30) + a[1][i].raw;
  }
  return v;
}

Vec3<Position> SplineCurve::Cubic::bend(std::int64_t u) const {
  Vec3<Position> v;
  for (int i = 0; i < 3; ++i)
    v[i].raw = product_rounded(6 * a[3][i].raw, u, 30) + 2 * a[2][i].raw;
  return v;
}

SplineCurve::SplineCurve(std::span<const PathPoint> points, bool closed) : closed_(closed) {
  LKS_ASSERT(points.size() >= (closed ? 3U : 2U));
  pieces_.resize(closed ? points.size() : points.size() - 1);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Vec3<Position> from = points[i].position, to = points[(i + 1) % points.size()].position;
    pieces_[i].chord = curve_length(to - from);
    pieces_[i].parameter = parameters_;
    parameters_ += pieces_[i].chord;
  }
  fit(points, &Piece::point, false);
  fit(points, &Piece::up, true);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].distance = length_;
    length_ = distance_to({i, k_piece_end});
  }
}

void SplineCurve::fit(std::span<const PathPoint> points, Cubic Piece::*cubic, bool ups) {
  std::vector<std::int64_t> values(points.size()), chords(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    chords[i] = pieces_[i].chord.raw;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3<Unit>& up = points[i].up;
      values[i] = ups ? std::int64_t{direction_of(up.x.raw, up.y.raw, up.z.raw)[axis].raw} * 4
                      : Position(points[i].position[axis]).raw;
    }
    const std::vector<std::int64_t> slopes = spline_slopes(values, chords, closed_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const std::size_t next = (i + 1) % points.size();
      const std::int64_t first = product_rounded(slopes[i], chords[i], k_slope_bits);
      const std::int64_t last = product_rounded(slopes[next], chords[i], k_slope_bits);
      const std::int64_t way = values[next] - values[i];
      Cubic& to = pieces_[i].*cubic;
      to.a[0][axis].raw = values[i];
      to.a[1][axis].raw = first;
      to.a[2][axis].raw = 3 * way - 2 * first - last;
      to.a[3][axis].raw = first + last - 2 * way;
    }
  }
}

PathFault SplineCurve::fault(std::uint32_t& point) const {
  constexpr std::int64_t k_looks = 16;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    point = static_cast<std::uint32_t>(i);
    const Piece& piece = pieces_[i];
    for (std::int64_t k = 0; k <= k_looks; ++k) {
      const std::int64_t u = k_piece_end / k_looks * k;
      const Direction along = direction(piece.point.slope(u));
      if (static_cast<std::int64_t>(along.length) < piece.chord.raw / 4)
        return PathFault::too_sharp;
      const Raw3 up = curve_across(raw3(piece.up.value(u)), raw3(along.unit));
      if (norm(up[0], up[1], up[2]) < std::uint64_t{1} << 29) return PathFault::no_direction_up;
    }
  }
  point = 0;
  return length_ > Position(k_max_path_length) ? PathFault::too_long : PathFault::none;
}

SplineCurve::Spot SplineCurve::spot_of(Position parameter) const {
  const auto after =
      std::ranges::lower_bound(pieces_, parameter, std::less_equal<>{}, &Piece::parameter);
  const auto piece = static_cast<std::size_t>(after - pieces_.begin());
  const std::size_t at = piece == 0 ? 0 : piece - 1;
  const std::int64_t u =
      curve_quotient((parameter - pieces_[at].parameter).raw, pieces_[at].chord.raw, 30);
  return {at, std::clamp(u, std::int64_t{0}, k_piece_end)};
}

// Further by at most a piece, into the next piece at most.
SplineCurve::Spot SplineCurve::moved(const Spot& spot, std::int64_t by) const {
  const std::int64_t u = spot.u + std::clamp(by, -k_piece_end, k_piece_end);
  const std::int64_t beyond = u < 0 ? u : u > k_piece_end ? u - k_piece_end : 0;
  const bool is_first = spot.piece == 0, is_last = spot.piece + 1 == pieces_.size();
  if (beyond == 0 || (!closed_ && (beyond < 0 ? is_first : is_last)))
    return {spot.piece, u - beyond};
  const std::size_t next =
      beyond < 0 ? (is_first ? pieces_.size() : spot.piece) - 1 : (is_last ? 0 : spot.piece + 1);
  const std::int64_t there = curve_quotient(
      product_rounded(beyond, pieces_[spot.piece].chord.raw, 30), pieces_[next].chord.raw, 30);
  return {next, std::clamp(beyond < 0 ? k_piece_end + there : there, std::int64_t{0}, k_piece_end)};
}

// Newton's method for (p − c)·c′ = 0, of which a step goes no farther than four times too far.
SplineCurve::Spot SplineCurve::nearest_spot(const Vec3<Position>& point, const Spot& from) const {
  constexpr int k_most_curve_steps = 24;
  Spot spot = from;
  for (int step = 0; step < k_most_curve_steps; ++step) {
    const Cubic& cubic = pieces_[spot.piece].point;
    const Raw3 gap = raw3(point - cubic.value(spot.u));
    const Direction along = direction(cubic.slope(spot.u));
    const auto speed = static_cast<std::int64_t>(along.length);
    if (speed == 0) break;
    const std::int64_t bend =
        curve_quotient(curve_dot(gap, raw3(cubic.bend(spot.u)), 32), speed, 32);
    const std::int64_t by =
        curve_quotient(curve_dot(gap, raw3(along.unit), 30), std::max(speed - bend, speed / 4), 30);
    const Spot next = moved(spot, by);
    const bool is_there = (by <= 1 && by >= -1) || (next.piece == spot.piece && next.u == spot.u);
    spot = next;
    if (is_there) break;
  }
  return spot;
}

Position SplineCurve::parameter_of(const Spot& spot) const {
  const Piece& piece = pieces_[spot.piece];
  return piece.parameter + Position::from_raw(product_rounded(piece.chord.raw, spot.u, 30));
}

// By the quadrature of Gauss with four points.
Position SplineCurve::distance_to(const Spot& spot) const {
  constexpr std::int64_t k_places[] = {365051866, 924638074}, k_weights[] = {700235528, 373506296};
  const Piece& piece = pieces_[spot.piece];
  std::int64_t sum = 0;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t place = i < 2 ? -k_places[i] : k_places[i - 2];
    const std::int64_t u = product_rounded(spot.u, k_piece_end + place, 31);
    sum += product_rounded(curve_length(piece.point.slope(u)).raw, k_weights[i & 1], 30);
  }
  return piece.distance + Position::from_raw(product_rounded(sum, spot.u, 31));
}

// With the tangent t, t′ = (c″ − t·(t·c″)) / |c′|²; the frame turns at t × t′ and, about t, as the
// direction up turns against that.
CurvePlace SplineCurve::place_of(const Spot& spot) const {
  const Piece& piece = pieces_[spot.piece];
  const Direction along = direction(piece.point.slope(spot.u));
  const Raw3 t = raw3(along.unit), up = raw3(piece.up.value(spot.u));
  const auto speed = std::max<std::int64_t>(static_cast<std::int64_t>(along.length), 1);
  const Raw3 level = curve_across(up, t);
  const Direction z = direction(level[0], level[1], level[2]);
  const Raw3 y = curve_cross(raw3(z.unit), t);
  CurvePlace place;
  place.point = piece.point.value(spot.u);
  place.frame = {along.unit, direction_of(y[0], y[1], y[2]), z.unit};
  place.parameter = parameter_of(spot);
  place.distance = distance_to(spot);
  Raw3 turn = curve_across(raw3(piece.point.bend(spot.u)), t);
  for (std::int64_t& part : turn)
    part = curve_quotient(curve_quotient(part, speed, 30), speed, 32);
  const std::int64_t rise =
      curve_quotient(curve_dot(raw3(piece.up.slope(spot.u)), y, 30), speed, 30);
  const std::int64_t carried = product_rounded(curve_dot(up, t, 30), curve_dot(turn, y, 30), 32);
  const auto height = std::max<std::int64_t>(static_cast<std::int64_t>(z.length), 1);
  const std::int64_t roll = curve_quotient(carried - rise, height, 32);
  place.turning = curve_cross(t, turn);
  for (std::size_t i = 0; i < 3; ++i)
    place.turning[i] += product_rounded(t[i], roll, 30);
  return place;
}

CurvePlace SplineCurve::nearest(const Vec3<Position>& point, Position from) const {
  const Spot spot = nearest_spot(point, spot_of(from));
  CurvePlace place = place_of(spot);
  const bool is_end = (spot.piece == 0 && spot.u == 0) ||
                      (spot.piece + 1 == pieces_.size() && spot.u == k_piece_end);
  if (is_end && !closed_) {
    place.distance.raw += curve_dot(raw3(point - place.point), raw3(place.frame.x), 30);
    place.turning = {};
  }
  return place;
}

Position SplineCurve::find(const Vec3<Position>& point) const {
  constexpr std::int64_t k_looks = 4;
  Spot best;
  std::uint64_t least = ~std::uint64_t{0};
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    for (std::int64_t k = 0; k <= k_looks; ++k) {
      const Spot spot = nearest_spot(point, {i, k_piece_end / k_looks * k});
      const Vec3<Position> gap = point - pieces_[spot.piece].point.value(spot.u);
      const std::uint64_t distance = norm(gap.x.raw, gap.y.raw, gap.z.raw);
      if (distance >= least) continue;
      least = distance;
      best = spot;
    }
  }
  return parameter_of(best);
}

Mat3 SplineCurve::frame_at(std::size_t point) const {
  const bool is_end = point == pieces_.size();
  return place_of({is_end ? point - 1 : point, is_end ? k_piece_end : 0}).frame;
}

CurvePlace SplineCurve::at(Position distance) const {
  constexpr int k_most_curve_steps = 16;
  if (closed_) {
    distance.raw %= length_.raw;
    if (distance < Position{}) distance += length_;
  }
  const auto after =
      std::ranges::lower_bound(pieces_, distance, std::less_equal<>{}, &Piece::distance);
  Spot spot{static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - pieces_.begin(), 1)) - 1, 0};
  for (int step = 0; step < k_most_curve_steps; ++step) {
    const std::int64_t speed =
        std::max<std::int64_t>(curve_length(pieces_[spot.piece].point.slope(spot.u)).raw, 1);
    const std::int64_t by = curve_quotient((distance - distance_to(spot)).raw, speed, 30);
    const std::int64_t u = std::clamp(spot.u + std::clamp(by, -k_piece_end, k_piece_end),
                                      std::int64_t{0}, k_piece_end);
    if (u == spot.u) break;
    spot.u = u;
  }
  return place_of(spot);
}

}  // namespace lockstone::geometry
