#include "core/dynamics/step/contacts/contact_constraints.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/step/input/contact_params.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::ManifoldBlock;
using lanes::ManifoldKernels;
using lanes::scalar::high;
using lanes::scalar::low;

// Approaches slower than this do not bounce, m/s, Q20.
constexpr std::int32_t k_restitution_threshold = 1 << 20;

// 1/count, Q28.
constexpr std::int64_t k_one_over_q28[] = {0, 1 << 28, 1 << 27, ((1 << 28) + 1) / 3, 1 << 26};

// Of lanes without a contact.
constexpr lanes::ManifoldGeometry k_no_geometry{};

// How many lanes ahead of the one being filled memory is asked for.
constexpr std::uint32_t k_lanes_ahead = 12;

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

// Of a point, as the record has it.
std::int64_t impulse_of_point(const ContactRecord& record) {
  LKS_ASSERT(record.count <= lanes::k_block_points);
  std::int64_t sum = 0;
  for (const ContactPointRecord& point : record.points)
    sum += point.normal_impulse.raw;
  return raw::round_shift(sum * k_one_over_q28[record.count], 28);
}

// `mean_impulse` follows the impulses over 2^shift ticks, where the initial warm start
// gave one. If other contacts learned theirs while bodies settle, these would tremble on.
void update_mean(std::int64_t now, int shift, ContactRecord& record) {
  const std::int64_t mean = record.mean_impulse.raw;
  if (mean == 0) return;
  record.mean_impulse.raw = static_cast<std::int32_t>(mean + raw::round_shift(now - mean, shift));
}

// The points of a contact that are not those of the tick before.
void name_points(const Manifold& manifold, ContactRecord& record) {
  record.points = {};
  record.count = static_cast<std::uint16_t>(manifold.count);
  for (std::size_t i = 0; i < record.count; ++i)
    record.points[i].feature = manifold.points[i].feature;
}

// Keeps all of its impulse, and pushes nothing out.
void make_rigid(lanes::PrepareInput& input) {
  input.keep = 1 << 30;
  input.bias_rate = 0;
}

Vec3<Unit> unit_normal_of(const ManifoldBlock& block, std::size_t lane) {
  return {Unit::from_raw(low(block.axes[0][lane])), Unit::from_raw(high(block.axes[0][lane])),
          Unit::from_raw(low(block.axes[1][lane]))};
}

}  // namespace

ContactConstraints::ContactConstraints(const TimeStep& step, std::size_t body_capacity,
                                       std::size_t contact_capacity, const Parts& parts)
    : parts_(parts),
      softness_(ContactSoftness::of(step)),
      params_(solver_params(step)),
      mean_shift_(static_cast<int>(std::bit_width(static_cast<std::uint32_t>(step.tick_rate))) + 2),
      layout_(body_capacity, contact_capacity) {
  const std::size_t most = ConstraintLayout::most_blocks(contact_capacity);
  blocks_.reserve(most);
  approaches_.reserve(most);
  restitution_.reserve(most);
  has_points_.reserve(most * k_block_lanes);
}

// Blocks only grow, within their capacity.
void ContactConstraints::lay_out(const ContactScene& scene, Parallel& parallel) {
  layout_.build(scene, parts_.bodies, parts_.contacts, parallel);
  kernels_ = &lanes::manifold_kernels(layout_.graph().greatest_count());
  points_ = 0;
  has_restitution_ = false;
  LKS_ASSERT(is_reserved(blocks_, layout_.block_count()));
  if (blocks_.size() >= layout_.block_count()) return;
  blocks_.resize(layout_.block_count());
  approaches_.resize(layout_.block_count());
  restitution_.resize(layout_.block_count());
  has_points_.resize(layout_.lane_count());
}

ContactRun ContactConstraints::run() {
  SolverBodies& bodies = parts_.bodies;
  return {bodies.rows(), bodies.before(), bodies.constants(), blocks_, params_};
}

const ManifoldKernels& ContactConstraints::kernels_of(std::size_t color) const {
  return color == k_overflow_color ? lanes::k_scalar_manifolds : *kernels_;
}

void ContactConstraints::prepare(const ContactScene& scene, std::size_t color, std::size_t first,
                                 std::size_t end) {
  LKS_ASSERT(end <= layout_.blocks_of(color).count);
  Scratch scratch;
  SolverBodies& bodies = parts_.bodies;
  const ManifoldKernels& kernels = kernels_of(color);
  std::uint32_t points = 0;
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t block = layout_.blocks_of(color).first + i;
    points += fill_block(scene, block, scratch);
    kernels.prepare(scratch.inputs, bodies.inertias().data(), bodies.rows().data(),
                    bodies.before().data(), blocks_[block], approaches_[block]);
  }
  points_.fetch_add(points, std::memory_order_relaxed);
}

