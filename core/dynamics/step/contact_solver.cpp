#include "core/dynamics/step/contact_solver.h"

#include <algorithm>
#include <bit>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::ManifoldBlock;
using lanes::ManifoldKernels;
using lanes::RowBody;
using lanes::RowTravel;
using lanes::scalar::high;
using lanes::scalar::low;

// Overlap is pushed out at most this fast, m/s, Q20.
constexpr std::int32_t k_push_out_speed = 3 << 20;

// Approaches slower than this do not bounce, m/s, Q20.
constexpr std::int32_t k_restitution_threshold = 1 << 20;

// Points nearer than k_skin count as touching, and come to rest at k_resting_overlap. In between, a
// spring both pushes and lets go smoothly, so that bodies that rock by a hair do not rattle.
constexpr Displacement k_skin = Displacement::from_ratio(1, 4000);
constexpr Displacement k_resting_overlap = Displacement::from_ratio(1, 200000);

// Contacts of a stack are rigid if their points are within k_firm_range of k_resting_overlap, they
// carry more than 1/k_firm_part of the impulse that makes a contact overloaded, and their bodies
// are slower than 2^-k_rigid_shift of the speed that gravity gives in a substep. Others stay
// springs, since a spring damps a body that rattles.
constexpr Displacement k_firm_range = Displacement::from_ratio(1, 5000);
constexpr std::int64_t k_firm_part = 10;
constexpr int k_rigid_shift = 6;

// 1/count, Q28.
constexpr std::int64_t k_one_over_q28[] = {0, 1 << 28, 1 << 27, ((1 << 28) + 1) / 3, 1 << 26};

// Of lanes without a contact.
constexpr lanes::ManifoldGeometry k_no_geometry{};

// The greatest speed of a body in a substep along each axis: 1000 m/s, Q50. Sums of sixteen
// substeps can be read.
constexpr std::int64_t k_row_limit = std::int64_t{1000} << lanes::k_velocity_bits;

// step = 1/rate = mantissa · 2^-(7 + shift)
lanes::SweepRules rules_of(const TimeStep& step) {
  const std::int64_t rate = step.substep_rate();
  int shift = 32;
  while (raw::round_divide(std::int64_t{1} << (7 + shift), rate) > INT32_MAX)
    --shift;
  const std::int64_t mantissa = raw::round_divide(std::int64_t{1} << (7 + shift), rate);
  return {static_cast<std::int32_t>(rate),
          k_push_out_speed,
          k_skin.raw,
          k_resting_overlap.raw,
          static_cast<std::int32_t>(mantissa),
          shift};
}

std::int64_t to_row(Velocity v) {
  return v.raw << k_grid_to_row;
}

std::int64_t within_limit(std::int64_t x) {
  return std::clamp(x, -k_row_limit, k_row_limit);
}

// One component of a body in the first substep. `before` holds the velocity that the impulses of
// the last tick give, and receives the component as it was.
void start_component(std::int64_t gain, std::int64_t& now, std::int64_t& before) {
  const std::int64_t start = within_limit(now), warm = within_limit(before);
  now = start + gain * (std::int64_t{1} << k_grid_to_row) + warm;
  before = start;
}

// In a later substep it gains as much as in the one before.
void repeat_component(std::int64_t& now, std::int64_t& before) {
  const std::int64_t start = within_limit(now);
  now = 2 * start - before;
  before = start;
}

// A hint, without meaning.
template <class T>
void prefetch(const T& object) {
#if defined(__GNUC__)
  const char* bytes = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof(T); i += 64)
    __builtin_prefetch(bytes + i);
#else
  (void)object;
#endif
}

// Loops of a substep: ten of bodies, joints and direct contacts; the colours of contacts twice,
// of nets four times.
constexpr std::size_t k_most_substep_loops = 13 + 6 * (k_graph_colors + 1);

// How many lanes ahead of the one being filled memory is asked for.
constexpr std::size_t k_lanes_ahead = 12;

// Of a point, as the record has it.
std::int64_t mean_impulse(const ContactRecord& record) {
  std::int64_t sum = 0;
  for (const ContactPointRecord& point : record.points)
    sum += point.normal_impulse.raw;
  return raw::round_shift(sum * k_one_over_q28[record.count], 28);
}

