// Validity of a stored state: bytes from anywhere are checked whole before they are used.

#include <algorithm>

#include <lockstone/hash.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/state/limits.h"
#include "core/dynamics/state/one_way_bits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/world/commands/command_checks.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/fluids.h"
#include "core/world/phases/vehicle/vehicle_phase.h"
#include "core/world/state/record_checks.h"
#include "core/world/state/record_codec.h"
#include "core/world/state/snapshot_format.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// The limit plus its own rounding error.
bool in_range(const Vec3<Velocity>& v) {
  constexpr Velocity limit = k_speed_limit + Velocity::from_ratio(1, 1024);
  return is_within(v, limit);
}

bool has_valid_inertia(const Vec3<Unit>& inertia) {
  for (int i = 0; i < 3; ++i) {
    if (inertia[i] < k_min_inertia || inertia[i] > Unit::from_integer(1)) return false;
  }
  return true;
}

bool has_valid_mass(const BodyRecord& record) {
  if (!record.is_dynamic()) return record.inverse_mass == 0 && record.inverse_mass_exponent == 0;
  return record.inverse_mass >= (1 << 30) && record.inverse_mass_exponent >= -64 &&
         record.inverse_mass_exponent <= 2;
}

bool has_valid_surface(const BodyRecord& record) {
  return geometry::is_valid(record.surface()) && (record.rules >> 9) == 0;
}

bool has_valid_limits(const BodyRecord& record) {
  const auto most = SolverVelocity::from_raw(k_speed_limit.raw >> 12);
  const auto valid = [&](SolverVelocity v) { return v > SolverVelocity{} && v <= most; };
  return valid(record.max_speed) && valid(record.max_surface_speed) &&
         record.linear_damping >= Rate{} && record.angular_damping >= Rate{} &&
         is_within(record.gravity_scale, k_gravity_scale_limit) && record.locks <= k_all_body_locks;
}

// Static and kinematic bodies may have a surface motion: rotated, and moved to the centre of mass,
// it may be longer than commands allow.
bool has_valid_notes(const BodyRecord& record) {
  constexpr int k_exponent_bits = 2 * k_gain_exponent_bits;
  if (!record.is_dynamic()) return !record.is_pushed() && are_one_way_bits(record.union_c);
  if (!record.is_pushed()) return true;
  const TickGain gain = tick_gain_of(record);
  return !record.is_asleep() && is_enabled(record) && record.rest_ticks == 0 &&
         record.still_ticks == 0 && record.union_c.raw >> k_exponent_bits == 0 &&
         is_within(gain.velocity, k_most_gain) && is_within(gain.spin, k_most_gain);
}

// The asset exists, and a body without a mass distribution does not move.
bool has_known_shape(const BodyRecord& record, const Asset* asset) {
  const ShapeKind kind = record.shape().kind;
  if (is_asset(kind) && (asset == nullptr || asset->kind() != kind)) return false;
  return may_have(static_cast<MotionType>(record.motion), record.shape(),
                  geometry::geometry_of(asset));
}

bool has_zero_rest(const BodyRecord& record) {
  const bool notes_something_else = !record.is_dynamic() || record.is_pushed();
  const bool none =
      record.union_a == Vec3<Unit>{} && record.union_b == Vec3<Unit>{} && record.union_c == Unit{};
  return (notes_something_else || none) && record.rest_ticks == 0;
}

// A sleeping body stands still, and only a body that may fall asleep by resting has a pose of its
// rest.
bool has_valid_sleep(const BodyRecord& record) {
  const bool watched = record.is_dynamic() && record.may_sleep() && !record.is_asleep();
  if (!watched && !has_zero_rest(record)) return false;
  if (record.has_changed_sleep() && !record.is_dynamic()) return false;
  if (record.still_ticks != 0 && (!record.is_dynamic() || !record.is_awake())) return false;
  if (!record.moves() || !is_enabled(record)) return !record.is_asleep();
  return !record.is_asleep() || (!has_motion(record) && record.may_sleep());
}

bool is_empty_slot(const BodyRecord& record) {
  BodyRecord empty;
  empty.generation = record.generation;
  return record == empty;
}

bool has_valid_points(const ContactRecord& record) {
  if (record.count > record.points.size()) return false;
  for (std::size_t i = 0; i < record.points.size(); ++i) {
    const ContactPointRecord& point = record.points[i];
    if (point.normal_impulse < SolverVelocity{}) return false;
    if (i >= record.count && point != ContactPointRecord{}) return false;
  }
  return true;
}

}  // namespace

// A component may be a few units in the last place beyond 1, as steps leave it; the norm says how
// many. The bound keeps squares in range.
bool has_unit_norm(const Quat& q) {
  constexpr std::int32_t k_bound = (1 << 30) + (1 << 10);
  for (const Unit c : {q.x, q.y, q.z, q.w}) {
    if (c.raw > k_bound || c.raw < -k_bound) return false;
  }
  const std::int64_t norm = (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w).raw;  // Q60
  const std::int64_t error = norm - (std::int64_t{1} << 60);
  return error < (std::int64_t{1} << 40) && error > -(std::int64_t{1} << 40);
}

