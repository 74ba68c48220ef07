#include <algorithm>

#include <lockstone/character.h>

#include "core/dynamics/state/limits.h"
#include "core/math/block_float.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr int k_max_slides = 6;
constexpr int k_max_push_outs = 4;
constexpr std::size_t k_max_planes = 16;
constexpr Length k_motion_limit = Length::from_integer(8);
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

bool is_negligible(const Vec3<Length>& v) {
  return abs(v.x) <= k_negligible && abs(v.y) <= k_negligible && abs(v.z) <= k_negligible;
}

// One move under way.
class Mover {
 public:
  Mover(const World& world, const CharacterDef& def, const Vec3<Position>& position)
      : world_(world), def_(def), shape_(Shape::capsule(def.half_height, def.radius)) {
    move_.position = position;
  }

  CharacterMove run(const Vec3<Length>& motion, bool stay_on_ground) {
    push_out();
    const bool rises = motion.y > Length{};
    const bool stood = find_ground(def_.skin * 2);
    slide(motion, stood || stay_on_ground);
    if (stay_on_ground && stood && !rises) settle();
    move_.grounded = find_ground(def_.skin * 2) && !rises;
    if (!move_.grounded) move_.ground = {};
    return move_;
  }

 private:
  [[nodiscard]] bool is_walkable(const Vec3<Unit>& normal) const {
    return normal.y >= def_.min_ground_slope;
  }

  [[nodiscard]] ShapeHit cast(const Vec3<Position>& from, const Vec3<Length>& motion) const {
    return world_.cast_shape({shape_, {from, {}}, motion}, def_.filter);
  }

  // Out of all overlaps, the smallest first: each plane pushes by the rest that the others have not
  // provided.
  void push_out() {
    std::array<ShapeContact, k_max_planes> contacts;
    for (int round = 0; round < k_max_push_outs; ++round) {
      const std::size_t count =
          world_.contacts_of_shape(shape_, {move_.position, {}}, Length{}, contacts, def_.filter);
      Vec3<Length> out{};
      for (std::size_t i = 0; i < count; ++i) {
        const Length depth = -rounded<Length>(contacts[i].separation);
        const Length missing = depth - along(out, contacts[i].normal);
        if (missing > Length{}) out += times(contacts[i].normal, missing);
      }
      if (is_negligible(out)) return;
      move_.position = moved(move_.position, out);
    }
  }

  // As far as nothing is in the way, less the skin.
  [[nodiscard]] Vec3<Length> free_part(const Vec3<Length>& motion, const ShapeHit& hit) const {
    if (hit.body.is_null()) return motion;
    const Length closing = -along(motion, hit.normal);
    if (closing <= Length{}) return {};
    // The skin along the normal is skin / closing of the motion.
    const std::int64_t back =
        raw::round_divide(std::int64_t{def_.skin.raw} << Unit::frac_bits, closing.raw);
    const std::int64_t part = std::int64_t{hit.fraction.raw} - back;
    return part <= 0 ? Vec3<Length>{}
                     : scaled(motion, Unit::from_raw(static_cast<std::int32_t>(part)));
  }

  void note(const ShapeHit& hit, const Vec3<Length>& rest) {
    if (move_.hit_count == CharacterMove::k_max_hits) return;
    const Length blocked = max(-along(rest, hit.normal), Length{});
    move_.hits[move_.hit_count++] = {hit.body, hit.point, hit.normal, blocked};
  }

  void slide(Vec3<Length> motion, bool may_step) {
    std::array<Vec3<Unit>, k_max_slides> planes{};
    for (int i = 0; i < k_max_slides && !is_negligible(motion); ++i) {
      const ShapeHit hit = cast(move_.position, motion);
      const Vec3<Length> free = free_part(motion, hit);
      move_.position = moved(move_.position, free);
      if (hit.body.is_null()) return;
      motion -= free;
      note(hit, motion);
      if (may_step && !is_walkable(hit.normal) && step_up(motion)) return;
      planes[static_cast<std::size_t>(i)] = wall_normal(hit.normal, motion);
      motion = deflected(motion, std::span(planes).first(static_cast<std::size_t>(i) + 1));
    }
  }

  // A slope too steep to stand on does not lift the character: it acts as an upright wall.
  [[nodiscard]] Vec3<Unit> wall_normal(const Vec3<Unit>& normal, const Vec3<Length>& motion) const {
    const bool upward = normal.y > Unit{};
    if (!upward || is_walkable(normal) || motion.y < Length{}) return normal;
    if (normal.x == Unit{} && normal.z == Unit{}) return normal;
    return direction_of(normal.x.raw, 0, normal.z.raw);
  }

  // The rest of a motion that must enter none of the planes, the last of which it ran into:
  // along that plane, or along the crease with one of the others, or nothing.
  [[nodiscard]] static Vec3<Length> deflected(const Vec3<Length>& motion,
                                              std::span<const Vec3<Unit>> planes) {
    const Vec3<Unit>& last = planes.back();
    const Length into = along(motion, last);
    const Vec3<Length> flat = into < Length{} ? motion - times(last, into) : motion;
    const auto enters = [](const Vec3<Length>& v, const Vec3<Unit>& plane) {
      return along(v, plane) < -k_negligible;
    };
    const auto first = std::ranges::find_if(planes.first(planes.size() - 1),
                                            [&](const auto& plane) { return enters(flat, plane); });
    if (first == planes.end() - 1) return flat;
    const auto crease = cross(*first, last);
    if (crease.x.raw == 0 && crease.y.raw == 0 && crease.z.raw == 0) return {};
    const Vec3<Unit> edge = direction_of(crease);
    const Vec3<Length> result = times(edge, along(motion, edge));
    const bool stuck =
        std::ranges::any_of(planes, [&](const Vec3<Unit>& plane) { return enters(result, plane); });
    return stuck ? Vec3<Length>{} : result;
  }

