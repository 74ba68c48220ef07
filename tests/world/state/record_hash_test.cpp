// A record's hash is XXH3 of its canonical bytes, of a long one's part by part.

#include "core/world/state/record_hash.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/state/joint_record.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

template <class Record>
using BytesOf = std::array<std::byte, sizeof(Record)>;

template <class Record>
BytesOf<Record> random_bytes(test::Random& random) {
  BytesOf<Record> bytes;
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random.next());
  return bytes;
}

template <class Record>
Record record_of(const BytesOf<Record>& bytes) {
  ByteReader reader(bytes);
  return decode<Record>(reader);
}

// As docs/explanation/determinism.md says it.
std::uint64_t expected_hash(std::span<const std::byte> bytes, std::uint64_t seed) {
  while (bytes.size() > 240) {
    seed = hash64(bytes.first(128), seed);
    bytes = bytes.subspan(128);
  }
  return hash64(bytes, seed);
}

template <class Record>
class RecordHash : public ::testing::Test {};
using Records = ::testing::Types<BodyRecord, ContactRecord, JointRecord>;
TYPED_TEST_SUITE(RecordHash, Records);

TYPED_TEST(RecordHash, IsThatOfTheCanonicalBytes) {
  test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const auto bytes = random_bytes<TypeParam>(random);
    const std::uint64_t seed = random.next();
    ASSERT_EQ(hash_record(record_of<TypeParam>(bytes), seed), expected_hash(bytes, seed));
  }
}

TYPED_TEST(RecordHash, ChangesWithEveryBitAndWithTheSeed) {
  test::Random random;
  auto bytes = random_bytes<TypeParam>(random);
  const std::uint64_t seed = random.next();
  const std::uint64_t hash = hash_record(record_of<TypeParam>(bytes), seed);
  EXPECT_NE(hash_record(record_of<TypeParam>(bytes), seed + 1), hash);
  for (std::byte& byte : bytes) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      byte ^= std::byte{1} << bit;
      ASSERT_NE(hash_record(record_of<TypeParam>(bytes), seed), hash);
      byte ^= std::byte{1} << bit;
    }
  }
}

TEST(ContactHashes, AreTheSumOverThem) {
  test::Random random;
  std::vector<ContactRecord> records;
  std::uint64_t sum = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(hash_contacts(records), sum);
    records.push_back(record_of<ContactRecord>(random_bytes<ContactRecord>(random)));
    sum += hash_contact(records.back());
  }
}

}  // namespace
}  // namespace lockstone