// The mean impulse (`load`) follows the impulses over 2^shift ticks, where the initial warm start
// gave one. If other contacts learned theirs while bodies settle, these would tremble on.
void follow_load(std::int64_t now, int shift, ContactRecord& record) {
  const std::int64_t load = record.load.raw;
  if (load == 0) return;
  record.load.raw = static_cast<std::int32_t>(load + raw::round_shift(now - load, shift));
}

// The points of a contact that are not those of the tick before.
void name_points(const Manifold& manifold, ContactRecord& record) {
  record.points = {};
  record.count = static_cast<std::uint16_t>(manifold.count);
  for (std::size_t i = 0; i < record.count; ++i)
    record.points[i].feature = manifold.points[i].feature;
}

// Keeps all of its impulse, and pushes nothing out.
void make_rigid(lanes::ManifoldSource& source) {
  source.keep = 1 << 30;
  source.bias_rate = 0;
}

Vec3<Unit> unit_normal_of(const ManifoldBlock& block, std::size_t lane) {
  return {Unit::from_raw(low(block.axes[0][lane])), Unit::from_raw(high(block.axes[0][lane])),
          Unit::from_raw(low(block.axes[1][lane]))};
}

}  // namespace

ContactSolver::ContactSolver(const TimeStep& step, std::size_t body_capacity,
                             std::size_t contact_capacity, std::size_t joint_capacity,
                             std::size_t converged_contacts)
    : step_(step),
      softness_(ContactSoftness::of(step)),
      rules_(rules_of(step)),
      load_shift_(static_cast<int>(std::bit_width(static_cast<std::uint32_t>(step.tick_rate))) + 2),
      graph_(body_capacity + contact_capacity, contact_capacity),
      solver_index_(body_capacity),
      joints_(std::make_unique<JointSolver>(step, body_capacity, joint_capacity,
                                            converged_contacts != 0)),
      net_(step.substep_rate(), joint_capacity == 0 ? 0 : body_capacity, joint_capacity),
      supports_(body_capacity + contact_capacity + joint_capacity, contact_capacity),
      first_loads_(contact_capacity),
      islands_(body_capacity + contact_capacity + 1, body_capacity) {
  // A moving body has one number, or, if no impulse moves it, one in each contact. Bodies that
  // stand still have rows without numbers, in contacts and in joints of nets.
  const std::size_t most_numbers = body_capacity + contact_capacity + 1;
  const std::size_t most_rows = most_numbers + joint_capacity;
  members_.reserve(most_numbers);
  moving_holds_.reserve(contact_capacity);
  bodies_.reserve(most_numbers);
  rows_.reserve(most_rows);
  inertias_.reserve(most_rows);
  before_.reserve(most_rows);
  travel_.reserve(most_rows);
  axes_.reserve(most_numbers);
  gained_.reserve(most_numbers);
  gains_.reserve(body_capacity + 1);
  if (joint_capacity != 0) energy_limit_.reserve(body_capacity);
  places_.reserve(joint_capacity == 0 ? 0 : most_rows);
  sides_.reserve(contact_capacity);
  entries_.reserve(contact_capacity);
  impacts_.reserve(contact_capacity);
  // Each colour may leave one block half empty, but none without a contact.
  const std::size_t most =
      std::min(contact_capacity, blocks_for(contact_capacity) + k_graph_colors);
  blocks_.reserve(most);
  approaches_.reserve(most);
  restitution_.reserve(most);
  slots_.reserve(most * k_block_lanes);
  kept_.reserve(most * k_block_lanes);
  reserve_islands(most_numbers, body_capacity, contact_capacity, joint_capacity,
                  std::min(converged_contacts, contact_capacity));
  loops_.reserve((static_cast<std::size_t>(step.substeps) + 1) * k_most_substep_loops);
  stages_.reserve(loops_.capacity());
}

ContactSolver::~ContactSolver() = default;

void ContactSolver::make_room(std::uint32_t workers) {
  first_loads_.make_room(workers);
  heap_loads_.make_room(workers);
}

std::uint32_t ContactSolver::contacts() const {
  return static_cast<std::uint32_t>(entries_.size());
}

