#include "core/collision/broad_phase/broad_phase.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

constexpr ProxyTraits k_dynamic{.moves = true, .is_dynamic = true};

// The pairs that the broad phase must find, by looking at every pair.
struct Model {
  explicit Model(std::uint32_t count) : bounds(count), traits(count), present(count) {}

  [[nodiscard]] std::vector<Pair> pairs() const {
    std::vector<Pair> found;
    for (std::uint32_t a = 0; a < bounds.size(); ++a) {
      for (std::uint32_t b = 0; b < bounds.size(); ++b) {
        const bool ordered = traits[a].moves && (!traits[b].moves || b > a);
        if (a == b || !present[a] || !present[b] || !ordered) continue;
        if (overlap(bounds[a], bounds[b]) && can_meet(traits[a], traits[b]))
          found.push_back({a, b});
      }
    }
    return found;
  }

  [[nodiscard]] std::vector<std::uint32_t> seen(std::uint32_t mask, const Bounds& area) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < bounds.size(); ++i) {
      const bool visible = present[i] && (traits[i].filter.category & mask) != 0;
      if (visible && overlap(area, bounds[i])) found.push_back(i);
    }
    return found;
  }

  [[nodiscard]] std::vector<std::uint32_t> immovable_seen(const Bounds& area) const {
    std::vector<std::uint32_t> found = seen(0xffffffff, area);
    std::erase_if(found, [&](std::uint32_t body) { return traits[body].is_dynamic; });
    return found;
  }

  std::vector<Bounds> bounds;
  std::vector<ProxyTraits> traits;
  std::vector<bool> present;
};

Bounds random_box(test::Random& random) {
  Bounds box;
  const std::int64_t longest = random.between(0, 30) == 0 ? 9000 : 1500;
  for (int i = 0; i < 3; ++i) {
    box.lower[i].raw = static_cast<std::int32_t>(random.between(-2500, 2500));
    box.upper[i].raw = box.lower[i].raw + static_cast<std::int32_t>(random.between(100, longest));
  }
  return box;
}

// A step, or a jump back to the middle from far out.
Bounds moved(Bounds box, test::Random& random) {
  if (abs(box.lower.x) + abs(box.lower.y) + abs(box.lower.z) > BoundsCoordinate::from_integer(8)) {
    return random_box(random);
  }
  const std::int64_t reach = random.between(0, 9) == 0 ? 2000 : 60;
  for (int i = 0; i < 3; ++i) {
    const auto by = static_cast<std::int32_t>(random.between(-reach, reach));
    box.lower[i].raw += by;
    box.upper[i].raw += by;
  }
  return box;
}

CollisionFilter random_filter(test::Random& random) {
  CollisionFilter filter;
  filter.category = 1U << random.between(0, 3);
  if (random.between(0, 2) == 0) filter.mask = static_cast<std::uint32_t>(random.between(0, 15));
  if (random.between(0, 3) == 0) filter.group = static_cast<std::int32_t>(random.between(-2, 2));
  return filter;
}

ProxyTraits random_traits(test::Random& random) {
  const std::int64_t motion = random.between(0, 5);
  return {.filter = random_filter(random),
          .moves = motion > 1,
          .is_dynamic = motion > 2,
          .is_trigger = random.between(0, 9) == 0};
}

// One body of one tick: it goes, comes, moves, changes its traits or stays as it is.
void change(Model& model, BroadPhase& broad_phase, std::uint32_t body, std::int64_t moving_percent,
            test::Random& random) {
  const std::int64_t die = random.between(0, 999);
  if (die < 10) {
    model.present[body] = false;
    broad_phase.remove(body);
  }
  if (die >= 5 && die < 10 * moving_percent) {
    if (!model.present[body] || die < 20) model.traits[body] = random_traits(random);
    model.bounds[body] =
        model.present[body] ? moved(model.bounds[body], random) : random_box(random);
    model.present[body] = true;
    broad_phase.set(body, model.bounds[body], model.traits[body]);
  }
  if (die >= 995 && model.present[body] && model.traits[body].moves) {  // sleeps, or wakes
    model.traits[body].is_asleep = !model.traits[body].is_asleep;
    broad_phase.set(body, model.bounds[body], model.traits[body]);
  }
}

