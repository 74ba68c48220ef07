// Events of the last step.
#include <algorithm>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_WAKE == static_cast<int>(EventKind::wake));

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

lks_status lks_touching(const lks_world* world, lks_body a, lks_body b, uint32_t* out) {
  return call([&] {
    const World& source = read(world);
    required(out, "out") = source.touching(existing_body(source, a), existing_body(source, b));
  });
}
