#include <array>

#include "core/math/sym_mat3.h"
#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

/// |coordinate| ≤ 2^22 m
constexpr Domain k_far = below(54);
constexpr Domain k_entry = below(29);

using numerics::words;

RawSymMat3 sym_at(const Words& in, std::size_t at) {
  return {i32(in[at]),     i32(in[at + 1]), i32(in[at + 2]),
          i32(in[at + 3]), i32(in[at + 4]), i32(in[at + 5])};
}

Words words(const RawSymMat3& s) {
  return {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
}

Words words(const Mat3& m) {
  Words all;
  for (int column = 0; column < 3; ++column)
    for (int axis = 0; axis < 3; ++axis)
      all.push_back(m.column(column)[axis].raw);
  return all;
}

Words words(const EquilibratedSymMat3& s) {
  Words all = words(raw_of(s.scaled));
  all.insert(all.end(), s.exponent.begin(), s.exponent.end());
  return all;
}

/// The first six words become a positive definite matrix: six entries of a triangular factor, 14
/// bits each, times its transpose, plus one. A matrix that is positive definite already stays.
void make_definite(Words& in) {
  if (is_positive_definite(sym_at(in, 0)) && in[0] > 0) return;
  std::array<std::int64_t, 6> l{};
  for (std::size_t i = 0; i < 6; ++i)
    l[i] = in[i] % 16384;
  in[0] = l[0] * l[0] + 1;
  in[1] = l[3] * l[3] + l[1] * l[1] + 1;
  in[2] = l[4] * l[4] + l[5] * l[5] + l[2] * l[2] + 1;
  in[3] = l[0] * l[3];
  in[4] = l[0] * l[4];
  in[5] = l[3] * l[4] + l[1] * l[5];
}

void make_transform(Words& in) {
  normalise_at(in, 3);
}

void make_two_transforms(Words& in) {
  normalise_at(in, 3);
  normalise_at(in, 10);
}

void make_first_unit(Words& in) {
  normalise_at(in, 0);
}

/// Exact products are summed in 64 bits.
Words product(const Words& in) {
  const RawSymMat3 s = sym_at(in, 0);
  const auto entry = [](std::int32_t raw) { return Length::from_raw(raw); };
  const SymMat3<Length> typed{entry(s.xx), entry(s.yy), entry(s.zz),
                              entry(s.xy), entry(s.xz), entry(s.yz)};
  return words(typed * vec3_at<Length>(in, 6));
}

}  // namespace

std::vector<Function> structure_functions() {
  using W = const Words&;
  const auto transform_and_point = inputs({{k_far, 3}, {k_any32, 4}, {k_far, 3}});
  return {
      {"quat_multiply", inputs({{k_any32, 8}}),
       [](W in) -> Words { return words(multiply(quat_at(in, 0), quat_at(in, 4))); },
       make_two_units},
      {"to_matrix", inputs({{k_any32, 4}}),
       [](W in) -> Words { return words(to_matrix(quat_at(in, 0))); }, make_first_unit},
      {"rotate", inputs({{k_any32, 4}, {below(30), 3}}),
       [](W in) -> Words {
         return words(rotate(to_matrix(quat_at(in, 0)), vec3_at<Length>(in, 4)));
       },
       make_first_unit},
      {"rotate_inverse", inputs({{k_any32, 4}, {below(30), 3}}),
       [](W in) -> Words {
         return words(rotate_inverse(to_matrix(quat_at(in, 0)), vec3_at<Length>(in, 4)));
       },
       make_first_unit},
      {"sym_product", inputs({{k_entry, 6}, {k_any32, 3}}), product},
      {"sym_rotate", inputs({{k_any32, 4}, {k_entry, 6}}),
       [](W in) -> Words { return words(rotate_raw(to_matrix(quat_at(in, 0)), sym_at(in, 4))); },
       make_first_unit},
      {"sym_inverse", inputs({{k_any32, 6}, {{0, 30}, 1}}),
       [](W in) -> Words { return words(inverse_raw(sym_at(in, 0), i32(in[6]))); }, make_definite},
      {"sym_solve", inputs({{k_any32, 9}, {{-60, 60}, 1}}),
       [](W in) -> Words {
         const auto x =
             solve_raw_saturating(sym_at(in, 0), {i32(in[6]), i32(in[7]), i32(in[8])}, i32(in[9]));
         return {x.x, x.y, x.z};
       },
       make_definite},
      {"transform_apply", transform_and_point,
       [](W in) -> Words { return words(apply(transform_at(in, 0), vec3_at<Position>(in, 7))); },
       make_transform},
      {"transform_apply_length", inputs({{k_far, 3}, {k_any32, 7}}),
       [](W in) -> Words { return words(apply(transform_at(in, 0), vec3_at<Length>(in, 7))); },
       make_transform},
      {"transform_apply_inverse", transform_and_point,
       [](W in) -> Words {
         return words(apply_inverse(transform_at(in, 0), vec3_at<Position>(in, 7)));
       },
       make_transform},
      {"transform_compose", inputs({{k_far, 3}, {k_any32, 4}, {k_far, 3}, {k_any32, 4}}),
       [](W in) -> Words { return words(compose(transform_at(in, 0), transform_at(in, 7))); },
       make_two_transforms},
      {"transform_inverse", inputs({{k_far, 3}, {k_any32, 4}}),
       [](W in) -> Words { return words(inverse(transform_at(in, 0))); }, make_transform},
  };
}

}  // namespace lockstone::numerics
