#include "core/dynamics/impact/impact_island.h"

#include <algorithm>
#include <span>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/impact/impact_response.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

constexpr int k_most_impacts = 64;  // of a group in a tick

Vec3<Velocity> times(const Vec3<Velocity>& v, Unit u) {
  return {times(v.x, u), times(v.y, u), times(v.z, u)};
}

Velocity along(const Vec3<Velocity>& v, const Vec3<Unit>& n) {
  return times(v.x, n.x) + times(v.y, n.y) + times(v.z, n.z);
}

// The way covered in a tick at a speed, m, Q24, bounded so that squares fit.
std::int64_t way(Velocity v, const TimeStep& step) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 30;
  return std::clamp(raw::round_shift(step.tick.times(v.raw), 8), -k_bound, k_bound);
}

// A point above a surface: s + u·f + g·f²/2 after the fraction f of a tick, m, Q24.
struct Fall {
  static constexpr std::int64_t k_highest = std::int64_t{1} << 31;

  std::int64_t s = 0, u = 0, g = 0;

  // How fast it meets the surface, in m a tick, or −1 when it does not.
  [[nodiscard]] std::int64_t speed() const {
    const std::int64_t square = u * u - 2 * g * std::clamp<std::int64_t>(s, 0, k_highest);
    if (square < 0 || (u >= 0 && g >= 0)) return -1;
    return static_cast<std::int64_t>(isqrt(static_cast<std::uint64_t>(square)));
  }

  // When it does, Q30; clamped to 2.
  [[nodiscard]] std::int64_t fraction(std::int64_t at_speed) const {
    LKS_ASSERT(at_speed >= 0);
    constexpr std::int64_t k_late = std::int64_t{2} << 30;
    const std::int64_t top = u < 0 ? 2 * std::max<std::int64_t>(s, 0) : u + at_speed;
    const std::int64_t bottom = u < 0 ? at_speed - u : -g;
    if (bottom <= 0 || top > 2 * bottom) return k_late;
    return raw::round_divide(top << 30, bottom);
  }

  [[nodiscard]] std::int64_t after(Unit f) const {
    const auto part = [&](std::int64_t x) { return raw::multiply_shift(x, f.raw, 30); };
    return s + part(u) + raw::round_divide(part(part(g)), 2);
  }
};

Vec3<Velocity> surface_of(const BodyRecord& body) {
  return surface_velocity(inverse_inertia(body, to_matrix(body.orientation)), body.spin);
}

// Of a point of a body, w its surface velocity.
Vec3<Velocity> velocity_at(const BodyRecord& body, const Vec3<Velocity>& w, const Vec3<Length>& r) {
  const auto arm = [&](Velocity v, Length x) {
    return Velocity::from_raw(
        raw::multiply_shift(v.raw, x.raw, Length::frac_bits + body.scale_exponent));
  };
  return body.velocity + Vec3<Velocity>{arm(w.y, r.z) - arm(w.z, r.y),
                                        arm(w.z, r.x) - arm(w.x, r.z),
                                        arm(w.x, r.y) - arm(w.y, r.x)};
}

// Two balls are where their centres are; of other shapes the normal stays for the tick.
bool are_balls(const ImpactPair& pair) {
  return pair.a->is_ball() && pair.b->is_ball();
}

struct Balls {
  Vec3<Unit> normal;
  std::int64_t gap;  // m, Q24
};

Balls balls_at(const ImpactPair& pair, const Vec3<Position>& offset) {
  const auto length = static_cast<std::int64_t>(norm(offset.x.raw, offset.y.raw, offset.z.raw));
  const std::int64_t reach = std::int64_t{pair.a->size.x.raw} + pair.b->size.x.raw;
  const Vec3<Unit> normal =
      offset == Vec3<Position>{} ? pair.manifold->normal : direction_of(offset);
  return {normal, raw::round_shift(length - reach * (1 << 12), 8)};
}

// When two balls meet: Newton's method, from one side, since balls are round.
PairImpact impact_of_balls(const ImpactPair& pair, const Vec3<Velocity>& gain, const TimeStep& step,
                           Unit limit) {
  constexpr int k_iterations = 6;
  const Vec3<Velocity> v = pair.b->velocity - pair.a->velocity;
  const Vec3<Position> start = pair.b->position - pair.a->position;
  PairImpact impact;
  for (int i = 0; i < k_iterations; ++i) {
    const Unit t = Unit::from_raw(static_cast<std::int32_t>(impact.fraction));
    const Vec3<Velocity> gained = times(gain, t);
    Vec3<Position> offset = start;
    for (int axis = 0; axis < 3; ++axis) {
      const Velocity twice = v[axis] + v[axis] + gained[axis];
      offset[axis].raw += raw::round_divide(times(twice, t).raw, 2 * step.tick_rate);
    }
    const Balls balls = balls_at(pair, offset);
    LKS_ASSERT(geometry::is_unit(balls.normal));
    const Velocity closing = along(v + gained, balls.normal);
    const Fall fall{balls.gap, way(closing, step), way(along(gain, balls.normal), step)};
    const std::int64_t speed = fall.speed();
    if (speed < 0) return {};
    const std::int64_t further = fall.fraction(speed);
    LKS_ASSERT(further >= 0);
    impact.fraction += further;
    impact.speed = -closing;
    if (impact.fraction > limit.raw) return {};
    if (further <= 1) break;
  }
  impact.meets = true;
  return impact;
}

