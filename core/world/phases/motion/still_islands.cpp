#include "core/world/phases/motion/still_islands.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/body/pose_distance.h"

namespace lockstone {
namespace {

// Twice an eighth of a second, and not so few ticks that chance decides: ticks in which nothing
// moves count twice, those in which bodies tremble once, those of settled bodies seven times.
constexpr int k_moves_nothing = 2, k_trembles = 1, k_is_settled = 7;
std::uint8_t ticks_of(std::int32_t tick_rate) {
  return static_cast<std::uint8_t>(2 * std::max(tick_rate / 8, 4));
}

// 61 and 3.8 µm/s.
constexpr int k_tremble_exponent = -14, k_settled_exponent = -18;

// Bodies that float, hang or are driven may move as slowly as they tremble, and so may one alone.
bool may_tremble(const IslandTally& island) {
  return island.bodies > 1 && island.is_supported && !(island.joints != 0 && island.is_carried);
}

bool has_same_points(const ContactRecord& record, const Manifold& manifold) {
  if (record.count != manifold.count) return false;
  for (std::size_t i = 0; i < record.count; ++i)
    if (record.points[i].feature != manifold.points[i].feature) return false;
  return true;
}

}  // namespace

StillIslands::StillIslands(WorldData& world, TickContacts& found, const Bounces& bounces,
                           Pendulums& pendulums, Islands& islands)
    : world_(world),
      found_(found),
      bounces_(bounces),
      pendulums_(pendulums),
      islands_(islands),
      ticks_(ticks_of(world.time_step.tick_rate)),
      is_still_(world.def.body_capacity),
      is_tied_(world.def.body_capacity) {
  bodies_.reserve(world.def.body_capacity);
  stopped_.reserve(world.def.body_capacity);
}

void StillIslands::find() {
  for (const std::uint32_t body : bodies_)
    is_still_[body] = 0;
  bodies_.clear();
  stopped_.clear();
  contacts_ = points_ = 0;
  if (!may_find()) return;
  islands_.begin(world_.awake.list());
  look_at_bodies();
  look_at_contacts();
  look_at_joints();
  (void)islands_.settle(world_.awake.list());
  for (const std::uint32_t body : world_.awake.list())
    if (is_tied_[body] != 0 && !islands_.is_active(body)) keep(body);
  if (bodies_.empty()) return;
  leave_out_contacts();
  pendulums_.keep_joints(
      [this](const JointLink& link) { return !has(link.body_a) && !has(link.body_b); });
}

// From one tick before the last, so that differences of that tick count.
bool StillIslands::is_nearly_still(const BodyRecord& body) const {
  return body.still_ticks + k_is_settled >= ticks_;
}

// Whether any island may be still.
bool StillIslands::may_find() const {
  return std::ranges::any_of(world_.awake.list(), [&](std::uint32_t body) {
    return is_nearly_still(world_.bodies[body]);
  });
}

// A body that was still has no velocity unless something gave it one. Others may have some that
// contacts take back in each substep.
void StillIslands::look_at_bodies() {
  for (const std::uint32_t body : world_.awake.list()) {
    const BodyRecord& record = world_.bodies[body];
    is_tied_[body] = 0;
    if (!record.is_dynamic()) continue;
    const bool was_still = record.still_ticks > ticks_;
    if (record.still_ticks < ticks_ || !is_slower_than(record, k_tremble_exponent))
      islands_.mark_active(body);
    if (bounces_.has_moved(body) || pendulums_.has(body) || (was_still && has_motion(record)))
      stir(body);
  }
}

void StillIslands::look_at_contacts() {
  for (std::size_t i = 0; i < found_.records.size(); ++i) {
    const ContactRecord& record = found_.records[i];
    if (!record.is_inert()) connect(record.body_a, record.body_b, differs(i));
  }
}

void StillIslands::look_at_joints() {
  for (const JointLink& link : pendulums_.joints_to_solve())
    connect(link.body_a, link.body_b, false);
}

// A contact or a joint ties two bodies. It stirs their island where it `differs`, or where one of
// the two moves by itself or sleeps.
void StillIslands::connect(std::uint32_t a, std::uint32_t b, bool differs) {
  const auto is_solved = [&](std::uint32_t body) {
    return world_.bodies[body].is_dynamic() && world_.bodies[body].is_awake();
  };
  const auto stands = [&](std::uint32_t body) {
    return !world_.bodies[body].is_dynamic() && !has_motion(world_.bodies[body]);
  };
  const bool is_solved_a = is_solved(a), is_solved_b = is_solved(b);
  const bool stirs = differs || !(is_solved_a || stands(a)) || !(is_solved_b || stands(b));
  const auto tie = [&](std::uint32_t body) {
    is_tied_[body] = 1;
    if (stirs) stir(body);
  };
  if (is_solved_a) tie(a);
  if (is_solved_b) tie(b);
  if (is_solved_a && is_solved_b) islands_.join(a, b);
}

bool StillIslands::differs(std::size_t contact) const {
  const ContactSurface& surface = found_.surface_of(contact);
  return surface.is_left_out || surface.twist_drive != Rate{} ||
         surface.drive != Vec3<SolverVelocity>{} ||
         !has_same_points(found_.records[contact], found_.manifold_of(contact));
}

// The body begins to count again, if it is about to be still. Fewer ticks are counted on, since
// nothing is looked at while no body of the world is about to be still (may_find).
void StillIslands::stir(std::uint32_t body) {
  islands_.mark_active(body);
  if (is_nearly_still(world_.bodies[body])) world_.bodies[body].still_ticks = 0;
}

void StillIslands::keep(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  LKS_ASSERT(record.is_dynamic() && record.still_ticks >= ticks_);
  is_still_[body] = 1;
  bodies_.push_back(body);
  if (record.still_ticks > ticks_) return;
  stopped_.push_back(body);
  record.velocity = record.spin = {};
  record.still_ticks = static_cast<std::uint8_t>(ticks_ + 1);
  world_.hashes.bodies.mark(body);
}

void StillIslands::leave_out_contacts() {
  for (std::size_t i = 0; i < found_.records.size(); ++i) {
    const ContactRecord& record = found_.records[i];
    if (record.is_inert() || (!has(record.body_a) && !has(record.body_b))) continue;
    found_.surface_of(i).is_left_out = true;
    ++contacts_;
    points_ += record.count;
  }
}

std::uint8_t StillIslands::count_of(const IslandTally* island, const BodyRecord& body) const {
  if (island == nullptr) return 0;
  const bool stands = island->moved.get() == 0;
  const bool trembles = may_tremble(*island) && island->travelled.get() == 0;
  if (!stands && !trembles) return 0;
  const bool is_settled = trembles && island->unsettled.get() == 0;
  const int counts = is_settled ? k_is_settled : stands ? k_moves_nothing : k_trembles;
  return static_cast<std::uint8_t>(std::min<int>(body.still_ticks + counts, ticks_));
}

BodyMotion StillIslands::motion_since(const Transform& start, const BodyRecord& body) const {
  const bool has_moved = body.position != start.position || body.orientation != start.orientation;
  return {.has_moved = has_moved,
          .has_travelled = has_moved && !trembles(start, body),
          .is_settled = is_slower_than(body, k_settled_exponent)};
}

// Whether it moved no farther than iterations err.
bool StillIslands::trembles(const Transform& start, const BodyRecord& body) const {
  if (!is_slower_than(body, k_tremble_exponent)) return false;
  const auto in_a_tick = [this](int bits) {
    return std::max(
        (std::int64_t{1} << std::max(bits + k_tremble_exponent, 0)) / world_.time_step.tick_rate,
        std::int64_t{1});
  };
  const std::int64_t way = in_a_tick(Position::frac_bits);
  const auto way_of = [&](int i) { return body.position[i].raw - start.position[i].raw; };
  // Turning by a small angle moves the surface by it times the scale.
  return is_within(3, way, way_of) &&
         is_turned_within(in_a_tick(Unit::frac_bits - 1 - body.scale_exponent), body.orientation,
                          start.orientation);
}

}  // namespace lockstone
