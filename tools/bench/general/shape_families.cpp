// Shapes that interlock, spin or roll.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

GeneralPart bar(double radius, double half, const Triple& at, const Turn& turn) {
  GeneralPart part = slab({radius, half, 0}, at, turn);
  part.form = Form::capsule;
  return part;
}

int compound(SceneMaker& m, std::vector<GeneralPart> parts, const Triple& at, double density) {
  GeneralBody body;
  body.form = Form::compound;
  body.parts = std::move(parts);
  body.position = at;
  body.density = density;
  return m.add(body);
}

// A chain whose links hold each other by contact alone.
void fill_hooks(SceneMaker& m) {
  const int n = m.count(2, 16);
  const double h = m.random.between(0.1, 0.3), w = h * m.random.between(0.5, 0.8);
  const double t = w * m.random.between(0.1, 0.3), slack = m.random.between(0, 0.3) * t;
  const double ratio = m.random.log_between(1, 100);
  const bool round = m.random.chance(0.5);
  const Turn lie = turn_about({0, 0, 1}, std::numbers::pi / 2);
  std::vector<GeneralPart> link;
  for (const double way : {-1.0, 1.0}) {
    if (round) {
      link.push_back(bar(t, w, {0, way * h, 0}, lie));
      link.push_back(bar(t, h, {way * w, 0, 0}, {0, 0, 0, 1}));
    } else {
      link.push_back(slab({w + t, t, t}, {0, way * h, 0}));
      link.push_back(slab({t, h - t, t}, {way * w, 0, 0}));
    }
  }
  const double pitch = 2 * h - 2 * t - slack, top = pitch * n + 1 + h;
  m.ground();
  for (int i = 0; i < n; ++i) {
    const int body = compound(m, link, {0, top - i * pitch, 0}, 1000);
    if (i == 0) m.fix(body);
    m.turn(body, turn_about({0, 1, 0}, i % 2 * std::numbers::pi / 2));
    m.body(body).velocity = {i > 0 ? m.random.between(0, 0.3) : 0, 0, 0};
    if (i == n - 1) m.set_density(body, 1000 * ratio);
  }
  m.watch(n);  // the last: the ground is the first
  m.set_friction(m.random.between(0.1, 0.8));
  m.scene.low = top - (n - 1) * pitch - n * slack - 0.3 * t;
  m.judge(Judge::fallen, 0.02, 8);
}

// Nuts dropped over a post.
void fill_nuts(SceneMaker& m) {
  const int n = m.count(1, 16), sides = m.random.count(5, 9);
  const double post = m.random.between(0.05, 0.15), r = post * m.random.between(1.3, 2.2);
  const double thick = 0.3 * r, half = r * m.random.between(0.2, 0.6);
  const double spread = m.random.log_between(1, 1000);
  std::vector<GeneralPart> nut;
  for (int i = 0; i < sides; ++i) {
    const Turn turn = turn_about({0, 1, 0}, 2 * std::numbers::pi * i / sides);
    const double wide = (r + 2 * thick) * std::tan(std::numbers::pi / sides);
    nut.push_back(slab({thick, half, wide}, turned(turn, {r + thick, 0, 0}), turn));
  }
  m.ground();
  const double high = 2.5 * half * n + 0.5;
  m.fix(m.capsule(post, high, {0, high, 0}));
  for (int i = 0; i < n; ++i) {
    const int body = compound(m, nut, {0, 0.2 + half + 2.5 * half * i, 0},
                              100 * m.random.log_between(1, spread));
    m.turn(body, turn_about({m.random.between(-1, 1), 0, 1}, m.random.between(0, 0.2)));
  }
  m.set_friction(m.random.between(0.2, 0.8));
  heap(m, 12);
}

std::vector<GeneralPart> table(SceneMaker& m, double wide, double high, double thick) {
  std::vector<GeneralPart> parts{slab({wide, thick, wide}, {0, high, 0})};
  const int kind = m.random.count(0, 2);
  if (kind == 0) {
    for (const double x : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        parts.push_back(
            slab({thick, high, thick}, {x * (wide - thick), -thick, z * (wide - thick)}));
  } else {
    for (const double x : {-1.0, 1.0})
      parts.push_back(slab({thick, high, wide}, {x * (wide - thick), -thick, 0}));
  }
  if (kind == 2) parts.push_back(slab({wide, thick, wide}, {0, -high, 0}));
  return parts;
}

// Tables, benches and frames on top of each other.
void fill_tables(SceneMaker& m) {
  const int n = m.count(1, 14);
  const double spread = m.random.log_between(1, 1000);
  const double wide = m.random.between(0.3, 0.6), thick = m.random.between(0.03, 0.06);
  double y = 0;
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double high = m.random.between(0.15, 0.4);
    const auto parts = table(m, wide, high, thick);
    compound(m, parts,
             {m.random.between(-0.02, 0.02), y + high + thick, m.random.between(-0.02, 0.02)},
             50 * m.random.log_between(1, spread));
    y += 2 * high + 2 * thick;
  }
  m.set_friction(m.random.between(0.3, 0.8));
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.02, 8);
}

