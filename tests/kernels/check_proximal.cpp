// Small islands: every kernel of every target against the scalar twin, word by word.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/kernels/proximal/proximal_block.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/proximal_values.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

// The problem of an island, and the kernels' results.
struct Scene {
  std::vector<ProximalBlock> blocks;
  std::vector<BlockWord> bodies, sums;
  std::vector<BodyBlock> matrix;
  std::uint64_t bits = 0;
  PassResult result;
  Proposal proposal;
  bool fits = true;

  friend bool operator==(const Scene&, const Scene&) = default;
};

Scene make_scene(std::size_t contacts, bool wild, Random& random) {
  const ProblemMaker maker{random, wild};
  Scene scene;
  const std::size_t bodies = contacts + 1;
  scene.blocks.resize(contacts);
  scene.bodies.resize(bodies);
  scene.sums.resize(bodies);
  for (ProximalBlock& block : scene.blocks)
    maker.fill(block, bodies);
  for (std::size_t i = 0; i + 1 < bodies; ++i) {
    maker.fill_body(scene.bodies[i]);
    maker.fill_body(scene.sums[i]);
  }
  return scene;
}

struct Step {
  const char* name;
  std::function<void(const ProximalKernels&, Scene&)> run;
};

// Runs a step by the scalar twin, and from the same start by each target.
std::string compare(const Step& step, Scene& scene) {
  const Scene start = scene;
  step.run(k_scalar_proximal, scene);
  return on_each_target([&] {
    Scene other = start;
    step.run(proximal_kernels(), other);
    if (other == scene) return std::string();
    return std::string(step.name) + " of " + std::to_string(start.blocks.size()) + "\n";
  });
}

Step couple_step() {
  return {"couple", [](const ProximalKernels& kernels, Scene& scene) {
            for (ProximalBlock& block : scene.blocks)
              kernels.couple(block);
          }};
}

Step begin_step(int down) {
  return {"begin_phase", [down](const ProximalKernels& kernels, Scene& scene) {
            scene.bits = kernels.magnitudes(scene.blocks.data(), scene.blocks.size());
            kernels.begin_phase(scene.blocks.data(), scene.blocks.size(), down, down / 3);
          }};
}

Step pass_step() {
  return {"pass", [](const ProximalKernels& kernels, Scene& scene) {
            scene.result =
                kernels.pass(scene.blocks.data(), scene.blocks.size(), scene.bodies.data());
          }};
}

Step residuals_step() {
  return {"find_residuals", [](const ProximalKernels& kernels, Scene& scene) {
            scene.bits = kernels.find_residuals(scene.blocks.data(), scene.blocks.size(),
                                                scene.bodies.data());
          }};
}

Step right_sides_step(int drop) {
  return {"add_right_sides", [drop](const ProximalKernels& kernels, Scene& scene) {
            kernels.add_right_sides(scene.blocks.data(), scene.blocks.size(), drop,
                                    scene.sums.data());
          }};
}

Step propose_step(int drop, bool follows) {
  return {"propose", [drop, follows](const ProximalKernels& kernels, Scene& scene) {
            scene.proposal = kernels.propose(scene.blocks.data(), scene.blocks.size(), drop,
                                             follows, scene.bodies.data());
          }};
}

Step changes_step() {
  return {"add_changes", [](const ProximalKernels& kernels, Scene& scene) {
            scene.fits =
                kernels.add_changes(scene.blocks.data(), scene.blocks.size(), scene.sums.data());
          }};
}

Step update_step(int shift) {
  return {"update_residuals", [shift](const ProximalKernels& kernels, Scene& scene) {
            kernels.update_residuals(scene.blocks.data(), scene.blocks.size(), scene.bodies.data(),
                                     shift);
          }};
}

// The steps of a phase. A step that begins from the words of one before finds them as the twin left
// them; wild scenes also run each from words that no step has made.
std::string check_phase(const Scene& start, Random& random) {
  const int drop = static_cast<int>(random.between(1, 42));
  const Step steps[] = {couple_step(),
                        begin_step(static_cast<int>(random.between(1, 62))),
                        pass_step(),
                        residuals_step(),
                        right_sides_step(drop),
                        propose_step(drop, true),
                        propose_step(drop, false),
                        changes_step(),
                        update_step(static_cast<int>(random.between(-16, 62)))};
  std::string report;
  Scene scene = start;
  for (const Step& step : steps) {
    report += compare(step, scene);
    Scene alone = start;
    report += compare(step, alone);
  }
  return report;
}

// The matrix of a contact: blocks of both bodies, of one, or of none.
std::string check_matrix(const Scene& start, Random& random) {
  Scene scene = start;
  scene.matrix.resize(3);
  const std::uint64_t which = random.next();
  const Step step{"add_to_matrix", [which](const ProximalKernels& kernels, Scene& on) {
                    BodyBlock* blocks = on.matrix.data();
                    const bool a = which % 4 != 1, b = which % 4 != 2;
                    for (const ProximalBlock& block : on.blocks)
                      kernels.add_to_matrix(block,
                                            {a ? blocks : nullptr, b ? blocks + 1 : nullptr,
                                             a && b ? blocks + 2 : nullptr, (which >> 8) % 2 == 0});
                  }};
  return compare(step, scene);
}

