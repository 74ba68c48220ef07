// What rows of stability share.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/bench/accuracy/joint_scene.h"
#include "tools/bench/stability/stability.h"

namespace lockstone::bench {

/// Visits the handles of all bodies that exist.
template <class Visit>
void for_bodies(const World& world, Visit&& visit) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (const BodyHandle body = world.body_at(i); !body.is_null()) visit(world.body(body));
}

template <class Quantity>
[[nodiscard]] double real_length(const Vec3<Quantity>& v) {
  return std::hypot(testing::to_double(v.x), testing::to_double(v.y), testing::to_double(v.z));
}

/// m/s, of the fastest centre.
[[nodiscard]] inline double greatest_speed(const World& world) {
  double most = 0;
  for_bodies(world,
             [&](const BodyView& body) { most = std::max(most, real_length(body.velocity)); });
  return most;
}

/// How far the worst quaternion's length is from 1.
[[nodiscard]] inline double worst_norm(const World& world) {
  double worst = 0;
  for_bodies(world, [&](const BodyView& body) {
    const Quat& q = body.orientation;
    const double length = std::hypot(std::hypot(testing::to_double(q.x), testing::to_double(q.y)),
                                     std::hypot(testing::to_double(q.z), testing::to_double(q.w)));
    worst = std::max(worst, std::abs(length - 1));
  });
  return worst;
}

/// Steps, and keeps the worst of a figure.
class Worst {
 public:
  explicit Worst(std::function<double(const World&)> measure) : measure_(std::move(measure)) {}
  void see(const World& world) { worst_ = std::max(worst_, measure_(world)); }
  [[nodiscard]] double value() const { return worst_; }

 private:
  std::function<double(const World&)> measure_;
  double worst_ = 0;
};

/// Runs a scene; `each` sees the world after every tick.
template <class Each>
void run_for(SceneRun& scene, double seconds, Each&& each) {
  for (auto left = std::llround(seconds * scene.setting().tick_rate); left > 0; --left) {
    scene.step();
    each(scene.world());
  }
}

[[nodiscard]] inline StabilityResult stability_of(SceneRun& scene,
                                                  std::vector<StabilityFigure> figures) {
  const AccuracyResult run = scene.result({}, {}, 0, 0);
  return {std::move(figures), scene.world().tick(), run.tick_seconds, run.hash};
}

}  // namespace lockstone::bench
