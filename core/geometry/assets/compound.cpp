// Canonical bytes: asset head · u32 children · per child: u8 kind, 3 × i32 size, u64 id,
// 3 × i32 position, 4 × i32 orientation, i32 density, u8 has surface, 2 × i32 surface.

#include <algorithm>

#include <lockstone/compound.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/joined_meshes.h"
#include "core/geometry/assets/mixed_geometry.h"
#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/compound_solid.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/slab_tests.h"
#include "core/math/rotation_log.h"

namespace lockstone {
namespace {

using geometry::LocalBounds;

constexpr std::uint16_t k_compound_version = 2;
constexpr std::size_t k_child_bytes = 1 + 12 + 8 + 12 + 16 + 4 + 1 + geometry::k_surface_bytes;
constexpr Number k_max_density = Number::from_integer(1024);
constexpr Number k_min_density = Number::from_ratio(1, 1024);
static_assert(k_first_compound_triangle == geometry::k_first_triangle_part);

// Left alone when it is as good as normalising makes it, so that doing it twice changes nothing.
Quat normalized_once(const Quat& q) {
  const std::int64_t norm = (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w).raw;  // 60 bits
  const std::int64_t error = norm - (std::int64_t{1} << 60);
  constexpr std::int64_t k_bound = std::int64_t{1} << 33;
  return error <= k_bound && error >= -k_bound ? q : normalized(q);
}

bool is_mesh(const CompoundChild& child) {
  return child.shape.kind == ShapeKind::mesh;
}

// Of a child without an asset, or with one of its kind.
bool has_own_asset(const CompoundChild& child) {
  const AssetId named = child.asset == nullptr ? AssetId{} : child.asset->id();
  if (named != child.shape.asset_id()) return false;
  return child.asset == nullptr || child.asset->kind() == child.shape.kind;
}

CompoundFault fault_of(const CompoundChild& child) {
  const ShapeKind kind = child.shape.kind;
  if (!is_primitive(kind) && kind != ShapeKind::hull && kind != ShapeKind::mesh)
    return CompoundFault::invalid_shape;
  if (validate(child.shape) != Status::ok) return CompoundFault::invalid_shape;
  if (!has_own_asset(child)) return CompoundFault::missing_asset;
  if (!has_direction(child.orientation)) return CompoundFault::invalid_orientation;
  if (child.density < k_min_density || child.density > k_max_density) {
    return CompoundFault::invalid_density;
  }
  if (child.surface && !geometry::is_valid(*child.surface)) return CompoundFault::invalid_surface;
  return CompoundFault::none;
}

// In the compound's frame, rounded outward by a few micrometres.
LocalBounds bounds_of(const CompoundChild& child, const Mat3& rotation) {
  LocalBounds own;
  if (child.asset != nullptr) {
    own = child.asset->geometry().bounds();
  } else {
    const Vec3<Length> half = world_half_extents(child.shape, Mat3{});
    own = {-half, half};
  }
  LocalBounds result;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t low = geometry::fine(child.position[axis]), high = low;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t a = (rotation.column(i)[axis] * own.lower[i]).raw;
      const std::int64_t b = (rotation.column(i)[axis] * own.upper[i]).raw;
      low += std::min(a, b);
      high += std::max(a, b);
    }
    result.lower[axis].raw = raw::saturate<std::int32_t>((low >> 30) - 2);
    result.upper[axis].raw = raw::saturate<std::int32_t>((high >> 30) + 2);
  }
  return result;
}

LocalBounds united(const LocalBounds& a, const LocalBounds& b) {
  LocalBounds result;
  for (int i = 0; i < 3; ++i) {
    result.lower[i] = min(a.lower[i], b.lower[i]);
    result.upper[i] = max(a.upper[i], b.upper[i]);
  }
  return result;
}

bool is_in_range(const LocalBounds& bounds) {
  return geometry::is_asset_coordinate(bounds.lower) && geometry::is_asset_coordinate(bounds.upper);
}

