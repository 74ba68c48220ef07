// The bodies that each body stands on, by the contacts that touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/base/parallel.h"
#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/islands/body_links.h"

namespace lockstone {

/// Supports of one body; more are left out.
inline constexpr std::size_t k_most_supports = 32;

/// A contact that touches.
struct SupportLink : ContactPair {
  std::uint32_t record = 0;
  bool takes_mean = false;    // it is new, and iterated: its mean impulse is not known yet
  bool is_on_ground = false;  // one of its surfaces never moves, and neither is driven
};

/// The velocities that impulses add to a body's row.
struct RowPush {
  RawVec3 velocity{}, spin{};

  void add_to(lanes::BodyVelocity& row) const {
    for (std::size_t i = 0; i < 3; ++i) {
      row.velocity[i] += velocity[i];
      row.spin[i] += spin[i];
    }
  }
};

class SupportGraph {
 public:
  /// No function but this allocates.
  SupportGraph(std::size_t body_capacity, std::size_t contact_capacity);

  void clear() { links_.clear(); }

  /// In the order of the records.
  void add(const SupportLink& link) {
    LKS_ASSERT(link.a != link.b);
    LKS_ASSERT(links_.empty() || links_.back().record < link.record);
    links_.push_back(link);
  }

  /// Finds which bodies stand, over others, on something immovable. `carries(link, upper)` tells
  /// whether a link may support its upper body.
  template <class Carries>
  void find(const ContactRun& run, const Carries& carries) {
    find_uppers(run);
    is_supported_.assign(run.bodies.size(), 0);
    order_.clear();
    const auto add_if_supported = [&](std::uint32_t link, std::uint32_t lower) {
      const std::uint32_t body = upper_[link];
      if (body == 0 || lower_of(link) != lower || is_supported_[body] != 0) return;
      if (!carries(links_[link], body)) return;
      is_supported_[body] = k_supported;
      order_.push_back(body);
    };
    for (std::uint32_t i = 0; i < links_.size(); ++i)
      add_if_supported(i, 0);
    for (std::size_t i = 0; i < order_.size(); ++i)
      for (const std::uint32_t link : by_body_.at(order_[i]))
        add_if_supported(link, order_[i]);
    LKS_ASSERT(order_.size() < is_supported_.size());
    find_order();
  }

  [[nodiscard]] bool is_supported(std::size_t body) const { return is_supported_[body] != 0; }

  /// Calls `visit(body, worker)` for bodies that stand, from the top down: for each after all
  /// bodies that rest on it, whose pushes are in its row by then. In the end other bodies get
  /// theirs.
  template <class Visit>
  void descend(Parallel& parallel, std::span<lanes::BodyVelocity> rows, const Visit& visit) {
    LKS_ASSERT(rows.size() >= is_supported_.size());
    propagated_.assign(links_.size(), {});
    parallel.run_all(rounds_, [&](std::size_t round, std::uint32_t first, std::uint32_t end,
                                  std::uint32_t worker) {
      for (std::uint32_t i = first; i < end; ++i) {
        const std::uint32_t body = order_[round_begins_[round] + i];
        add_propagated(body, rows[body]);
        visit(body, worker);
      }
    });
    for (std::uint32_t body = 1; body < is_supported_.size(); ++body)
      if (is_supported_[body] != k_visited) add_propagated(body, rows[body]);
  }

  /// Adds the pushes of a link: to the row of the body being visited, which rests on it by its side
  /// B or A, and later to the one that carries it.
  void propagate(std::uint32_t link, bool rests_by_b, const RowPush& to_a, const RowPush& to_b,
                 lanes::BodyVelocity& row) {
    (rests_by_b ? to_b : to_a).add_to(row);
    propagated_[link] = rests_by_b ? to_a : to_b;
  }

  /// Calls `visit(link, number)` for the links that a body rests on.
  template <class Visit>
  void for_supports(std::uint32_t body, const Visit& visit) const {
    for (const std::uint32_t link : by_body_.at(body))
      if (upper_[link] == body) visit(links_[link], link);
  }

  [[nodiscard]] std::span<const SupportLink> links() const { return links_; }

 private:
  static constexpr std::uint8_t k_supported = 1, k_visited = 2;

  void find_uppers(const ContactRun& run);
  void find_order();
  void add_propagated(std::uint32_t body, lanes::BodyVelocity& row) const;
  [[nodiscard]] std::uint32_t lower_of(std::uint32_t link) const;
  [[nodiscard]] bool rests(std::uint32_t link) const {
    return upper_[link] != 0 && is_supported_[upper_[link]] != 0;
  }

  std::vector<SupportLink> links_;
  BodyLinks by_body_;
  std::vector<std::uint32_t> upper_;        // by link: the body that rests on the other; 0: none
  std::vector<RowPush> propagated_;         // by link: to the other
  std::vector<std::uint8_t> is_supported_;  // by body: stands, over others, on something immovable
  std::vector<std::uint32_t> carried_;      // by body: contacts that others rest on it by
  std::vector<std::uint32_t> order_;        // bodies, round by round
  std::vector<std::uint32_t> round_begins_;
  std::vector<Loop> rounds_;  // of bodies that have nothing to wait for any more
};

}  // namespace lockstone
