// Collides pairs one after the other, or keeps their manifolds of the tick before.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/phases/narrow/narrow_data.h"

namespace lockstone {

/// One worker's part of the narrow phase. Box pairs may wait for others, to be collided with them:
/// `finish` collides the last ones.
class PairCollider {
 public:
  PairCollider(NarrowData& data, PairScratch& scratch)
      : data_(data), world_(data.world), scratch_(scratch) {}

  /// `before`: the records of this pair a tick ago. `last_axis` parted the pair then, unless it is
  /// zero.
  void collide(std::uint32_t index, std::span<const ContactRecord> before,
               const Vec3<Unit>& last_axis);
  /// All contacts of two bodies, as they are or at their recycling poses; nothing is remembered.
  void collide_all_parts(const Pair& pair, PartContacts& parts) const;
  void finish() {
    if (scratch_.boxes.batch.size() > 0) collide_waiting();
  }

 private:
  static constexpr std::uint32_t k_nothing = 0xffffffff;

  [[nodiscard]] std::uint32_t remembered_manifold(std::span<const ContactRecord> before) const;
  // Where it is, or at its recycling pose.
  [[nodiscard]] PlacedShape placed(std::uint32_t body, bool is_recycled) const;
  // The same of the first of a pair, which the next pairs mostly have too.
  [[nodiscard]] const PlacedShape& placed_first(std::uint32_t body, bool is_recycled);
  // `margin_of`, by the turning speeds of the tick.
  [[nodiscard]] Length margin_in_tick(const Pair& pair) const;
  void read_poses(const Pair& pair, Length margin, ManifoldInput& input) const;
  [[nodiscard]] bool are_primitives(const Pair& pair) const;
  [[nodiscard]] bool is_bounded_primitive(std::uint32_t body) const;
  [[nodiscard]] const std::vector<Mat3>& rotations_of(const Pair& pair) const;
  void collide_primitives(std::uint32_t index, std::span<const ContactRecord> before,
                          const Vec3<Unit>& last_axis, PairTimer& timer);
  void collide_one_way(std::uint32_t index, std::span<const ContactRecord> before,
                       PairTimer& timer);
  int collide_alone(const WaitingBoxes::Entry& entry);
  void collide_waiting();
  template <class Find>
  int add_found(const WaitingBoxes::Entry& entry, Find&& find);
  void add_known(std::uint32_t index, std::uint32_t known, const ManifoldInput& input,
                 std::span<const ContactRecord> before);
  void add_contacts(std::uint32_t index, std::span<const PartContact> parts,
                    const ManifoldInput& input, std::span<const ContactRecord> before);
  void add_trigger(std::uint32_t index, std::span<const ContactRecord> before);
  void fill_single(std::uint32_t index, std::uint32_t id, const ManifoldInput& input,
                   std::span<const ContactRecord> before);
  void fill_found(const WaitingBoxes::Entry& entry, std::uint32_t id);
  void fill(std::uint32_t id, const ContactKey& key, const Surface* surface_a,
            const Surface* surface_b, const ManifoldInput& input,
            std::span<const ContactRecord> before);
  void shift_by_pose_delta(const Pair& pair, Manifold& manifold) const;

  NarrowData& data_;
  WorldData& world_;
  PairScratch& scratch_;
  // The last that `placed_first` placed.
  std::uint32_t first_ = k_nothing;
  bool first_is_recycled_ = false;
  PlacedShape placed_first_;
};

}  // namespace lockstone
