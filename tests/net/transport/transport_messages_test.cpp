// Packets that the program carries itself.
#include <gtest/gtest.h>

#include <lockstone/net/transport_messages.h>

namespace lockstone::net::test {
namespace {

std::vector<std::byte> message(unsigned channel, std::size_t payload) {
  std::vector<std::byte> bytes(1 + payload, std::byte{9});
  bytes[0] = static_cast<std::byte>(channel);
  return bytes;
}

struct Opened {
  Opened() : connection(transport.open()) {
    transport.opened();
    EXPECT_TRUE(transport.poll(0, event));
    EXPECT_EQ(event.kind, TransportEventKind::connected);
  }

  MessageTransport transport;
  ConnectionId connection;
  TransportEvent event;
};

TEST(MessageTransport, CarriesMessagesInBothDirections) {
  Opened end;
  EXPECT_TRUE(end.transport.receive(message(1, 5)));
  ASSERT_TRUE(end.transport.poll(0, end.event));
  EXPECT_EQ(end.event.channel, Channel::unreliable);
  EXPECT_EQ(end.event.bytes.size(), 5U);
  EXPECT_EQ(end.transport.send(end.connection, Channel::reliable, message(7, 2)), Status::ok);
  EXPECT_EQ(end.transport.next_message().size(), 4U);
  EXPECT_EQ(end.transport.next_message().front(), std::byte{0});
  end.transport.take_message();
  EXPECT_TRUE(end.transport.next_message().empty());
}

TEST(MessageTransport, BadMessagesEndTheConnection) {
  for (const auto& bad : {std::vector<std::byte>{}, message(0, 0), message(2, 5), message(1, 1300),
                          message(0, k_max_reliable_bytes + 100)}) {
    Opened end;
    EXPECT_FALSE(end.transport.receive(bad));
    EXPECT_FALSE(end.transport.is_open());
    ASSERT_TRUE(end.transport.poll(0, end.event));
    EXPECT_EQ(end.event.kind, TransportEventKind::disconnected);
    EXPECT_FALSE(end.transport.poll(0, end.event));
  }
}

TEST(MessageTransport, NeitherDirectionKeepsMoreThanItMay) {
  Opened end;
  bool taken = true;
  for (int i = 0; i < 1000 && taken; ++i)
    taken = end.transport.receive(message(0, k_max_reliable_bytes));
  EXPECT_FALSE(taken);
  Opened other;
  Status status = Status::ok;
  for (int i = 0; i < 1000 && status == Status::ok; ++i) {
    status = other.transport.send(other.connection, Channel::reliable,
                                  std::vector<std::byte>(k_max_reliable_bytes));
  }
  EXPECT_EQ(status, Status::capacity_exhausted);
  EXPECT_FALSE(other.transport.is_open());
}

TEST(MessageTransport, TheCodeOfTheEndIsTheReason) {
  Opened end;
  end.transport.closed(4000 + static_cast<unsigned>(RefuseReason::flooding));
  ASSERT_TRUE(end.transport.poll(0, end.event));
  EXPECT_EQ(end.event.reason, RefuseReason::flooding);
  EXPECT_EQ(end.transport.send(end.connection, Channel::reliable, message(0, 1)),
            Status::stale_handle);
}

TEST(MessageTransport, ANewConnectionHasANewNumberAndNothingOfTheOldOne) {
  Opened end;
  EXPECT_TRUE(end.transport.receive(message(0, 1)));
  EXPECT_EQ(end.transport.send(end.connection, Channel::reliable, message(0, 1)), Status::ok);
  const ConnectionId next = end.transport.open();
  EXPECT_NE(next, end.connection);
  EXPECT_FALSE(end.transport.poll(0, end.event));
  EXPECT_TRUE(end.transport.next_message().empty());
  end.transport.closed(1006);
  ASSERT_TRUE(end.transport.poll(0, end.event));
  EXPECT_EQ(end.event.connection, next);
}

TEST(MessageTransport, AfterTheSessionsEndTheRestIsStillThere) {
  Opened end;
  EXPECT_EQ(end.transport.send(end.connection, Channel::reliable, message(0, 1)), Status::ok);
  end.transport.disconnect(end.connection);
  EXPECT_TRUE(end.transport.is_open());
  EXPECT_FALSE(end.transport.next_message().empty());
  end.transport.take_message();
  EXPECT_FALSE(end.transport.is_open());
  EXPECT_FALSE(end.transport.poll(0, end.event));
}

}  // namespace
}  // namespace lockstone::net::test
