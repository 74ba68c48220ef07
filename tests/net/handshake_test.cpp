#include <gtest/gtest.h>

#include <lockstone/net/wire.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

// A server in an empty lobby, and clients of any kind.
class Handshake : public ::testing::Test {
 protected:
  Handshake() : transport_(network_.add_endpoint()), simulation_(toy_), inputs_(1, 0) {
    ServerConfig config;
    config.insecure = true;
    config.match_config = toy_.encode();
    ServerParts parts;
    parts.transport = &transport_;
    parts.simulation = &simulation_;
    parts.observer = &log_;
    server_ = std::move(Server::create(config, parts).server);
  }

  // A client whose simulation says `info` of itself.
  Client& add_client(std::optional<SimulationInfo> info = std::nullopt,
                     std::uint8_t slot = k_no_slot) {
    ClientConfig config;
    config.insecure = true;
    config.name = "Ann";
    config.wanted_slot = slot;
    ClientParts parts;
    SimTransport& endpoint = network_.add_endpoint();
    parts.transport = &endpoint;
    parts.connection = network_.connect(endpoint, transport_, {});
    parts.inputs = &inputs_;
    parts.factory = [info](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
      const Result<ToyConfig> toy = ToyConfig::decode(bytes);
      if (!toy) return toy.status();
      auto simulation = std::make_unique<ToySimulation>(toy.value());
      if (info) simulation->override_info(*info);
      return std::unique_ptr<Simulation>(std::move(simulation));
    };
    clients_.push_back(std::move(Client::create(config, std::move(parts)).client));
    return *clients_.back();
  }

  // Sends one packet as somebody who is not a client of ours.
  void say(ByteView packet) {
    SimTransport& endpoint = network_.add_endpoint();
    const ConnectionId connection = network_.connect(endpoint, transport_, {});
    EXPECT_EQ(endpoint.send(connection, Channel::reliable, packet), Status::ok);
  }

  void run_for(std::int64_t span_us) {
    for (const std::int64_t end_us = now_us_ + span_us; now_us_ < end_us; now_us_ += 10'000) {
      server_->update(now_us_);
      for (auto& client : clients_)
        client->update(now_us_);
    }
  }

  void expect_refused(const SimulationInfo& info, RefuseField field, std::uint64_t here,
                      std::uint64_t there) {
    const Client& client = add_client(info);
    run_for(k_second_us);
    ASSERT_EQ(client.state(), ClientState::refused);
    EXPECT_EQ(client.refusal().reason, RefuseReason::simulation_mismatch);
    EXPECT_EQ(client.refusal().field, field);
    EXPECT_EQ(client.refusal().here, here);
    EXPECT_EQ(client.refusal().there, there);
    EXPECT_EQ(log_.refusals.size(), 1U);
    EXPECT_EQ(server_->present_mask(), 0);
  }

  ToyConfig toy_;
  SimNetwork network_{1};
  SimTransport& transport_;
  ToySimulation simulation_;
  ScriptedInputs inputs_;
  ServerLog log_;
  std::unique_ptr<Server> server_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::int64_t now_us_ = 0;
};

TEST_F(Handshake, SeatsAnEqualClient) {
  const Client& client = add_client();
  run_for(k_second_us);
  EXPECT_EQ(client.state(), ClientState::lobby);
  EXPECT_EQ(client.slot(), 0);
  EXPECT_EQ(server_->present_mask(), 1);
}

TEST_F(Handshake, SeatsWhereItWasWished) {
  const Client& client = add_client(std::nullopt, 1);
  run_for(k_second_us);
  EXPECT_EQ(client.slot(), 1);
}

TEST_F(Handshake, RefusesAnotherAbiAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.abi = 42;
  expect_refused(info, RefuseField::abi, 1, 42);
}

TEST_F(Handshake, RefusesAnotherConfigHashAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.config_hash ^= 1;
  expect_refused(info, RefuseField::config_hash, simulation_.info().config_hash, info.config_hash);
}

TEST_F(Handshake, RefusesAnotherSceneHashAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.scene_hash = 5;
  expect_refused(info, RefuseField::scene_hash, simulation_.info().scene_hash, 5);
}

TEST_F(Handshake, RefusesAnotherCanaryAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.canary += 1;
  expect_refused(info, RefuseField::canary, simulation_.info().canary, info.canary);
}

TEST_F(Handshake, RefusesAnotherTickRateAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.tick_rate = 30;
  expect_refused(info, RefuseField::tick_rate, 60, 30);
}

TEST_F(Handshake, RefusesAnotherPlayerCountAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.player_count = 3;
  expect_refused(info, RefuseField::player_count, 2, 3);
}

TEST_F(Handshake, RefusesAnotherInputSizeAndNamesBothValues) {
  SimulationInfo info = simulation_.info();
  info.input_bytes = 8;
  expect_refused(info, RefuseField::input_bytes, 4, 8);
}

TEST_F(Handshake, RefusesAnotherProtocolVersionAndNamesBothValues) {
  std::array<std::byte, 64> bytes{};
  say(ByteView(bytes).first(encode(Hello{7, true, k_any_slot, 0, 0, 0, {}, {}}, bytes)));
  run_for(k_second_us);
  ASSERT_EQ(log_.refusals.size(), 1U);
  EXPECT_EQ(log_.refusals[0].to_line(),
            "refused: protocol mismatch, protocol: 0x0000000000000005 here, "
            "0x0000000000000007 there");
}