// Contacts of a colour lie far apart in memory.
const ContactRef* ContactConstraints::look_ahead(std::size_t lane,
                                                 std::span<const ContactRecord> records) const {
  LKS_ASSERT(lane < layout_.lane_count());
  const auto contact_at = [this](std::size_t index) -> const ContactRef* {
    const ContactLane place{static_cast<std::uint32_t>(index)};
    const bool has_contact = index < layout_.lane_count() && layout_.has_contact(place);
    return has_contact ? &parts_.contacts[layout_.contact_at(place)] : nullptr;
  };
  if (const ContactRef* far = contact_at(lane + 2 * k_lanes_ahead)) prefetch(*far);
  const ContactRef* near = contact_at(lane + k_lanes_ahead);
  if (near != nullptr) prefetch(records[near->record]);
  return near;
}

// Returns the number of points in the block.
std::uint32_t ContactConstraints::fill_block(const ContactScene& scene, std::size_t block,
                                             Scratch& scratch) {
  std::uint32_t points = 0;
  LKS_ASSERT(block < blocks_.size());
  lanes::PrepareInputs& inputs = scratch.inputs;
  for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
    const ContactLane place{static_cast<std::uint32_t>(block * k_block_lanes + lane)};
    restitution_[block][lane] = 0;
    if (!layout_.has_contact(place)) {
      inputs.lanes[lane] = {};
      inputs.body_a[lane] = inputs.body_b[lane] = 0;
      inputs.geometry[lane] = k_no_geometry.data();
      continue;
    }
    if (const ContactRef* ahead = look_ahead(place.value, scene.records)) {
      prefetch(scene.manifolds[ahead->manifold]);
      prefetch(scene.surfaces[ahead->manifold]);
      for (const BodyRef body : {ahead->a, ahead->b})
        if (!body.is_standing()) prefetch(parts_.bodies.constants()[body.number()].inverse_inertia);
    }
    fill_lane(scene, place, scratch);
    points += static_cast<std::uint32_t>(inputs.lanes[lane].count);
  }
  return points;
}

void ContactConstraints::fill_lane(const ContactScene& scene, ContactLane place, Scratch& scratch) {
  SolverBodies& bodies = parts_.bodies;
  const std::span<SolverBody> constants = bodies.constants();
  const ContactRef& contact = parts_.contacts[layout_.contact_at(place)];
  const ContactRecord& record = scene.records[contact.record];
  const Manifold& manifold = scene.manifolds[contact.manifold];
  LKS_ASSERT(record.count <= lanes::k_block_points);
  const ContactSurface& surface = scene.surfaces[contact.manifold];
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= static_cast<int>(lanes::k_block_points));
  const auto side = [&](BodyRef ref, std::uint32_t body, SolverBody& fixed) -> const SolverBody& {
    if (!ref.is_standing()) return constants[ref.number()];
    fixed.scale_exponent = scene.bodies[body].scale_exponent;
    return fixed;
  };
  const SolverBody& a = side(contact.a, record.body_a, scratch.fixed_a);
  const SolverBody& b = side(contact.b, record.body_b, scratch.fixed_b);
  const std::size_t lane = place.lane();
  lanes::PrepareInputs& inputs = scratch.inputs;
  inputs.body_a[lane] = lanes::body_velocity_offset(bodies.row_of(contact.a));
  inputs.body_b[lane] = lanes::body_velocity_offset(bodies.row_of(contact.b));
  inputs.geometry[lane] = geometry_of(manifold);
  if (layout_.is_alone(contact))
    constants[contact.a.is_standing() ? contact.b.number() : contact.a.number()].is_alone = true;
  IslandTally& island = parts_.islands.tally(contact);
  lanes::PrepareInput& input = inputs.lanes[lane];
  const ContactInput from{a, b, manifold, record, surface, island.is_pinched};
  has_points_[place.value] = fill_source(from, softness_, input) ? 1 : 0;
  if (island.is_stack() && parts_.effort.is_rigid(scene, bodies, contact)) make_rigid(input);
  if (island.few_are_overloaded() &&
      EffortPolicy::is_overloaded(scene, bodies, contact, input.share_b))
    island.overloaded.raise();
  restitution_[place.block()][lane] = surface.restitution.raw;
  if (surface.restitution.raw != 0) has_restitution_.store(true, std::memory_order_relaxed);
}

void ContactConstraints::solve(std::size_t color, std::size_t first, std::size_t end) {
  const std::size_t begin = layout_.blocks_of(color).first;
  kernels_of(color).solve(parts_.bodies.rows().data(), &blocks_[begin + first], end - first,
                          params_);
  apply_axis_locks(begin + first, begin + end);
}

