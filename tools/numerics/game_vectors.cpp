#include <lockstone/game_math.h>

#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

Random random_at(const Words& in) {
  Random random(u64(in[0]));
  random.drawn = u64(in[1]);
  return random;
}

Words words(const random_detail::Block& block) {
  return {block[0], block[1], block[2], block[3]};
}

using numerics::words;

}  // namespace

std::vector<Function> game_functions() {
  using W = const Words&;
  const auto two_vectors = inputs({{k_any32, 6}});
  const auto two_orientations = inputs({{k_any32, 8}});
  const auto and_a_word = inputs({{k_any32, 9}});
  return {
      {"angle_between", two_vectors,
       [](W in) -> Words {
         return {angle_between(vec3_at<Length>(in, 0), vec3_at<Length>(in, 3)).raw};
       }},
      {"angle_between_orientations", two_orientations,
       [](W in) -> Words { return {angle_between(quat_at(in, 0), quat_at(in, 4)).raw}; },
       make_two_units},
      {"from_directions", two_vectors,
       [](W in) -> Words {
         return words(from_directions(vec3_at<Length>(in, 0), vec3_at<Length>(in, 3)));
       }},
      {"look_rotation", two_vectors,
       [](W in) -> Words {
         return words(look_rotation(vec3_at<Length>(in, 0), vec3_at<Length>(in, 3)));
       }},
      {"slerp", and_a_word,
       [](W in) -> Words {
         return words(slerp(quat_at(in, 0), quat_at(in, 4), Unit::from_raw(i32(in[8]))));
       },
       make_two_units},
      {"rotate_toward", and_a_word,
       [](W in) -> Words {
         return words(rotate_toward(quat_at(in, 0), quat_at(in, 4), Angle::from_raw(i32(in[8]))));
       },
       make_two_units},
      {"philox",
       {k_any64, k_any64, k_any64},
       [](W in) -> Words {
         const std::uint64_t low = u64(in[0]), high = u64(in[1]);
         const auto half = [](std::uint64_t word) { return static_cast<std::uint32_t>(word); };
         return words(random_detail::philox(
             {half(low), half(low >> 32), half(high), half(high >> 32)}, u64(in[2])));
       }},
      {"random_stream",
       {k_any64, k_any64},
       [](W in) -> Words { return {i64(Random(u64(in[0])).stream(u64(in[1])).key)}; }},
      {"random_below",
       {k_any64, k_any64, k_positive64},
       [](W in) -> Words {
         Random random = random_at(in);
         const std::int64_t value = random.below(in[2]);
         return {value, i64(random.drawn)};
       }},
      {"random_between",
       {k_any64, k_any64, k_any64, k_any64},
       [](W in) -> Words {
         Random random = random_at(in);
         const std::int64_t value = random.between<std::int64_t>(in[2], in[3]);
         return {value, i64(random.drawn)};
       },
       [](Words& in) {
         if (in[2] > in[3]) std::swap(in[2], in[3]);
       }},
      {"random_direction",
       {k_any64, k_any64},
       [](W in) -> Words {
         Random random = random_at(in);
         Words all = words(random.direction());
         all.push_back(i64(random.drawn));
         return all;
       }},
  };
}

}  // namespace lockstone::numerics
