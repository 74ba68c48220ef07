// The inputs of a tick's contact solver, and how it numbers bodies.
#pragma once

#include <cstdint>
#include <span>

#include <lockstone/assert.h>
#include <lockstone/asset.h>

#include "core/dynamics/contact/contact_index.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/surface.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// A contact whose impulses of the tick are added up if it approaches faster than a speed.
struct WatchedContact {
  std::uint32_t record = 0;
  SolverVelocity hit_speed{};
};

/// The solver's inputs from a world. The manifold and the surfaces of record i have the number
/// manifold_ids[i]; those of triggers are left out.
struct ContactScene {
  std::span<const BodyRecord> bodies;
  std::span<const Mat3> rotations;
  std::span<const std::uint32_t> manifold_ids;
  std::span<const Manifold> manifolds;
  std::span<const ContactSurface> surfaces;
  std::span<const ContactRecord> records;
  std::span<const JointRecord> joints;
  std::span<const JointLink> joint_links;
  const AssetSet* assets = nullptr;  // that has the paths of joints; may be null without any
  Vec3<Acceleration> gravity;
  std::uint64_t tick = 0;
  std::span<const WatchedContact> watched{};  // by record
};

/// A body of the world with its motion type, by which it enters the solver, and a mark. Zero: none.
class BodySide {
 public:
  BodySide() = default;
  BodySide(std::uint32_t body, MotionType motion)
      : word_(body | static_cast<std::uint32_t>(motion) << k_motion_bit) {
    LKS_ASSERT(body >> k_mark_bit == 0);
  }

  [[nodiscard]] std::uint32_t body() const { return word_ & ((1U << k_mark_bit) - 1); }
  [[nodiscard]] MotionType motion() const { return static_cast<MotionType>(word_ >> k_motion_bit); }
  [[nodiscard]] bool is_dynamic() const { return motion() == MotionType::dynamic; }
  [[nodiscard]] bool is_none() const { return word_ == 0; }
  [[nodiscard]] bool is_marked() const { return (word_ >> k_mark_bit & 1) != 0; }
  void mark() { word_ |= 1U << k_mark_bit; }

 private:
  static constexpr int k_motion_bit = 30, k_mark_bit = 29;

  std::uint32_t word_ = 0;
};

/// A body of a contact as the solver numbers it. Bodies that can move have numbers from 1 on; a
/// body that stands still has no number, but a row of its own in each of its constraints.
class BodyRef {
 public:
  BodyRef() = default;
  [[nodiscard]] static BodyRef numbered(std::uint32_t number) { return BodyRef(number); }
  [[nodiscard]] static BodyRef standing(std::uint32_t index) { return BodyRef(index | k_standing); }

  [[nodiscard]] bool is_standing() const { return (word_ & k_standing) != 0; }
  [[nodiscard]] std::uint32_t number() const {
    LKS_ASSERT(!is_standing());
    return word_;
  }
  /// The how-manieth standing one.
  [[nodiscard]] std::uint32_t standing_index() const {
    LKS_ASSERT(is_standing());
    return word_ & ~k_standing;
  }

 private:
  static constexpr std::uint32_t k_standing = 0x80000000;

  explicit BodyRef(std::uint32_t word) : word_(word) {}

  std::uint32_t word_ = 0;
};

}  // namespace lockstone
