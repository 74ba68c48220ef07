#include "tools/fuzz/pair_source.h"

#include <array>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/shapes/tapered_ends.h"
#include "tools/fuzz/special_places.h"

namespace lockstone::fuzz {
namespace {

constexpr double k_micrometre = 1e-6;
constexpr double k_farthest = 1990;  // offsets, by axis

struct Sizes {
  double low;
  double high;
};

// Usual sizes of games, crumbs, everything at once, giants.
constexpr std::array<Sizes, 4> k_sizes{{{0.1, 3}, {0.001, 0.05}, {0.001, 500}, {50, 500}}};

std::array<Vec3<Length>, 3> random_triangle(Dice& dice, const Sizes& sizes) {
  std::array<Vec3<Length>, 3> corners;
  do {
    const double size = dice.log_uniform(sizes.low, sizes.high) / 2;
    const double thin = dice.chance(3) ? dice.log_uniform(1e-4, 1) : 1;
    const Real3 along = dice.direction(), across = dice.direction() * thin;
    const Real3 centre = dice.chance(2) ? Real3{} : dice.in_cube(std::min(100.0, size));
    for (Vec3<Length>& corner : corners) {
      const double u = dice.uniform(-1, 1);
      corner = to_length(centre + (along * u + across * dice.uniform(-1, 1)) * size * 0.7);
    }
  } while (geometry::is_degenerate(corners) || geometry::triangle_normal(corners) == Vec3<Unit>{});
  return corners;
}

double unevenness_of(const geometry::Polytope& polytope) {
  double most = 0;
  for (const geometry::PolytopeFace& face : polytope.faces) {
    for (int i = 0; i < face.edge_count; ++i) {
      const Vec3<Length>& v = geometry::start_of(polytope, face.first_edge + i);
      const geometry::Fine below = face.offset - dot(v, face.normal).raw;
      most = std::max(most, std::ldexp(static_cast<double>(below), -geometry::k_fine_bits));
    }
  }
  return most;
}

Body random_body(HullPool& pool, Dice& dice, Kind kind, const Sizes& sizes, std::uint64_t index) {
  Body body;
  body.kind = kind;
  const auto size = [&] { return dice.size(sizes.low, sizes.high); };
  const Length x = size(), y = size(), z = size();
  if (kind == Kind::sphere) body.shape = Shape::sphere(x);
  if (kind == Kind::capsule) body.shape = Shape::capsule(y, x);
  if (kind == Kind::box) {
    const Length deep = dice.chance(4) ? y : z;
    body.shape = Shape::box(x, dice.chance(4) ? x : y, deep);
  }
  if (kind == Kind::cylinder) body.shape = Shape::cylinder(y, x);
  if (kind == Kind::cone) body.shape = Shape::cone(y, x);
  if (kind == Kind::tapered_capsule)
    body.shape = Shape::tapered_capsule(y, x, dice.chance(8) ? x : z);
  if (kind == Kind::rounded_box) {
    const Length radius = size();
    const auto core = [&](Length half) { return min(half, k_max_shape_size - radius); };
    const Length wide = core(x), high = core(dice.chance(4) ? x : y), deep = core(z);
    body.shape = Shape::rounded_box(wide, high, deep, radius);
    body.radius = real(radius);
  }
  if (kind == Kind::half_space) body.shape = Shape::half_space();
  if (kind == Kind::hull) {
    const std::uint64_t built = std::min(k_hull_pool, 64 + index / 64);
    body.hull = pool.at(dice.next() % built);
    body.shape = body.hull->shape();
    body.polytope = body.hull->geometry().polytope();
  }
  if (kind == Kind::rounded_hull) {
    const std::uint64_t built = std::min(k_hull_pool, 64 + index / 64);
    const auto sharp = pool.at(dice.next() % built);
    body.hull = Hull::build(sharp->vertices(), HullOptions::rounded(x, 128)).hull;
    if (body.hull == nullptr) body.hull = sharp;  // too large
    body.shape = body.hull->shape();
    body.polytope = body.hull->geometry().polytope();
    body.radius = real(body.hull->radius());
  }
  if (kind == Kind::triangle) {
    body.triangle = std::make_unique<geometry::TrianglePolytope>();
    body.polytope = &body.triangle->set(random_triangle(dice, sizes));
    body.shape = {ShapeKind::hull, {}, {}};
  }
  if (body.polytope != nullptr) body.unevenness = unevenness_of(*body.polytope);
  const bool round = kind == Kind::sphere || kind == Kind::capsule;
  if (round) body.radius = real(body.shape.size.x);
  if (kind == Kind::tapered_capsule) {
    const geometry::TaperedEnds ends = geometry::tapered_ends(body.shape.size);
    body.radius = std::min(real(ends.low_radius), real(ends.high_radius));
    body.swell = {real(ends.low_radius) - body.radius, real(ends.high_radius) - body.radius};
  }
  body.turn_to(to_matrix(dice.orientation()));
  return body;
}

Vec3<Length> bounded(const Real3& v, double bound = k_farthest) {
  return to_length({std::clamp(v.x, -bound, bound), std::clamp(v.y, -bound, bound),
                    std::clamp(v.z, -bound, bound)});
}

// A normal of one of its faces; of a shape without faces, any direction.
Real3 some_normal(Dice& dice, const Body& body) {
  if (body.kind == Kind::half_space) return real(body.rotation.y);
  if (body.is_box()) {
    const int way = dice.chance(2) ? -1 : 1;
    return real(body.rotation.column(static_cast<int>(dice.between(0, 2)))) * way;
  }
  if (body.has_rims()) {
    const Real3 axis = real(body.rotation.y);
    if (dice.chance(2)) return direction_of(axis) * (dice.chance(2) ? -1 : 1);
    return direction_of(cross(axis, dice.direction()));
  }
  if (body.polytope == nullptr) return dice.direction();
  const auto last = static_cast<std::int64_t>(body.polytope->faces.size()) - 1;
  const auto face = static_cast<std::size_t>(dice.between(0, last));
  return turn(body.rotation, real(body.polytope->faces[face].normal));
}

// A half-space reaches as far as its plane.
double reach_of(const Body& body, const Real3& n) {
  return body.kind == Kind::half_space ? 0 : body.reach(n);
}

Vec3<Length> at_part_of_touch(const Pair& pair, const Real3& n, double part) {
  return bounded(n * ((reach_of(pair.a, n) + reach_of(pair.b, -n)) * part));
}

// B where faces, edges or vertices nearly touch: `gap` along a normal of A and anywhere aside.
Vec3<Length> flush(Dice& dice, const Pair& pair, double gap) {
  const Real3 n = some_normal(dice, pair.a);
  const Real3 aside = cross(n, dice.direction());
  const double slide = std::min(pair.a.size() + pair.b.size(), 1000.0) * dice.uniform(-0.5, 0.5);
  return bounded(n * (reach_of(pair.a, n) + reach_of(pair.b, -n) + gap) + aside * slide);
}

// Moves B along the closest points' normal until `gap` is left.
Vec3<Length> brought_near(const Pair& pair, double gap) {
  const ClosestPoints found = distance(pair.a.posed(), pair.b.posed(), pair.offset);
  if (found.overlapping) return pair.offset;
  return bounded(real(pair.offset) - real(found.normal) * (real(found.distance) - gap));
}

double small_gap(Dice& dice) {
  constexpr std::array<double, 6> k_gaps{0, 1, 3, 10, 100, 1000};
  const auto pick = static_cast<std::size_t>(dice.between(0, k_gaps.size() - 1));
  return k_gaps[pick] * k_micrometre * (dice.chance(3) ? -1 : 1);
}

void align(Dice& dice, Pair& pair) {
  pair.b.turn_to(pair.a.rotation);
  if (dice.chance(2)) return;
  const Quat tilt = dice.chance(2) ? dice.quarter_turns()
                                   : to_quat(dice.in_cube(dice.log_uniform(1e-9, 1e-3)), 1);
  pair.b.turn_to(multiply(pair.a.rotation, to_matrix(tilt)));
}

void place(Dice& dice, Pair& pair) {
  if (dice.chance(3)) align(dice, pair);
  const Real3 n = dice.direction();
  switch (dice.between(0, 7)) {
    case 0:
    case 1:
    case 2:
      pair.offset = at_part_of_touch(pair, n, dice.uniform(0.2, 1.3));
      return;
    case 3:
      pair.offset = flush(dice, pair, small_gap(dice));
      return;
    case 4:
      pair.offset = at_part_of_touch(pair, n, dice.uniform(0, 0.3));
      return;  // nested
    case 5:
      pair.offset = bounded(dice.in_cube(3 * k_micrometre));
      return;  // concentric
    default:
      break;
  }
  pair.offset = at_part_of_touch(pair, n, dice.uniform(0.8, 1.3));
  const double gap = small_gap(dice);
  pair.offset = brought_near(pair, gap);
  pair.offset = brought_near(pair, gap);
}

void aim(Dice& dice, Pair& pair) {
  const double size = std::min(1000.0, pair.a.size() + pair.b.size());
  const double far = size * dice.log_uniform(0.01, 2);
  const Real3 back = dice.direction() * far;
  pair.cast_from = bounded(real(pair.offset) * dice.uniform(0, 1.1) - back, 1000);
  pair.way = bounded((real(pair.offset) - real(pair.cast_from)) * dice.uniform(0.5, 2), 900);
  if (dice.chance(4)) pair.way = bounded(dice.direction() * size, 900);
  const double from = std::min(1400.0, pair.a.size() * dice.uniform(0, 4) + 1);
  const Real3 origin = dice.direction() * from;
  const double to = std::min(600.0, pair.a.size()) * dice.uniform(0, 1.1);
  const Real3 target = dice.direction() * to;
  pair.ray_origin = bounded(origin, 1400);
  pair.ray_way = bounded((target - origin) * dice.uniform(0.5, 2), 1400);
}

}  // namespace

Pair make_pair(HullPool& pool, std::uint64_t seed, std::uint64_t index,
               const std::vector<Kind>& kinds, Places places) {
  Dice dice(seed, index);
  const auto kind = [&] {
    return kinds[static_cast<std::size_t>(
        dice.between(0, static_cast<std::int64_t>(kinds.size()) - 1))];
  };
  Kind a = kind(), b = kind();
  for (; !do_meet(a, b); b = kind())
    a = kind();
  const auto sizes = [&] { return k_sizes[static_cast<std::size_t>(dice.between(0, 3))]; };
  const Sizes sizes_a = sizes();
  const Sizes sizes_b = dice.chance(2) ? sizes_a : sizes();
  Pair pair;
  pair.a = random_body(pool, dice, a, sizes_a, index);
  pair.b = random_body(pool, dice, b, sizes_b, index);
  if (places == Places::special && pair.half_space() == nullptr)
    place_specially(dice, pair);
  else
    place(dice, pair);
  pair.margin = to_length(dice.chance(3) ? 0 : dice.log_uniform(1e-5, 1));
  pair.turn = to_matrix(dice.orientation());
  aim(dice, pair);
  return pair;
}

}  // namespace lockstone::fuzz