void ContactSolver::fill_bodies(const ContactScene& scene, std::size_t first, std::size_t end) {
  for (std::size_t index = first; index < end; ++index) {
    inertias_[index] = {};
    rows_[index] = before_[index] = {};
    travel_[index] = {};
    if (index >= 1 && index < members_.size()) fill_member(scene, index);
  }
}

void ContactSolver::fill_member(const ContactScene& scene, std::size_t index) {
  const std::uint32_t body = members_[index];
  const BodyRecord& record = scene.bodies[body];
  bodies_[index] = solver_body(record, scene.rotations[body], scene.gravity, step_);
  axes_[index] = {};
  if (bodies_[index].held != 0) holds_.store(true, std::memory_order_relaxed);
  inertias_[index] = source_body(bodies_[index].inverse_inertia);
  for (int i = 0; i < 3; ++i) {
    rows_[index].velocity[static_cast<std::size_t>(i)] = to_row(record.velocity[i]);
    rows_[index].spin[static_cast<std::size_t>(i)] = to_row(record.spin[i]);
  }
  bodies_[index].rests = has_heap_ &&
                         islands_.load(islands_.of(static_cast<std::uint32_t>(index))).is_heap() &&
                         is_slower(rows_[index], bodies_[index], k_rigid_shift);
}

const ManifoldKernels& ContactSolver::kernels_of(std::size_t color) const {
  return color == k_overflow_color ? lanes::k_scalar_manifolds : *kernels_;
}

// Blocks of one colour, counted from its first.
void ContactSolver::fill_blocks(const ContactScene& scene, std::size_t color, std::size_t first,
                                std::size_t end) {
  Scratch scratch;
  const ManifoldKernels& kernels = kernels_of(color);
  std::uint32_t points = 0;
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t block = ranges_[color].first + i;
    points += fill_block(scene, block, scratch);
    kernels.prepare(scratch.sources, inertias_.data(), rows_.data(), before_.data(), blocks_[block],
                    approaches_[block]);
  }
  points_.fetch_add(points, std::memory_order_relaxed);
}

// Contacts of a colour lie far apart in memory.
const ContactSolver::Entry* ContactSolver::look_ahead(
    std::size_t slot, std::span<const ContactRecord> records) const {
  const std::size_t end = block_count_ * k_block_lanes, far = slot + 2 * k_lanes_ahead;
  if (far < end && slots_[far] != k_no_contact) prefetch(entries_[slots_[far]]);
  slot += k_lanes_ahead;
  if (slot >= end || slots_[slot] == k_no_contact) return nullptr;
  const Entry& entry = entries_[slots_[slot]];
  prefetch(records[entry.record]);
  return &entry;
}

// Returns the number of points in the block.
std::uint32_t ContactSolver::fill_block(const ContactScene& scene, std::size_t block,
                                        Scratch& scratch) {
  std::uint32_t points = 0;
  for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
    const std::uint32_t slot = slots_[block * k_block_lanes + lane];
    restitution_[block][lane] = 0;
    if (slot == k_no_contact) {
      scratch.sources.lanes[lane] = {};
      scratch.sources.body_a[lane] = scratch.sources.body_b[lane] = 0;
      scratch.sources.geometry[lane] = k_no_geometry.data();
      continue;
    }
    const Entry* ahead = look_ahead(block * k_block_lanes + lane, scene.records);
    if (ahead != nullptr) {
      prefetch(scene.manifolds[ahead->slot]);
      prefetch(scene.surfaces[ahead->slot]);
      for (const std::uint32_t index : {ahead->body_a, ahead->body_b})
        if ((index & k_immovable) == 0) prefetch(bodies_[index].inverse_inertia);
    }
    const Entry& entry = entries_[slot];
    const ContactRecord& record = scene.records[entry.record];
    const auto side = [&](std::uint32_t index, std::uint32_t body,
                          SolverBody& fixed) -> const SolverBody& {
      if ((index & k_immovable) == 0) return bodies_[index];
      fixed.scale_exponent = scene.bodies[body].scale_exponent;
      return fixed;
    };
    const SolverBody& a = side(entry.body_a, record.body_a, scratch.fixed_a);
    const SolverBody& b = side(entry.body_b, record.body_b, scratch.fixed_b);
    lanes::ManifoldSources& sources = scratch.sources;
    sources.body_a[lane] = lanes::row_body_offset(row_of(entry.body_a));
    sources.body_b[lane] = lanes::row_body_offset(row_of(entry.body_b));
    sources.geometry[lane] = geometry_of(scene.manifolds[entry.slot]);
    if (is_alone(entry))
      bodies_[(entry.body_a & k_immovable) == 0 ? entry.body_a : entry.body_b].is_alone = true;
    const ContactSurface& surface = scene.surfaces[entry.slot];
    IslandLoad& island = island_of(slot);
    const ContactInput input{a, b, scene.manifolds[entry.slot], record, surface, island.is_pinched};
    kept_[block * k_block_lanes + lane] =
        fill_source(input, softness_, sources.lanes[lane]) ? 1 : 0;
    if (island.is_heap() && is_firm(scene, entry)) make_rigid(sources.lanes[lane]);
    const lanes::ManifoldSource& source = sources.lanes[lane];
    if (island.few_are_loaded() && is_loaded(scene, entry, source.share_b)) island.loaded.raise();
    restitution_[block][lane] = surface.restitution.raw;
    if (restitution_[block][lane] != 0) bounces_.store(true, std::memory_order_relaxed);
    points += static_cast<std::uint32_t>(sources.lanes[lane].count);
  }
  return points;
}

