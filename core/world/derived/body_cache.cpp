#include "core/world/derived/body_cache.h"

namespace lockstone {

BodyCache::BodyCache(std::uint32_t body_capacity)
    : assets_(body_capacity),
      rotations_(body_capacity),
      recycling_rotations_(body_capacity),
      pose_deltas_(body_capacity),
      recycling_pose_numbers_(body_capacity),
      frames_(body_capacity),
      inner_radii_(body_capacity),
      hit_bodies_(body_capacity),
      persist_bodies_(body_capacity) {}

PlacedShape BodyCache::placed(std::uint32_t body, const BodyRecord& record) const {
  if (assets_[body] == nullptr)
    return {record.shape(), nullptr, record.position, rotations_[body], record.position};
  return place(record.shape(), assets_[body], record.position, frames_[body]);
}

PlacedShape BodyCache::recycled(std::uint32_t body, const BodyRecord& record) const {
  const Vec3<Position> centre = recycling_position(record);
  if (assets_[body] != nullptr && record.recycling_orientation == record.orientation)
    return place(record.shape(), assets_[body], centre, frames_[body]);
  return place(record.shape(), assets_[body], centre, recycling_rotations_[body]);
}

void BodyCache::refresh(std::uint32_t body, const BodyRecord& record) {
  rotations_[body] = to_matrix(record.orientation);
  recycling_rotations_[body] = to_matrix(record.recycling_orientation);
  ++recycling_pose_numbers_[body];
  refresh_turned(body, record);
}

void BodyCache::refresh_shape(std::uint32_t body, const BodyRecord& record) {
  inner_radii_[body] = lockstone::inner_radius(record.shape(), assets_[body]);
  refresh_events(body, record);
}

void BodyCache::refresh_events(std::uint32_t body, const BodyRecord& record) {
  if (hit_bodies_.has(body) != has_hit_events(record)) hit_bodies_.flip(body);
  if (persist_bodies_.has(body) != has_persist_events(record)) persist_bodies_.flip(body);
}

void BodyCache::refresh_turned(std::uint32_t body, const BodyRecord& record) {
  if (record.recycling_orientation == record.orientation)
    recycling_rotations_[body] = rotations_[body];
  pose_deltas_[body] = pose_delta_of(record);
  if (assets_[body] != nullptr) frames_[body] = shape_frame(assets_[body], rotations_[body]);
}

// `refresh_turned` copies the rotation of a body that has not left the pose.
void BodyCache::refresh_contact_rotation(std::uint32_t body, const BodyRecord& record) {
  if (record.recycling_orientation == record.orientation) return;
  recycling_rotations_[body] = to_matrix(record.recycling_orientation);
}

void BodyCache::renew_recycling_pose(std::uint32_t body, BodyRecord& record) {
  const Vec3<Length> place = record.recycling_place;
  const Quat orientation = record.recycling_orientation;
  set_recycling_pose(record);
  if (record.recycling_place != place || record.recycling_orientation != orientation)
    ++recycling_pose_numbers_[body];
}

}  // namespace lockstone
