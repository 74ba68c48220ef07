// Two players of the example game over a slow network, whose guesses are wrong again and again.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include <gtest/gtest.h>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_sim.h>

#include "tools/examples/rolling/rolling.h"

namespace lockstone::test {

/// Jumps for some ticks and rests for as many, so that to hold the last input is a wrong guess a
/// few times a second.
struct Restless final : net::InputSource {
  explicit Restless(std::uint64_t half_period) : half_period_ticks(half_period) {}
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    out[2] = std::byte{tick / half_period_ticks % 2 == 0};
  }
  std::uint64_t half_period_ticks;
};

/// Of the example game.
inline World& world_of(const net::Client& client) {
  return static_cast<RollingGame*>(client.simulation())->world();
}

/// The settings in which the two clients differ.
struct RollingPlayer {
  net::ClientObserver* observer = nullptr;
  std::uint8_t prediction_ticks = 12;
};

/// A server and its two clients. Null where it could not be made.
class RollingSession {
 public:
  RollingSession(const SimulationFactory& make, const std::array<RollingPlayer, 2>& players) {
    const std::byte config[] = {std::byte{2}};
    game_ = std::move(make(config)).value();
    net::ServerConfig server_config;
    server_config.insecure = true;
    server_config.match_config = {config[0]};
    net::SimTransport& hub = network_.add_endpoint();
    server_ = net::Server::create(server_config, {.transport = &hub,
                                                  .simulation = game_.get(),
                                                  .describer = nullptr,
                                                  .observer = nullptr})
                  .server;
    for (std::size_t i = 0; i < 2; ++i) {
      net::SimTransport& endpoint = network_.add_endpoint();
      const auto connection = network_.connect(endpoint, hub, {.delay_us = 50'000});
      net::ClientConfig client_config;
      client_config.insecure = true;
      client_config.prediction_ticks = players[i].prediction_ticks;
      net::ClientParts parts{&endpoint, connection, make, &sources_[i]};
      parts.observer = players[i].observer;
      clients_[i] = net::Client::create(client_config, parts).client;
    }
  }

  [[nodiscard]] bool is_open() const {
    return server_ != nullptr && clients_[0] != nullptr && clients_[1] != nullptr;
  }
  [[nodiscard]] const net::Client& client(std::size_t index) const { return *clients_[index]; }

  void update(std::int64_t now_us) {
    server_->update(now_us);
    for (const auto& client : clients_)
      client->update(now_us);
  }

 private:
  net::SimNetwork network_{7};
  Restless sources_[2] = {Restless(40), Restless(23)};
  std::unique_ptr<Simulation> game_;
  std::unique_ptr<net::Server> server_;
  std::unique_ptr<net::Client> clients_[2];
};

}  // namespace lockstone::test
