// clang-format off: it includes the one that must come before their others
#include "tools/bench/peers/jolt_parts.h"
// clang-format on

#include <Jolt/Physics/Constraints/DistanceConstraint.h>
#include <Jolt/Physics/Constraints/FixedConstraint.h>
#include <Jolt/Physics/Constraints/HingeConstraint.h>
#include <Jolt/Physics/Constraints/PointConstraint.h>
#include <Jolt/Physics/Constraints/SliderConstraint.h>
#include <Jolt/Physics/Constraints/SwingTwistConstraint.h>

namespace lockstone::bench::jolt {

using namespace general;

namespace {

// Places and axes in each body's frame, from its centre of mass.
struct Frames {
  JPH::Vec3 point_a, point_b, x_a, x_b, y_a, y_b;
};

Frames frames_of(const GeneralJoint& joint, const JPH::Body& a, const JPH::Body& b) {
  return {vec(joint.anchor_a) - a.GetShape()->GetCenterOfMass(),
          vec(joint.anchor_b) - b.GetShape()->GetCenterOfMass(),
          vec(turned(joint.frame_a, {1, 0, 0})),
          vec(turned(joint.frame_b, {1, 0, 0})),
          vec(turned(joint.frame_a, {0, 1, 0})),
          vec(turned(joint.frame_b, {0, 1, 0}))};
}

template <class Settings>
Settings local(const Frames& f) {
  Settings def;
  def.mSpace = JPH::EConstraintSpace::LocalToBodyCOM;
  def.mPoint1 = JPH::RVec3(f.point_a);
  def.mPoint2 = JPH::RVec3(f.point_b);
  return def;
}

void set_limits(float& low, float& high, const GeneralJoint& joint) {
  if (!joint.limited) return;
  low = static_cast<float>(joint.lower);
  high = static_cast<float>(joint.upper);
}

JPH::TwoBodyConstraint* hinge(const GeneralJoint& joint, JPH::Body& a, JPH::Body& b,
                              const Frames& f) {
  auto def = local<JPH::HingeConstraintSettings>(f);
  def.mHingeAxis1 = f.x_a;
  def.mHingeAxis2 = f.x_b;
  def.mNormalAxis1 = f.y_a;
  def.mNormalAxis2 = f.y_b;
  set_limits(def.mLimitsMin, def.mLimitsMax, joint);
  if (joint.effort > 0) def.mMotorSettings.SetTorqueLimit(static_cast<float>(joint.effort));
  def.mMotorSettings.mSpringSettings = {JPH::ESpringMode::FrequencyAndDamping,
                                        static_cast<float>(joint.hertz),
                                        static_cast<float>(joint.damping)};
  auto* made = static_cast<JPH::HingeConstraint*>(def.Create(a, b));
  if (joint.effort > 0) {
    made->SetMotorState(JPH::EMotorState::Velocity);
    made->SetTargetAngularVelocity(static_cast<float>(joint.speed));
  } else if (joint.hertz > 0) {
    made->SetMotorState(JPH::EMotorState::Position);
    made->SetTargetAngle(static_cast<float>(joint.target));
  }
  return made;
}

JPH::TwoBodyConstraint* rod(const GeneralJoint& joint, JPH::Body& a, JPH::Body& b,
                            const Frames& f) {
  auto def = local<JPH::DistanceConstraintSettings>(f);
  def.mMinDistance = def.mMaxDistance = static_cast<float>(joint.target);
  set_limits(def.mMinDistance, def.mMaxDistance, joint);
  def.mLimitsSpringSettings = {JPH::ESpringMode::FrequencyAndDamping,
                               static_cast<float>(joint.hertz), static_cast<float>(joint.damping)};
  return def.Create(a, b);
}

JPH::TwoBodyConstraint* ball(const GeneralJoint& joint, JPH::Body& a, JPH::Body& b,
                             const Frames& f) {
  if (!joint.limited) return local<JPH::PointConstraintSettings>(f).Create(a, b);
  JPH::SwingTwistConstraintSettings def;
  def.mSpace = JPH::EConstraintSpace::LocalToBodyCOM;
  def.mPosition1 = JPH::RVec3(f.point_a);
  def.mPosition2 = JPH::RVec3(f.point_b);
  def.mTwistAxis1 = f.x_a;
  def.mTwistAxis2 = f.x_b;
  def.mPlaneAxis1 = f.y_a;
  def.mPlaneAxis2 = f.y_b;
  def.mNormalHalfConeAngle = def.mPlaneHalfConeAngle = static_cast<float>(joint.cone);
  set_limits(def.mTwistMinAngle, def.mTwistMaxAngle, joint);
  return def.Create(a, b);
}

}  // namespace

JPH::TwoBodyConstraint* constraint_of(const GeneralJoint& joint, JPH::Body& a, JPH::Body& b) {
  const Frames f = frames_of(joint, a, b);
  if (joint.link == Link::hinge) return hinge(joint, a, b, f);
  if (joint.link == Link::rod) return rod(joint, a, b, f);
  if (joint.link == Link::ball) return ball(joint, a, b, f);
  if (joint.link == Link::weld) {
    auto def = local<JPH::FixedConstraintSettings>(f);
    def.mAxisX1 = f.x_a;
    def.mAxisX2 = f.x_b;
    def.mAxisY1 = f.y_a;
    def.mAxisY2 = f.y_b;
    return def.Create(a, b);
  }
  auto def = local<JPH::SliderConstraintSettings>(f);
  def.mSliderAxis1 = f.x_a;
  def.mSliderAxis2 = f.x_b;
  def.mNormalAxis1 = f.y_a;
  def.mNormalAxis2 = f.y_b;
  set_limits(def.mLimitsMin, def.mLimitsMax, joint);
  if (joint.effort > 0) def.mMotorSettings.SetForceLimit(static_cast<float>(joint.effort));
  auto* made = static_cast<JPH::SliderConstraint*>(def.Create(a, b));
  if (joint.effort > 0) {
    made->SetMotorState(JPH::EMotorState::Velocity);
    made->SetTargetVelocity(static_cast<float>(joint.speed));
  }
  return made;
}

}  // namespace lockstone::bench::jolt
