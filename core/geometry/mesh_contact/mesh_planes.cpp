// Contacts with triangles of one plane and one surface become one manifold.
#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "core/base/unset_array.h"
#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/mesh_contact/face_plane.h"
#include "core/geometry/mesh_contact/mesh_contacts.h"

namespace lockstone::geometry {
namespace {

/// Features that are not the shape's own.
constexpr std::uint32_t k_foreign = std::uint32_t{1} << 31;

std::optional<std::uint32_t> polytope_vertex(const Polytope& polytope, const RawVec& local) {
  for (std::uint32_t i = 0; i < polytope.vertices.size(); ++i) {
    const RawVec v = fine(polytope.vertices[i]);
    if (is_at(v.x, local.x) && is_at(v.y, local.y) && is_at(v.z, local.z)) return i;
  }
  return std::nullopt;
}

/// Which vertex of the shape a point of its core is at, if any. The core of a sphere is one point.
std::optional<std::uint32_t> vertex_of(const PosedShape& posed, const RawVec& core) {
  if (posed.polytope != nullptr) return polytope_vertex(*posed.polytope, core);
  return traits_of(posed.shape).vertex_at(posed.shape, core);
}

std::uint32_t foreign_feature(std::uint32_t part, std::uint32_t feature) {
  return k_foreign | ((part * 0x9e3779b1U) ^ (feature * 0x85ebca6bU));
}

std::uint32_t feature_of(const TriangleContact& contact, const ManifoldPoint& point,
                         const MeshContactFrame& frame) {
  const PosedShape& posed = frame.shape;
  const RawVec on_b =
      witness_on_b(contact.manifold, point, posed.shape, frame.offset) - fine(frame.offset);
  const RawVec core = on_b + along(contact.manifold.normal, core_radius(posed));
  const auto vertex = vertex_of(posed, along_columns(posed.rotation, core));
  return vertex ? *vertex : foreign_feature(contact.part, point.feature);
}

// Planes ------------------------------------------------------------------------------------------

/// A component of a unit vector in 1/64, from 0.
std::uint32_t in_sixty_fourths(Unit x) {
  return static_cast<std::uint32_t>(raw::round_shift(x.raw, Unit::frac_bits - 6) + 64);
}

/// Which normals belong together.
std::uint32_t plane_of(const Vec3<Unit>& normal) {
  return in_sixty_fourths(normal.x) << 16 | in_sixty_fourths(normal.y) << 8 |
         in_sixty_fourths(normal.z);
}

/// Surfaces by value; none first.
auto surface_key(const Surface* surface) {
  constexpr Surface k_none{{}, {}};
  const Surface& s = surface == nullptr ? k_none : *surface;
  return std::tuple(surface != nullptr, s.friction.raw, s.restitution.raw, s.rolling_resistance.raw,
                    s.tag, s.friction_rule, s.restitution_rule, s.rolling_rule);
}

/// The same for equal surfaces; 0 for none.
std::uint32_t surface_byte(const Surface* surface) {
  if (surface == nullptr) return 0;
  const auto friction = static_cast<std::uint32_t>(surface->friction.raw);
  const auto restitution = static_cast<std::uint32_t>(surface->restitution.raw);
  const auto rolling = static_cast<std::uint32_t>(surface->rolling_resistance.raw);
  const auto rules = static_cast<std::uint32_t>(surface->friction_rule) |
                     static_cast<std::uint32_t>(surface->restitution_rule) << 3 |
                     static_cast<std::uint32_t>(surface->rolling_rule) << 6;
  return 1 + ((friction * 0x9e3779b1U) ^ (restitution * 0x85ebca6bU) ^ (rolling * 0xc2b2ae35U) ^
              (surface->tag * 0x27d4eb2fU) ^ (rules * 0x165667b1U)) %
                 255;
}

/// The axis that a normal is nearest to, the first of equals.
int dominant_axis(const Vec3<Unit>& normal) {
  int dominant = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (abs(normal[axis]) > abs(normal[dominant])) dominant = axis;
  return dominant;
}

/// Places that count differ by less than 2^30 with this shift.
constexpr int k_wide_shift = k_fine_per_length + 3;

/// Twice the area of a wide triangle among the vertices: of the first, the one farthest from it,
/// and the one farthest from the line through both.
std::int64_t wide_area(std::span<const FaceVertex> vertices) {
  const FaceVertex& first = vertices.front();
  const auto way = [&](const FaceVertex& v) {
    return std::pair(raw::round_shift(v.x - first.x, k_wide_shift),
                     raw::round_shift(v.y - first.y, k_wide_shift));
  };
  std::pair<std::int64_t, std::int64_t> far{};
  std::int64_t square = 0, area = 0;
  for (const FaceVertex& v : vertices) {
    const auto [x, y] = way(v);
    if (x * x + y * y <= square) continue;
    square = x * x + y * y;
    far = {x, y};
  }
  for (const FaceVertex& v : vertices) {
    const auto [x, y] = way(v);
    const std::int64_t spanned = far.first * y - far.second * x;
    area = std::max(area, spanned < 0 ? -spanned : spanned);
  }
  return area;
}

/// Brings the chosen vertices to the front and returns them.
template <class IsChosen>
std::span<FaceVertex> chosen_ones(std::span<FaceVertex> all, IsChosen&& is_chosen) {
  const auto rest = std::partition(all.begin(), all.end(), is_chosen);
  return all.first(static_cast<std::size_t>(rest - all.begin()));
}

/// Whether some of the vertices span at least this part of the area of all, in sixteenths.
bool are_wide(std::span<const FaceVertex> some, std::span<const FaceVertex> all, int sixteenths) {
  return some.size() >= 3 && wide_area(some) >= wide_area(all) / 16 * sixteenths;
}

/// The vertices that support the shape, of more than four. First the shape's own, since its edges
/// reach no lower between them, where they are as wide as all. Of these those on the plane or
/// within k_low of the deepest, where they are a quarter as wide: a fast shape has a wide margin,
/// and vertices high above the plane, which may be farther apart, must not take the place of those
/// that it lies on. A shape that stands on a corner or an edge lies on none, and may fall.
std::span<FaceVertex> supporting_ones(std::span<FaceVertex> all) {
  constexpr Fine k_low = Fine{1} << (k_fine_bits - 8);  // 3.9 mm
  if (all.size() <= 4) return all;
  const auto own = chosen_ones(all, [](const FaceVertex& v) { return v.feature < k_foreign; });
  const auto these = are_wide(own, all, 15) ? own : all;
  if (these.size() <= 4) return these;
  const Fine deepest = std::ranges::min_element(these, {}, &FaceVertex::z)->z;
  const Fine limit = std::max(deepest, Fine{0}) + k_low;
  const auto low = chosen_ones(these, [&](const FaceVertex& v) { return v.z <= limit; });
  return are_wide(low, these, 4) ? low : these;
}

/// Points of one group with one normal, reduced to four whenever they do not fit.
class PointPool {
 public:
  explicit PointPool(const Vec3<Unit>& normal) : axis_(dominant_axis(normal)) {}

