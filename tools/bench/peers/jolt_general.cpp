// The scenes of families in Jolt, by its public headers, in single precision on one thread.
#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
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
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include "tools/bench/peers/general_peers.h"
#include "tools/bench/peers/jolt_parts.h"

namespace lockstone::bench {
namespace {

using jolt::quat;
using jolt::triple;
using jolt::vec;

constexpr JPH::ObjectLayer k_fixed = 0, k_moving = 1, k_nothing = 2;

void start_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();
    JPH::RegisterTypes();
  });
}

constexpr JPH::BroadPhaseLayer k_fixed_tree(0), k_moving_tree(1);

class Layers final : public JPH::BroadPhaseLayerInterface {
 public:
  [[nodiscard]] JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
  [[nodiscard]] JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
    return layer == k_fixed ? k_fixed_tree : k_moving_tree;
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  [[nodiscard]] const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer layer) const override {
    return layer == k_fixed_tree ? "fixed" : "moving";
  }
#endif
};

class Trees final : public JPH::ObjectVsBroadPhaseLayerFilter {
 public:
  [[nodiscard]] bool ShouldCollide(JPH::ObjectLayer layer,
                                   JPH::BroadPhaseLayer tree) const override {
    return layer == k_moving || (layer == k_fixed && tree == k_moving_tree);
  }
};

class Pairs final : public JPH::ObjectLayerPairFilter {
 public:
  [[nodiscard]] bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return a != k_nothing && b != k_nothing && (a == k_moving || b == k_moving);
  }
};

// Which bodies a sensor saw in the last step, and belts: their surfaces move.
class Listener final : public JPH::ContactListener {
 public:
  void OnContactAdded(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold&,
                      JPH::ContactSettings& settings) override {
    drive(a, b, settings);
    if (a.IsSensor()) seen.insert(b.GetID());
    if (b.IsSensor()) seen.insert(a.GetID());
  }
  void OnContactPersisted(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold&,
                          JPH::ContactSettings& settings) override {
    drive(a, b, settings);
  }
  std::set<JPH::BodyID> seen;
  std::map<JPH::BodyID, JPH::Vec3> belts;

 private:
  [[nodiscard]] JPH::Vec3 surface_of(const JPH::Body& body) const {
    const auto belt = belts.find(body.GetID());
    return belt == belts.end() ? JPH::Vec3::sZero() : body.GetRotation() * belt->second;
  }
  void drive(const JPH::Body& a, const JPH::Body& b, JPH::ContactSettings& settings) const {
    if (!belts.empty()) settings.mRelativeLinearSurfaceVelocity = surface_of(b) - surface_of(a);
  }
};

// Bodies that joints connect are one group, which excludes the pairs that a joint ties.
class Groups {
 public:
  explicit Groups(const GeneralScene& scene) : root_(scene.bodies.size()), place_(root_.size()) {
    std::iota(root_.begin(), root_.end(), 0U);
    for (const GeneralJoint& joint : scene.joints)
      root_[root_of(index(joint.a))] = root_of(index(joint.b));
    std::vector<JPH::uint> sizes(root_.size());
    for (std::size_t i = 0; i < root_.size(); ++i)
      place_[i] = sizes[root_of(i)]++;
    for (const GeneralJoint& joint : scene.joints) {
      const std::size_t root = root_of(index(joint.a));
      JPH::Ref<JPH::GroupFilterTable>& table = tables_[root];
      if (table == nullptr) table = new JPH::GroupFilterTable(sizes[root]);
      table->DisableCollision(place_[index(joint.a)], place_[index(joint.b)]);
    }
  }
  [[nodiscard]] JPH::CollisionGroup of(int body) {
    const std::size_t root = root_of(index(body));
    const auto table = tables_.find(root);
    if (table == tables_.end()) return {};
    return {table->second.GetPtr(), static_cast<JPH::CollisionGroup::GroupID>(root),
            place_[index(body)]};
  }

 private:
  static std::size_t index(int body) { return static_cast<std::size_t>(body); }
  std::size_t root_of(std::size_t body) {
    while (root_[body] != body)
      body = root_[body] = root_[root_[body]];
    return body;
  }

  std::vector<std::size_t> root_;
  std::vector<JPH::uint> place_;
  std::map<std::size_t, JPH::Ref<JPH::GroupFilterTable>> tables_;
};

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

// Pairs of bodies that a step has room for, and as many contacts.
JPH::uint room_of(const GeneralScene& scene) {
  const auto bodies = static_cast<JPH::uint>(scene.bodies.size());
  return std::max({1024U, std::min(65536U, 64 * bodies), 16 * bodies});
}

