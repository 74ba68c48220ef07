// Contacts of bodies that hardly move: how far they may move, and how separations follow.

#include "core/dynamics/contact/recycling_pose.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/geometry/scene.h"

namespace lockstone {
namespace {

using test::Dice;
using test::metres;
using test::real;
using test::Real;
using test::RealVec;

constexpr double k_hair = 1.0 / 512;

BodyRecord random_box(Dice& dice) {
  BodyRecord body;
  body.motion = static_cast<std::uint8_t>(MotionType::dynamic);
  body.shape_kind = static_cast<std::uint8_t>(ShapeKind::box);
  body.size = metres(dice.uniform(0.2, 0.6), dice.uniform(0.2, 0.6), dice.uniform(0.2, 0.6));
  body.orientation = dice.orientation();
  set_recycling_pose(body);
  return body;
}

Position position(double x) {
  return Position::from_raw(static_cast<std::int64_t>(std::ldexp(x, Position::frac_bits)));
}

// Moves and turns a body by no more than it may, or by as much as it must not.
void move(Dice& dice, double way, double angle, BodyRecord& body) {
  const RealVec along = dice.direction(), about = dice.direction();
  const auto lane = [](Real x) { return position(static_cast<double>(x)); };
  body.position += Vec3<Position>{lane(along.x * way), lane(along.y * way), lane(along.z * way)};
  const auto part = [&](Real x) { return static_cast<double>(x) * std::sin(angle / 2); };
  const double w = std::cos(angle / 2), x = part(about.x), y = part(about.y), z = part(about.z);
  const auto value = [](Unit c) { return std::ldexp(double{1} * c.raw, -Unit::frac_bits); };
  const Quat q = body.orientation;
  const double qx = value(q.x), qy = value(q.y), qz = value(q.z), qw = value(q.w);
  body.orientation =
      test::quat(w * qx + x * qw + y * qz - z * qy, w * qy - x * qz + y * qw + z * qx,
                 w * qz + x * qy - y * qx + z * qw, w * qw - x * qx - y * qy - z * qz);
}

TEST(RecyclingPose, IsNearWithinTheFinestDistance) {
  Dice dice;
  for (int round = 0; round < 2000; ++round) {
    const BodyRecord still = random_box(dice);
    EXPECT_TRUE(is_near_recycling_pose(still, coarse_range(still)));
    EXPECT_TRUE(pose_delta_of(still).is_none());
    BodyRecord body = still;
    move(dice, 0.99 * k_hair, 0.99 * k_hair, body);
    EXPECT_TRUE(is_near_recycling_pose(body, coarse_range(body)));
    BodyRecord far = still;
    move(dice, 1.01 * k_hair, 0, far);
    EXPECT_FALSE(is_near_recycling_pose(far, coarse_range(far)));
    BodyRecord turned = still;
    move(dice, 0, 1.01 * k_hair, turned);
    EXPECT_FALSE(is_near_recycling_pose(turned, coarse_range(turned)));
    set_recycling_pose(turned);
    EXPECT_TRUE(is_near_recycling_pose(turned, coarse_range(turned)));
  }
}

// Large stacks, which are rebalanced, follow more closely.
// Also of places half way between two steps of lengths.
TEST(RecyclingPose, LiesAlikeFromTheBodyAnywhereAndMirrored) {
  Dice dice;
  const auto way = [](std::int64_t raw) {
    BodyRecord body;
    body.position.x = Position::from_raw(raw);
    set_recycling_pose(body);
    return recycling_position(body).x.raw - raw;
  };
  for (int round = 0; round < 1000; ++round) {
    const std::int64_t half_steps = dice.between(-100'000, 100'000) * (std::int64_t{1} << 11);
    const std::int64_t east = dice.between(-900'000, 900'000) * Position::from_integer(1).raw;
    EXPECT_EQ(way(half_steps), way(half_steps + east));
    EXPECT_EQ(way(half_steps), -way(-half_steps));
  }
}

TEST(RecyclingPose, IsNearWithinAsMuchAsAsked) {
  Dice dice;
  for (const Length range : {coarse_range({}), wide_range({}), Length::from_ratio(1, 200)}) {
    const double most = static_cast<double>(real(range));
    BodyRecord near = random_box(dice), far = near;
    move(dice, 0.99 * most, 0.99 * most, near);
    EXPECT_TRUE(is_near_recycling_pose(near, range));
    move(dice, 1.01 * most, 0, far);
    EXPECT_FALSE(is_near_recycling_pose(far, range));
  }
}

TEST(RecyclingPose, RangesOfAPileFollowTheInnerRadius) {
  for (int exponent = -10; exponent <= 10; ++exponent) {
    BodyRecord body;
    body.scale_exponent = static_cast<std::int8_t>(exponent);
    EXPECT_LT(coarse_range(body), wide_range(body)) << exponent;
    EXPECT_EQ(pile_range(body, {}), coarse_range(body)) << exponent;
    EXPECT_EQ(pile_range(body, metres(200)), wide_range(body)) << exponent;
  }
  EXPECT_EQ(pile_range({}, metres(0.08)), metres(0.005));
}

TEST(RecyclingPose, IsLookedAtInAnyRecord) {
  for (const int exponent : {-128, -20, 20, 127}) {
    BodyRecord body;
    body.scale_exponent = static_cast<std::int8_t>(exponent);
    EXPECT_TRUE(is_near_recycling_pose(body, wide_range(body))) << exponent;
    body.position.x = Position::from_integer(1);
    EXPECT_FALSE(is_near_recycling_pose(body, wide_range(body))) << exponent;
  }
}

// Of a small body the hair is a part of its size: angles stay small.
TEST(RecyclingPose, IsNearWithinAPartOfASmallBody) {
  Dice dice;
  for (int exponent = -10; exponent < 10; ++exponent) {
    BodyRecord body = random_box(dice);
    body.scale_exponent = static_cast<std::int8_t>(exponent);
    const double scale = std::ldexp(1.0, exponent);
    const double bound = std::min(k_hair, scale / 512);
    const double way = std::max(bound, 1.0 / 524288);  // two steps of lengths
    BodyRecord near = body, far = body, turned = body;
    move(dice, 0.99 * way, 0, near);
    EXPECT_TRUE(is_near_recycling_pose(near, coarse_range(near))) << exponent;
    move(dice, 1.01 * way, 0, far);
    EXPECT_FALSE(is_near_recycling_pose(far, coarse_range(far))) << exponent;
    move(dice, 0, 1.2 * bound / scale, turned);
    EXPECT_FALSE(is_near_recycling_pose(turned, coarse_range(turned))) << exponent;
  }
}

// Boxes that stand on each other, leaning by a hundredth or less.
struct LeaningBoxes {
  explicit LeaningBoxes(Dice& dice) : a(random_box(dice)), b(random_box(dice)) {
    a.orientation = b.orientation = {};
    set_recycling_pose(a);
    const double height = std::ldexp(double{1} * (a.size.y + b.size.y).raw, -Length::frac_bits);
    b.position = {position(dice.uniform(-0.2, 0.2)), position(height + dice.uniform(-0.001, 0.001)),
                  position(dice.uniform(-0.2, 0.2))};
    lean = dice.uniform(0, 0.01);
    const double about = dice.uniform(-3.2, 3.2);
    b.orientation = test::quat(lean / 2 * std::cos(about), 0, lean / 2 * std::sin(about), 1);
    set_recycling_pose(b);
  }

