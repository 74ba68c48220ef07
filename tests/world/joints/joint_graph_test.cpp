// The graph of joints agrees with a list of joints after any order of additions and removals.

#include "core/world/derived/joint_graph.h"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_bodies = 12;
constexpr std::uint32_t k_joints = 30;

struct Joint {
  JointLink link;
  std::optional<Pair> exempt;
};

class JointGraphTest : public ::testing::Test {
 protected:
  void add(std::uint32_t joint) {
    const auto a = static_cast<std::uint32_t>(random.between(0, k_bodies - 2));
    const auto b = static_cast<std::uint32_t>(random.between(a + 1, k_bodies - 1));
    std::optional<Pair> exempt;
    if (random.between(0, 1) == 0) exempt = Pair{a, b};
    joints[joint] = {{joint, a, b}, exempt};
    graph.add(joints[joint].link, exempt);
  }
  void remove(std::uint32_t joint) {
    graph.remove(joint, joints[joint].exempt);
    joints.erase(joint);
  }
  void change_one() {
    const auto joint = static_cast<std::uint32_t>(random.between(0, k_joints - 1));
    if (joints.contains(joint)) {
      remove(joint);
    } else {
      add(joint);
    }
  }
  [[nodiscard]] std::vector<std::uint32_t> neighbours_by_list(std::uint32_t body) const {
    std::vector<std::uint32_t> found;
    for (const auto& [index, joint] : joints) {
      if (disabled[joint.link.body_a] || disabled[joint.link.body_b]) continue;
      if (joint.link.body_a == body) found.push_back(joint.link.body_b);
      if (joint.link.body_b == body) found.push_back(joint.link.body_a);
    }
    return found;
  }

  [[nodiscard]] std::vector<std::uint32_t> neighbours_of(std::uint32_t body) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t other : graph.neighbours(body))
      found.push_back(other);
    return found;
  }

  test::Random random;
  bool disabled[k_bodies] = {};
  JointGraph graph{k_bodies, k_joints};
  std::map<std::uint32_t, Joint> joints;  // the reference
};

TEST_F(JointGraphTest, ListsJointsByIndex) {
  for (int change = 0; change < 300; ++change) {
    change_one();
    ASSERT_EQ(graph.links().size(), joints.size());
    auto link = graph.links().begin();
    for (const auto& [index, joint] : joints) {
      ASSERT_EQ(link->joint, index);
      ASSERT_EQ(link->body_a, joint.link.body_a);
      ASSERT_EQ(link->body_b, joint.link.body_b);
      ++link;
    }
  }
}

TEST_F(JointGraphTest, NamesNeighboursInTheOrderOfJoints) {
  for (int change = 0; change < 300; ++change) {
    change_one();
    for (std::uint32_t body = 0; body < k_bodies; ++body) {
      ASSERT_EQ(neighbours_of(body), neighbours_by_list(body));
      ASSERT_EQ(graph.neighbours(body).empty(), neighbours_by_list(body).empty());
      ASSERT_EQ(graph.neighbours(body).has_one(), neighbours_by_list(body).size() == 1);
    }
  }
}

TEST_F(JointGraphTest, NamesNoNeighboursByJointsOfDisabledBodies) {
  for (int change = 0; change < 300; ++change) {
    change_one();
    const auto changed = static_cast<std::uint32_t>(random.between(0, k_bodies - 1));
    disabled[changed] = !disabled[changed];
    graph.set_enabled(changed, !disabled[changed]);
    for (std::uint32_t body = 0; body < k_bodies; ++body)
      ASSERT_EQ(neighbours_of(body), neighbours_by_list(body));
  }
}

TEST_F(JointGraphTest, NamesTheSameNeighboursOnceItIsRebuilt) {
  for (int change = 0; change < 100; ++change)
    change_one();
  std::vector<JointRecord> records(k_joints);
  for (int round = 0; round < 3; ++round) {
    change_one();
    records.assign(k_joints, {});
    for (const auto& [index, joint] : joints) {
      records[index].kind = 1;
      records[index].body_a = joint.link.body_a;
      records[index].body_b = joint.link.body_b;
    }
    graph.rebuild(records, [&](const JointRecord& record) {
      return joints[static_cast<std::uint32_t>(&record - records.data())].exempt;
    });
    for (std::uint32_t body = 0; body < k_bodies; ++body)
      ASSERT_EQ(neighbours_of(body), neighbours_by_list(body));
  }
}

TEST_F(JointGraphTest, ExemptsAPairAsLongAsOneJointDoes) {
  for (int change = 0; change < 300; ++change) {
    change_one();
    ASSERT_TRUE(std::ranges::is_sorted(graph.exempt_pairs()));
    for (std::uint32_t a = 0; a < k_bodies; ++a) {
      for (std::uint32_t b = a + 1; b < k_bodies; ++b) {
        const bool exempt = std::ranges::any_of(joints, [&](const auto& entry) {
          return entry.second.exempt == std::optional(Pair{a, b});
        });
        ASSERT_EQ(graph.is_exempt({a, b}), exempt);
      }
    }
  }
}

TEST_F(JointGraphTest, ListsJointsWithAnAwakeBody) {
  for (int change = 0; change < 100; ++change) {
    change_one();
    ASSERT_FALSE(graph.is_awake_list_current());
    const auto sleeper = static_cast<std::uint32_t>(random.between(0, k_bodies - 1));
    graph.list_awake([&](std::uint32_t body) { return body != sleeper && body % 2 == 0; });
    ASSERT_TRUE(graph.is_awake_list_current());
    const auto is_awake = [&](std::uint32_t body) { return body != sleeper && body % 2 == 0; };
    const auto awake = std::ranges::count_if(joints, [&](const auto& entry) {
      return is_awake(entry.second.link.body_a) || is_awake(entry.second.link.body_b);
    });
    ASSERT_EQ(std::ssize(graph.awake_links()), awake);
  }
}

}  // namespace
}  // namespace lockstone
