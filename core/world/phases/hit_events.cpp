#include "core/world/phases/hit_events.h"

#include <algorithm>
#include <tuple>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/collision/query/cast_placed.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/step/contacts/impulse_totals.h"
#include "core/math/divide.h"
#include "core/math/int128.h"
#include "core/world/derived/quantities.h"

namespace lockstone {
namespace {

// An impulse from the pair's velocity jump with `bits` fraction bits.
Impulse impulse_of(std::int64_t jump, int bits, BlockFloat inverse_mass) {
  const int shift = std::clamp(Impulse::frac_bits - bits - inverse_mass.exponent, -63, 63);
  return Impulse::from_raw(divide_raw_saturating(jump, inverse_mass.mantissa, shift));
}

BlockFloat inverse_mass_of(const BodyRecord& a, const BodyRecord& b) {
  return add(a.inverse_mass_value(), b.inverse_mass_value());
}

// Where a point of a manifold is: on B, or between both where both can move.
Vec3<Position> place_of(const ManifoldPoint& point, const BodyRecord& a, const BodyRecord& b) {
  return b.is_dynamic() ? place_between(point, a, b) : place_at(b.position, point.anchor_b);
}

// Mean of the points, weighted by their impulses; relative to the first, so that products fit.
Vec3<Position> mean_place(const ImpulseTotal& total, std::int64_t sum, const Manifold& manifold,
                          const BodyRecord& a, const BodyRecord& b) {
  LKS_ASSERT(sum > 0 && manifold.count > 0);
  const Vec3<Position> first = place_of(manifold.points[0], a, b);
  Vec3<Position> mean = first;
  for (int axis = 0; axis < 3; ++axis) {
    Int128 moment{};
    for (std::size_t i = 1; i < static_cast<std::size_t>(manifold.count); ++i) {
      const Position offset = place_of(manifold.points[i], a, b)[axis] - first[axis];
      moment = moment + multiply_wide(offset.raw, total.points[i]);
    }
    mean[axis] += Position::from_raw(round_divide(moment, sum));
  }
  return mean;
}

// By pair and part; then all that an event consists of, so that only equal ones tie.
auto order_of(const HitEvent& event) {
  const auto words = [](const auto& v) { return std::tuple(v.x.raw, v.y.raw, v.z.raw); };
  return std::tuple(event.a.index, event.b.index, event.part_a, event.part_b, words(event.point),
                    words(event.normal), event.normal_impulse.raw, words(event.friction_impulse),
                    event.approach_speed.raw, event.tag_a, event.tag_b);
}

}  // namespace

SolverVelocity hit_speed_of(const BodyRecord& a, const BodyRecord& b) {
  if (!has_hit_events(a)) return b.hit_speed;
  return has_hit_events(b) ? min(a.hit_speed, b.hit_speed) : a.hit_speed;
}

HitEvent hit_of(const WorldData& world, const Pair& pair, const ImpactTotal& total) {
  const BlockFloat inverse_mass = inverse_mass_of(world.bodies[pair.a], world.bodies[pair.b]);
  HitEvent event;
  event.a = world.handle_of(pair.a);
  event.b = world.handle_of(pair.b);
  event.point = total.point;
  event.normal = total.normal;
  event.approach_speed = total.approach;
  Velocity along{};
  for (int i = 0; i < 3; ++i)
    along += times(total.jump[i], total.normal[i]);
  event.normal_impulse = impulse_of(along.raw, Velocity::frac_bits, inverse_mass);
  for (int i = 0; i < 3; ++i) {
    const Velocity across = total.jump[i] - times(along, total.normal[i]);
    event.friction_impulse[i] = impulse_of(across.raw, Velocity::frac_bits, inverse_mass);
  }
  return event;
}

std::uint32_t part_at(const WorldData& world, std::uint32_t body, const Vec3<Position>& point,
                      std::uint32_t part) {
  constexpr Length k_reach = Length::from_integer(16);  // more than a body moves in most ticks
  const geometry::AssetGeometry* asset = world.cache.asset(body);
  if (asset == nullptr || asset->triangles() == nullptr) return part;
  if (asset->solids() != nullptr && part < geometry::k_first_triangle_part) return part;
  PlacedShape placed = world.placed(body);
  placed.asset = asset->triangles();
  return closest_point(placed, point, k_reach).part;
}

HitEvents::HitEvents(WorldData& world, TickContacts& found) : world_(world), found_(found) {
  watched_.reserve(world.def.contact_capacity);
  events_.reserve(most_listed(world.def));
}

void HitEvents::begin() {
  events_.clear();
  watched_.clear();
  left_out_ = false;
  const IndexSet& hit_bodies = world_.cache.hit_bodies();
  if (hit_bodies.count() == 0) return;
  LKS_ASSERT(is_reserved(watched_, found_.records.size()));
  for (std::uint32_t i = 0; i < found_.records.size(); ++i) {
    const ContactRecord& record = found_.records[i];
    if (!hit_bodies.has(record.body_a) && !hit_bodies.has(record.body_b)) continue;
    if (record.is_inert()) continue;
    watched_.push_back(
        {i, hit_speed_of(world_.bodies[record.body_a], world_.bodies[record.body_b])});
  }
}

void HitEvents::add_solved(const ImpulseTotals& totals) {
  totals.for_each([&](const ImpulseTotal& total) { add_solved(total); });
  left_out_ = left_out_ || totals.is_full();
}

void HitEvents::add_solved(const ImpulseTotal& total) {
  const ContactRecord& record = found_.records[total.record];
  const BodyRecord &a = world_.bodies[record.body_a], &b = world_.bodies[record.body_b];
  const Manifold& manifold = found_.manifold_of(total.record);
  std::int64_t sum = 0;
  for (const std::int64_t impulse : total.points)
    sum += impulse;
  if (sum <= 0) return;
  const BlockFloat inverse_mass = inverse_mass_of(a, b);
  HitEvent event;
  event.a = world_.handle_of(record.body_a);
  event.b = world_.handle_of(record.body_b);
  event.point = mean_place(total, sum, manifold, a, b);
  event.normal = manifold.normal;
  event.normal_impulse = impulse_of(sum, SolverVelocity::frac_bits, inverse_mass);
  for (int i = 0; i < 3; ++i) {
    event.friction_impulse[i] = impulse_of(total.friction[static_cast<std::size_t>(i)],
                                           SolverVelocity::frac_bits, inverse_mass);
  }
  event.approach_speed = rounded<Velocity>(found_.approach_speeds[total.record]);
  name_parts(record, found_.surface_of(total.record), event);
  if (!is_full()) events_.push_back(event);
}

void HitEvents::add_bounced(std::span<const BouncingContact> contacts,
                            std::span<const ImpactTotal> totals) {
  left_out_ = left_out_ || (!totals.empty() && totals.size() < contacts.size());
  for (std::size_t i = 0; i < totals.size(); ++i) {
    const ContactRecord& record = found_.records[contacts[i].contact];
    const Pair pair{record.body_a, record.body_b};
    const SolverVelocity hit_speed = hit_speed_of(world_.bodies[pair.a], world_.bodies[pair.b]);
    if (hit_speed == SolverVelocity{} || totals[i].approach <= rounded<Velocity>(hit_speed))
      continue;
    HitEvent event = hit_of(world_, pair, totals[i]);
    name_parts(record, found_.surface_of(contacts[i].contact), event);
    if (event.normal_impulse > Impulse{} && !is_full()) events_.push_back(event);
  }
}

void HitEvents::name_parts(const ContactRecord& record, const ContactSurface& surface,
                           HitEvent& event) const {
  event.part_a = record.part_a;
  event.part_b = part_at(world_, record.body_b, event.point, record.part_b);
  event.tag_a = surface.tag_a;
  event.tag_b = surface.tag_b;
}

bool HitEvents::is_full() {
  const bool full = events_.size() == most_hits(world_.def.body_capacity);
  left_out_ = left_out_ || full;
  return full;
}

void HitEvents::finish(std::span<const HitEvent> stops) {
  std::ranges::sort(events_, {}, order_of);
  events_.insert(events_.end(), stops.begin(), stops.end());
}

}  // namespace lockstone
