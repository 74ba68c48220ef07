// Scenes that only a converged solution of contacts, or of the locks of joints, holds
// (WorldDef::converged_contacts).

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/joints/joint_fixture.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

using test::gap, test::metres;

double distance(const Vec3<Position>& a, const Vec3<Position>& b) {
  return std::hypot(metres(a.x - b.x), metres(a.y - b.y), metres(a.z - b.z));
}

// Steps for so long; how far the bodies went in that time.
double greatest_way(World& world, const std::vector<BodyHandle>& bodies, int ticks) {
  std::vector<Vec3<Position>> starts;
  for (const BodyHandle body : bodies)
    starts.push_back(world.position(body));
  test::step(world, ticks);
  double most = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    most = std::max(most, distance(world.position(bodies[i]), starts[i]));
  return most;
}

// One of boxes off by up to 3 cm, whose height is that of 40.
TEST(Converged, AStackOutOfLineStands) {
  World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 40; ++i) {
    const Position x = Position::from_ratio(i * 37 % 61 - 30, 1000);
    boxes.push_back(test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), x,
                                                        Position::from_ratio(2 * i + 1, 2), {})));
  }
  EXPECT_LT(greatest_way(world, boxes, 900), 0.005);
}

TEST(Converged, ALightBoxCarriesThousandsOfTimesItsWeight) {
  for (const int ratio : {10, 400, 1000, 5000}) {
    World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
    test::add_ground(world);
    const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
    std::vector<BodyHandle> boxes;
    BodyDef heavy = test::dynamic_body(box, {}, 1.5_m, {});
    heavy.material.density = Density::from_integer(ratio);
    BodyDef light = test::dynamic_body(box, {}, 0.5_m, {});
    light.material.density = Density::from_integer(1);
    boxes.push_back(test::add(world, light));
    boxes.push_back(test::add(world, heavy));
    EXPECT_LT(greatest_way(world, boxes, 600), 0.002) << ratio;
  }
}

template <class Value>
double number(Value x) {
  return std::ldexp(static_cast<double>(x.raw), -Value::frac_bits);
}

// A hinge about z, of bodies that are turned about nothing else.
JointDef hinge_about_z(BodyHandle a, BodyHandle b) {
  JointDef hinge = JointDef::of(JointKind::hinge, a, b);
  hinge.frame_a.orientation = from_axis_angle({{}, 1_r, {}}, -1.570796327_rad);
  hinge.frame_b.orientation = hinge.frame_a.orientation;
  return hinge;
}

BodyHandle add_hook(World& world, Position y) {
  BodyDef hook;
  hook.motion = MotionType::static_body;
  hook.shape = Shape::sphere(0.02_m);
  hook.position.y = y;
  hook.filter.mask = 0;
  return test::add(world, hook);
}

// Boxes in a closed ring of hinges about z, its centre at the origin. Every fourth is heavier.
class Ring {
 public:
  Ring(World& world, int count, int ratio, double gravity)
      : world_(world), ratio_(ratio), gravity_(gravity) {
    const double half = 0.25, step = 2 * std::numbers::pi / count;
    radius_ = half / std::tan(step / 2);
    for (int i = 0; i < count; ++i) {
      BodyDef box =
          test::dynamic_body(Shape::box(0.22_m, 0.05_m, 0.08_m), at(radius_ * std::sin(step * i)),
                             at(radius_ * std::cos(step * i)), {});
      box.orientation = from_axis_angle({{}, {}, 1_r}, Angle::from_ratio(raw(-step * i), 1 << 20));
      box.filter.mask = 0;
      box.material.density = Density::from_integer(1000 * weight(boxes_.size()));
      boxes_.push_back(test::add(world, box));
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      JointDef hinge = hinge_about_z(boxes_[i], boxes_[(i + 1) % boxes_.size()]);
      hinge.frame_a.position.x = 0.25_m;
      hinge.frame_b.position.x = -0.25_m;
      join(hinge);
    }
  }

  void hang() { join(JointDef::of(JointKind::ball, add_hook(world_, at(radius_)), boxes_[0])); }

  // Turns the ring, and compresses it.
  void spin(double rate) {
    for (const BodyHandle box : boxes_) {
      const auto [x, y, z] = world_.position(box);
      (void)world_.apply(SetVelocity{box,
                                     {speed(rate * (metres(x) / 2 - metres(y))),
                                      speed(rate * (metres(x) - metres(y) / 2)),
                                      {}}});
      (void)world_.apply(
          SetAngularVelocity{box, {{}, {}, AngularVelocity::from_ratio(raw(rate), 1 << 20)}});
    }
  }

