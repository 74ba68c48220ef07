// The narrow phase of a tick: contacts of the pairs that the broad phase found, recomputed or kept
// from the tick before.

#include <algorithm>
#include <utility>

#include "core/geometry/dispatch/collide.h"
#include "core/geometry/distance/separation.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Largest speculative distance, so that Displacement holds it.
constexpr Length k_max_speculation = Length::from_integer(32);

// How far a pair can close is rounded up to 1 mm, so that a trembling body keeps its margin.
constexpr int k_reach_bits = 10;

// Pairs that are worth a worker.
constexpr std::uint32_t k_pair_grain = 8;
constexpr std::uint32_t k_number_piece = 256;

// How far ahead a pair must look: as far as it can close in one tick, but no farther than the
// bodies are thick, or a glancing pass would be taken for a hit.
Length speculative_distance(const BodyRecord& a, const BodyRecord& b, Length thickness,
                            const TimeStep& step) {
  constexpr std::int64_t k_below_step = (std::int64_t{1} << k_reach_bits) - 1;
  const std::int64_t closing = step.tick.times(sum_of_magnitudes(a.velocity - b.velocity));
  const std::int64_t steps =
      std::max<std::int64_t>(((closing >> 12) + k_below_step) >> k_reach_bits, 1);
  const Length reach = Length::from_raw(raw::saturate<std::int32_t>(steps << k_reach_bits));
  return k_contact_margin + min(min(reach, thickness), k_max_speculation);
}

// From A's contact pose to B's.
Vec3<Length> contact_offset(const BodyRecord& a, const BodyRecord& b) {
  return saturated<Length>(contact_position(b) - contact_position(a));
}

}  // namespace

// Each pair leaves its manifolds in slots of its own; then the contacts are numbered in the order
// of the pairs.
void World::Impl::collide_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::collide);
  std::swap(slots, old_slots);
  std::swap(manifolds, old_manifolds);
  std::swap(inputs, old_inputs);
  std::swap(found_separations, old_separations);
  found_contacts.resize(pairs.size());
  separating_axes.begin(pairs.size());
  if (!collide_side_by_side()) collide_one_by_one();
  if (narrow.has_overflowed()) report.status = Status::capacity_exhausted;
  remove_seams();
  number_contacts(report);
  remembers_manifolds = true;
}

Length World::Impl::margin_of(const Pair& pair) const {
  const Length thickness = max(cache.inner_radius(pair.a), cache.inner_radius(pair.b));
  return speculative_distance(bodies[pair.a], bodies[pair.b], thickness, time_step);
}

// Whether the two would get a contact now.
bool World::Impl::meet(const Pair& pair) {
  if (bodies[pair.a].is_trigger() || bodies[pair.b].is_trigger()) return false;
  if (is_found_at_contact_poses(pair)) {
    const BodyRecord &a = bodies[pair.a], &b = bodies[pair.b];
    const Shape shape_a = a.shape(), shape_b = b.shape();
    return collide({shape_a, cache.contact_rotations()[pair.a]},
                   {shape_b, cache.contact_rotations()[pair.b]}, contact_offset(a, b),
                   margin_of(pair))
               .count > 0;
  }
  PairScratch& scratch = narrow.scratch(0);
  collide_bodies(placed(pair.a), placed(pair.b), margin_of(pair), scratch.triangles.get(),
                 scratch.part_contacts);
  return scratch.part_contacts.count > 0;
}

// Returns whether all manifolds found room.
bool World::Impl::collide_side_by_side() {
  narrow.begin(parallel.workers(), !profiler.times_pairs());
  parallel.for_each(
      {static_cast<std::uint32_t>(pairs.size()), k_pair_grain, profiler.times_pairs()},
      [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
        collide_piece(first, end, narrow.scratch(worker));
      });
  return !narrow.is_out_of_slots();
}

// Slots are given out in the order of the pairs, so that the last pairs are those that find none.
void World::Impl::collide_one_by_one() {
  narrow.begin(1, false);
  collide_piece(0, static_cast<std::uint32_t>(pairs.size()), narrow.scratch(0));
}

