// Ball joints: every target against the scalar twin.
#include <cstddef>
#include <vector>

#include "core/kernels/ball/ball_block.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

constexpr std::int64_t k_one = std::int64_t{1} << 30;
constexpr std::int32_t k_rate = 240;

// The inputs and outputs of a tick.
struct Scene {
  std::vector<BodyInertia> inertias;
  std::vector<BodyPlace> places, later;
  std::vector<BodyVelocity> bodies, warm;
  std::vector<BallBlock> blocks;

  friend bool operator==(const Scene& a, const Scene& b) {
    return a.bodies == b.bodies && a.warm == b.warm && a.blocks == b.blocks;
  }
};

// Wild: any bits, where no format forbids them. Else such as a solver would make.
struct SceneMaker {
  Random& random;
  bool wild;

  std::int64_t operand_in(std::int64_t low, std::int64_t high) {
    return wild ? operand(random) : random.between(low, high);
  }
  std::int64_t both(std::int64_t low, std::int64_t high) {
    const std::int64_t first = operand_in(low, high);
    return scalar::pack(first, operand_in(low, high));
  }

  void fill(BodyVelocity& body) {
    constexpr std::int64_t k_bound = std::int64_t{1} << 52;
    for (std::int64_t& x : body.velocity)
      x = wild ? word(random) : random.between(-k_bound, k_bound);
    for (std::int64_t& x : body.spin)
      x = wild ? word(random) : random.between(-k_bound, k_bound);
  }

  // A turn about z by the angle of a 3-4-5 triangle.
  void fill(BodyPlace& place) {
    constexpr std::int64_t k_near = std::int64_t{1} << 33;
    for (std::size_t i = 0; i < 3; ++i)
      place.words[i] = wild ? word(random) : random.between(-k_near, k_near);
    const std::int64_t c = k_one / 5 * 3, s = k_one / 5 * 4;
    const std::int64_t turn[] = {scalar::pack(c, s), scalar::pack(0, -s), scalar::pack(c, 0), 0,
                                 k_one};
    for (std::size_t i = 0; i < 5; ++i)
      place.words[3 + i] = wild ? word(random) : turn[i];
  }

  void fill(BodyInertia& body) {
    for (std::size_t i = 0; i < 6; ++i)
      body.inertia[i] =
          static_cast<std::int32_t>(operand_in(i < 3 ? k_one / 2 : -k_one / 4, i < 3 ? k_one : 1));
  }

  // About all axes, as the bodies of a plain joint turn.
  void make_alike(BodyInertia& body) {
    const auto moment = static_cast<std::int32_t>(random.between(0, k_one));
    body.inertia = {moment, moment, moment, 0, 0, 0};
  }

  void fill(BallBlock& block, std::size_t lane) {
    for (BlockWord& word : block.anchor)
      word[lane] = both(-(1 << 20), 1 << 20);
    block.scale[lane] = scalar::pack(random.between(13, 31), random.between(13, 31));
    block.factor[lane] =
        scalar::pack(std::int64_t{1} << random.between(0, 12), 1 << random.between(0, 12));
    block.share[lane] = scalar::pack(random.between(0, k_one), random.between(16, 28));
    block.impulse[0][lane] = both(-k_most_impulse, k_most_impulse);
    block.impulse[1][lane] = operand_in(-k_most_impulse, k_most_impulse);
  }
};

// Bodies are named once but for body 0.
Scene make_scene(std::size_t blocks, bool wild, Random& random) {
  SceneMaker maker{random, wild};
  Scene scene;
  scene.blocks.resize(blocks);
  scene.bodies.resize(1 + 2 * k_block_lanes * blocks);
  scene.warm.resize(scene.bodies.size());
  scene.inertias.resize(scene.bodies.size());
  scene.places.resize(scene.bodies.size());
  scene.later.resize(scene.bodies.size());
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    maker.fill(scene.bodies[i]);
    maker.fill(scene.inertias[i]);
    maker.fill(scene.places[i]);
    maker.fill(scene.later[i]);
  }
  std::uint32_t next = 1;
  for (std::size_t i = 0; i < blocks * k_block_lanes; ++i, next += 2) {
    BallBlock& block = scene.blocks[i / k_block_lanes];
    const std::size_t lane = i % k_block_lanes;
    maker.fill(block, lane);
    block.body_a[lane] = body_velocity_offset(next);
    block.body_b[lane] = body_velocity_offset(next + 1);
    if (i / k_block_lanes % 2 == 0 && random.between(0, 7) != 0) {
      maker.make_alike(scene.inertias[next]);
      maker.make_alike(scene.inertias[next + 1]);
    } else {
      block.scale[lane] |= k_special_balls;
    }
  }
  return scene;
}

void run(const BallKernels& kernels, Scene& scene) {
  BallBlock* blocks = scene.blocks.data();
  const std::size_t count = scene.blocks.size();
  const BodyInertia* inertias = scene.inertias.data();
  kernels.begin(blocks, count, scene.places.data(), inertias, scene.warm.data(), k_rate);
  kernels.solve_positions(scene.bodies.data(), blocks, count);
  kernels.update(scene.bodies.data(), scene.warm.data(), blocks, count, scene.later.data(),
                 inertias, k_rate);
}

std::string compare(const Scene& start) {
  Scene expected = start;
  run(k_scalar_balls, expected);
  return on_each_target([&] {
    Scene scene = start;
    run(ball_kernels(k_block_lanes), scene);
    if (scene == expected) return std::string();
    return "balls in " + std::to_string(start.blocks.size()) + " blocks\n";
  });
}

}  // namespace

std::string check_balls(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 1000 && report.empty(); ++round) {
    const auto blocks = static_cast<std::size_t>(random.between(1, 4));
    report += compare(make_scene(blocks, round % 2 == 0, random));
  }
  return report;
}

}  // namespace lockstone::lanes::test
