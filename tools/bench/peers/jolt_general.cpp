// The scenes of families in Jolt, by its public headers, in single precision on one thread.
#include <algorithm>
#include <mutex>
#include <set>
#include <vector>

// clang-format off: this one must come before their others
#include <Jolt/Jolt.h>
// clang-format on

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/GroupFilterTable.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Constraints/DistanceConstraint.h>
#include <Jolt/Physics/Constraints/FixedConstraint.h>
#include <Jolt/Physics/Constraints/HingeConstraint.h>
#include <Jolt/Physics/Constraints/PointConstraint.h>
#include <Jolt/Physics/Constraints/SliderConstraint.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include "tools/bench/general/vectors.h"
#include "tools/bench/peers/general_peers.h"

namespace lockstone::bench {
namespace {

using namespace general;

constexpr JPH::ObjectLayer k_fixed = 0, k_moving = 1, k_nothing = 2;

void start_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();
    JPH::RegisterTypes();
  });
}

JPH::Vec3 vec(const Triple& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
JPH::Quat quat(const Turn& q) {
  return JPH::Quat(static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                   static_cast<float>(q[3]))
      .Normalized();
}
Triple triple(const JPH::Vec3& v) {
  return {v.GetX(), v.GetY(), v.GetZ()};
}

class Layers final : public JPH::BroadPhaseLayerInterface {
 public:
  [[nodiscard]] JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
  [[nodiscard]] JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override {
    return JPH::BroadPhaseLayer(0);
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  [[nodiscard]] const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override {
    return "all";
  }
#endif
};

class AllLayers final : public JPH::ObjectVsBroadPhaseLayerFilter {};

class Pairs final : public JPH::ObjectLayerPairFilter {
 public:
  [[nodiscard]] bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return a != k_nothing && b != k_nothing && (a == k_moving || b == k_moving);
  }
};

// Which bodies a sensor saw in the last step.
class Sensors final : public JPH::ContactListener {
 public:
  void OnContactAdded(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold&,
                      JPH::ContactSettings&) override {
    if (a.IsSensor()) seen.insert(b.GetID());
    if (b.IsSensor()) seen.insert(a.GetID());
  }
  std::set<JPH::BodyID> seen;
};

JPH::ShapeRefC hull_of(const GeneralBody& body) {
  JPH::Array<JPH::Vec3> points;
  for (const Triple& point : body.points)
    points.push_back(vec(point));
  const JPH::ShapeSettings::ShapeResult made = JPH::ConvexHullShapeSettings(points).Create();
  return made.IsValid() ? made.Get() : JPH::ShapeRefC();
}

JPH::ShapeRefC shape_of(const GeneralBody& body) {
  const JPH::Vec3 size = vec(body.size);
  JPH::ShapeRefC shape;
  if (body.form == Form::sphere) shape = new JPH::SphereShape(size.GetX());
  if (body.form == Form::capsule) shape = new JPH::CapsuleShape(size.GetY(), size.GetX());
  if (body.form == Form::box)
    shape = new JPH::BoxShape(size, std::min(0.05F, 0.1F * size.ReduceMin()));
  if (body.form == Form::hull) shape = hull_of(body);
  if (shape != nullptr) {
    auto* convex = static_cast<JPH::ConvexShape*>(const_cast<JPH::Shape*>(shape.GetPtr()));
    convex->SetDensity(static_cast<float>(body.density));
  }
  return shape;
}

JPH::BodyCreationSettings settings_of(const GeneralBody& body, const JPH::Shape* shape,
                                      bool may_sleep) {
  const JPH::EMotionType motion = body.motion == Motion::fixed       ? JPH::EMotionType::Static
                                  : body.motion == Motion::kinematic ? JPH::EMotionType::Kinematic
                                                                     : JPH::EMotionType::Dynamic;
  JPH::ObjectLayer layer = body.motion == Motion::fixed ? k_fixed : k_moving;
  if (!body.collides) layer = k_nothing;
  JPH::BodyCreationSettings def(shape, JPH::RVec3(vec(body.position)), quat(body.orientation),
                                motion, layer);
  def.mFriction = static_cast<float>(body.friction);
  def.mRestitution = static_cast<float>(body.restitution);
  def.mLinearDamping = def.mAngularDamping = 0;
  def.mLinearVelocity = vec(body.velocity);
  def.mAngularVelocity = vec(body.angular_velocity);
  def.mAllowSleeping = may_sleep;
  def.mIsSensor = body.trigger;
  def.mMaxAngularVelocity = 1000;
  if (body.moves()) def.mMotionQuality = JPH::EMotionQuality::LinearCast;
  return def;
}

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

JPH::TwoBodyConstraint* constraint_of(const GeneralJoint& joint, JPH::Body& a, JPH::Body& b) {
  const Frames f = frames_of(joint, a, b);
  if (joint.link == Link::hinge) return hinge(joint, a, b, f);
  if (joint.link == Link::rod) return rod(joint, a, b, f);
  if (joint.link == Link::ball) return local<JPH::PointConstraintSettings>(f).Create(a, b);
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
  return def.Create(a, b);
}

class JoltGeneral final : public GeneralEngine {
 public:
  JoltGeneral(const GeneralScene& scene, int substeps)
      : memory_(64 << 20), substeps_(substeps), jobs_(JPH::cMaxPhysicsJobs) {
    const auto bodies = static_cast<JPH::uint>(scene.bodies.size());
    const JPH::uint pairs = std::min(65536U, std::max(1024U, 64 * bodies));
    system_.Init(bodies + 1, 0, pairs, pairs, layers_, all_, pairs_);
    system_.SetGravity(vec({0, -scene.gravity, 0}));
    system_.SetContactListener(&sensors_);
    auto* group = new JPH::GroupFilterTable(bodies);
    for (const GeneralJoint& joint : scene.joints)
      group->DisableCollision(static_cast<JPH::uint>(joint.a), static_cast<JPH::uint>(joint.b));
    const JPH::Ref<JPH::GroupFilter> filter = group;
    for (const GeneralBody& body : scene.bodies)
      add(body, scene, filter);
    for (const GeneralJoint& joint : scene.joints)
      system_.AddConstraint(constraint_of(joint, *at(joint.a), *at(joint.b)));
    system_.OptimizeBroadPhase();
  }
  ~JoltGeneral() override {
    JPH::Constraints all = system_.GetConstraints();
    for (const auto& constraint : all)
      system_.RemoveConstraint(constraint);
    for (JPH::Body* body : bodies_) {
      interface().RemoveBody(body->GetID());
      interface().DestroyBody(body->GetID());
    }
  }

  void step() override {
    sensors_.seen.clear();
    system_.Update(1.0F / 60, substeps_, &memory_, &jobs_);
  }
  void set_motion(int body, const Triple& velocity, const Triple& angular_velocity) override {
    interface().SetLinearAndAngularVelocity(at(body)->GetID(), vec(velocity),
                                            vec(angular_velocity));
  }
  [[nodiscard]] GeneralState state(int index) const override {
    const JPH::Body& body = *at(index);
    const JPH::Quat q = body.GetRotation();
    return {triple(JPH::Vec3(body.GetPosition())),
            {q.GetX(), q.GetY(), q.GetZ(), q.GetW()},
            body.IsStatic() ? Triple{} : triple(body.GetLinearVelocity()),
            body.IsStatic() ? Triple{} : triple(body.GetAngularVelocity())};
  }
  [[nodiscard]] bool asleep(int body) const override { return !at(body)->IsActive(); }
  [[nodiscard]] bool entered(int body) const override {
    return sensors_.seen.count(at(body)->GetID()) > 0;
  }

 private:
  [[nodiscard]] JPH::BodyInterface& interface() { return system_.GetBodyInterfaceNoLock(); }
  [[nodiscard]] JPH::Body* at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

  void add(const GeneralBody& body, const GeneralScene& scene,
           const JPH::Ref<JPH::GroupFilter>& filter) {
    const JPH::ShapeRefC shape = shape_of(body);
    JPH::BodyCreationSettings def = settings_of(body, shape, scene.may_sleep);
    const auto index = static_cast<JPH::CollisionGroup::SubGroupID>(bodies_.size());
    if (!scene.joints.empty()) def.mCollisionGroup = JPH::CollisionGroup(filter, 0, index);
    bodies_.push_back(interface().CreateBody(def));
    interface().AddBody(bodies_.back()->GetID(), JPH::EActivation::Activate);
  }

  Layers layers_;
  AllLayers all_;
  Pairs pairs_;
  Sensors sensors_;
  JPH::TempAllocatorImpl memory_;
  int substeps_;
  JPH::JobSystemSingleThreaded jobs_;
  JPH::PhysicsSystem system_;
  std::vector<JPH::Body*> bodies_;
};

}  // namespace

std::unique_ptr<GeneralEngine> make_jolt_general(const GeneralScene& scene, int substeps) {
  const auto has_spring = [](const GeneralJoint& joint) {
    return joint.link == Link::ball && joint.hertz > 0;
  };
  if (std::ranges::any_of(scene.joints, has_spring)) return nullptr;  // its points have none
  start_library();
  return std::make_unique<JoltGeneral>(scene, substeps);
}

}  // namespace lockstone::bench
