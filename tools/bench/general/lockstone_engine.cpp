// The scenes of families in our engine.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include <lockstone/compound.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/world.h>

#include "tools/bench/general/engine.h"
#include "tools/fuzz/real.h"
#include "tools/render/svg.h"

namespace lockstone::bench {
namespace {

template <class T>
T fixed(double x) {
  return T::from_raw(
      static_cast<typename T::Representation>(std::llround(std::ldexp(x, T::frac_bits))));
}
template <class T>
Vec3<T> fixed(const Triple& v) {
  return {fixed<T>(v[0]), fixed<T>(v[1]), fixed<T>(v[2])};
}
Quat fixed(const Turn& q) {
  return fuzz::to_quat({q[0], q[1], q[2]}, q[3]);
}
template <class T>
Triple triple(const Vec3<T>& v) {
  const fuzz::Real3 r = fuzz::real(v);
  return {r.x, r.y, r.z};
}

// Assets by their numbers, so that bodies share them.
class Assets {
 public:
  /// Of a body or a part; null for the shapes that need none.
  [[nodiscard]] AssetPtr of(const GeneralShape& shape) {
    if (shape.form != Form::hull && shape.form != Form::mesh) return nullptr;
    AssetPtr& asset = known_[shape];
    if (asset == nullptr) asset = shape.form == Form::hull ? hull_of(shape) : mesh_of(shape);
    return asset;
  }
  [[nodiscard]] AssetPtr of_body(const GeneralBody& body) {
    return body.form == Form::compound ? compound_of(body) : of(body);
  }
  /// Those that several bodies or parts may name.
  [[nodiscard]] std::vector<AssetPtr> shared() const {
    std::vector<AssetPtr> all;
    for (const auto& [shape, asset] : known_)
      all.push_back(asset);
    return all;
  }

 private:
  static std::vector<Vec3<Length>> points_of(const GeneralShape& shape) {
    std::vector<Vec3<Length>> points;
    for (const Triple& point : shape.points)
      points.push_back(fixed<Length>(point));
    return points;
  }
  static AssetPtr hull_of(const GeneralShape& shape) { return Hull::build(points_of(shape)).hull; }
  static AssetPtr mesh_of(const GeneralShape& shape) {
    const std::vector<Vec3<Length>> points = points_of(shape);
    std::vector<TriangleIndices> triangles;
    const auto index = [](int i) { return static_cast<std::uint32_t>(i); };
    for (const auto& [a, b, c] : shape.triangles)
      triangles.push_back({index(a), index(b), index(c)});
    return Mesh::build({points, triangles, {}, {}, {}}).mesh;
  }
  AssetPtr compound_of(const GeneralBody& body);

