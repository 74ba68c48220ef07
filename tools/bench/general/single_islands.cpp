// Islands by themselves, with fixed numbers: the cost of one of each kind.
#include <cmath>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

void pass_through(SceneMaker& m) {
  for (GeneralBody& body : m.scene.bodies)
    body.collides = false;
}

void fill_one_slider_crank(SceneMaker& m) {
  const int crank = m.box({0.1, 0.03, 0.03}, {0.1, 0, 0});
  const int bar = m.box({0.3, 0.03, 0.03}, {0.5, 0, 0});
  const int slide = m.box({0.1, 0.1, 0.1}, {0.8, 0, 0});
  const int frame = m.anchor({0, 0, 0});
  GeneralJoint& motor = m.join(Link::hinge, frame, crank, {0, 0, 0});
  motor.speed = 6;
  motor.effort = 5000;
  m.join(Link::hinge, crank, bar, {0.2, 0, 0});
  m.join(Link::hinge, bar, slide, {0.8, 0, 0});
  m.join(Link::slider, frame, slide, {0.8, 0, 0}, {1, 0, 0});
  pass_through(m);
  m.scene.passive = false;
  m.judge(Judge::rate, 0.01, 10);
}

void fill_one_chain(SceneMaker& m) {
  constexpr int k_links = 30;
  constexpr double k_half = 0.1;
  int before = m.anchor({0, 0, 0});
  for (int i = 0; i < k_links; ++i) {
    const int link =
        m.box({0.9 * k_half, 0.3 * k_half, 0.3 * k_half}, {(2 * i + 1) * k_half, 0, 0});
    m.join(Link::ball, before, link, {2 * i * k_half, 0, 0});
    before = link;
  }
  pass_through(m);
  m.scene.low = -2 * k_links * k_half;
  m.judge(Judge::gap, 0.01, 10);
}

void fill_one_stack(SceneMaker& m) {
  m.ground();
  for (int i = 0; i < 25; ++i)
    m.box({0.5, 0.5, 0.5}, Triple{0, i + 0.5, 0} + Triple{m.random.between(-0.03, 0.03), 0,
                                                          m.random.between(-0.03, 0.03)});
  m.judge(Judge::displacement, 0.1, 10);
}

void fill_one_ragdoll(SceneMaker& m) {
  m.ground();
  add_ragdoll(m, {0, 2, 0});
  m.set_friction(0.6);
  m.judge(Judge::gap, 0.01, 10);
}

// A chassis on four driven wheels.
void fill_one_car(SceneMaker& m) {
  m.ground();
  const int chassis = m.box({0.8, 0.2, 0.5}, {0, 0.6, 0}, 300);
  for (const double x : {-0.6, 0.6}) {
    for (const double z : {-0.65, 0.65}) {
      const int wheel = m.ball(0.3, {x, 0.3, z}, 500);
      GeneralJoint& axle = m.join(Link::hinge, chassis, wheel, {x, 0.3, z}, {0, 0, 1});
      axle.speed = -5;
      axle.effort = 100;
    }
  }
  m.set_friction(0.8);
  m.scene.passive = false;
  m.judge(Judge::gap, 0.01, 10);
}

}  // namespace

const std::vector<Family>& single_islands() {
  static const std::vector<Family> all{
      {"one-slider-crank", "a motor turns a crank at 6 rad/s", fill_one_slider_crank},
      {"one-chain", "thirty links on balls swing from horizontal", fill_one_chain},
      {"one-stack", "25 boxes, off by up to 3 cm", fill_one_stack},
      {"one-ragdoll", "ten bodies fall on a floor", fill_one_ragdoll},
      {"one-car", "a chassis on four driven wheels", fill_one_car}};
  return all;
}

}  // namespace lockstone::bench
