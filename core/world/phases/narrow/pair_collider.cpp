// The pairs of a tick, one by one.

#include "core/world/phases/narrow/pair_collider.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/dispatch/collide.h"
#include "core/geometry/distance/separation.h"
#include "core/world/phases/narrow/contact_surfaces.h"
#include "core/world/phases/narrow/narrow_phase.h"
#include "core/world/phases/narrow/one_way.h"

namespace lockstone {
namespace {

// Of two boxes or hulls that touched a tick ago; other pairs hold nothing. Whether bodies that are
// apart have a contact follows from how bounds are rounded, and must not change the results.
HeldFeatures held_features(std::span<const ContactRecord> before, const BodyRecord& a,
                           const BodyRecord& b) {
  HeldFeatures held;
  if (before.size() != 1 || !before.front().is_touching()) return held;
  if (!has_faces(a) || !has_faces(b)) return held;
  LKS_ASSERT(before.front().count <= held.features.size());
  held.count = before.front().count;
  for (std::uint32_t i = 0; i < before.front().count; ++i) {
    const ContactPointRecord& point = before.front().points[i];
    held.features[i] = point.feature;
    if (point.normal_impulse > SolverVelocity{})
      held.loaded = static_cast<std::uint16_t>(held.loaded | 1U << i);
  }
  return held;
}

// As if they are those of the pair's own manifold.
std::uint8_t held_own(const HeldFeatures& held) {
  if (held.count == 0) return ManifoldInput::k_holds_none;
  return static_cast<std::uint8_t>(ManifoldInput::k_holds_own | held.loaded);
}

bool has_features(const Manifold& manifold, const HeldFeatures& held) {
  bool are_same = manifold.count == held.count;
  for (std::size_t i = 0; are_same && i < held.count; ++i)
    are_same = manifold.points[i].feature == held.features[i];
  return are_same;
}

// Whether a manifold that was found has the features that were held.
void note_held(const Manifold& manifold, const HeldFeatures& held, ManifoldInput& input) {
  if (held.count != 0 && !has_features(manifold, held)) input.held = ManifoldInput::k_holds_others;
}

}  // namespace

// Where the two are, to the length that primitives are collided with; frames of assets, and where a
// half-space is met, follow from every bit.
void PairCollider::read_poses(const Pair& pair, Length margin, ManifoldInput& input) const {
  const BodyRecord &a = world_.bodies[pair.a], &b = world_.bodies[pair.b];
  const Vec3<Position> apart = b.position - a.position;
  input = {are_primitives(pair) ? rounded<Position>(saturated<Length>(apart)) : apart,
           key_of(a.orientation), key_of(b.orientation), margin};
}

Length PairCollider::margin_in_tick(const Pair& pair) const {
  if (!data_.knows_turning_speeds) return margin_of(world_, pair);
  const auto turning_of = [this](std::uint32_t body) {
    return world_.bodies[body].is_awake() ? data_.turning_speeds[body] : 0;
  };
  const Length margin = margin_of(world_, pair, turning_of(pair.a) + turning_of(pair.b));
  LKS_ASSERT(margin == margin_of(world_, pair));
  return margin;
}

void PairCollider::collide(std::uint32_t index, std::span<const ContactRecord> before,
                           const Vec3<Unit>& last_axis) {
  const Pair pair = data_.pairs[index];
  const BodyRecord& a = world_.bodies[pair.a];
  const BodyRecord& b = world_.bodies[pair.b];
  PairTimer timer(world_.profiler, a.shape().kind, b.shape().kind);
  if (a.is_trigger() || b.is_trigger()) {
    if (bodies_overlap(world_.placed(pair.a), world_.placed(pair.b))) add_trigger(index, before);
    return;
  }
  if (is_one_way_pair(world_, pair)) return collide_one_way(index, before, timer);
  const Length margin = margin_in_tick(pair);
  const bool is_recycled = is_found_at_recycling_poses(world_, pair);
  // Where they stay if the pair is to wait.
  WaitingBoxes::Entry& entry = scratch_.boxes.entries[scratch_.boxes.batch.size()];
  ManifoldInput& input = entry.input;
  if (is_recycled) {
    input.margin = margin;
    input.pose_a = key_of_recycling_pose(world_.cache.recycling_pose_number(pair.a));
    input.pose_b = key_of_recycling_pose(world_.cache.recycling_pose_number(pair.b));
  } else {
    read_poses(pair, margin, input);
  }
  entry.held = held_features(before, a, b);
  input.held = held_own(entry.held);
  const std::uint32_t known = remembered_manifold(before);
  const bool is_known = known != ManifoldIds::k_none &&
                        (is_recycled ? data_.notes_before.inputs[known].has_same_poses(input)
                                     : data_.notes_before.inputs[known] == input);
  if (is_known) {
    timer.found(1, 1);
    return add_known(index, known, input, before);
  }
  if (is_recycled) input.offset = rounded<Position>(recycling_offset(a, b));
  if (are_primitives(pair)) return collide_primitives(index, before, last_axis, timer);
  const PlacedShape& shape_a = placed_first(pair.a, is_recycled);
  const PlacedShape shape_b = placed(pair.b, is_recycled);
  if (last_axis != Vec3<Unit>{} && separated_along(shape_a, shape_b, margin, last_axis)) {
    data_.separating_axes.note(index, pair, last_axis);
    return timer.found_apart();
  }
  PartContacts& parts = scratch_.part_contacts;
  collide_bodies(shape_a, shape_b, margin, scratch_.triangles.get(), parts, entry.held);
  if (parts.count == 0) data_.separating_axes.note(index, pair, parts.separating_axis);
  timer.found(parts.count);
  if (parts.overflowed) data_.ids.note_overflow();
  if (parts.count == 1) note_held(parts.contacts.front().manifold, entry.held, input);
  add_contacts(index, {parts.begin(), parts.end()}, input, before);
}

// Nothing of it is remembered: where the pair has no one-way body any more it is collided again.
void PairCollider::collide_one_way(std::uint32_t index, std::span<const ContactRecord> before,
                                   PairTimer& timer) {
  const Pair pair = data_.pairs[index];
  PartContacts& parts = scratch_.part_contacts;
  collide_all_parts(pair, parts);
  timer.found(parts.count);
  if (parts.overflowed) data_.ids.note_overflow();
  if (!is_passing(world_, pair, before, parts))
    return add_contacts(index, {parts.begin(), parts.end()}, {}, before);
  const std::uint32_t id = data_.ids.take(scratch_, 1);
  if (id == ManifoldIds::k_none) return;
  data_.of_pair[index] = {id, 1};
  data_.origins[id] = {0, 0, ContactOrigin::k_new, k_contact_passing};
  data_.found.manifolds[id] = {};
  data_.notes.inputs[id] = {};
  data_.found.surfaces[id] = {};
}

void PairCollider::collide_all_parts(const Pair& pair, PartContacts& parts) const {
  const bool is_recycled = is_found_at_recycling_poses(world_, pair);
  collide_bodies(placed(pair.a, is_recycled), placed(pair.b, is_recycled), margin_of(world_, pair),
                 scratch_.triangles.get(), parts);
}

PlacedShape PairCollider::placed(std::uint32_t body, bool is_recycled) const {
  return is_recycled ? world_.cache.recycled(body, world_.bodies[body]) : world_.placed(body);
}

const PlacedShape& PairCollider::placed_first(std::uint32_t body, bool is_recycled) {
  if (first_ != body || first_is_recycled_ != is_recycled) {
    first_ = body;
    first_is_recycled_ = is_recycled;
    placed_first_ = placed(body, is_recycled);
  }
  return placed_first_;
}

// For primitive shapes the manifold is made where it stays. Its inputs are in the next waiting
// entry.
void PairCollider::collide_primitives(std::uint32_t index, std::span<const ContactRecord> before,
                                      const Vec3<Unit>& last_axis, PairTimer& timer) {
  const Pair pair = data_.pairs[index];
  WaitingBoxes& waiting = scratch_.boxes;
  WaitingBoxes::Entry& entry = waiting.entries[waiting.batch.size()];
  const Vec3<Length> offset = saturated<Length>(entry.input.offset);
  const Shape shape_a = world_.bodies[pair.a].shape(), shape_b = world_.bodies[pair.b].shape();
  const std::vector<Mat3>& turned = rotations_of(pair);
  const PosedShape a{shape_a, turned[pair.a]}, b{shape_b, turned[pair.b]};
  if (last_axis != Vec3<Unit>{} && separated_along(a, b, offset, entry.input.margin, last_axis)) {
    data_.separating_axes.note(index, pair, last_axis);
    return timer.found_apart();
  }
  // The batch holds no edges.
  const bool may_wait = waiting.are_admitted && !geometry::is_of_edges(entry.held.first());
  entry.index = index;
  entry.before = before;
  if (may_wait && geometry::BoxBatch::takes(shape_a, shape_b, offset)) {
    waiting.batch.add(a, b, offset, entry.input.margin, entry.held);
    if (waiting.batch.is_full()) collide_waiting();
    return;
  }
  timer.found(collide_alone(entry));
}

// Returns the number of manifolds.
int PairCollider::collide_alone(const WaitingBoxes::Entry& entry) {
  const Pair pair = data_.pairs[entry.index];
  const Shape shape_a = world_.bodies[pair.a].shape(), shape_b = world_.bodies[pair.b].shape();
  const std::vector<Mat3>& turned = rotations_of(pair);
  return add_found(entry, [&](Manifold& manifold) {
    lockstone::collide({shape_a, turned[pair.a]}, {shape_b, turned[pair.b]},
                       saturated<Length>(entry.input.offset), entry.input.margin, entry.held,
                       manifold);
  });
}

void PairCollider::collide_waiting() {
  geometry::BoxBatch& batch = scratch_.boxes.batch;
  batch.collide();
  for (std::size_t i = 0; i < batch.size(); ++i)
    add_found(scratch_.boxes.entries[i], [&](Manifold& manifold) { batch.write(i, manifold); });
  batch.clear();
}

// `find` fills the manifold where it stays. Returns the number of manifolds.
template <class Find>
int PairCollider::add_found(const WaitingBoxes::Entry& entry, Find&& find) {
  const std::uint32_t id = data_.ids.take(scratch_, 1);
  Manifold& manifold = id == ManifoldIds::k_none ? scratch_.part_contacts.contacts.front().manifold
                                                 : data_.found.manifolds[id];
  find(manifold);
  if (manifold.count == 0) {
    data_.separating_axes.note(entry.index, data_.pairs[entry.index], manifold.normal);
    ManifoldIds::release(scratch_, id);
    return 0;
  }
  if (id != ManifoldIds::k_none) fill_found(entry, id);
  return 1;
}

// `known`: the manifold of a tick ago. The pose delta of the bodies since that manifold was found
// is added to it.
void PairCollider::add_known(std::uint32_t index, std::uint32_t known, const ManifoldInput& input,
                             std::span<const ContactRecord> before) {
  const std::uint32_t id = data_.ids.take(scratch_, 1);
  if (id == ManifoldIds::k_none) return;
  Manifold& manifold = data_.found.manifolds[id];
  manifold = data_.manifolds_before[known];
  for (std::size_t i = 0; i < k_max_manifold_points; ++i)
    manifold.points[i].separation = data_.notes_before.separations[known][i];
  fill_single(index, id, input, before);
}

// The one contact of a pair without parts, whose manifold is in its place.
void PairCollider::fill_single(std::uint32_t index, std::uint32_t id, const ManifoldInput& input,
                               std::span<const ContactRecord> before) {
  const Pair pair = data_.pairs[index];
  data_.of_pair[index] = {id, 1};
  fill(id, {pair.a, pair.b, 0, 0}, nullptr, nullptr, input, before);
}

// The same of a manifold that was found now.
void PairCollider::fill_found(const WaitingBoxes::Entry& entry, std::uint32_t id) {
  fill_single(entry.index, id, entry.input, entry.before);
  note_held(data_.found.manifolds[id], entry.held, data_.notes.inputs[id]);
}

// All but the manifold, which is there as it was found.
void PairCollider::fill(std::uint32_t id, const ContactKey& key, const Surface* surface_a,
                        const Surface* surface_b, const ManifoldInput& input,
                        std::span<const ContactRecord> before) {
  const auto old = std::ranges::find(before, key, &ContactRecord::key);
  data_.origins[id] = {key.part_a, key.part_b,
                       old == before.end() || old->is_passing() ? ContactOrigin::k_new
                                                                : world_.contacts.index_of(*old),
                       0};
  data_.notes.inputs[id] = input;
  for (std::size_t i = 0; i < k_max_manifold_points; ++i)
    data_.notes.separations[id][i] = data_.found.manifolds[id].points[i].separation;
  shift_by_pose_delta({key.body_a, key.body_b}, data_.found.manifolds[id]);
  find_surface(world_, {key.body_a, key.body_b}, surface_a, surface_b, data_.found.manifolds[id],
               data_.found.surfaces[id]);
  if (data_.found.surfaces[id].restitution > Coefficient{}) data_.ids.note_elastic();
}

void PairCollider::shift_by_pose_delta(const Pair& pair, Manifold& manifold) const {
  if (!is_found_at_recycling_poses(world_, pair)) return;
  const PoseDelta &a = world_.cache.pose_delta(pair.a), &b = world_.cache.pose_delta(pair.b);
  if (!a.is_none() || !b.is_none()) shift_manifold(a, b, manifold);
}

// Neither an asset nor without end: its frame is the body's.
bool PairCollider::is_bounded_primitive(std::uint32_t body) const {
  return world_.cache.asset(body) == nullptr &&
         world_.bodies[body].shape().kind != ShapeKind::half_space;
}

bool PairCollider::are_primitives(const Pair& pair) const {
  return is_bounded_primitive(pair.a) && is_bounded_primitive(pair.b);
}

// The manifold of a tick ago: only of pairs with a single contact, which parts 0 and 0 name.
std::uint32_t PairCollider::remembered_manifold(std::span<const ContactRecord> before) const {
  if (!world_.contacts.remembers_manifolds() || before.size() != 1) return ManifoldIds::k_none;
  const ContactRecord& record = before.front();
  const bool is_single = record.part_a == 0 && record.part_b == 0 &&
                         has_one_piece(world_, record.body_a) &&
                         has_one_piece(world_, record.body_b);
  return is_single ? world_.contacts.manifold_ids()[world_.contacts.index_of(record)]
                   : ManifoldIds::k_none;
}

void PairCollider::add_trigger(std::uint32_t index, std::span<const ContactRecord> before) {
  const std::uint32_t id = data_.ids.take(scratch_, 1);
  if (id == ManifoldIds::k_none) return;
  data_.of_pair[index] = {id, 1};
  data_.origins[id] = {
      0, 0, before.empty() ? ContactOrigin::k_new : world_.contacts.index_of(before.front()),
      k_contact_trigger};
  data_.found.manifolds[id] = {};
  data_.notes.inputs[id] = {};
  data_.found.surfaces[id] = {};
  data_.found.surfaces[id].tag_a = world_.bodies[data_.pairs[index].a].tag;
  data_.found.surfaces[id].tag_b = world_.bodies[data_.pairs[index].b].tag;
}

void PairCollider::add_contacts(std::uint32_t index, std::span<const PartContact> parts,
                                const ManifoldInput& input, std::span<const ContactRecord> before) {
  if (parts.empty()) return;
  const auto count = static_cast<std::uint32_t>(parts.size());
  const std::uint32_t first = data_.ids.take(scratch_, count);
  if (first == ManifoldIds::k_none) return;
  const Pair pair = data_.pairs[index];
  data_.of_pair[index] = {first, count};
  for (std::uint32_t i = 0; i < count; ++i) {
    const PartContact& contact = parts[i];
    data_.found.manifolds[first + i] = contact.manifold;
    fill(first + i, {pair.a, pair.b, contact.part_a, contact.part_b}, contact.surface_a,
         contact.surface_b, input, before);
  }
}

const std::vector<Mat3>& PairCollider::rotations_of(const Pair& pair) const {
  return is_found_at_recycling_poses(world_, pair) ? world_.cache.recycling_rotations()
                                                   : world_.cache.rotations();
}

}  // namespace lockstone
