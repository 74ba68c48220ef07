// Ghosts at the seams between static bodies, removed from the contacts of each moving body.

#include "core/collision/narrow_phase/seams.h"

#include <algorithm>

#include "core/world/phases/narrow/narrow_phase.h"

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

// The contacts of one moving body with static ones.
class SeamSearch {
 public:
  SeamSearch(NarrowData& data, std::uint32_t first_pair, SeamContacts& scratch)
      : data_(data),
        world_(data.world),
        first_(first_pair),
        end_(end_of(data.pairs, first_pair)),
        body_(data.pairs[first_pair].a),
        found_(scratch) {}

  void run();

 private:
  void list_contacts();
  void list_contacts_of(std::uint32_t pair);
  void judge(SeamContact& contact);
  void drop_ghosts(std::uint32_t pair);
  void move_manifold(std::uint32_t from, std::uint32_t to);
  [[nodiscard]] bool has_mesh_alone() const;
  [[nodiscard]] bool is_static(std::uint32_t pair) const;
  [[nodiscard]] bool is_passing(std::uint32_t pair) const;
  [[nodiscard]] TouchedPoint point_of(const SeamContact& contact, int point) const;
  [[nodiscard]] const std::optional<FaceOfShape>& face_of(SeamContact& contact) const;
  [[nodiscard]] bool is_covered(const SeamContact& contact) const;
  [[nodiscard]] bool is_covered(const SeamContact& contact, const TouchedPoint& at) const;
  [[nodiscard]] std::uint32_t part_of(const SeamContact& contact) const {
    return data_.origins[contact.id].part_b;
  }

  NarrowData& data_;
  const WorldData& world_;
  const std::uint32_t first_, end_;  // the body's pairs
  const std::uint32_t body_;
  SeamContacts& found_;
};

void SeamSearch::run() {
  list_contacts();
  bool any = false;
  for (SeamContact& each : found_.all()) {
    judge(each);
    any = any || each.ghost_of != SeamContact::k_none;
  }
  if (!any) return;
  break_rings(found_.all());
  for (std::uint32_t i = first_; i < end_; ++i)
    drop_ghosts(i);
}

// Then no other surface covers a contact.
bool SeamSearch::has_mesh_alone() const {
  bool any = false;
  for (std::uint32_t i = first_; i < end_; ++i) {
    if (!is_static(i)) continue;
    if (any || !is_one_mesh(world_, data_.pairs[i].b)) return false;
    any = true;
  }
  return any;
}

bool SeamSearch::is_static(std::uint32_t pair) const {
  const BodyRecord& other = world_.bodies[data_.pairs[pair].b];
  return has_seams(world_, data_.pairs[pair].b) && !other.is_trigger() &&
         !world_.bodies[body_].is_trigger();
}

bool SeamSearch::is_passing(std::uint32_t pair) const {
  const FoundContacts& found = data_.of_pair[pair];
  return found.count > 0 && (data_.origins[found.first_id].flags & k_contact_passing) != 0;
}

// Nothing is listed where all have one normal: then none can do harm.
void SeamSearch::list_contacts() {
  found_.count = 0;
  if (has_mesh_alone()) return;
  for (std::uint32_t i = first_; i < end_; ++i)
    if (data_.of_pair[i].count > 0 && is_static(i) && !is_passing(i)) list_contacts_of(i);
  const auto is_like_first = [&](const SeamContact& each) {
    return are_alike(each.normal, found_.contacts.front().normal);
  };
  if (std::ranges::all_of(found_.all(), is_like_first)) found_.count = 0;
}

void SeamSearch::list_contacts_of(std::uint32_t pair) {
  const FoundContacts& of_pair = data_.of_pair[pair];
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    if (found_.count == SeamContacts::k_capacity) return;
    const std::uint32_t id = of_pair.first_id + i;
    const Manifold& manifold = data_.found.manifolds[id];
    found_.contacts[found_.count++] = {id, data_.pairs[pair].b, -manifold.normal,
                                       least_of(data_.notes.separations[id], manifold.count)};
  }
}

// On the surface of the static body. Overlapping bodies share a point, which is round bodies' own.
TouchedPoint SeamSearch::point_of(const SeamContact& contact, int point) const {
  const auto at = static_cast<std::size_t>(point);
  const BodyRecord& record = world_.bodies[body_];
  const ManifoldPoint& found = data_.found.manifolds[contact.id].points[at];
  const Vec3<Length>& anchor = found.anchor_a;
  const bool is_recycled = is_found_at_recycling_poses(world_, {body_, contact.other});
  const Displacement separation =
      is_recycled ? data_.notes.separations[contact.id][at] : found.separation;
  const bool halves = separation.raw < 0 && !is_round(record.shape().kind);
  const Displacement way = halves ? separation / 2 : separation;
  const Vec3<Position> centre = is_recycled ? recycling_position(record) : record.position;
  return {centre + anchor - rounded<Position>(contact.normal * way), contact.normal};
}

