// Chains and loops of joints, hung or fastened, that nothing touches.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

constexpr double k_pi = std::numbers::pi;

// Bodies of a joint scene pass through each other, and may fall a given way.
void hang(SceneMaker& m, double reach) {
  for (GeneralBody& body : m.scene.bodies)
    body.collides = false;
  m.scene.low = -reach;
}

Link ball_or_hinge(SceneMaker& m) {
  return m.random.chance(0.5) ? Link::ball : Link::hinge;
}

// Planks in a row, both ends fastened: singular where it is straight.
void fill_span(SceneMaker& m) {
  const int n = m.count(2, 20);
  const double pitch = m.random.between(0.2, 1), half = 0.475 * pitch;
  const double density = m.random.log_between(100, 5000);
  const Link link = ball_or_hinge(m);
  int before = m.anchor({0, 0, 0});
  for (int i = 0; i < n; ++i) {
    const int plank = m.box({half, 0.1 * pitch, 0.5 * pitch}, {(i + 0.5) * pitch, 0, 0}, density);
    m.join(link, before, plank, {i * pitch, 0, 0});
    before = plank;
  }
  m.join(link, before, m.anchor({n * pitch, 0, 0}), {n * pitch, 0, 0});
  hang(m, n * pitch);
  m.judge(Judge::gap, 0.01, 8);
}

// A closed ring of boxes about a point of the y axis, in the plane of x and y; the first one is at
// the top.
struct Ring {
  int count = 0;
  double half = 0;    // of a box's length
  double centre = 0;  // y

  [[nodiscard]] double radius() const { return half / std::tan(k_pi / count); }
};

template <class Density>
std::vector<int> add_ring(SceneMaker& m, const Ring& ring, Link link, const Density& density) {
  std::vector<int> boxes;
  const auto at = [&ring](double reach, double part) {
    const double angle = 2 * k_pi * part / ring.count;
    return Triple{reach * std::sin(angle), ring.centre + reach * std::cos(angle), 0};
  };
  for (int i = 0; i < ring.count; ++i) {
    const double half = ring.half;
    const int box = m.box({0.9 * half, 0.2 * half, 0.3 * half}, at(ring.radius(), i), density());
    m.turn(box, general::turn_about({0, 0, 1}, -(2 * k_pi * i / ring.count)));
    boxes.push_back(box);
  }
  const double corner = ring.half / std::sin(k_pi / ring.count);
  for (int i = 0; i < ring.count; ++i)
    m.join(link, boxes[static_cast<std::size_t>(i)],
           boxes[static_cast<std::size_t>((i + 1) % ring.count)], at(corner, i + 0.5));
  return boxes;
}

// A closed ring with parallel hinges, hung from one ball.
void fill_ring(SceneMaker& m) {
  const int n = m.count(3, 24);
  const Ring ring{n, m.random.between(0.1, 0.4)};
  const Link link = m.random.chance(0.8) ? Link::hinge : Link::ball;
  const double spread = m.random.log_between(1, 10);
  const std::vector<int> boxes =
      add_ring(m, ring, link, [&] { return 1000 * m.random.log_between(1, spread); });
  const Triple top{0, ring.radius(), 0};
  m.join(Link::ball, m.anchor(top), boxes[0], top);
  hang(m, n * 2 * ring.half);
  m.judge(Judge::gap, 0.01, 8);
}