  // Steps for so long; the greatest opening of its joints, m.
  double widest_gap_in(int ticks) {
    double widest = 0;
    most_energy_ = energy();
    for (int tick = 0; tick < ticks; ++tick) {
      (void)world_.step();
      for (const JointHandle joint : joints_)
        widest = std::max(widest, gap(world_.joint(joint)));
      most_energy_ = std::max(most_energy_, energy());
    }
    return widest;
  }

  // In the plane of the ring, J/kg.
  [[nodiscard]] double energy() const {
    double sum = 0, mass = 0;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const BodyView view = world_.body(boxes_[i]);
      const double vx = number(view.velocity.x), vy = number(view.velocity.y);
      const double w = number(view.angular_velocity.z);
      const double turning = (0.22 * 0.22 + 0.05 * 0.05) / 3 * w * w;
      sum += weight(i) * ((vx * vx + vy * vy + turning) / 2 + gravity_ * number(view.position.y));
      mass += weight(i);
    }
    return sum / mass;
  }
  [[nodiscard]] double most_energy() const { return most_energy_; }

 private:
  [[nodiscard]] int weight(std::size_t box) const { return box % 4 == 0 ? ratio_ : 1; }
  static std::int64_t raw(double x) { return std::llround(std::ldexp(x, 20)); }
  static Position at(double x) { return Position::from_ratio(raw(x), 1 << 20); }
  static Velocity speed(double x) { return Velocity::from_ratio(raw(x), 1 << 20); }
  void join(const JointDef& def) { joints_.push_back(world_.create_joint(def).value()); }

  World& world_;
  int ratio_;
  double gravity_, radius_ = 0, most_energy_ = 0;
  std::vector<BodyHandle> boxes_;
  std::vector<JointHandle> joints_;
};

TEST(ConvergedJoints, AHungRingOfHingesStaysClosedAndGainsNoEnergy) {
  for (const int ratio : {1, 10}) {
    for (const int count : {3, 8, 17, 23}) {
      World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
      Ring ring(world, count, ratio, 9.81);
      ring.hang();
      const double start = ring.energy();
      EXPECT_LT(ring.widest_gap_in(300), 0.001) << count << " boxes, " << ratio;
      EXPECT_LT(ring.most_energy(), start + 0.02) << count << " boxes, " << ratio;
    }
  }
}

TEST(ConvergedJoints, AFreeRingOfHingesStaysClosedAndGainsNoEnergy) {
  for (const int count : {3, 8, 20}) {
    World world = test::make_world({.body_capacity = 64, .sleep_ms = 0, .gravity = {}});
    Ring ring(world, count, 10, 0);
    ring.spin(3);
    const double start = ring.energy();
    EXPECT_LT(ring.widest_gap_in(480), 0.001) << count;
    EXPECT_LT(ring.most_energy(), 1.001 * start) << count;
  }
}

// A boom on a hinge and a cable; its rope of light links carries a box of a ton.
class Crane {
 public:
  explicit Crane(World& world) : world_(world) {
    const BodyHandle boom = add(Shape::box(2_m, 0.08_m, 0.08_m), 2_m, {}, 800);
    JointDef foot = hinge_about_z(add_hook(world, {}), boom);
    foot.frame_b.position.x = -2_m;
    join(foot);
    JointDef cable = JointDef::of(JointKind::distance, add_hook(world, 3_m), boom);
    cable.frame_b.position.x = 1.9_m;
    cable.linear[0].mode = AxisMode::limited;
    cable.linear[0].lower = cable.linear[0].upper = 4.92036_m;
    (void)world.create_joint(cable).value();
    hang_load(boom);
  }

