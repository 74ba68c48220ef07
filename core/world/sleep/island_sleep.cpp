// Sleep: islands at rest leave the tick, and come back when something disturbs them.
//
// A body is awake or asleep by a flag of its record. A pair of bodies is looked at while one of the
// two is awake; contacts between bodies of which none is awake sleep, as they are, until one
// wakes. All but the flags and the pose of rest is derived.

#include "core/world/sleep/island_sleep.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"

namespace lockstone {
namespace {

constexpr Displacement k_deep = Displacement::from_ratio(1, 300);

bool has_deep_point(const Manifold& manifold) {
  const auto is_deep = [](const ManifoldPoint& point) { return point.separation < -k_deep; };
  return std::ranges::any_of(
      std::span(manifold.points).first(static_cast<std::size_t>(manifold.count)), is_deep);
}

}  // namespace

IslandSleep::IslandSleep(WorldData& world, SleepFlags& flags, Waking& waking, Islands& islands,
                         const TickContacts& found)
    : world_(world), flags_(flags), waking_(waking), islands_(islands), found_(found) {
  to_sleep_.reserve(world.def.body_capacity);
}

// Bodies that a kinematic body moves or is about to move stay awake. Bodies without joints that
// keep others awake are braked.
void IslandSleep::run(StepReport& report) {
  const StageTimer timer(world_.profiler, StepStage::sleep);
  waking_.wake_listed();  // bodies that were hit during the step
  to_sleep_.clear();
  if (flags_.rest_rules().ticks != 0 && watch_bodies()) {
    join_islands();
    hold_overlapping();
    report.islands = islands_.settle(world_.awake.list());
    for (const std::uint32_t body : world_.awake.list())
      if (world_.bodies[body].is_dynamic() && !islands_.is_active(body)) to_sleep_.push_back(body);
    brake_unrested();
  }
  for (const std::uint32_t body : to_sleep_)
    flags_.set_asleep(body);
  if (!to_sleep_.empty()) freeze_contacts();
  report.asleep_bodies = flags_.asleep_count();
}

void IslandSleep::brake_unrested() {
  const RestRules& rules = flags_.rest_rules();
  const Velocity brake = rules.brake(world_.def.tick_rate);
  for (const std::uint32_t body : world_.awake.list()) {
    BodyRecord& record = world_.bodies[body];
    const bool is_unrested =
        record.is_dynamic() && is_watched(record, rules) && record.rest_ticks < rules.ticks;
    if (!is_unrested || !islands_.rests_in_part(body)) continue;
    if (!world_.joint_graph.neighbours(body).empty()) continue;
    if (slow_down(record, world_.cache.rotation(body), brake)) world_.refresh_bounds(body);
  }
}

// Returns whether some dynamic body is ready to sleep.
bool IslandSleep::watch_bodies() {
  const RestRules& rules = flags_.rest_rules();
  bool ready = false;
  for (const std::uint32_t body : world_.awake.list()) {
    BodyRecord& record = world_.bodies[body];
    if (is_watched(record, rules)) {
      world_.hashes.bodies.mark(body);
      ready |= count_rest(record, rules);
    } else if (!record.is_dynamic() && record.may_sleep()) {
      if (!has_motion(record)) to_sleep_.push_back(body);
    }
  }
  return ready;
}

// Bodies that overlap deeply are still being pushed out, too slowly for the rest test to see: they
// must rest longer. At the end of a tick, when each contact has its manifold.
void IslandSleep::hold_overlapping() {
  const auto mark_active = [&](std::uint32_t body) {
    const bool counts = world_.awake.has(body) && world_.bodies[body].is_dynamic();
    if (counts && world_.bodies[body].rest_ticks < flags_.rest_rules().long_ticks())
      islands_.mark_active(body);
  };
  const std::span<const ContactRecord> active = world_.contacts.active();
  const std::span<const std::uint32_t> ids = world_.contacts.manifold_ids();
  LKS_ASSERT(ids.size() == active.size());
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (ids[i] == ContactLists::k_no_manifold || !has_deep_point(found_.manifolds[ids[i]]))
      continue;
    mark_active(active[i].body_a);
    mark_active(active[i].body_b);
  }
}

void IslandSleep::join_islands() {
  world_.list_awake_joints();
  const std::span<const std::uint32_t> all = world_.awake.list();
  islands_.begin(all);
  for (const std::uint32_t body : all) {
    if (world_.bodies[body].rest_ticks < flags_.rest_rules().ticks)
      islands_.mark_active(body);
    else if (world_.bodies[body].is_dynamic())
      islands_.note_rest(body);
  }
  const auto connect = [&](std::uint32_t a, std::uint32_t b) {
    if (!world_.awake.has(a) || !world_.awake.has(b)) return;
    const bool a_dynamic = world_.bodies[a].is_dynamic();
    if (a_dynamic && world_.bodies[b].is_dynamic())
      islands_.join(a, b);
    else
      islands_.mark_driven(a_dynamic ? a : b);
  };
  for (const ContactRecord& contact : world_.contacts.active())
    if (!contact.is_inert()) connect(contact.body_a, contact.body_b);
  for (const JointLink& joint : world_.joint_graph.awake_links())
    connect(joint.body_a, joint.body_b);
}

// Between ticks. Nothing was woken across joints: that is for the next step.
std::uint32_t IslandSleep::island_for_command(std::uint32_t body) {
  join_islands();
  world_.joint_graph.forget_awake_list();
  return islands_.root(body);
}

Status IslandSleep::put_to_sleep(std::uint32_t body) {
  const std::uint32_t island = island_for_command(body);
  to_sleep_.clear();
  for (const std::uint32_t other : world_.awake.list()) {
    const BodyRecord& record = world_.bodies[other];
    if (!record.is_dynamic() || islands_.root(other) != island) continue;
    if (!record.may_sleep()) return Status::invalid_argument;
    to_sleep_.push_back(other);
  }
  for (const std::uint32_t other : to_sleep_)
    flags_.set_asleep(other);
  freeze_contacts();
  return Status::ok;
}

bool IslandSleep::may_island_sleep(std::uint32_t body) {
  const std::uint32_t island = island_for_command(body);
  return std::ranges::all_of(world_.awake.list(), [&](std::uint32_t other) {
    const BodyRecord& record = world_.bodies[other];
    return !record.is_dynamic() || islands_.root(other) != island || record.may_sleep();
  });
}

}  // namespace lockstone