Status validate(const BodyRecord& record, const AssetSet& assets) {
  if (!is_generation(record.generation) || record.motion > 3) return Status::malformed;
  if (!record.exists()) return is_empty_slot(record) ? Status::ok : Status::malformed;
  if (record.shape_kind > static_cast<std::uint8_t>(k_last_shape_kind) ||
      validate(record.shape()) != Status::ok)
    return Status::malformed;
  const Asset* asset = assets.find(record.shape().asset_id());
  if (!has_known_shape(record, asset)) return Status::malformed;
  const int scale = properties_of(record.shape(), geometry::geometry_of(asset),
                                  static_cast<MotionType>(record.motion))
                        .scale_exponent;
  const bool consistent = record.scale_exponent == scale && has_valid_inertia(record.inertia) &&
                          has_valid_mass(record) && has_valid_surface(record) &&
                          has_valid_sleep(record) && has_valid_limits(record) &&
                          has_valid_notes(record);
  if (!consistent) return Status::malformed;
  const bool in_world = is_within(record.position, k_world_limit) && in_range(record.velocity) &&
                        in_range(record.spin) && has_unit_norm(record.orientation) &&
                        has_unit_norm(record.recycling_orientation) &&
                        is_hit_speed(record.hit_speed);
  return in_world ? Status::ok : Status::malformed;
}

Status validate(const FluidRecord& record) {
  if (!record.exists()) return record == FluidRecord{} ? Status::ok : Status::malformed;
  const bool turned = has_unit_norm(record.orientation);
  return turned && is_valid(fluid_of(record)) ? Status::ok : Status::malformed;
}

Status validate(const PairRuleRecord& record) {
  const bool has_flags = record.flags != 0 && (record.flags & ~k_all_pair_rule_flags) == 0;
  const bool fits =
      record.has_surface() ? is_valid(record.surface) : record.surface == PairSurface{};
  return record.body_a < record.body_b && has_flags && fits ? Status::ok : Status::malformed;
}

Status validate(const SurfaceRuleRecord& record) {
  return record.tag_a <= record.tag_b && is_valid(record.surface) ? Status::ok : Status::malformed;
}

// Its settings and controls are those that a definition makes.
Status validate(const VehicleRecord& record) {
  const VehicleDef def = def_of(record);
  if (record.axle_count != def.axle_count || !is_valid(def)) return Status::malformed;
  VehicleRecord same = record_of(record.chassis, def);
  set_controls(same, controls_of(record));
  for (std::size_t i = 0; i < std::size_t{2} * record.axle_count; ++i)
    same.wheels[i] = record.wheels[i];
  same.engine_speed = record.engine_speed;
  same.gear = record.gear;
  same.shifting = record.shifting;
  const bool has_gear = record.gear >= -1 && record.gear <= static_cast<int>(k_max_gears) &&
                        record.shifting <= record.shift_ticks &&
                        record.engine_speed >= AngularVelocity{};
  const bool has_wheels = std::ranges::all_of(record.wheels, [](const WheelRecord& wheel) {
    return wheel.is_grounded <= 1 && wheel.load >= Force{};
  });
  return same == record && has_gear && has_wheels ? Status::ok : Status::malformed;
}

// One that is as in the asset would be another record of the same terrain.
bool is_valid_tile(const geometry::AssetGeometry& terrain, const TerrainTileRecord& tile) {
  if (const geometry::MeshEditing* groups = terrain.mesh_editing())
    return groups->is_tile(terrain, tile);
  const geometry::HeightEditing* editing = terrain.height_editing();
  if (editing == nullptr) return false;
  const geometry::HeightFieldData& field = editing->data_of(terrain);
  return editing->is_tile(field, tile) && tile != editing->original(field, tile.key());
}

Status validate(const ContactRecord& record, const BodyRecord& a, const BodyRecord& b,
                const AssetSet& assets) {
  const auto is_leading = [&](const BodyRecord& body) {
    const bool has_asset = body.moves() && is_asset(body.shape().kind);
    const Asset* asset = has_asset ? assets.find(body.shape().asset) : nullptr;
    return leads(body, geometry::geometry_of(asset));
  };
  const bool ordered = a.exists() && b.exists() && (a.moves() || b.moves()) &&
                       is_in_order({record.body_a, record.body_b}, is_leading(a), is_leading(b));
  const bool known = (record.flags & ~k_all_contact_flags) == 0;
  const bool trigger = a.is_trigger() || b.is_trigger();
  const bool passes = record.is_passing() && !trigger && !record.is_touching();
  const bool valid = ordered && known && is_enabled(a) && is_enabled(b) &&
                     trigger == record.is_trigger() && passes == record.is_passing() &&
                     has_valid_points(record) && (!record.is_inert() || record.count == 0);
  return valid ? Status::ok : Status::malformed;
}

Status validate(const JointRecord& record, const BodyRecord& a, const BodyRecord& b) {
  const bool valid =
      can_join(a, b) && is_anchor(a, record.anchor_a) && is_anchor(b, record.anchor_b);
  return valid ? Status::ok : Status::malformed;
}

