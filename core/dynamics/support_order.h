// Who stands on whom, by the contacts that touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body_links.h"
#include "core/dynamics/row_geometry.h"

namespace lockstone {

/// A contact that touches.
struct SupportLink : ContactPair {
  std::uint32_t record = 0;
  bool is_new = false;
  bool is_on_ground = false;  // one of its surfaces never moves, and neither is driven
};

class SupportOrder {
 public:
  /// No function but this allocates.
  SupportOrder(std::size_t body_capacity, std::size_t contact_capacity);

  void clear() { links_.clear(); }

  /// In the order of the records.
  void add(const SupportLink& link) { links_.push_back(link); }

  /// Finds which bodies stand, over others, on something immovable. `carries(link, upper)` tells
  /// whether a link may hold up its upper body.
  template <class Carries>
  void find(const ContactRun& run, const Carries& carries) {
    find_uppers(run);
    is_held_.assign(run.bodies.size(), 0);
    order_.clear();
    const auto hold = [&](std::uint32_t link, std::uint32_t lower) {
      const std::uint32_t body = upper_[link];
      if (body == 0 || lower_of(link) != lower || is_held_[body] != 0) return;
      if (!carries(links_[link], body)) return;
      is_held_[body] = 1;
      order_.push_back(body);
    };
    for (std::uint32_t i = 0; i < links_.size(); ++i)
      hold(i, 0);
    for (std::size_t i = 0; i < order_.size(); ++i)
      for (const std::uint32_t link : by_body_.at(order_[i]))
        hold(link, order_[i]);
    find_order();
  }

  /// Bodies that stand, downwards from what carries nothing.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
  [[nodiscard]] bool is_held(std::size_t body) const { return is_held_[body] != 0; }

  /// Visits the links that a body rests on.
  template <class Visit>
  void for_supports(std::uint32_t body, const Visit& visit) const {
    for (const std::uint32_t link : by_body_.at(body))
      if (upper_[link] == body) visit(links_[link]);
  }

 private:
  void find_uppers(const ContactRun& run);
  void find_order();
  [[nodiscard]] std::uint32_t lower_of(std::uint32_t link) const;
  [[nodiscard]] bool rests(std::uint32_t link) const {
    return upper_[link] != 0 && is_held_[upper_[link]] != 0;
  }

  std::vector<SupportLink> links_;
  BodyLinks by_body_;
  std::vector<std::uint32_t> upper_;    // by link: the body that rests on the other; 0: none
  std::vector<std::uint8_t> is_held_;   // by body: stands, over others, on something immovable
  std::vector<std::uint32_t> carried_;  // by body: contacts that others rest on it by
  std::vector<std::uint32_t> order_;    // bodies
};

}  // namespace lockstone
