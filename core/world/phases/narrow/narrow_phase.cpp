// The narrow phase of a tick: contacts of the pairs that the broad phase found, recomputed or kept
// from the tick before.

#include "core/world/phases/narrow/narrow_phase.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

#include "core/geometry/dispatch/collide.h"
#include "core/math/roots.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/narrow/pair_collider.h"

namespace lockstone {
namespace {

// Largest speculative distance, so that Displacement holds it.
constexpr Length k_max_speculation = Length::from_integer(32);

// How far a pair can close is rounded up to 1 mm, so that a trembling body keeps its margin.
constexpr int k_reach_bits = 10;

// Pairs, and bodies, that are worth a worker.
constexpr std::uint32_t k_pair_grain = 8, k_body_grain = 64;
constexpr std::uint32_t k_number_piece = 256;

// The way of a speed in a tick, m/s, Q32; rounded up to 1 mm.
Length way_in_tick(const TimeStep& step, std::int64_t speed) {
  constexpr std::int64_t k_below_step = (std::int64_t{1} << k_reach_bits) - 1;
  const std::int64_t steps = ((step.tick.times(speed) >> 12) + k_below_step) >> k_reach_bits;
  return Length::from_raw(raw::saturate<std::int32_t>(steps << k_reach_bits));
}

// Nothing is behind a half-space.
Length thickness_of(const WorldData& world, std::uint32_t body) {
  const bool is_endless = world.bodies[body].shape().kind == ShapeKind::half_space;
  return is_endless ? k_max_speculation : world.cache.inner_radius(body);
}

}  // namespace

// How far ahead a pair must look: as far as it can close in one tick. Where bodies pass each other,
// no farther than they are thick, or a glancing pass would be taken for a hit.
Length margin_of(const WorldData& world, const Pair& pair) {
  return margin_of(world, pair, turning_speed(world, pair.a) + turning_speed(world, pair.b));
}

Length margin_of(const WorldData& world, const Pair& pair, std::int64_t turning) {
  const Vec3<Velocity> passing = world.bodies[pair.a].velocity - world.bodies[pair.b].velocity;
  const Length reach =
      max(way_in_tick(world.time_step, norm_bound(passing.x.raw, passing.y.raw, passing.z.raw)),
          Length::from_raw(1 << k_reach_bits));
  const Length thickness = max(thickness_of(world, pair.a), thickness_of(world, pair.b));
  const Length turn = way_in_tick(world.time_step, turning);
  return k_contact_margin +
         min(min(reach, thickness) + min(turn, k_max_speculation), k_max_speculation);
}

NarrowPhase::NarrowPhase(WorldData& world, TickContacts& found) : data_(world, found) {
  data_.turning_speeds.resize(world.def.body_capacity);
  data_.of_pair.reserve(world.def.pair_capacity);
  data_.separating_axes.reserve(world.def.pair_capacity);
  make_room();
}

void NarrowPhase::make_room() {
  const auto has_triangles = [](const AssetPtr& asset) {
    return asset->geometry().mesh_kernels() != nullptr;
  };
  data_.ids.prepare(data_.world.def.contact_capacity, data_.world.parallel.workers(),
                    std::ranges::any_of(data_.world.assets->all(), has_triangles));
  const std::size_t most = data_.ids.capacity();
  if (data_.origins.size() >= most) return;
  data_.origins.resize(most);
  data_.found.manifolds.resize(most);
  data_.found.surfaces.resize(most);
  data_.manifolds_before.resize(most);
  for (ManifoldNotes* notes : {&data_.notes, &data_.notes_before}) {
    notes->inputs.resize(most);
    notes->separations.resize(most);
  }
}

Length NarrowPhase::margin_of(const Pair& pair) const {
  return lockstone::margin_of(data_.world, pair);
}

// Each pair leaves its manifolds in places of its own; then the contacts are numbered in the order
// of the pairs.
void NarrowPhase::run(std::span<const Pair> pairs, StepReport& report) {
  const StageTimer timer(data_.world.profiler, StepStage::collide);
  data_.pairs = pairs;
  std::swap(data_.found.manifolds, data_.manifolds_before);
  std::swap(data_.notes, data_.notes_before);
  data_.of_pair.resize(pairs.size());
  data_.separating_axes.begin(pairs.size());
  find_turning_speeds();
  if (!collide_side_by_side()) collide_one_by_one();
  if (data_.ids.has_overflowed()) report.status = Status::capacity_exhausted;
  data_.found.has_elastic = data_.ids.has_elastic();
  if (data_.ids.has_seams()) remove_seams(data_);
  number_contacts(report);
}

bool NarrowPhase::meet(const Pair& pair) {
  WorldData& world = data_.world;
  const BodyRecord &a = world.bodies[pair.a], &b = world.bodies[pair.b];
  if (a.is_trigger() || b.is_trigger() || are_ignored(world, pair.a, pair.b)) return false;
  PartContacts& parts = scratch().part_contacts;
  PairCollider(data_, scratch()).collide_all_parts(pair, parts);
  return parts.count > 0;
}

bool NarrowPhase::are_passing(std::uint32_t a, std::uint32_t b) const {
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  const Pair pair = data_.world.pair_of(a, b);
  const std::vector<ContactRecord>& records = data_.found.records;
  const auto at = std::ranges::lower_bound(records, pair, {}, bodies_of);
  return at != records.end() && bodies_of(*at) == pair && at->is_passing();
}

// Once for each body, unless most are in no pair.
void NarrowPhase::find_turning_speeds() {
  const std::span<const std::uint32_t> awake = data_.world.awake.list();
  data_.knows_turning_speeds = awake.size() <= data_.pairs.size();
  if (!data_.knows_turning_speeds) return;
  data_.world.parallel.for_each({static_cast<std::uint32_t>(awake.size()), k_body_grain},
                                [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                                  for (const std::uint32_t body : awake.subspan(first, end - first))
                                    data_.turning_speeds[body] = turning_speed(data_.world, body);
                                });
}

// Returns whether all manifolds found room.
bool NarrowPhase::collide_side_by_side() {
  data_.ids.begin(data_.world.parallel.workers(), !data_.world.profiler.times_pairs());
  data_.world.parallel.for_each({static_cast<std::uint32_t>(data_.pairs.size()), k_pair_grain,
                                 data_.world.profiler.times_pairs()},
                                [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
                                  collide_piece(first, end, data_.ids.scratch(worker));
                                });
  return !data_.ids.is_out_of_ids();
}

// Ids are given out in the order of the pairs, so that the last pairs are those that find none.
void NarrowPhase::collide_one_by_one() {
  data_.ids.begin(1, false);
  collide_piece(0, static_cast<std::uint32_t>(data_.pairs.size()), data_.ids.scratch(0));
}

// Old contacts are sorted by key and pairs are too, so that one pass carries records over.
void NarrowPhase::collide_piece(std::uint32_t first, std::uint32_t end, PairScratch& scratch) {
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  const std::span<const ContactRecord> all = data_.world.contacts.active();
  const auto begin = std::ranges::lower_bound(all, data_.pairs[first], {}, bodies_of);
  std::span<const ContactRecord> before(begin, all.end());
  const std::span<const Pair> exempt_pairs = data_.world.joint_graph.exempt_pairs();
  auto exempt = std::ranges::lower_bound(exempt_pairs, data_.pairs[first]);
  PairCollider collider(data_, scratch);
  SeparatingAxes::Reader last_axes = data_.separating_axes.read_from(data_.pairs[first]);
  bool beside_static = first > 0;  // a static body may come before
  for (std::uint32_t i = first; i < end; ++i) {
    beside_static = look_for_seam(i, beside_static);
    data_.of_pair[i] = {};
    data_.separating_axes.note(i, data_.pairs[i], {});
    while (exempt != exempt_pairs.end() && *exempt < data_.pairs[i])
      ++exempt;
    if (exempt != exempt_pairs.end() && *exempt == data_.pairs[i]) continue;
    if (are_ignored(data_.world, data_.pairs[i].a, data_.pairs[i].b)) continue;
    while (!before.empty() && bodies_of(before.front()) < data_.pairs[i])
      before = before.subspan(1);
    std::size_t known = 0;
    while (known < before.size() && bodies_of(before[known]) == data_.pairs[i])
      ++known;
    collider.collide(i, before.first(known), last_axes.axis_of(data_.pairs[i]));
    before = before.subspan(known);
  }
  collider.finish();
}

// `beside_static`: the pair before, if it is of the same body, may be preceded by one with a static
// body, or be one. Returns the same for the next pair.
bool NarrowPhase::look_for_seam(std::uint32_t pair, bool beside_static) {
  const Pair& both = data_.pairs[pair];
  const bool goes_on = beside_static && pair > 0 && data_.pairs[pair - 1].a == both.a;
  if (!has_seams(data_.world, both.b)) return goes_on;
  const bool is_one = has_one_piece(data_.world, both.b) || is_one_mesh(data_.world, both.b);
  if (goes_on || !is_one) data_.ids.note_seams();
  return true;
}

// In pieces: the first pass counts, the second writes where the contacts of the pieces before end.
// Between them the index of a piece's first pair is that of the piece. The last pairs are those
// that find no room.
void NarrowPhase::number_contacts(StepReport& report) {
  const std::uint32_t room = data_.world.contacts.active_capacity();
  const auto pair_count = static_cast<std::uint32_t>(data_.pairs.size());
  const std::uint32_t pieces = (pair_count + k_number_piece - 1) / k_number_piece;
  const auto count = [&](std::uint32_t first, std::uint32_t end) {
    std::uint32_t sum = 0;
    for (std::uint32_t i = first; i < end; ++i)
      sum += data_.of_pair[i].count;
    data_.of_pair[first].index = sum;
  };
  const auto add_up = [&] {
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < pair_count; i += k_number_piece)
      sum = std::min(sum + std::exchange(data_.of_pair[i].index, sum), room);
    data_.found.resize(sum);
  };
  const auto number = [&](std::uint32_t first, std::uint32_t end) {
    std::uint32_t index = data_.of_pair[first].index;
    for (std::uint32_t i = first; i < end; ++i) {
      FoundContacts& of_pair = data_.of_pair[i];
      of_pair.count = std::min(of_pair.count, room - index);
      of_pair.index = index;
      index += of_pair.count;
      number_contacts_of(i);
    }
  };
  const Loop loops[] = {{pieces, 1}, {1, 1, true}, {pieces, 1}};
  data_.world.parallel.run_all(
      loops, [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
        if (loop == 1) return add_up();
        for (std::uint32_t piece = first; piece < end; ++piece) {
          const std::uint32_t begin = piece * k_number_piece;
          const std::uint32_t stop = std::min(begin + k_number_piece, pair_count);
          loop == 0 ? count(begin, stop) : number(begin, stop);
        }
      });
  if (data_.ids.taken() > data_.found.records.size()) report.status = Status::capacity_exhausted;
}

// A record keeps the impulses and the touching flag of the tick before.
void NarrowPhase::number_contacts_of(std::uint32_t pair) {
  const FoundContacts& of_pair = data_.of_pair[pair];
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    const std::uint32_t id = of_pair.first_id + i;
    const ContactOrigin& origin = data_.origins[id];
    const Pair& both = data_.pairs[pair];
    ContactRecord& record = data_.found.records[of_pair.index + i];
    if (origin.before == ContactOrigin::k_new)
      record = {};
    else
      record = data_.world.contacts.active()[origin.before];
    record.body_a = both.a;
    record.body_b = both.b;
    record.part_a = origin.part_a;
    record.part_b = origin.part_b;
    record.flags = static_cast<std::uint16_t>(record.flags | origin.flags);
    data_.found.manifold_ids[of_pair.index + i] = id;
    data_.found.approach_speeds[of_pair.index + i] = {};
  }
}

}  // namespace lockstone
