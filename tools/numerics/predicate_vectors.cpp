#include "core/math/predicates.h"
#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

LatticePoint point_at(const Words& in, std::size_t index) {
  return {i32(in[3 * index]), i32(in[3 * index + 1]), i32(in[3 * index + 2])};
}

Words word(Contact contact) {
  return {static_cast<std::int64_t>(contact)};
}

Words circumsphere(const Words& in) {
  return {side_of_circumsphere(point_at(in, 0), point_at(in, 1), point_at(in, 2), point_at(in, 3),
                               point_at(in, 4))};
}

Words orientation(const Words& in) {
  return {orient3d(point_at(in, 0), point_at(in, 1), point_at(in, 2), point_at(in, 3))};
}

Words triangle(const Words& in) {
  return {point_in_triangle(point_at(in, 0), point_at(in, 1), point_at(in, 2), point_at(in, 3))};
}

Words segments(const Words& in) {
  return word(segment_segment(point_at(in, 0), point_at(in, 1), point_at(in, 2), point_at(in, 3)));
}

Words piercing(const Words& in) {
  return word(segment_triangle(point_at(in, 0), point_at(in, 1), point_at(in, 2), point_at(in, 3),
                               point_at(in, 4)));
}

/// Few coordinates: degenerate cases are the rule.
constexpr Domain k_few{-2, 2};

}  // namespace

std::vector<Function> predicate_functions() {
  using W = const Words&;
  return {
      {"lattice_shift", {k_any64}, [](W in) -> Words { return {lattice_shift(u64(in[0]))}; }},
      {"to_lattice", inputs({{below(62), 6}, {{33, 62}, 1}}),
       [](W in) -> Words {
         const LatticePoint p =
             to_lattice({in[0], in[1], in[2]}, {in[3], in[4], in[5]}, i32(in[6]));
         return {p.x, p.y, p.z};
       }},
      {"orient3d", inputs({{k_any32, 12}}), orientation},
      {"orient3d_few", inputs({{k_few, 12}}), orientation},
      {"side_of_plane", inputs({{k_any32, 3}, {k_any64, 1}, {k_any32, 3}}),
       [](W in) -> Words {
         return {side_of_plane(point_at(in, 0), in[3], {i32(in[4]), i32(in[5]), i32(in[6])})};
       }},
      {"side_of_sphere", inputs({{k_any32, 3}, {{0, k_max64}, 1}, {k_any32, 3}}),
       [](W in) -> Words {
         return {side_of_sphere(point_at(in, 0), in[3], {i32(in[4]), i32(in[5]), i32(in[6])})};
       }},
      {"side_of_circumsphere", inputs({{below(23), 15}}), circumsphere},
      {"side_of_circumsphere_few", inputs({{k_few, 15}}), circumsphere},
      {"point_in_triangle", inputs({{k_any32, 12}}), triangle},
      {"point_in_triangle_few", inputs({{k_few, 12}}), triangle},
      {"segment_segment", inputs({{k_any32, 12}}), segments},
      {"segment_segment_few", inputs({{k_few, 12}}), segments},
      {"segment_triangle", inputs({{k_any32, 15}}), piercing},
      {"segment_triangle_few", inputs({{k_few, 15}}), piercing},
  };
}

}  // namespace lockstone::numerics
