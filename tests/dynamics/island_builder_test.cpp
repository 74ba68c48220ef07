#include "core/dynamics/step/islands/island_builder.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/step/islands/island_lists.h"
#include "tests/dynamics/tick_scene.h"

namespace lockstone {
namespace {

const Vec3<Unit> k_up{{}, Unit::from_ratio(1, 1), {}};

// Two boxes on a ground, one on the other, and a third box beside them.
void make_two_islands(TickScene& scene) {
  const std::uint32_t ground = scene.add_body(k_static), box = scene.add_body(k_dynamic),
                      lid = scene.add_body(k_dynamic), other = scene.add_body(k_dynamic);
  scene.add_contact(ground, box);
  scene.add_contact(ground, other);
  scene.add_contact(box, lid).count = 0;
  scene.gather(0);
}

TEST(IslandBuilder, DoesNotJoinBodiesThroughTheGround) {
  TickScene scene;
  make_two_islands(scene);
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
  EXPECT_EQ(scene.islands.count(), 3U);
  EXPECT_EQ(scene.islands.of(scene.contacts[{0}]), scene.islands.of(scene.contacts[{2}]));
  EXPECT_NE(scene.islands.of(scene.contacts[{0}]), scene.islands.of(scene.contacts[{1}]));
}

TEST(IslandBuilder, CountsTheContactsOfEachIsland) {
  TickScene scene;
  make_two_islands(scene);
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
  EXPECT_EQ(scene.islands.tally(scene.contacts[{0}]).contacts, 2U);
  EXPECT_EQ(scene.islands.tally(scene.contacts[{0}]).fresh, 1U);
  EXPECT_EQ(scene.islands.tally(scene.contacts[{1}]).contacts, 1U);
  EXPECT_EQ(scene.islands.tally(scene.contacts[{1}]).fresh, 0U);
}

TEST(IslandBuilder, JoinsBodiesByJoints) {
  TickScene scene;
  const std::uint32_t ground = scene.add_body(k_static), a = scene.add_body(k_dynamic),
                      b = scene.add_body(k_dynamic);
  scene.add_contact(ground, a);
  scene.add_contact(ground, b);
  scene.add_joint(a, b);
  scene.gather();
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
  EXPECT_EQ(scene.islands.of(scene.contacts[{0}]), scene.islands.of(scene.contacts[{1}]));
}

// A press comes down on a box that lies on the ground.
void make_press(TickScene& scene, bool moves) {
  const std::uint32_t ground = scene.add_body(k_static), box = scene.add_body(k_dynamic),
                      head = scene.add_body(k_kinematic);
  if (moves) scene.body(head).velocity.y = Velocity::from_ratio(-1, 1);
  scene.add_contact(ground, box, k_up);
  scene.add_contact(box, head, k_up);
  scene.gather();
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
}

TEST(IslandBuilder, FindsIslandsThatAMovingBodyPressesAgainstAnother) {
  TickScene moving, resting;
  make_press(moving, true);
  make_press(resting, false);
  EXPECT_TRUE(moving.islands.tally(moving.contacts[{0}]).is_pinched);
  EXPECT_FALSE(resting.islands.tally(resting.contacts[{0}]).is_pinched);
}

TEST(PinchedIslands, NeedAnotherBodyAndAnOppositePush) {
  PinchedIslands pinched(4);
  pinched.add_pressing({3, 7, k_up});
  pinched.add_pressing({3, 7, k_up});
  pinched.sort();
  EXPECT_TRUE(pinched.is_pinched({3, 8, -k_up}));
  EXPECT_FALSE(pinched.is_pinched({3, 7, -k_up}));
  EXPECT_FALSE(pinched.is_pinched({3, 8, k_up}));
  EXPECT_FALSE(pinched.is_pinched({2, 8, -k_up}));
}

TEST(IslandLists, HaveTheItemsOfEachIslandInTheirOrder) {
  TickScene scene;
  make_two_islands(scene);
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
  IslandLists lists(TickScene::k_capacity, TickScene::k_capacity, TickScene::k_capacity);
  lists.build(scene.get(), scene.bodies, scene.contacts, scene.islands);
  const std::uint32_t island = scene.islands.of(scene.contacts[{0}]);
  std::vector<std::uint32_t> bodies, contacts;
  lists.for_bodies(island, [&](std::uint32_t number) { bodies.push_back(number); });
  lists.for_contacts(island, [&](ContactId contact) { contacts.push_back(contact.value); });
  EXPECT_EQ(bodies, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(contacts, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(scene.islands.tally(island).bodies, 2U);
}

}  // namespace
}  // namespace lockstone
