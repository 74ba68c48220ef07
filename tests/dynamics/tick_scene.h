// A scene of the contact solver that tests build body by body and contact by contact.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

inline constexpr auto k_static = MotionType::static_body, k_kinematic = MotionType::kinematic,
                      k_dynamic = MotionType::dynamic;

class TickScene {
 public:
  static constexpr std::uint32_t k_capacity = 64;

  std::uint32_t add_body(MotionType motion) {
    BodyRecord& body = bodies_.emplace_back();
    body.motion = static_cast<std::uint8_t>(motion);
    body.orientation = body.recycling_orientation = Quat{};
    return static_cast<std::uint32_t>(bodies_.size() - 1);
  }
  BodyRecord& body(std::uint32_t index) { return bodies_[index]; }

  ContactRecord& add_contact(std::uint32_t a, std::uint32_t b, const Vec3<Unit>& normal = {}) {
    manifolds_.emplace_back().normal = normal;
    surfaces_.emplace_back();
    ids_.push_back(static_cast<std::uint32_t>(ids_.size()));
    ContactRecord& record = records_.emplace_back();
    record.body_a = a;
    record.body_b = b;
    record.count = 1;
    return record;
  }
  ContactSurface& surface(std::size_t contact) { return surfaces_[contact]; }
  Manifold& manifold(std::size_t contact) { return manifolds_[contact]; }
  void add_joint(std::uint32_t a, std::uint32_t b) { links_.push_back({0, a, b}); }

  [[nodiscard]] ContactScene get() const {
    return {bodies_, {}, ids_, manifolds_, surfaces_, records_, {}, links_, {}, {}, 0};
  }

  /// Gathers the scene's contacts.
  void gather(std::int64_t bearing_impulse = INT64_MAX) {
    bodies.clear();
    contacts.gather(get(), bearing_impulse, bodies, parallel);
  }

  Parallel parallel;
  SolverBodies bodies{TimeStep::of(60, 4), k_capacity, k_capacity, k_capacity};
  ContactList contacts{k_capacity};
  IslandBuilder islands{k_capacity, k_capacity};

 private:
  std::vector<BodyRecord> bodies_;
  std::vector<std::uint32_t> ids_;
  std::vector<Manifold> manifolds_;
  std::vector<ContactSurface> surfaces_;
  std::vector<ContactRecord> records_;
  std::vector<JointLink> links_;
};

}  // namespace lockstone
