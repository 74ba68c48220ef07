// Which bodies bounce within the tick, at the moments at which they meet (impact_island.h): groups
// of bodies that touch nothing but each other and immovable bodies, with restitution in every
// contact. The contact solver handles all other bounces, at the tick's end.

#include "core/world/phases/motion/bounces.h"

#include <algorithm>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/state/limits.h"
#include "core/geometry/numeric/q50.h"
#include "core/world/derived/quantities.h"

namespace lockstone {
namespace {

// The solver slows a body that would hit a surface in the substep after the tick: here such a body
// flies on as well.
constexpr Unit k_two_ticks = Unit::max();

// The solver pushes out bodies that overlap by more.
constexpr Displacement k_overlap = Displacement::from_ratio(-1, 2000);

constexpr std::uint32_t k_group_grain = 8;

// A smaller overlap of bodies that do not approach is left as it is: the solver lets contacts rest
// so.
constexpr Displacement k_resting_overlap = Displacement::from_ratio(-1, 100000);

// Of `marks_`, by the least body of a group: contacts, whether some are to be pushed out if
// nothing bounces, and whether any will bounce.
constexpr std::uint8_t k_contact_count = 0x3f;
constexpr std::uint8_t k_leans = 0x40;
constexpr std::uint8_t k_will_bounce = 0x80;
static_assert(k_most_bounce_contacts < k_contact_count);

bool is_elastic(const Manifold& manifold, const ContactSurface& surface) {
  return surface.restitution > Coefficient{} || manifold.count == 0;
}

bool is_nearer(const Manifold& manifold, Displacement separation) {
  for (int i = 0; i < manifold.count; ++i)
    if (manifold.points[static_cast<std::size_t>(i)].separation < separation) return true;
  return false;
}

}  // namespace

Bounces::Bounces(WorldData& world, TickContacts& found, MovedBodies& moved, Islands& islands)
    : world_(world),
      found_(found),
      moved_(moved),
      islands_(islands),
      has_bounced_(world.def.body_capacity),
      marks_(world.def.body_capacity) {
  contacts_.reserve(world.def.contact_capacity);
  totals_.reserve(most_hits(world.def.body_capacity));
  groups_.reserve(world.def.contact_capacity);
  bodies_.reserve(world.def.body_capacity);
}

void Bounces::find() {
  for (const std::uint32_t body : bodies_)
    has_bounced_[body] = 0;
  bodies_.clear();
  contacts_.clear();
  groups_.clear();
  totals_.clear();
  const auto elastic = [&](std::uint32_t id) {
    return found_.surfaces[id].restitution > Coefficient{};
  };
  if (!found_.has_elastic || std::ranges::none_of(found_.manifold_ids, elastic)) return;
  join_groups();
  for (std::size_t i = 0; i < found_.records.size(); ++i)
    look_for(i);
  for (std::size_t i = 0; i < found_.records.size(); ++i)
    mark(i);
  std::ranges::sort(contacts_);
  if (world_.cache.hit_bodies().count() != 0)
    totals_.resize(std::min(contacts_.size(), most_hits(world_.def.body_capacity)));
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (i == 0 || contacts_[i].root != contacts_[i - 1].root)
      groups_.push_back(static_cast<std::uint32_t>(i));
  }
}

bool Bounces::is_ballistic(std::uint32_t body) const {
  return world_.bodies[body].is_dynamic() && world_.bodies[body].is_awake();
}

// Groups of bodies that touch. Active are those with a contact without restitution, with a joint,
// or with a body that sleeps.
void Bounces::join_groups() {
  islands_.begin(world_.awake.list());
  for (const std::uint32_t body : world_.awake.list())
    marks_[body] = 0;
  const auto mark_active = [&](std::uint32_t body) {
    if (is_ballistic(body)) islands_.mark_active(body);
  };
  for (std::size_t i = 0; i < found_.records.size(); ++i) {
    const ContactRecord& record = found_.records[i];
    if (record.is_inert()) continue;
    const bool a = world_.bodies[record.body_a].is_dynamic(),
               b = world_.bodies[record.body_b].is_dynamic();
    const bool both_ballistic = is_ballistic(record.body_a) && is_ballistic(record.body_b);
    if (both_ballistic) islands_.join(record.body_a, record.body_b);
    if (is_elastic(found_.manifold_of(i), found_.surface_of(i)) && (both_ballistic || a != b))
      continue;
    mark_active(record.body_a);
    mark_active(record.body_b);
  }
  for (const JointLink& link : world_.joint_graph.awake_links()) {
    mark_active(link.body_a);
    mark_active(link.body_b);
  }
  (void)islands_.settle(world_.awake.list());
  for (const ContactRecord& record : found_.records) {
    if (record.is_inert() || !one_is_ballistic(record)) continue;
    std::uint8_t& marks = marks_[root_of(record)];
    if (marks < k_contact_count) ++marks;
  }
}

