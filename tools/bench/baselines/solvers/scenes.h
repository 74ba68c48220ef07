// Families of scenes: generators with a seed.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/baselines/solvers/system.h"

namespace lockstone::bench::trial {

struct Scene {
  System system;
  double seconds = 10;
  bool stands = true;  // nothing should move
  bool powered = false;
  int motor = -1;  // joint whose speed is measured
};

// Uniform numbers, the same everywhere.
class Random {
 public:
  explicit Random(int seed) : state_(0x9e3779b97f4a7c15ull * (2 * seed + 1)) {}
  double operator()(double low, double high);

 private:
  unsigned long long state_;
};

struct Family {
  const char* name;
  void (*make)(Scene& scene, Random& random, double size);
  std::vector<double> sizes;
};

const std::vector<Family>& contact_families();
const std::vector<Family>& joint_families();
const std::vector<Family>& mixed_families();

}  // namespace lockstone::bench::trial
