// A touching or nearly touching pair as it is stored, saved and hashed.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

/// Bits of ContactRecord::flags.
enum ContactFlag : std::uint16_t {
  k_contact_trigger = 1,   // one of the two is a trigger: no points
  k_contact_touching = 2,  // the surfaces met, or pushed, in the last step
  k_contact_passing = 4,   // through a one-way body: no points
  k_all_contact_flags = k_contact_trigger | k_contact_touching | k_contact_passing,
};

/// The state of one contact point between ticks. Impulses are the pair's velocity jump,
/// λ·(1/mA + 1/mB), per substep.
struct ContactPointRecord {
  std::uint32_t feature = 0;
  SolverVelocity normal_impulse{};

  friend bool operator==(const ContactPointRecord&, const ContactPointRecord&) = default;
};

/// The two bodies and parts of a contact. A part is a piece of a compound, or a group of triangles.
struct ContactKey {
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;

  friend constexpr auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// Records are sorted by key; unused points are zero.
struct ContactRecord {
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;
  std::array<ContactPointRecord, 4> points{};
  Vec3<SolverVelocity> friction_impulse{};  // of all points, in world axes
  Vec3<SolverVelocity> rolling_impulse{};   // torque / ℓ, in world axes
  SolverVelocity twist_impulse{};           // about the normal, at the points' mean radius
  SolverVelocity mean_impulse{};            // mean normal impulse of a point, or 0
  std::uint16_t count = 0;                  // 0 … 4
  std::uint16_t flags = 0;                  // ContactFlag

  friend bool operator==(const ContactRecord&, const ContactRecord&) = default;

  [[nodiscard]] ContactKey key() const { return {body_a, body_b, part_a, part_b}; }
  /// A contact that has just been found: without points, impulses and flags.
  [[nodiscard]] static ContactRecord of(const ContactKey& key) {
    return {.body_a = key.body_a, .body_b = key.body_b, .part_a = key.part_a, .part_b = key.part_b};
  }
  /// The normal impulse of the point with this feature; 0 where there is none.
  [[nodiscard]] SolverVelocity impulse_of(std::uint32_t feature) const {
    for (std::size_t i = 0; i < count; ++i)
      if (points[i].feature == feature) return points[i].normal_impulse;
    return {};
  }
  [[nodiscard]] bool is_trigger() const { return (flags & k_contact_trigger) != 0; }
  [[nodiscard]] bool is_passing() const { return (flags & k_contact_passing) != 0; }
  /// Whether the contact pushes nothing: it has no points.
  [[nodiscard]] bool is_inert() const {
    return (flags & (k_contact_trigger | k_contact_passing)) != 0;
  }
  [[nodiscard]] bool is_touching() const { return (flags & k_contact_touching) != 0; }
};

template <class F>
constexpr void visit_fields(ContactRecord& record, F&& f) {
  constexpr const char* k_point_names[] = {"point[0]", "point[1]", "point[2]", "point[3]"};
  visit_value("body_a", "", record.body_a, f);
  visit_value("body_b", "", record.body_b, f);
  visit_value("part_a", "", record.part_a, f);
  visit_value("part_b", "", record.part_b, f);
  for (std::size_t i = 0; i < record.points.size(); ++i) {
    ContactPointRecord& point = record.points[i];
    visit_value(k_point_names[i], ".feature", point.feature, f);
    visit_value(k_point_names[i], ".normal_impulse", point.normal_impulse, f);
  }
  visit_value("friction_impulse", "", record.friction_impulse, f);
  visit_value("rolling_impulse", "", record.rolling_impulse, f);
  visit_value("twist_impulse", "", record.twist_impulse, f);
  visit_value("mean_impulse", "", record.mean_impulse, f);
  visit_value("count", "", record.count, f);
  visit_value("flags", "", record.flags, f);
}

static_assert(visited_bytes<ContactRecord>() == sizeof(ContactRecord), "a field is missing");

}  // namespace lockstone
