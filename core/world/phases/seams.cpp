// Ghosts at the seams between static bodies, removed from the contacts of each moving body.

#include "core/collision/narrow_phase/seams.h"

#include <algorithm>

#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_seam_grain = 64;

// Points that much farther apart than the nearest say nothing of the edge that is met.
constexpr Displacement k_slant = Displacement::from_ratio(1, 2000);

bool is_round(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::capsule;
}

bool is_on_face(const SeamContact& contact) {
  return contact.face && are_alike(contact.face->normal, contact.normal);
}

// First those whose normals are their faces', then by separation, then by key.
bool keeps_better(std::span<const SeamContact> all, std::uint32_t a, std::uint32_t b) {
  if (is_on_face(all[a]) != is_on_face(all[b])) return is_on_face(all[a]);
  return all[a].separation != all[b].separation ? all[a].separation < all[b].separation : a < b;
}

// Of contacts that are ghosts of one another the best stays, so that nothing falls through.
void break_rings(std::span<SeamContact> all) {
  for (std::uint32_t first = 0; first < all.size(); ++first) {
    std::uint32_t best = first, at = all[first].ghost_of;
    for (std::size_t steps = 0; steps < all.size() && at != SeamContact::k_none && at != first;
         ++steps) {
      if (keeps_better(all, at, best)) best = at;
      at = all[at].ghost_of;
    }
    if (at == first) all[best].ghost_of = SeamContact::k_none;
  }
}

Displacement least_of(const std::array<Displacement, k_max_manifold_points>& separations,
                      int count) {
  return *std::min_element(separations.begin(), separations.begin() + count);
}

std::uint32_t end_of(std::span<const Pair> pairs, std::uint32_t first) {
  std::uint32_t end = first;
  while (end < pairs.size() && pairs[end].a == pairs[first].a)
    ++end;
  return end;
}

}  // namespace

// The contacts of one moving body with static ones.
struct World::Impl::SeamSearch {
  Impl& world;
  const std::uint32_t first, end;  // the body's pairs
  const std::uint32_t body;
  SeamContacts& found;

  SeamSearch(Impl& of, std::uint32_t first_pair, SeamContacts& scratch)
      : world(of),
        first(first_pair),
        end(end_of(of.pairs, first_pair)),
        body(of.pairs[first_pair].a),
        found(scratch) {}

  void run();

 private:
  void list_contacts();
  void list_contacts_of(std::uint32_t pair);
  void judge(SeamContact& contact);
  void drop_ghosts(std::uint32_t pair);
  void move_slot(std::uint32_t from, std::uint32_t to);
  [[nodiscard]] bool is_static(std::uint32_t pair) const;
  [[nodiscard]] TouchedPoint point_of(const SeamContact& contact, int point) const;
  [[nodiscard]] const std::optional<FaceOfShape>& face_of(SeamContact& contact) const;
  [[nodiscard]] bool is_covered(const SeamContact& contact) const;
  [[nodiscard]] bool is_covered(const SeamContact& contact, const TouchedPoint& at) const;
  [[nodiscard]] std::uint32_t part_of(const SeamContact& contact) const {
    return world.origins[contact.slot].part_b;
  }
};

void World::Impl::SeamSearch::run() {
  list_contacts();
  bool any = false;
  for (SeamContact& each : found.all()) {
    judge(each);
    any = any || each.ghost_of != SeamContact::k_none;
  }
  if (!any) return;
  break_rings(found.all());
  for (std::uint32_t i = first; i < end; ++i)
    drop_ghosts(i);
}

bool World::Impl::SeamSearch::is_static(std::uint32_t pair) const {
  const BodyRecord& other = world.bodies[world.pairs[pair].b];
  return !other.moves() && !other.is_trigger() && !world.bodies[body].is_trigger();
}

// Nothing is listed where all have one normal: then none can do harm.
void World::Impl::SeamSearch::list_contacts() {
  found.count = 0;
  for (std::uint32_t i = first; i < end; ++i)
    if (world.found_contacts[i].count > 0 && is_static(i)) list_contacts_of(i);
  const auto is_like_first = [&](const SeamContact& each) {
    return are_alike(each.normal, found.contacts.front().normal);
  };
  if (std::ranges::all_of(found.all(), is_like_first)) found.count = 0;
}

void World::Impl::SeamSearch::list_contacts_of(std::uint32_t pair) {
  const FoundContacts& of_pair = world.found_contacts[pair];
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    if (found.count == SeamContacts::k_capacity) return;
    const std::uint32_t slot = of_pair.slot + i;
    const Manifold& manifold = world.manifolds[slot];
    found.contacts[found.count++] = {slot, world.pairs[pair].b, -manifold.normal,
                                     least_of(world.found_separations[slot], manifold.count)};
  }
}

// On the surface of the static body. Overlapping bodies share a point, which is round bodies' own.
TouchedPoint World::Impl::SeamSearch::point_of(const SeamContact& contact, int point) const {
  const auto at = static_cast<std::size_t>(point);
  const BodyRecord& record = world.bodies[body];
  const Vec3<Length>& anchor = world.manifolds[contact.slot].points[at].anchor_a;
  const Displacement separation = world.found_separations[contact.slot][at];
  const bool halves = separation.raw < 0 && !is_round(record.shape().kind);
  const Displacement way = halves ? separation / 2 : separation;
  const bool may_drift = world.is_found_at_contact_poses({body, contact.other});
  const Vec3<Position> centre = may_drift ? contact_position(record) : record.position;
  return {centre + anchor - rounded<Position>(contact.normal * way), contact.normal};
}

