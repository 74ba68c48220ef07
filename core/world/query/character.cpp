#include <algorithm>

#include <lockstone/character.h>

#include "core/dynamics/state/limits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/block_float.h"
#include "core/math/int128.h"
#include "core/math/roots.h"
#include "core/world/query/character_obstacles.h"

namespace lockstone {
namespace {

constexpr std::size_t k_max_slides = 6;
constexpr int k_max_push_outs = 4;
constexpr std::size_t k_max_planes = 16;
constexpr Length k_motion_limit = Length::from_integer(8);
constexpr Unit k_one_side = Unit::from_ratio(99, 100);
constexpr Length k_negligible = Length::from_raw(16);  // 15 µm

Vec3<Position> moved(const Vec3<Position>& from, const Vec3<Length>& by) {
  return from + rounded<Position>(by);
}

Length along(const Vec3<Length>& v, const Vec3<Unit>& n) {
  return rounded<Length>(dot(n, v));
}

Vec3<Length> times(const Vec3<Unit>& n, Length length) {
  return {rounded<Length>(n.x * length), rounded<Length>(n.y * length),
          rounded<Length>(n.z * length)};
}

Vec3<Length> scaled(const Vec3<Length>& v, Unit factor) {
  return {rounded<Length>(v.x * factor), rounded<Length>(v.y * factor),
          rounded<Length>(v.z * factor)};
}

constexpr Vec3<Unit> k_y_axis{{}, Unit::from_integer(1), {}};

Vec3<Unit> up_of(const CharacterDef& def) {
  return rotate(to_matrix(def.orientation), k_y_axis);
}

/// Half extents of the shape along its own axes.
Vec3<Length> half_extents(const Shape& shape) {
  return world_half_extents(shape, to_matrix(Quat{}));
}

bool is_negligible(const Vec3<Length>& v) {
  return abs(v.x) <= k_negligible && abs(v.y) <= k_negligible && abs(v.z) <= k_negligible;
}

// One move under way.
class Mover {
 public:
  Mover(const World& world, const CharacterDef& def, const Vec3<Position>& position)
      : obstacles_(world, def), def_(def), up_(up_of(def)) {
    move_.position = position;
  }

  CharacterMove run(const Vec3<Length>& motion, bool stay_on_ground, const Vec3<Length>& carried) {
    push_out();
    const bool rises = height_of(motion) > Length{};
    const bool stood = !move_.ground.is_null() || find_ground(def_.skin * 2);
    slide(motion + carried, stood || stay_on_ground);
    move_.ground = {};
    if (stay_on_ground && stood && !rises)
      settle();
    else if (!rises)
      (void)find_ground(def_.skin * 2);
    move_.grounded = !move_.ground.is_null();
    return move_;
  }

 private:
  [[nodiscard]] Unit slope_of(const Vec3<Unit>& normal) const {
    return rounded<Unit>(dot(normal, up_));
  }
  [[nodiscard]] bool is_walkable(const Vec3<Unit>& normal) const {
    return slope_of(normal) >= def_.min_ground_slope;
  }
  [[nodiscard]] Length height_of(const Vec3<Length>& v) const { return along(v, up_); }
  [[nodiscard]] Vec3<Length> upward(Length height) const { return times(up_, height); }
  [[nodiscard]] Vec3<Length> level_part(const Vec3<Length>& v) const {
    return v - upward(height_of(v));
  }
  [[nodiscard]] ShapeHit cast(const Vec3<Position>& from, const Vec3<Length>& motion) const {
    return obstacles_.cast(from, motion);
  }

  // Until the skin is free, the deepest overlaps included: each plane pushes by the rest that the
  // others have not provided. Between obstacles that leave no room for the skin it stays where the
  // nearest of them is farthest.
  void push_out() {
    Vec3<Position> best = move_.position;
    Length most = Length::min();
    for (int round = 0; round <= k_max_push_outs; ++round) {
      const PushOut push = find_push_out(round == 0);
      if (push.least > most) {
        most = push.least;
        best = move_.position;
      }
      if (is_negligible(push.way)) break;
      move_.position = moved(move_.position, push.way);
    }
    move_.position = best;
  }

