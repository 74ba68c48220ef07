// Bodies that fly onto what does not give way, and bounce: at the moment of the tick at which they
// meet it, not at the tick's end. Height and speed then agree, so that a bounce neither wins nor
// loses energy, and a ball comes to rest when it ought to.
//
// Only for what meets nothing else in the tick; other bounces are those of the contact solver.

#include <algorithm>

#include "core/dynamics/impact_response.h"
#include "core/dynamics/motion.h"
#include "core/math/roots.h"
#include "core/math/trig.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Slower ones do not bounce: a ball would be back within half a tick.
constexpr Velocity k_least_bounce = Velocity::from_ratio(1, 32);

constexpr int k_most_bounces = 16;  // in a tick

constexpr std::uint32_t k_bounce_grain = 16;

constexpr Unit k_whole = Unit::from_integer(1);

// The solver brakes what meets a surface in the substep after the tick: that flies on as well.
constexpr Unit k_two_ticks = Unit::max();

Velocity times(Velocity v, Unit u) {
  return Velocity::from_raw(raw::multiply_shift(v.raw, u.raw, Unit::frac_bits));
}

Velocity along(const Vec3<Velocity>& v, const Vec3<Unit>& n) {
  return times(v.x, n.x) + times(v.y, n.y) + times(v.z, n.z);
}

// What a speed covers in a tick, m, Q24, bounded so that squares fit.
std::int64_t way(Velocity v, const TimeStep& step) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 30;
  return std::clamp(raw::round_shift(step.tick.times(v.raw), 8), -k_bound, k_bound);
}

// A point above a surface: s + u·f + g·f²/2 after the fraction f of a tick, m, Q24.
struct Fall {
  std::int64_t s = 0, u = 0, g = 0;

  // How fast it meets the surface, in m a tick, or −1 when it does not.
  [[nodiscard]] std::int64_t speed() const {
    const std::int64_t square = u * u - 2 * g * std::max<std::int64_t>(s, 0);
    if (square < 0 || (u >= 0 && g >= 0)) return -1;
    return static_cast<std::int64_t>(isqrt(static_cast<std::uint64_t>(square)));
  }

  // When it does, Q30; beyond 2 it is held.
  [[nodiscard]] std::int64_t fraction(std::int64_t at_speed) const {
    constexpr std::int64_t k_late = std::int64_t{2} << 30;
    const std::int64_t top = u < 0 ? 2 * std::max<std::int64_t>(s, 0) : u + at_speed;
    const std::int64_t bottom = u < 0 ? at_speed - u : -g;
    if (bottom <= 0 || top > 2 * bottom) return k_late;
    return raw::round_divide(top << 30, bottom);
  }
};

}  // namespace

/// A body on its way through a tick, and the one contact that it has.
struct World::Impl::Bouncing {
  BodyRecord& body;
  const BodyRecord& other;
  const Manifold& manifold;
  bool is_a;                          // whether the body is A of the manifold
  Vec3<Velocity> gain;                // of the whole tick
  std::array<std::int64_t, 4> gap{};  // m, Q24
};

World::Impl::Bouncing World::Impl::bouncing(std::size_t contact) {
  const ContactRecord& record = new_contacts[contact];
  const bool is_a = bodies[record.body_a].is_dynamic();
  BodyRecord& body = bodies[is_a ? record.body_a : record.body_b];
  const BodyRecord& other = bodies[is_a ? record.body_b : record.body_a];
  Bouncing b{body, other, manifolds[slots[contact]], is_a, {}, {}};
  b.gain = tick_gain(body, header.gravity, time_step);
  for (int i = 0; i < b.manifold.count; ++i) {
    const auto point = static_cast<std::size_t>(i);
    b.gap[point] = b.manifold.points[point].separation.raw;
  }
  return b;
}

