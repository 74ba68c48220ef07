// Data of each body that many phases read and that follow from its record: rotation matrices, the
// asset and its frame, the pose delta from the recycling pose. Derived, so neither saved nor
// hashed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/units.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/contact/recycling_pose.h"
#include "core/dynamics/state/body_record.h"
#include "core/world/derived/index_set.h"

namespace lockstone {

class BodyCache {
 public:
  /// No function but this allocates.
  explicit BodyCache(std::uint32_t body_capacity);

  /// Null: a shape complete in itself.
  [[nodiscard]] const geometry::AssetGeometry* asset(std::uint32_t body) const {
    return assets_[body];
  }
  void set_asset(std::uint32_t body, const geometry::AssetGeometry* asset) {
    assets_[body] = asset;
  }

  [[nodiscard]] const Mat3& rotation(std::uint32_t body) const { return rotations_[body]; }
  /// By body index.
  [[nodiscard]] const std::vector<Mat3>& rotations() const { return rotations_; }
  /// To be written by a kernel; `refresh_turned` follows for each body.
  [[nodiscard]] Mat3* rotations_out() { return rotations_.data(); }

  /// The radius of a ball within the shape.
  [[nodiscard]] Length inner_radius(std::uint32_t body) const { return inner_radii_[body]; }

  /// At the recycling pose, by body index.
  [[nodiscard]] const std::vector<Mat3>& recycling_rotations() const {
    return recycling_rotations_;
  }
  /// From the recycling pose.
  [[nodiscard]] const PoseDelta& pose_delta(std::uint32_t body) const { return pose_deltas_[body]; }
  /// Another number whenever the recycling pose is another.
  [[nodiscard]] std::uint32_t recycling_pose_number(std::uint32_t body) const {
    return recycling_pose_numbers_[body];
  }

  /// Bodies with hit events.
  [[nodiscard]] const IndexSet& hit_bodies() const { return hit_bodies_; }
  /// Bodies that ask for an event in each tick of a contact.
  [[nodiscard]] const IndexSet& persist_bodies() const { return persist_bodies_; }
  /// After a change of the event settings; `refresh_shape` does so too.
  void refresh_events(std::uint32_t body, const BodyRecord& record);
  void forget_events(std::uint32_t body) {
    hit_bodies_.erase(body);
    persist_bodies_.erase(body);
  }
  void forget_events() {
    hit_bodies_.clear();
    persist_bodies_.clear();
  }

  /// The body's shape where it is.
  [[nodiscard]] PlacedShape placed(std::uint32_t body, const BodyRecord& record) const;
  /// The body's shape at its recycling pose.
  [[nodiscard]] PlacedShape recycled(std::uint32_t body, const BodyRecord& record) const;

  /// After any change of the record but its shape.
  void refresh(std::uint32_t body, const BodyRecord& record);
  /// After a change of the shape or the asset.
  void refresh_shape(std::uint32_t body, const BodyRecord& record);
  /// After the body moved, and its rotation was written. A recycling pose that the body has left
  /// keeps its rotation.
  void refresh_turned(std::uint32_t body, const BodyRecord& record);
  /// After a load of another pose of the same body, before `refresh_turned`.
  void refresh_contact_rotation(std::uint32_t body, const BodyRecord& record);
  /// Sets the recycling pose to the body's own.
  void renew_recycling_pose(std::uint32_t body, BodyRecord& record);

 private:
  // All by body.
  std::vector<const geometry::AssetGeometry*> assets_;
  std::vector<Mat3> rotations_;
  std::vector<Mat3> recycling_rotations_;
  std::vector<PoseDelta> pose_deltas_;
  std::vector<std::uint32_t> recycling_pose_numbers_;
  std::vector<ShapeFrame> frames_;  // kept where an asset is
  std::vector<Length> inner_radii_;
  IndexSet hit_bodies_;
  IndexSet persist_bodies_;
};

}  // namespace lockstone
