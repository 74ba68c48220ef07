#include "core/dynamics/direct/island_pool.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {

IslandPool::IslandPool(const Capacity& capacity)
    : capacity_(capacity), local_(capacity.numbers), factor_(capacity.bodies, capacity.problems) {
  capacity_.joints = std::min(capacity.joints, capacity.problems);
  islands_.reserve(capacity.bodies);
  bodies_.reserve(capacity.bodies);
  contacts_.reserve(capacity.problems);
  joints_.reserve(capacity_.joints);
  problems_.reserve(capacity.problems);
  blocks_.reserve(capacity.problems);
  velocities_.reserve(2 * capacity.bodies);
  changes_.reserve(2 * capacity.bodies);
  gains_.reserve(2 * capacity.bodies);
  roots_.reserve(2 * capacity.bodies);
  pairs_.reserve(capacity.problems);
}

void IslandPool::clear() {
  islands_.clear();
  bodies_.clear();
  contacts_.clear();
  joints_.clear();
  problems_.clear();
  blocks_.clear();
  velocities_.clear();
  changes_.clear();
  gains_.clear();
  roots_.clear();
  factor_.clear();
  was_full_ = false;
}

PoolShare IslandPool::share(std::uint32_t index) const {
  const Island& island = islands_[index];
  const std::size_t end =
      index + 1 < islands_.size() ? islands_[index + 1].plan.first_target : factor_.sizes().targets;
  return {island.bodies, island.contacts + island.joints, island.joints, island.plan.blocks,
          static_cast<std::uint32_t>(end - island.plan.first_target)};
}

PoolShare IslandPool::room() const {
  const auto narrow = [](std::size_t size) { return static_cast<std::uint32_t>(size); };
  return {narrow(capacity_.bodies), narrow(capacity_.problems), narrow(capacity_.joints),
          narrow(factor_.sizes().most_blocks), narrow(factor_.sizes().most_targets)};
}

IslandPool::Island IslandPool::place(std::size_t bodies, std::size_t contacts,
                                     std::size_t joints) const {
  Island island;
  island.first_body = static_cast<std::uint32_t>(bodies_.size());
  island.bodies = static_cast<std::uint32_t>(bodies);
  island.first_vector = static_cast<std::uint32_t>(velocities_.size());
  island.first_contact = static_cast<std::uint32_t>(contacts_.size());
  island.contacts = static_cast<std::uint32_t>(contacts);
  island.first_joint = static_cast<std::uint32_t>(joints_.size());
  island.joints = static_cast<std::uint32_t>(joints);
  island.first_problem = static_cast<std::uint32_t>(problems_.size());
  return island;
}

bool IslandPool::has_room(std::size_t bodies, std::size_t contacts, std::size_t joints) {
  const bool fits = bodies_.size() + bodies <= capacity_.bodies &&
                    problems_.size() + contacts + joints <= capacity_.problems &&
                    joints_.size() + joints <= capacity_.joints;
  was_full_ = was_full_ || !fits;
  return fits;
}

// Plans the factor of an island. False if it would be too large.
bool IslandPool::plan(Island& island, std::span<const std::uint32_t> bodies,
                      std::span<const IslandContact> contacts,
                      std::span<const IslandJoint> joints) {
  LKS_ASSERT(island.bodies == bodies.size() && std::ranges::is_sorted(bodies));
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    local_[bodies[i]] = i;
  pairs_.clear();
  const auto add_pair = [this](std::uint32_t a, std::uint32_t b) {
    if (a != 0 && b != 0) pairs_.emplace_back(local_[a], local_[b]);
  };
  for (const IslandContact& contact : contacts)
    add_pair(contact.a, contact.b);
  for (const IslandJoint& joint : joints)
    add_pair(joint.a, joint.b);
  LKS_ASSERT(pairs_.size() <= contacts.size() + joints.size());
  return factor_.plan(island.bodies, pairs_, island.plan);
}

bool IslandPool::add(std::span<const std::uint32_t> bodies, std::span<const IslandContact> contacts,
                     std::span<const IslandJoint> joints) {
  LKS_ASSERT(!bodies.empty() && !contacts.empty());
  Island island = place(bodies.size(), contacts.size(), joints.size());
  LKS_ASSERT(is_reserved(bodies_, bodies_.size() + bodies.size()));
  LKS_ASSERT(is_reserved(problems_, problems_.size() + contacts.size() + joints.size()));
  if (!plan(island, bodies, contacts, joints)) return false;
  bodies_.insert(bodies_.end(), bodies.begin(), bodies.end());
  for (const IslandContact& contact : contacts) {
    ProximalContact& added = contacts_.emplace_back();
    added.id = contact.id;
    added.a = contact.a;
    added.b = contact.b;
  }
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  for (const IslandContact& contact : contacts)
    add_problem(island, contact.a, contact.b);
  for (const IslandJoint& joint : joints)
    add_problem(island, joint.a, joint.b);
  const std::size_t vectors = velocities_.size() + bodies.size() + 1;
  LKS_ASSERT(is_reserved(velocities_, vectors));
  velocities_.resize(vectors);
  changes_.resize(vectors);
  gains_.resize(vectors);
  roots_.resize(vectors);
  islands_.push_back(island);
  return true;
}

void IslandPool::add_problem(const Island& island, std::uint32_t a, std::uint32_t b) {
  lanes::ProximalBlock& problem = problems_.emplace_back();
  problem.a = a != 0 ? local_[a] : island.bodies;
  problem.b = b != 0 ? local_[b] : island.bodies;
  LKS_ASSERT(problem.a != problem.b);
  MatrixBlocks blocks;
  if (a != 0) blocks.a = factor_.diagonal(island.plan, problem.a);
  if (b != 0) blocks.b = factor_.diagonal(island.plan, problem.b);
  if (a != 0 && b != 0) blocks.both = factor_.find(island.plan, problem.a, problem.b);
  blocks_.push_back(blocks);
}

IslandView IslandPool::view(std::uint32_t index) {
  LKS_ASSERT(index < count());
  Island& island = islands_[index];
  const std::size_t problems = std::size_t{island.contacts} + island.joints;
  const std::size_t vectors = std::size_t{island.bodies} + 1;
  const auto of = [&](auto& all) { return std::span(all).subspan(island.first_vector, vectors); };
  return {island.state,
          island.plan,
          std::span(bodies_).subspan(island.first_body, island.bodies),
          std::span(contacts_).subspan(island.first_contact, island.contacts),
          std::span(joints_).subspan(island.first_joint, island.joints),
          std::span(problems_).subspan(island.first_problem, problems),
          std::span(blocks_).subspan(island.first_problem, problems),
          of(velocities_),
          of(changes_),
          of(gains_),
          of(roots_)};
}

}  // namespace lockstone
