#include "core/dynamics/step/input/contact_list.h"

#include <gtest/gtest.h>

#include "tests/dynamics/tick_scene.h"

namespace lockstone {
namespace {

TEST(BodySide, KeepsBodyMotionAndMarkApart) {
  BodySide side(12345, k_dynamic);
  EXPECT_FALSE(side.is_marked());
  side.mark();
  EXPECT_TRUE(side.is_marked());
  EXPECT_EQ(side.body(), 12345U);
  EXPECT_EQ(side.motion(), k_dynamic);
  EXPECT_TRUE(BodySide().is_none());
  EXPECT_FALSE(BodySide(0, k_static).is_none());
}

TEST(ContactList, NumbersADynamicBodyOnceAndAKinematicOneInEachContact) {
  TickScene scene;
  const std::uint32_t platform = scene.add_body(k_kinematic);
  const std::uint32_t first = scene.add_body(k_dynamic), second = scene.add_body(k_dynamic);
  scene.add_contact(platform, first);
  scene.add_contact(platform, second);
  scene.add_contact(first, second);
  scene.gather();
  ASSERT_EQ(scene.contacts.size(), 3U);
  EXPECT_NE(scene.contacts[{0}].a.number(), scene.contacts[{1}].a.number());
  EXPECT_EQ(scene.contacts[{0}].b.number(), scene.contacts[{2}].a.number());
  EXPECT_EQ(scene.contacts[{1}].b.number(), scene.contacts[{2}].b.number());
  EXPECT_EQ(scene.bodies.number_of(platform), scene.contacts[{0}].a.number());
  EXPECT_EQ(scene.bodies.count(), 5U);  // number 0, two of the platform, two bodies
}

TEST(ContactList, GivesABodyThatStandsStillARowInEachContact) {
  TickScene scene;
  const std::uint32_t ground = scene.add_body(k_static);
  const std::uint32_t box = scene.add_body(k_dynamic);
  scene.add_contact(ground, box);
  scene.add_contact(ground, box);
  scene.gather();
  ASSERT_TRUE(scene.contacts[{0}].a.is_standing());
  EXPECT_EQ(scene.bodies.number_of(ground), 0U);
  EXPECT_EQ(scene.bodies.row_of(scene.contacts[{0}].a), 2U);
  EXPECT_EQ(scene.bodies.row_of(scene.contacts[{1}].a), 3U);
  EXPECT_EQ(scene.bodies.row_count(), 4U);
}

TEST(ContactList, LeavesOutTriggersAndTakenContactsAndKeepsTheOrderOfTheRest) {
  TickScene scene;
  const std::uint32_t ground = scene.add_body(k_static), box = scene.add_body(k_dynamic);
  for (int i = 0; i < 4; ++i)
    scene.add_contact(ground, box);
  scene.add_contact(ground, box).flags = k_contact_trigger;
  scene.surface(1).is_left_out = true;
  scene.gather();
  ASSERT_EQ(scene.contacts.size(), 3U);
  EXPECT_EQ(scene.contacts[{0}].record, 0U);
  EXPECT_EQ(scene.contacts[{1}].record, 2U);
  EXPECT_EQ(scene.contacts[{2}].record, 3U);
}

TEST(ContactList, MarksNewContactsOfTwoDynamicBodiesAndBearingOnes) {
  TickScene scene;
  const std::uint32_t ground = scene.add_body(k_static), box = scene.add_body(k_dynamic),
                      lid = scene.add_body(k_dynamic);
  scene.add_contact(ground, box).count = 0;
  scene.add_contact(box, lid).count = 0;
  ContactRecord& bearing = scene.add_contact(box, lid);
  bearing.count = 2;
  bearing.mean_impulse.raw = 51;
  scene.gather(100);
  EXPECT_FALSE(scene.contacts.is_new(scene.contacts[{0}]));
  EXPECT_TRUE(scene.contacts.is_new(scene.contacts[{1}]));
  EXPECT_FALSE(scene.contacts.is_bearing(scene.contacts[{1}]));
  EXPECT_TRUE(scene.contacts.is_bearing(scene.contacts[{2}]));
}

TEST(ContactList, ForgetsTheTickBefore) {
  TickScene scene;
  const std::uint32_t ground = scene.add_body(k_static), box = scene.add_body(k_dynamic);
  scene.add_contact(ground, box);
  scene.gather();
  EXPECT_EQ(scene.bodies.number_of(box), 1U);
  scene.bodies.clear();
  EXPECT_EQ(scene.bodies.number_of(box), 0U);
  EXPECT_EQ(scene.bodies.row_count(), 1U);
}

}  // namespace
}  // namespace lockstone
