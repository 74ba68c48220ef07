// The view of a client that predicts, over a slow network: guesses are wrong again and again, and
// the other player's ball is shown without jumps.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <lockstone/view.h>

#include "tests/view/rolling_session.h"

namespace lockstone {
namespace {

/// Shows each state that the client computes.
struct Shower final : net::ClientObserver {
  void tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t) override { show(); }
  void tick_predicted(std::uint64_t, std::span<const PlayerInput>) override { show(); }
  void rolled_back(std::uint64_t, std::uint64_t) override { ++rollbacks; }
  void state_loaded(std::uint64_t) override { view.reset(); }
  void show() {
    if (client != nullptr) view.update(world());
  }
  World& world() const { return test::world_of(*client); }

  const net::Client* client = nullptr;
  View view;
  int rollbacks = 0;
};

TEST(ViewOfASession, HasNoJumps) {
  Shower shower;
  test::RollingSession session(make_game, {{{&shower}, {}}});
  ASSERT_TRUE(session.is_open());
  const net::Client& watched = session.client(0);
  shower.client = &watched;

  TickClock clock(60);
  double last_shown = 0, last_true = 0, widest_shown = 0, widest_true = 0, farthest = 0;
  for (std::int64_t now_us = 0; now_us < 10'000'000; now_us += 6'944) {  // 144 frames a second
    session.update(now_us);
    if (watched.state() != net::ClientState::running) continue;
    clock.update(shower.view.tick(), now_us);
    const BodyHandle other{watched.slot() == 0 ? 2U : 1U, 1};
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