void encode(const CompoundChild& child, ByteWriter& writer) {
  writer.put(child.shape.kind);
  geometry::put_vector(writer, child.shape.size);
  writer.put(child.shape.asset.value);
  geometry::put_vector(writer, child.position);
  for (const Unit c :
       {child.orientation.x, child.orientation.y, child.orientation.z, child.orientation.w}) {
    writer.put(c.raw);
  }
  writer.put(child.density.raw);
  writer.put(static_cast<std::uint8_t>(child.surface.has_value()));
  geometry::put_surface(writer, child.surface.value_or(Surface{{}, {}}));
}

std::vector<std::byte> encode(std::span<const CompoundChild> children) {
  std::vector<std::byte> bytes(geometry::k_asset_header_bytes + 4 +
                               children.size() * k_child_bytes);
  ByteWriter writer(bytes);
  geometry::put_asset_header(writer, ShapeKind::compound, k_compound_version);
  writer.put(static_cast<std::uint32_t>(children.size()));
  for (const CompoundChild& child : children)
    encode(child, writer);
  LKS_CHECK(writer.ok() && writer.size() == bytes.size());
  return bytes;
}

// Whether it is canonical shows when the compound is built: it must give the same bytes.
CompoundChild decode_child(ByteReader& reader, const AssetSet& known) {
  CompoundChild child;
  child.shape.kind = static_cast<ShapeKind>(reader.get<std::uint8_t>());
  child.shape.size = geometry::get_vector(reader);
  child.shape.asset.value = reader.get<std::uint64_t>();
  child.position = geometry::get_vector(reader);
  child.orientation.x.raw = reader.get<std::int32_t>();
  child.orientation.y.raw = reader.get<std::int32_t>();
  child.orientation.z.raw = reader.get<std::int32_t>();
  child.orientation.w.raw = reader.get<std::int32_t>();
  child.density.raw = reader.get<std::int32_t>();
  const bool has_surface = reader.get<std::uint8_t>() != 0;
  const Surface surface = geometry::get_surface(reader);
  if (has_surface) child.surface = surface;
  for (const AssetPtr& asset : known.all()) {
    if (asset->id() == child.shape.asset_id()) child.asset = asset;
  }
  return child;
}

// Convex children that the window meets within the visitor's present limit.
template <class Geometry, class Window, class Limit, class Visitor>
void visit_met(const Geometry& geometry, const Window& window, Limit most, Visitor& visitor) {
  std::int64_t at = 0;
  for (std::size_t i = 0; i < geometry.children.size(); ++i) {
    if (is_mesh(geometry.children[i])) continue;
    if (window.meets(geometry.placed[i].bounds, window.limit_of(most), at))
      most = visitor.visit(geometry.part(i));
  }
}

// All children, of which the convex ones are its parts: meshes are joined beside it.
struct CompoundGeometry final : geometry::AssetGeometry {
  struct Placed {
    Mat3 rotation;
    LocalBounds bounds;
  };

  static constexpr std::size_t k_group = 8;  // children whose bounds are tested at once

  std::vector<CompoundChild> children;
  std::vector<Placed> placed;       // by child
  std::vector<LocalBounds> groups;  // of eight children each, in order
  LocalBounds all_bounds;
  geometry::Solid whole;
  bool has_meshes = false;

  [[nodiscard]] geometry::Part part(std::size_t index) const;
  void derive();