// Old contacts are sorted by key and pairs are too, so that one pass carries records over.
void World::Impl::collide_piece(std::uint32_t first, std::uint32_t end, PairScratch& scratch) {
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  const std::span<const ContactRecord> all = contacts();
  const auto begin = std::ranges::lower_bound(all, pairs[first], {}, bodies_of);
  std::span<const ContactRecord> before(begin, all.end());
  const std::span<const Pair> exempt_pairs = joint_graph.exempt_pairs();
  auto exempt = std::ranges::lower_bound(exempt_pairs, pairs[first]);
  SeparatingAxes::Reader last_axes = separating_axes.read_from(pairs[first]);
  bool beside_static = first > 0;  // a static body may come before
  for (std::uint32_t i = first; i < end; ++i) {
    beside_static = look_for_seam(i, beside_static);
    found_contacts[i] = {};
    separating_axes.note(i, pairs[i], {});
    while (exempt != exempt_pairs.end() && *exempt < pairs[i])
      ++exempt;
    if (exempt != exempt_pairs.end() && *exempt == pairs[i]) continue;
    while (!before.empty() && bodies_of(before.front()) < pairs[i])
      before = before.subspan(1);
    std::size_t known = 0;
    while (known < before.size() && bodies_of(before[known]) == pairs[i])
      ++known;
    collide_pair(i, before.first(known), last_axes.axis_of(pairs[i]), scratch);
    before = before.subspan(known);
  }
  if (scratch.boxes.batch.size() > 0) collide_waiting(scratch);
}

// Where the two are, to the length that primitives are collided with; frames of assets, and where a
// half-space is met, follow from every bit.
void World::Impl::read_poses(const Pair& pair, Length margin, ManifoldInput& input) const {
  const BodyRecord &a = bodies[pair.a], &b = bodies[pair.b];
  const Vec3<Position> apart = b.position - a.position;
  input = {are_primitives(pair) ? rounded<Position>(saturated<Length>(apart)) : apart,
           key_of(a.orientation), key_of(b.orientation), margin};
}

// `before`: the records of this pair a tick ago. `last_axis` parted the pair then, unless it is
// zero.
void World::Impl::collide_pair(std::uint32_t index, std::span<const ContactRecord> before,
                               const Vec3<Unit>& last_axis, PairScratch& scratch) {
  const Pair pair = pairs[index];
  const BodyRecord& a = bodies[pair.a];
  const BodyRecord& b = bodies[pair.b];
  PairTimer timer(profiler, a.shape().kind, b.shape().kind);
  if (a.is_trigger() || b.is_trigger()) {
    if (bodies_overlap(placed(pair.a), placed(pair.b))) add_trigger(index, before, scratch);
    return;
  }
  const Length margin = margin_of(pair);
  const bool may_drift = is_found_at_contact_poses(pair);
  // Where it stays if the pair is to wait.
  ManifoldInput& input = scratch.boxes.entries[scratch.boxes.batch.size()].input;
  if (may_drift) {
    input.margin = margin;
    input.pose_a = key_of_contact_pose(cache.contact_pose_number(pair.a));
    input.pose_b = key_of_contact_pose(cache.contact_pose_number(pair.b));
  } else {
    read_poses(pair, margin, input);
  }
  const std::uint32_t known = remembered_slot(before);
  const bool is_known =
      known != NarrowSlots::k_none &&
      (may_drift ? old_inputs[known].has_same_poses(input) : old_inputs[known] == input);
  if (is_known) {
    timer.found(1, 1);
    return add_known(index, known, input, before, scratch);
  }
  if (may_drift) input.offset = rounded<Position>(contact_offset(a, b));
  if (may_drift || are_primitives(pair))
    return collide_primitives(index, before, last_axis, scratch, timer);
  const PlacedShape shape_a = placed(pair.a), shape_b = placed(pair.b);
  if (last_axis != Vec3<Unit>{} && separated_along(shape_a, shape_b, margin, last_axis)) {
    separating_axes.note(index, pair, last_axis);
    return timer.found_apart();
  }
  PartContacts& parts = scratch.part_contacts;
  collide_bodies(shape_a, shape_b, margin, scratch.triangles.get(), parts);
  if (parts.count == 0) separating_axes.note(index, pair, parts.separating_axis);
  timer.found(parts.count);
  if (parts.overflowed) narrow.note_overflow();
  add_contacts(index, {parts.begin(), parts.end()}, input, before, scratch);
}

