// The parts of a server, each alone.
#include <gtest/gtest.h>

#include "net/session/server/data/keyframe_store.h"
#include "net/session/server/data/resume_wait.h"
#include "net/session/server/data/roster.h"
#include "net/session/server/data/tick_schedule.h"
#include "net/session/server/desync/dumps.h"
#include "net/session/server/leaving/departures.h"
#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

constexpr SimulationInfo k_two_players{.player_count = 2, .input_bytes = 4};

TEST(TickSchedule, CountsFromTheTickThatWasSetSoThatRoundingDoesNotAddUp) {
  TickSchedule schedule(60);
  schedule.rebase(10, 1'000);
  EXPECT_EQ(schedule.due_us(10), 1'000);
  EXPECT_EQ(schedule.due_us(11), 1'000 + 16'666);
  EXPECT_EQ(schedule.due_us(13), 1'000 + 50'000);
  EXPECT_EQ(schedule.due_us(7), 1'000 - 50'000);
}

TEST(ResumeWait, EndsWhenAllWhoAreExpectedAreBack) {
  ResumeWait wait(1'000);
  EXPECT_TRUE(wait.is_over());
  wait.begin(0b101);
  EXPECT_FALSE(wait.advance(0b001, 10));
  EXPECT_TRUE(wait.advance(0b111, 20));
  EXPECT_TRUE(wait.is_over());
  EXPECT_FALSE(wait.advance(0b111, 30)) << "it ends once";
}

TEST(ResumeWait, GivesTheOthersALimitedTimeFromTheFirstOneOn) {
  ResumeWait wait(1'000);
  wait.begin(0b11);
  EXPECT_FALSE(wait.advance(0, 5'000)) << "nobody is back";
  EXPECT_FALSE(wait.advance(0b01, 6'000));
  EXPECT_FALSE(wait.advance(0b01, 7'000));
  EXPECT_TRUE(wait.advance(0b01, 7'001));
}

TEST(Roster, ListsThoseWhoAreHereAndThoseWhoPlay) {
  Peer player;
  ServerConfig config;
  config.max_spectators = 1;
  Roster roster(k_two_players, config);
  EXPECT_EQ(roster.present_mask(), 0);
  roster.seat(1).occupy(player, 0);
  player.slot = 1;
  EXPECT_EQ(roster.present_mask(), 0b10);
  EXPECT_EQ(roster.active_mask(), 0);
  roster.seat(1).active_tick = 7;
  EXPECT_EQ(roster.active_mask(), 0b10);
  EXPECT_FALSE(roster.seat(1).plays(6));
  EXPECT_TRUE(roster.seat(1).plays(7));
  EXPECT_EQ(roster.follower_of(player), &roster.seat(1));
  roster.forget(player);
  EXPECT_EQ(roster.present_mask(), 0);
}

TEST(Roster, FindsASpectatorByItsPeer) {
  Peer spectator;
  spectator.slot = k_spectator_slot;
  ServerConfig config;
  config.max_spectators = 1;
  Roster roster(k_two_players, config);
  EXPECT_EQ(roster.follower_of(spectator), nullptr);
  Watcher* place = roster.free_watcher();
  ASSERT_NE(place, nullptr);
  place->peer = &spectator;
  EXPECT_EQ(roster.free_watcher(), nullptr);
  EXPECT_EQ(roster.follower_of(spectator), place);
  EXPECT_EQ(roster.watching(), 1U);
  roster.forget(spectator);
  EXPECT_EQ(roster.watching(), 0U);
}

TEST(Follower, NeedsTicksOnceItHasAStateOrIsSentOne) {
  Peer peer;
  Follower follower;
  EXPECT_FALSE(follower.needs_ticks());
  follower.peer = &peer;
  EXPECT_TRUE(follower.needs_ticks());
  follower.await_state(5);
  EXPECT_FALSE(follower.needs_ticks());
  follower.begin_snapshot(8, false);
  EXPECT_TRUE(follower.needs_ticks());
  EXPECT_EQ(follower.ticks_received, 8U);
}

TEST(Peers, GiveNoPlaceToOneMoreThanFit) {
  SimNetwork network(1);
  SimTransport& transport = network.add_endpoint();
  Peers peers(transport, 2);
  Peer* first = peers.open(1, 10);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->stage, Stage::connected);
  EXPECT_FALSE(first->is_admitted());
  EXPECT_NE(peers.open(2, 10), nullptr);
  EXPECT_EQ(peers.open(3, 10), nullptr);
  EXPECT_EQ(peers.find(1), first);
  EXPECT_EQ(peers.find(3), nullptr);
  *first = {};
  EXPECT_EQ(peers.find(1), nullptr);
  EXPECT_EQ(peers.open(3, 10), first);
}

TEST(KeyframeStore, KeepsTheStatesAtMultiplesOfItsInterval) {
  ToySimulation simulation(ToyConfig{});
  const std::vector<std::byte> zeros(simulation.info().input_bytes);
  PlayerInput neutral;
  neutral.bytes = zeros;
  const std::vector<PlayerInput> inputs(simulation.info().player_count, neutral);
  KeyframeStore store(4, 8, simulation.snapshot_bytes_max(SnapshotKind::canonical));
  std::uint64_t hash = 0;
  for (int i = 0; i < 9; ++i) {
    simulation.step(inputs);
    store.note(simulation);
    if (simulation.tick() == 8) hash = simulation.hash();
  }
  EXPECT_EQ(store.at_or_before(9), 8U);
  EXPECT_TRUE(store.has(4) && store.has(8));
  EXPECT_FALSE(store.has(12));
  EXPECT_EQ(store.hash_of(8), hash);
  ToySimulation other(ToyConfig{});
  ASSERT_EQ(other.load(SnapshotKind::canonical, store.find(8)), Status::ok);
  EXPECT_EQ(other.hash(), hash);
}

TEST(KeyframeStore, KeepsNothingWhereItIsNotUsed) {
  ToySimulation simulation(ToyConfig{});
  KeyframeStore store(60, 0, 0);
  store.note(simulation);
  EXPECT_FALSE(store.is_used());
  EXPECT_FALSE(store.has(0));
}

Dump piece_of(ByteView whole, std::size_t offset, std::size_t size) {
  return {0, static_cast<std::uint32_t>(whole.size()), static_cast<std::uint32_t>(offset),
          whole.subspan(offset, size)};
}

TEST(DumpTransfer, IsDoneWhenAllPiecesCameInOrder) {
  const std::vector<std::byte> whole(10, std::byte{7});
  DumpTransfer transfer;
  EXPECT_TRUE(transfer.append(piece_of(whole, 0, 6), 10));
  EXPECT_FALSE(transfer.done);
  EXPECT_FALSE(transfer.append(piece_of(whole, 7, 3), 10)) << "a gap";
  EXPECT_TRUE(transfer.append(piece_of(whole, 6, 4), 10));
  EXPECT_TRUE(transfer.done);
  EXPECT_EQ(transfer.bytes, whole);
}

TEST(DumpTransfer, RefusesMoreThanTheLimitAndAnotherLength) {
  const std::vector<std::byte> whole(10, std::byte{7});
  DumpTransfer transfer;
  EXPECT_FALSE(transfer.append(piece_of(whole, 0, 6), 9));
  EXPECT_TRUE(transfer.append(piece_of(whole, 0, 6), 10));
  Dump other = piece_of(whole, 6, 4);
  other.total_bytes = 9;
  EXPECT_FALSE(transfer.append(other, 10));
}

TEST(DumpRequests, AdmitNoMoreBytesThanWereAskedFor) {
  const std::vector<std::byte> whole(100);
  Seat seat;
  EXPECT_FALSE(DumpRequests::admit(seat, piece_of(whole, 0, 1))) << "nothing was asked for";
  seat.dump_bytes_allowed = 200;
  EXPECT_TRUE(DumpRequests::admit(seat, piece_of(whole, 0, 100)));
  EXPECT_FALSE(DumpRequests::admit(seat, piece_of(whole, 0, 100)));
}

// A server's data with nobody in it, over a network without packets.
struct EmptyServer {
  EmptyServer() {
    data.match.state = ServerState::running;
    data.match.now_us = 1'000'000;
  }
  static ServerConfig config() {
    ServerConfig made;
    made.insecure = true;
    made.info = k_two_players;
    return made;
  }
  SimNetwork network{1};
  SimTransport& transport = network.add_endpoint();
  ServerData data{config(), {.transport = &transport}};
  DumpRequests dumps{data};
  DesyncCases cases{data, dumps};
  MatchEnd end{data, cases};
  Departures departures{data, cases, end};
};

TEST(MatchEnd, WaitsForAPlayerWhoseSeatIsReserved) {
  EmptyServer server;
  server.data.roster.seat(0).reserved_until_us = 1'500'000;
  server.end.finish_if_deserted();
  EXPECT_EQ(server.data.match.state, ServerState::running);
  server.data.match.now_us = 1'500'000;
  server.end.finish_if_deserted();
  EXPECT_EQ(server.data.match.state, ServerState::closing);
  EXPECT_EQ(server.data.match.finish_reason, FinishReason::no_players);
}

TEST(Departures, ReserveTheSeatOfALostPlayerAndNotThatOfAnExpelledOne) {
  EmptyServer server;
  for (std::uint8_t slot = 0; slot < 2; ++slot) {
    Peer* peer = server.data.peers.open(slot + 1U, 0);
    peer->slot = slot;
    peer->stage = Stage::seated;
    Seat& seat = server.data.roster.seat(slot);
    seat.occupy(*peer, 0);
    seat.rejoin_key = 5;
    seat.confirmed = true;
  }
  Seat& lost = server.data.roster.seat(0);
  server.departures.connection_ended(*lost.peer, RefuseReason::none);
  EXPECT_EQ(lost.peer, nullptr);
  EXPECT_EQ(lost.rejoin_key, 5U);
  EXPECT_GT(lost.reserved_until_us, server.data.match.now_us);
  Seat& expelled = server.data.roster.seat(1);
  server.departures.expel(1, LeaveReason::malformed);
  EXPECT_EQ(expelled.rejoin_key, 0U);
  EXPECT_LE(expelled.reserved_until_us, server.data.match.now_us);
  EXPECT_TRUE(server.data.offenders.is_banned(expelled.identity, 1));
  EXPECT_EQ(server.data.counters.expelled, 1U);
}

TEST(DesyncCases, FreezeTheMatchOnlyWhereItEndsWithThem) {
  EmptyServer server;
  DesyncCase& found = server.cases.add();
  found.there.slot = 1;
  found.mismatch.tick = 4;
  EXPECT_FALSE(server.cases.freeze_match());
  found.ends_match = true;
  EXPECT_TRUE(server.cases.freeze_match());
  EXPECT_TRUE(server.cases.concern(1));
  EXPECT_EQ(server.cases.transfer_of(1, 4), &found.there);
  server.cases.give_up_on(1);
  EXPECT_TRUE(found.there.done);
  EXPECT_EQ(server.cases.transfer_of(1, 4), nullptr);
}

}  // namespace
}  // namespace lockstone::net::test
