// Rows 4 to 6 and 26 to 28: rotation without torque.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <lockstone/hull.h>
#include <lockstone/literals.h>

#include "tools/bench/accuracy/reference_rotation.h"
#include "tools/bench/accuracy/scene_run.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr int k_reference_rate = 6000;  // steps a second

WorldDef weightless() {
  WorldDef def;
  def.body_capacity = 4;
  def.pair_capacity = def.contact_capacity = 16;
  def.gravity = {};
  return def;
}

Long degrees(Long radians) {
  return radians * 180 / std::numbers::pi_v<Long>;
}

LongQuat real(const Quat& q) {
  const LongQuat r{fuzz::real(q.x), fuzz::real(q.y), fuzz::real(q.z), fuzz::real(q.w)};
  const Long norm = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  return {r.x / norm, r.y / norm, r.z / norm, r.w / norm};
}

Long3 real(const Vec3<AngularVelocity>& w) {
  return {fuzz::real(w.x), fuzz::real(w.y), fuzz::real(w.z)};
}

/// A box, up to a common factor of its moments.
struct Spinner {
  Shape shape;
  Vec3<AngularVelocity> angular_velocity;

  [[nodiscard]] Long3 moments() const {
    const Long x = fuzz::real(shape.size.x), y = fuzz::real(shape.size.y),
               z = fuzz::real(shape.size.z);
    return {y * y + z * z, z * z + x * x, x * x + y * y};
  }
  [[nodiscard]] FreeBody body() const {
    FreeBody body{moments(), real(angular_velocity)};
    for (std::size_t i = 0; i < 3; ++i)
      body.momentum[i] *= body.moments[i];
    return body;
  }
};

// 1 × 2 × 3 m.
constexpr Spinner k_box{Shape::box(0.5_m, 1_m, 1.5_m), {0.01_rps, 5_rps, {}}};

// The body as its view shows it: L from ω and orientation.
FreeBody seen(const Spinner& spinner, const BodyView& view) {
  const LongQuat q = real(view.orientation);
  Long3 w = rotate(conjugate(q), real(view.angular_velocity));
  const Long3 moments = spinner.moments();
  for (std::size_t i = 0; i < 3; ++i)
    w[i] *= moments[i];
  return {moments, rotate(q, w)};
}

class FreeRun {
 public:
  FreeRun(const Spinner& spinner, const Setting& setting)
      : scene_(setting, weightless()), body_(scene_.add(body_def(spinner))) {}

  [[nodiscard]] SceneRun& scene() { return scene_; }
  [[nodiscard]] BodyView view() { return scene_.world().body(body_); }

 private:
  static BodyDef body_def(const Spinner& spinner) {
    BodyDef def;
    def.shape = spinner.shape;
    def.angular_velocity = spinner.angular_velocity;
    return def;
  }

  SceneRun scene_;
  BodyHandle body_;
};

// The worst relative error over a run.
double energy_error(const Spinner& spinner, FreeRun& run, double seconds) {
  const FreeBody start = spinner.body();
  const Long right = energy(start, {});
  Long worst = 0;
  for (auto left = std::llround(seconds * run.scene().setting().tick_rate); left > 0; --left) {
    run.scene().step();
    const BodyView view = run.view();
    const Long now = energy(seen(spinner, view), real(view.orientation));
    worst = std::max(worst, std::abs(now / right - 1));
  }
  return static_cast<double>(worst);
}

struct MomentumError {
  double size = 0;
  double direction = 0;
};

MomentumError momentum_error(const Spinner& spinner, FreeRun& run, double seconds) {
  const Long3 right = spinner.body().momentum;
  const Long size = std::sqrt(dot(right, right));
  MomentumError worst;
  for (auto left = std::llround(seconds * run.scene().setting().tick_rate); left > 0; --left) {
    run.scene().step();
    const Long3 now = seen(spinner, run.view()).momentum;
    const Long now_size = std::sqrt(dot(now, now));
    Long across = 0;
    for (std::size_t i = 0; i < 3; ++i)
      across = std::hypot(across, now[i] / now_size - right[i] / size);
    worst.size = std::max(worst.size, static_cast<double>(std::abs(now_size / size - 1)));
    worst.direction = std::max(worst.direction, static_cast<double>(across));
  }
  return worst;
}