  // Up, along and down again: taken when it ends no lower and there is walkable ground ahead, under
  // the foot or a radius farther on, where the round foot no longer meets the ledge's rim.
  bool step_up(const Vec3<Length>& motion) {
    const Vec3<Length> level{motion.x, {}, motion.z};
    if (def_.step_height <= Length{} || is_negligible(level)) return false;
    const Vec3<Length> rise{{}, def_.step_height, {}};
    const Vec3<Length> risen = free_part(rise, cast(move_.position, rise));
    const Vec3<Position> above = moved(move_.position, risen);
    const Vec3<Length> along_ledge = free_part(level, cast(above, level));
    if (is_negligible(along_ledge)) return false;
    const Vec3<Position> over = moved(above, along_ledge);
    const Vec3<Length> fall{{}, -risen.y, {}};
    const ShapeHit ground = cast(over, fall);
    if (ground.body.is_null() ||
        !(is_walkable(ground.normal) || is_ground_ahead(over, level, fall))) {
      return false;
    }
    const Vec3<Position> end = moved(over, free_part(fall, ground));
    if (end.y < move_.position.y) return false;
    move_.position = end;
    move_.stepped = true;
    return true;
  }

  [[nodiscard]] bool is_ground_ahead(const Vec3<Position>& over, const Vec3<Length>& level,
                                     const Vec3<Length>& fall) const {
    const Vec3<Length> ahead = times(direction_of(level), def_.radius + def_.skin);
    const Vec3<Position> there = moved(over, free_part(ahead, cast(over, ahead)));
    const ShapeHit ground = cast(there, fall);
    return !ground.body.is_null() && is_walkable(ground.normal);
  }

  // Down to the ground that it walked off, as far as a step.
  void settle() {
    const Vec3<Length> fall{{}, -(def_.step_height + def_.skin), {}};
    const ShapeHit ground = cast(move_.position, fall);
    if (ground.body.is_null() || !is_walkable(ground.normal)) return;
    move_.position = moved(move_.position, free_part(fall, ground));
  }

  bool find_ground(Length reach) {
    const ShapeHit hit = cast(move_.position, {{}, -reach, {}});
    const bool found = !hit.body.is_null() && is_walkable(hit.normal);
    if (found) {
      move_.ground = hit.body;
      move_.ground_normal = hit.normal;
    }
    return found;
  }

  const World& world_;
  const CharacterDef& def_;
  const Shape shape_;
  CharacterMove move_;
};

// J = v · M·m / (M + m)
Impulse inelastic(Velocity speed, Mass a, Mass b) {
  const Unit share = ratio(inverse_of(a), inverse_of(b));  // b / (a + b)
  const std::int64_t reduced = raw::multiply_shift(a.raw, share.raw, Unit::frac_bits);
  const Int128 product = multiply_wide(speed.raw, reduced);  // 64 fraction bits
  return Impulse::from_raw(saturate_to_int64(round_shift(product, 64 - Impulse::frac_bits)));
}

}  // namespace

CharacterMove move_character(const World& world, const CharacterDef& character,
                             const Vec3<Position>& position, const Vec3<Length>& motion,
                             bool stay_on_ground) {
  if (!is_within(motion, k_motion_limit))
    misused("move_character: `motion` is above 8 m along an axis; move in shorter steps");
  if (character.skin <= Length{} || character.skin > character.radius)
    misused("move_character: CharacterDef::skin must be above 0 and at most the radius");
  return Mover(world, character, position).run(motion, stay_on_ground);
}

void apply_pushes(World& world, const CharacterDef& character, const CharacterMove& move) {
  for (std::size_t i = 0; i < move.hit_count; ++i) {
    const CharacterHit& hit = move.hits[i];
    if (!world.exists(hit.body) || hit.blocked <= Length{}) continue;
    const BodyView body = world.body(hit.body);
    if (body.motion != MotionType::dynamic) continue;
    Velocity speed = rounded<Velocity>(hit.blocked * Rate::from_integer(world.def().tick_rate));
    for (int axis = 0; axis < 3; ++axis) {
      // less the speed it already gives way with, against the normal
      speed += Velocity::from_raw(
          raw::multiply_shift(body.velocity[axis].raw, hit.normal[axis].raw, Unit::frac_bits));
    }
    if (speed <= Velocity{}) continue;
    const Impulse size = inelastic(speed, character.mass, world.mass(hit.body));
    const auto part = [&](Unit n) {
      return Impulse::from_raw(-raw::multiply_shift(size.raw, n.raw, Unit::frac_bits));
    };
    const Vec3<Impulse> impulse{part(hit.normal.x), part(hit.normal.y), part(hit.normal.z)};
    const Vec3<Length> point = saturated<Length>(hit.point - body.centre_of_mass);
    (void)world.apply(ApplyImpulseAt{hit.body, impulse, point});
  }
}

}  // namespace lockstone
