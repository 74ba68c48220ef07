// Snapshots. The native one is a copy of the used parts of the stores. The canonical one is:
//   u32 magic "LKSW" · u16 version · u16 reserved · u64 config hash
//   header record · body records · contact records · joint records · u64 XXH3 of all before
// all little-endian, each record its fields in the order of its list.

#include <algorithm>
#include <cstring>

#include <lockstone/hash.h>

#include "core/dynamics/inertia.h"
#include "core/dynamics/limits.h"
#include "core/dynamics/tick_gain.h"
#include "core/geometry/shape_properties.h"
#include "core/world/record_codec.h"
#include "core/world/snapshot_format.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr Unit k_whole = Unit::from_integer(1);

// Of any bits: the least number has no magnitude.
template <class T>
bool is_within(T x, T limit) {
  return x <= limit && x >= -limit;
}

template <class T>
bool in_range(const Vec3<T>& v, T limit) {
  return is_within(v.x, limit) && is_within(v.y, limit) && is_within(v.z, limit);
}

// The limit plus what its own rounding may leave.
bool in_range(const Vec3<Velocity>& v) {
  constexpr Velocity limit = k_speed_limit + Velocity::from_ratio(1, 1024);
  return in_range(v, limit);
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
  constexpr auto k_most = SolverVelocity::from_raw(k_speed_limit.raw >> 12);
  const auto valid = [](SolverVelocity v) { return v > SolverVelocity{} && v <= k_most; };
  return valid(record.max_speed) && valid(record.max_surface_speed) &&
         record.linear_damping >= Rate{} && record.angular_damping >= Rate{} &&
         is_within(record.gravity_scale, k_gravity_scale_limit) && record.locks <= k_all_body_locks;
}

// Mantissas of at most 30 bits. What is not dynamic may have a surface motion: rotated, and moved
// to the centre of mass, it may be longer than what commands give.
bool has_valid_notes(const BodyRecord& record) {
  constexpr int k_exponent_bits = 2 * k_gain_exponent_bits;
  if (!record.is_dynamic()) return !record.is_pushed() && record.note_c == Unit{};
  if (!record.is_pushed()) return true;
  return !record.is_asleep() && record.rest_ticks == 0 &&
         record.note_c.raw >> k_exponent_bits == 0 && in_range(record.note_a, k_whole) &&
         in_range(record.note_b, k_whole);
}

constexpr auto k_last_shape_kind = static_cast<std::uint8_t>(ShapeKind::compound);

// The asset exists, and what has no mass distribution does not move.
bool has_known_shape(const BodyRecord& record, const Asset* asset) {
  const ShapeKind kind = record.shape().kind;
  if (is_asset(kind) && (asset == nullptr || asset->kind() != kind)) return false;
  const bool has_solid = is_primitive(kind) || (asset != nullptr && asset->solid() != nullptr);
  return has_solid || record.is_static();
}

bool has_zero_rest(const BodyRecord& record) {
  const bool notes_something_else = !record.is_dynamic() || record.is_pushed();
  const bool none =
      record.note_a == Vec3<Unit>{} && record.note_b == Vec3<Unit>{} && record.note_c == Unit{};
  return (notes_something_else || none) && record.rest_ticks == 0;
}