  struct PushOut {
    Vec3<Length> way;
    Length least = Length::max();  // separation of an obstacle
  };
  PushOut find_push_out(bool notes) {
    std::array<ShapeContact, k_max_planes> contacts;
    const std::size_t count =
        obstacles_.contacts(move_.position, def_.skin + k_negligible, contacts);
    PushOut push;
    for (const ShapeContact& contact : std::span(contacts).first(count)) {
      const Length separation = rounded<Length>(contact.separation);
      push.least = min(push.least, separation);
      const Length missing = def_.skin - separation - along(push.way, contact.normal);
      if (missing > Length{}) push.way += times(contact.normal, missing);
      if (!notes) continue;
      note({contact.body, contact.point, contact.normal, {}});
      if (is_walkable(contact.normal)) stand_on(contact.body, contact.normal, contact.point);
    }
    return push;
  }

  // The part of a motion in which nothing is in the way, less the skin.
  [[nodiscard]] Unit free_share(const Vec3<Length>& motion, const ShapeHit& hit) const {
    if (hit.body.is_null()) return Unit::from_integer(1);
    const Length closing = -along(motion, hit.normal);
    if (closing <= Length{}) return {};
    // The skin along the normal is skin / closing of the motion.
    const std::int64_t back =
        raw::round_divide(std::int64_t{def_.skin.raw} << Unit::frac_bits, closing.raw);
    const std::int64_t part = std::int64_t{hit.fraction.raw} - back;
    return Unit::from_raw(static_cast<std::int32_t>(std::max(part, std::int64_t{0})));
  }
  [[nodiscard]] Vec3<Length> free_part(const Vec3<Length>& motion, const ShapeHit& hit) const {
    return scaled(motion, free_share(motion, hit));
  }

  // Hits of one body from one side are one.
  void note(const CharacterHit& hit) {
    for (CharacterHit& other : std::span(move_.hits).first(move_.hit_count)) {
      if (other.body != hit.body || rounded<Unit>(dot(other.normal, hit.normal)) < k_one_side)
        continue;
      other.blocked = max(other.blocked, hit.blocked);
      return;
    }
    if (move_.hit_count == CharacterMove::k_max_hits) return;
    move_.hits[move_.hit_count++] = hit;
  }
  void note(const ShapeHit& hit, const Vec3<Length>& rest) {
    note({hit.body, hit.point, hit.normal, max(-along(rest, hit.normal), Length{})});
  }

  // Along the planes that it ran into, as near to the request as they let it.
  void slide(Vec3<Length> request, bool may_step) {
    std::array<Vec3<Unit>, k_max_slides + 1> planes{};
    std::size_t count = 0;
    if (!move_.ground.is_null()) planes[count++] = move_.ground_normal;
    Vec3<Length> motion = allowed(request, std::span(planes).first(count));
    while (count <= k_max_slides && !is_negligible(motion)) {
      const ShapeHit hit = cast(move_.position, motion);
      const Unit part = free_share(motion, hit);
      move_.position = moved(move_.position, scaled(motion, part));
      if (hit.body.is_null()) return;
      const Unit left = Unit::from_integer(1) - part;
      request = scaled(request, left);
      motion = scaled(motion, left);
      note(hit, motion);
      if (may_step && !is_walkable(hit.normal) && step_up(motion)) return;
      planes[count++] = wall_normal(hit.normal, motion);
      motion = allowed(request, std::span(planes).first(count));
    }
  }

  [[nodiscard]] Vec3<Unit> level_part(const Vec3<Unit>& normal, Unit slope) const {
    return {normal.x - rounded<Unit>(up_.x * slope), normal.y - rounded<Unit>(up_.y * slope),
            normal.z - rounded<Unit>(up_.z * slope)};
  }

  // A slope too steep to stand on does not lift the character: it acts as an upright wall.
  [[nodiscard]] Vec3<Unit> wall_normal(const Vec3<Unit>& normal, const Vec3<Length>& motion) const {
    const Unit slope = slope_of(normal);
    if (slope <= Unit{} || is_walkable(normal) || height_of(motion) < Length{}) return normal;
    const Vec3<Unit> level = level_part(normal, slope);
    if (level == Vec3<Unit>{}) return normal;
    return direction_of(level.x.raw, level.y.raw, level.z.raw);
  }

  [[nodiscard]] static bool enters(const Vec3<Length>& v, const Vec3<Unit>& plane) {
    return along(v, plane) < -k_negligible;
  }

