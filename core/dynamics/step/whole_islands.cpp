#include "core/dynamics/step/whole_islands.h"

#include <utility>

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {

WholeIslands::WholeIslands(std::size_t body_capacity, std::size_t converged_contacts,
                           std::size_t joint_capacity, int substeps, const Parts& parts,
                           ConvergedIslands& converged)
    : parts_(parts), converged_(converged), substeps_(substeps) {
  islands_.reserve(body_capacity);
  bodies_.reserve(body_capacity + converged_contacts);
  clusters_.reserve(joint_capacity);
}

void WholeIslands::plan() {
  islands_.clear();
  bodies_.clear();
  clusters_.clear();
  converged_count_ = contact_count_ = 0;
  find_candidates();
  count_clusters();
  choose();
  list_clusters();
  for (Island& island : islands_)
    list_bodies(island);
  LKS_ASSERT(bodies_.size() >= islands_.size() && converged_count_ <= islands_.size());
}

// Islands that are converged are numbered in the order of the tick's islands.
void WholeIslands::find_candidates() {
  std::uint32_t converged = 0;
  for (std::uint32_t i = 1; i < parts_.islands.count(); ++i) {
    IslandTally& tally = parts_.islands.tally(i);
    LKS_ASSERT(tally.whole == 0);
    const std::uint32_t number = tally.is_converged ? converged++ : k_no_contacts;
    if (!tally.is_converged && tally.contacts != 0) continue;
    if (tally.has_ball_impacts || (tally.contacts == 0 && tally.joints == 0)) continue;
    LKS_ASSERT(is_reserved(islands_, islands_.size() + 1));
    Island& island = islands_.emplace_back();
    island.island = i;
    island.converged = number;
    island.watched = parts_.energy_limit.number_of(i);
    tally.whole = static_cast<std::uint32_t>(islands_.size());
  }
  LKS_ASSERT(converged == converged_.count());
}

std::uint32_t& WholeIslands::entry_of_cluster(std::uint32_t cluster) {
  const std::uint32_t body = parts_.joints.solver().whole_clusters().body_of(cluster);
  LKS_ASSERT(parts_.islands.of(BodyRef::numbered(body)) != 0);
  return parts_.islands.tally(parts_.islands.of(BodyRef::numbered(body))).whole;
}

void WholeIslands::count_clusters() {
  const WholeClusters& clusters = parts_.joints.solver().whole_clusters();
  for (std::uint32_t i = 0; i < parts_.joints.solver().cluster_count(); ++i) {
    const std::uint32_t entry = entry_of_cluster(i);
    if (entry == 0) continue;
    LKS_ASSERT(entry <= islands_.size());
    Island& island = islands_[entry - 1];
    ++island.clusters;
    island.joints += clusters.joint_count(i);
    island.is_apart = island.is_apart && clusters.is_apart(i);
  }
}

// Keeps the candidates whose joints are all in clusters of their own.
void WholeIslands::choose() {
  std::erase_if(islands_, [this](const Island& island) {
    IslandTally& tally = parts_.islands.tally(island.island);
    tally.whole = 0;
    LKS_ASSERT(island.joints <= tally.joints);
    return !island.is_apart || island.joints != tally.joints;
  });
  std::uint32_t number = 0, clusters = 0;
  for (Island& island : islands_) {
    parts_.islands.tally(island.island).whole = ++number;
    island.first_cluster = clusters;
    clusters += std::exchange(island.clusters, 0);  // `list_clusters` counts them again
  }
  LKS_ASSERT(is_reserved(clusters_, clusters));
  clusters_.resize(clusters);
}

void WholeIslands::list_clusters() {
  for (std::uint32_t i = 0; i < parts_.joints.solver().cluster_count(); ++i) {
    const std::uint32_t entry = entry_of_cluster(i);
    if (entry == 0) continue;
    Island& island = islands_[entry - 1];
    LKS_ASSERT(island.first_cluster + island.clusters < clusters_.size());
    clusters_[island.first_cluster + island.clusters++] = i;
    parts_.joints.solver().whole_clusters().take(i);
  }
}

void WholeIslands::list_bodies(Island& island) {
  island.first_body = static_cast<std::uint32_t>(bodies_.size());
  converged_.lists().for_bodies(island.island,
                                [&](std::uint32_t number) { add_body(island, number); });
  LKS_ASSERT(island.bodies == parts_.islands.tally(island.island).bodies);
  if (island.converged != k_no_contacts) take_contacts(island);
}

void WholeIslands::add_body(Island& island, std::uint32_t number) {
  LKS_ASSERT(is_reserved(bodies_, bodies_.size() + 1));
  LKS_ASSERT(!parts_.bodies.constants()[number].is_whole);
  bodies_.push_back(number);
  ++island.bodies;
  parts_.bodies.constants()[number].is_whole = true;
}

// Bodies that move by themselves have a number in each of their contacts.
void WholeIslands::take_contacts(Island& island) {
  ++converged_count_;
  const IslandView view = converged_.take(island.converged);
  LKS_ASSERT(parts_.islands.all().of(view.bodies[0]) == island.island);
  contact_count_ += static_cast<std::uint32_t>(view.contacts.size());
  for (ProximalContact& contact : view.contacts) {
    contact.is_whole = true;
    for (const BodyRef body : {parts_.contacts[contact.id].a, parts_.contacts[contact.id].b})
      if (!body.is_standing() && parts_.islands.of(body) == 0) add_body(island, body.number());
  }
}

void WholeIslands::leave_out(TickWork& work) const {
  LKS_ASSERT(bodies_.size() < work.bodies && clusters_.size() <= work.clusters);
  LKS_ASSERT(converged_count_ <= work.converged && contact_count_ <= parts_.contacts.size());
  work.whole = static_cast<std::uint32_t>(islands_.size());
  work.relaxes = work.relaxes && contact_count_ != parts_.contacts.size();
  if (bodies_.size() + 1 == work.bodies) work.staged_bodies = 0;
  if (converged_count_ == work.converged) work.converged = 0;
  if (clusters_.size() != work.clusters) return;
  work.clusters = 0;
  // Bodies that coloured balls alone hold are in no cluster.
  if (work.ball_blocks == BlockCounts{}) work.joined = 0;
}

void WholeIslands::solve(std::size_t first, std::size_t end) {
  LKS_ASSERT(first <= end && end <= islands_.size());
  for (std::size_t i = first; i < end; ++i)
    solve(islands_[i]);
}

void WholeIslands::solve(const Island& island) {
  LKS_ASSERT(island.bodies > 0 && parts_.islands.tally(island.island).whole != 0);
  for (int substep = 0; substep < substeps_; ++substep) {
    push(island, substep == 0);
    relax(island);
  }
  if (island.converged != k_no_contacts) converged_.end(parts_.constraints.run(), island.converged);
}

// Until positions move.
void WholeIslands::push(const Island& island, bool is_first) {
  const JointRun joints = parts_.joints.run();
  WholeClusters& clusters = parts_.joints.solver().whole_clusters();
  const std::span own = std::span(clusters_).subspan(island.first_cluster, island.clusters);
  const bool is_watched = island.watched != EnergyLimit::k_unwatched;
  LKS_ASSERT(!is_watched || parts_.energy_limit.island(island.watched) == island.island);
  if (is_watched) parts_.energy_limit.note(energy_bodies(), island.watched);
  for (const std::uint32_t number : std::span(bodies_).subspan(island.first_body, island.bodies))
    parts_.bodies.integrate_velocity(is_first, number);
  for (const std::uint32_t cluster : own)
    clusters.warm_start(joints, cluster);
  if (island.converged != k_no_contacts)
    converged_.solve(parts_.constraints.run(), parts_.joints, island.converged, true);
  for (const std::uint32_t cluster : own)
    clusters.solve(joints, cluster);
  if (is_watched) parts_.energy_limit.limit_moves(energy_bodies(), island.watched);
}

// Positions move, then the rest of the substep. Only contacts ask how far a body travelled.
void WholeIslands::relax(const Island& island) {
  const JointRun joints = parts_.joints.run();
  WholeClusters& clusters = parts_.joints.solver().whole_clusters();
  const std::span own = std::span(clusters_).subspan(island.first_cluster, island.clusters);
  for (const std::uint32_t number : std::span(bodies_).subspan(island.first_body, island.bodies))
    if (number < parts_.joints.first_without_contacts()) parts_.bodies.integrate_position(number);
  LKS_ASSERT(island.first_body + island.bodies <= bodies_.size());
  for (const std::uint32_t cluster : own)
    clusters.move(joints, cluster);
  for (const std::uint32_t cluster : own)
    clusters.relax(joints, cluster);
  if (island.converged != k_no_contacts) {
    const ContactRun run = parts_.constraints.run();
    const std::span<const ProximalContact> contacts = converged_.contacts(island.converged);
    for (const ProximalContact& contact : contacts)
      lanes::move_separations(parts_.bodies.travel().data(), run.blocks[contact.block()],
                              contact.lane(), run.params);
    converged_.solve(run, parts_.joints, island.converged, false);
  }
  if (island.watched != EnergyLimit::k_unwatched)
    parts_.energy_limit.limit_gains(energy_bodies(), island.watched);
  if (island.converged == k_no_contacts || parts_.totals.empty()) return;
  for (const ProximalContact& contact : converged_.contacts(island.converged))
    parts_.totals.note(parts_.constraints.run(), contact.id);
}

EnergyLimit::Bodies WholeIslands::energy_bodies() {
  return {parts_.bodies, parts_.islands.all(), parts_.joints.solver()};
}

}  // namespace lockstone