  // Swings for so long; the greatest opening of its joints, m.
  double widest_gap_in(int ticks) {
    (void)world_.apply(SetVelocity{load_, {{}, {}, 0.7_mps}});
    double widest = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      (void)world_.step();
      for (const JointHandle joint : joints_)
        widest = std::max(widest, gap(world_.joint(joint)));
      const Vec3<Velocity> v = world_.body(load_).velocity;
      fastest_ = std::max(fastest_, std::hypot(number(v.x), number(v.y), number(v.z)));
    }
    return widest;
  }
  [[nodiscard]] double fastest_load() const { return fastest_; }

 private:
  BodyHandle add(const Shape& shape, Position x, Position y, int density) {
    BodyDef def = test::dynamic_body(shape, x, y, {});
    def.filter.mask = 0;
    def.material.density = Density::from_integer(density);
    return test::add(world_, def);
  }
  void join(const JointDef& def) { joints_.push_back(world_.create_joint(def).value()); }

  void hang_load(BodyHandle boom) {
    JointDef ball = JointDef::of(JointKind::ball, boom, {});
    ball.frame_a.position.x = 1.9_m;
    ball.frame_b.position.y = 0.08_m;
    for (int i = 0; i < 10; ++i) {
      const Position y = Position::from_ratio(-16 * i - 8, 100);
      ball.body_b = add(Shape::capsule(0.05_m, 0.03_m), 3.9_m, y, 1000);
      join(ball);
      ball.body_a = ball.body_b;
      ball.frame_a.position = {{}, -0.08_m, {}};
    }
    ball.body_b = load_ = add(Shape::box(0.3_m, 0.3_m, 0.3_m), 3.9_m, -1.9_m, 5000);
    ball.frame_b.position.y = 0.3_m;
    join(ball);
  }

  World& world_;
  BodyHandle load_{};
  double fastest_ = 0;
  std::vector<JointHandle> joints_;
};

TEST(ConvergedJoints, ACraneCarriesAHeavyLoadOnALightRope) {
  World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
  Crane crane(world);
  EXPECT_LT(crane.widest_gap_in(600), 0.001);
  EXPECT_LT(crane.fastest_load(), 0.8);
}

// A motor turns a crank of 0.3 m, whose rod of 1 m pushes a box of 8 kg to and fro.
class SliderCrank {
 public:
  SliderCrank(World& world, Torque effort) : world_(world) {
    const BodyHandle frame = add_hook(world, {});
    const BodyHandle crank = add(Shape::box(0.15_m, 0.03_m, 0.03_m), 0.15_m);
    const BodyHandle rod = add(Shape::box(0.5_m, 0.03_m, 0.03_m), 0.8_m);
    const BodyHandle slide = add(Shape::box(0.1_m, 0.1_m, 0.1_m), 1.3_m);
    JointDef motor = hinge(frame, {}, crank, -0.15_m);
    motor.angular[0].speed = 5_rps;
    motor.angular[0].max_effort = effort;
    motor_ = world.create_joint(motor).value();
    (void)world.create_joint(hinge(crank, 0.15_m, rod, -0.5_m)).value();
    (void)world.create_joint(hinge(rod, 0.5_m, slide, {})).value();
    JointDef slider = JointDef::of(JointKind::slider, frame, slide);
    slider.frame_a.position.x = 1.3_m;
    (void)world.create_joint(slider).value();
    crank_ = crank;
  }

  [[nodiscard]] double speed() const { return number(world_.body(crank_).angular_velocity.z); }
  [[nodiscard]] double torque() const { return std::abs(number(world_.joint(motor_).torque.x)); }

 private:
  static JointDef hinge(BodyHandle a, Length at_a, BodyHandle b, Length at_b) {
    JointDef def = hinge_about_z(a, b);
    def.frame_a.position.x = at_a;
    def.frame_b.position.x = at_b;
    return def;
  }
  BodyHandle add(const Shape& shape, Position x) {
    BodyDef def = test::dynamic_body(shape, x, {}, {});
    def.filter.mask = 0;
    return test::add(world_, def);
  }

  World& world_;
  BodyHandle crank_{};
  JointHandle motor_{};
};

TEST(ConvergedJoints, AMotorKeepsTheSpeedOfASliderCrank) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  const SliderCrank machine(world, Torque::from_integer(5000));
  test::step(world, 10);
  for (int tick = 0; tick < 480; ++tick) {
    (void)world.step();
    ASSERT_NEAR(machine.speed(), 5, 0.01) << tick;
  }
}

TEST(ConvergedJoints, AMotorOfASliderCrankPushesNoHarderThanItMay) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  const SliderCrank machine(world, Torque::from_integer(20));
  double fastest = 0, greatest = 0;
  for (int tick = 0; tick < 480; ++tick) {
    (void)world.step();
    fastest = std::max(fastest, machine.speed());
    greatest = std::max(greatest, machine.torque());
  }
  EXPECT_LT(greatest, 20.1);
  EXPECT_GT(greatest, 19.9);
  EXPECT_GT(fastest, 4);
  EXPECT_LT(fastest, 5.5);
}

}  // namespace
}  // namespace lockstone
