// The scenes of families in Box3D, by its public headers, in single precision.
#include <algorithm>
#include <mutex>

#include <box3d/box3d.h>

#include "tools/bench/general/vectors.h"
#include "tools/bench/peers/general_peers.h"

namespace lockstone::bench {
namespace {

using namespace general;

// Worlds live in one list of the library's.
std::mutex& world_list() {
  static std::mutex mutex;
  return mutex;
}

b3Vec3 vec(const Triple& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
b3Quat quat(const Turn& q) {
  return {vec({q[0], q[1], q[2]}), static_cast<float>(q[3])};
}
Triple triple(const b3Vec3& v) {
  return {v.x, v.y, v.z};
}

b3WorldId world_of(const GeneralScene& scene) {
  b3WorldDef def = b3DefaultWorldDef();
  def.gravity = vec({0, -scene.gravity, 0});
  def.enableSleep = scene.may_sleep;
  def.workerCount = 0;
  const std::scoped_lock lock(world_list());
  return b3CreateWorld(&def);
}

b3BodyDef body_def(const GeneralBody& body) {
  b3BodyDef def = b3DefaultBodyDef();
  def.type = body.motion == Motion::fixed       ? b3_staticBody
             : body.motion == Motion::kinematic ? b3_kinematicBody
                                                : b3_dynamicBody;
  def.position = b3ToPos(vec(body.position));
  def.rotation = quat(body.orientation);
  def.linearVelocity = vec(body.velocity);
  def.angularVelocity = vec(body.angular_velocity);
  def.isBullet = body.bullet;
  return def;
}

b3ShapeDef shape_def(const GeneralBody& body) {
  b3ShapeDef def = b3DefaultShapeDef();
  def.density = static_cast<float>(body.density);
  def.baseMaterial.friction = static_cast<float>(body.friction);
  def.baseMaterial.restitution = static_cast<float>(body.restitution);
  if (!body.collides) def.filter.maskBits = 0;
  def.isSensor = body.trigger;
  def.enableSensorEvents = true;
  return def;
}

void add_hull(b3BodyId id, const b3ShapeDef& def, const GeneralBody& body) {
  std::vector<b3Vec3> points;
  for (const Triple& point : body.points)
    points.push_back(vec(point));
  b3HullData* hull = b3CreateHull(points.data(), static_cast<int>(points.size()), 64);
  if (hull == nullptr) return;
  b3CreateHullShape(id, &def, hull);
  b3DestroyHull(hull);
}

void add_shape(b3BodyId id, const GeneralBody& body) {
  const b3ShapeDef def = shape_def(body);
  const b3Vec3 size = vec(body.size);
  if (body.form == Form::sphere) {
    const b3Sphere sphere{{0, 0, 0}, size.x};
    b3CreateSphereShape(id, &def, &sphere);
  } else if (body.form == Form::capsule) {
    const b3Capsule capsule{{0, -size.y, 0}, {0, size.y, 0}, size.x};
    b3CreateCapsuleShape(id, &def, &capsule);
  } else if (body.form == Form::box) {
    const b3BoxHull box = b3MakeBoxHull(size.x, size.y, size.z);
    b3CreateHullShape(id, &def, &box.base);
  } else {
    add_hull(id, def, body);
  }
}

// A hinge of theirs turns about z.
b3JointDef base_of(const b3JointDef& standard, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3JointDef def = standard;
  const Turn about =
      joint.link == Link::hinge ? turn_about({0, 1, 0}, std::acos(0.0)) : Turn{0, 0, 0, 1};
  def.bodyIdA = a;
  def.bodyIdB = b;
  def.localFrameA = {vec(joint.anchor_a), quat(joint.frame_a * about)};
  def.localFrameB = {vec(joint.anchor_b), quat(joint.frame_b * about)};
  return def;
}

void add_hinge(b3WorldId world, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3RevoluteJointDef def = b3DefaultRevoluteJointDef();
  def.base = base_of(def.base, joint, a, b);
  def.enableLimit = joint.limited;
  def.lowerAngle = static_cast<float>(joint.lower);
  def.upperAngle = static_cast<float>(joint.upper);
  def.enableMotor = joint.effort > 0;
  def.motorSpeed = static_cast<float>(joint.speed);
  def.maxMotorTorque = static_cast<float>(joint.effort);
  def.enableSpring = joint.hertz > 0;
  def.targetAngle = static_cast<float>(joint.target);
  def.hertz = static_cast<float>(joint.hertz);
  def.dampingRatio = static_cast<float>(joint.damping);
  b3CreateRevoluteJoint(world, &def);
}

void add_slider(b3WorldId world, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3PrismaticJointDef def = b3DefaultPrismaticJointDef();
  def.base = base_of(def.base, joint, a, b);
  def.enableLimit = joint.limited;
  def.lowerTranslation = static_cast<float>(joint.lower);
  def.upperTranslation = static_cast<float>(joint.upper);
  def.enableMotor = joint.effort > 0;
  def.motorSpeed = static_cast<float>(joint.speed);
  def.maxMotorForce = static_cast<float>(joint.effort);
  b3CreatePrismaticJoint(world, &def);
}

void add_rod(b3WorldId world, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3DistanceJointDef def = b3DefaultDistanceJointDef();
  def.base = base_of(def.base, joint, a, b);
  def.length = static_cast<float>(joint.target);
  def.enableSpring = joint.hertz > 0;
  def.hertz = static_cast<float>(joint.hertz);
  def.dampingRatio = static_cast<float>(joint.damping);
  if (joint.limited) {
    def.enableLimit = true;
    def.minLength = static_cast<float>(joint.lower);
    def.maxLength = static_cast<float>(joint.upper);
  }
  b3CreateDistanceJoint(world, &def);
}

void add_joint(b3WorldId world, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  if (joint.link == Link::hinge) return add_hinge(world, joint, a, b);
  if (joint.link == Link::slider) return add_slider(world, joint, a, b);
  if (joint.link == Link::rod) return add_rod(world, joint, a, b);
  if (joint.link == Link::weld) {
    b3WeldJointDef def = b3DefaultWeldJointDef();
    def.base = base_of(def.base, joint, a, b);
    b3CreateWeldJoint(world, &def);
    return;
  }
  b3SphericalJointDef def = b3DefaultSphericalJointDef();
  def.base = base_of(def.base, joint, a, b);
  def.enableSpring = joint.hertz > 0;
  def.hertz = static_cast<float>(joint.hertz);
  def.dampingRatio = static_cast<float>(joint.damping);
  def.targetRotation = quat(turn_by(joint.turn));
  b3CreateSphericalJoint(world, &def);
}

class Box3dGeneral final : public GeneralEngine {
 public:
  Box3dGeneral(const GeneralScene& scene, int substeps)
      : world_(world_of(scene)), substeps_(substeps) {
    for (const GeneralBody& body : scene.bodies) {
      const b3BodyDef def = body_def(body);
      bodies_.push_back(b3CreateBody(world_, &def));
      add_shape(bodies_.back(), body);
    }
    for (const GeneralJoint& joint : scene.joints)
      add_joint(world_, joint, body(joint.a), body(joint.b));
  }
  ~Box3dGeneral() override {
    const std::scoped_lock lock(world_list());
    b3DestroyWorld(world_);
  }

  void step() override { b3World_Step(world_, 1.0F / 60, substeps_); }
  void set_motion(int index, const Triple& velocity, const Triple& angular_velocity) override {
    b3Body_SetLinearVelocity(body(index), vec(velocity));
    b3Body_SetAngularVelocity(body(index), vec(angular_velocity));
  }
  [[nodiscard]] GeneralState state(int index) const override {
    const b3BodyId id = body(index);
    const b3Quat q = b3Body_GetRotation(id);
    return {triple(b3ToVec3(b3Body_GetPosition(id))),
            {q.v.x, q.v.y, q.v.z, q.s},
            triple(b3Body_GetLinearVelocity(id)),
            triple(b3Body_GetAngularVelocity(id))};
  }
  [[nodiscard]] bool asleep(int index) const override { return !b3Body_IsAwake(body(index)); }
  [[nodiscard]] bool entered(int index) const override {
    const b3SensorEvents events = b3World_GetSensorEvents(world_);
    const auto is_ours = [&](const b3SensorBeginTouchEvent& event) {
      return B3_ID_EQUALS(b3Shape_GetBody(event.visitorShapeId), body(index));
    };
    return std::any_of(events.beginEvents, events.beginEvents + events.beginCount, is_ours);
  }

 private:
  [[nodiscard]] b3BodyId body(int index) const { return bodies_[static_cast<std::size_t>(index)]; }

  b3WorldId world_;
  int substeps_;
  std::vector<b3BodyId> bodies_;
};

}  // namespace

std::unique_ptr<GeneralEngine> make_box3d_general(const GeneralScene& scene, int substeps) {
  return std::make_unique<Box3dGeneral>(scene, substeps);
}

}  // namespace lockstone::bench