// A chain of light links, some fastened far beside their centres, holds a closed ring of heavier
// boxes.
void fill_weak_link(SceneMaker& m) {
  const int links = m.count(1, 3), n = m.count(3, 8);
  Ring ring{n, m.random.between(0.1, 0.4)};
  const double half = ring.half;
  const double ratio = m.random.log_between(1, 2000), size = m.random.log_between(0.02, 0.2);
  const Link held = m.random.chance(0.3) ? Link::weld : ball_or_hinge(m);
  double top = 0;
  int before = m.anchor({0, 0, 0});
  const double ring_mass = 1000 * 8 * 0.9 * half * 0.2 * half * 0.3 * half * n;
  const double lever = m.random.between(0, 0.5);
  for (int i = 0; i < links; ++i) {
    const Triple beside = m.jitter(lever);
    const int link = m.box({0.3 * size, 0.9 * size, 0.3 * size},
                           Triple{beside[0], top - size + beside[1], beside[2]});
    m.set_mass(link, ring_mass / ratio);
    m.join(i == 0 ? held : ball_or_hinge(m), before, link, {0, top, 0});
    top -= 2 * size;
    before = link;
  }
  ring.centre = top - ring.radius();
  const std::vector<int> boxes = add_ring(m, ring, Link::hinge, [] { return 1000.0; });
  m.join(Link::ball, before, boxes[0], {0, top, 0});
  const double push = m.random.between(0, 2);
  for (const int box : boxes)
    m.body(box).velocity = {push, 0, 0};
  hang(m, 2 * size * links + n * 2 * half);
  m.judge(Judge::gap, 0.01, 8);
}

// n × n plates joined at the middle of their edges, hung by two corners.
void hang_net(SceneMaker& m, int n, double pitch, Link link) {
  std::vector<int> plates;
  for (int i = 0; i < n * n; ++i)
    plates.push_back(
        m.box({0.47 * pitch, 0.04, 0.47 * pitch}, {i % n * pitch, 0, i / n * pitch}, 500));
  const auto plate = [&](int x, int z) { return plates[static_cast<std::size_t>(z * n + x)]; };
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x + 1 < n; ++x) {
      m.join(link, plate(x, z), plate(x + 1, z), {(x + 0.5) * pitch, 0, z * pitch}, {0, 0, 1});
      m.join(link, plate(z, x), plate(z, x + 1), {z * pitch, 0, (x + 0.5) * pitch}, {1, 0, 0});
    }
  }
  const double edge = 0.5 * pitch, far = (n - 0.5) * pitch;
  m.join(Link::ball, m.anchor({-edge, 0, -edge}), plate(0, 0), {-edge, 0, -edge});
  m.join(Link::ball, m.anchor({far, 0, -edge}), plate(n - 1, 0), {far, 0, -edge});
  hang(m, n * pitch * 2);
  m.judge(Judge::gap, 0.01, 8);
}

void fill_net(SceneMaker& m) {
  const int n = m.count(2, 5);
  const double pitch = m.random.between(0.3, 0.8);
  hang_net(m, n, pitch, ball_or_hinge(m));
}

void fill_wide_net(SceneMaker& m) {
  const int n = m.count(6, 24);
  hang_net(m, n, m.random.between(0.3, 0.8), Link::ball);
}

// An open chain with a heavy end.
void fill_chain(SceneMaker& m) {
  const int n = m.count(2, 60);
  const double half = m.random.between(0.05, 0.3), ratio = m.random.log_between(1, 500);
  const double tilt = m.random.between(0, 0.5 * k_pi);
  const Triple way{std::sin(tilt), -std::cos(tilt), 0};
  using namespace general;
  const Turn along = turn_about({0, 0, 1}, tilt);
  int before = m.anchor({0, 0, 0});
  for (int i = 0; i < n; ++i) {
    const int link = m.box({0.3 * half, 0.9 * half, 0.3 * half}, (2 * i + 1) * half * way);
    m.turn(link, along);
    m.join(m.random.chance(0.7) ? Link::ball : Link::hinge, before, link, 2 * i * half * way);
    before = link;
  }
  m.set_density(before, 1000 * ratio);
  hang(m, 2 * n * half);
  m.judge(Judge::gap, 0.01, 10);
}

