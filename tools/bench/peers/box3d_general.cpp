// The scenes of families in Box3D, by its public headers, in single precision.
#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

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
  def.workerCount = 0;  // the caller's thread alone
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
  def.baseMaterial.tangentVelocity = vec(body.surface);
  if (!body.collides) def.filter.maskBits = 0;
  def.isSensor = body.trigger;
  def.enableSensorEvents = true;
  return def;
}

void add_hull(b3BodyId id, const b3ShapeDef& def, const GeneralPart& part) {
  std::vector<b3Vec3> points;
  for (const Triple& point : part.points)
    points.push_back(vec(part.position + turned(part.orientation, point)));
  b3HullData* hull = b3CreateHull(points.data(), static_cast<int>(points.size()), 64);
  if (hull == nullptr) return;
  b3CreateHullShape(id, &def, hull);
  b3DestroyHull(hull);
}

void add_part(b3BodyId id, const b3ShapeDef& def, const GeneralPart& part) {
  const b3Vec3 size = vec(part.size), at = vec(part.position);
  if (part.form == Form::sphere) {
    const b3Sphere sphere{at, size.x};
    b3CreateSphereShape(id, &def, &sphere);
  } else if (part.form == Form::capsule) {
    const Triple half = turned(part.orientation, {0, part.size[1], 0});
    const b3Capsule capsule{vec(part.position - half), vec(part.position + half), size.x};
    b3CreateCapsuleShape(id, &def, &capsule);
  } else if (part.form == Form::box) {
    const b3Transform place{at, quat(part.orientation)};
    const b3BoxHull box = b3MakeTransformedBoxHull(size.x, size.y, size.z, place);
    b3CreateHullShape(id, &def, &box.base);
  } else {
    add_hull(id, def, part);
  }
}

b3MeshData* mesh_of(const GeneralShape& shape) {
  std::vector<b3Vec3> vertices;
  for (const Triple& point : shape.points)
    vertices.push_back(vec(point));
  std::vector<std::int32_t> indices;
  for (const auto& triangle : shape.triangles)
    indices.insert(indices.end(), triangle.begin(), triangle.end());
  b3MeshDef def{};
  def.vertices = vertices.data();
  def.indices = indices.data();
  def.vertexCount = static_cast<int>(vertices.size());
  def.triangleCount = static_cast<int>(shape.triangles.size());
  def.identifyEdges = true;
  return b3CreateMesh(&def, nullptr, 0);
}

// Meshes by their numbers: the shapes that have one do not own it.
class Meshes {
 public:
  Meshes() = default;
  Meshes(const Meshes&) = delete;
  Meshes& operator=(const Meshes&) = delete;
  ~Meshes() {
    for (const auto& [shape, mesh] : known_)
      b3DestroyMesh(mesh);
  }
  [[nodiscard]] const b3MeshData* of(const GeneralShape& shape) {
    b3MeshData*& mesh = known_[shape];
    if (mesh == nullptr) mesh = mesh_of(shape);
    return mesh;
  }

 private:
  std::map<GeneralShape, b3MeshData*> known_;
};

void add_shapes(b3BodyId id, const GeneralBody& body, Meshes& meshes) {
  const b3ShapeDef def = shape_def(body);
  if (body.form == Form::mesh)
    b3CreateMeshShape(id, &def, meshes.of(body), b3Vec3_one);
  else if (body.form == Form::compound)
    for (const GeneralPart& part : body.parts)
      add_part(id, def, part);
  else
    add_part(id, def, {body});
}

// A hinge of theirs turns about z, and limits of a ball are about it.
b3JointDef base_of(const b3JointDef& standard, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3JointDef def = standard;
  const bool is_about_z = joint.link == Link::hinge || (joint.link == Link::ball && joint.limited);
  const Turn about = is_about_z ? turn_about({0, 1, 0}, std::acos(0.0)) : Turn{0, 0, 0, 1};
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

void add_ball(b3WorldId world, const GeneralJoint& joint, b3BodyId a, b3BodyId b) {
  b3SphericalJointDef def = b3DefaultSphericalJointDef();
  def.base = base_of(def.base, joint, a, b);
  def.enableConeLimit = def.enableTwistLimit = joint.limited;
  def.coneAngle = static_cast<float>(joint.cone);
  def.lowerTwistAngle = static_cast<float>(joint.lower);
  def.upperTwistAngle = static_cast<float>(joint.upper);
  def.enableSpring = joint.hertz > 0;
  def.hertz = static_cast<float>(joint.hertz);
  def.dampingRatio = static_cast<float>(joint.damping);
  def.targetRotation = quat(turn_by(joint.turn));
  b3CreateSphericalJoint(world, &def);
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
  add_ball(world, joint, a, b);
}

class Box3dGeneral final : public GeneralEngine {
 public:
  Box3dGeneral(const GeneralScene& scene, int substeps)
      : scene_(scene),
        world_(world_of(scene)),
        substeps_(substeps),
        bodies_(scene.bodies.size(), b3_nullBodyId) {
    change(changes_of(scene).front());
  }
  ~Box3dGeneral() override {
    const std::scoped_lock lock(world_list());
    b3DestroyWorld(world_);
  }

  void change(const GeneralChange& change) override {
    for (const int index : change.gone) {
      b3DestroyBody(body(index));
      bodies_[static_cast<std::size_t>(index)] = b3_nullBodyId;
    }
    for (const int index : change.come) {
      const auto i = static_cast<std::size_t>(index);
      const b3BodyDef def = body_def(scene_.bodies[i]);
      bodies_[i] = b3CreateBody(world_, &def);
      add_shapes(bodies_[i], scene_.bodies[i], meshes_);
    }
    for (const int index : change.joints) {
      const GeneralJoint& joint = scene_.joints[static_cast<std::size_t>(index)];
      add_joint(world_, joint, body(joint.a), body(joint.b));
    }
  }
  void step() override { b3World_Step(world_, 1.0F / 60, substeps_); }
  void set_motion(int index, const Triple& velocity, const Triple& angular_velocity) override {
    b3Body_SetLinearVelocity(body(index), vec(velocity));
    b3Body_SetAngularVelocity(body(index), vec(angular_velocity));
  }
  void set_gravity(const Triple& gravity) override {
    b3World_SetGravity(world_, vec(gravity));
    for (const b3BodyId id : bodies_)
      if (B3_IS_NON_NULL(id)) b3Body_SetAwake(id, true);
  }
  [[nodiscard]] GeneralState state(int index) const override {
    if (B3_IS_NULL(body(index))) return coming(scene_.bodies[static_cast<std::size_t>(index)]);
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

  const GeneralScene& scene_;
  Meshes meshes_;
  b3WorldId world_;
  int substeps_;
  std::vector<b3BodyId> bodies_;
};

}  // namespace

std::unique_ptr<GeneralEngine> make_box3d_general(const GeneralScene& scene, int substeps) {
  return std::make_unique<Box3dGeneral>(scene, substeps);
}

}  // namespace lockstone::bench
