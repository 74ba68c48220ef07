#include "core/world/derived/body_cache.h"

namespace lockstone {

BodyCache::BodyCache(std::uint32_t body_capacity)
    : assets_(body_capacity),
      rotations_(body_capacity),
      contact_rotations_(body_capacity),
      drifts_(body_capacity),
      contact_pose_numbers_(body_capacity),
      frames_(body_capacity),
      inner_radii_(body_capacity) {}

PlacedShape BodyCache::placed(std::uint32_t body, const BodyRecord& record) const {
  if (assets_[body] == nullptr)
    return {record.shape(), nullptr, record.position, rotations_[body], record.position};
  return place(record.shape(), assets_[body], record.position, frames_[body]);
}

void BodyCache::refresh(std::uint32_t body, const BodyRecord& record) {
  rotations_[body] = to_matrix(record.orientation);
  contact_rotations_[body] = to_matrix(record.contact_orientation);
  ++contact_pose_numbers_[body];
  refresh_turned(body, record);
}

void BodyCache::refresh_shape(std::uint32_t body, const BodyRecord& record) {
  inner_radii_[body] = lockstone::inner_radius(record.shape(), assets_[body]);
}

void BodyCache::refresh_turned(std::uint32_t body, const BodyRecord& record) {
  if (record.contact_orientation == record.orientation) contact_rotations_[body] = rotations_[body];
  drifts_[body] = drift_of(record);
  if (assets_[body] != nullptr) frames_[body] = shape_frame(assets_[body], rotations_[body]);
}

// `refresh_turned` copies the rotation of a body that has not left the pose.
void BodyCache::refresh_contact_rotation(std::uint32_t body, const BodyRecord& record) {
  if (record.contact_orientation == record.orientation) return;
  contact_rotations_[body] = to_matrix(record.contact_orientation);
}

void BodyCache::take_contact_pose(std::uint32_t body, BodyRecord& record) {
  const Vec3<Length> place = record.contact_place;
  const Quat orientation = record.contact_orientation;
  set_contact_pose(record);
  if (record.contact_place != place || record.contact_orientation != orientation)
    ++contact_pose_numbers_[body];
}

}  // namespace lockstone