// Rows of a joint, some of them in use. Words are any.
std::string check_rows(Random& random) {
  std::vector<BlockWord> rows(k_block_lanes + 4);
  std::vector<std::int64_t> errors(rows.size());
  for (BlockWord& row : rows)
    std::generate(row.begin(), row.end(), [&] { return word(random); });
  std::generate(errors.begin(), errors.end(), [&] { return operand(random); });
  const auto used = static_cast<std::uint32_t>(random.below(std::size_t{1} << rows.size()));
  const std::uint64_t which = random.next();
  Scene scene;
  scene.matrix.resize(3);
  scene.bodies.resize(2);
  scene.sums.resize(4);
  for (BlockWord& body : scene.bodies)
    std::generate(body.begin(), body.end(), [&] { return word(random); });
  const Step matrix{"add_rows", [&](const ProximalKernels& kernels, Scene& on) {
                      BodyBlock* blocks = on.matrix.data();
                      const bool a = which % 4 != 1, b = which % 4 != 2;
                      kernels.add_rows(rows.data(), used,
                                       {a ? blocks : nullptr, b ? blocks + 1 : nullptr,
                                        a && b ? blocks + 2 : nullptr, (which >> 8) % 2 == 0});
                    }};
  const Step sides{"subtract_rows", [&](const ProximalKernels& kernels, Scene& on) {
                     kernels.subtract_rows(rows.data(), used, errors.data(), on.sums[0],
                                           on.sums[1]);
                   }};
  const Step products{"row_products", [&](const ProximalKernels& kernels, Scene& on) {
                        kernels.row_products(rows.data(), used, on.bodies[0], on.bodies[1],
                                             on.sums[2].data());
                      }};
  return compare(matrix, scene) + compare(sides, scene) + compare(products, scene);
}

// A column of a factor. Blocks 0 … count − 1 are below the diagonal, the last is the diagonal, and
// between them are those that elimination changes.
struct ColumnCase {
  FactorColumn column;
  std::vector<BelowDiagonal> below;
  std::vector<std::uint32_t> targets;

  ColumnCase(std::uint32_t count, Random& random) {
    column.count = count;
    for (std::size_t i = 0; i < k_body_words; ++i) {
      column.mantissas[i] = operand(random);
      column.shifts[i] = static_cast<std::int32_t>(random.between(1, 62));
    }
    for (std::uint32_t i = 0; i < count; ++i)
      below.push_back({i + 1, i});
    for (std::uint32_t i = 0; i < count * (count + 1) / 2; ++i)
      targets.push_back(count + i);
  }

  [[nodiscard]] std::size_t blocks() const { return below.size() + targets.size() + 1; }
};

// Words of blocks are any: sums of products, or two entries of the factor.
std::string check_factor(std::uint32_t count, Random& random) {
  const ColumnCase of(count, random);
  Scene scene;
  scene.matrix.resize(of.blocks());
  scene.bodies.resize(count + 1);
  scene.sums.resize(1);
  for (BodyBlock& block : scene.matrix)
    for (BlockWord& words : block.words)
      std::generate(words.begin(), words.end(), [&] { return word(random); });
  for (BlockWord& words : scene.bodies)
    std::generate(words.begin(), words.end(),
                  [&] { return random.next() % 2 == 0 ? word(random) : operand(random); });
  const Step eliminate{"eliminate", [&of](const ProximalKernels& kernels, Scene& on) {
                         kernels.eliminate(on.matrix.data(), of.column, on.matrix.back(),
                                           of.below.data(), of.targets.data());
                       }};
  const Step down{"solve_down", [&of](const ProximalKernels& kernels, Scene& on) {
                    const BlockWord x = on.bodies[0];
                    on.fits = kernels.solve_down(on.matrix.data(), of.column, of.below.data(), x,
                                                 on.bodies.data());
                  }};
  const Step up{"solve_up", [&of](const ProximalKernels& kernels, Scene& on) {
                  kernels.solve_up(on.matrix.data(), of.column, of.below.data(), on.bodies.data(),
                                   on.sums[0]);
                }};
  return compare(eliminate, scene) + compare(down, scene) + compare(up, scene);
}

}  // namespace

std::string check_proximal(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 1500 && report.empty(); ++round) {
    const auto contacts = static_cast<std::size_t>(random.between(0, 9));
    const Scene start = make_scene(contacts, round % 2 == 0, random);
    report += check_phase(start, random) + check_matrix(start, random);
    report += check_rows(random);
    report += check_factor(static_cast<std::uint32_t>(random.between(0, 5)), random);
  }
  return report;
}

}  // namespace lockstone::lanes::test