// The point that meets the surface first within what is left of the tick; null when none does.
World::Impl::Meeting World::Impl::next_meeting(const Bouncing& b, Unit left) const {
  const auto surface = [&](const BodyRecord& record) {
    const Mat3 rotation = to_matrix(record.orientation);
    return surface_velocity(inverse_inertia(record, rotation), record.spin);
  };
  const auto velocity = [&](const BodyRecord& record, const Vec3<Velocity>& w,
                            const Vec3<Length>& r) {
    const auto arm = [&](Velocity v, Length x) {
      return Velocity::from_raw(
          raw::multiply_shift(v.raw, x.raw, Length::frac_bits + record.scale_exponent));
    };
    return record.velocity + Vec3<Velocity>{arm(w.y, r.z) - arm(w.z, r.y),
                                            arm(w.z, r.x) - arm(w.x, r.z),
                                            arm(w.x, r.y) - arm(w.y, r.x)};
  };
  const Vec3<Unit> up = b.is_a ? -b.manifold.normal : b.manifold.normal;  // off the surface
  const Vec3<Velocity> own = surface(b.body), others = surface(b.other);
  Meeting first;
  first.fraction = left.raw + std::int64_t{1};
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.manifold.count); ++i) {
    const ManifoldPoint& point = b.manifold.points[i];
    const Vec3<Length>& arm = b.is_a ? point.anchor_a : point.anchor_b;
    const Vec3<Length>& other_arm = b.is_a ? point.anchor_b : point.anchor_a;
    const Vec3<Velocity> apart = velocity(b.body, own, arm) - velocity(b.other, others, other_arm);
    const Fall fall{b.gap[i], way(along(apart, up), time_step), way(along(b.gain, up), time_step)};
    const std::int64_t speed = fall.speed();
    if (speed < 0) continue;
    const std::int64_t fraction = fall.fraction(speed);
    if (fraction < first.fraction) first = {true, fraction, speed};
  }
  return first;
}

// On the way for a fraction of the tick, as in flight.
void World::Impl::advance(Bouncing& b, Unit fraction) const {
  const Vec3<Unit> up = b.is_a ? -b.manifold.normal : b.manifold.normal;
  const Vec3<Position> before = b.body.position;
  const auto part = [&](Velocity v) { return times(v, fraction).raw; };
  const Vec3<Velocity> w =
      surface_velocity(inverse_inertia(b.body, to_matrix(b.body.orientation)), b.body.spin);
  RotationVector turn;
  for (int i = 0; i < 3; ++i) {
    const Velocity gained = times(b.gain[i], fraction);
    const Velocity twice = b.body.velocity[i] + b.body.velocity[i] + gained;
    b.body.position[i].raw += raw::round_divide(part(twice), 2 * time_step.tick_rate);
    b.body.velocity[i] += gained;
    turn[i].raw = raw::scale_binary(time_step.tick.times(part(w[i])), -b.body.scale_exponent);
  }
  b.body.orientation = integrate(b.body.orientation, turn);
  const Vec3<Position> went = b.body.position - before;
  const Vec3<Velocity> way_of_other = b.other.moves() ? b.other.velocity : Vec3<Velocity>{};
  const auto other_way = [&](Velocity v) { return time_step.tick.times(part(v)); };
  std::int64_t apart = 0;
  for (int i = 0; i < 3; ++i) {
    apart += raw::multiply_shift(went[i].raw - other_way(way_of_other[i]), up[i].raw, 30);
  }
  for (std::int64_t& gap : b.gap)
    gap += raw::round_shift(apart, 8);
}

void World::Impl::find_bounces() {
  for (const std::uint32_t body : bouncing_bodies)
    bounce_of[body] = 0;
  bouncing_bodies.clear();
  const auto elastic = [](const ContactSurface& s) { return s.restitution > Coefficient{}; };
  const auto elastic_slot = [&](std::uint32_t slot) { return elastic(surfaces[slot]); };
  if (std::ranges::none_of(slots, elastic_slot)) return;
  for (const ContactRecord& record : new_contacts)
    neighbours[record.body_a] = neighbours[record.body_b] = 0;
  const auto count = [&](std::uint32_t body) {
    if (neighbours[body] < 2) ++neighbours[body];
  };
  for (const ContactRecord& record : new_contacts) {
    if (record.is_trigger()) continue;
    count(record.body_a);
    count(record.body_b);
  }
  for (const JointLink& link : active_joints)
    neighbours[link.body_a] = neighbours[link.body_b] = 2;  // what a joint holds does not fly
  for (std::size_t i = 0; i < new_contacts.size(); ++i) {
    if (elastic(surfaces[slots[i]]) && !new_contacts[i].is_trigger() && will_bounce(i))
      mark_bounce(i);
  }
}

