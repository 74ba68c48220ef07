#include "core/dynamics/step/contacts/constraint_layout.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/dynamics/tick_scene.h"

namespace lockstone {
namespace {

// A row of boxes that touch their neighbours, the first of which stands on the ground.
void make_row(TickScene& scene, int count) {
  std::uint32_t last = scene.add_body(MotionType::static_body);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t next = scene.add_body(MotionType::dynamic);
    scene.add_contact(last, next);
    last = next;
  }
  scene.gather();
}

TEST(ConstraintLayout, GivesEachContactALaneOfItsOwnAndFindsItBack) {
  TickScene scene;
  make_row(scene, 40);
  ConstraintLayout layout(TickScene::k_capacity, TickScene::k_capacity);
  layout.build(scene.get(), scene.bodies, scene.contacts, scene.parallel);
  std::set<std::uint32_t> lanes;
  for (std::uint32_t i = 0; i < scene.contacts.size(); ++i) {
    const ContactLane lane = layout.lane_of({i});
    EXPECT_TRUE(layout.has_contact(lane));
    EXPECT_EQ(layout.contact_at(lane), ContactId{i});
    lanes.insert(lane.value);
  }
  EXPECT_EQ(lanes.size(), scene.contacts.size());
  std::size_t taken = 0;
  for (std::uint32_t i = 0; i < layout.lane_count(); ++i)
    taken += layout.has_contact({i}) ? 1U : 0U;
  EXPECT_EQ(taken, scene.contacts.size());
}

TEST(ConstraintLayout, LetsNoBodyThatMovesOccurTwiceInAColour) {
  TickScene scene;
  make_row(scene, 40);
  ConstraintLayout layout(TickScene::k_capacity, TickScene::k_capacity);
  layout.build(scene.get(), scene.bodies, scene.contacts, scene.parallel);
  for (std::size_t color = 0; color < k_graph_colors; ++color) {
    std::set<std::uint32_t> numbers;
    const auto [first, count] = layout.blocks_of(color);
    for (std::size_t i = first * lanes::k_block_lanes; i < (first + count) * lanes::k_block_lanes;
         ++i) {
      const ContactLane lane{static_cast<std::uint32_t>(i)};
      if (!layout.has_contact(lane)) continue;
      const ContactRef& contact = scene.contacts[layout.contact_at(lane)];
      for (const BodyRef body : {contact.a, contact.b})
        EXPECT_TRUE(body.is_standing() || numbers.insert(body.number()).second);
    }
  }
}

// Kernels do less where the manifolds of a vector have few points.
TEST(ConstraintLayout, OrdersTheContactsOfAColourByTheirNumberOfPoints) {
  TickScene scene;
  make_row(scene, 40);
  for (std::uint32_t i = 0; i < scene.contacts.size(); ++i)
    scene.manifold(i).count = static_cast<int>(1 + i * 7 % 4);
  ConstraintLayout layout(TickScene::k_capacity, TickScene::k_capacity);
  layout.build(scene.get(), scene.bodies, scene.contacts, scene.parallel);
  for (std::size_t color = 0; color < k_graph_colors; ++color) {
    int points = 1;
    const auto [first, count] = layout.blocks_of(color);
    for (std::size_t i = first * lanes::k_block_lanes; i < (first + count) * lanes::k_block_lanes;
         ++i) {
      const ContactLane lane{static_cast<std::uint32_t>(i)};
      if (!layout.has_contact(lane)) continue;
      const int own = std::min(scene.manifold(layout.contact_at(lane).value).count, 3);
      EXPECT_GE(own, points);
      points = own;
    }
  }
}

TEST(ConstraintLayout, CallsAContactAloneWhereABodyTouchesTheGroundOnly) {
  TickScene alone, two;
  make_row(alone, 1);
  make_row(two, 2);
  ConstraintLayout layout(TickScene::k_capacity, TickScene::k_capacity);
  layout.build(alone.get(), alone.bodies, alone.contacts, alone.parallel);
  EXPECT_TRUE(layout.is_alone(alone.contacts[{0}]));
  layout.build(two.get(), two.bodies, two.contacts, two.parallel);
  EXPECT_FALSE(layout.is_alone(two.contacts[{0}]));
  EXPECT_FALSE(layout.is_alone(two.contacts[{1}]));
}

}  // namespace
}  // namespace lockstone