std::vector<Pair> pairs_of(BroadPhase& broad_phase) {
  const auto found = broad_phase.find_pairs();
  return {found.begin(), found.end()};
}

std::vector<std::uint32_t> seen_by(const BroadPhase& broad_phase, std::uint32_t mask,
                                   const Bounds& area) {
  std::vector<std::uint32_t> found;
  broad_phase.traverse(
      mask, [&](const Bounds& b) { return overlap(area, b); },
      [&](std::uint32_t body) { found.push_back(body); });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::uint32_t> immovable_seen_by(const BroadPhase& broad_phase, const Bounds& area) {
  std::vector<std::uint32_t> found;
  broad_phase.traverse_immovable([&](const Bounds& b) { return overlap(area, b); },
                                 [&](std::uint32_t body) { found.push_back(body); });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Pair> first(std::vector<Pair> pairs, std::size_t count) {
  pairs.resize(std::min(count, pairs.size()));
  return pairs;
}

class BothBroadPhases : public ::testing::TestWithParam<BroadPhaseKind> {};

TEST_P(BothBroadPhases, FindEveryPairOnceAndSortedWhateverHappens) {
  test::Random random;
  constexpr std::uint32_t k_count = 60;
  Model model(k_count);
  BroadPhase broad_phase(GetParam(), k_count, 1 << 12);
  for (int tick = 0; tick < test::share_of(3000); ++tick) {
    // Calm and busy times, and now and then all at once.
    const std::int64_t moving_percent = tick % 500 == 0 ? 100 : tick / 100 % 3 * 20 + 1;
    if (random.between(0, 400) == 0) {
      broad_phase.clear();
      std::fill(model.present.begin(), model.present.end(), false);
    }
    for (std::uint32_t body = 0; body < k_count; ++body) {
      change(model, broad_phase, body, moving_percent, random);
      if (body % 7 == 0) broad_phase.settle(BroadPhase::Moment::command);
    }
    ASSERT_EQ(pairs_of(broad_phase), model.pairs()) << "tick " << tick;
    ASSERT_FALSE(broad_phase.overflowed());
    const auto mask = static_cast<std::uint32_t>(random.between(0, 15));
    const Bounds area = random_box(random);
    ASSERT_EQ(seen_by(broad_phase, mask, area), model.seen(mask, area)) << "tick " << tick;
    ASSERT_EQ(immovable_seen_by(broad_phase, area), model.immovable_seen(area)) << "tick " << tick;
    ASSERT_TRUE(tick % 10 != 0 || broad_phase.is_valid()) << "tick " << tick;
  }
}

TEST_P(BothBroadPhases, KeepTheFirstPairsWhenTheyExceedTheCapacity) {
  test::Random random;
  constexpr std::uint32_t k_count = 40;
  constexpr std::uint32_t k_capacity = 8;
  Model model(k_count);
  BroadPhase broad_phase(GetParam(), k_count, k_capacity);
  int overflows = 0, full_searches = 0, quick_searches = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    if (tick % 500 == 0) {  // fewer bodies than before, so that the candidates fit again
      broad_phase.clear();
      std::fill(model.present.begin(), model.present.end(), false);
    }
    const std::uint32_t used = tick / 500 % 2 == 0 ? k_count : k_count / 2;
    for (std::uint32_t body = 0; body < used; ++body)
      change(model, broad_phase, body, tick < 500 ? 100 : 20, random);
    const std::vector<Pair> all = model.pairs();
    ASSERT_EQ(pairs_of(broad_phase), first(all, k_capacity)) << "tick " << tick;
    ASSERT_EQ(broad_phase.overflowed(), all.size() > k_capacity) << "tick " << tick;
    const BroadPhase::Effort& effort = broad_phase.effort();
    overflows += broad_phase.overflowed() ? 1 : 0;
    full_searches += effort.searched_all ? 1 : 0;
    quick_searches += effort.searched_all ? 0 : 1;
  }
  EXPECT_GT(overflows, 0);
  EXPECT_GT(full_searches, 0);
  EXPECT_GT(quick_searches, 0);
}

TEST_P(BothBroadPhases, TrySoonAgainAndThenMoreSeldomWhetherCandidatesFit) {
  BroadPhase broad_phase(GetParam(), 40, 100);
  std::vector<int> quick;  // ticks
  for (int tick = 0; tick < 300; ++tick) {
    // 780 candidates, and from tick 200 on 190.
    if (tick == 200)
      for (std::uint32_t body = 20; body < 40; ++body)
        broad_phase.remove(body);
    Bounds box;
    box.upper.x = BoundsCoordinate::from_integer(1 + tick % 2);
    for (std::uint32_t body = 0; body < (tick < 200 ? 40U : 20U); ++body)
      broad_phase.set(body, box, k_dynamic);
    (void)broad_phase.find_pairs();
    if (broad_phase.effort().searched > 0 && !broad_phase.effort().searched_all)
      quick.push_back(tick);
  }
  // It tries in ticks 0, 2, 5, 10, 19, 36, 69, 134, 199 and 264.
  ASSERT_FALSE(quick.empty());
  EXPECT_EQ(quick.front(), 264);
}

TEST_P(BothBroadPhases, KeepTheFirstOfManyPairsWhateverTheOrderOfComing) {
  BroadPhase roomy(GetParam(), 40, 1 << 12);
  BroadPhase tight(GetParam(), 40, 100);
  for (std::uint32_t body = 0; body < 40; ++body) {
    roomy.set(body, Bounds{}, k_dynamic);
    tight.set(39 - body, Bounds{}, k_dynamic);
  }
  const std::vector<Pair> all = pairs_of(roomy);
  ASSERT_EQ(all.size(), 780U);
  EXPECT_FALSE(roomy.overflowed());
  EXPECT_EQ(pairs_of(tight), first(all, 100));
  EXPECT_TRUE(tight.overflowed());
}

TEST_P(BothBroadPhases, ForgetWithoutChangingResults) {
  test::Random random;
  constexpr std::uint32_t k_count = 60;
  Model model(k_count);
  BroadPhase kept(GetParam(), k_count, 200);
  for (int tick = 0; tick < 300; ++tick) {
    for (std::uint32_t body = 0; body < k_count; ++body)
      change(model, kept, body, 30, random);
    BroadPhase made(GetParam(), k_count, 200);
    for (std::uint32_t body = 0; body < k_count; ++body) {
      if (model.present[body]) made.set(body, model.bounds[body], model.traits[body]);
    }
    ASSERT_EQ(pairs_of(kept), pairs_of(made)) << "tick " << tick;
    ASSERT_EQ(kept.overflowed(), made.overflowed()) << "tick " << tick;
  }
}

TEST_P(BothBroadPhases, SearchOnlyForBodiesThatLeftTheirFatBox) {
  BroadPhase broad_phase(GetParam(), 100, 1000);
  Bounds box;
  box.upper = {BoundsCoordinate::from_integer(1), BoundsCoordinate::from_integer(1),
               BoundsCoordinate::from_integer(1)};
  const auto shift = [&](std::uint32_t body, std::int32_t by) {
    Bounds shifted = box;
    shifted.lower.x.raw += static_cast<std::int32_t>(body) * 1000 + by;
    shifted.upper.x.raw += static_cast<std::int32_t>(body) * 1000 + by;
    broad_phase.set(body, shifted, k_dynamic);
  };
  for (std::uint32_t body = 0; body < 100; ++body)
    shift(body, 0);
  EXPECT_EQ(broad_phase.find_pairs().size(), 99U);
  EXPECT_EQ(broad_phase.effort().searched, 100U);
  EXPECT_EQ(broad_phase.find_pairs().size(), 99U);
  EXPECT_EQ(broad_phase.effort().searched, 0U);
  for (std::uint32_t body = 0; body < 100; ++body)
    shift(body, 1);
  EXPECT_EQ(broad_phase.find_pairs().size(), 99U);
  EXPECT_EQ(broad_phase.effort().searched, 0U);
  shift(50, 500);
  EXPECT_EQ(broad_phase.find_pairs().size(), 98U);
  EXPECT_EQ(broad_phase.effort().searched, 1U);
}

TEST(BroadPhase, IsNotSearchedBodyByBodyWhileAWorldIsMade) {
  constexpr std::uint32_t k_count = 4000;
  BroadPhase broad_phase(BroadPhaseKind::tree, k_count, 1000);
  Bounds box;
  box.upper = {BoundsCoordinate::from_integer(1), BoundsCoordinate::from_integer(1),
               BoundsCoordinate::from_integer(1)};
  std::uint64_t tests = 0;
  for (std::uint32_t body = 0; body < k_count; ++body) {
    Bounds shifted = box;
    shifted.lower.x.raw += static_cast<std::int32_t>(body) * 3000;
    shifted.upper.x.raw += static_cast<std::int32_t>(body) * 3000;
    broad_phase.set(body, shifted, k_dynamic);
    broad_phase.settle(BroadPhase::Moment::command);
    std::uint32_t seen = 0;
    broad_phase.traverse(
        k_every_category,
        [&](const Bounds& other) {
          ++tests;
          return overlap(shifted, other);
        },
        [&](std::uint32_t) { ++seen; });
    EXPECT_EQ(seen, 1U);
  }
  EXPECT_LT(tests, std::uint64_t{100} * k_count);  // 2,000 a body without
}

TEST_P(BothBroadPhases, TakeBoxesAtTheEdgeOfTheirRange) {
  Model model(32);
  BroadPhase broad_phase(GetParam(), 32, 1000);
  test::Random random;
  for (int tick = 0; tick < 50; ++tick) {
    for (std::uint32_t body = 0; body < 32; ++body) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t edges[] = {BoundsCoordinate::min().raw, BoundsCoordinate::min().raw + 1,
                                      0, BoundsCoordinate::max().raw};
        const auto low = random.between(0, 3), high = random.between(0, 3);
        model.bounds[body].lower[i].raw = edges[std::min(low, high)];
        model.bounds[body].upper[i].raw = edges[std::max(low, high)];
      }
      model.traits[body] = k_dynamic;
      model.present[body] = true;
      broad_phase.set(body, model.bounds[body], model.traits[body]);
    }
    ASSERT_EQ(pairs_of(broad_phase), model.pairs());
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, BothBroadPhases,
                         ::testing::Values(BroadPhaseKind::tree, BroadPhaseKind::sweep_and_prune),
                         [](const auto& kind) {
                           return kind.param == BroadPhaseKind::tree ? "Tree" : "SweepAndPrune";
                         });

