#include "net/transport/enet/enet_commands.h"

#include <algorithm>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "net/transport/random.h"

namespace lockstone::net::test {
namespace {

using Bytes = std::vector<std::byte>;
using Verdict = CommandFilter::Verdict;

void put(Bytes& bytes, std::uint32_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

Bytes command(std::uint8_t kind, std::uint8_t channel, std::uint16_t sequence,
              std::initializer_list<std::pair<std::uint32_t, int>> fields = {}) {
  Bytes bytes{std::byte{kind}, std::byte{channel}};
  put(bytes, sequence, 2);
  for (const auto& [value, size] : fields)
    put(bytes, value, size);
  return bytes;
}

Bytes reliable(std::uint16_t sequence, std::uint16_t size = 1) {
  Bytes bytes = command(0x86, 0, sequence, {{size, 2}});
  bytes.resize(bytes.size() + size);
  return bytes;
}

Bytes fragment(std::uint16_t first, std::uint32_t number, std::uint32_t total) {
  const std::uint32_t count = (total + k_enet_fragment_bytes - 1) / k_enet_fragment_bytes;
  const std::uint32_t offset = number * k_enet_fragment_bytes;
  const std::uint32_t size = std::min(k_enet_fragment_bytes, total - offset);
  Bytes bytes = command(0x88, 0, static_cast<std::uint16_t>(first + number),
                        {{first, 2}, {size, 2}, {count, 4}, {number, 4}, {total, 4}, {offset, 4}});
  bytes.resize(bytes.size() + size);
  return bytes;
}

TEST(CommandFilter, PassesCommandsThatEnetSendsForASession) {
  const std::vector<Bytes> usual{
      command(0x01, 0, 5, {{5, 2}, {100, 2}}),
      command(0x01, 0xff, 5, {{5, 2}, {100, 2}}),
      command(0x84, 0xff, 2, {{7, 4}}),
      command(0x44, 0xff, 0, {{7, 4}}),
      command(0x85, 0xff, 3),
      reliable(1),
      reliable(2, 1000),
      fragment(3, 0, 5000),
      fragment(3, 3, 5000),
      command(0x49, 1, 0, {{9, 2}, {0, 2}}),
      command(0x8a, 0xff, 4, {{0, 4}, {0, 4}}),
      command(0x8b, 0xff, 4, {{5000, 4}, {2, 4}, {0, 4}}),
  };
  for (std::size_t i = 0; i < usual.size(); ++i) {
    CommandFilter filter;
    Bytes bytes = usual[i];
    if (bytes[0] == std::byte{0x49}) {
      bytes[7] = std::byte{1};
      bytes.push_back(std::byte{0});
    }
    EXPECT_EQ(filter.admit(bytes, 0, false), Verdict::pass) << i;
    for (std::size_t size = 1; size < bytes.size(); ++size)
      EXPECT_EQ(filter.admit(ByteView(bytes).first(size), 0, false), Verdict::malformed) << i;
  }
}

TEST(CommandFilter, RefusesCommandsThatNoSessionSends) {
  const std::vector<Bytes> unusual{
      reliable(1, 0),                                     // nothing in it
      command(0x86, 1, 1, {{1, 2}, {0, 1}}),              // another channel
      command(0x06, 0, 1, {{1, 2}, {0, 1}}),              // not to be acknowledged
      command(0x07, 1, 0, {{1, 2}, {1, 2}, {0, 1}}),      // unreliable, which ENet sorts
      command(0x49, 1, 0, {{9, 2}, {0, 2}}),              // nothing in it
      command(0xc9, 1, 0, {{9, 2}, {1, 2}, {0, 1}}),      // to be acknowledged
      command(0x8a, 0xff, 1, {{1, 4}, {0, 4}}),           // a narrow connection
      command(0x8b, 0xff, 1, {{1, 4}, {0, 4}, {32, 4}}),  // a throttle that shuts
      command(0x83, 0xff, 1,
              {{0, 4},
               {1400, 4},
               {65536, 4},
               {2, 4},
               {0, 4},
               {0, 4},
               {5000, 4},
               {2, 4},
               {2, 4},
               {0, 4}}),  // an answer nobody waits for
      command(0x88, 0, 1, {{1, 2}, {0, 2}, {1000000, 4}, {0, 4}, {2000, 4}, {0, 4}}),
      command(0x88, 0, 1, {{1, 2}, {0, 2}, {2, 4}, {0, 4}, {0xffffffff, 4}, {0, 4}}),
      fragment(1, 0, k_enet_fragment_bytes),  // fits into one
  };
  for (std::size_t i = 0; i < unusual.size(); ++i) {
    CommandFilter filter;
    EXPECT_EQ(filter.admit(unusual[i], 0, false), Verdict::malformed) << i;
    EXPECT_EQ(filter.waiting(), 0U) << i;
  }
}

TEST(CommandFilter, TakesNoMoreCommandsThanEnetPutsIntoADatagram) {
  Bytes bytes;
  for (std::size_t i = 0; i < CommandFilter::k_max_commands; ++i) {
    const Bytes ping = command(0x85, 0xff, static_cast<std::uint16_t>(i));
    bytes.insert(bytes.end(), ping.begin(), ping.end());
  }
  CommandFilter filter;
  EXPECT_EQ(filter.admit(bytes, 0, false), Verdict::pass);
  const Bytes ping = command(0x85, 0xff, 99);
  bytes.insert(bytes.end(), ping.begin(), ping.end());
  EXPECT_EQ(filter.admit(bytes, 0, false), Verdict::malformed);
}

// Across the wrap of sequence numbers, too.
TEST(CommandFilter, LetsFewPacketsWaitBehindAGap) {
  for (const int number : {0, 1000, 0x7fff, 0xffe0, 0xffff}) {
    const auto delivered = static_cast<std::uint16_t>(number);
    CommandFilter filter;
    const auto after = [delivered](unsigned step) {
      return static_cast<std::uint16_t>(delivered + step);
    };
    for (unsigned i = 0; i < CommandFilter::k_max_waiting; ++i)
      ASSERT_EQ(filter.admit(reliable(after(2 + i)), delivered, false), Verdict::pass);
    EXPECT_EQ(filter.admit(reliable(after(2)), delivered, false), Verdict::pass);  // again
    EXPECT_EQ(filter.admit(reliable(after(500)), delivered, false), Verdict::too_far);
    EXPECT_EQ(filter.admit(reliable(delivered), delivered, false), Verdict::pass);  // old
    const std::uint16_t now = after(1 + CommandFilter::k_max_waiting);
    EXPECT_EQ(filter.admit(reliable(static_cast<std::uint16_t>(now + 2)), now, false),
              Verdict::pass);
    EXPECT_EQ(filter.waiting(), 1U);
    EXPECT_EQ(filter.admit(reliable(static_cast<std::uint16_t>(now + 5000)), now, false),
              Verdict::too_far);
  }
}

// Of a server's ticks, as many as fit into ENet's window of 64 KiB.
TEST(CommandFilter, LetsAWindowOfTicksWaitWhereThisSideCalled) {
  CommandFilter filter;
  constexpr std::uint16_t k_bytes = 1200;
  constexpr unsigned k_window = k_enet_window_bytes / k_bytes;
  for (unsigned i = 0; i < k_window; ++i) {
    const auto sequence = static_cast<std::uint16_t>(2 + i);
    ASSERT_EQ(filter.admit(reliable(sequence, k_bytes), 0, true), Verdict::pass) << i;
  }
  CommandFilter of_caller;
  std::size_t passed = 0;
  for (unsigned i = 0; i < 100; ++i) {
    const auto sequence = static_cast<std::uint16_t>(2 + i);
    if (of_caller.admit(reliable(sequence), 0, false) == Verdict::pass) ++passed;
  }
  EXPECT_EQ(passed, 32U);
}

TEST(CommandFilter, RefusesPacketsThatShareSequenceNumbers) {
  CommandFilter filter;
  EXPECT_EQ(filter.admit(fragment(10, 1, 5000), 0, false), Verdict::pass);  // 10 … 13
  EXPECT_EQ(filter.admit(reliable(13), 0, false), Verdict::malformed);
  EXPECT_EQ(filter.admit(fragment(9, 0, 2000), 0, false), Verdict::malformed);
  EXPECT_EQ(filter.admit(reliable(14), 0, false), Verdict::pass);
}

// Stands in for ENet's store: packets by their first number, delivered in order.
struct Store {
  std::map<std::uint16_t, std::uint16_t> counts;
  std::uint16_t delivered = 0;

  void add(std::uint16_t first, std::uint16_t count) {
    const auto ahead = static_cast<std::uint16_t>(first - delivered);
    if (ahead != 0 && ahead < 0x8000) counts.emplace(first, count);
    for (auto next = counts.find(static_cast<std::uint16_t>(delivered + 1)); next != counts.end();
         next = counts.find(static_cast<std::uint16_t>(delivered + 1))) {
      delivered = static_cast<std::uint16_t>(delivered + next->second);
      counts.erase(next);
    }
  }
};

TEST(CommandFilter, BoundsTheMemoryOfAnyRunOfHostileCommands) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    CommandFilter filter;
    Store store;
    store.delivered = static_cast<std::uint16_t>(random.below(65536));
    for (int i = 0; i < 5000; ++i) {
      const std::uint64_t reach = random.below(4) == 0 ? 65536 : 100;
      const auto first = static_cast<std::uint16_t>(store.delivered + random.below(reach));
      const bool whole = random.below(2) == 0;
      const auto total = static_cast<std::uint32_t>(k_enet_fragment_bytes + 1 + random.below(5000));
      const std::uint32_t count =
          whole ? 1 : (total + k_enet_fragment_bytes - 1) / k_enet_fragment_bytes;
      const Bytes bytes = whole ? reliable(first) : fragment(first, 0, total);
      if (filter.admit(bytes, store.delivered, false) != Verdict::pass) continue;
      store.add(first, static_cast<std::uint16_t>(count));
      ASSERT_LE(store.counts.size(), CommandFilter::k_max_waiting);
    }
  }
}

// A sender whose packets arrive late, twice or at the second try.
TEST(CommandFilter, RefusesNothingOfAnHonestSenderOnABadLine) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    CommandFilter filter;
    Store store;
    store.delivered = 0xff00;
    std::multimap<std::uint64_t, std::uint16_t> line;  // by time of arrival
    for (unsigned i = 0; i < 5000; ++i) {
      const auto sequence = static_cast<std::uint16_t>(0xff01 + i);
      std::uint64_t at = 40 * i + random.below(100);  // ms
      while (random.chance(100'000))
        at += 200;
      line.emplace(at, sequence);
      if (random.chance(50'000)) line.emplace(at + random.below(300), sequence);
    }
    for (const auto& [at, sequence] : line) {
      ASSERT_EQ(filter.admit(reliable(sequence), store.delivered, false), Verdict::pass);
      store.add(sequence, 1);
    }
    EXPECT_TRUE(store.counts.empty());
  }
}

}  // namespace
}  // namespace lockstone::net::test
