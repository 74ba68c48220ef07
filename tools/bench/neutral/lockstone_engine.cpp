#include <algorithm>

#include <lockstone/world.h>

#include "tools/bench/neutral/engine.h"
#include "tools/fuzz/real.h"

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
template <class T>
Triple triple(const Vec3<T>& v) {
  const fuzz::Real3 r = fuzz::real(v);
  return {r.x, r.y, r.z};
}

constexpr int k_most_substeps = 16;  // of one tick of a world

// Beyond the substeps that one tick of ours can have, several ticks make one of the scene.
int ticks_of(int setting) {
  return std::max(1, setting / k_most_substeps);
}

WorldDef world_of(const NeutralScene& scene, int setting) {
  WorldDef def;
  def.tick_rate = static_cast<std::uint16_t>(k_scene_tick_rate * ticks_of(setting));
  const auto bodies = static_cast<std::uint32_t>(scene.bodies.size());
  def.body_capacity = bodies + 1;
  def.pair_capacity = def.contact_capacity = 32 * bodies + 64;
  def.joint_capacity = static_cast<std::uint32_t>(scene.joints.size()) + 1;
  def.sleep_ms = 0;
  def.substeps = static_cast<std::uint8_t>(setting / ticks_of(setting));
  def.gravity = fixed<Acceleration>(scene.gravity_at(0));
  return def;
}

BodyDef body_of(const NeutralBody& body, const NeutralScene& scene) {
  BodyDef def;
  def.shape = body.is_box() ? Shape::box(fixed<Length>(body.size[0]), fixed<Length>(body.size[1]),
                                         fixed<Length>(body.size[2]))
                            : Shape::sphere(fixed<Length>(body.size[0]));
  if (body.fixed) def.motion = MotionType::static_body;
  if (!body.collides) def.filter.mask = 0;
  def.position = fixed<Position>(body.position);
  def.velocity = fixed<Velocity>(body.velocity);
  def.angular_velocity = fixed<AngularVelocity>(body.angular_velocity);
  def.material.density = fixed<Density>(body.density);
  def.material.friction = fixed<Coefficient>(scene.friction);
  def.material.restitution = fixed<Coefficient>(scene.restitution);
  return def;
}

class LockstoneEngine final : public NeutralEngine {
 public:
  LockstoneEngine(const NeutralScene& scene, int setting)
      : world_(std::move(World::create(world_of(scene, setting)).value())),
        ticks_(ticks_of(setting)) {
    for (const NeutralBody& body : scene.bodies)
      bodies_.push_back(world_.create_body(body_of(body, scene)).value());
    for (const NeutralJoint& joint : scene.joints) {
      JointDef def = JointDef::of(JointKind::ball, body(joint.a), body(joint.b));
      def.frame_a.position = fixed<Length>(joint.anchor_a);
      def.frame_b.position = fixed<Length>(joint.anchor_b);
      (void)world_.create_joint(def).value();
    }
  }

  void step() override {
    for (int tick = 0; tick < ticks_; ++tick)
      (void)world_.step();
  }
  void set_gravity(const Triple& gravity) override {
    (void)world_.apply(SetGravity{fixed<Acceleration>(gravity)});
  }
  void set_velocity(int index, const Triple& velocity) override {
    (void)world_.apply(SetVelocity{body(index), fixed<Velocity>(velocity)});
  }
  [[nodiscard]] BodyState state(int index) const override {
    const BodyView view = world_.body(body(index));
    const Quat& q = view.orientation;
    return {triple(view.position),
            {fuzz::real(q.x), fuzz::real(q.y), fuzz::real(q.z), fuzz::real(q.w)},
            triple(view.velocity),
            triple(view.angular_velocity)};
  }
  [[nodiscard]] std::uint64_t hash() const override { return world_.hash().total; }

 private:
  [[nodiscard]] BodyHandle body(int index) const {
    return bodies_[static_cast<std::size_t>(index)];
  }

  World world_;
  int ticks_;  // for one of the scene
  std::vector<BodyHandle> bodies_;
};

}  // namespace

NeutralMaker lockstone_maker() {
  return {
      "lockstone", "substeps", [](const NeutralScene& scene, int setting) {
        return std::unique_ptr<NeutralEngine>(std::make_unique<LockstoneEngine>(scene, setting));
      }};
}

}  // namespace lockstone::bench
