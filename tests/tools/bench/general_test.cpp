// The machinery of `lockstone bench general`: seeds make the same scenes, scenes the same states.
// The command measures the goals that our engine does not reach yet; they are not asserted here.
#include <iterator>
#include <set>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tools/bench/general/run.h"

namespace lockstone::bench {
namespace {

constexpr int k_substeps = 4;

GeneralFigures play(std::string_view family, std::uint64_t seed) {
  return *play_general(lockstone_general(), make_scene(*find_family(family), seed), k_substeps);
}

TEST(GeneralScenes, AreTheSameForTheSameSeed) {
  for (const Family& family : families()) {
    for (std::uint64_t seed = 1; seed <= test::share_of(20U); ++seed)
      EXPECT_EQ(bytes_of(make_scene(family, seed)), bytes_of(make_scene(family, seed)));
  }
}

TEST(GeneralScenes, DifferFromSeedToSeed) {
  for (const Family& family : families())
    EXPECT_NE(bytes_of(make_scene(family, 1)), bytes_of(make_scene(family, 2))) << family.name;
}

TEST(GeneralScenes, NameFamiliesOnce) {
  std::set<std::string_view> names;
  for (const Family& family : families()) {
    EXPECT_TRUE(names.insert(family.name).second) << family.name;
    EXPECT_EQ(find_family(family.name), &family);
  }
  EXPECT_EQ(find_family("none of them"), nullptr);
}

TEST(GeneralScenes, ArePlainNumbersWithinTheirOwnBodies) {
  for (const Family& family : families()) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const GeneralScene scene = make_scene(family, seed);
      const auto bodies = static_cast<int>(scene.bodies.size());
      EXPECT_FALSE(scene.watched.empty()) << family.name;
      for (const GeneralJoint& joint : scene.joints)
        EXPECT_TRUE(joint.a >= 0 && joint.a < bodies && joint.b >= 0 && joint.b < bodies);
      for (const GeneralBody& body : scene.bodies)
        EXPECT_TRUE(body.density > 0 && volume_of(body) > 0) << family.name;
    }
  }
}

TEST(GeneralScenes, ShrinkByTheirCap) {
  const Family& wall = *find_family("wall");
  EXPECT_LT(make_scene(wall, 1, 3).bodies.size(), make_scene(wall, 1).bodies.size());
}

// A stack of boxes converges to other velocities than iterations give it.
TEST(GeneralRun, IteratesContactsWhereToldTo) {
  const GeneralScene scene = make_scene(*find_family("many-stacks"), 1);
  const GeneralFigures iterated = *play_general(lockstone_iterated(), scene, k_substeps);
  const GeneralFigures again = *play_general(lockstone_iterated(), scene, k_substeps);
  EXPECT_EQ(iterated.hash, again.hash);
  EXPECT_NE(iterated.hash, play("many-stacks", 1).hash);
}

// Levers of many radii between masses of 1000 : 1, thrown on the ground: the joints come apart, and
// closing them must lift nothing.
TEST(GeneralRun, GainsNoEnergyWhereJointsCannotHold) {
  for (const std::uint64_t seed : {83U, 243U, 255U, 266U, 278U})
    EXPECT_LT(play("toss", seed).gain, 0.05) << seed;
  for (const std::uint64_t seed : {138U, 188U, 207U})
    EXPECT_LT(play("jumble", seed).gain, 0.05) << seed;
}

// Locks that cannot hold together leave the factor little but rounding: bodies jumped by metres.
TEST(GeneralRun, MovesNoBodyByTheRoundingOfAFactor) {
  for (const std::uint64_t seed : {3006447U, 3022394U, 3108973U, 3242369U})
    EXPECT_LT(play("toss", seed).gain, 0.01) << seed;
}

// A light body under a heavy one feels impulses of its own weight times their ratio. They were cut
// at 2^14 m/s, on one side and not on the other: boxes of 100,000 : 1 bounced higher than they fell
// from, and light ones reached 500 m/s.
TEST(GeneralRun, GainsNoEnergyWhereAHeavyBoxFallsOnLightBodies) {
  for (const std::uint64_t seed : {39U, 57U})
    EXPECT_LT(play("crush", seed).gain, 0.01) << seed;
  const GeneralFigures fast = play("crush", 52);
  EXPECT_LT(fast.gain, 0.01);
  EXPECT_LT(fast.speed, 150);
}

// A ball that floor and box press from both sides, in an island that is solved to convergence.
TEST(GeneralRun, GainsNoEnergyWhereBallsBounceAmongOtherBodies) {
  for (const std::uint64_t seed : {7657U, 10323U, 17176U, 26437U, 27359U})
    EXPECT_LT(play("toss", seed).gain, 0.001) << seed;
  EXPECT_LT(play("spill", 11676).gain, 0.001);
}

// Capsules and boxes that turn by more than a radian a tick where they bounce, or are stopped.
TEST(GeneralRun, GainsNoEnergyWhereFastTurningBodiesMeetTheFloor) {
  for (const std::uint64_t seed : {5508U, 7760U, 13658U, 20751U, 27803U, 30846U})
    EXPECT_LT(play("toss", seed).gain, 0.01) << seed;
}

// Sliders, welds and hinges with levers of metres between masses of 1000 : 1, thrown: the impulses
// that hold them exceed those that light bodies may get at once.
TEST(GeneralRun, HoldsLightBodiesBetweenHeavyOnesOnLongLevers) {
  for (const std::uint64_t seed : {245587U, 348918U}) {
    const GeneralFigures figures = play("fling", seed);
    EXPECT_LT(figures.speed, 30) << seed;
    EXPECT_LT(figures.gain, 0.05) << seed;
  }
}