bool World::Impl::will_bounce(std::size_t contact) {
  const ContactRecord& record = new_contacts[contact];
  const BodyRecord& a = bodies[record.body_a];
  const BodyRecord& b = bodies[record.body_b];
  if (a.is_dynamic() == b.is_dynamic() || manifolds[slots[contact]].count == 0) return false;
  const std::uint32_t body = a.is_dynamic() ? record.body_a : record.body_b;
  if (neighbours[body] != 1 || turns_much(body)) return false;
  const Meeting meeting = next_meeting(bouncing(contact), k_two_ticks);
  return meeting.meets && meeting.speed > way(k_least_bounce, time_step);
}

// Points of what is no ball are where they were at the tick's beginning: it may turn by 2^-4 rad.
bool World::Impl::turns_much(std::uint32_t body) const {
  const BodyRecord& record = bodies[body];
  if (record.shape().kind == ShapeKind::sphere) return false;
  const Vec3<Velocity> w = surface_velocity(inverse_inertia(record, rotations[body]), record.spin);
  const std::int64_t turned =
      raw::scale_binary(time_step.tick.times(sum_of_magnitudes(w)), -record.scale_exponent);
  return turned > std::int64_t{1} << 28;
}

// The solver leaves it out; what it carried is forgotten.
void World::Impl::mark_bounce(std::size_t contact) {
  ContactRecord& record = new_contacts[contact];
  const std::uint32_t body = bodies[record.body_a].is_dynamic() ? record.body_a : record.body_b;
  ContactRecord fresh;
  fresh.body_a = record.body_a;
  fresh.body_b = record.body_b;
  fresh.part_a = record.part_a;
  fresh.part_b = record.part_b;
  record = fresh;
  surfaces[slots[contact]].bounces = true;
  bounce_of[body] = static_cast<std::uint32_t>(contact) + 1;
  bouncing_bodies.push_back(body);
}

// Before all others move: what these bounce off is where the tick began.
void World::Impl::run_bounces() {
  const Loop each{static_cast<std::uint32_t>(bouncing_bodies.size()), k_bounce_grain};
  parallel.for_each(each, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (const std::uint32_t body : std::span(bouncing_bodies).subspan(first, end - first)) {
      starts[body] = {bodies[body].position, bodies[body].orientation};
      bounce(body);
    }
  });
}

// Through the tick from bounce to bounce; what is too slow to bounce again stays on the surface.
void World::Impl::bounce(std::uint32_t body) {
  const std::size_t contact = bounce_of[body] - 1;
  ContactRecord& record = new_contacts[contact];
  Bouncing b = bouncing(contact);
  Unit left = k_whole;
  for (int i = 0; i < k_most_bounces; ++i) {
    const Meeting meeting = next_meeting(b, left);
    if (!meeting.meets) break;
    const Unit fraction{static_cast<std::int32_t>(meeting.fraction)};
    advance(b, fraction);
    left -= fraction;
    const bool rests = meeting.speed <= way(k_least_bounce, time_step) || i + 1 == k_most_bounces;
    record.flags = k_contact_touching;
    const Velocity approach = answer_bounce(record, contact, rests);
    approach_speeds[contact] = max(
        approach_speeds[contact],
        SolverVelocity::from_raw(raw::saturate<std::int32_t>(raw::round_shift(approach.raw, 12))));
    if (rests) b.gain = {};
    if (rests) break;
  }
  advance(b, left);
}

Velocity World::Impl::answer_bounce(const ContactRecord& record, std::size_t contact, bool rests) {
  BodyRecord& a = bodies[record.body_a];
  BodyRecord& b = bodies[record.body_b];
  const InverseInertia inertia_a = inverse_inertia(a, to_matrix(a.orientation));
  const InverseInertia inertia_b = inverse_inertia(b, to_matrix(b.orientation));
  const ContactSurface& surface = surfaces[slots[contact]];
  return answer_impact({a, inertia_a}, {b, inertia_b},
                       {manifolds[slots[contact]], surface.friction,
                        rests ? Coefficient{} : surface.restitution, Velocity{}});
}

}  // namespace lockstone