using Gaps = std::array<std::int64_t, k_max_manifold_points>;

Gaps gaps_of(const Manifold& manifold) {
  Gaps gaps{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
    gaps[i] = manifold.points[i].separation.raw;
  return gaps;
}

// How the points come together; `gain`: of B against A in a tick.
std::array<Fall, k_max_manifold_points> falls_of(const ImpactPair& pair, const Gaps& gaps,
                                                 const Vec3<Velocity>& gain, const TimeStep& step) {
  std::array<Fall, k_max_manifold_points> falls{};
  const Vec3<Velocity> wa = surface_of(*pair.a), wb = surface_of(*pair.b);
  const Manifold& manifold = *pair.manifold;
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= k_max_manifold_points);
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
    const ManifoldPoint& point = manifold.points[i];
    const Vec3<Velocity> apart =
        velocity_at(*pair.b, wb, point.anchor_b) - velocity_at(*pair.a, wa, point.anchor_a);
    falls[i] = {gaps[i], way(along(apart, manifold.normal), step),
                way(along(gain, manifold.normal), step)};
  }
  return falls;
}

PairImpact impact_of_points(const ImpactPair& pair, const Gaps& gaps, const Vec3<Velocity>& gain,
                            const TimeStep& step, Unit limit) {
  const auto falls = falls_of(pair, gaps, gain, step);
  PairImpact first;
  first.fraction = limit.raw + std::int64_t{1};
  for (std::size_t i = 0; i < static_cast<std::size_t>(pair.manifold->count); ++i) {
    const std::int64_t speed = falls[i].speed();
    if (speed < 0) continue;
    const std::int64_t fraction = falls[i].fraction(speed);
    if (fraction >= first.fraction) continue;
    LKS_ASSERT(fraction >= 0);
    const std::int64_t per_second = speed * step.tick_rate;
    first = {true, fraction, Velocity::from_raw(per_second * 256)};
  }
  return first;
}

// On the way for a fraction of the tick, as in flight.
void integrate_ballistic(BodyRecord& body, const Vec3<Velocity>& gain, Unit fraction,
                         const TimeStep& step) {
  LKS_ASSERT(fraction >= Unit{} && fraction <= Unit::from_integer(1) && step.tick_rate > 0);
  for (int i = 0; i < 3; ++i) {
    const Velocity gained = times(gain[i], fraction);
    const Velocity twice = body.velocity[i] + body.velocity[i] + gained;
    body.position[i].raw += raw::round_divide(times(twice, fraction).raw, 2 * step.tick_rate);
    body.velocity[i] += gained;
  }
  (void)turn_in_flight(body, to_matrix(body.orientation), step, fraction);
}

// The one point where two balls touch.
Manifold touching_balls(const ImpactPair& pair) {
  Manifold manifold;
  manifold.normal = balls_at(pair, pair.b->position - pair.a->position).normal;
  manifold.count = 1;
  for (int i = 0; i < 3; ++i) {
    const Unit n = manifold.normal[i];
    const auto arm = [&](const BodyRecord& body) {
      return static_cast<std::int32_t>(
          raw::multiply_shift(body.size.x.raw, n.raw, Unit::frac_bits));
    };
    manifold.points[0].anchor_a[i].raw = arm(*pair.a);
    manifold.points[0].anchor_b[i].raw = -arm(*pair.b);
  }
  LKS_ASSERT(geometry::is_unit(manifold.normal));
  return manifold;
}

// Mean of the points of a manifold that are about as near as the nearest, where B has them.
Vec3<Position> meeting_point(const Gaps& gaps, const Manifold& manifold, const BodyRecord& b) {
  constexpr std::int64_t k_about = std::int64_t{1} << 14;  // 1 mm, Q24
  const auto count = static_cast<std::size_t>(manifold.count);
  LKS_ASSERT(count >= 1 && count <= gaps.size());
  const std::int64_t least = *std::min_element(gaps.begin(), gaps.begin() + manifold.count);
  Vec3<Position> sum;
  std::int64_t near = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (gaps[i] > least + k_about) continue;
    ++near;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += rounded<Position>(manifold.points[i].anchor_b[axis]);
  }
  LKS_ASSERT(near >= 1);
  Vec3<Position> point = b.position;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] += Position::from_raw(raw::round_divide(sum[axis].raw, near));
  return point;
}

Vec3<Velocity> gain_in_tick(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                            const TimeStep& step) {
  return body.is_dynamic() ? tick_gain(body, gravity, step) : Vec3<Velocity>{};
}

}  // namespace

