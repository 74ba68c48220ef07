// Which bodies and contacts a tick's solver gathers: their numbers, colours and lanes.

#include <algorithm>
#include <cstdlib>

#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;

// The least number of items in a piece of a loop: about a microsecond of work.
constexpr std::uint32_t k_side_grain = 256;

// The impulse from which on a contact is overloaded, m/s, Q20: between bodies of equal mass 2½
// times the impulse of gravity in a substep.
std::int64_t heap_push(const Vec3<Acceleration>& gravity, const TimeStep& step) {
  std::int64_t most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(std::int64_t{gravity[i].raw}));
  if (most == 0) return INT64_MAX;
  return raw::round_divide(5 * raw::round_shift(most, Acceleration::frac_bits - 20),
                           step.substep_rate());
}

}  // namespace

// A body enters the solver with its first constraint. A body that no impulse moves enters again
// with every constraint, since constraints that are solved side by side write to all their bodies.
std::uint32_t ContactSolver::take_up(Side side) {
  if (side.motion() == MotionType::static_body) return k_immovable | immovables_++;
  const std::uint32_t body = side.body(), known = solver_index_[body];
  const auto index = static_cast<std::uint32_t>(members_.size());
  if (known == 0) solver_index_[body] = index;
  members_.push_back(body);
  graph_.add_body();
  islands_.add_body(side.is_dynamic());
  return index;
}

// Collects the few fields of large records that `take_up` reads, side by side.
void ContactSolver::find_sides(const ContactScene& scene, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    const ContactRecord& record = scene.records[i];
    const bool left_out = record.is_trigger() || scene.surfaces[scene.slots[i]].bounces;
    sides_[i] = {};
    if (left_out) continue;
    const auto side_of = [&](std::uint32_t body) -> Side {
      return {body, static_cast<MotionType>(scene.bodies[body].motion)};
    };
    sides_[i] = {side_of(record.body_a), side_of(record.body_b)};
    if (record.count == 0 && sides_[i].a.is_dynamic() && sides_[i].b.is_dynamic())
      sides_[i].a.mark();
    if (std::int64_t{record.load.raw} * record.count > heap_push_) sides_[i].b.mark();
  }
}

// In the order of the records: bodies, colours and lanes follow from the state alone.
void ContactSolver::take_up_contacts(const ContactScene& scene, Parallel& parallel) {
  sides_.resize(scene.records.size());
  heap_push_ = heap_push(scene.gravity, step_);
  parallel.for_each(
      {static_cast<std::uint32_t>(sides_.size()), k_side_grain},
      [&](std::size_t first, std::size_t end, std::uint32_t) { find_sides(scene, first, end); });
  graph_.clear();
  islands_.clear();
  for (const std::uint32_t body : members_)
    solver_index_[body] = 0;
  members_.assign(1, 0);
  immovables_ = 0;
  entries_.resize(sides_.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Sides sides = sides_[i];
    if (sides.a.is_left_out()) continue;
    const std::uint32_t a = number_of(sides.a), b = number_of(sides.b);
    graph_.add(a, sides.a.is_dynamic(), b, sides.b.is_dynamic());
    if (sides.a.is_dynamic() && sides.b.is_dynamic()) islands_.join(a, b);
    entries_[count++] = {static_cast<std::uint32_t>(i), scene.slots[i], a, b};
  }
  entries_.resize(count);
  first_without_contacts_ = static_cast<std::uint32_t>(members_.size());
  take_up_joints(scene);
  count_islands(scene);
  reserve_rows();
}

// Once contacts and joints have named all bodies.
void ContactSolver::count_islands(const ContactScene& scene) {
  for (const JointLink& link : scene.joint_links) {
    const std::uint32_t a = solver_index_[link.body_a], b = solver_index_[link.body_b];
    const bool both_move =
        scene.bodies[link.body_a].is_dynamic() && scene.bodies[link.body_b].is_dynamic();
    if (both_move) islands_.join(a, b);
  }
  islands_.settle();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Sides& sides = sides_[entries_[i].record];
    IslandLoad& load = island_of(i);
    ++load.contacts;
    load.fresh += sides.is_new() ? 1U : 0U;
    load.bearing += sides.is_bearing() ? 1U : 0U;
  }
  mark_pinched(scene);
  plan_converged(scene);
  has_heap_ = islands_.any(&IslandLoad::is_heap);
}

void ContactSolver::reserve_rows() {
  if (!net_.empty() && places_.size() < row_count()) places_.resize(row_count());
  if (bodies_.size() < members_.size()) {
    bodies_.resize(members_.size());
    axes_.resize(members_.size());
    gained_.resize(members_.size());
  }
  if (rows_.size() >= row_count()) return;  // they only grow, within their capacity
  inertias_.resize(row_count());
  rows_.resize(row_count());
  before_.resize(row_count());
  travel_.resize(row_count());
}

std::uint32_t ContactSolver::row_count() const {
  return static_cast<std::uint32_t>(members_.size()) + immovables_;
}

// Gives each colour its blocks and each contact its lane.
void ContactSolver::lay_out(Parallel& parallel) {
  block_count_ = 0;
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    ranges_[color] = {block_count_, blocks_for(graph_.count(color))};
    block_count_ += ranges_[color].count;
  }
  kernels_ = &lanes::manifold_kernels(graph_.greatest_count());
  if (blocks_.size() < block_count_) {  // they only grow, within their capacity
    slots_.resize(block_count_ * k_block_lanes);
    blocks_.resize(block_count_);
    approaches_.resize(block_count_);
    kept_.resize(block_count_ * k_block_lanes);
    restitution_.resize(block_count_);
  }
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    const std::size_t begin = ranges_[color].first, end = begin + ranges_[color].count;
    for (std::size_t i = begin * k_block_lanes + graph_.count(color); i < end * k_block_lanes; ++i)
      slots_[i] = k_no_contact;
  }
  parallel.for_each({static_cast<std::uint32_t>(entries_.size()), k_side_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                      for (std::uint32_t i = first; i < end; ++i)
                        slots_[slot_of(i)] = i;
                    });
}

}  // namespace lockstone