  // The motion nearest to the request that enters none of the planes: the request, its part along
  // one plane, or along the crease of two, or none.
  [[nodiscard]] static Vec3<Length> allowed(const Vec3<Length>& request,
                                            std::span<const Vec3<Unit>> planes) {
    const auto is_free = [&](const Vec3<Length>& v) {
      return std::ranges::none_of(planes, [&](const auto& plane) { return enters(v, plane); });
    };
    if (is_free(request)) return request;
    Vec3<Length> best{};
    Length least = Length::max();
    for (const Vec3<Unit>& plane : planes) {
      const Length into = along(request, plane);
      const Vec3<Length> flat = request - times(plane, into);
      if (-into >= least || into >= Length{} || !is_free(flat)) continue;
      least = -into;
      best = flat;
    }
    return least < Length::max() ? best : along_crease(request, planes, is_free);
  }

  template <class IsFree>
  [[nodiscard]] static Vec3<Length> along_crease(const Vec3<Length>& request,
                                                 std::span<const Vec3<Unit>> planes,
                                                 const IsFree& is_free) {
    Vec3<Length> best{};
    Length most{};
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto crease = cross(planes[i], planes[j]);
        if (crease == decltype(crease){}) continue;
        const Vec3<Unit> edge = direction_of(crease);
        const Length part = along(request, edge);
        const Vec3<Length> result = times(edge, part);
        if (abs(part) <= most || !is_free(result)) continue;
        most = abs(part);
        best = result;
      }
    }
    return best;
  }

  // Up, along and down again: taken when it ends no lower and there is walkable ground ahead, under
  // the foot or a radius farther on, where the round foot no longer meets the ledge's rim.
  bool step_up(const Vec3<Length>& motion) {
    const Vec3<Length> level = level_part(motion);
    if (def_.step_height <= Length{} || is_negligible(level)) return false;
    const Vec3<Length> rise = upward(def_.step_height);
    const Vec3<Length> risen = free_part(rise, cast(move_.position, rise));
    const Vec3<Position> above = moved(move_.position, risen);
    const Vec3<Length> along_ledge = free_part(level, cast(above, level));
    if (is_negligible(along_ledge)) return false;
    const Vec3<Position> over = moved(above, along_ledge);
    const Vec3<Length> fall = -risen;
    const ShapeHit ground = cast(over, fall);
    if (ground.body.is_null() ||
        !(is_walkable(ground.normal) || is_ground_ahead(over, level, fall))) {
      return false;
    }
    const Vec3<Position> end = moved(over, free_part(fall, ground));
    if (height_of(saturated<Length>(end - move_.position)) < Length{}) return false;
    move_.position = end;
    move_.stepped = true;
    return true;
  }

  [[nodiscard]] bool is_ground_ahead(const Vec3<Position>& over, const Vec3<Length>& level,
                                     const Vec3<Length>& fall) const {
    const Vec3<Length> half = half_extents(def_.shape);
    const Vec3<Length> ahead = times(direction_of(level), max(half.x, half.z) + def_.skin);
    const Vec3<Position> there = moved(over, free_part(ahead, cast(over, ahead)));
    const ShapeHit ground = cast(there, fall);
    return !ground.body.is_null() && is_walkable(ground.normal);
  }

  // Down to the ground that it walked off, as far as a step.
  void settle() {
    const Vec3<Length> fall = upward(-(def_.step_height + def_.skin));
    const ShapeHit hit = cast(move_.position, fall);
    if (hit.body.is_null() || !is_walkable(hit.normal)) return;
    move_.position = moved(move_.position, free_part(fall, hit));
    stand_on(hit.body, hit.normal, hit.point);
  }

  bool find_ground(Length reach) {
    const ShapeHit hit = cast(move_.position, upward(-reach));
    if (hit.body.is_null() || !is_walkable(hit.normal)) return false;
    stand_on(hit.body, hit.normal, hit.point);
    return true;
  }

  void stand_on(BodyHandle body, const Vec3<Unit>& normal, const Vec3<Position>& point) {
    move_.ground = body;
    move_.ground_normal = normal;
    move_.ground_point = point;
  }

  const CharacterObstacles obstacles_;
  const CharacterDef& def_;
  const Vec3<Unit> up_;
  CharacterMove move_;
};

// J = v · M·m / (M + m)
Impulse inelastic(Velocity speed, Mass a, Mass b) {
  const Unit share = ratio(inverse_of(a), inverse_of(b));  // b / (a + b)
  const std::int64_t reduced = raw::multiply_shift(a.raw, share.raw, Unit::frac_bits);
  const Int128 product = multiply_wide(speed.raw, reduced);  // 64 fraction bits
  return Impulse::from_raw(saturate_to_int64(round_shift(product, 64 - Impulse::frac_bits)));
}

