// Continuous collision: each body that moved far in a tick is swept along its path, stopped at its
// first impact, given the impact's impulses, and moved on for the rest of the tick.

#include "core/world/phases/motion/continuous.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "core/collision/continuous/first_impact.h"
#include "core/collision/continuous/relative_path.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/impact/impact_response.h"
#include "core/geometry/numeric/q50.h"
#include "core/math/roots.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/motion/early_stop.h"
#include "core/world/phases/motion/fronts.h"
#include "core/world/phases/motion/passes.h"
#include "core/world/phases/narrow/contact_surfaces.h"
#include "core/world/phases/narrow/one_way.h"

namespace lockstone {
namespace {

Transform pose_of(const BodyRecord& body) {
  return {body.position, body.orientation};
}

// To a pose on the path that brought it to the one it has. The angular momentum turns with the
// body: kept in world axes it would not fit a pose off the free rotation, and a thin body could
// gain any amount of energy.
void stop_at(BodyRecord& body, const Transform& pose) {
  const Mat3 end = to_matrix(body.orientation);
  body.position = pose.position;
  body.orientation = pose.orientation;
  if (!body.rotates() || body.has_spherical_inertia()) return;
  body.spin = rotate_wide(to_matrix(pose.orientation), rotate_inverse_wide(end, body.spin));
}

// The rest of a motion after a fraction of it.
Sweep rest_of(const Sweep& motion, Unit fraction) {
  const std::int32_t left = (k_whole_tick - fraction).raw;
  const auto part = [&](std::int64_t x) { return raw::multiply_shift(x, left, Unit::frac_bits); };
  Sweep rest = motion;
  rest.start = pose_at(motion, fraction);
  for (int i = 0; i < 3; ++i) {
    rest.translation[i].raw = part(motion.translation[i].raw);
    rest.rotation[i].raw = part(motion.rotation[i].raw);
  }
  return rest;
}

// At least the way of any point of a body about its centre, 32 bits: |Δq| = d is a turn of
// 4·asin(d/2), which is at most 65/32 of d up to ½ and below 4·d beyond.
std::int64_t turned_way(const Quat& from, const Quat& to, Length radius) {
  const auto change = [](Unit a, Unit b) { return std::int64_t{a.raw} - b.raw; };
  const auto square = [](std::int64_t x) { return static_cast<std::uint64_t>(x * x); };
  const std::uint64_t sum = square(change(from.x, to.x)) + square(change(from.y, to.y)) +
                            square(change(from.z, to.z)) + square(change(from.w, to.w));
  const std::int64_t chord = isqrt(sum) + std::int64_t{1};
  constexpr std::int64_t k_half = std::int64_t{1} << (Unit::frac_bits - 1);
  const std::int64_t angle = chord <= k_half ? 2 * chord + chord / 32 : 4 * chord;
  return raw::multiply_shift(angle, radius.raw, Unit::frac_bits - 12);
}

// One point, at the centre of A.
Manifold through_centre(const Vec3<Unit>& normal, const Vec3<Length>& from_b) {
  Manifold manifold;
  manifold.normal = normal;
  manifold.count = 1;
  manifold.points[0].anchor_b = from_b;
  return manifold;
}

// The deepest point of a manifold, on B.
Vec3<Position> deepest_point(const Manifold& manifold, const Vec3<Position>& position_b) {
  const auto points = std::span(manifold.points).first(static_cast<std::size_t>(manifold.count));
  return place_at(position_b,
                  std::ranges::min_element(points, {}, &ManifoldPoint::separation)->anchor_b);
}

// The impulses at an impact, and the contact that came in fastest.
struct Stop {
  ImpactTotal total;
  const PartContact* fastest = nullptr;
};

// The hit of an impact, if it is one.
std::optional<HitEvent> hit_of_stop(const WorldData& world, const ContactEvent& impact,
                                    const Stop& stop) {
  const Pair pair{impact.a.index, impact.b.index};
  const SolverVelocity hit_speed = hit_speed_of(world.bodies[pair.a], world.bodies[pair.b]);
  if (stop.fastest == nullptr) return {};
  if (stop.total.approach <= rounded<Velocity>(hit_speed)) return {};
  HitEvent event = hit_of(world, pair, stop.total);
  if (event.normal_impulse <= Impulse{}) return {};
  event.part_a = stop.fastest->part_a;
  event.part_b = part_at(world, pair.b, event.point, stop.fastest->part_b);
  event.tag_a = impact.tag_a;
  event.tag_b = impact.tag_b;
  event.was_stopped = true;
  return event;
}

// A half-space has nothing behind it to come out at, and contacts find the bodies that
// triangles sweep over.
bool may_sweep(const BodyRecord& body, const geometry::AssetGeometry* asset) {
  return body.shape().kind != ShapeKind::half_space &&
         (asset == nullptr || asset->mesh_kernels() == nullptr);
}

// Compounds may have parts much thinner than their thickest.
Position sweeping_limit(Length inner_radius, const geometry::AssetGeometry* asset) {
  constexpr Length k_least = Length::from_ratio(1, 1000);
  const bool has_parts = asset != nullptr && asset->polytope() == nullptr;
  return rounded<Position>(has_parts ? k_least : max(inner_radius / 2, k_least));
}

// Whether |Δq| may hide most of a turn: w·dt > 3 s for the surface speed w.
bool may_turn_by_half(const BodyRecord& body, const Mat3& rotation, const TimeStep& step) {
  const std::int64_t limit =
      raw::scale_binary(std::int64_t{3 * step.tick_rate} << 32, body.scale_exponent);
  const std::int64_t spin = geometry::sum_of_magnitudes(body.spin);
  if (!body.is_dynamic()) return spin > limit;
  const Unit least = min(body.inertia.x, min(body.inertia.y, body.inertia.z));
  if (spin <= raw::multiply_shift(limit, least.raw, Unit::frac_bits)) return false;
  return geometry::sum_of_magnitudes(surface_velocity(inverse_inertia(body, rotation), body.spin)) >
         limit;
}

}  // namespace

ContinuousCollision::ContinuousCollision(WorldData& world, MovedBodies& moved, NarrowPhase& narrow,
                                         Waking& waking, TriggerPasses& passes)
    : world_(world),
      moved_(moved),
      narrow_(narrow),
      waking_(waking),
      passes_(passes),
      far_movers_(world.def.body_capacity) {
  const std::uint32_t capacity = world.def.body_capacity;
  joined_movers_.reserve(world.def.joint_capacity == 0 ? 0 : capacity);
  sweepers_.reserve(capacity);
  struck_.reserve(capacity);
  stops_.still.reserve(capacity);
  stops_.impacts.reserve(capacity);
  stops_.hits.reserve(capacity);
}

void ContinuousCollision::run(StepReport& report) {
  const StageTimer timer(world_.profiler, StepStage::continuous);
  stops_.impacts.clear();
  stops_.hits.clear();
  stops_.still.clear();
  passes_.begin();
  list_sweepers();
  for (const std::uint32_t body : moved_.bodies()) {
    if ((far_movers_[body] & (k_far_mover | k_swept_over)) == 0) continue;
    ++report.continuous_bodies;
    sweep_body(body, report);
  }
  if (world_.triggers.count() != 0)
    for (const Sweeper& each : sweepers_)
      passes_.note(each.body, motion_in_tick(each.body), {}, k_whole_tick);
  passes_.finish();
  if (narrow_.knows_triangles()) clamp_to_fronts(world_, moved_);
  if (passes_.overflowed()) report.status = Status::capacity_exhausted;
}

// Again when an impact changes how a body turns before its own way is looked at.
void ContinuousCollision::note_far_mover(std::uint32_t body) {
  const bool is_swept = world_.bodies[body].is_dynamic() && !world_.bodies[body].is_trigger();
  const bool went_far = goes_far(body, moved_.start(body), world_.bodies[body]);
  far_movers_[body] = !went_far ? 0 : is_swept ? k_far_mover : k_sweeper;
}

// Farther than half its thickness: a shorter motion cannot take it through anything.
bool ContinuousCollision::goes_far(std::uint32_t body, const Transform& start,
                                   const BodyRecord& record) const {
  const bool is_swept = record.is_dynamic() && !record.is_trigger();
  if (!is_swept && !may_sweep(record, world_.cache.asset(body))) return false;
  const std::int64_t limit =
      is_swept ? rounded<Position>(world_.cache.inner_radius(body) / 2).raw
               : sweeping_limit(world_.cache.inner_radius(body), world_.cache.asset(body)).raw;
  const Vec3<Position> gone = record.position - start.position;
  std::int64_t way = geometry::sum_of_magnitudes(gone);
  if (way > limit) way = static_cast<std::int64_t>(norm(gone.x.raw, gone.y.raw, gone.z.raw));
  if (way > limit) return true;
  if (start.orientation == record.orientation) return false;
  const auto goes_far = [&](Length radius) {
    return way + turned_way(start.orientation, record.orientation, radius) > limit ||
           may_turn_by_half(record, world_.cache.rotation(body), world_.time_step);
  };
  // Most go nowhere near as far, and need no root.
  const Length reach =
      Length::from_raw(raw::saturate<std::int32_t>(geometry::sum_of_magnitudes(record.size)));
  if (world_.cache.asset(body) == nullptr && !goes_far(reach)) return false;
  const Length radius = bounding_radius(record.shape(), world_.cache.asset(body));
  const bool shows_turning = radius > world_.cache.inner_radius(body) || !is_swept;
  return shows_turning && goes_far(radius);
}

// How it turned is of interest only where something is in its way. A sweeper that it meets twice
// takes it along from the first time on: a straight way ends behind a blade that turns.
void ContinuousCollision::sweep_body(std::uint32_t body, StepReport& report) {
  BodyRecord& record = world_.bodies[body];
  const Transform& start = moved_.start(body);
  const Bounds way = bounds_on_way(body, {start, record.position - start.position, {}});
  bool is_free = true;
  const auto meet = [&](std::uint32_t) { is_free = false; };
  visit_sweepers(body, way, meet);
  if (is_free) visit_obstacles(body, way, meet);
  if (is_free) return passes_.note(body, motion_in_tick(body), {}, k_whole_tick);
  if (!world_.joint_graph.neighbours(body).empty()) return sweep_joined(body, report);
  Sweep motion = motion_in_tick(body);
  Unit done{};                         // of the tick
  Transform last_pose = motion.start;  // at the last impact, with `met`
  Unit last_fraction{};
  std::uint32_t met = body;
  for (int i = 0; i < k_max_impacts; ++i) {
    const NextImpact next = find_impact(body, motion, done);
    passes_.note(body, motion, done, next.impact.hit ? next.impact.fraction : k_whole_tick);
    if (!next.impact.hit && i > 0 && carries(met)) push_out(body, met);
    if (!next.impact.hit) return;
    ++report.impacts;
    if (i > 0 && next.body == met && carries(met)) {
      stop_at(record, carried(last_pose, motion_of(met, last_fraction)));
      resolve(body, next, k_whole_tick);
      return push_out(body, met);
    }
    stop_at(record, pose_at(motion, next.impact.fraction));
    const Unit left = k_whole_tick - done;
    done = k_whole_tick - rounded<Unit>(left * (k_whole_tick - next.impact.fraction));
    resolve(body, next, done);
    last_pose = pose_of(record);
    last_fraction = done;
    met = next.body;
    const bool last = i + 1 == k_max_impacts;
    if (last) return;
    motion = go_on(record, k_whole_tick - done);
    if (!limit_position(record)) continue;
    ++report.saturations;
    motion.translation = record.position - motion.start.position;
  }
}

// Out of a sweeper, where both are at the tick's end: contacts alone are too slow for it.
void ContinuousCollision::push_out(std::uint32_t body, std::uint32_t sweeper) {
  BodyRecord& record = world_.bodies[body];
  const BodyRecord& other = world_.bodies[sweeper];
  PairScratch& scratch = narrow_.scratch();
  collide_bodies(place(record.shape(), world_.cache.asset(body), record.position,
                       to_matrix(record.orientation)),
                 place(other.shape(), world_.cache.asset(sweeper), other.position,
                       to_matrix(other.orientation)),
                 {}, scratch.triangles.get(), scratch.part_contacts);
  Displacement deepest{};
  Vec3<Unit> normal{};
  for (const PartContact& contact : scratch.part_contacts) {
    const Manifold& manifold = contact.manifold;
    for (int i = 0; i < manifold.count; ++i) {
      const Displacement separation = manifold.points[static_cast<std::size_t>(i)].separation;
      if (separation >= deepest) continue;
      deepest = separation;
      normal = manifold.normal;
    }
  }
  for (int i = 0; i < 3; ++i)
    record.position[i] += rounded<Position>(normal[i] * deepest);
  (void)limit_position(record);
}

// Bodies connected by joints stop together where the first of them runs into something, and lose
// the rest of the tick: a limb that stopped alone would leave its joint. The solver propagates the
// impact to the others.
void ContinuousCollision::sweep_joined(std::uint32_t body, StepReport& report) {
  if (!find_impact(body, motion_in_tick(body), {}).impact.hit)
    return passes_.note(body, motion_in_tick(body), {}, k_whole_tick);
  list_joined(body);
  NextImpact first;
  std::uint32_t body_of_first = body;
  for (const std::uint32_t each : joined_movers_) {
    if (far_movers_[each] == k_joined_mover) continue;
    const NextImpact next = find_impact(each, motion_in_tick(each), {});
    const bool sooner = next.impact.hit &&
                        (!first.impact.hit || next.impact.fraction < first.impact.fraction ||
                         (next.impact.fraction == first.impact.fraction && each < body_of_first));
    if (sooner) first = next, body_of_first = each;
  }
  ++report.impacts;
  EarlyStop stop(world_.header.gravity, world_.time_step);
  for (const std::uint32_t each : joined_movers_) {
    const Sweep motion = motion_in_tick(each);
    const Transform pose = pose_at(motion, first.impact.fraction);
    passes_.note(each, motion, {}, first.impact.fraction);
    stop.add(world_.bodies[each], motion.start, moved_.start_speeds(each), pose.position);
    stop_at(world_.bodies[each], pose);
    far_movers_[each] = 0;
  }
  for (const std::uint32_t each : joined_movers_)
    stop.slow(world_.bodies[each]);
  resolve(body_of_first, first, first.impact.fraction);
  if (carries(first.body))
    carry_joined(body_of_first, motion_of(first.body, first.impact.fraction));
}

// The body and the dynamic bodies that joints connect to it, all of which move.
void ContinuousCollision::list_joined(std::uint32_t body) {
  joined_movers_.assign(1, body);
  far_movers_[body] |= k_joined_mover;
  for (std::size_t i = 0; i < joined_movers_.size(); ++i) {
    for (const std::uint32_t other : world_.joint_graph.neighbours(joined_movers_[i])) {
      if (!world_.bodies[other].is_dynamic() || (far_movers_[other] & k_joined_mover) != 0)
        continue;
      far_movers_[other] |= k_joined_mover;
      joined_movers_.push_back(other);
    }
  }
}

// How sweepers turn is known once they are listed.
Sweep ContinuousCollision::motion_in_tick(std::uint32_t body) const {
  const BodyRecord& record = world_.bodies[body];
  const Transform& start = moved_.start(body);
  const Vec3<Position> way = record.position - start.position;
  if (is_sweeper(body)) {
    const auto known = std::ranges::lower_bound(sweepers_, body, {}, &Sweeper::body);
    if (known != sweepers_.end() && known->body == body) return {start, way, known->rotation};
  }
  return {start, way,
          turn_since(start.orientation, world_.cache.rotation(body), record, world_.time_step,
                     k_whole_tick)};
}

// Moves a body for the rest of a tick at the velocities at hand, which already hold the whole
// tick's gravity; returns the way.
Sweep ContinuousCollision::go_on(BodyRecord& record, Unit left) const {
  const Mat3 rotation = to_matrix(record.orientation);
  Sweep motion{pose_of(record), {}, {}};
  for (int i = 0; i < 3; ++i) {
    motion.translation[i].raw = raw::multiply_shift(
        world_.time_step.tick.times(record.velocity[i].raw), left.raw, Unit::frac_bits);
  }
  record.position += motion.translation;
  (void)turn_in_flight(record, rotation, world_.time_step, left);
  motion.rotation = turn_since(motion.start.orientation, rotation, record, world_.time_step, left);
  return motion;
}

// How a body moves from `done` to the end of the tick, itself followed or not.
Sweep ContinuousCollision::motion_of(std::uint32_t body, Unit done) const {
  const BodyRecord& record = world_.bodies[body];
  if (!record.is_awake()) return {pose_of(record), {}, {}};
  return rest_of(motion_in_tick(body), done);
}

// The sweepers at which a body may stop on its path.
template <class F>
void ContinuousCollision::visit_sweepers(std::uint32_t body, const Bounds& way, F&& f) const {
  moved_.note_look(body, body);
  for (const Sweeper& each : sweepers_) {
    if (!overlap(way, each.way) || !world_.is_obstacle(body, each.body)) continue;
    moved_.note_look(body, each.body);
    f(each.body);
  }
}

// All other obstacles there.
template <class F>
void ContinuousCollision::visit_obstacles(std::uint32_t body, const Bounds& way, F&& f) const {
  const bool is_bullet = world_.bodies[body].is_bullet();
  const auto test = [&](const Bounds& bounds) { return overlap(way, bounds); };
  const auto visit = [&](std::uint32_t other) {
    const bool considered = other != body && (is_bullet || !world_.bodies[other].is_dynamic());
    if (!considered || is_sweeper(other) || !world_.is_obstacle(body, other)) return;
    moved_.note_look(body, other);
    f(other);
  };
  if (is_bullet)
    world_.broad_phase.traverse(k_every_category, test, visit);
  else
    world_.broad_phase.traverse_immovable(test, visit);
}

NextImpact ContinuousCollision::find_impact(std::uint32_t body, const Sweep& motion,
                                            Unit done) const {
  const Shape shape = world_.bodies[body].shape();
  const Length inner = world_.cache.inner_radius(body);
  const Length radius = bounding_radius(shape, world_.cache.asset(body));
  NextImpact next;
  const auto meet = [&](std::uint32_t other) {
    const Shape other_shape = world_.bodies[other].shape();
    const Sweep other_motion = motion_of(other, done);
    const Length turned = radius > inner ? radius : Length{};
    const bool sweeps = is_sweeper(other);
    const Length free_way = sweeps ? inner / 8 : inner / 2;
    if (relative_way(motion, other_motion, turned) <= rounded<Position>(free_way)) return;
    const Impact impact = first_impact({shape, world_.cache.asset(body), motion},
                                       {other_shape, world_.cache.asset(other), other_motion},
                                       sweeps ? ImpactDepth::shallow : ImpactDepth::half);
    const bool sooner =
        impact.hit && (!next.impact.hit || impact.fraction < next.impact.fraction ||
                       (impact.fraction == next.impact.fraction && other < next.body));
    if (sooner &&
        !passes_on_way(world_, narrow_, {body, other}, motion, other_motion, impact.fraction))
      next = {other, impact};
  };
  const Bounds way = bounds_on_way(body, motion);
  visit_sweepers(body, way, meet);
  visit_obstacles(body, way, meet);
  return next;
}

// Impulses between the two where they are at `done`. Velocities hold the whole tick's gravity; the
// part that acts after the impact is taken off while it is resolved.
void ContinuousCollision::resolve(std::uint32_t body, const NextImpact& next, Unit done) {
  const std::uint32_t other = next.body;
  BodyRecord& a = world_.bodies[body];
  BodyRecord& b = world_.bodies[other];
  PairScratch& scratch = narrow_.scratch();
  const Sweep other_motion = motion_of(other, done);
  const Mat3 rotation_a = to_matrix(a.orientation),
             rotation_b = to_matrix(other_motion.start.orientation);
  collide_bodies(
      place(a.shape(), world_.cache.asset(body), a.position, rotation_a),
      place(b.shape(), world_.cache.asset(other), other_motion.start.position, rotation_b),
      k_impact_gap * 4, scratch.triangles.get(), scratch.part_contacts);
  const InverseInertia inertia_a = inverse_inertia(a, rotation_a);
  const InverseInertia inertia_b = inverse_inertia(b, rotation_b);
  const Vec3<Velocity> to_come =
      gravity_gain(a, world_.header.gravity, world_.time_step, k_whole_tick - done);
  a.velocity -= to_come;
  Velocity approach{};
  std::uint32_t tag_a = a.tag, tag_b = b.tag;
  const bool is_watched = hit_speed_of(a, b) != SolverVelocity{};
  Stop stop;
  for (const PartContact& contact : scratch.part_contacts) {
    ContactSurface surface;
    find_surface(world_, {body, other}, contact.surface_a, contact.surface_b, contact.manifold,
                 surface);
    tag_a = surface.tag_a;
    tag_b = surface.tag_b;
    const Vec3<Velocity> before = b.velocity - a.velocity;
    const Velocity speed = answer_impact({a, inertia_a}, {b, inertia_b},
                                         {contact.manifold, surface.friction, surface.restitution});
    if (is_watched && speed > approach) stop.fastest = &contact;
    approach = max(approach, speed);
    if (!is_watched) continue;
    stop.total.add(speed, (b.velocity - a.velocity) - before, contact.manifold.normal,
                   deepest_point(contact.manifold, other_motion.start.position));
  }
  if (next.impact.crossing != Vec3<Unit>{}) {
    const Vec3<Position> arm = a.position - other_motion.start.position;
    (void)answer_impact({a, inertia_a}, {b, inertia_b},
                        {through_centre(next.impact.crossing, saturated<Length>(arm)), {}, {}});
  }
  a.velocity += to_come;
  (void)limit_speed(a, inertia_a, world_.def.speed_limit);
  if (b.is_dynamic()) (void)limit_speed(b, inertia_b, world_.def.speed_limit);
  world_.hashes.bodies.mark(other);
  if (b.is_dynamic()) {
    const auto swept_over = static_cast<std::uint8_t>(far_movers_[other] & k_swept_over);
    note_far_mover(other);
    far_movers_[other] |= swept_over;
  }
  if (b.is_dynamic() && b.is_asleep()) waking_.note_hit(other);
  if (b.still_ticks != 0 && std::ranges::find(stops_.still, other) == stops_.still.end())
    stops_.still.push_back(other);
  if (stops_.impacts.size() == world_.def.body_capacity) return;
  stops_.impacts.push_back(
      {EventKind::impact, {body, a.generation}, {other, b.generation}, approach, tag_a, tag_b});
  if (const auto event = hit_of_stop(world_, stops_.impacts.back(), stop))
    stops_.hits.push_back(*event);
}

}  // namespace lockstone