  std::map<GeneralShape, AssetPtr> known_;
};

Shape shape_of(const GeneralShape& shape, const AssetPtr& asset) {
  const Vec3<Length> size = fixed<Length>(shape.size);
  if (shape.form == Form::sphere) return Shape::sphere(size.x);
  if (shape.form == Form::capsule) return Shape::capsule(size.y, size.x);
  if (shape.form == Form::box) return Shape::box(size.x, size.y, size.z);
  return asset->shape();
}

AssetPtr Assets::compound_of(const GeneralBody& body) {
  std::vector<CompoundChild> children;
  for (const GeneralPart& part : body.parts) {
    CompoundChild& child = children.emplace_back();
    child.asset = of(part);
    child.shape = shape_of(part, child.asset);
    child.position = fixed<Length>(part.position);
    child.orientation = fixed(part.orientation);
  }
  return Compound::build(children).compound;
}

struct SceneAssets {
  std::vector<AssetPtr> of_body;
  std::shared_ptr<const AssetSet> set;  // with the hulls of compounds
};

SceneAssets assets_of(const GeneralScene& scene) {
  Assets assets;
  SceneAssets result;
  for (const GeneralBody& body : scene.bodies)
    result.of_body.push_back(assets.of_body(body));
  std::vector<AssetPtr> all = assets.shared();
  std::ranges::copy_if(result.of_body, std::back_inserter(all),
                       [](const AssetPtr& asset) { return asset != nullptr; });
  result.set = std::make_shared<const AssetSet>(std::move(all));
  return result;
}

// All may meet all in a scene of few bodies.
void make_room(WorldDef& def, std::uint32_t bodies) {
  constexpr std::uint32_t k_few = 1024;
  def.body_capacity = bodies + 1;
  def.pair_capacity = def.contact_capacity = std::max(64 * bodies + 64, bodies * bodies / 2 + 1);
  if (bodies <= k_few) return;
  def.pair_capacity = 32 * bodies;
  def.contact_capacity = 12 * bodies;
}

WorldDef world_of(const GeneralScene& scene, int substeps, bool converges) {
  WorldDef def;
  if (!converges) def.converged_contacts = 0;
  make_room(def, static_cast<std::uint32_t>(scene.bodies.size()));
  def.joint_capacity = static_cast<std::uint32_t>(scene.joints.size()) + 1;
  if (!scene.may_sleep) def.sleep_ms = 0;
  def.substeps = static_cast<std::uint8_t>(substeps);
  def.gravity = fixed<Acceleration>(Triple{0, -scene.gravity, 0});
  return def;
}

BodyDef body_of(const GeneralBody& body, const AssetPtr& asset) {
  BodyDef def;
  def.motion = body.motion == Motion::fixed       ? MotionType::static_body
               : body.motion == Motion::kinematic ? MotionType::kinematic
                                                  : MotionType::dynamic;
  def.shape = shape_of(body, asset);
  if (!body.collides) def.filter.mask = 0;
  def.position = fixed<Position>(body.position);
  def.orientation = fixed(body.orientation);
  def.velocity = fixed<Velocity>(body.velocity);
  def.angular_velocity = fixed<AngularVelocity>(body.angular_velocity);
  def.material.density = fixed<Density>(body.density);
  def.material.friction = fixed<Coefficient>(body.friction);
  def.material.restitution = fixed<Coefficient>(body.restitution);
  def.surface_motion.velocity = fixed<SolverVelocity>(body.surface);
  def.is_trigger = body.trigger;
  def.is_bullet = body.bullet;
  return def;
}

JointKind kind_of(Link link) {
  constexpr JointKind k_kinds[] = {JointKind::ball, JointKind::hinge, JointKind::slider,
                                   JointKind::weld, JointKind::distance};
  return k_kinds[static_cast<std::size_t>(link)];
}

// Twist and swing.
void limit_ball(JointDef& def, const GeneralJoint& joint) {
  def.angular[0].mode = def.angular[1].mode = AxisMode::limited;
  def.angular[0].lower = fixed<Angle>(joint.lower);
  def.angular[0].upper = fixed<Angle>(joint.upper);
  def.angular[1].upper = fixed<Angle>(joint.cone);
}

// Length or angle of the one way that a joint may move.
template <class Axis, class Value>
void drive(Axis& axis, const GeneralJoint& joint, Value) {
  if (joint.limited) {
    axis.mode = AxisMode::limited;
    axis.lower = fixed<Value>(joint.lower);
    axis.upper = fixed<Value>(joint.upper);
  }
  axis.target = fixed<Value>(joint.target);
  axis.speed = fixed<decltype(axis.speed)>(joint.speed);
  axis.max_effort = fixed<decltype(axis.max_effort)>(joint.effort);
  axis.hertz = fixed<Number>(joint.hertz);
  if (joint.hertz > 0) axis.damping_ratio = fixed<Number>(joint.damping);
}

JointDef joint_of(const GeneralJoint& joint, BodyHandle a, BodyHandle b) {
  JointDef def = JointDef::of(kind_of(joint.link), a, b);
  def.frame_a = {fixed<Length>(joint.anchor_a), fixed(joint.frame_a)};
  def.frame_b = {fixed<Length>(joint.anchor_b), fixed(joint.frame_b)};
  if (joint.link == Link::hinge) drive(def.angular[0], joint, Angle{});
  if (joint.link == Link::slider) drive(def.linear[0], joint, Length{});
  if (joint.link == Link::ball && joint.limited) limit_ball(def, joint);
  if (joint.link == Link::ball && joint.hertz > 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      drive(def.angular[i], joint, Angle{});
      def.angular[i].target = fixed<Angle>(joint.turn[i]);
    }
  }
  if (joint.link != Link::rod) return def;
  GeneralJoint rod = joint;
  if (rod.hertz == 0 && !rod.limited) {
    rod.limited = true;
    rod.lower = rod.upper = rod.target;
  }
  drive(def.linear[0], rod, Length{});
  return def;
}

class LockstoneGeneral final : public GeneralEngine {
 public:
  LockstoneGeneral(const GeneralScene& scene, int substeps, bool converges)
      : scene_(scene),
        assets_(assets_of(scene)),
        world_(std::move(World::create(world_of(scene, substeps, converges), assets_.set).value())),
        bodies_(scene.bodies.size()) {
    change(changes_of(scene).front());
  }

