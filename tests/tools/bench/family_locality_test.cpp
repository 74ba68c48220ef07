// Law 9 in scenes of families: a scene takes the same course alone and beside other ones, to the
// bit (docs/explanation/locality.md).
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tools/bench/general/watch.h"

namespace lockstone::bench {
namespace {

constexpr int k_substeps = 4;
constexpr int k_ticks = test::share_of(120);

// So many scenes in one world: their contacts together stay below the world's default capacity for
// islands that are solved to convergence.
constexpr std::size_t k_company = 4;

// Distance between two scenes, m: farther than any is wide.
constexpr double k_apart = 50000;

void shift(GeneralScene& scene, double x) {
  for (GeneralBody& body : scene.bodies)
    body.position[0] += x;
}

// Puts the second scene's bodies behind the first one's.
void append(GeneralScene& scene, GeneralScene other) {
  const auto first = static_cast<int>(scene.bodies.size());
  for (GeneralJoint& joint : other.joints) {
    joint.a += first;
    joint.b += first;
  }
  for (GeneralMove& move : other.moves)
    move.body += first;
  scene.bodies.insert(scene.bodies.end(), other.bodies.begin(), other.bodies.end());
  scene.joints.insert(scene.joints.end(), other.joints.begin(), other.joints.end());
  scene.moves.insert(scene.moves.end(), other.moves.begin(), other.moves.end());
}

// An engine with a scene, and its changes before some ticks.
class Player {
 public:
  explicit Player(GeneralScene scene)
      : scene_(std::move(scene)),
        changes_(changes_of(scene_)),
        engine_(lockstone_general().make(scene_, k_substeps)) {}

  void step(int tick) {
    begin_tick(*engine_, scene_, changes_, tick);
    engine_->step();
  }
  [[nodiscard]] std::size_t count() const { return scene_.bodies.size(); }
  [[nodiscard]] GeneralState state(std::size_t body) const {
    return engine_->state(static_cast<int>(body));
  }

 private:
  GeneralScene scene_;
  std::vector<GeneralChange> changes_;
  std::unique_ptr<GeneralEngine> engine_;
};

void expect_same(const GeneralState& alone, const GeneralState& beside) {
  ASSERT_EQ(alone.position, beside.position);
  ASSERT_EQ(alone.orientation, beside.orientation);
  ASSERT_EQ(alone.velocity, beside.velocity);
  ASSERT_EQ(alone.angular_velocity, beside.angular_velocity);
}

// A member's bodies have their order in the company, behind those of the members before it.
void expect_same_course(const std::vector<GeneralScene>& members, int ticks) {
  GeneralScene together = members.front();
  for (std::size_t i = 1; i < members.size(); ++i)
    append(together, members[i]);
  Player company(together);
  std::vector<Player> alone(members.begin(), members.end());
  for (int tick = 0; tick < ticks; ++tick) {
    company.step(tick);
    std::size_t first = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      alone[i].step(tick);
      for (std::size_t body = 0; body < alone[i].count(); ++body)
        ASSERT_NO_FATAL_FAILURE(expect_same(alone[i].state(body), company.state(first + body)))
            << members[i].family << ':' << members[i].seed << ", body " << body << ", tick "
            << tick;
      first += alone[i].count();
    }
  }
}

// Bodies that come later take the places of others' that went, and so another order.
bool has_late_bodies(const GeneralScene& scene) {
  return std::ranges::any_of(scene.bodies, [](const GeneralBody& body) { return body.from > 0; });
}

TEST(FamilyLocality, LetsScenesGoTheWayTheyGoAlone) {
  const char* more = std::getenv("LOCKSTONE_LOCALITY_TICKS");
  const int ticks = more == nullptr ? k_ticks : std::stoi(more);
  // Scenes in one world have its gravity, which does not turn, and sleep in it or not.
  std::vector<std::vector<GeneralScene>> companies;
  std::uint64_t seed = 20261126;
  for (const Family& family : families()) {
    GeneralScene scene = make_scene(family, seed++);
    if (!scene.pulls.empty() || has_late_bodies(scene)) continue;
    scene.ticks = ticks;  // bodies of long scenes leave beside short ones too
    const auto fits = [&](const std::vector<GeneralScene>& company) {
      return company.size() < k_company && company.front().gravity == scene.gravity &&
             company.front().may_sleep == scene.may_sleep;
    };
    auto company = std::ranges::find_if(companies, fits);
    if (company == companies.end())
      company = companies.insert(company, std::vector<GeneralScene>{});
    shift(scene, k_apart * static_cast<double>(company->size()));
    company->push_back(std::move(scene));
  }
  for (const std::vector<GeneralScene>& company : companies)
    EXPECT_NO_FATAL_FAILURE(expect_same_course(company, ticks));
}

}  // namespace
}  // namespace lockstone::bench
