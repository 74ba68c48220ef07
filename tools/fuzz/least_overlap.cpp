#include "tools/fuzz/least_overlap.h"

#include <algorithm>
#include <numbers>
#include <vector>

namespace lockstone::fuzz {
namespace {

constexpr int k_spread = 96;
constexpr std::size_t k_descents = 6;
constexpr double k_same_valley = 0.02;  // rad

struct Trial {
  Real3 direction;
  double overlap = 0;
};

class Descent {
 public:
  explicit Descent(const Pair& pair) : pair_(pair), offset_(real(pair.offset)) {}

  [[nodiscard]] Trial at(const Real3& direction) const {
    const Real3 n = direction_of(direction);
    return {n, -separation(pair_, offset_, n)};
  }

  /// Six directions around the best one, turned from round to round so that no kink of the overlap
  /// stays between them; half the step when none is better.
  [[nodiscard]] double from(Trial best) const {
    double turn = 0;
    for (double step = 0.1; step > 1e-8;) {
      const Trial better = best_around(best, step, turn += 0.7);
      const bool falls = better.overlap < best.overlap;
      if (falls) best = better;
      step *= falls ? 1.3 : 0.5;
      step = std::min(step, 0.3);
    }
    return best.overlap;
  }

 private:
  [[nodiscard]] Trial best_around(const Trial& middle, double step, double turn) const {
    const Real3& n = middle.direction;
    const Real3 u = direction_of(cross(n, std::abs(n.x) < 0.6 ? Real3{1, 0, 0} : Real3{0, 1, 0}));
    const Real3 v = cross(n, u);
    Trial best = middle;
    for (int i = 0; i < 6; ++i) {
      const double angle = turn + i * std::numbers::pi / 3;
      const Trial trial = at(n + (u * std::cos(angle) + v * std::sin(angle)) * step);
      if (trial.overlap < best.overlap) best = trial;
    }
    return best;
  }

  const Pair& pair_;
  Real3 offset_;
};

void add_axes(const Pair& pair, std::vector<Real3>& seeds) {
  for (int i = 0; i < 3; ++i) {
    const Real3 of_a = real(pair.a.rotation.column(i)), of_b = real(pair.b.rotation.column(i));
    seeds.insert(seeds.end(), {of_a, -of_a, of_b, -of_b});
    for (int k = 0; k < 3; ++k) {
      const Real3 across = cross(of_a, real(pair.b.rotation.column(k)));
      if (norm(across) > 1e-9) seeds.insert(seeds.end(), {across, -across});
    }
  }
}

void add_spread(std::vector<Real3>& seeds) {
  for (int i = 0; i < k_spread; ++i) {
    const double y = 1 - (2 * i + 1.0) / k_spread,
                 angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double flat = std::sqrt(1 - y * y);
    seeds.push_back({flat * std::cos(angle), y, flat * std::sin(angle)});
  }
}

}  // namespace

double least_overlap(const Pair& pair, std::span<const Real3> seeds) {
  std::vector<Real3> directions(seeds.begin(), seeds.end());
  add_axes(pair, directions);
  add_spread(directions);
  const Descent descent(pair);
  std::vector<Trial> trials;
  for (const Real3& d : directions)
    if (norm(d) > 0.5e-9) trials.push_back(descent.at(d));
  std::ranges::stable_sort(trials, {}, &Trial::overlap);
  std::vector<Trial> valleys;
  for (const Trial& trial : trials) {
    if (valleys.size() == k_descents) break;
    const auto is_near = [&](const Trial& other) {
      return norm(other.direction - trial.direction) < k_same_valley;
    };
    if (std::ranges::none_of(valleys, is_near)) valleys.push_back(trial);
  }
  double least = trials.front().overlap;
  for (const Trial& valley : valleys)
    least = std::min(least, descent.from(valley));
  return least;
}

}  // namespace lockstone::fuzz
