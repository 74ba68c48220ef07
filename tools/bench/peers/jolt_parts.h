// Shapes and joints of the scenes in Jolt, by its public headers.
#pragma once

#include <map>
#include <utility>

// clang-format off: this one must come before their others
#include <Jolt/Jolt.h>
// clang-format on

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Collision/Shape/Shape.h>
#include <Jolt/Physics/Constraints/TwoBodyConstraint.h>

#include "tools/bench/general/vectors.h"

namespace lockstone::bench::jolt {

inline JPH::Vec3 vec(const Triple& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
inline JPH::Quat quat(const Turn& q) {
  return JPH::Quat(static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                   static_cast<float>(q[3]))
      .Normalized();
}
inline Triple triple(const JPH::Vec3& v) {
  return {v.GetX(), v.GetY(), v.GetZ()};
}

/// By their numbers, so that bodies share them.
class Shapes {
 public:
  /// Null where Jolt refuses the shape.
  [[nodiscard]] JPH::ShapeRefC of_body(const GeneralBody& body);

 private:
  [[nodiscard]] JPH::ShapeRefC of(const GeneralShape& shape, double density);

  std::map<std::pair<GeneralShape, double>, JPH::ShapeRefC> known_;
};

[[nodiscard]] JPH::TwoBodyConstraint* constraint_of(const GeneralJoint& joint, JPH::Body& a,
                                                    JPH::Body& b);

}  // namespace lockstone::bench::jolt
