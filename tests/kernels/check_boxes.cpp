// Pairs of boxes: every target against the scalar twin.
#include <cstring>
#include <vector>

#include "core/kernels/box/box_block.h"
#include "tests/kernels/check.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

struct BoxScene {
  std::array<BoxSource, k_box_pairs> sources{};
  std::array<FourPoints, k_box_pairs> points{};
  std::array<std::int64_t, k_box_pairs> swapped{};
  std::array<FaceMeeting, k_box_pairs> meetings{};
  std::array<FourPlaced, k_box_pairs> placed{};

  void run(const BoxKernels& kernels) {
    kernels.meet(sources.data(), meetings.data());
    kernels.place(meetings.data(), points.data(), swapped.data(), placed.data());
  }
  friend bool operator==(const BoxScene& a, const BoxScene& b) {
    return std::memcmp(&a.meetings, &b.meetings, sizeof a.meetings) == 0 &&
           std::memcmp(&a.placed, &b.placed, sizeof a.placed) == 0;
  }
};

// Wild: any bits. Else in the ranges of directions and lengths.
BoxScene make_boxes(bool wild, Random& random) {
  constexpr std::int64_t k_one = std::int64_t{1} << 30, k_far = std::int64_t{1} << 53;
  const auto number = [&](std::int64_t low, std::int64_t high) {
    return static_cast<std::int32_t>(wild ? operand(random) : random.between(low, high));
  };
  const auto length = [&] { return wild ? word(random) : random.between(-k_far, k_far); };
  BoxScene scene;
  for (std::size_t i = 0; i < k_box_pairs; ++i) {
    BoxSource& source = scene.sources[i];
    for (std::int32_t& x : source.axes_a)
      x = number(-k_one, k_one);
    for (std::int32_t& x : source.axes_b)
      x = number(-k_one, k_one);
    for (std::size_t k = 0; k < 3; ++k) {
      source.half_a[k] = number(0, 1 << 21);
      source.half_b[k] = number(0, 1 << 21);
      source.offset[k] = number(-(1 << 22), 1 << 22);
    }
    source.margin = number(0, 1 << 20);
    for (FacePoint& point : scene.points[i]) {
      point.x = length();
      point.y = length();
      point.z = length();
      point.feature = random.between(0, 1 << 14);
    }
    scene.swapped[i] = random.between(0, 1);
  }
  return scene;
}

}  // namespace

std::string check_boxes(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 2000 && report.empty(); ++round) {
    const BoxScene start = make_boxes(round % 2 == 0, random);
    BoxScene expected = start;
    expected.run(k_scalar_boxes);
    report += on_each_target([&] {
      BoxScene scene = start;
      scene.run(box_kernels());
      return scene == expected ? std::string() : std::string("boxes\n");
    });
  }
  return report;
}

}  // namespace lockstone::lanes::test
