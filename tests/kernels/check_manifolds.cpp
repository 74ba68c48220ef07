// Iterations over manifolds: every target against the scalar twin.
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/kernels/contact/manifold_block.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

constexpr std::int32_t k_one = 1 << 30;

// The inputs and outputs of a tick.
struct Scene {
  std::vector<ManifoldGeometry> geometry;
  std::vector<PrepareInputs> sources;  // they point into the geometry, of the first copy
  std::vector<BodyInertia> inertias;
  std::vector<BlockWord> restitution;
  std::vector<BodyVelocity> bodies, warm;
  std::vector<DeltaPose> travel;
  std::vector<ManifoldBlock> blocks;
  std::vector<ManifoldApproach> approaches;

  friend bool operator==(const Scene& a, const Scene& b) {
    return a.bodies == b.bodies && a.warm == b.warm && a.blocks == b.blocks &&
           a.approaches == b.approaches;
  }
};

// Wild: any bits, where no format forbids them. Else such as a solver would make.
struct SceneMaker {
  Random& random;
  bool wild;

  std::int64_t pick(std::int64_t low, std::int64_t high) {
    return wild ? operand(random) : random.between(low, high);
  }
  std::int64_t velocity() { return wild ? word(random) : random.between(-(1LL << 52), 1LL << 52); }
  std::int64_t travel() { return wild ? word(random) : random.between(-(1LL << 38), 1LL << 38); }

  void fill(BodyVelocity& body) {
    for (std::int64_t& x : body.velocity)
      x = velocity();
    for (std::int64_t& x : body.spin)
      x = velocity();
  }
  void fill(DeltaPose& body) {
    for (std::int64_t& x : body.velocity)
      x = travel();
    for (std::int64_t& x : body.surface)
      x = travel();
  }

  std::int32_t small(std::int64_t low, std::int64_t high) {
    return static_cast<std::int32_t>(pick(low, high));
  }
  std::int32_t fixed(std::int64_t low, std::int64_t high) {
    return static_cast<std::int32_t>(random.between(low, high));
  }

  // Of bodies named by plain manifolds M is a number.
  void fill(BodyInertia& body, bool plain) {
    for (std::size_t i = 0; i < 6; ++i)
      body.inertia[i] = small(i < 3 ? 1 : -k_one / 4, k_one);
    if (plain) body.inertia = {body.inertia[0], body.inertia[0], body.inertia[0], 0, 0, 0};
  }

  void fill_normal(ManifoldGeometry& in) {
    constexpr std::int32_t k_units[][3] = {{k_one, 0, 0},
                                           {0, -k_one, 0},
                                           {0, 0, k_one},
                                           {k_one / 5 * 3, 0, -(k_one / 5 * 4)},
                                           {-(k_one / 3), k_one / 3 * 2, k_one / 3 * 2}};
    const std::int32_t* unit = k_units[random.next() % 5];
    for (std::size_t i = 0; i < 3; ++i)
      in[i] = wild ? operand(random) : unit[i];
  }

  // Unread fields hold arbitrary bits.
  void fill_points(ManifoldGeometry& geometry, PrepareInput& in) {
    in.count = fixed(1, 4);
    in.one_over_count = k_one / in.count;
    geometry[3] = operand(random);
    for (std::size_t i = 0; i < k_block_points; ++i) {
      std::int32_t* point = &geometry[4 + 8 * i];
      for (std::size_t anchor = 0; anchor < 6; ++anchor)
        point[anchor] = small(-(1 << 20), 1 << 20);
      point[6] = small(-(1 << 18), 1 << 18);
      point[7] = operand(random);
      if (i < static_cast<std::size_t>(in.count))
        in.impulses[i] = fixed(0, wild ? k_most_impulse : 1 << 18);
    }
  }

  // Features that few contacts have: rolling resistance, moving surfaces, axis locks.
  void fill_extras(PrepareInput& in, bool fixed_a) {
    if (random.next() % 2 == 0) {
      in.rolling_limit = fixed(1, k_one / 2);
      for (std::int32_t& x : in.rolling)
        x = small(-(1 << 18), 1 << 18);
    }
    if (random.next() % 2 == 0) {
      for (std::int32_t& x : in.drive)
        x = small(-(1 << 22), 1 << 22);
      in.twist_drive = small(-(1 << 22), 1 << 22);
    }
    if (random.next() % 4 != 0) return;
    in.locked[random.next() % 3] = fixed_a ? k_one : fixed(0, k_one);
  }