// For primitive shapes the manifold is made where it stays. Its inputs are in the next waiting
// entry.
void World::Impl::collide_primitives(std::uint32_t index, std::span<const ContactRecord> before,
                                     const Vec3<Unit>& last_axis, PairScratch& scratch,
                                     PairTimer& timer) {
  const Pair pair = pairs[index];
  WaitingBoxes& waiting = scratch.boxes;
  WaitingBoxes::Entry& entry = waiting.entries[waiting.batch.size()];
  const Vec3<Length> offset = saturated<Length>(entry.input.offset);
  const Shape shape_a = bodies[pair.a].shape(), shape_b = bodies[pair.b].shape();
  const std::vector<Mat3>& turned = rotations_of(pair);
  const PosedShape a{shape_a, turned[pair.a]}, b{shape_b, turned[pair.b]};
  if (last_axis != Vec3<Unit>{} && separated_along(a, b, offset, entry.input.margin, last_axis)) {
    separating_axes.note(index, pair, last_axis);
    return timer.found_apart();
  }
  if (waiting.are_admitted && geometry::BoxBatch::takes(shape_a, shape_b, offset)) {
    entry.index = index;
    entry.before = before;
    waiting.batch.add(a, b, offset, entry.input.margin);
    if (waiting.batch.is_full()) collide_waiting(scratch);
    return;
  }
  timer.found(collide_alone(index, entry.input, before, scratch));
}

// Returns the number of manifolds.
int World::Impl::collide_alone(std::uint32_t index, const ManifoldInput& input,
                               std::span<const ContactRecord> before, PairScratch& scratch) {
  const Pair pair = pairs[index];
  const Shape shape_a = bodies[pair.a].shape(), shape_b = bodies[pair.b].shape();
  const std::uint32_t slot = narrow.take(scratch, 1);
  Manifold& manifold = slot == NarrowSlots::k_none ? scratch.part_contacts.contacts.front().manifold
                                                   : manifolds[slot];
  const std::vector<Mat3>& turned = rotations_of(pair);
  collide({shape_a, turned[pair.a]}, {shape_b, turned[pair.b]}, saturated<Length>(input.offset),
          input.margin, manifold);
  if (manifold.count == 0) {
    separating_axes.note(index, pair, manifold.normal);
    NarrowSlots::give_back(scratch, slot);
    return 0;
  }
  if (slot != NarrowSlots::k_none) fill_single(index, slot, input, before);
  return 1;
}

void World::Impl::collide_waiting(PairScratch& scratch) {
  geometry::BoxBatch& batch = scratch.boxes.batch;
  batch.collide();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const WaitingBoxes::Entry& entry = scratch.boxes.entries[i];
    if (!batch.is_settled(i)) {
      collide_alone(entry.index, entry.input, entry.before, scratch);
      continue;
    }
    const std::uint32_t slot = narrow.take(scratch, 1);
    if (slot == NarrowSlots::k_none) continue;
    batch.write(i, manifolds[slot]);
    fill_single(entry.index, slot, entry.input, entry.before);
  }
  batch.clear();
}

// `known`: the slot of a tick ago. The drift of the bodies since that manifold was found is added
// to it.
void World::Impl::add_known(std::uint32_t index, std::uint32_t known, const ManifoldInput& input,
                            std::span<const ContactRecord> before, PairScratch& scratch) {
  const std::uint32_t slot = narrow.take(scratch, 1);
  if (slot == NarrowSlots::k_none) return;
  Manifold& manifold = manifolds[slot];
  manifold = old_manifolds[known];
  for (std::size_t i = 0; i < k_max_manifold_points; ++i)
    manifold.points[i].separation = old_separations[known][i];
  fill_single(index, slot, input, before);
}

