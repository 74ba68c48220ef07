#include "core/math/trig.h"
#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

RotationVector rotation_at(const Words& in, std::size_t at) {
  return vec3_at<RotationComponent>(in, at);
}

/// The first three words become a unit vector, or zero.
void make_axis(Words& in) {
  const Vec3<Unit> given = vec3_at<Unit>(in, 0);
  if (is_near_unit(norm_squared(given))) return;
  const Vec3<Unit> axis = direction_of(given);
  for (std::size_t i = 0; i < 3; ++i)
    in[i] = axis[static_cast<int>(i)].raw;
}

/// Rotation vectors of every size, most of them short as in a tick.
constexpr Domain k_turn = below(34);

}  // namespace

std::vector<Function> angle_functions() {
  using W = const Words&;
  return {
      {"sin_cos",
       {k_any32},
       [](W in) -> Words {
         const SinCos both = sin_cos(Angle::from_raw(i32(in[0])));
         return {both.sin.raw, both.cos.raw};
       }},
      {"tan",
       {k_any32, {0, 31}},
       [](W in) -> Words { return {tan_raw_saturating(Angle::from_raw(i32(in[0])), i32(in[1]))}; }},
      {"atan2", {k_any64, k_any64}, [](W in) -> Words { return {atan2_raw(in[0], in[1]).raw}; }},
      {"atan2_near",
       {below(33), below(33)},
       [](W in) -> Words { return {atan2_raw(in[0], in[1]).raw}; }},
      {"asin", {k_any32}, [](W in) -> Words { return {asin(Unit::from_raw(i32(in[0]))).raw}; }},
      {"acos", {k_any32}, [](W in) -> Words { return {acos(Unit::from_raw(i32(in[0]))).raw}; }},
      {"rotation_from_vector",
       {k_turn, k_turn, k_turn},
       [](W in) -> Words { return words(rotation_from_vector(rotation_at(in, 0))); }},
      {"rotation_from_vector_far",
       {k_any64, k_any64, k_any64},
       [](W in) -> Words { return words(rotation_from_vector(rotation_at(in, 0))); }},
      {"from_axis_angle",
       {k_any32, k_any32, k_any32, k_any32},
       [](W in) -> Words {
         return words(from_axis_angle(vec3_at<Unit>(in, 0), Angle::from_raw(i32(in[3]))));
       },
       make_axis},
      {"integrate", inputs({{k_any32, 4}, {k_turn, 3}}),
       [](W in) -> Words { return words(integrate(quat_at(in, 0), rotation_at(in, 4))); },
       [](Words& in) { normalise_at(in, 0); }},
  };
}

}  // namespace lockstone::numerics
