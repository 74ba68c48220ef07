#include "core/world/state/contact_lists.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace lockstone {
namespace {

constexpr std::uint32_t k_bodies = 8;
constexpr std::uint32_t k_contacts = 16;

ContactRecord contact(std::uint32_t a, std::uint32_t b) {
  ContactRecord record;
  record.body_a = a;
  record.body_b = b;
  return record;
}

// Lists of the contacts 0-1, 1-2, 2-3 and 4-5, with the manifolds 10, 11, 12 and 13.
ContactLists four_contacts() {
  ContactLists lists(k_bodies, k_contacts);
  const std::vector<ContactRecord> records{contact(0, 1), contact(1, 2), contact(2, 3),
                                           contact(4, 5)};
  std::vector<std::uint32_t> ids{10, 11, 12, 13};
  lists.write(0, records);
  lists.replace(ids);
  return lists;
}

std::vector<std::uint32_t> first_bodies(const ContactLists& lists) {
  std::vector<std::uint32_t> bodies;
  for (const ContactRecord& record : lists.active())
    bodies.push_back(record.body_a);
  return bodies;
}

std::vector<std::uint32_t> ids_of(const ContactLists& lists) {
  return {lists.manifold_ids().begin(), lists.manifold_ids().end()};
}

using Numbers = std::vector<std::uint32_t>;

TEST(ContactLists, SetAsideTheContactsOfWhichNoBodyIsAwake) {
  ContactLists lists = four_contacts();
  lists.freeze([](std::uint32_t body) { return body >= 3; });
  EXPECT_EQ(first_bodies(lists), (Numbers{2, 4}));
  EXPECT_EQ(ids_of(lists), (Numbers{12, 13}));
  EXPECT_EQ(lists.sleeping().count(), 2U);
  EXPECT_EQ(lists.count(), 4U);
  EXPECT_EQ(lists.active_capacity(), k_contacts - 2);
}

TEST(ContactLists, MergeThawedContactsByKeyAndKnowNoManifoldOfThem) {
  ContactLists lists = four_contacts();
  lists.freeze([](std::uint32_t body) { return body >= 3; });
  std::vector<ContactRecord> thawed;
  lists.thaw_all_of(1, [&](const ContactRecord& record) { thawed.push_back(record); });
  std::ranges::sort(thawed, {}, &ContactRecord::key);
  lists.merge(thawed);
  EXPECT_EQ(first_bodies(lists), (Numbers{0, 1, 2, 4}));
  constexpr std::uint32_t k_none = ContactLists::k_no_manifold;
  EXPECT_EQ(ids_of(lists), (Numbers{k_none, k_none, 12, 13}));
  EXPECT_EQ(lists.sleeping().count(), 0U);
}

TEST(ContactLists, VisitActiveAndFrozenContactsByKey) {
  ContactLists lists = four_contacts();
  lists.freeze([](std::uint32_t body) { return body == 2 || body == 4; });
  Numbers visited;
  lists.for_each(k_bodies, [&](const ContactRecord& record) { visited.push_back(record.body_a); });
  EXPECT_EQ(visited, (Numbers{0, 1, 2, 4}));
  EXPECT_EQ(lists.sleeping().count(), 1U);
}

TEST(ContactLists, ForgetManifoldsWhereContactsOfABodyAreDropped) {
  ContactLists lists = four_contacts();
  lists.drop_active_of(7);
  EXPECT_TRUE(lists.remembers_manifolds());
  lists.drop_active_of(1);
  EXPECT_FALSE(lists.remembers_manifolds());
  EXPECT_EQ(first_bodies(lists), (Numbers{2, 4}));
}

TEST(ContactLists, ChangeARecordWhereItIs) {
  ContactLists lists = four_contacts();
  lists.freeze([](std::uint32_t body) { return body >= 3; });
  const std::uint64_t hash = lists.sleeping().hash();
  lists.change(lists.active()[0], [](ContactRecord& record) { record.part_a = 7; });
  EXPECT_EQ(lists.active()[0].part_a, 7U);
  EXPECT_EQ(lists.sleeping().hash(), hash);
  const ContactRecord* sleeping = nullptr;
  lists.sleeping().for_each_of(0, [&](const ContactRecord& record) { sleeping = &record; });
  ASSERT_NE(sleeping, nullptr);
  lists.change(*sleeping, [](ContactRecord& record) { record.part_b = 9; });
  EXPECT_EQ(sleeping->part_b, 9U);
  EXPECT_NE(lists.sleeping().hash(), hash);
}

TEST(ContactLists, AdoptALoadedStateByTheFlagsOfItsBodies) {
  ContactLists lists = four_contacts();
  const std::vector<ContactRecord> loaded{contact(0, 2), contact(1, 6), contact(5, 7)};
  lists.forget_manifolds();
  lists.adopt(loaded, [](std::uint32_t body) { return body == 6; });
  EXPECT_EQ(first_bodies(lists), (Numbers{1}));
  EXPECT_EQ(lists.sleeping().count(), 2U);
  EXPECT_EQ(lists.count(), 3U);
}

}  // namespace
}  // namespace lockstone
