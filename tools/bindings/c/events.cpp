// Events of the last step.
#include <algorithm>
#include <span>
#include <vector>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_CONTACT_PERSIST == static_cast<int>(EventKind::contact_persist));

lks_event event_of(const ContactEvent& event) {
  return {static_cast<std::uint32_t>(event.kind),
          0,
          id_of(event.a),
          id_of(event.b),
          event.approach_speed.raw,
          event.tag_a,
          event.tag_b};
}

lks_joint_event joint_event_of(const JointEvent& event) {
  return {id_of(event.joint), id_of(event.a), id_of(event.b), event.user_data};
}

lks_hit_event hit_event_of(const HitEvent& event) {
  return {id_of(event.a),
          id_of(event.b),
          raw_of(event.point),
          event.normal_impulse.raw,
          raw_of(event.friction_impulse),
          event.approach_speed.raw,
          raw_of(event.normal),
          event.was_stopped ? 1U : 0U,
          event.part_a,
          event.part_b,
          event.tag_a,
          event.tag_b};
}

lks_body_contact contact_of(const BodyContact& contact) {
  lks_body_contact raw{};
  raw.other = id_of(contact.other);
  for (std::size_t i = 0; i < contact.count; ++i) {
    const TouchingPoint& point = contact.points[i];
    raw.points[i] = {raw_of(point.point), point.normal_force.raw, point.separation.raw, 0};
  }
  raw.normal_force = contact.normal_force.raw;
  raw.friction = raw_of(contact.friction);
  raw.normal = raw_of(contact.normal);
  raw.count = contact.count;
  raw.part = contact.part;
  raw.other_part = contact.other_part;
  raw.tag = contact.tag;
  raw.other_tag = contact.other_tag;
  return raw;
}

// Calls ask(room) for at most `most` results, and gives them converted.
template <class Found, class Raw, class Ask, class Convert>
void give_found(Raw* out, std::size_t capacity, std::size_t most, std::size_t* count, Ask&& ask,
                Convert&& convert) {
  required(count, "count");
  array(out, capacity, "out");
  std::vector<Found> room(std::min(capacity, most));
  const std::size_t found = ask(std::span(room));
  std::transform(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(found), out, convert);
  *count = found;
}

template <class Event, class Raw, class Convert>
void give_events(std::span<const Event> events, Raw* out, std::size_t capacity, std::size_t* count,
                 Convert&& convert) {
  required(count, "count");
  array(out, capacity, "out");
  const auto shown = events.first(std::min(events.size(), capacity));
  std::ranges::transform(shown, out, convert);
  give_count(events.size(), capacity, *count, "events");
}

}  // namespace

lks_status lks_events(const lks_world* world, lks_event* out, size_t capacity, size_t* count) {
  return call([&] { give_events(read(world).events(), out, capacity, count, event_of); });
}

lks_status lks_joint_events(const lks_world* world, lks_joint_event* out, size_t capacity,
                            size_t* count) {
  return call(
      [&] { give_events(read(world).joint_events(), out, capacity, count, joint_event_of); });
}

lks_status lks_hit_events(const lks_world* world, lks_hit_event* out, size_t capacity,
                          size_t* count) {
  return call([&] { give_events(hit_events(read(world)), out, capacity, count, hit_event_of); });
}

lks_status lks_contacts_of(const lks_world* world, lks_body body, lks_body_contact* out,
                           size_t capacity, size_t* count) {
  return call([&] {
    const World& source = read(world);
    const BodyHandle handle = existing_body(source, body);
    give_found<BodyContact>(
        out, capacity, source.def().contact_capacity, count,
        [&](auto room) { return contacts_of(source, handle, room); }, contact_of);
  });
}

lks_status lks_joints_of(const lks_world* world, lks_body body, lks_joint* out, size_t capacity,
                         size_t* count) {
  return call([&] {
    const World& source = read(world);
    const BodyHandle handle = existing_body(source, body);
    give_found<JointHandle>(
        out, capacity, source.joint_count(), count,
        [&](auto room) { return joints_of(source, handle, room); }, id_of<JointHandle>);
  });
}

lks_status lks_touching(const lks_world* world, lks_body a, lks_body b, uint32_t* out) {
  return call([&] {
    const World& source = read(world);
    required(out, "out") = source.touching(existing_body(source, a), existing_body(source, b));
  });
}
