// Masonry: walls, towers, arches, domes.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

constexpr double k_pi = std::numbers::pi;

// Each row comes `ticks` after the one below it.
void brick_wall(SceneMaker& m, int wide, int high, int ticks = 0) {
  const double off = m.random.between(0, 1e-3);
  m.ground();
  for (int row = 0; row < high; ++row) {
    const bool odd = row % 2 == 1;  // half a brick at each end
    for (int i = 0; i < wide + (odd ? 1 : 0); ++i) {
      const bool end = odd && (i == 0 || i == wide);
      const double x = 0.5 * i - (odd ? 0.25 : 0) + (end ? (i == 0 ? 0.125 : -0.125) : 0);
      const double along = x + m.random.between(-off, off), across = m.random.between(-off, off);
      const int brick =
          m.box({end ? 0.125 : 0.25, 0.1, 0.125}, {along, 0.1 * (2 * row + 1), across});
      m.body(brick).from = ticks * row;
    }
  }
  m.set_friction(m.random.between(0.4, 0.8));
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.01, 15);
}

void fill_wall(SceneMaker& m) {
  const int wide = m.count(2, 12);
  brick_wall(m, wide, m.count(3, 16));
}

// Through 256 bodies and 1,024 contacts, where our solver changes its method.
void fill_long_wall(SceneMaker& m) {
  const int wide = m.count(12, 24);
  brick_wall(m, wide, m.count(10, 18));
}

// Through the same numbers while it is built. A new row falls onto the others, which have sunk.
void fill_built_wall(SceneMaker& m) {
  const int wide = m.count(4, 24), high = m.count(6, 18);
  brick_wall(m, wide, high, m.random.count(1, 40));
  m.judge(Judge::displacement, 0.1, 15);
}

void fill_nudged_wall(SceneMaker& m) {
  const int wide = m.count(4, 24), high = m.count(6, 18);
  brick_wall(m, wide, high);
  const int nudges = m.random.count(1, 6);
  const int bricks = static_cast<int>(m.scene.bodies.size()) - 1;
  for (int i = 0; i < nudges; ++i) {
    const int brick = m.random.count(1, bricks);
    m.scene.moves.push_back({60 + 10 * i, brick, m.jitter(m.random.between(0.05, 0.6)), {}});
  }
  m.judge(Judge::displacement, 0.1, 15);
}

void fill_round_tower(SceneMaker& m) {
  const int bricks = m.count(6, 16), rings = m.count(3, 16);
  const double half = 0.25, radius = half / std::tan(k_pi / bricks) + 0.15;
  m.ground();
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < bricks; ++i) {
      const double angle = 2 * k_pi * (i + 0.5 * (ring % 2)) / bricks;
      const int brick =
          m.box({0.97 * half, 0.1, 0.12},
                {radius * std::sin(angle), 0.1 * (2 * ring + 1), radius * std::cos(angle)});
      m.turn(brick, general::turn_about({0, 1, 0}, angle));
    }
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.01, 12);
}

void fill_jenga(SceneMaker& m) {
  const int layers = m.count(4, 18);
  const double gone = m.random.chance(0.5) ? 0 : 0.2, off = m.random.between(0, 5e-4);
  m.ground();
  for (int layer = 0; layer < layers; ++layer) {
    const bool across = layer % 2 == 1;
    for (int i = -1; i <= 1; ++i) {
      if (i == 0 && layer + 1 < layers && m.random.chance(gone)) continue;
      const double side = 0.25 * i + m.random.between(-off, off);
      m.box(across ? Triple{0.375, 0.075, 0.12} : Triple{0.12, 0.075, 0.375},
            {across ? 0 : side, 0.075 * (2 * layer + 1), across ? side : 0});
    }
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.01, 15);
}

void box_pyramid(SceneMaker& m, int rows) {
  const double half = m.random.between(0.2, 0.5), gap = m.random.between(0, 0.15);
  m.ground();
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i)
      m.box({half, half, half}, {half * (2 + gap) * (i + 0.5 * row), half * (2 * row + 1), 0});
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.02, 12);
}

void fill_pyramid(SceneMaker& m) {
  box_pyramid(m, m.count(3, 16));
}