  void fill(ManifoldGeometry& geometry, PrepareInput& in, bool plain) {
    fill_normal(geometry);
    fill_points(geometry, in);
    const bool fixed_a = random.next() % 4 == 0;
    in.share_b = fixed_a ? k_one : fixed(0, k_one);
    in.coefficient = small(0, k_one);
    in.scale_a = fixed_a ? 0 : k_one >> random.between(0, 5);
    in.scale_b = k_one >> random.between(0, 5);
    in.bias_rate = fixed(0, 1 << 25);
    in.keep = fixed(k_one / 2, k_one);
    in.mean_impulse = fixed(0, 1 << 18);
    in.inertia_a = 1 << random.between(0, 12);
    in.inertia_b = 1 << random.between(0, 12);
    in.inverse_scale_a = fixed_a ? 0 : 1 << random.between(0, 18);
    in.inverse_scale_b = 1 << random.between(0, 18);
    in.offset_shift = fixed(13, 31);
    in.shift = fixed(16, 28);
    for (std::int32_t& x : in.friction)
      x = small(-(1 << 18), 1 << 18);
    in.twist = small(-(1 << 18), 1 << 18);
    in.kind = plain ? 0 : k_special_lane;
    if (!plain) fill_extras(in, fixed_a);
  }
};

constexpr ManifoldGeometry k_no_geometry{};

static_assert(offsetof(ManifoldBlock, axes) == sizeof(BlockWord) &&
              sizeof(ManifoldBlock) % sizeof(BlockWord) == 0);

// Of points beyond a manifold's count blocks tell impulses and masses.
void forget_points(const PrepareInput& source, std::size_t lane, ManifoldBlock& block,
                   ManifoldApproach& approach) {
  if (source.count == 1) block.coupling[1][lane] = block.coupling[2][lane] = 0;
  for (auto i = static_cast<std::size_t>(source.count); i < k_block_points; ++i) {
    block.points[i].offset[lane] = block.points[i].separation[lane] = approach.speed[i][lane] = 0;
    if (i == 1) block.response_01_23[lane] &= ~std::int64_t{0xffffffff};
    if (i == 2) block.response_02_13[lane] &= ~std::int64_t{0xffffffff};
    if (i == 2) block.response_03_12[lane] &= 0xffffffff;
    if (i == 3) block.response_01_23[lane] &= 0xffffffff;
    if (i == 3) block.response_02_13[lane] &= 0xffffffff;
    if (i == 3) block.response_03_12[lane] &= ~std::int64_t{0xffffffff};
  }
}

// Of lanes without a manifold blocks say nothing, of plain ones not all.
void forget_empty(const PrepareInputs& sources, ManifoldBlock& block, ManifoldApproach& approach) {
  for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
    const PrepareInput& source = sources.lanes[lane];
    const bool is_empty = source.count == 0;
    forget_points(source, lane, block, approach);
    const std::size_t first = is_empty ? sizeof(BlockWord) : offsetof(ManifoldBlock, inertia);
    const std::int64_t none = 0;
    auto* const bytes = reinterpret_cast<unsigned char*>(&block);
    for (std::size_t at = first; at < sizeof(block); at += sizeof(BlockWord))
      if (source.kind == 0) std::memcpy(bytes + at + lane * sizeof(none), &none, sizeof(none));
    for (BlockWord& word : approach.speed)
      if (source.is_elastic == 0) word[lane] = 0;
    if (is_empty) approach.summary[lane] = 0;
  }
}

// Of a block all manifolds, some or none.
std::vector<bool> choose(std::size_t blocks, Random& random) {
  std::vector<bool> chosen;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::uint64_t how = random.next() % 3;
    for (std::size_t lane = 0; lane < k_block_lanes; ++lane)
      chosen.push_back(how == 0 || (how == 1 && random.next() % 2 == 0));
  }
  return chosen;
}