// The worst relative error of the first flips, each a change of sign of L's component along y.
double flip_error(const Spinner& spinner, FreeRun& run, int flips) {
  const FreeBody start = spinner.body();
  const auto [x, y, z] = start.moments;
  const FlipTimes right =
      flip_times({z, y, x}, dot(start.momentum, start.momentum), 2 * energy(start, {}));
  const auto along_y = [&] {
    const BodyView view = run.view();
    return rotate(conjugate(real(view.orientation)), start.momentum)[1];
  };
  double worst = 0;
  Long before = along_y();
  const Long tick = Long{1} / run.scene().setting().tick_rate;
  for (int ticks = 0, seen_flips = 0; seen_flips < flips && ticks < 1'000'000; ++ticks) {
    run.scene().step();
    const Long now = along_y();
    if ((now < 0) != (before < 0)) {
      const Long time = (ticks + before / (before - now)) * tick;
      const Long expected = right.first + right.interval * seen_flips;
      worst = std::max(worst, static_cast<double>(std::abs(time / expected - 1)));
      ++seen_flips;
    }
    before = now;
  }
  return worst;
}

// In degrees, at the end.
double orientation_error(const Spinner& spinner, FreeRun& run, int seconds) {
  const FreeBody body = spinner.body();
  run.scene().run(seconds);
  const LongQuat right = turn_freely(body, {}, seconds, seconds * k_reference_rate);
  return static_cast<double>(degrees(angle_between(right, real(run.view().orientation))));
}

std::vector<AccuracyResult> orientation_and_energy(const Spinner& spinner, int seconds,
                                                   double energy_goal) {
  std::vector<AccuracyResult> results = over_tick_rates([&](const Setting& setting) {
    FreeRun run(spinner, setting);
    const double error = orientation_error(spinner, run, seconds);
    return run.scene().result("orientation", "degrees", error, 0.01);
  });
  for (const AccuracyResult& result : over_tick_rates([&](const Setting& setting) {
         FreeRun run(spinner, setting);
         const double error = energy_error(spinner, run, seconds);
         return run.scene().result("energy", "relative", error, energy_goal);
       }))
    results.push_back(result);
  return results;
}

std::shared_ptr<const Hull> cylinder() {
  constexpr int k_sides = 16;
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < k_sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / k_sides;
    for (const double y : {-0.5, 0.5})
      points.push_back(fuzz::to_length({0.3 * std::cos(angle), y, 0.3 * std::sin(angle)}));
  }
  return Hull::build(points).hull;
}

}  // namespace

std::vector<AccuracyResult> measure_box_energy(const AccuracyOptions&) {
  std::vector<AccuracyResult> results = over_tick_rates([](const Setting& setting) {
    FreeRun run(k_box, setting);
    const double error = energy_error(k_box, run, 60);
    return run.scene().result("first minute", "relative", error, 1e-5);
  });
  FreeRun run(k_box, k_usual_setting);
  run.scene().run(3540);
  const double late = energy_error(k_box, run, 60);
  results.push_back(run.scene().result("60th minute", "relative", late, 1e-5));
  return results;
}

std::vector<AccuracyResult> measure_box_momentum(const AccuracyOptions&) {
  FreeRun run(k_box, k_usual_setting);
  const MomentumError error = momentum_error(k_box, run, 60);
  return {run.scene().result("size", "relative", error.size, 1e-7),
          run.scene().result("direction", "rad", error.direction, 1e-7)};
}

std::vector<AccuracyResult> measure_box_flips(const AccuracyOptions&) {
  return over_tick_rates([](const Setting& setting) {
    FreeRun run(k_box, setting);
    const double error = flip_error(k_box, run, 8);
    return run.scene().result("8 flips", "relative", error, 1e-3);
  });
}

std::vector<AccuracyResult> measure_cylinder(const AccuracyOptions&) {
  constexpr int k_seconds = 60;
  const auto hull = cylinder();
  const auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{hull});
  return over_substeps([&](const Setting& setting) {
    SceneRun scene(setting, weightless(), assets);
    BodyDef def;
    def.shape = hull->shape();
    def.angular_velocity.y = 100_rps;
    const BodyHandle body = scene.add(def);
    scene.run(k_seconds);
    const LongQuat right = exponential({0, Long{100} * k_seconds, 0});
    const Long error = angle_between(right, real(scene.world().body(body).orientation));
    return scene.result("angle", "degrees", static_cast<double>(degrees(error)), 0.05);
  });
}

// I = (1, 2, 3): the thinnest plate of √2 × 1.
std::vector<AccuracyResult> measure_dzhanibekov(const AccuracyOptions&) {
  const Spinner spinner{Shape::box(1.41421356_m, 1_m, 0.001_m), {0.01_rps, 10_rps, 0.01_rps}};
  return orientation_and_energy(spinner, 2, 3e-5);
}

// I = (.1, 2, 2.05).
std::vector<AccuracyResult> measure_rod(const AccuracyOptions&) {
  const Spinner spinner{Shape::box(1.40534694_m, 0.27386128_m, 0.15811388_m),
                        {8_rps, 1_rps, 0.5_rps}};
  return orientation_and_energy(spinner, 10, 1e-5);
}

}  // namespace lockstone::bench