PairImpact next_impact(const ImpactPair& pair, const Vec3<Acceleration>& gravity,
                       const TimeStep& step, Unit limit) {
  const Vec3<Velocity> gain =
      gain_in_tick(*pair.b, gravity, step) - gain_in_tick(*pair.a, gravity, step);
  if (are_balls(pair)) return impact_of_balls(pair, gain, step, limit);
  return impact_of_points(pair, gaps_of(*pair.manifold), gain, step, limit);
}

void ImpactIsland::add(const ImpactPair& pair) {
  LKS_ASSERT(contact_count_ < contacts_.size());
  LKS_ASSERT(pair.a != pair.b);
  Contact& contact = contacts_[contact_count_++];
  contact = {};
  contact.pair = pair;
  contact.flyer_a = flyer_of(pair.a);
  contact.flyer_b = flyer_of(pair.b);
  contact.gap = gaps_of(*pair.manifold);
}

std::uint8_t ImpactIsland::flyer_of(BodyRecord* body) {
  if (!body->is_dynamic()) return k_none;
  const auto end = flyers_.begin() + static_cast<std::ptrdiff_t>(flyer_count_);
  const auto known =
      std::find_if(flyers_.begin(), end, [&](const Flyer& flyer) { return flyer.body == body; });
  if (known == end) {
    LKS_ASSERT(flyer_count_ < flyers_.size());
    *known = {body, tick_gain(*body, gravity_, step_)};
    ++flyer_count_;
  }
  return static_cast<std::uint8_t>(known - flyers_.begin());
}

Vec3<Velocity> ImpactIsland::gain_of(std::uint8_t flyer) const {
  return flyer == k_none ? Vec3<Velocity>{} : flyers_[flyer].gain;
}

PairImpact ImpactIsland::impact_of(const Contact& contact, Unit limit) const {
  const Vec3<Velocity> gain = gain_of(contact.flyer_b) - gain_of(contact.flyer_a);
  if (are_balls(contact.pair)) return impact_of_balls(contact.pair, gain, step_, limit);
  return impact_of_points(contact.pair, contact.gap, gain, step_, limit);
}

void ImpactIsland::run() {
  Unit left = k_whole_tick;
  for (int i = 0; i < k_most_impacts; ++i) {
    PairImpact first;
    first.fraction = left.raw + std::int64_t{1};
    Contact* next = nullptr;
    for (Contact& contact : std::span(contacts_).first(contact_count_)) {
      if (contact.rests) continue;
      const PairImpact impact = impact_of(contact, left);
      if (!impact.meets || impact.fraction >= first.fraction) continue;
      first = impact;
      next = &contact;
    }
    if (next == nullptr) break;
    const Unit fraction = Unit::from_raw(static_cast<std::int32_t>(first.fraction));
    advance(fraction);
    LKS_ASSERT(fraction >= Unit{} && fraction <= left);
    left -= fraction;
    answer(*next, first.speed);
  }
  advance(left);
}

void ImpactIsland::advance(Unit fraction) {
  if (fraction == Unit{}) return;
  LKS_ASSERT(contact_count_ <= contacts_.size() && flyer_count_ <= flyers_.size());
  for (Contact& contact : std::span(contacts_).first(contact_count_)) {
    if (are_balls(contact.pair)) continue;
    const Vec3<Velocity> gain = gain_of(contact.flyer_b) - gain_of(contact.flyer_a);
    const auto falls = falls_of(contact.pair, contact.gap, gain, step_);
    for (std::size_t i = 0; i < falls.size(); ++i)
      contact.gap[i] = falls[i].after(fraction);
  }
  for (const Flyer& flyer : std::span(flyers_).first(flyer_count_))
    integrate_ballistic(*flyer.body, flyer.gain, fraction, step_);
}

// A contact that is too slow to bounce again stays closed for the rest of the tick.
void ImpactIsland::answer(Contact& contact, Velocity speed) {
  LKS_ASSERT(!contact.rests);
  contact.touched = true;
  contact.rests = speed <= k_least_bounce;
  BodyRecord& a = *contact.pair.a;
  BodyRecord& b = *contact.pair.b;
  const ContactSurface& surface = *contact.pair.surface;
  const InverseInertia inertia_a = inverse_inertia(a, to_matrix(a.orientation));
  const InverseInertia inertia_b = inverse_inertia(b, to_matrix(b.orientation));
  const bool balls = are_balls(contact.pair);
  const Manifold now = balls ? touching_balls(contact.pair) : *contact.pair.manifold;
  const Vec3<Velocity> before = b.velocity - a.velocity;
  const Velocity approach = answer_impact(
      {a, inertia_a}, {b, inertia_b},
      {now, surface.friction, contact.rests ? Coefficient{} : surface.restitution, Velocity{}});
  contact.approach = max(contact.approach, approach);
  if (contact.pair.is_watched) {
    contact.total.add(approach, (b.velocity - a.velocity) - before, now.normal,
                      meeting_point(contact.gap, now, b));
  }
  if (!contact.rests) return;
  for (const std::uint8_t flyer : {contact.flyer_a, contact.flyer_b})
    if (flyer != k_none) flyers_[flyer].gain = {};
}

}  // namespace lockstone