  [[nodiscard]] const LocalBounds& bounds() const override { return all_bounds; }
  [[nodiscard]] const geometry::Solid* solid() const override {
    return has_meshes ? nullptr : &whole;
  }
  [[nodiscard]] const geometry::AssetGeometry* solids() const override { return this; }
  void visit_parts(const LocalBounds& region, geometry::PartVisitor& visitor) const override {
    for (std::size_t group = 0; group < groups.size(); ++group) {
      if (!geometry::overlap(region, groups[group])) continue;
      const std::size_t end = std::min(children.size(), (group + 1) * k_group);
      for (std::size_t i = group * k_group; i < end; ++i)
        if (!is_mesh(children[i]) && geometry::overlap(region, placed[i].bounds))
          visitor.visit(part(i));
    }
  }
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach,
                          geometry::WayPartVisitor& visitor) const override {
    visit_met(*this, geometry::RayWindow(origin, translation, reach), Unit::from_integer(1),
              visitor);
  }
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        geometry::NearPartVisitor& visitor) const override {
    visit_met(*this, geometry::NearWindow(point), reach, visitor);
  }
};

void CompoundGeometry::derive() {
  std::vector<geometry::PlacedSolid> solids;
  for (const CompoundChild& child : children) {
    const Mat3 rotation = to_matrix(child.orientation);
    const LocalBounds bounds = bounds_of(child, rotation);
    placed.push_back({rotation, bounds});
    all_bounds = placed.size() == 1 ? bounds : united(all_bounds, bounds);
    if (placed.size() % k_group == 1)
      groups.push_back(bounds);
    else
      groups.back() = united(groups.back(), bounds);
    has_meshes = has_meshes || is_mesh(child);
    if (has_meshes) continue;
    geometry::PlacedSolid part{
        child.asset != nullptr ? *child.asset->geometry().solid() : geometry::solid_of(child.shape),
        child.position,
        child.orientation,
        {}};
    const std::uint64_t weight = static_cast<std::uint64_t>(part.solid.volume.mantissa) *
                                 static_cast<std::uint64_t>(child.density.raw);
    part.weight = block_float(weight, part.solid.volume.exponent - Number::frac_bits);
    solids.push_back(part);
  }
  if (is_in_range(all_bounds) && !has_meshes) whole = geometry::combined(solids);
}

geometry::Part CompoundGeometry::part(std::size_t index) const {
  const CompoundChild& child = children[index];
  return {static_cast<std::uint32_t>(index),
          child.shape,
          child.asset != nullptr ? child.asset->geometry().polytope() : nullptr,
          child.position,
          placed[index].rotation,
          child.surface ? &*child.surface : nullptr,
          {}};
}

const CompoundGeometry& geometry_of(const Compound& compound) {
  return static_cast<const CompoundGeometry&>(*compound.geometry().solids());
}

const geometry::MeshJoining* joining_of(std::span<const CompoundChild> children) {
  const auto mesh = std::ranges::find_if(children, is_mesh);
  return mesh == children.end() ? nullptr : mesh->asset->geometry().mesh_joining();
}

geometry::JoinedMeshes join_meshes(const CompoundGeometry& compound) {
  std::vector<geometry::PlacedMesh> meshes;
  for (std::uint32_t i = 0; i < compound.children.size(); ++i) {
    const CompoundChild& child = compound.children[i];
    if (!is_mesh(child)) continue;
    meshes.push_back({i, child.asset->geometry(), child.position, compound.placed[i].rotation,
                      child.surface ? &*child.surface : nullptr});
  }
  return joining_of(compound.children)->join(meshes);
}

CompoundFault fault_of(geometry::JoinFault fault) {
  switch (fault) {
    case geometry::JoinFault::none:
      return CompoundFault::none;
    case geometry::JoinFault::empty:
      return CompoundFault::no_triangles;
    case geometry::JoinFault::too_many_triangles:
      return CompoundFault::too_many_triangles;
    case geometry::JoinFault::too_many_surfaces:
      return CompoundFault::too_many_surfaces;
  }
  return CompoundFault::none;
}

}  // namespace

