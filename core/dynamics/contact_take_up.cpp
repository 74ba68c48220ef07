// Which bodies and contacts a tick's solver takes up: their numbers, colours and lanes.

#include "core/dynamics/contact_solver.h"
#include "core/dynamics/joint_solver.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;

// What a piece of a loop has at least: a microsecond or so of work.
constexpr std::uint32_t k_side_grain = 256;

}  // namespace

// Bodies enter the solver when a constraint first names them. What no impulse moves enters anew
// with every constraint, since constraints that are solved side by side write to all their bodies.
std::uint32_t ContactSolver::take_up(std::uint32_t body, MotionType motion) {
  if (motion == MotionType::static_body) return k_immovable | immovables_++;
  const bool is_dynamic = motion == MotionType::dynamic;
  const std::uint32_t known = solver_index_[body];
  if (known != 0 && is_dynamic) return known;
  const auto index = static_cast<std::uint32_t>(members_.size());
  if (known == 0) solver_index_[body] = index;
  members_.push_back(body);
  graph_.add_body();
  return index;
}

// What taking up reads of large records, side by side.
void ContactSolver::find_sides(const ContactScene& scene, std::size_t first, std::size_t end) {
  std::uint32_t fresh = 0;
  for (std::size_t i = first; i < end; ++i) {
    const ContactRecord& record = scene.records[i];
    const bool left_out = record.is_trigger() || scene.surfaces[scene.slots[i]].bounces;
    const auto motion_of = [&](std::uint32_t body) {
      return static_cast<MotionType>(scene.bodies[body].motion);
    };
    sides_[i] = {left_out ? Sides::k_left_out : record.body_a, record.body_b,
                 motion_of(record.body_a), motion_of(record.body_b)};
    const bool both_move =
        sides_[i].motion_a == MotionType::dynamic && sides_[i].motion_b == MotionType::dynamic;
    if (record.count == 0 && both_move && !left_out) ++fresh;
  }
  if (fresh != 0) new_.fetch_add(fresh, std::memory_order_relaxed);
}

// In the order of the records: bodies, colours and lanes follow from the state alone.
void ContactSolver::take_up_contacts(const ContactScene& scene, Parallel& parallel) {
  sides_.resize(scene.records.size());
  new_ = 0;
  parallel.for_each(
      {static_cast<std::uint32_t>(sides_.size()), k_side_grain},
      [&](std::size_t first, std::size_t end, std::uint32_t) { find_sides(scene, first, end); });
  graph_.clear();
  entries_.clear();
  for (const std::uint32_t body : members_)
    solver_index_[body] = 0;
  members_.assign(1, 0);
  immovables_ = 0;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Sides& sides = sides_[i];
    if (sides.body_a == Sides::k_left_out) continue;
    const std::uint32_t a = take_up(sides.body_a, sides.motion_a);
    const std::uint32_t b = take_up(sides.body_b, sides.motion_b);
    graph_.add(a, sides.motion_a == MotionType::dynamic, b, sides.motion_b == MotionType::dynamic);
    entries_.push_back({static_cast<std::uint32_t>(i), scene.slots[i], a, b});
  }
  first_without_contacts_ = static_cast<std::uint32_t>(members_.size());
  take_up_joints(scene);
  reserve_rows();
}

void ContactSolver::reserve_rows() {
  if (!net_.empty() && places_.size() < row_count()) places_.resize(row_count());
  if (bodies_.size() < members_.size()) bodies_.resize(members_.size());
  if (rows_.size() >= row_count()) return;  // they only grow, within what is reserved
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
  slots_.assign(block_count_ * k_block_lanes, k_no_contact);
  if (blocks_.size() < block_count_) {  // they only grow, within what is reserved
    blocks_.resize(block_count_);
    approaches_.resize(block_count_);
    kept_.resize(block_count_ * k_block_lanes);
    restitution_.resize(block_count_);
  }
  parallel.for_each({static_cast<std::uint32_t>(entries_.size()), k_side_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                      for (std::uint32_t i = first; i < end; ++i)
                        slots_[slot_of(i)] = i;
                    });
}

}  // namespace lockstone
