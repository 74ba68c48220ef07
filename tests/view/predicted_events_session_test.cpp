// The events of a client that predicts, over a slow network: each impact is heard once, though
// wrong guesses step its tick again and again.
#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/predicted_events.h>

#include "tests/view/rolling_session.h"

namespace lockstone {
namespace {

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
  World& world() const { return test::world_of(*client); }
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
  World& world() const { return test::world_of(*client); }
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
  Speaker speaker;
  Witness witness;
  test::RollingSession session(make_loud_game, {{{&speaker}, {&witness, 0}}});
  ASSERT_TRUE(session.is_open());
  speaker.client = &session.client(0);
  witness.client = &session.client(1);

  for (std::int64_t now_us = 0; now_us < 20'000'000; now_us += 6'944)
    session.update(now_us);
  // Later events may still move.
  const std::uint64_t end = std::min(speaker.confirmed, session.client(1).ticks_stepped()) - 8;
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