const std::optional<FaceOfShape>& World::Impl::SeamSearch::face_of(SeamContact& contact) const {
  if (contact.has_looked) return contact.face;
  contact.has_looked = true;
  contact.face =
      touched_face({world.placed(contact.other), part_of(contact)}, point_of(contact, 0));
  return contact.face;
}

// A ghost names the best contact whose face keeps the body off.
void World::Impl::SeamSearch::judge(SeamContact& contact) {
  const std::span<SeamContact> all = found.all();
  const PlacedShape shape = world.placed(contact.other);
  const Vec3<Position> at = point_of(contact, 0).point;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    SeamContact& keeper = all[i];
    if (&keeper == &contact || are_alike(keeper.normal, contact.normal)) continue;
    if (world.origins[keeper.slot].part_a != world.origins[contact.slot].part_a) continue;
    const std::optional<FaceOfShape>& face = face_of(keeper);
    if (!face || !is_below({shape, part_of(contact)}, at, *face)) continue;
    if (contact.ghost_of == SeamContact::k_none || keeps_better(all, i, contact.ghost_of))
      contact.ghost_of = i;
  }
  if (contact.ghost_of == SeamContact::k_none) return;
  if (!is_covered(contact)) contact.ghost_of = SeamContact::k_none;
}

// The points that are farther apart than the nearest are there because slanted faces were clipped.
bool World::Impl::SeamSearch::is_covered(const SeamContact& contact) const {
  for (int i = 0; i < world.manifolds[contact.slot].count; ++i) {
    const Displacement separation =
        world.found_separations[contact.slot][static_cast<std::size_t>(i)];
    if (separation > contact.separation + k_slant) continue;
    if (!is_covered(contact, point_of(contact, i))) return false;
  }
  return true;
}

// By any static body that the moving one may touch. A mesh knows the ghosts among its own edges.
bool World::Impl::SeamSearch::is_covered(const SeamContact& contact, const TouchedPoint& at) const {
  const Bounds near = bounds_of_way(at.point, at.point, k_seam_width);
  for (std::uint32_t i = first; i < end; ++i) {
    const std::uint32_t other = world.pairs[i].b;
    if (!is_static(i) || !overlap(near, world.broad_phase.bounds(other))) continue;
    const Asset* asset = world.cache.asset(other);
    const bool is_own = other == contact.other;
    if (is_own && asset != nullptr && asset->mesh_kernels() != nullptr) continue;
    if (!world.joint_graph.exempt_pairs().empty() && world.are_joined(body, other)) continue;
    const std::uint32_t except = is_own ? part_of(contact) : k_no_part;
    if (covers(world.placed(other), except, at, world.bodies[body].position)) return true;
  }
  return false;
}

// The contacts that stay move up to the pair's first slots.
void World::Impl::SeamSearch::drop_ghosts(std::uint32_t pair) {
  FoundContacts& of_pair = world.found_contacts[pair];
  const auto is_ghost = [&](std::uint32_t slot) {
    const auto at = std::ranges::find(found.all(), slot, &SeamContact::slot);
    return at != found.all().end() && at->ghost_of != SeamContact::k_none;
  };
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    const std::uint32_t from = of_pair.slot + i, to = of_pair.slot + kept;
    if (is_ghost(from)) continue;
    ++kept;
    if (from != to) move_slot(from, to);
  }
  world.narrow.note_dropped(of_pair.count - kept);
  of_pair.count = kept;
}

void World::Impl::SeamSearch::move_slot(std::uint32_t from, std::uint32_t to) {
  world.origins[to] = world.origins[from];
  world.manifolds[to] = world.manifolds[from];
  world.inputs[to] = world.inputs[from];
  world.found_separations[to] = world.found_separations[from];
  world.surfaces[to] = world.surfaces[from];
}

// The pairs of a body follow one another; the worker with the first of them does all.
void World::Impl::remove_seams() {
  if (!narrow.has_seams()) return;
  const auto pair_count = static_cast<std::uint32_t>(pairs.size());
  parallel.for_each({pair_count, k_seam_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
                      for (std::uint32_t i = first; i < end; ++i) {
                        if (i > 0 && pairs[i - 1].a == pairs[i].a) continue;
                        SeamSearch(*this, i, narrow.scratch(worker).seams).run();
                      }
                    });
}

// `beside_static`: the pair before, if it is of the same body, may be preceded by one with a static
// body, or be one. Returns the same for the next pair.
bool World::Impl::look_for_seam(std::uint32_t pair, bool beside_static) {
  const Pair& both = pairs[pair];
  const bool goes_on = beside_static && pair > 0 && pairs[pair - 1].a == both.a;
  if (bodies[both.b].moves()) return goes_on;
  if (goes_on || !has_one_piece(both.b)) narrow.note_seams();
  return true;
}

}  // namespace lockstone