void ContactConstraints::relax(std::size_t color, std::size_t first, std::size_t end,
                               std::uint32_t substep) {
  const std::size_t begin = layout_.blocks_of(color).first;
  kernels_of(color).relax(parts_.bodies.rows().data(), parts_.bodies.travel().data(),
                          &blocks_[begin + first], end - first, dithered(params_, substep));
  apply_axis_locks(begin + first, begin + end);
}

void ContactConstraints::bounce(std::size_t color, std::size_t first, std::size_t end) {
  const std::size_t begin = layout_.blocks_of(color).first;
  LKS_ASSERT(first <= end && end <= layout_.blocks_of(color).count);
  for (std::size_t block = begin + first; block < begin + end; ++block) {
    const lanes::BlockWord& restitution = restitution_[block];
    if (std::all_of(restitution.begin(), restitution.end(), [](auto e) { return e == 0; }))
      continue;
    kernels_of(color).bounce(parts_.bodies.rows().data(), blocks_[block], approaches_[block],
                             restitution, k_restitution_threshold);
  }
  apply_axis_locks(begin + first, begin + end);
}

// The bodies of blocks of one colour, which no other block of it names.
void ContactConstraints::apply_axis_locks(std::size_t first, std::size_t end) {
  if (!parts_.bodies.has_axis_locks()) return;
  LKS_ASSERT(first <= end && end <= blocks_.size());
  for (std::size_t i = first * k_block_lanes; i < end * k_block_lanes; ++i) {
    const ContactLane place{static_cast<std::uint32_t>(i)};
    if (!layout_.has_contact(place)) continue;
    const ContactRef& contact = parts_.contacts[layout_.contact_at(place)];
    for (const BodyRef body : {contact.a, contact.b})
      if (!body.is_standing()) parts_.bodies.apply_axis_locks(body.number());
  }
}

std::uint32_t ContactConstraints::store(std::size_t color, std::size_t first, std::size_t end,
                                        const StoreTarget& target, SolvedMotion& motion) const {
  const std::size_t begin = layout_.blocks_of(color).first;
  LKS_ASSERT(first <= end && end <= layout_.blocks_of(color).count);
  std::uint32_t clamped = 0;
  for (std::size_t i = (begin + first) * k_block_lanes; i < (begin + end) * k_block_lanes; ++i) {
    const ContactLane place{static_cast<std::uint32_t>(i)};
    if (!layout_.has_contact(place)) continue;
    const ContactRef* ahead = look_ahead(i, target.records);
    if (ahead != nullptr && has_points_[i + k_lanes_ahead] == 0)
      prefetch(target.manifolds[ahead->manifold]);
    const ContactRef& contact = parts_.contacts[layout_.contact_at(place)];
    ContactRecord& record = target.records[contact.record];
    if (has_points_[i] == 0) name_points(target.manifolds[contact.manifold], record);
    clamped += store_contact(place, record);
    LKS_ASSERT(std::ranges::all_of(record.points, [](const ContactPointRecord& point) {
      return point.normal_impulse.raw >= 0;
    }));
    LKS_ASSERT(record.count <= lanes::k_block_points);
    LKS_ASSERT(std::ranges::all_of(
        std::span(record.points).subspan(record.count),
        [](const ContactPointRecord& point) { return point == ContactPointRecord{}; }));
    update_mean(impulse_of_point(record), mean_shift_, record);
    target.approaches[contact.record].raw = approach_of(place);
    if (record.is_touching())
      motion.note_push(contact, unit_normal_of(blocks_[place.block()], place.lane()));
  }
  return clamped;
}

// Writes the impulses of a contact to its record, which has the feature ids already. Returns the
// number of clamped values.
std::uint32_t ContactConstraints::store_contact(ContactLane place, ContactRecord& record) const {
  const ManifoldBlock& block = blocks_[place.block()];
  const std::size_t lane = place.lane();
  std::uint32_t clamped = approaches_[place.block()].clamped(lane);
  bool touching = approaches_[place.block()].touches(lane);
  for (std::size_t i = 0; i < record.count; ++i) {
    const std::int64_t word = block.points[i].impulse[lane];
    const std::int32_t impulse = low(word), greatest = high(word);
    LKS_ASSERT(impulse >= 0 && impulse <= greatest);
    record.points[i].normal_impulse.raw = impulse;
    touching = touching || greatest > 0;
    clamped += greatest == lanes::k_most_impulse ? 1 : 0;
  }
  across(block, lane, block.friction[lane], record.friction_impulse);
  record.rolling_impulse = {};
  if (!block.is_plain(lane) && block.rolling[lane] != 0)
    across(block, lane, block.rolling[lane], record.rolling_impulse);
  record.twist_impulse.raw = low(block.twist[lane]);
  record.flags = touching ? k_contact_touching : 0;
  return clamped;
}

}  // namespace lockstone
