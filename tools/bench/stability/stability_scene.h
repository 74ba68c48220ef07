// Helpers for rows of stability.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/bench/accuracy/joint_scene.h"
#include "tools/bench/stability/stability.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {

/// Visits the handles of all bodies that exist.
template <class Visit>
void for_bodies(const World& world, Visit&& visit) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (const BodyHandle body = world.body_at(i); !body.is_null()) visit(world.body(body));
}

/// m/s, of the fastest centre.
[[nodiscard]] inline double greatest_speed(const World& world) {
  double most = 0;
  for_bodies(world, [&](const BodyView& body) {
    most = std::max(most, fuzz::norm(fuzz::real(body.velocity)));
  });
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

/// m, how far the lowest dynamic body's centre is below the origin's height; at least 0.
[[nodiscard]] inline double greatest_depth(const World& world) {
  double depth = 0;
  for_bodies(world, [&](const BodyView& body) {
    if (body.motion == MotionType::dynamic)
      depth = std::max(depth, -testing::to_double(body.position.y));
  });
  return depth;
}

/// Sixty balls, boxes and capsules between four walls, and a paddle that turns among them.
void fill_stirred_pit(SceneRun& scene);

/// Runs a scene: the worst of each measure, which sees the world after every tick.
template <class... Measures>
[[nodiscard]] std::array<double, sizeof...(Measures)> worst_of(SceneRun& scene, double seconds,
                                                               const Measures&... measures) {
  std::array<double, sizeof...(Measures)> worst{};
  for (auto left = std::llround(seconds * scene.setting().tick_rate); left > 0; --left) {
    scene.step();
    std::size_t i = 0;
    ((worst[i] = std::max(worst[i], measures(scene.world())), ++i), ...);
  }
  return worst;
}

[[nodiscard]] inline StabilityResult stability_of(SceneRun& scene,
                                                  std::vector<StabilityFigure> figures) {
  const AccuracyResult run = scene.result({}, {}, 0, 0);
  return {std::move(figures), scene.world().tick(), run.tick_seconds, run.hash};
}

}  // namespace lockstone::bench
