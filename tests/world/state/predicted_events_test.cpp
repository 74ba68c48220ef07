#include <algorithm>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/predicted_events.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

const EventName k_thud{k_own_event_kinds, 1, 2}, k_click{k_own_event_kinds + 1, 1, 2};

// Gives ticks their events: returns the ids, negative of events that were told before, and collects
// the revoked ones.
struct Listener {
  PredictedEvents events;
  std::vector<std::uint64_t> revoked;

  std::vector<std::int64_t> tick(std::uint64_t tick, const std::vector<EventName>& names) {
    std::vector<std::int64_t> told;
    events.begin_tick(tick);
    for (const EventName& name : names) {
      const PredictedEvents::Told one = events.add(name);
      told.push_back(one.is_new ? static_cast<std::int64_t>(one.id)
                                : -static_cast<std::int64_t>(one.id));
    }
    for (const PredictedEvents::Event& event : events.end_tick())
      revoked.push_back(event.id);
    return told;
  }
};

using Ids = std::vector<std::int64_t>;
using Revoked = std::vector<std::uint64_t>;

TEST(PredictedEvents, TellAnEventOnceThoughItsTickIsSteppedAgain) {
  Listener game;
  EXPECT_EQ(game.tick(5, {k_thud}), Ids{1});
  EXPECT_EQ(game.tick(6, {}), Ids{});
  EXPECT_EQ(game.tick(5, {k_thud}), Ids{-1});
  EXPECT_EQ(game.tick(6, {k_click}), Ids{2});
  EXPECT_EQ(game.tick(7, {}), Ids{});
  EXPECT_TRUE(game.revoked.empty());
}

TEST(PredictedEvents, FollowAnEventThatMovesWithinTheWindow) {
  Listener game;
  EXPECT_EQ(game.tick(10, {k_thud}), Ids{1});
  for (const std::uint64_t moved : {12U, 10U, 8U}) {
    for (std::uint64_t tick = 7; tick <= 13; ++tick)
      EXPECT_EQ(game.tick(tick, tick == moved ? std::vector{k_thud} : std::vector<EventName>{}),
                tick == moved ? Ids{-1} : Ids{});
  }
  EXPECT_TRUE(game.revoked.empty());
}

TEST(PredictedEvents, RevokeAnEventThatNeverHappened) {
  Listener game;
  EXPECT_EQ(game.tick(10, {k_thud, k_click}), (Ids{1, 2}));
  EXPECT_EQ(game.tick(10, {k_click}), Ids{-2});
  EXPECT_EQ(game.tick(11, {}), Ids{});
  EXPECT_TRUE(game.revoked.empty());  // it may come until tick 12
  EXPECT_EQ(game.tick(12, {}), Ids{});
  EXPECT_EQ(game.revoked, Revoked{1});
  EXPECT_EQ(game.tick(13, {k_thud}), Ids{3});  // another one
}

TEST(PredictedEvents, TellTwoOfOneNameApart) {
  Listener game;
  EXPECT_EQ(game.tick(10, {k_thud}), Ids{1});
  EXPECT_EQ(game.tick(11, {k_thud}), Ids{2});
  EXPECT_EQ(game.tick(10, {}), Ids{});
  EXPECT_EQ(game.tick(11, {k_thud}), Ids{-2});
  EXPECT_EQ(game.tick(12, {}), Ids{});
  EXPECT_EQ(game.revoked, Revoked{1});
}

TEST(PredictedEvents, ForgetFinalEventsAndCountThoseWithoutRoom) {
  Listener game{PredictedEvents({.capacity = 2, .window_ticks = 2}), {}};
  EXPECT_EQ(game.tick(1, {k_thud, k_click, k_thud}), (Ids{1, 2, 0}));
  EXPECT_EQ(game.events.dropped(), 1U);
  game.events.confirm(1);
  EXPECT_EQ(game.tick(2, {k_thud, k_click}), (Ids{3, 4}));
  const auto lost = game.events.reset();
  ASSERT_EQ(lost.size(), 2U);
  EXPECT_EQ(lost[0].id, 3U);
  EXPECT_EQ(game.tick(1, {k_thud}), Ids{5});  // the clock may start again
  EXPECT_TRUE(game.revoked.empty());
}

const EventName k_scrape{static_cast<std::uint32_t>(EventKind::contact_persist), 1, 2};

TEST(PredictedEvents, TellALastingEventAsOne) {
  Listener game;
  EXPECT_EQ(game.tick(5, {k_scrape}), Ids{1});
  EXPECT_EQ(game.tick(6, {k_scrape, k_thud}), (Ids{-1, 2}));
  EXPECT_EQ(game.tick(7, {k_scrape}), Ids{-1});
  EXPECT_EQ(game.tick(8, {}), Ids{});
  EXPECT_EQ(game.tick(9, {k_scrape}), Ids{3});  // another one
  EXPECT_TRUE(game.revoked.empty());
}

