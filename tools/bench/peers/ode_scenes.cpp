#include <cstdarg>
#include <vector>

#include <ode/ode.h>

#include "tools/bench/peers/scene_peers.h"

namespace lockstone::bench {
namespace {

constexpr int k_contacts_of_pair = 8;
constexpr std::size_t k_bodies_of_direct = 6;  // that touch

dReal real(double x) {
  return static_cast<dReal>(x);
}

Triple triple(const dReal* v) {
  return {v[0], v[1], v[2]};
}

// Opened once, for the program's life.
void open_ode() {
  static const int opened = dInitODE2(0);
  // It complains of every step in which its direct solver gives up a contact.
  dSetMessageHandler([](int, const char*, va_list) {});
  (void)opened;
}

// Its defaults, with friction as a share of the normal force.
class OdeScene final : public NeutralEngine {
 public:
  OdeScene(const NeutralScene& scene, int steps, bool direct)
      : friction_(scene.friction), restitution_(scene.restitution), steps_(steps), direct_(direct) {
    open_ode();
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetAutoDisableFlag(world_, 0);
    set_gravity(scene.gravity_at(0));
    for (const NeutralBody& body : scene.bodies)
      add(body);
    for (const NeutralJoint& joint : scene.joints)
      add(joint, scene);
  }
  OdeScene(const OdeScene&) = delete;
  OdeScene& operator=(const OdeScene&) = delete;

  ~OdeScene() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void step() override {
    for (int i = 0; i < steps_; ++i) {
      dSpaceCollide(space_, this, collide);
      const dReal time = real(1 / (k_scene_tick_rate * steps_));
      direct_ ? dWorldStep(world_, time) : dWorldQuickStep(world_, time);
      dJointGroupEmpty(contacts_);
    }
  }
  void set_gravity(const Triple& g) override {
    dWorldSetGravity(world_, real(g[0]), real(g[1]), real(g[2]));
  }
  void set_velocity(int body, const Triple& v) override {
    dBodySetLinearVel(at(body), real(v[0]), real(v[1]), real(v[2]));
  }
  [[nodiscard]] BodyState state(int index) const override {
    const auto place = static_cast<std::size_t>(index);
    if (bodies_[place] == nullptr) return {places_[place], {0, 0, 0, 1}, {}, {}};
    const dReal* q = dBodyGetQuaternion(at(index));
    return {triple(dBodyGetPosition(at(index))),
            {q[1], q[2], q[3], q[0]},
            triple(dBodyGetLinearVel(at(index))),
            triple(dBodyGetAngularVel(at(index)))};
  }

 private:
  // Null for a fixed body.
  [[nodiscard]] dBodyID at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

  void add(const NeutralBody& body) {
    const Triple& p = body.position;
    dGeomID geom = nullptr;
    if (body.collides) {
      geom = body.is_box() ? dCreateBox(space_, real(2 * body.size[0]), real(2 * body.size[1]),
                                        real(2 * body.size[2]))
                           : dCreateSphere(space_, real(body.size[0]));
    }
    places_.push_back(p);
    bodies_.push_back(body.fixed ? nullptr : dBodyCreate(world_));
    if (body.fixed) {
      if (geom != nullptr) dGeomSetPosition(geom, real(p[0]), real(p[1]), real(p[2]));
      return;
    }
    if (geom != nullptr) dGeomSetBody(geom, bodies_.back());
    place(bodies_.back(), body);
  }

  static void place(dBodyID made, const NeutralBody& body) {
    const Triple &p = body.position, &v = body.velocity, &w = body.angular_velocity;
    const Triple moments = body.moments_over_mass();
    dMass mass;
    dMassSetParameters(&mass, real(body.mass()), 0, 0, 0, real(moments[0] * body.mass()),
                       real(moments[1] * body.mass()), real(moments[2] * body.mass()), 0, 0, 0);
    dBodySetMass(made, &mass);
    dBodySetPosition(made, real(p[0]), real(p[1]), real(p[2]));
    dBodySetLinearVel(made, real(v[0]), real(v[1]), real(v[2]));
    dBodySetAngularVel(made, real(w[0]), real(w[1]), real(w[2]));
  }

  void add(const NeutralJoint& joint, const NeutralScene& scene) {
    dJointID made = dJointCreateBall(world_, nullptr);
    dJointAttach(made, at(joint.a), at(joint.b));
    const Triple& p = scene.bodies[static_cast<std::size_t>(joint.a)].position;
    dJointSetBallAnchor(made, real(p[0] + joint.anchor_a[0]), real(p[1] + joint.anchor_a[1]),
                        real(p[2] + joint.anchor_a[2]));
  }

  static void collide(void* data, dGeomID a, dGeomID b) {
    auto& self = *static_cast<OdeScene*>(data);
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == body_b) return;
    dContact contacts[k_contacts_of_pair];
    const int count = dCollide(a, b, k_contacts_of_pair, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      dSurfaceParameters& surface = contacts[i].surface;
      surface = {};
      surface.mode = dContactApprox1 | (self.restitution_ > 0 ? dContactBounce : 0);
      surface.mu = real(self.friction_);
      surface.bounce = real(self.restitution_);
      dJointAttach(dJointCreateContact(self.world_, self.contacts_, &contacts[i]), body_a, body_b);
    }
  }

  double friction_;
  double restitution_;
  int steps_;
  bool direct_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  std::vector<dBodyID> bodies_;
  std::vector<Triple> places_;
};

std::size_t touching_bodies(const NeutralScene& scene) {
  std::size_t count = 0;
  for (const NeutralBody& body : scene.bodies)
    count += body.collides ? 1 : 0;
  return count;
}

}  // namespace

std::unique_ptr<NeutralEngine> make_ode_scene(const NeutralScene& scene, int setting) {
  return std::make_unique<OdeScene>(scene, setting, false);
}

std::unique_ptr<NeutralEngine> make_ode_direct_scene(const NeutralScene& scene, int setting) {
  if (touching_bodies(scene) > k_bodies_of_direct || scene.bodies.size() > 64) return nullptr;
  return std::make_unique<OdeScene>(scene, setting, true);
}

}  // namespace lockstone::bench
