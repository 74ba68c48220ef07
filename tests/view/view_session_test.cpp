// The view of a client that predicts, over a slow network: guesses are wrong again and again, and
// the other player's ball is shown without jumps.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_sim.h>
#include <lockstone/view.h>

#include "tools/examples/rolling/rolling.h"

namespace lockstone {
namespace {

/// Jumps for some ticks and rests for as many, so that to hold the last input is a wrong guess a
/// few times a second.
struct Restless final : net::InputSource {
  explicit Restless(std::uint64_t half_period) : half_period_ticks(half_period) {}
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    out[2] = std::byte{tick / half_period_ticks % 2 == 0};
  }
  std::uint64_t half_period_ticks;
};

/// Shows each state that the client computes.
struct Shower final : net::ClientObserver {
  void tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t) override { show(); }
  void tick_predicted(std::uint64_t, std::span<const PlayerInput>) override { show(); }
  void rolled_back(std::uint64_t, std::uint64_t) override { ++rollbacks; }
  void state_loaded(std::uint64_t) override { view.reset(); }
  void show() {
    if (client != nullptr) view.update(world());
  }
  World& world() const { return static_cast<RollingGame*>(client->simulation())->world(); }

  const net::Client* client = nullptr;
  View view;
  int rollbacks = 0;
};

TEST(ViewOfASession, HasNoJumps) {
  net::SimNetwork network(7);
  net::SimTransport& hub = network.add_endpoint();
  RollingGame game(2);
  net::ServerConfig server_config;
  server_config.insecure = true;
  server_config.match_config = {std::byte{2}};
  const auto server =
      net::Server::create(
          server_config,
          {.transport = &hub, .simulation = &game, .describer = nullptr, .observer = nullptr})
          .server;
  ASSERT_NE(server, nullptr);
  Restless sources[2] = {Restless(40), Restless(23)};
  Shower shower;
  std::unique_ptr<net::Client> clients[2];
  for (std::size_t i = 0; i < 2; ++i) {
    net::SimTransport& endpoint = network.add_endpoint();
    const auto connection = network.connect(endpoint, hub, {.delay_us = 50'000});
    net::ClientConfig config;
    config.insecure = true;
    config.prediction_ticks = 12;
    net::ClientParts parts{&endpoint, connection, make_game, &sources[i]};
    if (i == 0) parts.observer = &shower;
    clients[i] = net::Client::create(config, parts).client;
    ASSERT_NE(clients[i], nullptr);
  }
  shower.client = clients[0].get();

  TickClock clock(60);
  double last_shown = 0, last_true = 0, widest_shown = 0, widest_true = 0, farthest = 0;
  for (std::int64_t now_us = 0; now_us < 10'000'000; now_us += 6'944) {  // 144 frames a second
    server->update(now_us);
    for (const auto& client : clients)
      client->update(now_us);
    if (clients[0]->state() != net::ClientState::running) continue;
    clock.update(shower.view.tick(), now_us);
    const BodyHandle other{clients[0]->slot() == 0 ? 2U : 1U, 1};
    const auto pose = shower.view.pose<double>(other, clock.fraction());
    if (!pose) continue;
    const double shown = pose->position[1];
    const double truth = static_cast<double>(shower.world().position(other).y.raw) * 0x1p-32;
    if (now_us > 3'000'000) {
      widest_shown = std::max(widest_shown, std::abs(shown - last_shown));
      widest_true = std::max(widest_true, std::abs(truth - last_true));
      farthest = std::max(farthest, std::abs(shown - truth));
    }
    last_shown = shown;
    last_true = truth;
  }
  std::printf("%d rollbacks; steps of a frame: true %.3f m, shown %.3f m; apart %.3f m\n",
              shower.rollbacks, widest_true, widest_shown, farthest);
  EXPECT_GT(shower.rollbacks, 10);
  EXPECT_GT(widest_true, 3 * widest_shown);
  EXPECT_LT(widest_shown, 0.1);
}

}  // namespace
}  // namespace lockstone