// Whether a contact of a stack carries, and lies where it comes to rest. A stack would bend by a
// spring there.
bool ContactSolver::is_firm(const ContactScene& scene, const Entry& entry) const {
  const ContactRecord& record = scene.records[entry.record];
  if (std::int64_t{record.load.raw} * record.count * k_firm_part <= heap_push_) return false;
  const Manifold& manifold = scene.manifolds[entry.slot];
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
    const std::int64_t off = std::int64_t{manifold.points[i].separation.raw} + rules_.overlap;
    if (off > k_firm_range.raw || off < -k_firm_range.raw) return false;
  }
  const auto rests = [&](std::uint32_t index) {
    return (index & k_immovable) != 0 || bodies_[index].rests;
  };
  return rests(entry.body_a) && rests(entry.body_b);
}

// In the first substep: gravity and the impulses of the tick before. Later ones start with the
// impulses that the substep before ended with. All responses are fixed for a tick, so these
// impulses and gravity give a body the same velocity as in the substep before.
void ContactSolver::integrate_velocities(bool is_first, std::size_t first, std::size_t end) {
  for (std::size_t i = std::max<std::size_t>(first, 1); i < end; ++i) {
    RowBody& row = rows_[i];
    RowBody& before = before_[i];
    const SolverBody& body = bodies_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_first) {
        start_component(body.gain[axis], row.velocity[axis], before.velocity[axis]);
        start_component(body.spin_gain[axis], row.spin[axis], before.spin[axis]);
      } else {
        repeat_component(row.velocity[axis], before.velocity[axis]);
        repeat_component(row.spin[axis], before.spin[axis]);
      }
    }
    hold(i);
  }
}

// Preparation gives locked axes no response; here the velocity that a push left there is cleared.
void ContactSolver::hold(std::size_t index) {
  if (bodies_[index].held == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (bodies_[index].is_held(axis)) rows_[index].velocity[static_cast<std::size_t>(axis)] = 0;
  }
}

// The bodies of blocks of one colour, which no other block of it names.
void ContactSolver::hold_blocks(std::size_t first, std::size_t end) {
  if (!holds_) return;
  for (std::size_t slot = first * k_block_lanes; slot < end * k_block_lanes; ++slot) {
    if (slots_[slot] == k_no_contact) continue;
    const Entry& entry = entries_[slots_[slot]];
    for (const std::uint32_t index : {entry.body_a, entry.body_b})
      if ((index & k_immovable) == 0) hold(index);
  }
}

void ContactSolver::integrate_positions(std::size_t first, std::size_t end) {
  for (std::size_t i = std::max<std::size_t>(first, 1); i < end; ++i) {
    if (bodies_[i].is_pushed() && is_still(rows_[i])) continue;
    const RowBody row = bodies_[i].is_alone ? steadied(rows_[i]) : rows_[i];
    RowTravel& travel = travel_[i];
    const std::array<std::int64_t, 3> spin = {within_limit(row.spin[0]), within_limit(row.spin[1]),
                                              within_limit(row.spin[2])};
    const std::array<std::int64_t, 3> surface = surface_velocity(bodies_[i].inverse_inertia, spin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      travel.velocity[axis] += within_limit(row.velocity[axis]) >> k_grid_to_row;
      travel.surface[axis] += surface[axis];
    }
  }
}