TEST(PredictedEvents, KeepALastingEventThatEndsSoonerOrLater) {
  Listener game;
  for (std::uint64_t tick = 5; tick <= 9; ++tick)
    EXPECT_EQ(game.tick(tick, {k_scrape}), Ids{tick == 5 ? 1 : -1});
  EXPECT_EQ(game.tick(7, {k_scrape}), Ids{-1});
  for (std::uint64_t tick = 8; tick <= 12; ++tick)
    EXPECT_EQ(game.tick(tick, {}), Ids{});  // it ended
  EXPECT_TRUE(game.revoked.empty());
  for (std::uint64_t tick = 8; tick <= 12; ++tick)
    EXPECT_EQ(game.tick(tick, {k_scrape}), Ids{-1});  // and after all it did not
  EXPECT_EQ(game.tick(4, {k_scrape}), Ids{-1});       // it began sooner
  EXPECT_EQ(game.tick(5, {k_scrape}), Ids{-1});
  EXPECT_TRUE(game.revoked.empty());
}

TEST(PredictedEvents, RevokeALastingEventThatNeverBegan) {
  Listener game;
  for (std::uint64_t tick = 5; tick <= 9; ++tick)
    EXPECT_EQ(game.tick(tick, {k_scrape}), Ids{tick == 5 ? 1 : -1});
  for (std::uint64_t tick = 5; tick <= 7; ++tick)
    EXPECT_EQ(game.tick(tick, {}), Ids{});
  EXPECT_EQ(game.revoked, Revoked{1});
  EXPECT_EQ(game.tick(8, {k_scrape}), Ids{2});
}

TEST(PredictedEvents, LastOverConfirmedTicks) {
  Listener game{PredictedEvents({.capacity = 1, .window_ticks = 2}), {}};
  for (std::uint64_t tick = 1; tick <= 50; ++tick) {
    EXPECT_EQ(game.tick(tick, {k_scrape}), Ids{tick == 1 ? 1 : -1});
    game.events.confirm(tick);
  }
  EXPECT_EQ(game.tick(51, {}), Ids{});
  game.events.confirm(51);
  EXPECT_EQ(game.tick(52, {k_thud}), Ids{2});  // there is room again
  EXPECT_EQ(game.events.dropped(), 0U);
}

// Steps ticks, goes back, and steps them again, mostly with the events that they had.
class Timeline {
 public:
  explicit Timeline(test::Random& random) : random_(random) {}

  void step() {
    const std::uint64_t tick = happened_.size();
    if (tick == guesses_.size()) guesses_.push_back(any_events());
    if (random_.below(3) == 0) guesses_[tick] = any_events();
    step(guesses_[tick]);
  }
  void step(const std::vector<EventName>& names) {
    const Ids told = game_.tick(happened_.size(), names);
    happened_.push_back(names);
    for (std::size_t i = 0; i < told.size(); ++i) {
      const std::int64_t id = told[i];
      if (id > 0) heard_[id] = names[i];
      if (id < 0) {
        EXPECT_EQ(heard_.at(-id), names[i]);
      }
    }
    for (const std::uint64_t id : game_.revoked)
      EXPECT_EQ(heard_.erase(static_cast<std::int64_t>(id)), 1U);
    game_.revoked.clear();
  }
  // Nothing more happens, until all that was ever told is settled.
  void finish() {
    while (happened_.size() < guesses_.size() + 3)
      step({});
  }
  void roll_back() {
    happened_.resize(confirmed_ + random_.below(happened_.size() - confirmed_ + 1));
  }
  void confirm() {
    if (confirmed_ + 1 >= happened_.size()) return;
    game_.events.confirm(confirmed_++);
  }

  [[nodiscard]] std::vector<EventName> happened() const {
    std::vector<EventName> all;
    for (const auto& names : happened_)
      all.insert(all.end(), names.begin(), names.end());
    std::ranges::sort(all);
    return all;
  }
  [[nodiscard]] std::vector<EventName> heard() const {
    std::vector<EventName> all;
    for (const auto& [id, name] : heard_)
      all.push_back(name);
    std::ranges::sort(all);
    return all;
  }

 private:
  std::vector<EventName> any_events() {
    std::vector<EventName> names;
    for (std::size_t i = random_.below(3); i > 0; --i)
      names.push_back({k_own_event_kinds, random_.below(3), 0});
    return names;
  }

  test::Random& random_;
  Listener game_;
  std::vector<std::vector<EventName>> guesses_, happened_;  // by tick
  std::map<std::int64_t, EventName> heard_;                 // told and not revoked, by id
  std::uint64_t confirmed_ = 0;                             // ticks that are final
};

TEST(PredictedEvents, AddUpToTheEventsThatHappened) {
  test::Random random;
  for (int round = 0; round < test::share_of(200); ++round) {
    Timeline timeline(random);
    for (int i = 0; i < 60; ++i) {
      for (std::size_t ticks = random.below(8); ticks > 0; --ticks)
        timeline.step();
      if (random.below(2) == 0) timeline.roll_back();
      if (random.below(2) == 0) timeline.confirm();
    }
    timeline.finish();
    ASSERT_EQ(timeline.happened(), timeline.heard()) << "in round " << round;
  }
}

}  // namespace
}  // namespace lockstone