const std::optional<FaceOfShape>& SeamSearch::face_of(SeamContact& contact) const {
  if (contact.has_looked) return contact.face;
  contact.has_looked = true;
  contact.face =
      touched_face({world_.placed(contact.other), part_of(contact)}, point_of(contact, 0));
  return contact.face;
}

// A ghost names the best contact whose face keeps the body off.
void SeamSearch::judge(SeamContact& contact) {
  const std::span<SeamContact> all = found_.all();
  const PlacedShape shape = world_.placed(contact.other);
  const Vec3<Position> at = point_of(contact, 0).point;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    SeamContact& keeper = all[i];
    if (&keeper == &contact || are_alike(keeper.normal, contact.normal)) continue;
    if (data_.origins[keeper.id].part_a != data_.origins[contact.id].part_a) continue;
    const std::optional<FaceOfShape>& face = face_of(keeper);
    if (!face || !is_below({shape, part_of(contact)}, at, *face)) continue;
    if (contact.ghost_of == SeamContact::k_none || keeps_better(all, i, contact.ghost_of))
      contact.ghost_of = i;
  }
  if (contact.ghost_of == SeamContact::k_none) return;
  if (!is_covered(contact)) contact.ghost_of = SeamContact::k_none;
}

// The points that are farther apart than the nearest are there because slanted faces were clipped.
bool SeamSearch::is_covered(const SeamContact& contact) const {
  for (int i = 0; i < data_.found.manifolds[contact.id].count; ++i) {
    const Displacement separation =
        data_.notes.separations[contact.id][static_cast<std::size_t>(i)];
    if (separation > contact.separation + k_slant) continue;
    if (!is_covered(contact, point_of(contact, i))) return false;
  }
  return true;
}

// By any static body that the moving one may touch. A mesh knows the ghosts among its own edges.
bool SeamSearch::is_covered(const SeamContact& contact, const TouchedPoint& at) const {
  const Bounds near = bounds_of_way(at.point, at.point, k_seam_width);
  for (std::uint32_t i = first_; i < end_; ++i) {
    const std::uint32_t other = data_.pairs[i].b;
    if (!is_static(i) || !overlap(near, world_.broad_phase.bounds(other))) continue;
    const bool is_own = other == contact.other;
    if (is_own && is_one_mesh(world_, other)) continue;
    if (world_.are_exempt(body_, other) || is_passing(i)) continue;
    const std::uint32_t except = is_own ? part_of(contact) : k_no_part;
    if (covers(world_.placed(other), except, at, world_.bodies[body_].position)) return true;
  }
  return false;
}

// The contacts that stay move up to the pair's first ids.
void SeamSearch::drop_ghosts(std::uint32_t pair) {
  FoundContacts& of_pair = data_.of_pair[pair];
  const auto is_ghost = [&](std::uint32_t id) {
    const auto at = std::ranges::find(found_.all(), id, &SeamContact::id);
    return at != found_.all().end() && at->ghost_of != SeamContact::k_none;
  };
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    const std::uint32_t from = of_pair.first_id + i, to = of_pair.first_id + kept;
    if (is_ghost(from)) continue;
    ++kept;
    if (from != to) move_manifold(from, to);
  }
  data_.ids.note_dropped(of_pair.count - kept);
  of_pair.count = kept;
}

void SeamSearch::move_manifold(std::uint32_t from, std::uint32_t to) {
  data_.origins[to] = data_.origins[from];
  data_.found.manifolds[to] = data_.found.manifolds[from];
  data_.notes.inputs[to] = data_.notes.inputs[from];
  data_.notes.separations[to] = data_.notes.separations[from];
  data_.found.surfaces[to] = data_.found.surfaces[from];
}

}  // namespace

// The pairs of a body follow one another; the worker with the first of them does all.
void remove_seams(NarrowData& data) {
  const std::span<const Pair> pairs = data.pairs;
  data.world.parallel.for_each({static_cast<std::uint32_t>(pairs.size()), k_seam_grain},
                               [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
                                 for (std::uint32_t i = first; i < end; ++i) {
                                   if (i > 0 && pairs[i - 1].a == pairs[i].a) continue;
                                   SeamSearch(data, i, data.ids.scratch(worker).seams).run();
                                 }
                               });
}

}  // namespace lockstone
