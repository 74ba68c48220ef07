// The cache of a body follows from its record alone.

#include "core/world/derived/body_cache.h"

#include <gtest/gtest.h>

#include <lockstone/literals.h>

namespace lockstone {
namespace {

using namespace literals;

constexpr std::uint32_t k_body = 3;

class BodyCacheTest : public ::testing::Test {
 protected:
  BodyCacheTest() {
    record.shape_kind = static_cast<std::uint8_t>(ShapeKind::box);
    record.size = {1_m, 2_m, 3_m};
    record.position = {7_m, 8_m, 9_m};
    turn(1_deg);
    set_recycling_pose(record);
    cache.refresh_shape(k_body, record);
    cache.refresh(k_body, record);
  }
  void turn(Angle angle) { record.orientation = from_axis_angle({Unit{}, 1_r, Unit{}}, angle); }
  void write_rotation() { cache.rotations_out()[k_body] = to_matrix(record.orientation); }

  BodyRecord record;
  BodyCache cache{8};
};

TEST_F(BodyCacheTest, HoldsTheRotationOfTheOrientation) {
  EXPECT_EQ(cache.rotation(k_body), to_matrix(record.orientation));
}

TEST_F(BodyCacheTest, HoldsTheInnerRadiusOfTheShape) {
  EXPECT_EQ(cache.inner_radius(k_body), 1_m);
}

TEST_F(BodyCacheTest, PlacesAShapeWithoutAnAssetAtTheBody) {
  EXPECT_EQ(cache.placed(k_body, record).origin, record.position);
}

TEST_F(BodyCacheTest, HasNoDriftAtTheContactPose) {
  EXPECT_TRUE(cache.pose_delta(k_body).is_none());
}

TEST_F(BodyCacheTest, KeepsTheRotationOfAContactPoseThatTheBodyLeft) {
  const Mat3 at_contact = cache.recycling_rotations()[k_body];
  turn(1.01_deg);
  write_rotation();
  cache.refresh_turned(k_body, record);
  EXPECT_EQ(cache.recycling_rotations()[k_body], at_contact);
  EXPECT_FALSE(cache.pose_delta(k_body).is_none());
}

TEST_F(BodyCacheTest, RenumbersAContactPoseOnlyWhenItChanges) {
  const std::uint32_t number = cache.recycling_pose_number(k_body);
  cache.renew_recycling_pose(k_body, record);
  EXPECT_EQ(cache.recycling_pose_number(k_body), number);
  turn(1.01_deg);
  write_rotation();
  cache.renew_recycling_pose(k_body, record);
  EXPECT_NE(cache.recycling_pose_number(k_body), number);
}

}  // namespace
}  // namespace lockstone
