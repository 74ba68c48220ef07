#include <gtest/gtest.h>

#include <lockstone/net/transport_sim.h>

namespace lockstone::net {
namespace {

struct Arrival {
  std::int64_t at_us;
  int number;
  friend bool operator==(const Arrival&, const Arrival&) = default;
};

// Sends `count` numbered packets, one a millisecond, and returns the arrivals with their times.
std::vector<Arrival> arrivals(std::uint64_t seed, const LinkFaults& faults, Channel channel,
                              int count, std::pair<std::int64_t, std::int64_t> cut = {0, 0}) {
  SimNetwork network(seed);
  SimTransport& a = network.add_endpoint();
  SimTransport& b = network.add_endpoint();
  const ConnectionId connection = network.connect(a, b, faults);
  network.partition(b, cut.first, cut.second);
  std::vector<Arrival> result;
  TransportEvent event;
  for (std::int64_t now_us = 0; now_us < 20'000'000; now_us += 1000) {
    while (a.poll(now_us, event)) {
    }
    const auto number = static_cast<int>(now_us / 1000);
    const std::array<std::byte, 2> bytes{static_cast<std::byte>(number & 255),
                                         static_cast<std::byte>(number >> 8)};
    if (number < count) {
      EXPECT_EQ(a.send(connection, channel, bytes), Status::ok);
    }
    while (b.poll(now_us, event)) {
      if (event.kind != TransportEventKind::received) continue;
      const int low = std::to_integer<int>(event.bytes[0]);
      const int high = event.bytes.size() > 1 ? std::to_integer<int>(event.bytes[1]) : 0;
      result.push_back({now_us, low | (high << 8)});
    }
  }
  return result;
}

TEST(SimTransport, DeliversInOrderAfterTheDelayWithoutFaults) {
  LinkFaults faults;
  faults.delay_us = 50'000;
  const std::vector<Arrival> got = arrivals(1, faults, Channel::unreliable, 100);
  ASSERT_EQ(got.size(), 100U);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(got[static_cast<std::size_t>(i)], (Arrival{50'000 + i * 1000, i}));
  }
}

TEST(SimTransport, LosesAboutTheShareOfPacketsThatItIsTold) {
  LinkFaults faults;
  faults.loss_ppm = 300'000;
  const std::size_t got = arrivals(2, faults, Channel::unreliable, 10'000).size();
  EXPECT_GT(got, 6800U);
  EXPECT_LT(got, 7200U);
}

TEST(SimTransport, LosesInBursts) {
  LinkFaults faults;
  faults.burst_start_ppm = 10'000;
  const std::vector<Arrival> got = arrivals(3, faults, Channel::unreliable, 10'000);
  int gaps = 0;
  for (std::size_t i = 1; i < got.size(); ++i)
    gaps += got[i].number != got[i - 1].number + 1;
  const auto lost = 10'000 - static_cast<int>(got.size());
  EXPECT_GT(lost, 200);
  EXPECT_GT(lost, 2 * gaps);  // several packets a gap
}

TEST(SimTransport, DuplicatesAndReorders) {
  LinkFaults faults;
  faults.duplicate_ppm = 200'000;
  faults.reorder_ppm = 200'000;
  const std::vector<Arrival> got = arrivals(4, faults, Channel::unreliable, 1000);
  EXPECT_GT(got.size(), 1100U);
  int backwards = 0;
  for (std::size_t i = 1; i < got.size(); ++i)
    backwards += got[i].number < got[i - 1].number;
  EXPECT_GT(backwards, 50);
}

TEST(SimTransport, ReliableChannelIsCompleteAndInOrderWhateverHappens) {
  LinkFaults faults;
  faults.loss_ppm = 300'000;
  faults.duplicate_ppm = 100'000;
  faults.reorder_ppm = 300'000;
  faults.delay_us = 20'000;
  faults.jitter_us = 50'000;
  const std::vector<Arrival> got =
      arrivals(5, faults, Channel::reliable, 1000, {200'000, 1'500'000});
  ASSERT_EQ(got.size(), 1000U);
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(got[static_cast<std::size_t>(i)].number, i);
}

TEST(SimTransport, PartitionLosesUnreliablePacketsAndHeals) {
  const std::vector<Arrival> got = arrivals(6, {}, Channel::unreliable, 1000, {300'000, 500'000});
  EXPECT_EQ(got.size(), 800U);
}

TEST(SimTransport, SameSeedGivesTheSameNetworkAndAnotherDoesNot) {
  LinkFaults faults;
  faults.loss_ppm = 100'000;
  faults.jitter_us = 30'000;
  const auto first = arrivals(7, faults, Channel::unreliable, 500);
  EXPECT_TRUE(first == arrivals(7, faults, Channel::unreliable, 500));
  EXPECT_FALSE(first == arrivals(8, faults, Channel::unreliable, 500));
}

TEST(SimTransport, OneFaultDoesNotDisturbTheDrawsOfAnother) {
  LinkFaults faults;
  faults.loss_ppm = 100'000;
  const auto plain = arrivals(9, faults, Channel::unreliable, 500);
  faults.delay_us = 10'000;
  const auto delayed = arrivals(9, faults, Channel::unreliable, 500);
  ASSERT_EQ(plain.size(), delayed.size());
  for (std::size_t i = 0; i < plain.size(); ++i)
    EXPECT_EQ(plain[i].number, delayed[i].number);
}

TEST(SimTransport, DisconnectArrivesAfterEarlierPackets) {
  SimNetwork network(1);
  SimTransport& a = network.add_endpoint();
  SimTransport& b = network.add_endpoint();
  const ConnectionId connection = network.connect(a, b, {});
  const std::array<std::byte, 1> bytes{};
  TransportEvent event;
  while (b.poll(0, event)) {
  }
  EXPECT_EQ(a.send(connection, Channel::reliable, bytes), Status::ok);
  a.disconnect(connection);
  EXPECT_EQ(a.send(connection, Channel::reliable, bytes), Status::stale_handle);
  ASSERT_TRUE(b.poll(1, event));
  EXPECT_EQ(event.kind, TransportEventKind::received);
  ASSERT_TRUE(b.poll(1, event));
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_FALSE(b.poll(1, event));
}

TEST(SimTransport, RefusesEmptyAndTooLongPackets) {
  SimNetwork network(1);
  SimTransport& a = network.add_endpoint();
  const ConnectionId connection = network.connect(a, network.add_endpoint(), {});
  const std::vector<std::byte> bytes(k_max_reliable_bytes + k_carrier_reserve_bytes + 1);
  EXPECT_EQ(a.send(connection, Channel::reliable, {}), Status::invalid_argument);
  EXPECT_EQ(a.send(connection, Channel::reliable, bytes), Status::invalid_argument);
  EXPECT_EQ(a.send(connection, Channel::unreliable,
                   ByteView(bytes).first(k_max_datagram_bytes + k_carrier_reserve_bytes + 1)),
            Status::invalid_argument);
  EXPECT_EQ(a.send(99, Channel::reliable, ByteView(bytes).first(1)), Status::stale_handle);
}

}  // namespace
}  // namespace lockstone::net
