// The ids of the tick's manifolds, which workers take side by side.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/collision/narrow_phase/collide_bodies.h"
#include "core/dynamics/state/contact_record.h"
#include "core/geometry/contact/box/box_batch.h"
#include "core/world/phases/narrow/seam_contacts.h"

namespace lockstone {

/// An orientation; or the number of a body's recycling pose, which tells as much.
struct PoseKey {
  std::int32_t x = 0, y = 0, z = 0, w = 0;

  friend constexpr bool operator==(const PoseKey& a, const PoseKey& b) {
    return ((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z) | (a.w ^ b.w)) == 0;
  }
};

[[nodiscard]] constexpr PoseKey key_of(const Quat& q) {
  return {q.x.raw, q.y.raw, q.z.raw, q.w.raw};
}

/// No orientation has components as large.
[[nodiscard]] constexpr PoseKey key_of_recycling_pose(std::uint32_t number) {
  return {static_cast<std::int32_t>(number), std::numeric_limits<std::int32_t>::max(), 0, 0};
}

/// The inputs of the manifold of two convex shapes, besides the shapes.
struct ManifoldInput {
  Vec3<Position> offset{};
  PoseKey pose_a{}, pose_b{};
  Length margin{};
  // Of HeldFeatures. A manifold that was found while others were held may be another one once its
  // own are.
  static constexpr std::uint8_t k_holds_none = 0, k_holds_own = 16, k_holds_others = 255;
  std::uint8_t held = k_holds_none;  // or k_holds_own, with bit n if an impulse pushed at point n

  friend bool operator==(const ManifoldInput&, const ManifoldInput&) = default;
  /// Where poses tell all: recycling poses do.
  [[nodiscard]] bool has_same_poses(const ManifoldInput& other) const {
    return pose_a == other.pose_a && pose_b == other.pose_b && margin == other.margin &&
           held == other.held;
  }
};

/// The separations of a manifold at the poses where it was found, before the pose deltas of its
/// bodies are added (recycling_pose.h).
using FoundSeparations = std::array<Displacement, k_max_manifold_points>;

/// Box pairs that wait for others to be collided with them.
struct WaitingBoxes {
  struct Entry {
    std::uint32_t index = 0;
    ManifoldInput input{};
    HeldFeatures held{};
    std::span<const ContactRecord> before{};
  };

  geometry::BoxBatch batch;
  std::array<Entry, geometry::BoxBatch::k_capacity> entries;
  bool are_admitted = false;  // else each pair is collided by itself, in order
};

/// The scratch memory of a worker.
struct alignas(64) PairScratch {
  PartContacts part_contacts;                  // of the pair at hand
  std::unique_ptr<TriangleScratch> triangles;  // null when no asset has triangles
  WaitingBoxes boxes;
  SeamContacts seams;               // of the body at hand
  std::uint32_t next = 0, end = 0;  // ids at hand
  std::uint32_t taken = 0;          // ids that hold a contact
};

/// One worker gets ids one after the other, until all contacts that a world has room for are
/// there. Several get them by blocks, of which the last is left half empty, so that they need more;
/// where they run out of them, or take more than one worker would get, the caller begins again with
/// one. So which contacts find no room depends on their order alone.
class ManifoldIds {
 public:
  static constexpr std::uint32_t k_none = 0xffffffff;

  /// Makes room; the only function that allocates.
  void prepare(std::uint32_t contact_capacity, std::uint32_t workers, bool with_triangles) {
    const std::uint32_t spare =
        workers > 1 ? contact_capacity / 8 + 2 * k_block * workers : k_block;
    room_ = contact_capacity + k_block;
    capacity_ = std::max(capacity_, contact_capacity + spare);
    while (scratch_.size() < workers) {
      scratch_.push_back(std::make_unique<PairScratch>());
      if (with_triangles) scratch_.back()->triangles = std::make_unique<TriangleScratch>();
    }
  }

