// Several transports as one.
#include <gtest/gtest.h>

#include <lockstone/net/transport_joined.h>
#include <lockstone/net/transport_sim.h>

namespace lockstone::net::test {
namespace {

struct TwoNetworks {
  SimNetwork first{1}, second{2};
  SimTransport& server_first = first.add_endpoint();
  SimTransport& server_second = second.add_endpoint();
  SimTransport& client_first = first.add_endpoint();
  SimTransport& client_second = second.add_endpoint();
  ConnectionId by_first = first.connect(client_first, server_first, {});
  ConnectionId by_second = second.connect(client_second, server_second, {});
  JoinedTransport joined{{&server_first, &server_second}};
};

TEST(JoinedTransport, GivesEachConnectionANumberOfItsOwnAndReachesItByThat) {
  TwoNetworks pair;
  std::vector<ConnectionId> connections;
  TransportEvent event;
  while (pair.joined.poll(0, event)) {
    EXPECT_EQ(event.kind, TransportEventKind::connected);
    connections.push_back(event.connection);
  }
  ASSERT_EQ(connections.size(), 2U);
  EXPECT_NE(connections[0], connections[1]);
  const std::array<std::byte, 1> bytes{std::byte{5}};
  EXPECT_EQ(pair.joined.send(connections[1], Channel::reliable, bytes), Status::ok);
  pair.joined.flush();
  EXPECT_EQ(pair.joined.stats(connections[0]).packets_sent, 0U);
  EXPECT_EQ(pair.joined.stats(connections[1]).packets_sent, 1U);
  EXPECT_TRUE(pair.client_second.poll(1, event));  // it is connected
  ASSERT_TRUE(pair.client_second.poll(1, event));
  EXPECT_EQ(event.bytes.front(), std::byte{5});
  pair.joined.disconnect(connections[1]);
  EXPECT_EQ(pair.joined.send(connections[1], Channel::reliable, bytes), Status::stale_handle);
}

TEST(JoinedTransport, NoPartKeepsTheOthersWaiting) {
  TwoNetworks pair;
  TransportEvent event;
  while (pair.joined.poll(0, event)) {
  }
  while (pair.client_first.poll(0, event) || pair.client_second.poll(0, event)) {
  }
  const std::array<std::byte, 1> bytes{};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(pair.client_first.send(pair.by_first, Channel::reliable, bytes), Status::ok);
    EXPECT_EQ(pair.client_second.send(pair.by_second, Channel::reliable, bytes), Status::ok);
  }
  ConnectionId last = k_no_connection;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(pair.joined.poll(1, event));
    EXPECT_NE(event.connection, last);
    last = event.connection;
  }
}

TEST(JoinedTransport, UnknownConnectionsAreStale) {
  TwoNetworks pair;
  const std::array<std::byte, 1> bytes{};
  const ConnectionId nowhere = ConnectionId{3} << k_connection_bits;
  EXPECT_EQ(pair.joined.send(nowhere, Channel::reliable, bytes), Status::stale_handle);
  EXPECT_EQ(pair.joined.stats(nowhere).packets_sent, 0U);
  EXPECT_FALSE(pair.joined.identity(nowhere).authenticated);
  EXPECT_FALSE(pair.joined.secure());
}

}  // namespace
}  // namespace lockstone::net::test
