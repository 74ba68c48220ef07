// The scenes of families in our engine.
#include <algorithm>
#include <cmath>

#include <lockstone/hull.h>
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

std::shared_ptr<const Hull> hull_of(const GeneralBody& body) {
  std::vector<Vec3<Length>> points;
  for (const Triple& point : body.points)
    points.push_back(fixed<Length>(point));
  return Hull::build(points).hull;
}

// The hull of each body that has one.
std::vector<AssetPtr> hulls_of(const GeneralScene& scene) {
  std::vector<AssetPtr> hulls(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].form == Form::hull) hulls[i] = hull_of(scene.bodies[i]);
  return hulls;
}

std::shared_ptr<const AssetSet> set_of(const std::vector<AssetPtr>& hulls) {
  std::vector<AssetPtr> all;
  std::ranges::copy_if(hulls, std::back_inserter(all), [](const AssetPtr& hull) { return !!hull; });
  return std::make_shared<const AssetSet>(std::move(all));
}

WorldDef world_of(const GeneralScene& scene, int substeps) {
  WorldDef def;
  const auto bodies = static_cast<std::uint32_t>(scene.bodies.size());
  def.body_capacity = bodies + 1;
  def.pair_capacity = def.contact_capacity = std::max(64 * bodies + 64, bodies * bodies / 2 + 1);
  def.joint_capacity = static_cast<std::uint32_t>(scene.joints.size()) + 1;
  if (!scene.may_sleep) def.sleep_ms = 0;
  def.substeps = static_cast<std::uint8_t>(substeps);
  def.gravity = fixed<Acceleration>(Triple{0, -scene.gravity, 0});
  return def;
}

Shape shape_of(const GeneralBody& body, const AssetPtr& hull) {
  const Vec3<Length> size = fixed<Length>(body.size);
  if (body.form == Form::sphere) return Shape::sphere(size.x);
  if (body.form == Form::capsule) return Shape::capsule(size.y, size.x);
  if (body.form == Form::box) return Shape::box(size.x, size.y, size.z);
  return hull->shape();
}

BodyDef body_of(const GeneralBody& body, const AssetPtr& hull) {
  BodyDef def;
  def.motion = body.motion == Motion::fixed       ? MotionType::static_body
               : body.motion == Motion::kinematic ? MotionType::kinematic
                                                  : MotionType::dynamic;
  def.shape = shape_of(body, hull);
  if (!body.collides) def.filter.mask = 0;
  def.position = fixed<Position>(body.position);
  def.orientation = fixed(body.orientation);
  def.velocity = fixed<Velocity>(body.velocity);
  def.angular_velocity = fixed<AngularVelocity>(body.angular_velocity);
  def.material.density = fixed<Density>(body.density);
  def.material.friction = fixed<Coefficient>(body.friction);
  def.material.restitution = fixed<Coefficient>(body.restitution);
  def.is_trigger = body.trigger;
  def.is_bullet = body.bullet;
  return def;
}

JointKind kind_of(Link link) {
  constexpr JointKind k_kinds[] = {JointKind::ball, JointKind::hinge, JointKind::slider,
                                   JointKind::weld, JointKind::distance};
  return k_kinds[static_cast<std::size_t>(link)];
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
  LockstoneGeneral(const GeneralScene& scene, const std::vector<AssetPtr>& hulls, int substeps)
      : world_(std::move(World::create(world_of(scene, substeps), set_of(hulls)).value())) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      bodies_.push_back(world_.create_body(body_of(scene.bodies[i], hulls[i])).value());
    for (const GeneralJoint& joint : scene.joints)
      (void)world_.create_joint(joint_of(joint, body(joint.a), body(joint.b))).value();
  }

  void step() override { contacts_ = world_.step().contacts; }
  [[nodiscard]] std::uint32_t contacts() const override { return contacts_; }
  void set_motion(int index, const Triple& velocity, const Triple& angular_velocity) override {
    (void)world_.apply(SetVelocity{body(index), fixed<Velocity>(velocity)});
    (void)world_.apply(SetAngularVelocity{body(index), fixed<AngularVelocity>(angular_velocity)});
  }
  [[nodiscard]] GeneralState state(int index) const override {
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

  World world_;
  std::uint32_t contacts_ = 0;
  std::vector<BodyHandle> bodies_;
};

std::unique_ptr<GeneralEngine> make(const GeneralScene& scene, int substeps) {
  return std::make_unique<LockstoneGeneral>(scene, hulls_of(scene), substeps);
}

}  // namespace

GeneralMaker lockstone_general() {
  return {"lockstone", "", make};
}

}  // namespace lockstone::bench
