// Two worlds beside each other, body by body.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <lockstone/testing/floating.h>
#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/studio/native/lockstone_studio.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr double k_degrees = 180 / std::numbers::pi;

template <class T>
float gap_between(const Vec3<T>& a, const Vec3<T>& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = testing::to_double(a[axis] - b[axis]);
    sum += way * way;
  }
  return static_cast<float>(std::sqrt(sum));
}

// By the chord between both quaternions, which is exactly 0 for equal ones.
float turn_between(const Quat& a, const Quat& b) {
  double minus = 0, plus = 0;
  for (const auto& [x, y] : {std::pair{a.x, b.x}, {a.y, b.y}, {a.z, b.z}, {a.w, b.w}}) {
    const double left = testing::to_double(x), right = testing::to_double(y);
    minus += (left - right) * (left - right);
    plus += (left + right) * (left + right);
  }
  const double chord = std::sqrt(std::min(minus, plus));
  return static_cast<float>(4 * k_degrees * std::asin(std::min(1.0, chord / 2)));
}

bool same(const BodyView& a, const BodyView& b) {
  return a.position == b.position && a.orientation == b.orientation && a.velocity == b.velocity &&
         a.angular_velocity == b.angular_velocity && a.mass == b.mass && a.shape == b.shape &&
         a.is_asleep == b.is_asleep && a.user_data == b.user_data && a.motion == b.motion;
}

// Flags, m, m/s, degrees.
void add_row(const World& a, const World& b, std::uint32_t row, std::vector<float>& numbers,
             std::uint32_t& differing) {
  const auto at = [row](const World& world) {
    return row < world.body_limit() ? world.body_at(row) : BodyHandle{};
  };
  const BodyHandle left = at(a), right = at(b);
  std::uint32_t flags = 0;
  float place = 0, speed = 0, turn = 0;
  if (left != right) {
    flags = LKS_STUDIO_DIFFERS | (right.is_null() ? LKS_STUDIO_ONLY_A : 0) |
            (left.is_null() ? LKS_STUDIO_ONLY_B : 0);
  } else if (!left.is_null()) {
    const BodyView x = a.body(left), y = b.body(right);
    flags = same(x, y) ? 0 : LKS_STUDIO_DIFFERS;
    place = gap_between(x.position, y.position);
    speed = gap_between(x.velocity, y.velocity);
    turn = turn_between(x.orientation, y.orientation);
  }
  differing += flags != 0 ? 1 : 0;
  numbers.insert(numbers.end(), {static_cast<float>(flags), place, speed, turn});
}

}  // namespace

lks_status lks_studio_compare(const lks_world* a, const lks_world* b, lks_studio_list* list,
                              uint32_t* differing) {
  static std::vector<float> numbers;
  return call([&] {
    const World &left = read(a), &right = read(b);
    required(differing, "differing") = 0;
    numbers.clear();
    const std::uint32_t rows = std::max(left.body_limit(), right.body_limit());
    for (std::uint32_t row = 0; row < rows; ++row)
      add_row(left, right, row, numbers, *differing);
    required(list, "list") = {numbers.data(), static_cast<std::uint32_t>(numbers.size())};
  });
}