class JoltGeneral final : public GeneralEngine {
 public:
  JoltGeneral(const GeneralScene& scene, int substeps)
      : scene_(scene),
        groups_(scene),
        memory_((64U << 20) + std::size_t{k_bytes_a_pair} * room_of(scene)),
        substeps_(substeps),
        jobs_(JPH::cMaxPhysicsJobs),
        bodies_(scene.bodies.size()),
        joints_(scene.joints.size()) {
    system_.Init(static_cast<JPH::uint>(bodies_.size()) + 1, 0, room_of(scene), room_of(scene),
                 layers_, trees_, pairs_);
    system_.SetGravity(vec({0, -scene.gravity, 0}));
    const auto asks = [](const GeneralBody& body) {
      return body.trigger || body.surface != Triple{};
    };
    if (std::ranges::any_of(scene.bodies, asks)) system_.SetContactListener(&listener_);
    change(changes_of(scene).front());
    system_.OptimizeBroadPhase();
  }
  ~JoltGeneral() override {
    for (const JPH::Ref<JPH::TwoBodyConstraint>& joint : joints_)
      if (joint != nullptr) system_.RemoveConstraint(joint);
    joints_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (bodies_[i] != nullptr) remove(i);
  }

  void change(const GeneralChange& change) override {
    for (const int index : change.gone)
      remove(static_cast<std::size_t>(index));
    if (!change.gone.empty()) wake();
    for (const int index : change.come)
      add(index);
    for (const int index : change.joints) {
      const auto i = static_cast<std::size_t>(index);
      const GeneralJoint& joint = scene_.joints[i];
      joints_[i] = jolt::constraint_of(joint, *at(joint.a), *at(joint.b));
      system_.AddConstraint(joints_[i]);
    }
  }
  void step() override {
    listener_.seen.clear();
    const JPH::EPhysicsUpdateError error = system_.Update(1.0F / 60, substeps_, &memory_, &jobs_);
    had_room_ = had_room_ && error == JPH::EPhysicsUpdateError::None;
  }
  [[nodiscard]] bool had_room() const override { return had_room_; }
  void set_motion(int body, const Triple& velocity, const Triple& angular_velocity) override {
    interface().SetLinearAndAngularVelocity(at(body)->GetID(), vec(velocity),
                                            vec(angular_velocity));
  }
  void set_gravity(const Triple& gravity) override {
    system_.SetGravity(vec(gravity));
    wake();
  }
  [[nodiscard]] GeneralState state(int index) const override {
    if (at(index) == nullptr) return coming(scene_.bodies[static_cast<std::size_t>(index)]);
    const JPH::Body& body = *at(index);
    const JPH::Quat q = body.GetRotation();
    return {triple(JPH::Vec3(body.GetPosition())),
            {q.GetX(), q.GetY(), q.GetZ(), q.GetW()},
            body.IsStatic() ? Triple{} : triple(body.GetLinearVelocity()),
            body.IsStatic() ? Triple{} : triple(body.GetAngularVelocity())};
  }
  [[nodiscard]] bool asleep(int body) const override { return !at(body)->IsActive(); }
  [[nodiscard]] bool entered(int body) const override {
    return listener_.seen.count(at(body)->GetID()) > 0;
  }

 private:
  [[nodiscard]] JPH::BodyInterface& interface() { return system_.GetBodyInterfaceNoLock(); }
  [[nodiscard]] JPH::Body* at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

  void add(int index) {
    const GeneralBody& body = scene_.bodies[static_cast<std::size_t>(index)];
    const JPH::ShapeRefC shape = shapes_.of_body(body);
    JPH::BodyCreationSettings def = settings_of(body, shape, scene_.may_sleep);
    def.mCollisionGroup = groups_.of(index);
    JPH::Body*& made_body = bodies_[static_cast<std::size_t>(index)];
    made_body = interface().CreateBody(def);
    if (body.surface != Triple{}) listener_.belts[made_body->GetID()] = vec(body.surface);
    interface().AddBody(made_body->GetID(), JPH::EActivation::Activate);
  }
  void wake() {
    for (const JPH::Body* body : bodies_)
      if (body != nullptr && body->IsDynamic()) interface().ActivateBody(body->GetID());
  }
  // Its joints first.
  void remove(std::size_t index) {
    for (JPH::Ref<JPH::TwoBodyConstraint>& joint : joints_) {
      if (joint == nullptr) continue;
      if (joint->GetBody1() != bodies_[index] && joint->GetBody2() != bodies_[index]) continue;
      system_.RemoveConstraint(joint);
      joint = nullptr;
    }
    interface().RemoveBody(bodies_[index]->GetID());
    interface().DestroyBody(bodies_[index]->GetID());
    bodies_[index] = nullptr;
  }

  static constexpr std::size_t k_bytes_a_pair = 1536;

  const GeneralScene& scene_;
  Groups groups_;
  jolt::Shapes shapes_;
  Layers layers_;
  Trees trees_;
  Pairs pairs_;
  Listener listener_;
  JPH::TempAllocatorImpl memory_;
  int substeps_;
  JPH::JobSystemSingleThreaded jobs_;
  JPH::PhysicsSystem system_;
  std::vector<JPH::Body*> bodies_;
  std::vector<JPH::Ref<JPH::TwoBodyConstraint>> joints_;
  bool had_room_ = true;
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
