// The parts of a client, each alone.
#include <gtest/gtest.h>

#include "net/session/client/client_end.h"
#include "net/session/client/lead_clock.h"
#include "net/session/client/own_inputs.h"
#include "net/session/client/tick_buffer.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_history = 256;

TickBuffer buffer_with(std::initializer_list<std::uint64_t> ticks) {
  TickBuffer buffer(k_history, 1);
  const std::array<std::byte, 1> record{};
  for (const std::uint64_t tick : ticks)
    buffer.put(tick, record);
  while (buffer.advance()) {
  }
  return buffer;
}

TEST(TickBuffer, IsCompleteUpToTheFirstGap) {
  TickBuffer buffer = buffer_with({0, 1, 3});
  EXPECT_EQ(buffer.received(), 2U);
  buffer.put(2, std::array<std::byte, 1>{});
  EXPECT_TRUE(buffer.advance());
  EXPECT_TRUE(buffer.advance());
  EXPECT_FALSE(buffer.advance());
  EXPECT_EQ(buffer.received(), 4U);
}

TEST(TickBuffer, AsksForAllGapsAtOnceWhenTheFirstIsOld) {
  TickBuffer buffer = buffer_with({0, 2, 4, 5});
  EXPECT_FALSE(buffer.missing(1'000'000, 0)) << "it may only be late";
  EXPECT_FALSE(buffer.missing(1'029'999, 0));
  const std::optional<Resend> request = buffer.missing(1'030'000, 0);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->first_tick, 1U);
  EXPECT_EQ(request->count, 3U) << "ticks 1 and 3, and 2 between them";
  EXPECT_FALSE(buffer.missing(1'100'000, 50'000)) << "the answer may be on its way";
  EXPECT_TRUE(buffer.missing(1'180'000, 50'000));
}

TEST(TickBuffer, AsksForNothingWhereNothingLacks) {
  TickBuffer buffer = buffer_with({0, 1, 2});
  EXPECT_FALSE(buffer.missing(0, 0));
  EXPECT_FALSE(buffer.missing(10'000'000, 0));
}

TEST(TickBuffer, GoesOnWithTheTicksThatAreHereAfterARestart) {
  TickBuffer buffer = buffer_with({5, 6});
  EXPECT_EQ(buffer.received(), 0U);
  buffer.restart(5, 0);
  EXPECT_EQ(buffer.received(), 7U);
  buffer.clear(0);
  buffer.restart(5, 0);
  EXPECT_EQ(buffer.received(), 5U);
}

struct CountingSource final : InputSource {
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    ticks.push_back(tick);
    out[0] = static_cast<std::byte>(tick);
  }
  std::vector<std::uint64_t> ticks;
};

TEST(OwnInputs, AreSampledOnceForEachTickAfterTheDelay) {
  CountingSource source;
  OwnInputs inputs(1);
  inputs.begin(4);
  EXPECT_TRUE(inputs.sample(6, source));
  EXPECT_FALSE(inputs.sample(6, source));
  EXPECT_TRUE(inputs.sample(7, source));
  EXPECT_EQ(source.ticks, (std::vector<std::uint64_t>{4, 5, 6}));
  EXPECT_EQ(inputs.find(5)[0], std::byte{5});
  EXPECT_FALSE(inputs.has(3));
}

TEST(OwnInputs, AreNotSampledForTicksThatTheServerHasReplaced) {
  CountingSource source;
  OwnInputs inputs(1);
  inputs.acknowledge(10);
  EXPECT_EQ(inputs.acknowledged(), 10U);
  EXPECT_TRUE(inputs.sample(12, source));
  EXPECT_EQ(source.ticks, (std::vector<std::uint64_t>{10, 11}));
  inputs.acknowledge(5);
  EXPECT_EQ(inputs.acknowledged(), 10U) << "an older packet that was overtaken";
}

TEST(LeadClock, RunsAtTheTickRateAndAtTheTrim) {
  LeadClock clock;
  clock.restart(100, 5'000'000);
  clock.advance(6'000'000, 0);
  EXPECT_EQ(clock.tick(60), 160U);
  clock.advance(7'000'000, 50'000);
  EXPECT_EQ(clock.tick(60), 223U) << "5 % of 60 ticks are 3";
}

TEST(LeadClock, GoesOnFromTheTickThatItIsSetTo) {
  LeadClock clock;
  clock.restart(0, 0);
  clock.advance(1'000'000, 0);
  clock.set_tick(20);
  EXPECT_EQ(clock.tick(60), 20U);
  clock.advance(1'500'000, 0);
  EXPECT_EQ(clock.tick(60), 50U);
}

TEST(ClientEnd, AllowsANewConnectionForALostOneAndNotAfterADismissal) {
  ClientStatus status;
  EXPECT_FALSE(may_reconnect(status)) << "it is connecting";
  status.state = ClientState::failed;
  for (const ClientFailure lost : {ClientFailure::connection_lost, ClientFailure::server_silent,
                                   ClientFailure::handshake_timed_out}) {
    status.failure = lost;
    EXPECT_TRUE(may_reconnect(status)) << to_string(lost);
  }
  status.failure = ClientFailure::dropped;
  status.leave_reason = LeaveReason::too_far_behind;
  EXPECT_TRUE(may_reconnect(status));
  status.leave_reason = LeaveReason::desync;
  EXPECT_FALSE(may_reconnect(status));
}

}  // namespace
}  // namespace lockstone::net
