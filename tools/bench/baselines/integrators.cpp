// Row 101: the effect of Euler's three methods on the energy of a spring and of an orbit, in
// double.
#include <array>
#include <cmath>
#include <numbers>

#include "tools/bench/accuracy/accuracy.h"

namespace lockstone::bench {
namespace {

constexpr double k_step = 1.0 / 60;  // s
constexpr double k_minute = 60;      // s
constexpr int k_minutes = 10;
constexpr double k_rate = std::numbers::pi;  // rad/s: a spring of 2 s, an orbit of 2 s at 1 m

using Vec2 = std::array<double, 2>;

Vec2 plus(const Vec2& a, const Vec2& b, double h) {
  return {a[0] + h * b[0], a[1] + h * b[1]};
}

double square(const Vec2& a) {
  return a[0] * a[0] + a[1] * a[1];
}

struct System {
  const char* name;
  Vec2 (*pull)(const Vec2& place);  // acceleration
  double (*potential)(const Vec2& place);
};

constexpr double k_strength = k_rate * k_rate;

constexpr System k_spring{"spring",
                          [](const Vec2& x) -> Vec2 {
                            return {-k_strength * x[0], -k_strength * x[1]};
                          },
                          [](const Vec2& x) { return k_strength * square(x) / 2; }};
constexpr System k_orbit{"orbit",
                         [](const Vec2& x) -> Vec2 {
                           const double cube = square(x) * std::sqrt(square(x));
                           return {-k_strength * x[0] / cube, -k_strength * x[1] / cube};
                         },
                         [](const Vec2& x) { return -k_strength / std::sqrt(square(x)); }};

struct Motion {
  Vec2 place{1, 0};
  Vec2 velocity{0, k_rate};
};

using Method = void (*)(const System& system, Motion& motion);

void explicit_euler(const System& system, Motion& m) {
  const Vec2 pull = system.pull(m.place);
  m.place = plus(m.place, m.velocity, k_step);
  m.velocity = plus(m.velocity, pull, k_step);
}

// v' = v + h·a(x + h·v'), by iteration: h²·|∂a/∂x| is small.
void implicit_euler(const System& system, Motion& m) {
  constexpr int k_rounds = 12;
  Vec2 velocity = m.velocity;
  for (int i = 0; i < k_rounds; ++i)
    velocity = plus(m.velocity, system.pull(plus(m.place, velocity, k_step)), k_step);
  m.velocity = velocity;
  m.place = plus(m.place, velocity, k_step);
}

void semi_implicit_euler(const System& system, Motion& m) {
  m.velocity = plus(m.velocity, system.pull(m.place), k_step);
  m.place = plus(m.place, m.velocity, k_step);
}

double energy(const System& system, const Motion& m) {
  return square(m.velocity) / 2 + system.potential(m.place);
}

struct Minutes {
  double first = 0, last = 0;  // the worst relative error of each
};

Minutes run(const System& system, Method method) {
  Motion motion;
  const double right = energy(system, motion);
  Minutes worst;
  const auto steps = static_cast<int>(std::lround(k_minute / k_step));
  for (int i = 0; i < k_minutes * steps; ++i) {
    method(system, motion);
    const double error = std::abs(energy(system, motion) / right - 1);
    if (i < steps) worst.first = std::max(worst.first, error);
    if (i >= (k_minutes - 1) * steps) worst.last = std::max(worst.last, error);
  }
  return worst;
}

}  // namespace

std::vector<AccuracyResult> measure_integrators(const AccuracyOptions&) {
  constexpr std::pair<const char*, Method> k_methods[] = {
      {"explicit Euler", explicit_euler},
      {"implicit Euler", implicit_euler},
      {"semi-implicit Euler", semi_implicit_euler}};
  // Of the last method alone it is held that the error does not grow.
  constexpr double k_growth = 1.01;
  std::vector<AccuracyResult> results;
  for (const System& system : {k_spring, k_orbit}) {
    for (const auto& [name, method] : k_methods) {
      const Minutes worst = run(system, method);
      const bool judged = method == semi_implicit_euler;
      AccuracyResult result{std::string(name) + ", " + system.name, "relative", 1, worst.last,
                            judged ? k_growth * worst.first : 0,    {}};
      result.note = "energy in the 10th minute; in the first " + std::to_string(worst.first);
      result.judged = judged;
      results.push_back(result);
    }
  }
  return results;
}

}  // namespace lockstone::bench