  [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
  [[nodiscard]] PairScratch& scratch(std::uint32_t worker) { return *scratch_[worker]; }

  /// `with_batches`: pairs may wait for others, so that ids are not given out in their order.
  void begin(std::uint32_t workers, bool with_batches) {
    block_ = workers > 1 ? k_block : 1;
    limit_ = workers > 1 ? capacity_ : room_;
    used_ = 0;
    out_of_ids_ = overflowed_ = has_elastic_ = has_seams_ = false;
    dropped_ = 0;
    for (const std::unique_ptr<PairScratch>& scratch : scratch_) {
      scratch->next = scratch->end = scratch->taken = 0;
      scratch->boxes.are_admitted = with_batches;
    }
  }

  /// The first of `count` ids in a row, or k_none.
  std::uint32_t take(PairScratch& scratch, std::uint32_t count) {
    scratch.taken += count;
    if (scratch.end - scratch.next < count) {
      // One worker goes on with an id that it gave back.
      const std::uint32_t left = block_ == 1 ? scratch.end - scratch.next : 0;
      const std::uint32_t size = std::max(block_, count - left);
      // Nobody asks on once it is known that there is no more, so that the number does not wrap.
      if (out_of_ids_.load(std::memory_order_relaxed)) return k_none;
      scratch.next = used_.fetch_add(size, std::memory_order_relaxed) - left;
      scratch.end = scratch.next + left + size;
      if (scratch.end > limit_) {
        scratch.next = scratch.end = 0;
        out_of_ids_.store(true, std::memory_order_relaxed);
        return k_none;
      }
    }
    const std::uint32_t first = scratch.next;
    scratch.next += count;
    return first;
  }

  /// Takes back the last id that `take` gave, or the request for one.
  static void release(PairScratch& scratch, std::uint32_t id) {
    --scratch.taken;
    if (id != k_none) --scratch.next;
  }

  /// Whether some contact has no id, or would have none if one worker had taken them.
  [[nodiscard]] bool is_out_of_ids() const { return out_of_ids_ || taken_at_first() > room_; }

  /// Contacts since `begin`, those without an id included, those dropped not.
  [[nodiscard]] std::uint32_t taken() const { return taken_at_first() - dropped_; }
  /// The same with those dropped.
  [[nodiscard]] std::uint32_t taken_at_first() const {
    std::uint32_t sum = 0;
    for (const std::unique_ptr<PairScratch>& scratch : scratch_)
      sum += scratch->taken;
    return sum;
  }

  /// For contacts that turned out to be none; their ids stay taken.
  void note_dropped(std::uint32_t count) {
    if (count != 0) dropped_.fetch_add(count, std::memory_order_relaxed);
  }

  /// For bodies that may touch more than one static piece.
  void note_seams() {
    if (!has_seams_.load(std::memory_order_relaxed))
      has_seams_.store(true, std::memory_order_relaxed);
  }
  [[nodiscard]] bool has_seams() const { return has_seams_; }

  /// For pairs of which parts were left out.
  void note_overflow() { overflowed_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool has_overflowed() const { return overflowed_; }

  /// For contacts with restitution.
  void note_elastic() {
    if (!has_elastic_.load(std::memory_order_relaxed))
      has_elastic_.store(true, std::memory_order_relaxed);
  }
  [[nodiscard]] bool has_elastic() const { return has_elastic_; }

 private:
  static constexpr std::uint32_t k_block = 64;
  static_assert(k_block >= PartContacts::k_capacity);

  std::vector<std::unique_ptr<PairScratch>> scratch_;  // by worker
  std::uint32_t capacity_ = 0;
  std::uint32_t room_ = 0;   // of one worker
  std::uint32_t limit_ = 0;  // of all in this run
  std::uint32_t block_ = 1;
  std::atomic<std::uint32_t> used_{0};
  std::atomic<bool> out_of_ids_{false};
  std::atomic<bool> overflowed_{false};
  std::atomic<bool> has_elastic_{false};
  std::atomic<bool> has_seams_{false};
  std::atomic<std::uint32_t> dropped_{0};
};

}  // namespace lockstone