std::string_view to_string(CompoundFault fault) {
  switch (fault) {
    case CompoundFault::none:
      return "none";
    case CompoundFault::no_children:
      return "no children";
    case CompoundFault::too_many_children:
      return "too many children";
    case CompoundFault::invalid_shape:
      return "a child's shape is not a valid primitive, hull or mesh";
    case CompoundFault::missing_asset:
      return "a child's hull or mesh is missing";
    case CompoundFault::invalid_orientation:
      return "a child's orientation has no direction";
    case CompoundFault::invalid_density:
      return "a child's density is out of range";
    case CompoundFault::invalid_surface:
      return "a child's surface is out of range";
    case CompoundFault::coordinate_out_of_range:
      return "a child reaches too far from the origin";
    case CompoundFault::no_triangles:
      return "no triangle of the meshes has area";
    case CompoundFault::too_many_triangles:
      return "the meshes have too many triangles together";
    case CompoundFault::too_many_surfaces:
      return "the meshes have too many surfaces together";
  }
  return "unknown";
}

Compound::Compound(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : Asset(ShapeKind::compound, id, std::move(geometry)) {}

CompoundResult Compound::build(std::span<const CompoundChild> children) {
  if (children.empty()) return {nullptr, CompoundFault::no_children};
  if (children.size() > k_max_compound_children) return {nullptr, CompoundFault::too_many_children};
  auto made = std::make_unique<CompoundGeometry>();
  for (const CompoundChild& child : children) {
    const auto index = static_cast<std::uint32_t>(made->children.size());
    if (const CompoundFault fault = fault_of(child); fault != CompoundFault::none) {
      return {nullptr, fault, index};
    }
    made->children.push_back(child);
    made->children.back().orientation = normalized_once(child.orientation);
  }
  made->derive();
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (is_in_range(made->placed[i].bounds)) continue;
    return {nullptr, CompoundFault::coordinate_out_of_range, static_cast<std::uint32_t>(i)};
  }
  const AssetId id = geometry::id_of(encode(made->children));
  std::unique_ptr<const geometry::AssetGeometry> whole;
  if (made->has_meshes) {
    geometry::JoinedMeshes joined = join_meshes(*made);
    if (joined.triangles == nullptr) return {nullptr, fault_of(joined.fault), joined.child};
    whole = std::make_unique<const geometry::OwnedMixedGeometry>(std::move(made),
                                                                 std::move(joined.triangles));
  } else {
    whole = std::move(made);
  }
  return {std::shared_ptr<const Compound>(new Compound(id, std::move(whole)))};
}

Result<std::shared_ptr<const Compound>> Compound::from_bytes(ByteView bytes,
                                                             const AssetSet& known) {
  ByteReader reader(bytes);
  const Status head = geometry::read_asset_header(reader, ShapeKind::compound, k_compound_version);
  if (head != Status::ok) return head;
  const auto count = reader.get<std::uint32_t>();
  if (!reader.ok()) return Status::truncated;
  if (count == 0 || count > k_max_compound_children) return Status::malformed;
  if (reader.remaining() < count * k_child_bytes) return Status::truncated;
  std::vector<CompoundChild> children;
  for (std::uint32_t i = 0; i < count; ++i) {
    children.push_back(decode_child(reader, known));
    if (!children.back().shape.asset_id().is_null() && children.back().asset == nullptr) {
      return Status::not_found;
    }
  }
  const CompoundResult built = build(children);
  if (!built.ok() || !std::ranges::equal(built.compound->canonical_bytes(), bytes)) {
    return Status::malformed;
  }
  return built.compound;
}

std::span<const CompoundChild> Compound::children() const {
  return geometry_of(*this).children;
}

std::optional<CompoundPart> Compound::find_part(std::uint32_t part) const {
  if (part < children().size())
    return is_mesh(children()[part]) ? std::nullopt : std::optional(CompoundPart{part, 0});
  const geometry::AssetGeometry* joined = geometry().triangles();
  if (joined == nullptr) return std::nullopt;
  const geometry::TriangleSource* source = joining_of(children())->source_of(*joined, part);
  if (source == nullptr) return std::nullopt;
  return CompoundPart{source->child, source->triangle};
}

std::vector<std::byte> Compound::canonical_bytes() const {
  return encode(children());
}

}  // namespace lockstone