bool Bounces::one_is_ballistic(const ContactRecord& record) const {
  return is_ballistic(record.body_a) || is_ballistic(record.body_b);
}

// The least body of the group.
std::uint32_t Bounces::root_of(const ContactRecord& record) {
  return islands_.root(is_ballistic(record.body_a) ? record.body_a : record.body_b);
}

ImpactPair Bounces::pair_of(std::size_t contact) {
  const ContactRecord& record = found_.records[contact];
  return {&world_.bodies[record.body_a], &world_.bodies[record.body_b],
          &found_.manifold_of(contact), &found_.surface_of(contact),
          world_.cache.hit_bodies().count() != 0};
}

bool Bounces::may_bounce(const ContactRecord& record) {
  if (record.is_inert() || !one_is_ballistic(record)) return false;
  const std::uint32_t root = root_of(record);
  return !islands_.is_active(root) && (marks_[root] & k_contact_count) <= k_most_bounce_contacts;
}

// A contact that will bounce marks its whole group; a contact that comes to rest leaves the group
// to the solver. Where no bodies meet, nothing need be solved.
void Bounces::look_for(std::size_t contact) {
  const ContactRecord& record = found_.records[contact];
  const Manifold& manifold = found_.manifold_of(contact);
  if (!may_bounce(record) || manifold.count == 0) return;
  const std::uint32_t root = root_of(record);
  const PairImpact impact =
      next_impact(pair_of(contact), world_.header.gravity, world_.time_step, k_two_ticks);
  const bool rests = impact.meets && impact.speed <= k_least_bounce;
  if (rests || is_nearer(manifold, k_overlap) || turns_much(record.body_a) ||
      turns_much(record.body_b))
    return islands_.mark_active(root);
  if (impact.meets)
    marks_[root] |= k_will_bounce;
  else if (is_nearer(manifold, k_resting_overlap))
    marks_[root] |= k_leans;
}

// Contact points of a body other than a ball stay where they were at the tick's beginning, so it
// may turn by at most 2^-4 rad.
bool Bounces::turns_much(std::uint32_t body) const {
  const BodyRecord& record = world_.bodies[body];
  if (!record.is_dynamic() || record.shape().kind == ShapeKind::sphere) return false;
  const Vec3<Velocity> w =
      surface_velocity(inverse_inertia(record, world_.cache.rotation(body)), record.spin);
  const std::int64_t turned = raw::scale_binary(
      world_.time_step.tick.times(geometry::sum_of_magnitudes(w)), -record.scale_exponent);
  return turned > std::int64_t{1} << 28;
}

// The solver leaves it out, and its impulses are dropped.
void Bounces::mark(std::size_t contact) {
  ContactRecord& record = found_.records[contact];
  if (!may_bounce(record)) return;
  const std::uint8_t marks = marks_[root_of(record)];
  if ((marks & k_will_bounce) == 0 && (marks & k_leans) != 0) return;
  record = ContactRecord::of(record.key());
  found_.surface_of(contact).is_left_out = true;
  contacts_.push_back({root_of(record), static_cast<std::uint32_t>(contact)});
  for (const std::uint32_t body : {record.body_a, record.body_b}) {
    if (!world_.bodies[body].is_dynamic() || has_bounced_[body] != 0) continue;
    has_bounced_[body] = 1;
    bodies_.push_back(body);
    moved_.note_start(body);
  }
}

// Before all other bodies move, so that the obstacles of these bounces are where the tick began.
void Bounces::run() {
  const Loop each{static_cast<std::uint32_t>(groups_.size()), k_group_grain};
  world_.parallel.for_each(each, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t group = first; group < end; ++group)
      run_group(group);
  });
}

void Bounces::run_group(std::uint32_t index) {
  const std::size_t first = groups_[index];
  const std::size_t end = index + 1 < groups_.size() ? groups_[index + 1] : contacts_.size();
  const std::span<const BouncingContact> group_contacts =
      std::span(contacts_).subspan(first, end - first);
  ImpactIsland group(world_.header.gravity, world_.time_step);
  for (const BouncingContact& each : group_contacts)
    group.add(pair_of(each.contact));
  group.run();
  for (std::size_t i = 0; i < group_contacts.size(); ++i) {
    const std::uint32_t contact = group_contacts[i].contact;
    const bool touches = is_nearer(found_.manifold_of(contact), Displacement::from_raw(1));
    if (group.touched(i) || touches) found_.records[contact].flags = k_contact_touching;
    if (!group.touched(i)) continue;
    if (first + i < totals_.size()) totals_[first + i] = group.total(i);
    found_.approach_speeds[contact] = SolverVelocity::from_raw(
        raw::saturate<std::int32_t>(raw::round_shift(group.approach(i).raw, 12)));
  }
}

}  // namespace lockstone