TEST_F(Handshake, RefusesAClientThatDidNotAskForInsecure) {
  std::array<std::byte, 64> bytes{};
  say(ByteView(bytes).first(encode(Hello{}, bytes)));
  run_for(k_second_us);
  ASSERT_EQ(log_.refusals.size(), 1U);
  EXPECT_EQ(log_.refusals[0].reason, RefuseReason::insecure_not_allowed);
  EXPECT_EQ(log_.refusals[0].field, RefuseField::insecure);
}

TEST_F(Handshake, RefusesATakenSlotButNotAnother) {
  add_client(std::nullopt, 0);
  run_for(k_second_us);
  const Client& second = add_client(std::nullopt, 0);
  run_for(k_second_us);
  EXPECT_EQ(second.refusal().reason, RefuseReason::slot_taken);
  const Client& third = add_client(std::nullopt, 1);
  run_for(k_second_us);
  EXPECT_EQ(third.state(), ClientState::running);
}

TEST_F(Handshake, RefusesASlotThatDoesNotExist) {
  const Client& client = add_client(std::nullopt, 9);
  run_for(k_second_us);
  EXPECT_EQ(client.refusal().field, RefuseField::slot);
  EXPECT_EQ(client.refusal().there, 9U);
}

TEST_F(Handshake, RefusesWhoComesAfterTheStart) {
  add_client();
  add_client();
  run_for(k_second_us);
  EXPECT_EQ(server_->state(), ServerState::running);
  const Client& late = add_client();
  run_for(k_second_us);
  EXPECT_EQ(late.refusal().reason, RefuseReason::match_full);
}

TEST_F(Handshake, TimesOutOnASilentPeer) {
  SimTransport& endpoint = network_.add_endpoint();
  network_.connect(endpoint, transport_, {});
  run_for(4 * k_second_us);
  EXPECT_TRUE(log_.refusals.empty());
  run_for(2 * k_second_us);
  ASSERT_EQ(log_.refusals.size(), 1U);
  EXPECT_EQ(log_.refusals[0].reason, RefuseReason::handshake_timeout);
}

TEST_F(Handshake, FreesTheSeatOfWhoLeavesTheLobby) {
  Client& client = add_client();
  run_for(k_second_us);
  client.leave();
  run_for(k_second_us);
  EXPECT_EQ(server_->present_mask(), 0);
  add_client();
  add_client();
  run_for(k_second_us);
  EXPECT_EQ(server_->state(), ServerState::running);
}

TEST_F(Handshake, ClientSaysWhenItCannotBuildTheGame) {
  toy_.seed = 3;
  ClientConfig config;
  config.insecure = true;
  ClientParts parts;
  SimTransport& endpoint = network_.add_endpoint();
  parts.transport = &endpoint;
  parts.connection = network_.connect(endpoint, transport_, {});
  parts.inputs = &inputs_;
  parts.factory = [](ByteView) -> Result<std::unique_ptr<Simulation>> {
    return Status::unsupported_version;
  };
  clients_.push_back(std::move(Client::create(config, std::move(parts)).client));
  run_for(k_second_us);
  EXPECT_EQ(clients_[0]->failure(), ClientFailure::config_not_understood);
}

TEST(Setup, NeedsInsecureByNameOnBothEnds) {
  SimNetwork network(1);
  const ToyConfig toy;
  ToySimulation simulation(toy);
  ServerParts parts;
  parts.transport = &network.add_endpoint();
  parts.simulation = &simulation;
  EXPECT_EQ(Server::create({}, parts).error, SetupError::insecure_not_requested);
  ScriptedInputs inputs(1, 0);
  ClientParts client_parts;
  client_parts.transport = parts.transport;
  client_parts.inputs = &inputs;
  client_parts.factory = lockstone::toy::toy_factory();
  EXPECT_EQ(Client::create({}, client_parts).error, SetupError::insecure_not_requested);
}

TEST(Setup, RefusesValuesOutOfRange) {
  SimNetwork network(1);
  ToySimulation simulation{ToyConfig{}};
  ServerParts parts;
  parts.transport = &network.add_endpoint();
  ServerConfig config;
  config.insecure = true;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::player_count_out_of_range);
  parts.simulation = &simulation;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::none);
  config.input_delay_ticks = 61;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::input_delay_out_of_range);
  config.input_delay_ticks = 0;
  config.history_ticks = 1000;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::history_out_of_range);
  config.history_ticks = 1024;
  for (std::int64_t Timeouts::*span :
       {&Timeouts::handshake_us, &Timeouts::silence_warning_us, &Timeouts::drop_us,
        &Timeouts::dump_us, &Timeouts::finish_us, &Timeouts::rejoin_us}) {
    config.timeouts = {};
    config.timeouts.*span = 0;
    EXPECT_EQ(Server::create(config, parts).error, SetupError::timeouts_out_of_range);
  }
}

}  // namespace
}  // namespace lockstone::net::test