Status SnapshotView::check(ContactStore) const {
  for (std::uint32_t i = 0; i < header.contact_count; ++i) {
    const ContactRecord record = contact(i);
    if (record.body_a >= header.body_limit || record.body_b >= header.body_limit) {
      return Status::malformed;
    }
    if (validate(record, body(record.body_a), body(record.body_b), *assets_) != Status::ok)
      return Status::malformed;
    if (i == 0) continue;
    const ContactRecord last = contact(i - 1);
    if (last.key() >= record.key()) return Status::malformed;
  }
  return Status::ok;
}

Result<SnapshotView> SnapshotView::open(ByteView bytes, const WorldDef& def,
                                        const AssetSet& assets) {
  ByteReader reader(bytes);
  SnapshotView view;
  view.assets_ = &assets;
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto reserved = reader.get<std::uint16_t>();
  const auto config = reader.get<std::uint64_t>();
  view.header = decode<WorldHeader>(reader);
  if (!reader.ok()) return Status::truncated;
  if (magic != k_snapshot_magic || reserved != 0) return Status::malformed;
  if (version != k_snapshot_version) return Status::unsupported_version;
  if (config != config_hash(def, assets.hash())) return Status::incompatible;
  if (!WorldStores::fits(view.header, def)) return Status::malformed;
  const ByteView records = reader.get_bytes(WorldStores::record_bytes(view.header));
  const std::size_t hashed = reader.position();
  const auto hash = reader.get<std::uint64_t>();
  if (!reader.ok()) return Status::truncated;
  if (reader.remaining() != 0) return Status::malformed;
  if (hash != hash64(bytes.first(hashed))) return Status::checksum_mismatch;
  view.records_ = StoredRecords<WorldStores>(view.header, records);
  return view;
}

Status SnapshotView::check(JointStore) const {
  for (std::uint32_t i = 0; i < header.joint_limit; ++i) {
    const JointRecord record = joint(i);
    if (validate(record) != Status::ok) return Status::malformed;
    if (!record.exists()) continue;
    if (record.body_a >= header.body_limit || record.body_b >= header.body_limit) {
      return Status::malformed;
    }
    if (validate(record, body(record.body_a), body(record.body_b)) != Status::ok)
      return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check(FluidStore) const {
  if (header.fluid_limit != 0 && linked_fluid_phase == nullptr) return Status::incompatible;
  for (std::uint32_t i = 0; i < header.fluid_limit; ++i)
    if (validate(record<FluidStore>(i)) != Status::ok) return Status::malformed;
  return Status::ok;
}

// By key, of bodies that exist.
Status SnapshotView::check(PairRuleStore) const {
  for (std::uint32_t i = 0; i < header.pair_rule_count; ++i) {
    const auto rule = record<PairRuleStore>(i);
    if (validate(rule) != Status::ok || rule.body_b >= header.body_limit) return Status::malformed;
    if (!body(rule.body_a).exists() || !body(rule.body_b).exists()) return Status::malformed;
    if (i > 0 && record<PairRuleStore>(i - 1).key() >= rule.key()) return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check(SurfaceRuleStore) const {
  for (std::uint32_t i = 0; i < header.surface_rule_count; ++i) {
    const auto rule = record<SurfaceRuleStore>(i);
    if (validate(rule) != Status::ok) return Status::malformed;
    if (i > 0 && record<SurfaceRuleStore>(i - 1).key() >= rule.key()) return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check(VehicleStore) const {
  if (header.vehicle_count != 0 && linked_vehicle_phase == nullptr) return Status::incompatible;
  for (std::uint32_t i = 0; i < header.vehicle_count; ++i) {
    const auto vehicle = record<VehicleStore>(i);
    if (validate(vehicle) != Status::ok) return Status::malformed;
    if (vehicle.chassis >= header.body_limit || !body(vehicle.chassis).exists())
      return Status::malformed;
    if (i > 0 && record<VehicleStore>(i - 1).key() >= vehicle.key()) return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check(TerrainTileStore) const {
  for (std::uint32_t i = 0; i < header.terrain_tile_count; ++i) {
    const auto tile = record<TerrainTileStore>(i);
    if (tile.owner >= header.body_limit || !body(tile.owner).exists()) return Status::malformed;
    const Asset* asset = assets_->find(body(tile.owner).shape().asset_id());
    if (asset == nullptr || !is_valid_tile(asset->geometry(), tile)) return Status::malformed;
    if (i > 0 && record<TerrainTileStore>(i - 1).key() >= tile.key()) return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check(BodyStore) const {
  for (std::uint32_t i = 0; i < header.body_limit; ++i) {
    const BodyRecord record = body(i);
    if (validate(record, *assets_) != Status::ok) return Status::malformed;
    if (record.exists() && !is_near_recycling_pose(record, wide_range(record)))
      return Status::malformed;
  }
  return Status::ok;
}

Status SnapshotView::check() const {
  if (!is_valid_gravity(header.gravity) || header.reserved != 0) return Status::malformed;
  Status status = Status::ok;
  WorldStores::for_each([&](auto store) {
    if (status == Status::ok) status = check(store);
  });
  return status;
}

}  // namespace lockstone