// Through 256 bodies.
void fill_high_pyramid(SceneMaker& m) {
  box_pyramid(m, m.count(19, 26));
}

// Eight points of a stone between two angles and two radii, about the middle of them.
std::vector<Triple> wedge(double inner, double outer, double from, double to, double half,
                          const Triple& middle) {
  std::vector<Triple> points;
  for (const double r : {inner, outer}) {
    for (const double angle : {from, to}) {
      for (const double z : {-half, half})
        points.push_back({r * std::cos(angle) - middle[0], r * std::sin(angle) - middle[1], z});
    }
  }
  return points;
}

// Wedges between two fixed springers.
void fill_arch(SceneMaker& m) {
  const int n = m.count(5, 21);
  const double inner = m.random.between(1, 3), outer = inner * m.random.between(1.2, 1.4);
  const double start = m.random.between(0.1, 0.5);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double step = (k_pi - 2 * start) / n, from = start + i * step, to = from + step;
    const double r = 0.5 * (inner + outer), a = 0.5 * (from + to);
    const Triple middle{r * std::cos(a), r * std::sin(a), 0};
    m.hull(wedge(inner, outer, from, to, 0.3, middle), middle, 2000);
    if (i == 0 || i == n - 1) m.fix(static_cast<int>(m.scene.bodies.size()) - 1);
  }
  m.set_friction(m.random.between(0.6, 0.9));
  m.judge(Judge::displacement, 0.02, 12);
}

// Corbelled rings of bricks, each a little within the one below.
void fill_dome(SceneMaker& m) {
  const int rings = m.count(3, 10), bricks = m.count(8, 16);
  double radius = 0.25 / std::tan(k_pi / bricks) + 0.3;
  m.ground();
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < bricks; ++i) {
      const double angle = 2 * k_pi * (i + 0.5 * (ring % 2)) / bricks;
      const double half = (radius - 0.2) * std::tan(k_pi / bricks) * 0.96;
      const int brick = m.box({half, 0.08, 0.2}, {radius * std::sin(angle), 0.08 * (2 * ring + 1),
                                                  radius * std::cos(angle)});
      m.turn(brick, general::turn_about({0, 1, 0}, angle));
    }
    radius -= 0.02;
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.02, 12);
}

// A row that falls one by one: all do.
void fill_dominoes(SceneMaker& m) {
  constexpr double k_thin = 0.05, k_turning = 2.5;
  const int n = m.count(4, 60);
  const double high = m.random.between(0.3, 0.6), pitch = high * m.random.between(0.5, 1.1);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const int stone = m.box({k_thin, high, 0.2}, {i * pitch, high, 0});
    if (i == 0) {  // turns about its far lower edge: 0.8 rad/s tip the lowest stone
      m.body(stone).angular_velocity = {0, 0, -k_turning};
      m.body(stone).velocity = {k_turning * high, k_turning * k_thin, 0};
    }
    m.watch(stone);
  }
  m.scene.expected = 0.3 * high;  // how far a fallen one's centre has moved
  m.judge(Judge::missed, 0, 4 + 0.2 * n);
}

}  // namespace

void add_wall_families(std::vector<Family>& all) {
  all.insert(all.end(), {{"wall", "brick walls 2-12 wide, 3-16 high", fill_wall},
                         {"long-wall", "brick walls 12-24 wide, 10-18 high", fill_long_wall},
                         {"built-wall", "4-24 wide, 6-18 high, built row by row", fill_built_wall},
                         {"nudged-wall", "the same, 1-6 nudges of up to 0.6 m/s", fill_nudged_wall},
                         {"round-tower", "3-16 rings of 6-16 bricks", fill_round_tower},
                         {"jenga", "4-18 layers of three, some middles gone", fill_jenga},
                         {"pyramid", "3-16 rows of boxes, gaps of 0-15 %", fill_pyramid},
                         {"high-pyramid", "19-26 rows, the same", fill_high_pyramid},
                         {"arch", "5-21 wedges between fixed ends", fill_arch},
                         {"dome", "3-10 corbelled rings of 8-16 bricks", fill_dome},
                         {"dominoes", "4-60 stones: all fall", fill_dominoes}});
}

}  // namespace lockstone::bench