// The one contact of a pair without parts, whose manifold is in its slot.
void World::Impl::fill_single(std::uint32_t index, std::uint32_t slot, const ManifoldInput& input,
                              std::span<const ContactRecord> before) {
  const Pair pair = pairs[index];
  found_contacts[index] = {slot, 1};
  fill_slot(slot, {pair.a, pair.b, 0, 0}, nullptr, nullptr, input, before);
}

// All but the manifold, which is there as it was found.
void World::Impl::fill_slot(std::uint32_t slot, const ContactKey& key, const Surface* surface_a,
                            const Surface* surface_b, const ManifoldInput& input,
                            std::span<const ContactRecord> before) {
  const auto old = std::ranges::find(before, key, &ContactRecord::key);
  origins[slot] = {key.part_a, key.part_b,
                   old == before.end() ? ContactOrigin::k_new : index_of(*old), false};
  inputs[slot] = input;
  for (std::size_t i = 0; i < k_max_manifold_points; ++i)
    found_separations[slot][i] = manifolds[slot].points[i].separation;
  drift({key.body_a, key.body_b}, manifolds[slot]);
  find_surface({key.body_a, key.body_b}, surface_a, surface_b, manifolds[slot], surfaces[slot]);
  if (surfaces[slot].restitution > Coefficient{}) narrow.note_elastic();
}

// Faces and edges of boxes stay where they are while their bodies drift; round shapes touch
// elsewhere at once, and are soon collided.
bool World::Impl::is_found_at_contact_poses(const Pair& pair) const {
  constexpr auto k_box = static_cast<std::uint8_t>(ShapeKind::box);
  return bodies[pair.a].shape_kind == k_box && bodies[pair.b].shape_kind == k_box;
}

void World::Impl::drift(const Pair& pair, Manifold& manifold) const {
  if (!is_found_at_contact_poses(pair)) return;
  const ContactDrift &a = cache.drift(pair.a), &b = cache.drift(pair.b);
  if (!a.is_none() || !b.is_none()) shift_separations(a, b, manifold);
}

// Neither an asset nor without end: its frame is the body's.
bool World::Impl::is_bounded_primitive(std::uint32_t body) const {
  return cache.asset(body) == nullptr && bodies[body].shape().kind != ShapeKind::half_space;
}

bool World::Impl::are_primitives(const Pair& pair) const {
  return is_bounded_primitive(pair.a) && is_bounded_primitive(pair.b);
}

// The slot of a tick ago: only of pairs with a single contact, which parts 0 and 0 name.
std::uint32_t World::Impl::remembered_slot(std::span<const ContactRecord> before) const {
  if (!remembers_manifolds || before.size() != 1) return NarrowSlots::k_none;
  const ContactRecord& record = before.front();
  const bool is_single = record.part_a == 0 && record.part_b == 0 && has_one_piece(record.body_a) &&
                         has_one_piece(record.body_b);
  return is_single ? old_slots[static_cast<std::size_t>(&record - contact_store.data())]
                   : NarrowSlots::k_none;
}

bool World::Impl::has_one_piece(std::uint32_t body) const {
  const Asset* asset = cache.asset(body);
  return asset == nullptr || asset->polytope() != nullptr;
}

void World::Impl::add_trigger(std::uint32_t index, std::span<const ContactRecord> before,
                              PairScratch& scratch) {
  const std::uint32_t slot = narrow.take(scratch, 1);
  if (slot == NarrowSlots::k_none) return;
  found_contacts[index] = {slot, 1};
  origins[slot] = {0, 0, before.empty() ? ContactOrigin::k_new : index_of(before.front()), true};
  manifolds[slot] = {};
  inputs[slot] = {};
  surfaces[slot] = {};
  surfaces[slot].tag_a = bodies[pairs[index].a].tag;
  surfaces[slot].tag_b = bodies[pairs[index].b].tag;
}