TEST(GeneralRun, EndsInTheSameStateOnAnyNumberOfThreads) {
  GeneralOptions options;
  for (const std::string_view name : {"pendulum", "cairn", "clatter", "trigger"})
    options.families.push_back(find_family(name));
  options.engines = {lockstone_general()};
  options.seeds = 3;
  const std::vector<FamilyRun> alone = run_general(options, nullptr);
  options.threads = 4;
  const std::vector<FamilyRun> together = run_general(options, nullptr);
  ASSERT_EQ(alone.size(), together.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    for (std::size_t seed = 0; seed < alone[i].figures.size(); ++seed) {
      EXPECT_EQ(alone[i].figures[seed]->hash, together[i].figures[seed]->hash);
      EXPECT_EQ(alone[i].figures[seed]->error, together[i].figures[seed]->error);
    }
  }
}

// A body that flies off is a great figure, not one that is none.
TEST(GeneralRun, HasFiniteFiguresEvenOfScenesThatFlyApart) {
  for (const std::string_view name : {"span", "door", "fast-paddle", "tiles-roll"}) {
    const GeneralFigures figures = play(name, 1);
    for (const double figure : {figures.error, figures.gap, figures.gain, figures.speed})
      EXPECT_LE(figure, k_lost_figure) << name;
    EXPECT_GT(figures.tick_micros, 0);
  }
}

TEST(GeneralRun, HoldsTheFamiliesThatAreKnownToHold) {
  for (const std::string_view name : {"pendulum", "house", "arch", "door", "seesaw", "cairn"}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
      EXPECT_FALSE(play(name, seed).failed) << name << ":" << seed;
  }
}

// A pendulum that a wrong moment of inertia or height would show.
TEST(GeneralRun, SeesThatAPendulumKeepsItsEnergy) {
  EXPECT_LT(play("pendulum", 1).gain, 0.02);
}

// Linkages that regained a tenth to four fifths of their energy: an unchecked step of Newton's
// method where locks were open, gravity on ways that an early stop took back, and bounces of bodies
// that were taken to be heavier to turn. The last two regained nothing before such steps were
// checked, and regain up to 2.7 % now: closing may take as much as (0.5 m/s)² for each kilogram.
TEST(GeneralRun, TakesNoEnergyFromJammedLinkages) {
  for (const std::uint64_t seed :
       {3291568U, 3077967U, 3148778U, 3135453U, 3223273U, 3266618U, 3036191U, 3264774U, 3023286U,
        3239653U, 3043622U, 3154769U, 3180723U})
    EXPECT_LT(play("toss", seed).gain, k_gain_bound) << seed;
}

// Thin plates that reached 155 to 500 m/s: hit in the last substep of a tick, and iterated from the
// next tick on, with impulses that had been converged.
TEST(GeneralRun, GainsNoEnergyWhereAConvergedPileBecomesALooseOne) {
  for (const std::uint64_t seed : {29ULL, 164ULL, 266ULL})
    EXPECT_LT(play("plates", seed).gain, k_gain_bound) << seed;
}

// Thin plates that overlap each other in several places, and that regained a quarter to two thirds
// of their energy as overlap was pushed out.
TEST(GeneralRun, GainsNoEnergyWhereThinPlatesHavePassedEachOther) {
  for (const std::uint64_t seed : {16ULL, 484ULL})
    EXPECT_LT(play("plates", seed).gain, k_gain_bound) << seed;
}

// Loads that lie still on a deck, deeper than contacts beside joints are stiff. The factor was kept
// while these became softer: one load was thrown up at 5 m/s.
TEST(GeneralRun, ThrowsNoLoadFromADeckWhoseContactsSoften) {
  EXPECT_LT(play("drawbridge", 9100004).gain, 0.0001);
}

// A light link in a loop that holds heavy bodies by long levers: it gave way by 1.5 m, turned at
// 700 rad/s within a substep, and regained a fifth of the energy from a factor of earlier rows.
TEST(GeneralRun, HoldsHeavyBodiesByALightLinkOfALoop) {
  const GeneralFigures figures = play("jumble", 11);
  EXPECT_LT(figures.gain, 0.001);
  EXPECT_LT(figures.gap, 0.002);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    EXPECT_FALSE(play("weak-link", seed).failed) << seed;
}

// Walls that grow beyond the islands that converge, and are iterated from then on. They buckled and
// fell by 4 to 5 m while the points of contacts at recycling poses turned with the bricks.
TEST(GeneralRun, KeepsWallsUpWhileTheyAreBuilt) {
  constexpr std::uint64_t k_seeds[] = {9600022, 9600036};
  for (const std::uint64_t seed : std::span(k_seeds).first(test::share_of(std::size(k_seeds))))
    EXPECT_LT(play("built-wall", seed).error, 0.1) << seed;
}

// The first two are given up: new, or once it is pushed. A dome of as many contacts is solved, and
// stays converged: iterated it moves by 16 mm.
TEST(GeneralRun, KeepsUpWallsThatItGivesUpAndSolvesDomes) {
  EXPECT_LT(play("wall", 9300007).error, 0.005);
  EXPECT_LT(play("nudged-wall", 9300010).error, 0.01);
  EXPECT_LT(play("dome", 9700029).error, 0.0002);
}

TEST(GeneralRun, DrawsAScene) {
  const std::string picture =
      draw_general(lockstone_general(), make_scene(*find_family("ladder"), 1), k_substeps);
  EXPECT_NE(picture.find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace lockstone::bench
