// Row 25: volume, centre of mass and moments of hulls and compounds.
#include <cmath>
#include <mutex>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/solid.h"
#include "tools/bench/accuracy/accuracy.h"
#include "tools/bench/accuracy/reference_mass.h"
#include "tools/fuzz/dice.h"
#include "tools/fuzz/hull_pool.h"
#include "tools/support/for_blocks.h"

namespace lockstone::bench {
namespace {

using fuzz::Dice;

constexpr double k_goal = 1e-6;
constexpr double k_goal_metres = 1e-6;
constexpr double k_small = 0.05;  // m: of smaller solids the centre's rounding shows in the moments

struct Errors {
  std::uint64_t tries = 0;
  double volume = 0;         ///< relative
  double centre = 0;         ///< m, by axis
  double moments = 0;        ///< of the greatest
  double small_moments = 0;  ///< likewise, of bodies smaller than k_small

  void add(const Errors& other) {
    tries += other.tries;
    volume = std::max(volume, other.volume);
    centre = std::max(centre, other.centre);
    moments = std::max(moments, other.moments);
    small_moments = std::max(small_moments, other.small_moments);
  }
};

// From principal moments and axes, m².
Long33 second_moments(const geometry::Solid& solid) {
  const Mat3 axes = to_matrix(solid.axes);
  const fuzz::Real3 m = fuzz::real(solid.inertia);
  const std::array<Long, 3> moment{m.x, m.y, m.z};
  const Long s = std::ldexp(Long{1}, 2 * solid.scale_exponent);
  Long33 second{};
  for (int k = 0; k < 3; ++k) {
    const Long along =
        ((moment[0] + moment[1] + moment[2]) / 2 - moment[static_cast<std::size_t>(k)]) * s;
    const fuzz::Real3 a = fuzz::real(axes.column(k));
    const std::array<Long, 3> axis{a.x, a.y, a.z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        second[i][j] += along * axis[i] * axis[j];
  }
  return second;
}

Errors errors_of(const geometry::Solid& solid, const MassReference& truth) {
  Errors errors;
  errors.tries = 1;
  const Long volume = std::ldexp(static_cast<Long>(solid.volume.mantissa), solid.volume.exponent);
  errors.volume = static_cast<double>(std::abs(volume / truth.volume - 1));
  const fuzz::Real3 c = fuzz::real(solid.centre);
  const std::array<Long, 3> centre{c.x, c.y, c.z};
  const Long33 second = second_moments(solid);
  Long greatest = 0, worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    errors.centre =
        std::max(errors.centre, static_cast<double>(std::abs(centre[i] - truth.centre[i])));
    greatest = std::max(greatest, truth.second[i][i]);
    for (std::size_t j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(second[i][j] - truth.second[i][j]));
  }
  const bool is_small = fuzz::real(solid.radius) < k_small;
  (is_small ? errors.small_moments : errors.moments) = static_cast<double>(worst / greatest);
  return errors;
}

CompoundChild random_child(Dice& dice, fuzz::HullPool& pool) {
  CompoundChild child;
  const auto size = [&] { return dice.size(0.01, 5); };
  const Length x = size(), y = size(), z = size();
  switch (dice.between(0, 3)) {
    case 0:
      child.shape = Shape::sphere(x);
      break;
    case 1:
      child.shape = Shape::capsule(y, x);
      break;
    case 2:
      child.shape = Shape::box(x, y, z);
      break;
    default:
      child.asset = pool.at(static_cast<std::uint64_t>(dice.between(0, 255)));
      child.shape = child.asset->shape();
  }
  child.position = fuzz::to_length(dice.in_cube(5));
  child.orientation = dice.orientation();
  child.density = Number::from_raw(static_cast<std::int32_t>(dice.between(1 << 14, 1 << 26)));
  return child;
}

Errors compound_errors(Dice& dice, fuzz::HullPool& pool) {
  std::vector<CompoundChild> children;
  for (std::int64_t count = dice.between(1, 8); count > 0; --count)
    children.push_back(random_child(dice, pool));
  const CompoundResult result = Compound::build(children);
  if (!result.ok()) return {};
  return errors_of(*result.compound->geometry().solid(),
                   mass_of_compound(result.compound->children()));
}

void add_results(const char* of, const Errors& errors, std::vector<AccuracyResult>& results) {
  const std::string name(of);
  results.push_back({name + ", volume", "relative", errors.tries, errors.volume, k_goal, {}});
  results.push_back({name + ", centre", "m", errors.tries, errors.centre, k_goal_metres, {}});
  results.push_back({name + ", moments", "relative", errors.tries, errors.moments, k_goal, {}});
  results.push_back(
      {name + " below 5 cm", "relative", errors.tries, errors.small_moments, k_goal, {}});
}

}  // namespace

std::vector<AccuracyResult> measure_masses(const AccuracyOptions& options) {
  fuzz::HullPool pool(options.seed);
  std::mutex mutex;
  Errors hulls, compounds;
  tool::for_blocks(
      options.tries, 16, options.threads, [&](std::uint64_t first, std::uint64_t count) {
        Errors hull_part, compound_part;
        for (std::uint64_t i = options.first + first; i < options.first + first + count; ++i) {
          Dice dice(options.seed, i);
          const auto hull = fuzz::random_hull(dice);
          hull_part.add(errors_of(*hull->geometry().solid(), mass_of_hull(hull->vertices())));
          compound_part.add(compound_errors(dice, pool));
        }
        const std::lock_guard lock(mutex);
        hulls.add(hull_part);
        compounds.add(compound_part);
      });
  std::vector<AccuracyResult> results;
  add_results("hulls", hulls, results);
  add_results("compounds", compounds, results);
  return results;
}

}  // namespace lockstone::bench
