// Impulses that give an iterated island energy within a tick are given in part.

#include "core/dynamics/step/contacts/iterated_gain_limit.h"

#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/contact/block_words.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/dynamics/tick_scene.h"

namespace lockstone {
namespace {

constexpr std::int64_t k_metre = std::int64_t{1} << lanes::k_velocity_bits;  // a second

std::int64_t impulse_word(std::int64_t most, std::int64_t now) {
  return most * (std::int64_t{1} << 32) + now;
}

// Bodies of 1 kg without gravity, each in contact with body 0, that are solved by iterations.
class GainScene {
 public:
  explicit GainScene(MotionType ground, int count) {
    scene_.add_body(ground);
    for (int i = 1; i <= count; ++i)
      scene_.add_contact(0, scene_.add_body(MotionType::dynamic));
  }
  BodyRecord& body(std::uint32_t index) { return scene_.body(index); }

  /// Once the bodies are as at the tick's beginning.
  void begin() {
    scene_.gather();
    scene_.islands.build(scene_.get(), scene_.bodies, scene_.contacts);
    scene_.bodies.reserve_rows();
    for (std::uint32_t i = 1; i < scene_.bodies.count(); ++i)
      if (scene_.bodies.side(i).is_dynamic())
        scene_.bodies.constants()[i].inverse_mass = block_float(1, 0);
    layout_.build(scene_.get(), scene_.bodies, scene_.contacts, scene_.parallel);
    blocks_.resize(layout_.lane_count() / lanes::k_block_lanes);
    limit_.limit_warm_start(scene_.get(), run());
  }

  /// Along x, m/s: as the substep began, and by the impulses since.
  void move(std::uint32_t body, int before, int now) {
    const std::uint32_t number = scene_.bodies.number_of(body);
    scene_.bodies.before()[number].velocity[0] = before * k_metre;
    scene_.bodies.rows()[number].velocity[0] = now * k_metre;
  }
  void limit() {
    limit_.note_pushes(0, scene_.bodies.count());
    limit_.limit_gains(run());
  }
  [[nodiscard]] std::int64_t speed(std::uint32_t body) {
    return scene_.bodies.rows()[scene_.bodies.number_of(body)].velocity[0];
  }
  std::int64_t& impulse(std::uint32_t contact) {
    const ContactLane place = layout_.lane_of({contact});
    return blocks_[place.block()].points[0].impulse[place.lane()];
  }
  std::int64_t& twist(std::uint32_t contact) {
    const ContactLane place = layout_.lane_of({contact});
    return blocks_[place.block()].twist[place.lane()];
  }

 private:
  ContactRun run() {
    return {scene_.bodies.rows(), scene_.bodies.before(), scene_.bodies.constants(), blocks_,
            params_};
  }

  TickScene scene_;
  ConstraintLayout layout_{TickScene::k_capacity, TickScene::k_capacity};
  std::vector<lanes::ManifoldBlock> blocks_;
  lanes::SolverParams params_{};
  IteratedGainLimit limit_{TickScene::k_capacity,
                           {scene_.bodies, scene_.contacts, scene_.islands, layout_, 4}};
};

TEST(IteratedGainLimit, TakesImpulsesBackThatGiveAnIslandEnergy) {
  GainScene scene(k_static, 2);
  scene.begin();
  scene.move(1, 0, 10);
  scene.impulse(0) = impulse_word(800, 500);
  scene.limit();
  EXPECT_EQ(scene.speed(1), 0);
  EXPECT_EQ(scene.impulse(0), impulse_word(800, 0));  // the largest of the tick stays
}

// The high operand of a twist is the contact's radius, 0 of a single point: it stays where a
// negative twist ends as 0.
TEST(IteratedGainLimit, KeepsTheRadiusOfATwist) {
  for (const std::int64_t radius : {0, 3}) {
    for (const std::int64_t twist : {-7, 0, 7}) {
      GainScene scene(k_static, 1);
      scene.begin();
      scene.move(1, 0, 10);
      scene.twist(0) = lanes::scalar::pack(twist, radius);
      scene.limit();
      EXPECT_EQ(high_word(scene.twist(0)), radius) << twist;
      EXPECT_EQ(low_word(scene.twist(0)), 0) << twist;
    }
  }
}

// Several contacts of 1,024 m/s each.
TEST(IteratedGainLimit, TakesImpulsesBackThatExceedTheRangeOfVelocities) {
  GainScene scene(k_static, 1);
  scene.begin();
  scene.move(1, -1000, 8000);
  scene.limit();
  EXPECT_LE(std::abs(scene.speed(1)), 1000 * k_metre);
}

TEST(IteratedGainLimit, LeavesOtherIslandsAlone) {
  GainScene scene(k_static, 2);
  scene.body(2).velocity.x = Velocity::from_integer(-5);
  scene.begin();
  scene.move(1, 0, 10);
  scene.move(2, -5, 5);
  scene.impulse(1) = impulse_word(500, 500);
  scene.limit();
  EXPECT_EQ(scene.speed(2), 5 * k_metre);
  EXPECT_EQ(scene.impulse(1), impulse_word(500, 500));
}

// A body that bounces off is as fast as it was when the tick began.
TEST(IteratedGainLimit, LetsABodyBounceOffAsFastAsItCame) {
  GainScene scene(k_static, 1);
  scene.body(1).velocity.x = Velocity::from_integer(-10);
  scene.begin();
  scene.move(1, 0, 10);
  scene.limit();
  EXPECT_EQ(scene.speed(1), 10 * k_metre);
}

TEST(IteratedGainLimit, LeavesImpulsesOfAMovingKinematicBody) {
  GainScene scene(k_kinematic, 1);
  scene.body(0).velocity.x = Velocity::from_integer(10);
  scene.begin();
  scene.move(1, 0, 10);
  scene.limit();
  EXPECT_EQ(scene.speed(1), 10 * k_metre);
}

}  // namespace
}  // namespace lockstone
