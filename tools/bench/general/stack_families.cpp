// Stacks, tables, uneven masses.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

void stack(SceneMaker& m, const Triple& at, int boxes, double half, double off) {
  for (int i = 0; i < boxes; ++i)
    m.box({half, half, half}, {at[0] + m.random.between(-off, off), half * (2 * i + 1),
                               at[2] + m.random.between(-off, off)});
}

void fill_many_stacks(SceneMaker& m) {
  const int n = m.count(1, 20), boxes = m.count(2, 16);
  const double half = m.random.between(0.15, 0.5), off = half * m.random.between(0, 0.12);
  m.ground();
  for (int i = 0; i < n; ++i)
    stack(m, {4 * half * (i % 5), 0, 4 * half * (i / 5)}, boxes, half, off);
  m.judge(Judge::displacement, 0.1 * half, 15);
}

void fill_tall_stack(SceneMaker& m) {
  const double half = m.random.between(0.2, 0.5), off = 2 * half * m.random.between(0, 0.02);
  m.ground();
  stack(m, {0, 0, 0}, m.count(20, 160), half, off);
  m.judge(Judge::displacement, 0.2 * half, 15);
}

// A plate on rows of boxes.
void fill_plate(SceneMaker& m) {
  const int n = m.count(2, 7);
  const double half = m.random.between(0.1, 0.4), pitch = 3 * half,
               mass = 8000 * half * half * half;
  m.ground();
  for (int i = 0; i < n * n; ++i)
    m.box({half, half, half}, {i % n * pitch, half, i / n * pitch});
  const double wide = 0.5 * n * pitch, middle = 0.5 * (n - 1) * pitch;
  const int plate = m.box({wide, 0.1, wide}, {middle, 2 * half + 0.1, middle});
  m.set_mass(plate, mass * m.random.log_between(1, 1000));
  m.judge(Judge::displacement, 0.02, 8);
}

// A plate on four legs with a load upon it, the centre of mass within the legs.
void fill_table(SceneMaker& m) {
  const double leg = m.random.between(0.2, 0.5), wide = m.random.between(0.6, 1.2);
  const double inset = wide * m.random.between(0.5, 0.9), ratio = m.random.log_between(1, 1000);
  m.ground();
  int first = 0;
  for (int i = 0; i < 4; ++i)
    first = m.box({0.1, leg, 0.1}, {i % 2 ? inset : -inset, leg, i / 2 ? inset : -inset});
  const double mass = mass_of(m.body(first)) * ratio;
  const double x = 0.7 * inset * m.random.between(-1, 1), z = 0.7 * inset * m.random.between(-1, 1);
  const int plate = m.box({wide, 0.05, wide}, {0, 2 * leg + 0.05, 0});
  if (m.random.chance(0.5)) {  // off centre itself
    m.body(plate).position[0] = 0.5 * x;
    m.body(plate).position[2] = 0.5 * z;
    m.set_mass(plate, mass);
  } else {
    m.set_mass(m.box({0.15, 0.15, 0.15}, {x, 2 * leg + 0.25, z}), mass);
  }
  m.judge(Judge::displacement, 0.02, 8);
}

// The same with its centre outside: it falls, and must not gain energy.
void fill_tipping_table(SceneMaker& m) {
  const double leg = m.random.between(0.2, 0.5), inset = m.random.between(0.3, 0.6);
  m.ground();
  int first = 0;
  for (int i = 0; i < 4; ++i)
    first = m.box({0.1, leg, 0.1}, {i % 2 ? inset : -inset, leg, i / 2 ? inset : -inset});
  const int plate = m.box({1, 0.1, 1}, {inset * m.random.between(1.1, 1.5), 2 * leg + 0.1, 0.2});
  m.set_mass(plate, mass_of(m.body(first)) * m.random.log_between(1, 2000));
  m.judge(Judge::gain, 0.05, 5);
}

void fill_heavy_on_light(SceneMaker& m) {
  const double light = m.random.between(0.2, 0.6), heavy = light * m.random.between(0.6, 2);
  const int n = m.count(1, 4);
  m.ground();
  int top = 0;
  for (int i = 0; i < n; ++i)
    top = m.box({light, light, light}, {0, light * (2 * i + 1), 0}, 500);
  const double mass = mass_of(m.body(top)) * m.random.log_between(5, 1e4);
  top = m.box({heavy, heavy, heavy}, {0, 2 * n * light + heavy, 0});
  m.set_mass(top, mass);
  m.judge(Judge::displacement, 0.02, 10);
}

// Stacked layers of boards and blocks of random masses.
void fill_pallets(SceneMaker& m) {
  const int layers = m.count(1, 8);
  const double half = m.random.between(0.1, 0.3);
  m.ground();
  double y = 0;
  for (int layer = 0; layer < layers; ++layer) {
    for (int i = 0; i < 9; ++i)
      m.box({half, half, half}, {4 * half * (i % 3 - 1), y + half, 4 * half * (i / 3 - 1)},
            m.random.log_between(200, 5000));
    m.box({5.5 * half, 0.05, 5.5 * half}, {0, y + 2 * half + 0.05, 0}, 700);
    y += 2 * half + 0.1;
  }
  m.judge(Judge::displacement, 0.02, 10);
}

// Boxes of random sizes, each within the one below.
void fill_cairn(SceneMaker& m) {
  const int n = m.count(3, 25);
  m.ground();
  double y = 0, half = m.random.between(0.4, 0.8);
  for (int i = 0; i < n; ++i) {
    const double high = half * m.random.between(0.3, 1);
    const int box = m.box({half, high, half}, {0, y + high, 0}, m.random.log_between(300, 3000));
    m.turn(box, general::turn_about({0, 1, 0}, m.random.between(0, 0.7)));
    y += 2 * high;
    half *= m.random.between(0.92, 1.0);
  }
  m.judge(Judge::displacement, 0.02, 12);
}

}  // namespace

void add_stack_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"many-stacks", "1-20 stacks of 2-16 boxes, off by up to 6 %", fill_many_stacks},
              {"tall-stack", "20-160 boxes, off by up to 2 %", fill_tall_stack},
              {"plate", "plate on 4-49 boxes, up to 1000 : 1", fill_plate},
              {"table", "plate and load on four legs, up to 1000 : 1", fill_table},
              {"tipping-table", "the same, its centre outside: energy", fill_tipping_table},
              {"heavy-on-light", "box on 1-4 lighter ones, 5-10,000 : 1", fill_heavy_on_light},
              {"pallets", "1-8 layers of nine boxes and a board", fill_pallets},
              {"cairn", "3-25 boxes of random sizes and turns", fill_cairn}});
}

}  // namespace lockstone::bench
