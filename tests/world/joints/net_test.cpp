// Nets of ball joints. Up to 256 bodies they are loops with a factor; larger ones, or those of a
// world without one, are left to the coloured balls.

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::hold, test::join;

World make_room(std::uint32_t converged_contacts) {
  WorldDef def{.body_capacity = 1024, .pair_capacity = 8192, .contact_capacity = 4096};
  def.joint_capacity = 2048;
  def.converged_contacts = converged_contacts;
  return test::make_world(def);
}

// A square of bodies a metre apart, each held to its neighbours, which meet nothing.
std::vector<BodyHandle> add_net(World& world, int side, const Shape& shape, test::Random& random) {
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < side * side; ++i) {
    BodyDef def = test::dynamic_body(shape, Position::from_integer(i % side), {},
                                     Position::from_integer(i / side));
    def.filter.mask = 0;
    for (int axis = 0; axis < 3; ++axis)
      def.velocity[axis] = Velocity::from_ratio(random.between(-100, 100), 100);
    bodies.push_back(test::add(world, def));
    const auto before = [&](int steps) { return bodies[static_cast<std::size_t>(i - steps)]; };
    if (i % side > 0) hold(world, before(1), bodies.back(), {0.5_m, {}, {}});
    if (i >= side) hold(world, before(side), bodies.back(), {{}, {}, 0.5_m});
  }
  return bodies;
}

template <class Of>
double mean(const std::vector<BodyHandle>& bodies, Of of) {
  double sum = 0;
  for (const BodyHandle body : bodies)
    sum += of(body);
  return sum / static_cast<double>(bodies.size());
}

double mean_height(const World& world, const std::vector<BodyHandle>& bodies) {
  return mean(bodies,
              [&](BodyHandle body) { return test::metres(world.body(body).centre_of_mass.y); });
}

double mean_speed_down(const World& world, const std::vector<BodyHandle>& bodies) {
  return -mean(bodies,
               [&](BodyHandle body) { return test::metres_per_second(world.velocity(body).y); });
}

// Whether bodies move alike in two worlds.
void expect_alike(const World& one, const World& other, const std::vector<BodyHandle>& bodies) {
  for (const BodyHandle body : bodies) {
    ASSERT_EQ(one.body(body).centre_of_mass, other.body(body).centre_of_mass);
    ASSERT_EQ(one.body(body).orientation, other.body(body).orientation);
    ASSERT_EQ(one.velocity(body), other.velocity(body));
  }
}

const Shape k_shapes[] = {Shape::sphere(0.4_m), Shape::box(0.45_m, 0.1_m, 0.45_m)};

// Forces between its bodies do not move the centre of mass of a net, however it is solved. Coloured
// balls move with all that a substep gains: by g·h·t/2 too far, 10.2 mm in half a second.
TEST(Nets, FallAsTheirCentreOfMassDoes) {
  test::Random random;
  for (const int side : {3, 15, 16, 17, 24}) {
    for (const std::uint32_t converged : {0U, 2048U}) {
      for (const Shape& shape : k_shapes) {
        World world = make_room(converged);
        const std::vector<BodyHandle> net = add_net(world, side, shape, random);
        const double speed = mean_speed_down(world, net);
        test::step(world, 30);
        EXPECT_NEAR(mean_height(world, net), -speed / 2 - 9.81 / 8, 0.0103)
            << side << " bodies a side, room for " << converged;
        EXPECT_NEAR(mean_speed_down(world, net), speed + 9.81 / 2, 0.01)
            << side << " bodies a side, room for " << converged;
      }
    }
  }
}

// Two boxes on a ledge far away, with a spring between them: an island of contacts and joints that
// is iterated, stage by stage.
void add_sprung_pair(World& world) {
  BodyDef ledge;
  ledge.motion = MotionType::static_body;
  ledge.shape = Shape::box(5_m, 0.5_m, 5_m);
  ledge.position.x = 100_m;
  test::add(world, ledge);
  const auto box = [&](Position x) {
    return test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), x, 1_m, {}));
  };
  JointDef hinge = JointDef::of(JointKind::hinge, box(99.4_m), box(100.6_m));
  hinge.frame_a.position.x = 0.6_m;
  hinge.frame_b.position.x = -0.6_m;
  hinge.angular[0].hertz = 2_r;
  join(world, hinge);
}

// Whether an island is solved whole depends on its own joints (law 9).
TEST(Nets, MoveAlikeBesideAnotherIsland) {
  for (const int side : {16, 17}) {
    for (const Shape& shape : k_shapes) {
      World alone = make_room(2048), beside = make_room(2048);
      test::Random random, same;
      const std::vector<BodyHandle> net = add_net(alone, side, shape, random);
      ASSERT_EQ(add_net(beside, side, shape, same), net);
      add_sprung_pair(beside);
      for (int tick = 0; tick < 20; ++tick) {
        (void)alone.step();
        (void)beside.step();
        expect_alike(alone, beside, net);
      }
    }
  }
}

}  // namespace
}  // namespace lockstone
