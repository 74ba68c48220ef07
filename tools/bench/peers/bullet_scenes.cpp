#include <cmath>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tools/bench/peers/scene_peers.h"

namespace lockstone::bench {
namespace {

btScalar scalar(double x) {
  return static_cast<btScalar>(x);
}

btVector3 vector(const Triple& v) {
  return {scalar(v[0]), scalar(v[1]), scalar(v[2])};
}

Triple triple(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

// Its defaults: ten iterations, split impulses, implicit gyroscopic torque. A pair's friction and
// restitution are the products of both bodies': each gets the root.
class BulletScene final : public NeutralEngine {
 public:
  BulletScene(const NeutralScene& scene, int steps)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
        steps_(steps) {
    set_gravity(scene.gravity_at(0));
    for (const NeutralBody& body : scene.bodies)
      add(body, scene);
    for (const NeutralJoint& joint : scene.joints)
      add(joint);
  }

  ~BulletScene() override {
    for (const auto& joint : joints_)
      world_.removeConstraint(joint.get());
    for (const auto& body : bodies_)
      world_.removeRigidBody(body.get());
  }

  void step() override {
    for (int i = 0; i < steps_; ++i)
      world_.stepSimulation(scalar(1 / (k_scene_tick_rate * steps_)), 0);
  }
  void set_gravity(const Triple& gravity) override { world_.setGravity(vector(gravity)); }
  void set_velocity(int body, const Triple& velocity) override {
    at(body).setLinearVelocity(vector(velocity));
  }
  [[nodiscard]] BodyState state(int index) const override {
    const btRigidBody& body = at(index);
    const btQuaternion q = body.getWorldTransform().getRotation();
    return {triple(body.getWorldTransform().getOrigin()),
            {q.x(), q.y(), q.z(), q.w()},
            triple(body.getLinearVelocity()),
            triple(body.getAngularVelocity())};
  }

 private:
  [[nodiscard]] btRigidBody& at(int body) const { return *bodies_[static_cast<std::size_t>(body)]; }

  void add(const NeutralBody& body, const NeutralScene& scene) {
    if (body.is_box())
      shapes_.push_back(std::make_unique<btBoxShape>(vector(body.size)));
    else
      shapes_.push_back(std::make_unique<btSphereShape>(scalar(body.size[0])));
    const btScalar mass = body.fixed ? 0 : scalar(body.mass());
    btVector3 inertia(0, 0, 0);
    if (!body.fixed) inertia = vector(body.moments_over_mass()) * mass;
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes_.back().get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(vector(body.position));
    info.m_friction = scalar(std::sqrt(scene.friction));
    info.m_restitution = scalar(std::sqrt(scene.restitution));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& made = *bodies_.back();
    made.setActivationState(DISABLE_DEACTIVATION);
    made.setLinearVelocity(vector(body.velocity));
    made.setAngularVelocity(vector(body.angular_velocity));
    if (body.collides)
      world_.addRigidBody(&made);
    else
      world_.addRigidBody(&made, 0, 0);
  }

  void add(const NeutralJoint& joint) {
    joints_.push_back(std::make_unique<btPoint2PointConstraint>(
        at(joint.a), at(joint.b), vector(joint.anchor_a), vector(joint.anchor_b)));
    world_.addConstraint(joints_.back().get(), true);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
  btDiscreteDynamicsWorld world_;
  int steps_;
};

}  // namespace

std::unique_ptr<NeutralEngine> make_bullet_scene(const NeutralScene& scene, int setting) {
  return std::make_unique<BulletScene>(scene, setting);
}

}  // namespace lockstone::bench
