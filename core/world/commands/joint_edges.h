// The joints of each body, for traversals along them. Derived.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/state/joint_record.h"

namespace lockstone {

class JointEdges {
 public:
  /// No function but this allocates.
  JointEdges(std::uint32_t body_capacity, std::uint32_t joint_capacity)
      : begins_(std::size_t{body_capacity} + 1) {
    others_.reserve(std::size_t{2} * joint_capacity);
  }

  /// The joints changed.
  void clear() { is_current_ = false; }

  /// Bodies that a joint ties to this one, in the order of joints. `links` are all joints.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t body,
                                                  std::span<const JointLink> links) {
    if (links.empty()) return {};
    if (!is_current_) rebuild(links);
    return std::span(others_).subspan(begins_[body], begins_[body + 1] - begins_[body]);
  }

 private:
  // Counts, then fills each body's part from its end to its beginning.
  void rebuild(std::span<const JointLink> links) {
    std::fill(begins_.begin(), begins_.end(), 0U);
    for (const JointLink& link : links) {
      ++begins_[link.body_a];
      ++begins_[link.body_b];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& begin : begins_)
      begin = sum += begin;
    others_.resize(std::size_t{2} * links.size());
    for (std::size_t i = links.size(); i-- > 0;) {
      others_[--begins_[links[i].body_a]] = links[i].body_b;
      others_[--begins_[links[i].body_b]] = links[i].body_a;
    }
    is_current_ = true;
  }

  std::vector<std::uint32_t> begins_;  // by body: where its part begins
  std::vector<std::uint32_t> others_;  // part by part
  bool is_current_ = false;
};

}  // namespace lockstone