  [[nodiscard]] Manifold collide() const {
    const Shape shape_a = a.shape(), shape_b = b.shape();
    const Mat3 turned_a = to_matrix(a.orientation), turned_b = to_matrix(b.orientation);
    return lockstone::collide({shape_a, turned_a}, {shape_b, turned_b},
                              saturated<Length>(b.position - a.position), metres(0.02));
  }

  BodyRecord a, b;
  double lean;
};

// The same points, found where the bodies are now, are as far apart as those that followed. A
// corner that an edge cuts off moves along the face, which counts times the faces' lean.
TEST(RecyclingPose, SeparationsFollow) {
  Dice dice;
  int met = 0;
  for (int round = 0; round < 20000; ++round) {
    LeaningBoxes boxes(dice);
    Manifold followed = boxes.collide();
    move(dice, dice.uniform(0, k_hair), dice.uniform(0, k_hair), boxes.a);
    move(dice, dice.uniform(0, k_hair), dice.uniform(0, k_hair), boxes.b);
    shift_manifold(pose_delta_of(boxes.a), pose_delta_of(boxes.b), followed);
    const Manifold now = boxes.collide();
    // Half a step of lengths counts twice, and of separations.
    const double allowed = 2e-6 + 3 * k_hair * boxes.lean + 4 * k_hair * k_hair;
    for (int i = 0; i < now.count; ++i) {
      const ManifoldPoint& point = now.points[static_cast<std::size_t>(i)];
      const auto same = std::ranges::find(followed.points, point.feature, &ManifoldPoint::feature);
      if (same == followed.points.end()) continue;
      ++met;
      EXPECT_NEAR(static_cast<double>(real(same->separation)),
                  static_cast<double>(real(point.separation)), allowed)
          << round;
    }
  }
  EXPECT_GT(met, 20000);
}

// Where bodies moved and turned further, separations follow to first order, and anchors stay.
TEST(RecyclingPose, AnchorsStay) {
  Dice dice;
  const double most = static_cast<double>(real(wide_range({})));
  for (int round = 0; round < 2000; ++round) {
    LeaningBoxes boxes(dice);
    const Manifold found = boxes.collide();
    const Vec3<Position> before = boxes.a.position;
    move(dice, dice.uniform(most / 2, most), dice.uniform(most / 2, most), boxes.a);
    ASSERT_TRUE(is_near_recycling_pose(boxes.a, wide_range(boxes.a)));
    Manifold followed = found;
    shift_manifold(pose_delta_of(boxes.a), pose_delta_of(boxes.b), followed);
    const Mat3 then = to_matrix(boxes.a.recycling_orientation),
               now = to_matrix(boxes.a.orientation);
    for (int i = 0; i < found.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const ManifoldPoint &point = found.points[at], &moved = followed.points[at];
      const Vec3<Length> turned = rotate(now, rotate_inverse(then, point.anchor_a));
      double apart = static_cast<double>(real(point.separation));
      for (int axis = 0; axis < 3; ++axis) {
        const double way = static_cast<double>(real(boxes.a.position[axis]) - real(before[axis])) +
                           static_cast<double>(real(turned[axis]) - real(point.anchor_a[axis]));
        apart -= static_cast<double>(real(found.normal[axis])) * way;
      }
      EXPECT_NEAR(static_cast<double>(real(moved.separation)), apart, most * most);
      EXPECT_EQ(moved.anchor_a, point.anchor_a);
      EXPECT_EQ(moved.anchor_b, point.anchor_b);
    }
  }
}

}  // namespace
}  // namespace lockstone