// Bodies are named once but for body 0.
Scene make_scene(std::size_t blocks, bool wild, Random& random) {
  SceneMaker maker{random, wild};
  Scene scene;
  scene.geometry.resize(blocks * k_block_lanes);
  scene.sources.resize(blocks);
  scene.restitution.resize(blocks);
  scene.blocks.resize(blocks);
  scene.approaches.resize(blocks);
  scene.bodies.resize(1 + 2 * k_block_lanes * blocks);
  scene.warm.resize(scene.bodies.size());
  scene.inertias.resize(scene.bodies.size());
  scene.travel.resize(scene.bodies.size());
  const std::vector<bool> plain = choose(blocks, random), elastic = choose(blocks, random);
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    maker.fill(scene.bodies[i]);
    maker.fill(scene.inertias[i], plain[(i - 1) / 2]);
    maker.fill(scene.travel[i]);
  }
  std::uint32_t next = 1;
  const auto used = static_cast<std::size_t>(
      random.between(1, static_cast<std::int64_t>(blocks * k_block_lanes)));
  for (std::size_t i = 0; i < blocks * k_block_lanes; ++i, next += 2) {
    PrepareInputs& sources = scene.sources[i / k_block_lanes];
    const std::size_t lane = i % k_block_lanes;
    if (i >= used) {  // as the solver leaves lanes without a contact
      sources.geometry[lane] = k_no_geometry.data();
      continue;
    }
    maker.fill(scene.geometry[i], sources.lanes[lane], plain[i]);
    sources.geometry[lane] = scene.geometry[i].data();
    sources.body_a[lane] = sources.lanes[lane].scale_a == 0 ? 0 : body_velocity_offset(next);
    sources.body_b[lane] = body_velocity_offset(next + 1);
    sources.lanes[lane].is_elastic = elastic[i] ? 1 : 0;
    scene.restitution[i / k_block_lanes][lane] = elastic[i] ? k_one / 2 : 0;
  }
  return scene;
}

void run(const ManifoldKernels& kernels, const SolverParams& rules, Scene& scene) {
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    kernels.prepare(scene.sources[i], scene.inertias.data(), scene.bodies.data(), scene.warm.data(),
                    scene.blocks[i], scene.approaches[i]);
  }
  const std::size_t count = scene.blocks.size();
  kernels.solve(scene.bodies.data(), scene.blocks.data(), count, rules);
  kernels.relax(scene.bodies.data(), scene.travel.data(), scene.blocks.data(), count, rules);
  kernels.solve(scene.bodies.data(), scene.blocks.data(), count, rules);
  for (std::size_t i = 0; i < count; ++i) {
    kernels.bounce(scene.bodies.data(), scene.blocks[i], scene.approaches[i], scene.restitution[i],
                   1 << 20);
    forget_empty(scene.sources[i], scene.blocks[i], scene.approaches[i]);
  }
}

// Whether separations that are moved one by one are those that `relax` leaves.
bool moves_separations_alike(const Scene& start, const SolverParams& rules) {
  Scene all = start;
  const ManifoldKernels& kernels = k_scalar_manifolds;
  for (std::size_t i = 0; i < all.blocks.size(); ++i)
    kernels.prepare(all.sources[i], all.inertias.data(), all.bodies.data(), all.warm.data(),
                    all.blocks[i], all.approaches[i]);
  Scene each = all;
  kernels.relax(all.bodies.data(), all.travel.data(), all.blocks.data(), all.blocks.size(), rules);
  for (std::size_t i = 0; i < each.blocks.size(); ++i) {
    for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
      if (each.blocks[i].used[lane] == 0) continue;
      move_separations(each.travel.data(), each.blocks[i], lane, rules);
      for (std::size_t point = 0; point < k_block_points; ++point)
        if (each.blocks[i].points[point].separation[lane] !=
            all.blocks[i].points[point].separation[lane])
          return false;
    }
  }
  return true;
}

std::string compare(const Scene& start, const SolverParams& rules) {
  Scene expected = start;
  run(k_scalar_manifolds, rules, expected);
  return on_each_target([&] {
    Scene scene = start;
    run(manifold_kernels(k_block_lanes), rules, scene);
    if (scene == expected) return std::string();
    return "manifolds in " + std::to_string(start.blocks.size()) + " blocks\n";
  });
}

}  // namespace

std::string check_manifolds(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 1500 && report.empty(); ++round) {
    const auto blocks = static_cast<std::size_t>(random.between(1, 4));
    const auto limit_dither = static_cast<std::int32_t>(random.between(-(1 << 29), (1 << 29) - 1));
    const auto part_dither = static_cast<std::int32_t>(random.between(-(1 << 29), (1 << 29) - 1));
    const SolverParams rules{240, 3 << 20, 4194, 336, 1145324612, 31, limit_dither, part_dither};
    const Scene scene = make_scene(blocks, round % 2 == 0, random);
    report += compare(scene, rules);
    if (!moves_separations_alike(scene, rules)) report += "separations of single manifolds\n";
  }
  return report;
}

}  // namespace lockstone::lanes::test