TEST(Layers, NeverRuleOutBodiesThatCollide) {
  test::Random random;
  int ruled_out = 0;
  for (int round = 0; round < 20000; ++round) {
    const CollisionFilter one = random_filter(random), other = random_filter(random);
    const Layers among = united(layers_of(random_filter(random)), layers_of(other));
    const bool may = may_collide(layers_of(one), among);
    ASSERT_TRUE(may || !should_collide(one, other));
    ruled_out += may ? 0 : 1;
  }
  EXPECT_GT(ruled_out, 0);
}

TEST(CanMeet, NeedsOneToBePushedOrToSense) {
  constexpr ProxyTraits k_standing{};
  constexpr ProxyTraits k_kinematic{.moves = true};
  constexpr ProxyTraits k_zone{.is_trigger = true};
  EXPECT_TRUE(can_meet(k_dynamic, k_dynamic));
  EXPECT_TRUE(can_meet(k_dynamic, k_standing));
  EXPECT_TRUE(can_meet(k_zone, k_kinematic));
  EXPECT_FALSE(can_meet(k_kinematic, k_standing));
  EXPECT_FALSE(can_meet(k_zone, k_zone));
  EXPECT_FALSE(can_meet(k_standing, k_zone));
}

}  // namespace
}  // namespace lockstone
