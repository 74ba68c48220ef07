// Which bodies bounce within the tick, at the moments at which they meet (bounce_group.h): groups
// of bodies that touch nothing but each other and immovable bodies, with restitution in every
// contact. The contact solver handles all other bounces, at the tick's end.

#include <algorithm>

#include "core/dynamics/impact/impact_island.h"
#include "core/world/world_impl.h"

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

// Of `bounce_marks`, by the least body of a group: contacts, whether some are to be pushed out if
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

void World::Impl::find_bounces() {
  for (const std::uint32_t body : bouncing_bodies)
    has_bounced[body] = 0;
  bouncing_bodies.clear();
  bouncing_contacts.clear();
  bounce_groups.clear();
  const auto elastic = [&](std::uint32_t slot) {
    return surfaces[slot].restitution > Coefficient{};
  };
  if (!narrow.has_elastic() || std::ranges::none_of(slots, elastic)) return;
  join_bouncing();
  for (std::size_t i = 0; i < new_contacts.size(); ++i)
    look_for_bounce(i);
  for (std::size_t i = 0; i < new_contacts.size(); ++i)
    mark_bounce(i);
  std::ranges::sort(bouncing_contacts);
  for (std::size_t i = 0; i < bouncing_contacts.size(); ++i) {
    if (i == 0 || bouncing_contacts[i].root != bouncing_contacts[i - 1].root)
      bounce_groups.push_back(static_cast<std::uint32_t>(i));
  }
}

bool World::Impl::flies(std::uint32_t body) const {
  return bodies[body].is_dynamic() && bodies[body].is_awake();
}

// Groups of bodies that touch. Held are those with a contact without restitution, with a joint, or
// with a body that sleeps.
void World::Impl::join_bouncing() {
  islands.begin(awake.list());
  for (const std::uint32_t body : awake.list())
    bounce_marks[body] = 0;
  const auto hold = [&](std::uint32_t body) {
    if (flies(body)) islands.hold(body);
  };
  for (std::size_t i = 0; i < new_contacts.size(); ++i) {
    const ContactRecord& record = new_contacts[i];
    if (record.is_trigger()) continue;
    const bool a = bodies[record.body_a].is_dynamic(), b = bodies[record.body_b].is_dynamic();
    const bool both_fly = flies(record.body_a) && flies(record.body_b);
    if (both_fly) islands.join(record.body_a, record.body_b);
    if (is_elastic(manifolds[slots[i]], surfaces[slots[i]]) && (both_fly || a != b)) continue;
    hold(record.body_a);
    hold(record.body_b);
  }
  for (const JointLink& link : joint_graph.awake_links()) {
    hold(link.body_a);
    hold(link.body_b);
  }
  (void)islands.settle(awake.list());
  for (const ContactRecord& record : new_contacts) {
    if (record.is_trigger() || !one_flies(record)) continue;
    std::uint8_t& marks = bounce_marks[bounce_root(record)];
    if (marks < k_contact_count) ++marks;
  }
}

bool World::Impl::one_flies(const ContactRecord& record) const {
  return flies(record.body_a) || flies(record.body_b);
}

// The least body of the group.
std::uint32_t World::Impl::bounce_root(const ContactRecord& record) {
  return islands.root(flies(record.body_a) ? record.body_a : record.body_b);
}

BouncePair World::Impl::bounce_pair(std::size_t contact) {
  const ContactRecord& record = new_contacts[contact];
  const std::uint32_t slot = slots[contact];
  return {&bodies[record.body_a], &bodies[record.body_b], &manifolds[slot], &surfaces[slot]};
}

bool World::Impl::may_bounce(const ContactRecord& record) {
  if (record.is_trigger() || !one_flies(record)) return false;
  const std::uint32_t root = bounce_root(record);
  return !islands.is_held(root) && (bounce_marks[root] & k_contact_count) <= k_most_bounce_contacts;
}