Vec3<Impulse> along(Impulse size, const Vec3<Unit>& n) {
  const auto part = [&](Unit x) {
    return Impulse::from_raw(raw::multiply_shift(size.raw, x.raw, Unit::frac_bits));
  };
  return {part(n.x), part(n.y), part(n.z)};
}

Impulse over_tick(Force force, const World& world) {
  constexpr int k_more_bits = Impulse::frac_bits - Force::frac_bits;
  const std::int64_t rate = world.def().tick_rate;
  return Impulse::from_raw(raw::scale_saturating(raw::round_divide(force.raw, rate), k_more_bits));
}

/// The part of a velocity along a direction, its raw.
template <class Speed>
std::int64_t raw_along(const Vec3<Speed>& v, const Vec3<Unit>& n) {
  std::int64_t sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    sum += raw::multiply_shift(v[axis].raw, n[axis].raw, Unit::frac_bits);
  return sum;
}

/// The impulse that a body gets from a hit, against the hit's normal.
Impulse push_of(const World& world, const CharacterDef& character, const CharacterHit& hit,
                const BodyView& body) {
  Velocity speed = rounded<Velocity>(hit.blocked * Rate::from_integer(world.def().tick_rate));
  // less the speed it already gives way with, or more that with which it comes, along the normal
  speed += Velocity::from_raw(raw_along(body.velocity, hit.normal));
  if (speed <= Velocity{}) return {};
  return min(inelastic(speed, character.mass, body.mass.mass),
             over_tick(character.push_force, world));
}

void push(World& world, BodyHandle handle, const BodyView& body, const Vec3<Position>& point,
          const Vec3<Impulse>& impulse) {
  const Vec3<Length> arm = saturated<Length>(point - body.centre_of_mass);
  (void)world.apply(ApplyImpulseAt{handle, impulse, arm});
}

/// Of two numbers of 32 fraction bits, with as many.
std::int64_t product(std::int64_t a, std::int64_t b) {
  return saturated_product(a, b, 32);
}

/// Whether a point of a body moves along gravity faster than a tick of free fall makes it.
bool gives_way(const World& world, const CharacterDef& character, const BodyView& body,
               const Vec3<Position>& point) {
  const Vec3<Length> arm = saturated<Length>(point - body.centre_of_mass);
  const auto turning = cross(body.angular_velocity, arm);
  const Vec3<Acceleration>& gravity = character.gravity;
  std::int64_t speed = 0, gain = 0;  // times |g|, 32 fraction bits
  for (int axis = 0; axis < 3; ++axis) {
    const Velocity v = body.velocity[axis] + rounded<Velocity>(turning[axis]);
    speed += product(v.raw, gravity[axis].raw);
    gain += product(gravity[axis].raw, gravity[axis].raw);
  }
  return speed > raw::round_divide(gain, world.def().tick_rate);
}

/// m·g over a tick; of a body that gives way the share that leaves both falling together.
Vec3<Impulse> weight_of(const World& world, const CharacterDef& character, const BodyView& ground,
                        const Vec3<Position>& point) {
  const Vec3<Acceleration>& gravity = character.gravity;
  const Unit share = gives_way(world, character, ground, point)
                         ? ratio(inverse_of(character.mass), inverse_of(ground.mass.mass))
                         : Unit::from_integer(1);
  const auto part = [&](Acceleration g) {
    const Int128 product = multiply_wide(g.raw, character.mass.raw);  // 64 fraction bits
    const std::int64_t force = saturate_to_int64(round_shift(product, 64 - Impulse::frac_bits));
    const std::int64_t weight = raw::round_divide(force, world.def().tick_rate);
    return Impulse::from_raw(raw::multiply_shift(weight, share.raw, Unit::frac_bits));
  };
  return {part(gravity.x), part(gravity.y), part(gravity.z)};
}

Length within_limit(Length way) {
  return clamp(way, -k_motion_limit, k_motion_limit);
}

/// Of one tick.
Angle angle_of(std::uint64_t speed, const World& world) {
  const std::uint64_t angle = speed / world.def().tick_rate >> (32 - Angle::frac_bits);
  return Angle::from_raw(static_cast<std::int32_t>(std::min<std::uint64_t>(angle, INT32_MAX)));
}