// What sleeps stands still, and only what may fall asleep by resting has notes of it.
bool has_valid_sleep(const BodyRecord& record) {
  const bool watched = record.is_dynamic() && record.may_sleep() && !record.is_asleep();
  if (!watched && !has_zero_rest(record)) return false;
  if (!record.moves()) return !record.is_asleep();
  const bool still = record.velocity == Vec3<Velocity>{} && record.spin == Vec3<Velocity>{};
  return !record.is_asleep() || (still && record.may_sleep());
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

bool has_unit_norm(const Quat& q) {
  constexpr std::int32_t k_bound = 1 << 30;
  for (const Unit c : {q.x, q.y, q.z, q.w}) {
    if (c.raw > k_bound || c.raw < -k_bound) return false;
  }
  const std::int64_t norm = (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w).raw;  // Q60
  const std::int64_t error = norm - (std::int64_t{1} << 60);
  return error < (std::int64_t{1} << 40) && error > -(std::int64_t{1} << 40);
}

Status validate(const BodyRecord& record, const AssetSet& assets) {
  if (record.generation == 0 || record.motion > 3) return Status::malformed;
  if (!record.exists()) return is_empty_slot(record) ? Status::ok : Status::malformed;
  const bool known =
      record.shape_kind <= k_last_shape_kind && (record.flags & ~k_all_body_flags) == 0;
  if (!known || validate(record.shape()) != Status::ok) return Status::malformed;
  const Asset* asset = assets.find(record.asset);
  if (!has_known_shape(record, asset)) return Status::malformed;
  const int scale = properties_of(record.shape(), asset).scale_exponent;
  const bool consistent = record.scale_exponent == scale && has_valid_inertia(record.inertia) &&
                          has_valid_mass(record) && has_valid_surface(record) &&
                          has_valid_sleep(record) && has_valid_limits(record) &&
                          has_valid_notes(record);
  const bool in_world = in_range(record.position, k_world_limit) && in_range(record.velocity) &&
                        in_range(record.spin) && has_unit_norm(record.orientation);
  return consistent && in_world ? Status::ok : Status::malformed;
}

Status SnapshotView::check_contacts() const {
  for (std::uint32_t i = 0; i < header.contact_count; ++i) {
    const ContactRecord record = contact(i);
    if (record.body_a >= header.body_limit || record.body_b >= header.body_limit) {
      return Status::malformed;
    }
    const BodyRecord a = body(record.body_a), b = body(record.body_b);
    const bool ordered = a.moves() && b.exists() && (!b.moves() || record.body_a < record.body_b);
    const bool known = (record.flags & ~k_all_contact_flags) == 0 && record.reserved == 0;
    const bool trigger = a.is_trigger() || b.is_trigger();
    if (!ordered || !known || trigger != record.is_trigger() || !has_valid_points(record) ||
        (trigger && record.count != 0)) {
      return Status::malformed;
    }
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
  if (view.header.body_limit > def.body_capacity ||
      view.header.contact_count > def.contact_capacity ||
      view.header.joint_limit > def.joint_capacity) {
    return Status::malformed;
  }
  const std::size_t body_bytes = view.header.body_limit * sizeof(BodyRecord);
  const std::size_t contact_bytes = view.header.contact_count * sizeof(ContactRecord);
  view.bodies_ = reader.get_bytes(body_bytes);
  view.contacts_ = reader.get_bytes(contact_bytes);
  view.joints_ = reader.get_bytes(view.header.joint_limit * sizeof(JointRecord));
  const std::size_t hashed = reader.position();
  const auto hash = reader.get<std::uint64_t>();
  if (!reader.ok()) return Status::truncated;
  if (reader.remaining() != 0) return Status::malformed;
  if (hash != hash64(bytes.first(hashed))) return Status::checksum_mismatch;
  return view;
}

BodyRecord SnapshotView::body(std::uint32_t index) const {
  ByteReader reader(bodies_.subspan(index * sizeof(BodyRecord), sizeof(BodyRecord)));
  return decode<BodyRecord>(reader);
}

ContactRecord SnapshotView::contact(std::uint32_t index) const {
  ByteReader reader(contacts_.subspan(index * sizeof(ContactRecord), sizeof(ContactRecord)));
  return decode<ContactRecord>(reader);
}

JointRecord SnapshotView::joint(std::uint32_t index) const {
  ByteReader reader(joints_.subspan(index * sizeof(JointRecord), sizeof(JointRecord)));
  return decode<JointRecord>(reader);
}

Status SnapshotView::check_joints() const {
  for (std::uint32_t i = 0; i < header.joint_limit; ++i) {
    const JointRecord record = joint(i);
    if (validate(record) != Status::ok) return Status::malformed;
    if (!record.exists()) continue;
    if (record.body_a >= header.body_limit || record.body_b >= header.body_limit) {
      return Status::malformed;
    }
    const BodyRecord a = body(record.body_a), b = body(record.body_b);
    if (!can_join(a, b) || !is_anchor(a, record.anchor_a) || !is_anchor(b, record.anchor_b)) {
      return Status::malformed;
    }
  }
  return Status::ok;
}

Status SnapshotView::check() const {
  if (!is_valid_gravity(header.gravity) || header.reserved != 0) return Status::malformed;
  for (std::uint32_t i = 0; i < header.body_limit; ++i) {
    if (validate(body(i), *assets_) != Status::ok) return Status::malformed;
  }
  if (const Status status = check_contacts(); status != Status::ok) return status;
  return check_joints();
}

std::size_t World::snapshot_bytes_max(SnapshotKind kind) const {
  const std::size_t frame = kind == SnapshotKind::native ? 0 : k_snapshot_frame_bytes;
  return frame + sizeof(WorldHeader) + impl_->def.body_capacity * sizeof(BodyRecord) +
         impl_->def.contact_capacity * sizeof(ContactRecord) +
         impl_->def.joint_capacity * sizeof(JointRecord);
}

std::size_t World::save(SnapshotKind kind, std::span<std::byte> out) const {
  return kind == SnapshotKind::native ? impl_->save_native(out) : impl_->save_canonical(out);
}

Status World::load(SnapshotKind kind, ByteView bytes) {
  return kind == SnapshotKind::native ? impl_->load_native(bytes) : impl_->load_canonical(bytes);
}

std::size_t World::Impl::save_native(std::span<std::byte> out) const {
  const std::size_t body_bytes = header.body_limit * sizeof(BodyRecord);
  const std::size_t joint_bytes = header.joint_limit * sizeof(JointRecord);
  const std::size_t size =
      sizeof(header) + body_bytes + header.contact_count * sizeof(ContactRecord) + joint_bytes;
  if (size > out.size()) return 0;
  std::byte* to = out.data();
  const auto put = [&](const void* from, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
    to += bytes;
  };
  put(&header, sizeof(header));
  put(bodies.data(), body_bytes);
  if (frozen.count() == 0) {
    put(contact_store.data(), active_contacts * sizeof(ContactRecord));
  } else {
    for_each_contact([&](const ContactRecord& contact) { put(&contact, sizeof(contact)); });
  }
  put(joints.data(), joint_bytes);
  return size;
}

Status World::Impl::load_native(ByteView bytes) {
  if (bytes.size() < sizeof(WorldHeader)) return Status::truncated;
  WorldHeader loaded;
  std::memcpy(&loaded, bytes.data(), sizeof(loaded));
  if (loaded.body_limit > def.body_capacity || loaded.contact_count > def.contact_capacity ||
      loaded.joint_limit > def.joint_capacity) {
    return Status::malformed;
  }
  const std::size_t body_bytes = loaded.body_limit * sizeof(BodyRecord);
  const std::size_t contact_bytes = loaded.contact_count * sizeof(ContactRecord);
  const std::size_t joint_bytes = loaded.joint_limit * sizeof(JointRecord);
  if (bytes.size() != sizeof(loaded) + body_bytes + contact_bytes + joint_bytes) {
    return Status::truncated;
  }
  for (std::uint32_t i = loaded.body_limit; i < header.body_limit; ++i)
    bodies[i] = {};
  for (std::uint32_t i = loaded.joint_limit; i < header.joint_limit; ++i)
    joints[i] = {};
  const std::byte* from = bytes.data() + sizeof(loaded);
  if (body_bytes > 0) std::memcpy(bodies.data(), from, body_bytes);
  new_contacts.resize(loaded.contact_count);
  if (contact_bytes > 0) std::memcpy(new_contacts.data(), from + body_bytes, contact_bytes);
  from += body_bytes + contact_bytes;
  if (joint_bytes > 0) std::memcpy(joints.data(), from, joint_bytes);
  header = loaded;
  forget_events();
  rebuild_derived();
  return Status::ok;
}

std::size_t World::Impl::save_canonical(std::span<std::byte> out) const {
  ByteWriter writer(out);
  writer.put(k_snapshot_magic);
  writer.put(k_snapshot_version);
  writer.put<std::uint16_t>(0);
  writer.put(config_hash(def, assets->hash()));
  encode(header, writer);
  for (std::uint32_t i = 0; i < header.body_limit; ++i)
    encode(bodies[i], writer);
  for_each_contact([&](const ContactRecord& contact) { encode(contact, writer); });
  for (std::uint32_t i = 0; i < header.joint_limit; ++i)
    encode(joints[i], writer);
  if (!writer.ok()) return 0;
  writer.put(hash64(writer.written()));
  return writer.ok() ? writer.size() : 0;
}

Status World::Impl::load_canonical(ByteView bytes) {
  const Result<SnapshotView> view = SnapshotView::open(bytes, def, *assets);
  if (!view.ok()) return view.status();
  if (const Status status = view.value().check(); status != Status::ok) return status;
  const std::uint32_t old_limit = header.body_limit, old_joints = header.joint_limit;
  header = view.value().header;
  for (std::uint32_t i = 0; i < header.body_limit; ++i)
    bodies[i] = view.value().body(i);
  for (std::uint32_t i = header.body_limit; i < old_limit; ++i)
    bodies[i] = {};
  new_contacts.clear();
  for (std::uint32_t i = 0; i < header.contact_count; ++i)
    new_contacts.push_back(view.value().contact(i));
  for (std::uint32_t i = 0; i < header.joint_limit; ++i)
    joints[i] = view.value().joint(i);
  for (std::uint32_t i = header.joint_limit; i < old_joints; ++i)
    joints[i] = {};
  forget_events();
  rebuild_derived();
  return Status::ok;
}

}  // namespace lockstone