void World::Impl::add_contacts(std::uint32_t index, std::span<const PartContact> parts,
                               const ManifoldInput& input, std::span<const ContactRecord> before,
                               PairScratch& scratch) {
  if (parts.empty()) return;
  const auto count = static_cast<std::uint32_t>(parts.size());
  const std::uint32_t first = narrow.take(scratch, count);
  if (first == NarrowSlots::k_none) return;
  const Pair pair = pairs[index];
  found_contacts[index] = {first, count};
  for (std::uint32_t i = 0; i < count; ++i) {
    const PartContact& contact = parts[i];
    manifolds[first + i] = contact.manifold;
    fill_slot(first + i, {pair.a, pair.b, contact.part_a, contact.part_b}, contact.surface_a,
              contact.surface_b, input, before);
  }
}

// Within contact_store.
std::uint32_t World::Impl::index_of(const ContactRecord& record) const {
  return static_cast<std::uint32_t>(&record - contact_store.data());
}

// In pieces: the first pass counts, the second writes where the contacts of the pieces before end.
// Between them the index of a piece's first pair is that of the piece. The last pairs are those
// that find no room.
void World::Impl::number_contacts(StepReport& report) {
  const std::uint32_t room = def.contact_capacity - frozen.count();
  const auto pair_count = static_cast<std::uint32_t>(pairs.size());
  const std::uint32_t pieces = (pair_count + k_number_piece - 1) / k_number_piece;
  const auto count = [&](std::uint32_t first, std::uint32_t end) {
    std::uint32_t sum = 0;
    for (std::uint32_t i = first; i < end; ++i)
      sum += found_contacts[i].count;
    found_contacts[first].index = sum;
  };
  const auto add_up = [&] {
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < pair_count; i += k_number_piece)
      sum = std::min(sum + std::exchange(found_contacts[i].index, sum), room);
    slots.resize(sum);
    new_contacts.resize(sum);
    approach_speeds.resize(sum);
  };
  const auto number = [&](std::uint32_t first, std::uint32_t end) {
    std::uint32_t index = found_contacts[first].index;
    for (std::uint32_t i = first; i < end; ++i) {
      FoundContacts& of_pair = found_contacts[i];
      of_pair.count = std::min(of_pair.count, room - index);
      of_pair.index = index;
      index += of_pair.count;
      number_contacts_of(i);
    }
  };
  const Loop loops[] = {{pieces, 1}, {1, 1, true}, {pieces, 1}};
  parallel.run_all(loops,
                   [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
                     if (loop == 1) return add_up();
                     for (std::uint32_t piece = first; piece < end; ++piece) {
                       const std::uint32_t begin = piece * k_number_piece;
                       const std::uint32_t stop = std::min(begin + k_number_piece, pair_count);
                       loop == 0 ? count(begin, stop) : number(begin, stop);
                     }
                   });
  if (narrow.taken() > new_contacts.size()) report.status = Status::capacity_exhausted;
}

// A record keeps the impulses and the touching flag of the tick before.
void World::Impl::number_contacts_of(std::uint32_t pair) {
  const FoundContacts& of_pair = found_contacts[pair];
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    const std::uint32_t slot = of_pair.slot + i;
    const ContactOrigin& origin = origins[slot];
    const Pair& both = pairs[pair];
    ContactRecord& record = new_contacts[of_pair.index + i];
    if (origin.before == ContactOrigin::k_new)
      record = {};
    else
      record = contact_store[origin.before];
    record.body_a = both.a;
    record.body_b = both.b;
    record.part_a = origin.part_a;
    record.part_b = origin.part_b;
    if (origin.is_trigger) {
      record.flags = static_cast<std::uint16_t>(record.flags | k_contact_trigger);
    }
    slots[of_pair.index + i] = slot;
    approach_speeds[of_pair.index + i] = {};
  }
}

}  // namespace lockstone