// Jacks, hooks and crosses that fall into a tangle.
void fill_tangle(SceneMaker& m) {
  const int n = m.count(2, 80), side = m.random.count(2, 4), kind = m.random.count(0, 3);
  const double size = m.random.between(0.1, 0.3), t = size * m.random.between(0.08, 0.25);
  const bool round = m.random.chance(0.5);
  const Turn x = turn_about({0, 0, 1}, std::numbers::pi / 2),
             z = turn_about({1, 0, 0}, std::numbers::pi / 2);
  const auto rod = [&](const Triple& at, const Turn& turn) {
    return round ? bar(t, size - t, at, turn) : slab({t, size, t}, at, turn);
  };
  std::vector<GeneralPart> parts{rod({0, 0, 0}, {0, 0, 0, 1})};
  if (kind == 0) parts.insert(parts.end(), {rod({0, 0, 0}, x), rod({0, 0, 0}, z)});
  if (kind == 1) parts.insert(parts.end(), {rod({size, size, 0}, x), rod({size, -size, 0}, x)});
  if (kind == 2)
    parts.insert(parts.end(), {rod({size, size, 0}, x), rod({2 * size, 0, 0}, {0, 0, 0, 1})});
  if (kind == 3) parts.insert(parts.end(), {rod({size, size, 0}, x), rod({-size, -size, 0}, z)});
  m.ground();
  pen(m, 1.6 * size * side, 8);
  for (int i = 0; i < n; ++i)
    m.turn(compound(m, parts, cell(i, side, 2.8 * size) + Triple{0, size, 0}, 800), m.any_turn());
  m.set_friction(m.random.between(0.2, 0.9));
  heap(m, 15);
}

std::vector<Triple> prism(int corners, double low_radius, double radius, double half) {
  std::vector<Triple> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.push_back({radius * std::cos(angle), half, radius * std::sin(angle)});
    if (low_radius > 0)
      points.push_back({low_radius * std::cos(angle), -half, low_radius * std::sin(angle)});
  }
  if (low_radius <= 0) points.push_back({0, -half, 0});
  return points;
}

// Coins, tops, cones and cylinders, spun or rolled, on a floor or down a slope.
void fill_spinners(SceneMaker& m) {
  const int n = m.count(1, 8);
  const bool slope = m.random.chance(0.4);
  m.ground();
  pen(m, 5, 5);
  if (slope) {
    const int ramp = m.box({4, 0.2, 5}, {-2.5, 0.6, 0});
    m.fix(ramp);
    m.turn(ramp, turn_about({0, 0, 1}, -m.random.between(0.1, 0.4)));
  }
  for (int i = 0; i < n; ++i) {
    const int kind = m.random.count(0, 3), corners = m.random.count(12, 28);
    const double r = m.random.between(0.08, 0.3);
    const double half =
        kind == 0 ? r * m.random.between(0.04, 0.15) : r * m.random.between(0.5, 1.5);
    const Triple at{slope ? -2.5 : 1.0 * (i % 3 - 1), slope ? 2.5 : r + half, 1.0 * (i - 0.5 * n)};
    const int body = m.hull(prism(corners,
                                  kind == 2   ? 0
                                  : kind == 3 ? 0.5 * r
                                              : r,
                                  r, half),
                            at, 2000);
    const Turn lie = turn_about({1, 0, 0}, std::numbers::pi / 2 + m.random.between(-0.2, 0.2));
    if (kind != 2 || m.random.chance(0.5)) m.turn(body, lie);
    m.body(body).angular_velocity = {m.random.between(-2, 2), m.random.between(-30, 30),
                                     m.random.between(-10, 10)};
    m.body(body).velocity = {m.random.between(-2, 2), 0, m.random.between(-1, 1)};
  }
  m.set_friction(m.random.between(0.2, 0.8));
  heap(m, 25);
}

}  // namespace

void add_shape_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"hooks", "2-16 links that hold each other by contact", fill_hooks},
              {"nuts", "1-16 nuts dropped over a post", fill_nuts},
              {"tables", "1-14 tables and frames on top of each other", fill_tables},
              {"tangle", "2-80 jacks, hooks and crosses fall into a tangle", fill_tangle},
              {"spinners", "1-8 coins, tops, cones, cylinders spin or roll", fill_spinners}});
}

}  // namespace lockstone::bench
