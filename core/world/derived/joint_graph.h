// The joints as a graph over bodies: all of them, those with an awake body, the neighbours of each
// body, and the pairs of bodies that joints exempt from collision. Derived from the joint records.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/collision/broad_phase/pair.h"
#include "core/dynamics/state/joint_record.h"
#include "core/world/derived/joint_neighbours.h"

namespace lockstone {

class JointGraph {
 public:
  /// No function but this allocates.
  JointGraph(std::uint32_t body_capacity, std::uint32_t joint_capacity);

  /// Holds the joints that exist among `joints`, and no others. `exempt_pair(joint)`: as for `add`.
  template <class ExemptPair>
  void rebuild(std::span<const JointRecord> joints, ExemptPair&& exempt_pair) {
    forget_awake_list();
    neighbours_.clear(links_);
    links_.clear();
    exempt_pairs_.clear();
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
      if (!joints[i].exists()) continue;
      links_.push_back({i, joints[i].body_a, joints[i].body_b});
      neighbours_.add(links_.back());
      if (const std::optional<Pair> pair = exempt_pair(joints[i])) exempt_pairs_.push_back(*pair);
    }
    std::ranges::sort(exempt_pairs_);
  }

  /// Adds the joint `link.joint`, which the graph does not hold. `exempt`: the pair of its bodies,
  /// if the joint keeps them from colliding.
  void add(const JointLink& link, const std::optional<Pair>& exempt);

  /// Removes a joint that was added with the same `exempt`.
  void remove(std::uint32_t joint, const std::optional<Pair>& exempt);

  /// Joints of a disabled body do nothing: they are in `links` alone.
  void set_enabled(std::uint32_t body, bool enabled) {
    if ((is_disabled_[body] == 0) == enabled) return;
    is_disabled_[body] = enabled ? 0 : 1;
    forget_awake_list();
  }

  /// All joints, by index.
  [[nodiscard]] std::span<const JointLink> links() const { return links_; }
  [[nodiscard]] bool empty() const { return links_.empty(); }

  /// The pairs that do not collide, ascending; one entry a joint.
  [[nodiscard]] std::span<const Pair> exempt_pairs() const { return exempt_pairs_; }
  [[nodiscard]] bool is_exempt(const Pair& pair) const;

  /// The bodies that joints connect to this one, in the order of the joints.
  [[nodiscard]] JointNeighbours::Range neighbours(std::uint32_t body) const {
    return neighbours_.of(body, is_disabled_);
  }

  /// The joints that work in the tick, by index, as of the last `list_awake`.
  [[nodiscard]] std::span<const JointLink> awake_links() const { return awake_links_; }

  /// Whether no joint and no body's sleep changed since the last `list_awake`.
  [[nodiscard]] bool is_awake_list_current() const { return is_awake_list_current_; }
  void forget_awake_list() { is_awake_list_current_ = false; }

  /// Lists the joints with an awake body again, if anything changed. `is_awake(body)`.
  template <class IsAwake>
  void list_awake(IsAwake&& is_awake) {
    if (is_awake_list_current_) return;
    awake_links_.clear();
    for (const JointLink& link : links_)
      if (works(link) && (is_awake(link.body_a) || is_awake(link.body_b)))
        awake_links_.push_back(link);
    is_awake_list_current_ = true;
  }

 private:
  [[nodiscard]] bool works(const JointLink& link) const {
    return (is_disabled_[link.body_a] | is_disabled_[link.body_b]) == 0;
  }

  std::vector<JointLink> links_;        // by joint
  std::vector<JointLink> awake_links_;  // by joint
  std::vector<Pair> exempt_pairs_;      // ascending
  bool is_awake_list_current_ = false;
  std::vector<std::uint8_t> is_disabled_;  // by body
  JointNeighbours neighbours_;
};

}  // namespace lockstone