// A contact that will bounce marks its whole group; a contact that comes to rest leaves the group
// to the solver. Where no bodies meet, nothing need be solved.
void World::Impl::look_for_bounce(std::size_t contact) {
  const ContactRecord& record = new_contacts[contact];
  const Manifold& manifold = manifolds[slots[contact]];
  if (!may_bounce(record) || manifold.count == 0) return;
  const std::uint32_t root = bounce_root(record);
  const Meeting meeting =
      next_meeting(bounce_pair(contact), header.gravity, time_step, k_two_ticks);
  const bool rests = meeting.meets && meeting.speed <= k_least_bounce;
  if (rests || is_nearer(manifold, k_overlap) || turns_much(record.body_a) ||
      turns_much(record.body_b))
    return islands.hold(root);
  if (meeting.meets)
    bounce_marks[root] |= k_will_bounce;
  else if (is_nearer(manifold, k_resting_overlap))
    bounce_marks[root] |= k_leans;
}

// Contact points of a body other than a ball stay where they were at the tick's beginning, so it
// may turn by at most 2^-4 rad.
bool World::Impl::turns_much(std::uint32_t body) const {
  const BodyRecord& record = bodies[body];
  if (!record.is_dynamic() || record.shape().kind == ShapeKind::sphere) return false;
  const Vec3<Velocity> w =
      surface_velocity(inverse_inertia(record, cache.rotation(body)), record.spin);
  const std::int64_t turned =
      raw::scale_binary(time_step.tick.times(sum_of_magnitudes(w)), -record.scale_exponent);
  return turned > std::int64_t{1} << 28;
}

// The solver leaves it out, and its impulses are dropped.
void World::Impl::mark_bounce(std::size_t contact) {
  ContactRecord& record = new_contacts[contact];
  if (!may_bounce(record)) return;
  const std::uint8_t marks = bounce_marks[bounce_root(record)];
  if ((marks & k_will_bounce) == 0 && (marks & k_leans) != 0) return;
  ContactRecord fresh;
  fresh.body_a = record.body_a;
  fresh.body_b = record.body_b;
  fresh.part_a = record.part_a;
  fresh.part_b = record.part_b;
  record = fresh;
  surfaces[slots[contact]].bounces = true;
  bouncing_contacts.push_back({bounce_root(record), static_cast<std::uint32_t>(contact)});
  for (const std::uint32_t body : {record.body_a, record.body_b}) {
    if (!bodies[body].is_dynamic() || has_bounced[body] != 0) continue;
    has_bounced[body] = 1;
    bouncing_bodies.push_back(body);
    starts[body] = {bodies[body].position, bodies[body].orientation};
  }
}

// Before all other bodies move, so that the obstacles of these bounces are where the tick began.
void World::Impl::run_bounces() {
  const Loop each{static_cast<std::uint32_t>(bounce_groups.size()), k_group_grain};
  parallel.for_each(each, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t group = first; group < end; ++group)
      run_bounce_group(group);
  });
}

void World::Impl::run_bounce_group(std::uint32_t index) {
  const std::size_t first = bounce_groups[index];
  const std::size_t end =
      index + 1 < bounce_groups.size() ? bounce_groups[index + 1] : bouncing_contacts.size();
  const std::span<const BouncingContact> contacts =
      std::span(bouncing_contacts).subspan(first, end - first);
  BounceGroup group(header.gravity, time_step);
  for (const BouncingContact& each : contacts)
    group.add(bounce_pair(each.contact));
  group.run();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::uint32_t contact = contacts[i].contact;
    const bool touches = is_nearer(manifolds[slots[contact]], Displacement::from_raw(1));
    if (group.touched(i) || touches) new_contacts[contact].flags = k_contact_touching;
    if (!group.touched(i)) continue;
    approach_speeds[contact] = SolverVelocity::from_raw(
        raw::saturate<std::int32_t>(raw::round_shift(group.approach(i).raw, 12)));
  }
}

}  // namespace lockstone