  /// A point at a vertex of the shape that is here already stays once, the deeper of both.
  void add(const ManifoldPoint& point) {
    if (point.feature < k_foreign) {
      ManifoldPoint* same = own(point.feature);
      if (same != nullptr) {
        if (point.separation < same->separation) *same = point;
        return;
      }
    }
    if (count_ == k_capacity) reduce();
    append(point);
  }

  /// Leaves at most four, ascending by feature: the shape's own come first, and a later one must
  /// be clearly better to take an earlier one's place.
  void reduce() {
    drop_repeats();
    // Areas are seen along the axis that the normal is nearest to: that needs no frame in the
    // plane, which could turn with the last bit of the normal.
    std::array<FaceVertex, k_capacity> polygon;
    for (std::size_t i = 0; i < count_; ++i) {
      const ManifoldPoint& p = points_[i];
      polygon[i] = {fine(p.anchor_b[(axis_ + 1) % 3]), fine(p.anchor_b[(axis_ + 2) % 3]),
                    Fine{p.separation.raw} * (Fine{1} << k_fine_per_displacement), p.feature};
    }
    const std::span all = std::span(polygon).first(count_);
    const auto kept = static_cast<std::size_t>(reduce_to_four(supporting_ones(all), k_area_shift));
    std::array<ManifoldPoint, k_max_manifold_points> chosen;
    for (std::size_t i = 0; i < kept; ++i)
      chosen[i] = *std::ranges::find(points(), polygon[i].feature, &ManifoldPoint::feature);
    own_.fill(0);
    count_ = 0;
    for (std::size_t i = 0; i < kept; ++i)
      append(chosen[i]);
  }