void check(const CharacterDef& character) {
  switch (character.shape.kind) {
    case ShapeKind::sphere:
    case ShapeKind::capsule:
    case ShapeKind::box:
    case ShapeKind::cylinder:
    case ShapeKind::cone:
    case ShapeKind::tapered_capsule:
    case ShapeKind::rounded_box:
      break;
    default:
      misused(
          "move_character: CharacterDef::shape must be a sphere, capsule, box, cylinder, cone, "
          "tapered capsule or rounded box");
  }
  if (character.skin <= Length{} || character.skin > inner_radius(character.shape))
    misused("move_character: CharacterDef::skin must be above 0 and at most the inner radius");
}

}  // namespace

CharacterMove move_character(const World& world, const CharacterDef& character,
                             const Vec3<Position>& position, const Vec3<Length>& motion,
                             bool stay_on_ground, const Vec3<Length>& carried) {
  if (!is_within(motion, k_motion_limit) || !is_within(carried, k_motion_limit))
    misused("move_character: a motion is above 8 m along an axis; move in shorter steps");
  check(character);
  return Mover(world, character, position).run(motion, stay_on_ground, carried);
}

CharacterCarry carried_by(const World& world, const CharacterDef& character,
                          const CharacterMove& move) {
  if (!move.grounded || !world.exists(move.ground)) return {};
  const BodyView ground = world.body(move.ground);
  if (ground.motion == MotionType::static_body || ground.is_asleep) return {};
  const std::int64_t rate = world.def().tick_rate;
  CharacterCarry carry;
  for (int axis = 0; axis < 3; ++axis) {
    const auto way = Position::from_raw(raw::round_divide(ground.velocity[axis].raw, rate));
    carry.motion[axis] = within_limit(saturated<Length>(way));
  }
  const Vec3<AngularVelocity>& spin = ground.angular_velocity;
  if (spin == Vec3<AngularVelocity>{}) return carry;
  const Quat turn = from_axis_angle(direction_of(spin.x.raw, spin.y.raw, spin.z.raw),
                                    angle_of(norm(spin.x.raw, spin.y.raw, spin.z.raw), world));
  const Vec3<Length> arm = saturated<Length>(move.ground_point - ground.centre_of_mass);
  const Vec3<Length> way = rotate(to_matrix(turn), arm) - arm;
  for (int axis = 0; axis < 3; ++axis)
    carry.motion[axis] = within_limit(carry.motion[axis] + within_limit(way[axis]));
  const Vec3<Unit> up = up_of(character);
  const std::int64_t about_up = raw_along(spin, up);
  const Angle yaw =
      angle_of(static_cast<std::uint64_t>(about_up < 0 ? -about_up : about_up), world);
  carry.turn = from_axis_angle(up, about_up < 0 ? -yaw : yaw);
  return carry;
}

void apply_pushes(World& world, const CharacterDef& character, const CharacterMove& move) {
  bool lands = false;
  for (const CharacterHit& hit : std::span(move.hits).first(move.hit_count)) {
    if (!world.exists(hit.body)) continue;
    const BodyView body = world.body(hit.body);
    if (body.motion != MotionType::dynamic) continue;
    const Impulse size = push_of(world, character, hit, body);
    if (size <= Impulse{}) continue;
    lands = lands || hit.body == move.ground;
    push(world, hit.body, body, hit.point, along(-size, hit.normal));
  }
  if (!move.grounded || lands || !world.exists(move.ground)) return;
  const BodyView ground = world.body(move.ground);
  if (ground.motion != MotionType::dynamic) return;
  push(world, move.ground, ground, move.ground_point,
       weight_of(world, character, ground, move.ground_point));
}

bool has_room(const World& world, const CharacterDef& character, const Vec3<Position>& position) {
  check(character);
  std::array<ShapeContact, k_max_planes> contacts;
  const std::size_t count =
      CharacterObstacles(world, character).contacts(position, Length{}, contacts);
  return std::ranges::none_of(std::span(contacts).first(count), [&](const ShapeContact& contact) {
    return -rounded<Length>(contact.separation) > character.skin;
  });
}

std::optional<Vec3<Position>> reshaped(const World& world, const CharacterDef& from,
                                       const Vec3<Position>& position, const CharacterDef& to) {
  const Length rise = half_extents(to.shape).y - half_extents(from.shape).y;
  const Vec3<Position> centre = moved(position, times(up_of(from), rise));
  if (!has_room(world, to, centre)) return std::nullopt;
  return centre;
}

}  // namespace lockstone
