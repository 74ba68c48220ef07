// The events of a client that predicts, over a slow network: each impact is heard once, though
// wrong guesses step its tick again and again.
#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_sim.h>
#include <lockstone/predicted_events.h>

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

// The game with hits.
Result<std::unique_ptr<Simulation>> make_loud_game(ByteView config) {
  Result<std::unique_ptr<Simulation>> game = make_game(config);
  if (!game.ok()) return game;
  World& world = static_cast<RollingGame&>(*game.value()).world();
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    EXPECT_EQ(world.apply(SetEvents{world.body_at(i), {true, SolverVelocity::from_integer(1)}}),
              Status::ok);
  return game;
}

std::vector<EventName> names_in(const World& world) {
  std::vector<EventName> names;
  for (const HitEvent& hit : hit_events(world))
    names.push_back(name_of(hit));
  for (const ContactEvent& event : world.events())
    names.push_back(name_of(event));
  return names;
}

/// Plays a sound for each new event, and stops those that never happened.
struct Speaker final : net::ClientObserver {
  void tick_predicted(std::uint64_t tick, std::span<const PlayerInput>) override { hear(tick); }
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput>, std::uint64_t) override {
    if (world().tick() == tick + 1) hear(tick);  // a right guess is not stepped again
    events.confirm(tick);
    confirmed = tick + 1;
  }
  void rolled_back(std::uint64_t, std::uint64_t) override { ++rollbacks; }
  void state_loaded(std::uint64_t) override {
    for (const PredictedEvents::Event& event : events.reset())
      sounds.erase(event.id);
  }
  void hear(std::uint64_t tick) {
    events.begin_tick(tick);
    for (const EventName& name : names_in(world())) {
      ++heard;
      const PredictedEvents::Told told = events.add(name);
      if (told.is_new) sounds[told.id] = {told.id, name, tick};
      if (!told.is_new) sounds.at(told.id).tick = tick;
    }
    for (const PredictedEvents::Event& event : events.end_tick()) {
      EXPECT_EQ(sounds.erase(event.id), 1U);
      ++revoked;
    }
  }
  World& world() const { return static_cast<RollingGame*>(client->simulation())->world(); }
  /// Sounds of ticks below `end`.
  std::vector<EventName> played(std::uint64_t end) const {
    std::vector<EventName> names;
    for (const auto& [id, sound] : sounds)
      if (sound.tick < end) names.push_back(sound.name);
    std::ranges::sort(names);
    return names;
  }

  const net::Client* client = nullptr;
  PredictedEvents events;
  std::map<std::uint64_t, PredictedEvents::Event> sounds;  // by id
  std::uint64_t confirmed = 0;
  int rollbacks = 0, heard = 0, revoked = 0;
};

/// Hears every tick once: it does not predict.
struct Witness final : net::ClientObserver {
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput>, std::uint64_t) override {
    for (const EventName& name : names_in(world()))
      events.emplace_back(tick, name);
  }
  World& world() const { return static_cast<RollingGame*>(client->simulation())->world(); }
  std::vector<EventName> happened(std::uint64_t end) const {
    std::vector<EventName> names;
    for (const auto& [tick, name] : events)
      if (tick < end) names.push_back(name);
    std::ranges::sort(names);
    return names;
  }

  const net::Client* client = nullptr;
  std::vector<std::pair<std::uint64_t, EventName>> events;
};

TEST(EventsOfASession, AreHeardOnce) {
  net::SimNetwork network(7);
  net::SimTransport& hub = network.add_endpoint();
  const std::byte players[] = {std::byte{2}};
  const auto game = make_loud_game(players);
  net::ServerConfig server_config;
  server_config.insecure = true;
  server_config.match_config = {std::byte{2}};
  const auto server = net::Server::create(server_config, {.transport = &hub,
                                                          .simulation = game.value().get(),
                                                          .describer = nullptr,
                                                          .observer = nullptr})
                          .server;
  ASSERT_NE(server, nullptr);
  Restless sources[2] = {Restless(40), Restless(23)};
  Speaker speaker;
  Witness witness;
  std::unique_ptr<net::Client> clients[2];
  for (std::size_t i = 0; i < 2; ++i) {
    net::SimTransport& endpoint = network.add_endpoint();
    const auto connection = network.connect(endpoint, hub, {.delay_us = 50'000});
    net::ClientConfig config;
    config.insecure = true;
    config.prediction_ticks = i == 0 ? 12 : 0;
    net::ClientParts parts{&endpoint, connection, make_loud_game, &sources[i]};
    parts.observer = i == 0 ? static_cast<net::ClientObserver*>(&speaker) : &witness;
    clients[i] = net::Client::create(config, parts).client;
    ASSERT_NE(clients[i], nullptr);
  }
  speaker.client = clients[0].get();
  witness.client = clients[1].get();

  for (std::int64_t now_us = 0; now_us < 20'000'000; now_us += 6'944) {
    server->update(now_us);
    for (const auto& client : clients)
      client->update(now_us);
  }
  // Later events may still move.
  const std::uint64_t end = std::min(speaker.confirmed, clients[1]->ticks_stepped()) - 8;
  const std::vector<EventName> played = speaker.played(end), happened = witness.happened(end);
  std::printf("%zu events in %d rollbacks; told %d times, played %zu, revoked %d\n",
              happened.size(), speaker.rollbacks, speaker.heard, speaker.sounds.size(),
              speaker.revoked);
  EXPECT_EQ(played, happened);
  EXPECT_GT(happened.size(), 20U);
  EXPECT_GT(speaker.rollbacks, 20);
  EXPECT_GT(speaker.revoked, 0);
  EXPECT_GT(speaker.heard, static_cast<int>(speaker.sounds.size() + 20));
}

}  // namespace
}  // namespace lockstone