void ContactSolver::bounce(const ManifoldKernels& kernels, std::size_t first, std::size_t end) {
  for (std::size_t block = first; block < end; ++block) {
    const lanes::BlockWord& restitution = restitution_[block];
    if (std::all_of(restitution.begin(), restitution.end(), [](auto e) { return e == 0; })) {
      continue;
    }
    kernels.bounce(rows_.data(), blocks_[block], approaches_[block], restitution,
                   k_restitution_threshold);
  }
}

void ContactSolver::store(std::span<const Manifold> manifolds, std::span<ContactRecord> records,
                          std::span<SolverVelocity> approaches, Parallel& parallel) {
  if (is_idle_) return;
  first_loads_.store(supports_, records);
  loops_.clear();
  stages_.clear();
  add_loop_of_each_color(StageKind::store);
  const StoreTarget target{manifolds, records, approaches};
  std::atomic<std::uint32_t> saturations{0};
  parallel.run_all(loops_,
                   [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
                     saturations.fetch_add(store_blocks(stages_[loop], first, end, target),
                                           std::memory_order_relaxed);
                   });
  saturations_ = saturations;
}

// Blocks of one colour, counted from its first. Returns the number of clamped values.
std::uint32_t ContactSolver::store_blocks(const Stage& stage, std::size_t first, std::size_t end,
                                          const StoreTarget& target) {
  const std::size_t begin = ranges_[stage.color].first;
  std::uint32_t clamped = 0;
  for (std::size_t slot = (begin + first) * k_block_lanes; slot < (begin + end) * k_block_lanes;
       ++slot) {
    if (slots_[slot] == k_no_contact) continue;
    const Entry* ahead = look_ahead(slot, target.records);
    if (ahead != nullptr && kept_[slot + k_lanes_ahead] == 0)
      prefetch(target.manifolds[ahead->slot]);
    const Entry& entry = entries_[slots_[slot]];
    ContactRecord& record = target.records[entry.record];
    const std::size_t block = slot / k_block_lanes, lane = slot % k_block_lanes;
    if (kept_[slot] == 0) name_points(target.manifolds[entry.slot], record);
    clamped += store_contact(block, lane, record);
    follow_load(mean_impulse(record), load_shift_, record);
    target.approaches[entry.record].raw = approaches_[block].fastest(lane);
    if (record.is_touching()) add_axes(entry, unit_normal_of(blocks_[block], lane));
  }
  return clamped;
}

// Between a body that nothing moves and one that touches nothing else.
bool ContactSolver::is_alone(const Entry& entry) const {
  const bool a_moves = (entry.body_a & k_immovable) == 0;
  const bool b_moves = (entry.body_b & k_immovable) == 0;
  return a_moves != b_moves && graph_.degree(a_moves ? entry.body_a : entry.body_b) == 1;
}

// Writes the impulses of a contact to its record, which has the feature ids already. Returns the
// number of clamped values.
std::uint32_t ContactSolver::store_contact(std::size_t block_index, std::size_t lane,
                                           ContactRecord& record) const {
  const ManifoldBlock& block = blocks_[block_index];
  std::uint32_t saturations = approaches_[block_index].clamped(lane);
  bool touching = approaches_[block_index].touches(lane);
  for (std::size_t i = 0; i < record.count; ++i) {
    const std::int64_t word = block.points[i].impulse[lane];
    const std::int32_t impulse = low(word), greatest = high(word);
    record.points[i].normal_impulse.raw = impulse;
    touching = touching || greatest > 0;
    saturations += greatest == lanes::k_most_impulse ? 1 : 0;
  }
  across(block, lane, block.friction[lane], record.friction_impulse);
  record.rolling_impulse = {};
  if (!block.is_plain(lane) && block.rolling[lane] != 0)
    across(block, lane, block.rolling[lane], record.rolling_impulse);
  record.twist_impulse.raw = low(block.twist[lane]);
  record.flags = touching ? k_contact_touching : 0;
  return saturations;
}

}  // namespace lockstone
