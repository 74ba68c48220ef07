#include "tools/fuzz/hull_pool.h"

#include <numbers>

#include "tools/fuzz/dice.h"

namespace lockstone::fuzz {
namespace {

using Cloud = std::vector<Real3>;

Cloud scattered(Dice& dice, const Real3& half) {
  Cloud cloud;
  const bool round = dice.chance(2);
  for (std::int64_t count = dice.between(4, 40); count > 0; --count) {
    const Real3 p = round ? dice.direction() : dice.in_cube(1);
    cloud.push_back({half.x * p.x, half.y * p.y, half.z * p.z});
  }
  return cloud;
}

// Coplanar, collinear and repeated points.
Cloud on_grid(Dice& dice, const Real3& half) {
  Cloud cloud;
  const std::int64_t cells = dice.between(1, 4);
  const auto place = [&] { return 2.0 * static_cast<double>(dice.between(0, cells)) - 1; };
  for (std::int64_t count = dice.between(8, 60); count > 0; --count) {
    const double x = place(), y = place();
    cloud.push_back(Real3{half.x * x, half.y * y, half.z * place()} *
                    (1.0 / static_cast<double>(cells)));
  }
  return cloud;
}

Cloud prism(Dice& dice, const Real3& half) {
  Cloud cloud;
  const std::int64_t sides = dice.between(3, 24);
  const double taper = dice.chance(3) ? dice.uniform(0, 1) : 1;
  for (std::int64_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sides);
    const double x = half.x * std::cos(angle), z = half.z * std::sin(angle);
    cloud.push_back({x, -half.y, z});
    cloud.push_back({x * taper, half.y, z * taper});
  }
  return cloud;
}

Cloud box(const Real3& half) {
  Cloud cloud;
  for (int i = 0; i < 8; ++i)
    cloud.push_back({(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                     (i & 4) != 0 ? half.z : -half.z});
  return cloud;
}

// A wedge whose sharp edge may be a milliradian thin.
Cloud sliver(Dice& dice, const Real3& half) {
  Cloud cloud = box(half);
  const double edge = dice.chance(2) ? 0 : 1e-3;
  for (Real3& p : cloud)
    if (p.x > 0) p.y *= edge;
  return cloud;
}

// Half extents: compact, a plate, a needle, or of any proportions.
Real3 proportions(Dice& dice, double low, double high) {
  const double size = dice.log_uniform(low, high);
  const double thin = std::max(0.0007, size * dice.log_uniform(1e-4, 1));
  const auto near = [&] { return size * dice.uniform(0.3, 1); };
  const std::int64_t form = dice.between(0, 3);
  const double x = near(), y = near(), z = near();
  if (form == 0) return {x, thin, z};
  if (form == 1) return {x, thin, thin};
  if (form == 2) return {x, y, z};
  return {x, thin, std::max(0.0007, size * dice.log_uniform(1e-4, 1))};
}

Cloud cloud_of(Dice& dice, const Real3& half) {
  switch (dice.between(0, 4)) {
    case 0:
      return on_grid(dice, half);
    case 1:
      return prism(dice, half);
    case 2:
      return box(half);
    case 3:
      return sliver(dice, half);
    default:
      return scattered(dice, half);
  }
}

std::shared_ptr<const Hull> hull_or_none(Dice& dice) {
  const bool any_size = dice.chance(2);
  const Real3 half = proportions(dice, any_size ? 0.001 : 0.1, any_size ? 500 : 3);
  const Mat3 rotation = dice.chance(2) ? Mat3{} : to_matrix(dice.orientation());
  const Real3 centre = dice.chance(3) ? dice.in_cube(std::min(200.0, norm(half))) : Real3{};
  std::vector<Vec3<Length>> points;
  for (const Real3& p : cloud_of(dice, half)) {
    const Real3 q = turn(rotation, p) + centre;
    points.push_back(to_length({std::clamp(q.x, -512.0, 512.0), std::clamp(q.y, -512.0, 512.0),
                                std::clamp(q.z, -512.0, 512.0)}));
  }
  HullOptions options;
  if (dice.chance(2)) options.tolerance = Length::from_raw(1);
  options.max_vertices = dice.chance(4) ? static_cast<int>(dice.between(4, 16)) : 128;
  return Hull::build(points, options).hull;
}

}  // namespace

std::shared_ptr<const Hull> random_hull(Dice& dice) {
  std::shared_ptr<const Hull> hull;
  while (hull == nullptr)
    hull = hull_or_none(dice);
  return hull;
}

HullPool::HullPool(std::uint64_t seed) : seed_(seed), hulls_(k_hull_pool) {}

const std::shared_ptr<const Hull>& HullPool::at(std::uint64_t number) {
  const auto index = static_cast<std::size_t>(number);
  std::call_once(built_[index], [&] {
    Dice dice(seed_ ^ 0x68756c6c73U, number);
    hulls_[index] = random_hull(dice);
  });
  return hulls_[index];
}

}  // namespace lockstone::fuzz
