#include "core/world/data/world_data.h"

#include "core/dynamics/body/inertia.h"
#include "core/geometry/numeric/q50.h"
#include "core/math/int128.h"
#include "core/math/roots.h"
#include "core/world/derived/quantities.h"

namespace lockstone {
namespace {

// How far a body goes in one tick, along one axis.
Position travel(Velocity v, const TimeStep& step) {
  return Position::from_raw(step.tick.times(v.raw));
}

// The way of a turning body's surface in a tick that is within its half of the contact margin.
constexpr Length k_covered_turn = k_contact_margin * 3 / 8;

// The speed of that way, m/s, Q32.
std::int64_t covered_speed(const TimeStep& step) {
  constexpr std::int64_t k_way = std::int64_t{k_covered_turn.raw}
                                 << (Position::frac_bits - Length::frac_bits);
  return k_way * step.tick_rate;
}

// How the body turns, ω·2^scale_exponent; zero where the margin covers it.
Vec3<Velocity> uncovered_turn(const WorldData& world, std::uint32_t body) {
  const BodyRecord& record = world.bodies[body];
  if (record.spin == Vec3<Velocity>{}) return {};
  const std::int64_t covered = covered_speed(world.time_step);
  if (record.is_dynamic()) {  // ω is at most spin over the least moment
    const Unit least = min(record.inertia.x, min(record.inertia.y, record.inertia.z));
    const std::int64_t spin = geometry::sum_of_magnitudes(record.spin);
    if (spin <= raw::multiply_shift(covered, least.raw, Unit::frac_bits)) return {};
  }
  const Vec3<Velocity> surface =
      surface_velocity(inverse_inertia(record, world.cache.rotation(body)), record.spin);
  return geometry::sum_of_magnitudes(surface) > covered ? surface : Vec3<Velocity>{};
}

// How far turning takes any point of the body in one tick, along each axis, at most, beyond the way
// that the margin covers.
Vec3<Position> turn_travel(const WorldData& world, std::uint32_t body, const WorldBox& box) {
  const Vec3<Velocity> surface = uncovered_turn(world, body);
  if (surface == Vec3<Velocity>{}) return {};
  const BodyRecord& record = world.bodies[body];
  Vec3<Position> reach;  // of the farthest points from the centre of mass
  for (int i = 0; i < 3; ++i)
    reach[i] = max(box.upper[i] - record.position[i], record.position[i] - box.lower[i]);
  const auto by = [&](Velocity w, Position arm) {
    return saturated_product(travel(abs(w), world.time_step).raw, arm.raw,
                             Position::frac_bits + record.scale_exponent);
  };
  Vec3<Position> result;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const std::int64_t way =
        raw::saturating_add(by(surface[j], reach[k]), by(surface[k], reach[j]));
    const Position beyond = Position::from_raw(way) - rounded<Position>(k_covered_turn);
    result[i] = min(max(beyond, Position{}), reach[j] + reach[k]);
  }
  return result;
}

}  // namespace

WorldData::WorldData(const WorldDef& definition, std::shared_ptr<const AssetSet> known_assets)
    : def(definition),
      assets(std::move(known_assets)),
      time_step(TimeStep::of(definition.tick_rate, definition.substeps)),
      bodies(definition.body_capacity),
      contacts(definition.body_capacity, definition.contact_capacity),
      joints(definition.joint_capacity),
      awake(definition.body_capacity),
      triggers(definition.body_capacity),
      joint_graph(definition.body_capacity, definition.joint_capacity),
      cache(definition.body_capacity),
      broad_phase(definition.broad_phase, definition.body_capacity, definition.pair_capacity),
      hashes{RecordHashes<BodyRecord, k_body_domain>(definition.body_capacity),
             RecordHashes<JointRecord, k_joint_domain>(definition.joint_capacity)} {
  header.gravity = definition.gravity;
  rests.reserve(definition.body_capacity);
  vehicles.resize(definition.vehicle_capacity);
  make_terrain_room(definition.terrain_tile_capacity, definition.body_capacity, *assets);
}

const BodyRecord* WorldData::find(BodyHandle body) const {
  if (body.is_null() || body.index >= header.body_limit) return nullptr;
  const BodyRecord& record = bodies[body.index];
  return record.exists() && record.generation == body.generation ? &record : nullptr;
}

