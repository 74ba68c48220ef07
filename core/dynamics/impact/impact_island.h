// Impact islands: bodies that bounce off each other, or off immovable bodies, at the moments of the
// tick at which they meet.
//
// Height and speed then agree, so that a bounce neither wins nor loses energy; and impacts follow
// one after the other, so that a push passes along a row of balls.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/dynamics/impact/impact_total.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/surface.h"
#include "core/dynamics/state/time_step.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

inline constexpr std::size_t k_most_bounce_contacts = 32;

/// Slower ones do not bounce: a ball would be back within half a tick.
inline constexpr Velocity k_least_bounce = Velocity::from_ratio(1, 32);

/// Where two bodies meet.
struct ImpactPair {
  BodyRecord* a = nullptr;
  BodyRecord* b = nullptr;
  const Manifold* manifold = nullptr;       ///< of the tick's beginning
  const ContactSurface* surface = nullptr;  ///< friction and restitution
  bool is_watched = false;                  ///< its impulses are added up
};

/// When two bodies meet next.
struct PairImpact {
  bool meets = false;
  std::int64_t fraction = 0;  ///< of the tick, Q30
  Velocity speed{};
};

/// Within `limit` of the tick, if nothing else happens.
[[nodiscard]] PairImpact next_impact(const ImpactPair& pair, const Vec3<Acceleration>& gravity,
                                     const TimeStep& step, Unit limit);

/// Takes bodies that meet only each other, and bodies that do not give way, through a tick.
class ImpactIsland {
 public:
  ImpactIsland(const Vec3<Acceleration>& gravity, const TimeStep& step)
      : gravity_(gravity), step_(step) {}

  /// At most k_most_bounce_contacts.
  void add(const ImpactPair& pair);

  /// Moves the dynamic bodies: to the tick's end, from impact to impact. Others are only read.
  void run();

  /// By the order of adding: whether the two met, and the greatest speed at which they did.
  [[nodiscard]] bool touched(std::size_t contact) const { return contacts_[contact].touched; }
  [[nodiscard]] Velocity approach(std::size_t contact) const { return contacts_[contact].approach; }
  /// Of a watched pair.
  [[nodiscard]] const ImpactTotal& total(std::size_t contact) const {
    return contacts_[contact].total;
  }

 private:
  struct Flyer {
    BodyRecord* body = nullptr;
    Vec3<Velocity> gain{};  // of the whole tick
  };
  static constexpr std::uint8_t k_none = 0xff;
  struct Contact {
    ImpactPair pair;
    std::uint8_t flyer_a = k_none, flyer_b = k_none;
    std::array<std::int64_t, k_max_manifold_points> gap{};  // m, Q24
    bool rests = false;                                     // met too slowly: left alone
    bool touched = false;
    Velocity approach{};
    ImpactTotal total{};
  };

  std::uint8_t flyer_of(BodyRecord* body);
  [[nodiscard]] Vec3<Velocity> gain_of(std::uint8_t flyer) const;
  [[nodiscard]] PairImpact impact_of(const Contact& contact, Unit limit) const;
  void advance(Unit fraction);
  void answer(Contact& contact, Velocity speed);

  Vec3<Acceleration> gravity_;
  TimeStep step_;
  std::array<Contact, k_most_bounce_contacts> contacts_{};
  std::array<Flyer, 2 * k_most_bounce_contacts> flyers_{};
  std::size_t contact_count_ = 0, flyer_count_ = 0;
};

}  // namespace lockstone