  [[nodiscard]] std::span<const ManifoldPoint> points() const {
    return std::span(points_.data(), count_);
  }

 private:
  static constexpr std::size_t k_capacity = 128;

  /// Points of a shape are up to 1800 m apart.
  static constexpr int k_area_shift = k_fine_per_length + 1;

  [[nodiscard]] ManifoldPoint* own(std::uint32_t feature) {
    const std::size_t place = own_[feature];
    return place == 0 ? nullptr : &points_[place - 1];
  }

  void append(const ManifoldPoint& point) {
    points_[count_++] = point;
    if (point.feature < k_foreign) own_[point.feature] = static_cast<std::uint8_t>(count_);
  }

  /// Features from triangles may repeat by accident: the deepest stays, of equals the first by
  /// place. The key is the whole point.
  void drop_repeats() {
    const std::span used(points_.data(), count_);
    std::ranges::sort(used, {}, [](const ManifoldPoint& p) {
      return std::tuple(p.feature, p.separation, p.anchor_b.x, p.anchor_b.y, p.anchor_b.z,
                        p.anchor_a.x, p.anchor_a.y, p.anchor_a.z);
    });
    const auto same = [](const ManifoldPoint& a, const ManifoldPoint& b) {
      return a.feature == b.feature;
    };
    count_ = static_cast<std::size_t>(std::unique(used.begin(), used.end(), same) - used.begin());
  }

  int axis_;
  UnsetArray<ManifoldPoint, k_capacity> points_;
  std::array<std::uint8_t, k_max_polytope_vertices> own_{};  ///< places + 1 of own features
  std::size_t count_ = 0;
};

/// The part of the shape that looks at a plane.
class FacingVertices {
 public:
  FacingVertices(const MeshContactFrame& frame, const Vec3<Unit>& normal) : frame_(frame) {
    find_feature(frame.shape, -normal, feature_);
    for (std::size_t i = 0; i < count(); ++i)
      local_[i] = along_columns(frame.rotation, place(i));
  }

  /// Those over the triangle's face within the margin; the manifold's normal is the face's.
  template <class Add>
  void add_over(const TriangleContact& contact, Add&& add) const {
    const FacePlane plane(contact.vertices, contact.face_normal);
    const Vec3<Unit>& normal = contact.manifold.normal;
    for (std::size_t i = 0; i < count(); ++i) {
      const Fine separation = plane.height(local_[i]) - fine(feature_.radius);
      if (!keeps(separation, frame_.margin) || !plane.has_beside(local_[i])) continue;
      const RawVec on_b = place(i) - along(normal, feature_.radius);
      Manifold one;
      add_point_on(frame_.shape.shape, one, {on_b - along(normal, separation), on_b}, frame_.offset,
                   separation, frame_.margin, feature_of(feature_.points[i]));
      add(one.points[0]);
    }
  }

 private:
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(feature_.count); }
  [[nodiscard]] RawVec place(std::size_t i) const {
    return feature_.points[i].at + fine(frame_.offset);
  }
  [[nodiscard]] std::uint32_t feature_of(const FeaturePoint& vertex) const {
    const PosedShape& posed = frame_.shape;
    const auto own = vertex_of(posed, along_columns(posed.rotation, vertex.at));
    return own ? *own : foreign_feature(0, vertex.id);
  }

  const MeshContactFrame& frame_;
  ContactFeature feature_;
  UnsetArray<RawVec, k_max_polytope_face_edges> local_;  ///< in the triangles' frame
};

/// A contact's place in the order of groups.
struct Member {
  std::uint32_t plane = 0;
  const TriangleContact* contact = nullptr;

