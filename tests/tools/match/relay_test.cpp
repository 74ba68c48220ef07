#include <map>

#include <gtest/gtest.h>

#include "tests/support/await.h"
#include "tools/relay/lossy_relay.h"

namespace lockstone::relay {
namespace {

using test::await;

// A server and a client with the relay between them; time is made up.
struct Line {
  explicit Line(const Faults& faults)
      : server(UdpSocket::open(Endpoint::loopback(0)).value()),
        client(UdpSocket::open(Endpoint::loopback(0)).value()),
        relay(LossyRelay::open(Endpoint::loopback(0), Endpoint::loopback(server->port()), faults, 7)
                  .value()) {}

  // The arrivals at the server of `count` numbered datagrams, one a millisecond: times by number.
  std::multimap<unsigned, std::int64_t> send(unsigned count) {
    std::multimap<unsigned, std::int64_t> arrived;
    for (std::int64_t now_us = 0; now_us < count * 1000 + 200'000; now_us += 1000) {
      const auto number = static_cast<unsigned>(now_us / 1000);
      const std::array bytes{static_cast<std::byte>(number & 255),
                             static_cast<std::byte>(number >> 8), std::byte{1}, std::byte{2}};
      if (number < count) client->send(Endpoint::loopback(relay->port()), bytes);
      const unsigned sent = std::min(number + 1, count);
      await([&] { return relay->pump(now_us), relay->counters().received >= sent; });
      await([&] {
        take(arrived, now_us);
        return arrived.size() + damaged >= relay->counters().delivered;
      });
    }
    return arrived;
  }

  // Takes the datagrams that are at the server by now.
  void take(std::multimap<unsigned, std::int64_t>& arrived, std::int64_t now_us) {
    std::array<std::byte, 4096> buffer{};
    Endpoint from;
    while (const auto got = server->receive(from, buffer)) {
      last = from;
      if (got->size() != 4 || (*got)[2] != std::byte{1} || (*got)[3] != std::byte{2}) {
        ++damaged;
        continue;
      }
      arrived.emplace(
          std::to_integer<unsigned>((*got)[0]) + 256 * std::to_integer<unsigned>((*got)[1]),
          now_us);
    }
  }

  std::unique_ptr<UdpSocket> server, client;
  std::unique_ptr<LossyRelay> relay;
  Endpoint last;
  unsigned damaged = 0;
};

TEST(LossyRelay, PassesOnBothWays) {
  Line line({});
  EXPECT_EQ(line.send(5).size(), 5U);
  EXPECT_TRUE(line.server->send(line.last, std::array{std::byte{9}}));
  await([&] { return line.relay->pump(1'000'000), line.relay->counters().delivered >= 6; });
  std::array<std::byte, 16> buffer{};
  Endpoint from;
  std::optional<ByteView> got;
  await([&] { return (got = line.client->receive(from, buffer)).has_value(); });
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ((*got)[0], std::byte{9});
  EXPECT_EQ(from.port, line.relay->port());
}

TEST(LossyRelay, LosesTheShareInRunsOfTheLength) {
  Faults faults;
  faults.loss_ppm = 50'000;
  faults.burst_packets = 4;
  Line line(faults);
  constexpr unsigned k_count = 20'000;
  const auto arrived = line.send(k_count);
  unsigned lost = 0, runs = 0;
  bool before = false;
  for (unsigned i = 0; i < k_count; ++i) {
    const bool missing = arrived.count(i) == 0;
    lost += missing ? 1 : 0;
    runs += missing && !before ? 1 : 0;
    before = missing;
  }
  EXPECT_NEAR(lost, 1000, 200);
  EXPECT_NEAR(static_cast<double>(lost) / runs, 4, 1);
  EXPECT_EQ(line.relay->counters().lost, lost);
}

TEST(LossyRelay, DelaysWithinItsJitterAndDoubles) {
  Faults faults;
  faults.delay_us = 50'000;
  faults.jitter_us = 15'000;
  faults.duplicate_ppm = 500'000;
  Line line(faults);
  const auto arrived = line.send(500);
  EXPECT_NEAR(static_cast<double>(arrived.size()), 750, 60);
  for (const auto& [number, at_us] : arrived) {
    EXPECT_GE(at_us - number * 1000, 35'000);
    EXPECT_LE(at_us - number * 1000, 66'000);
  }
}

TEST(LossyRelay, DamagesTheShare) {
  Faults faults;
  faults.flip_ppm = 200'000;
  faults.truncate_ppm = 100'000;
  Line line(faults);
  line.send(1000);
  EXPECT_NEAR(static_cast<double>(line.relay->counters().flipped), 200, 60);
  EXPECT_NEAR(static_cast<double>(line.relay->counters().truncated), 100, 50);
  EXPECT_GT(line.damaged, 100U);
}

}  // namespace
}  // namespace lockstone::relay