  void change(const GeneralChange& change) override {
    for (const int index : change.gone) {
      (void)world_.apply(DestroyBody{body(index)});
      bodies_[static_cast<std::size_t>(index)] = {};
    }
    for (const int index : change.come) {
      const auto i = static_cast<std::size_t>(index);
      bodies_[i] = world_.create_body(body_of(scene_.bodies[i], assets_.of_body[i])).value();
    }
    for (const int index : change.joints) {
      const GeneralJoint& joint = scene_.joints[static_cast<std::size_t>(index)];
      (void)world_.create_joint(joint_of(joint, body(joint.a), body(joint.b))).value();
    }
  }
  void step() override {
    const StepReport report = world_.step();
    contacts_ = report.contacts;
    had_room_ = had_room_ && report.status == Status::ok;
  }
  [[nodiscard]] std::uint32_t contacts() const override { return contacts_; }
  [[nodiscard]] bool had_room() const override { return had_room_; }
  void set_motion(int index, const Triple& velocity, const Triple& angular_velocity) override {
    (void)world_.apply(SetVelocity{body(index), fixed<Velocity>(velocity)});
    (void)world_.apply(SetAngularVelocity{body(index), fixed<AngularVelocity>(angular_velocity)});
  }
  void set_gravity(const Triple& gravity) override {
    (void)world_.apply(SetGravity{fixed<Acceleration>(gravity)});
  }
  [[nodiscard]] GeneralState state(int index) const override {
    if (body(index) == BodyHandle{}) return coming(scene_.bodies[static_cast<std::size_t>(index)]);
    const BodyView view = world_.body(body(index));
    const Quat& q = view.orientation;
    return {triple(view.position),
            {fuzz::real(q.x), fuzz::real(q.y), fuzz::real(q.z), fuzz::real(q.w)},
            triple(view.velocity),
            triple(view.angular_velocity)};
  }
  [[nodiscard]] bool asleep(int index) const override { return world_.body(body(index)).is_asleep; }
  [[nodiscard]] bool entered(int index) const override {
    return std::ranges::any_of(world_.events(), [&](const ContactEvent& event) {
      return event.kind == EventKind::trigger_enter &&
             (event.a == body(index) || event.b == body(index));
    });
  }
  [[nodiscard]] std::uint64_t hash() const override { return world_.hash().total; }
  [[nodiscard]] std::string picture(const std::string& caption) const override {
    render::Picture picture;
    picture.caption = caption;
    return render::draw(world_, picture);
  }

 private:
  [[nodiscard]] BodyHandle body(int index) const {
    return bodies_[static_cast<std::size_t>(index)];
  }

  const GeneralScene& scene_;
  SceneAssets assets_;
  World world_;
  std::vector<BodyHandle> bodies_;
  std::uint32_t contacts_ = 0;
  bool had_room_ = true;
};

template <bool converges>
std::unique_ptr<GeneralEngine> make(const GeneralScene& scene, int substeps) {
  return std::make_unique<LockstoneGeneral>(scene, substeps, converges);
}

}  // namespace

GeneralMaker lockstone_general() {
  return {"lockstone", "", make<true>};
}

GeneralMaker lockstone_iterated() {
  return {"lockstone", "", make<false>};
}

}  // namespace lockstone::bench
