#include "core/world/state/sleeping_contacts.h"

#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "core/world/state/record_hash.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_bodies = 12;

using Model = std::map<ContactKey, ContactRecord>;

ContactRecord random_record(test::Random& random) {
  ContactRecord record;
  record.body_a = static_cast<std::uint32_t>(random.between(0, k_bodies - 2));
  record.body_b = static_cast<std::uint32_t>(random.between(record.body_a + 1, k_bodies - 1));
  record.part_a = static_cast<std::uint32_t>(random.between(0, 2));
  record.twist_impulse.raw = static_cast<std::int32_t>(random.between(-1000, 1000));
  return record;
}

bool has(const ContactRecord& record, std::uint32_t body) {
  return record.body_a == body || record.body_b == body;
}

void expect_equal(const SleepingContacts& contacts, const Model& model) {
  std::vector<ContactRecord> expected, found;
  std::uint64_t hash = 0;
  for (const auto& [key, record] : model) {
    expected.push_back(record);
    hash += hash_contact(record);
  }
  contacts.for_each(k_bodies, [&](const ContactRecord& record) { found.push_back(record); });
  ASSERT_EQ(found, expected);
  ASSERT_EQ(contacts.count(), expected.size());
  ASSERT_EQ(contacts.hash(), hash);
}

TEST(SleepingContacts, HoldsTheEntriesOfAMap) {
  test::Random random;
  SleepingContacts contacts(k_bodies, 512);
  Model model;
  for (int i = 0; i < 4000; ++i) {
    const auto body = static_cast<std::uint32_t>(random.between(0, k_bodies - 1));
    const ContactRecord record = random_record(random);
    if (random.between(0, 19) != 0) {
      if (model.emplace(record.key(), record).second) contacts.add(record);
    } else {
      std::size_t seen = 0, taken = 0;
      contacts.for_each_of(body, [&](const ContactRecord& r) { seen += has(r, body) ? 1U : 0U; });
      contacts.remove_all_of(body, [&](const ContactRecord& r) {
        taken += model.count(r.key()) != 0 && model.at(r.key()) == r ? 1U : 0U;
      });
      EXPECT_EQ(std::erase_if(model, [&](const auto& m) { return has(m.second, body); }), taken);
      EXPECT_EQ(seen, taken);
    }
    expect_equal(contacts, model);
  }
  contacts.clear();
  expect_equal(contacts, {});
}

}  // namespace
}  // namespace lockstone