BodyRecord* WorldData::edit(BodyHandle body) {
  if (find(body) == nullptr) return nullptr;
  hashes.bodies.mark(body.index);
  return &bodies[body.index];
}

const JointRecord* WorldData::find(JointHandle joint) const {
  if (joint.is_null() || joint.index >= header.joint_limit) return nullptr;
  const JointRecord& record = joints[joint.index];
  return record.exists() && record.generation == joint.generation ? &record : nullptr;
}

JointRecord* WorldData::edit(JointHandle joint) {
  if (find(joint) == nullptr) return nullptr;
  hashes.joints.mark(joint.index);
  return &joints[joint.index];
}

std::uint32_t WorldData::body_count() const {
  const auto end = bodies.begin() + header.body_limit;
  return static_cast<std::uint32_t>(
      std::count_if(bodies.begin(), end, [](const BodyRecord& body) { return body.exists(); }));
}

Bounds WorldData::bounds_of(std::uint32_t body) const {
  const BodyRecord& record = bodies[body];
  const WorldBox box = world_box(placed(body));
  const Vec3<Position> turned = turn_travel(*this, body, box);
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const Position margin = rounded<Position>(k_contact_margin / 2) + turned[i];
    const Position swept = travel(record.velocity[i], time_step);
    bounds.lower[i] = round_down(box.lower[i] - margin + min(swept, Position{}));
    bounds.upper[i] = round_up(box.upper[i] + margin + max(swept, Position{}));
  }
  return bounds;
}

void WorldData::refresh(std::uint32_t body) {
  LKS_ASSERT(bodies[body].exists());
  cache.refresh(body, bodies[body]);
  refresh_bounds(body);
}

void WorldData::refresh_bounds(std::uint32_t body) {
  const BodyRecord& record = bodies[body];
  cache.refresh_shape(body, record);
  if (triggers.has(body) != (record.is_trigger() && is_enabled(record))) triggers.flip(body);
  joint_graph.set_enabled(body, is_enabled(record));
  if (!is_enabled(record)) return broad_phase.remove(body);
  broad_phase.set(body, bounds_of(body),
                  {record.filter(), record.moves(), record.is_dynamic(), record.is_trigger(),
                   record.is_asleep(), is_surface(record, cache.asset(body))});
}

Pair WorldData::pair_of(std::uint32_t a, std::uint32_t b) const {
  const Pair pair{a, b};
  const bool a_leads = leads(bodies[a], cache.asset(a));
  const bool b_leads = leads(bodies[b], cache.asset(b));
  return is_in_order(pair, a_leads, b_leads) ? pair : Pair{b, a};
}

std::optional<Pair> WorldData::exempt_pair(const JointRecord& joint) const {
  if (joint.collides()) return {};
  return pair_of(joint.body_a, joint.body_b);
}

bool WorldData::are_joined(std::uint32_t a, std::uint32_t b) const {
  return joint_graph.is_exempt(pair_of(a, b));
}

bool WorldData::are_exempt(std::uint32_t a, std::uint32_t b) const {
  return are_joined(a, b) || are_ignored(*this, a, b);
}

bool WorldData::is_obstacle(std::uint32_t body, std::uint32_t other) const {
  const BodyRecord& obstacle = bodies[other];
  return !obstacle.is_trigger() && should_collide(bodies[body].filter(), obstacle.filter()) &&
         !are_exempt(body, other);
}

std::int64_t turning_speed(const WorldData& world, std::uint32_t body) {
  const Vec3<Velocity> turn = uncovered_turn(world, body);
  if (turn == Vec3<Velocity>{}) return 0;
  const BodyRecord& record = world.bodies[body];
  const Length radius = bounding_radius(record.shape(), world.cache.asset(body));
  const std::int64_t speed =
      raw::multiply_shift(norm_bound(turn.x.raw, turn.y.raw, turn.z.raw), radius.raw,
                          Length::frac_bits + record.scale_exponent);
  return std::max<std::int64_t>(speed + 1 - covered_speed(world.time_step), 0);
}

}  // namespace lockstone
