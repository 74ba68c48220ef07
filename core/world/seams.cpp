// Ghosts at the seams between static bodies, removed from the contacts of each moving body.

#include "core/collision/seams.h"

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

}  // namespace

// The pairs of a body follow one another; whoever has the first of them does all.
void World::Impl::remove_seams() {
  if (!narrow.has_seams()) return;
  const auto pair_count = static_cast<std::uint32_t>(pairs.size());
  parallel.for_each({pair_count, k_seam_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
                      for (std::uint32_t i = first; i < end; ++i) {
                        if (i > 0 && pairs[i - 1].a == pairs[i].a) continue;
                        remove_seams_of(i, narrow.scratch(worker).seams);
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

bool World::Impl::is_static_pair(std::uint32_t pair) const {
  const BodyRecord& other = bodies[pairs[pair].b];
  return !other.moves() && !other.is_trigger() && !bodies[pairs[pair].a].is_trigger();
}

// `first`: the first pair of a body.
void World::Impl::remove_seams_of(std::uint32_t first, SeamContacts& scratch) {
  std::uint32_t end = first;
  while (end < pairs.size() && pairs[end].a == pairs[first].a)
    ++end;
  list_static_contacts(first, end, scratch);
  const std::span<SeamContact> all = scratch.all();
  bool any = false;
  for (SeamContact& each : all) {
    judge_seam(first, end, each, all);
    any = any || each.ghost_of != SeamContact::k_none;
  }
  if (!any) return;
  break_rings(all);
  for (std::uint32_t i = first; i < end; ++i)
    drop_ghosts(i, all);
}

// Nothing is listed where all have one normal: then none can do harm.
void World::Impl::list_static_contacts(std::uint32_t first, std::uint32_t end,
                                       SeamContacts& out) const {
  out.count = 0;
  bool differ = false;
  for (std::uint32_t i = first; i < end; ++i) {
    const FoundContacts& found = found_contacts[i];
    if (found.count == 0 || !is_static_pair(i)) continue;
    for (std::uint32_t slot = found.slot; slot < found.slot + found.count; ++slot) {
      if (out.count == SeamContacts::k_capacity) break;
      const Manifold& manifold = manifolds[slot];
      SeamContact& contact = out.contacts[out.count++];
      contact = {slot, pairs[i].b, -manifold.normal,
                 least_of(found_separations[slot], manifold.count)};
      differ = differ || !are_alike(contact.normal, out.contacts.front().normal);
    }
  }
  if (!differ) out.count = 0;
}

// On the surface of the static body. Overlapping bodies share a point, which is round bodies' own.
TouchedPoint World::Impl::touched_point(std::uint32_t body, const SeamContact& contact,
                                        int point) const {
  const auto at = static_cast<std::size_t>(point);
  const Vec3<Length>& anchor = manifolds[contact.slot].points[at].anchor_a;
  const Displacement separation = found_separations[contact.slot][at];
  const bool halves = separation.raw < 0 && !is_round(bodies[body].shape().kind);
  const Displacement way = halves ? separation / 2 : separation;
  const Vec3<Position> centre = is_found_at_contact_poses({body, contact.other})
                                    ? contact_position(bodies[body])
                                    : bodies[body].position;
  return {centre + anchor - rounded<Position>(contact.normal * way), contact.normal};
}

const std::optional<FaceOfShape>& World::Impl::face_of(std::uint32_t body,
                                                       SeamContact& contact) const {
  if (contact.has_looked) return contact.face;
  contact.has_looked = true;
  contact.face = touched_face({placed(contact.other), origins[contact.slot].part_b},
                              touched_point(body, contact, 0));
  return contact.face;
}

// A ghost names the best contact whose face keeps the body off.
void World::Impl::judge_seam(std::uint32_t first, std::uint32_t end, SeamContact& contact,
                             std::span<SeamContact> all) const {
  const std::uint32_t body = pairs[first].a;
  const PlacedShape shape = placed(contact.other);
  const TouchedPart part{shape, origins[contact.slot].part_b};
  const Vec3<Position> at = touched_point(body, contact, 0).point;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    SeamContact& keeper = all[i];
    if (&keeper == &contact || are_alike(keeper.normal, contact.normal)) continue;
    if (origins[keeper.slot].part_a != origins[contact.slot].part_a) continue;
    const std::optional<FaceOfShape>& face = face_of(body, keeper);
    if (!face || !is_below(part, at, *face)) continue;
    if (contact.ghost_of == SeamContact::k_none || keeps_better(all, i, contact.ghost_of))
      contact.ghost_of = i;
  }
  if (contact.ghost_of == SeamContact::k_none) return;
  if (!is_covered(first, end, contact)) contact.ghost_of = SeamContact::k_none;
}

// The points that are farther apart than the nearest are there because slanted faces were clipped.
bool World::Impl::is_covered(std::uint32_t first, std::uint32_t end,
                             const SeamContact& contact) const {
  for (int i = 0; i < manifolds[contact.slot].count; ++i) {
    const Displacement separation = found_separations[contact.slot][static_cast<std::size_t>(i)];
    if (separation > contact.separation + k_slant) continue;
    if (!is_covered(first, end, contact, touched_point(pairs[first].a, contact, i))) return false;
  }
  return true;
}

bool World::Impl::is_covered(std::uint32_t first, std::uint32_t end, const SeamContact& contact,
                             const TouchedPoint& at) const {
  const Bounds near = bounds_of_way(at.point, at.point, k_seam_width);
  for (std::uint32_t i = first; i < end; ++i) {
    const std::uint32_t other = pairs[i].b;
    if (!is_static_pair(i) || !overlap(near, broad_phase.bounds(other))) continue;
    const bool is_own = other == contact.other;
    const bool has_triangles =
        body_assets[other] != nullptr && body_assets[other]->mesh_kernels() != nullptr;
    if (has_triangles && is_own) continue;
    if (!joined_pairs.empty() && are_joined(pairs[i].a, other)) continue;
    const std::uint32_t except = is_own ? origins[contact.slot].part_b : k_no_part;
    if (covers(placed(other), except, at, bodies[pairs[i].a].position)) return true;
  }
  return false;
}

// The contacts that stay move up to the pair's first slots.
void World::Impl::drop_ghosts(std::uint32_t pair, std::span<const SeamContact> all) {
  FoundContacts& found = found_contacts[pair];
  const auto is_ghost = [&](std::uint32_t slot) {
    const auto at = std::ranges::find(all, slot, &SeamContact::slot);
    return at != all.end() && at->ghost_of != SeamContact::k_none;
  };
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < found.count; ++i) {
    const std::uint32_t from = found.slot + i, to = found.slot + kept;
    if (is_ghost(from)) continue;
    ++kept;
    if (from != to) move_slot(from, to);
  }
  narrow.note_dropped(found.count - kept);
  found.count = kept;
}

void World::Impl::move_slot(std::uint32_t from, std::uint32_t to) {
  origins[to] = origins[from];
  manifolds[to] = manifolds[from];
  inputs[to] = inputs[from];
  found_separations[to] = found_separations[from];
  surfaces[to] = surfaces[from];
}

}  // namespace lockstone
