// Row 102: a stack on springs, as penalty methods have it, beside the same stack on constraints.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/bench/support/measure.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr int k_boxes = 20;
constexpr double k_mass = 1000;  // kg
constexpr double k_seconds = 60;
constexpr double k_lost = 1e3;  // m: a body this far away is lost

// Boxes of 1 m that move up and down alone; spring and damper where two overlap.
struct PenaltyStack {
  double stiffness = 0;  // N/m
  double damping = 0;    // N·s/m
  std::array<double, k_boxes> y{}, v{};

  [[nodiscard]] double force_below(std::size_t i) const {
    const double under = i == 0 ? -0.5 : y[i - 1], rate = i == 0 ? 0 : v[i - 1];
    const double depth = 1 - (y[i] - under), closing = rate - v[i];
    return depth > 0 ? std::max(stiffness * depth + damping * closing, 0.0) : 0;
  }

  // Semi-implicit Euler.
  void step(double h) {
    std::array<double, k_boxes + 1> force{};
    for (std::size_t i = 0; i < k_boxes; ++i)
      force[i] = force_below(i);
    for (std::size_t i = 0; i < k_boxes; ++i) {
      v[i] += h * ((force[i] - force[i + 1]) / k_mass - k_gravity);
      y[i] += h * v[i];
    }
  }
};

// `share` of m/h², above which a long chain of springs is unstable without damping.
AccuracyResult penalty(const Setting& setting, double share, const char* name) {
  const double h = 1.0 / (setting.tick_rate * setting.substeps);
  PenaltyStack stack;
  stack.stiffness = share * k_mass / (h * h);
  stack.damping = std::min(std::sqrt(stack.stiffness * k_mass), k_mass / (4 * h));
  for (std::size_t i = 0; i < k_boxes; ++i)
    stack.y[i] = 0.5 + static_cast<double>(i);
  const auto steps = std::lround(k_seconds / h);
  const std::uint64_t begin = thread_nanoseconds();
  for (long i = 0; i < steps; ++i)
    stack.step(h);
  const auto taken = static_cast<double>(thread_nanoseconds() - begin);
  const double lost = std::abs(stack.y.back() - (k_boxes - 0.5));
  AccuracyResult result{name, "m", 1, lost < k_lost ? lost : k_lost, 0, {}};
  result.setting = setting.name();
  result.judged = false;
  result.tick_seconds = taken * 1e-9 / (k_seconds * setting.tick_rate);
  if (!(lost < k_boxes / 2.0)) result.note = "fell or flew apart";
  return result;
}

AccuracyResult constraints(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  scene.add(ground());
  BodyHandle top;
  for (int i = 0; i < k_boxes; ++i)
    top = scene.add(body_at(unit_box(), 0, 0.5 + i, 0));
  scene.run(k_seconds);
  const double lost = std::abs(fuzz::real(scene.world().position(top).y) - (k_boxes - 0.5));
  return scene.result("constraints", "m", lost, 1e-3);
}

}  // namespace

std::vector<AccuracyResult> measure_penalty(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](const std::function<AccuracyResult(const Setting&)>& measure) {
    for (AccuracyResult& result : at_settings(options, measure))
      results.push_back(std::move(result));
  };
  add([](const Setting& setting) { return penalty(setting, 0.025, "springs, 1/40 of m/h2"); });
  add([](const Setting& setting) { return penalty(setting, 0.125, "springs, 1/8 of m/h2"); });
  add([](const Setting& setting) { return penalty(setting, 2, "springs, 2 m/h2"); });
  add(constraints);
  return results;
}

}  // namespace lockstone::bench