// One to four rods that swing and keep their energy.
void fill_pendulum(SceneMaker& m) {
  using namespace general;
  const int n = m.count(1, 4);
  Triple at{0, 0, 0};
  int before = m.anchor(at);
  double reach = 0;
  for (int i = 0; i < n; ++i) {
    const double half = m.random.between(0.2, 0.6), angle = m.random.between(0.2, 1.6);
    const Triple way{std::sin(angle), -std::cos(angle), 0};
    const int rod =
        m.box({0.1 * half, half, 0.1 * half}, at + half * way, 1000 * m.random.log_between(0.2, 5));
    m.turn(rod, turn_about({0, 0, 1}, angle));
    m.join(ball_or_hinge(m), before, rod, at);
    at = at + 2 * half * way;
    reach += 2 * half;
    before = rod;
  }
  hang(m, reach);
  m.judge(Judge::energy, 0.05, 20);
}

// A four-bar linkage that swings through its toggle positions.
void fill_four_bar(SceneMaker& m) {
  const double width = m.random.between(0.5, 1.5), arm = m.random.between(0.2, 0.8);
  const double other = m.random.chance(0.5) ? arm : arm * m.random.between(1, 1.3);
  const double thick = 0.05;
  const int left = m.box({arm, thick, thick}, {arm, 0, 0});
  const int coupler = m.box({0.5 * width, thick, thick}, {2 * arm + 0.5 * width, 0, 0});
  const int right = m.box({other, thick, thick}, {2 * arm + width - other, 0, 0});
  const double end = 2 * arm + width - 2 * other;
  m.join(Link::hinge, m.anchor({0, 0, 0}), left, {0, 0, 0});
  m.join(Link::hinge, left, coupler, {2 * arm, 0, 0});
  m.join(Link::hinge, coupler, right, {2 * arm + width, 0, 0});
  m.join(Link::hinge, m.anchor({end, 0, 0}), right, {end, 0, 0});
  m.body(left).angular_velocity = {0, 0, 0};
  hang(m, 2 * arm + width + 2 * other);
  m.judge(Judge::gap, 0.01, 10);
}

// Balls that hang each on two rods and swing against each other.
void fill_cradle(SceneMaker& m) {
  using namespace general;
  const int n = m.count(2, 7), lifted = m.random.count(1, std::max(1, n / 2));
  const double r = m.random.between(0.05, 0.3), length = m.random.between(1, 3);
  const double angle = m.random.between(0.2, 1);
  for (int i = 0; i < n; ++i) {
    const double turn = i < lifted ? -angle : 0;
    const Triple top{2.001 * r * i, 0, 0};
    const int ball = m.ball(r, top + length * Triple{std::sin(turn), -std::cos(turn), 0}, 2000);
    m.body(ball).restitution = 1;
    m.body(ball).friction = 0;
    const Triple at = m.body(ball).position;
    for (const double side : {-0.5, 0.5}) {
      const Triple hook = top + Triple{0, 0, side * length};
      m.rod(m.anchor(hook), ball, hook, at);
    }
  }
  m.scene.low = -length;
  m.judge(Judge::energy, 0.1, 10);
}

}  // namespace

void add_loop_families(std::vector<Family>& all) {
  all.insert(
      all.end(),
      {{"span", "2-20 planks straight between two fixed ends", fill_span},
       {"ring", "closed ring of 3-24 boxes, parallel hinges or balls, hung", fill_ring},
       {"weak-link", "1-3 light links hold a ring of 3-8 boxes, up to 2000 : 1", fill_weak_link},
       {"net", "net of 2 x 2 to 5 x 5 plates hung by two corners", fill_net},
       {"wide-net", "such a net of 6 x 6 to 24 x 24 plates, balls between them", fill_wide_net},
       {"chain", "open chain of 2-60 links, end up to 500 : 1", fill_chain},
       {"pendulum", "1-4 rods that swing for 20 s", fill_pendulum},
       {"four-bar", "a linkage that swings through toggles", fill_four_bar},
       {"cradle", "2-7 elastic balls on two rods each", fill_cradle}});
}

}  // namespace lockstone::bench
