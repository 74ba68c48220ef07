#include "tools/fuzz/special_places.h"

#include <array>
#include <numbers>

namespace lockstone::fuzz {
namespace {

constexpr double k_farthest = 1990;  // offsets, by axis

Vec3<Length> bounded(const Real3& v) {
  return to_length({std::clamp(v.x, -k_farthest, k_farthest),
                    std::clamp(v.y, -k_farthest, k_farthest),
                    std::clamp(v.z, -k_farthest, k_farthest)});
}

double slight(Dice& dice, double least, double most) {
  if (dice.chance(3)) return 0;
  const double size = dice.log_uniform(least, most);
  return dice.chance(2) ? -size : size;
}

/// B like A, turned about A's axis and over an edge, and leaning by an angle that may be slight.
void turn_b(Dice& dice, Pair& pair, double quarters, double most_lean) {
  const double over = quarters * std::numbers::pi / 4, about = dice.uniform(-1, 1);
  const Mat3 spun = to_matrix(dice.chance(2) ? Quat{} : to_quat({0, about, 0}, 1));
  const Mat3 turned = to_matrix(to_quat({std::sin(over), 0, 0}, std::cos(over)));
  const double lean = slight(dice, 1e-9, most_lean);
  const Mat3 leaning = to_matrix(to_quat(dice.direction() * lean, 1));
  pair.b.turn_to(multiply(leaning, multiply(multiply(pair.a.rotation, turned), spun)));
}

/// A point of the body that reaches farthest along n.
Real3 outermost(const Body& body, const Real3& n) {
  Real3 best{};
  double most = -1e30;
  const auto take = [&](const Real3& point) {
    if (dot(point, n) <= most) return;
    most = dot(point, n);
    best = point;
  };
  for (std::size_t i = 0; i < body.core.size(); ++i)
    take(body.core[i] + n * (body.is_tapered() ? body.swell[i] : 0));
  for (const Circle& rim : body.rims)
    take(rim.centre + direction_of(n - rim.axis * dot(n, rim.axis)) * rim.radius);
  return best + n * body.radius;
}

double small_gap(Dice& dice) {
  constexpr std::array<double, 7> k_gaps{0, 1e-6, 3e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  const auto pick = static_cast<std::size_t>(dice.between(0, k_gaps.size() - 1));
  return k_gaps[pick] * (dice.chance(2) ? -1 : 1);
}

Real3 axis_of(const Body& body) {
  return direction_of(real(body.rotation.y));
}

/// B's centre on a line through A's along n, now and then a little beside it.
void along_line(Dice& dice, Pair& pair, const Real3& n) {
  const double whole = pair.a.reach(n) + pair.b.reach(-n);
  double apart = whole + small_gap(dice);
  if (dice.chance(2)) apart = whole * dice.uniform(0, 1);
  if (dice.chance(4)) apart = 0;
  const double aside = slight(dice, 1e-6, 1e-2) * std::min(pair.a.size(), pair.b.size());
  pair.offset = bounded(n * apart + dice.direction() * aside);
}

/// B's outermost point on A's along one direction: of two rims, edge on edge.
void point_on_point(Dice& dice, Pair& pair) {
  const Real3 n = dice.direction();
  const double lean = dice.uniform(0, 0.5);
  const Real3 facing = direction_of(n + dice.direction() * lean);
  pair.offset = bounded(outermost(pair.a, n) - outermost(pair.b, -facing) + n * small_gap(dice));
}

/// B's outermost point on a face of A, or of a disc or a side.
void point_on_face(Dice& dice, Pair& pair) {
  const Real3 axis = axis_of(pair.a);
  const Real3 n = dice.chance(2) ? axis * (dice.chance(2) ? -1 : 1)
                                 : direction_of(cross(axis, dice.direction()));
  const Real3 on_a = outermost(pair.a, n) * dice.uniform(0, 1);
  const Real3 at_height = on_a + n * (pair.a.reach(n) - dot(on_a, n) + small_gap(dice));
  pair.offset = bounded(at_height - outermost(pair.b, -n));
}

}  // namespace

void place_specially(Dice& dice, Pair& pair) {
  const Real3 axis = axis_of(pair.a);
  switch (dice.between(0, 5)) {
    case 0:  // coaxial, upright or upside down
      turn_b(dice, pair, dice.chance(2) ? 0 : 2, 1e-6);
      return along_line(dice, pair, axis * (dice.chance(2) ? -1 : 1));
    case 1:  // across
      turn_b(dice, pair, dice.chance(2) ? 1 : -1, 1e-3);
      return along_line(dice, pair,
                        dice.chance(3) ? axis : direction_of(cross(axis, dice.direction())));
    case 2:  // nearly parallel, side by side or one in the other
      turn_b(dice, pair, dice.chance(2) ? 0 : 2, 1e-1);
      return along_line(dice, pair, direction_of(cross(axis, dice.direction())));
    case 3:
      return point_on_point(dice, pair);
    case 4:
      turn_b(dice, pair, static_cast<double>(dice.between(-1, 2)), 1e-2);
      return point_on_point(dice, pair);
    default:
      return point_on_face(dice, pair);
  }
}

}  // namespace lockstone::fuzz
