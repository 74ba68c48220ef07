#include "tools/bench/baselines/solvers/stepper.h"

#include <cmath>
#include <ctime>

namespace lockstone::bench::trial {
namespace {

double rounded(double x, int bits) {
  return std::ldexp(std::nearbyint(std::ldexp(x, bits)), -bits);
}

// Of this thread: other work on the machine does not count.
double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

void Stepper::round_poses(const Problem& problem) {
  if (options_.round_pose == 0) return;
  const int bits = options_.round_pose;
  for (const int index : problem.bodies) {
    Body& b = system_.bodies[index];
    const auto all = [&](Vec3& v) {
      v = {rounded(v.x, bits), rounded(v.y, bits), rounded(v.z, bits)};
    };
    all(b.position);
    all(b.velocity);
    all(b.spin);
    b.rotation = {rounded(b.rotation.w, bits), rounded(b.rotation.x, bits),
                  rounded(b.rotation.y, bits), rounded(b.rotation.z, bits)};
    update(b);
  }
}

void Stepper::solve(Problem& problem) {
  const double h = k_tick / options_.substeps;
  make_rows(system_, h, problem);
  const bool direct = options_.method == Method::proximal &&
                      static_cast<int>(problem.rows.size()) <= options_.largest_direct;
  if (options_.method == Method::descent) {
    Descent descent(system_, problem, options_, h);
    for (int i = 0; i < options_.substeps; ++i)
      descent.substep();
  } else if (direct) {
    BlockFactor& factor = factors_[problem.bodies] = std::move(last_factors_[problem.bodies]);
    Proximal proximal(system_, problem, factor, options_, h, counts_);
    for (int i = 0; i < options_.substeps; ++i) {
      proximal.substep();
      round_poses(problem);
    }
  } else {
    SoftSteps soft(system_, problem, options_, h);
    for (int i = 0; i < options_.substeps; ++i) {
      soft.substep();
      round_poses(problem);
    }
    soft.restitution();
  }
  store_impulses(system_, problem);
}

void Stepper::tick() {
  collide(system_);
  const double start = processor_seconds();
  last_factors_ = std::move(factors_);
  factors_.clear();
  std::vector<Problem> islands = make_islands(system_);
  for (Problem& island : islands)
    solve(island);
  seconds_ += processor_seconds() - start;
}

}  // namespace lockstone::bench::trial