  [[nodiscard]] auto group() const { return std::tuple(plane, surface_key(contact->surface)); }
  [[nodiscard]] auto key() const { return std::tuple(group(), contact->part); }
};

/// A group in the making: its points, and the deepest of its triangles.
class Group {
 public:
  Group(const Member& first, const MeshContactFrame& frame)
      : plane_(first.plane),
        deepest_(first.contact),
        pool_(first.contact->manifold.normal),
        vertices_(frame, first.contact->manifold.normal) {}

  void add(const TriangleContact& contact, const MeshContactFrame& frame) {
    const auto take = [&](const ManifoldPoint& point) {
      pool_.add(point);
      if (point.separation >= least_) return;
      least_ = point.separation;
      deepest_ = &contact;
    };
    if (contact.on_face) vertices_.add_over(contact, take);
    for (int i = 0; i < contact.manifold.count; ++i) {
      ManifoldPoint point = contact.manifold.points[static_cast<std::size_t>(i)];
      point.feature = feature_of(contact, point, frame);
      take(point);
    }
  }

  [[nodiscard]] MeshManifold finished() {
    pool_.reduce();
    const Surface* surface = deepest_->surface;
    MeshManifold result{plane_ | surface_byte(surface) << 24, deepest_->part, surface, {}};
    result.manifold.normal = deepest_->manifold.normal;
    for (const ManifoldPoint& point : pool_.points())
      result.manifold.points[static_cast<std::size_t>(result.manifold.count++)] = point;
    return result;
  }

 private:
  std::uint32_t plane_;
  const TriangleContact* deepest_;
  Displacement least_ = Displacement::max();
  PointPool pool_;
  FacingVertices vertices_;
};

/// Takes the group in; beyond the capacity the shallowest leaves, of equals the later one.
void insert(MeshManifolds& out, const MeshManifold& manifold) {
  if (out.count < MeshManifolds::k_capacity) {
    out.manifolds[out.count++] = manifold;
    return;
  }
  ++out.left_out;
  std::size_t shallowest = 0;
  const auto depth = [](const MeshManifold& m) { return least_separation(m.manifold); };
  for (std::size_t i = 1; i < out.count; ++i)
    if (depth(out.manifolds[i]) >= depth(out.manifolds[shallowest])) shallowest = i;
  if (depth(manifold) >= depth(out.manifolds[shallowest])) return;
  std::copy(out.manifolds.begin() + static_cast<std::ptrdiff_t>(shallowest) + 1,
            out.manifolds.begin() + static_cast<std::ptrdiff_t>(out.count),
            out.manifolds.begin() + static_cast<std::ptrdiff_t>(shallowest));
  out.manifolds[out.count - 1] = manifold;
}

/// Two surfaces of one plane may share the byte: the later one takes the next that is free.
void make_keys_unique(MeshManifolds& out) {
  const auto used = std::span(out.manifolds).first(out.count);
  for (std::size_t i = 1; i < used.size(); ++i) {
    const auto before = used.first(i);
    const auto taken = [&] { return std::ranges::find(before, used[i].key, &MeshManifold::key); };
    while (taken() != before.end())
      used[i].key += std::uint32_t{1} << 24;
  }
  std::ranges::sort(used, {}, &MeshManifold::key);
}

}  // namespace

void merge_planes(std::span<const TriangleContact> contacts, const MeshContactFrame& frame,
                  MeshManifolds& out) {
  LKS_CHECK(contacts.size() <= TriangleContacts::k_capacity);
  UnsetArray<Member, TriangleContacts::k_capacity> members;
  std::size_t count = 0;
  for (const TriangleContact& contact : contacts) {
    if (contact.manifold.count == 0 && !contact.on_face) continue;
    const Vec3<Unit> normal = rotate_inverse(frame.rotation, contact.manifold.normal);
    members[count++] = {plane_of(normal), &contact};
  }
  const std::span<Member> used(members.data(), count);
  std::ranges::sort(used, {}, &Member::key);
  out.count = 0;
  out.left_out = 0;
  for (std::size_t i = 0; i < count;) {
    Group group(used[i], frame);
    const std::size_t first = i;
    for (; i < count && used[i].group() == used[first].group(); ++i)
      group.add(*used[i].contact, frame);
    if (const MeshManifold manifold = group.finished(); manifold.manifold.count > 0)
      insert(out, manifold);
  }
  make_keys_unique(out);
}

}  // namespace lockstone::geometry
