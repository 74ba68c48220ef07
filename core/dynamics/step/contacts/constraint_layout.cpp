#include "core/dynamics/step/contacts/constraint_layout.h"

#include <algorithm>

#include "core/base/reserved.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;

// The least number of contacts in a piece of a loop: about a microsecond of work.
constexpr std::uint32_t k_contact_grain = 256;

constexpr std::size_t blocks_for(std::size_t contacts) {
  return (contacts + k_block_lanes - 1) / k_block_lanes;
}

}  // namespace

ConstraintLayout::ConstraintLayout(std::size_t body_capacity, std::size_t contact_capacity)
    : graph_(body_capacity + contact_capacity, contact_capacity) {
  contacts_.reserve(most_blocks(contact_capacity) * k_block_lanes);
}

// Each colour may leave one block half empty, but none without a contact.
std::size_t ConstraintLayout::most_blocks(std::size_t contact_capacity) {
  return std::min(contact_capacity, blocks_for(contact_capacity) + k_graph_colors);
}

// Kernels do less where all manifolds of a vector have one point, or no more than two.
std::size_t ConstraintLayout::kind_of(const Manifold& manifold) {
  LKS_ASSERT(manifold.count >= 0);
  return static_cast<std::size_t>(std::clamp(manifold.count, 1, 3) - 1);
}

void ConstraintLayout::color_contacts(const ContactScene& scene, const SolverBodies& bodies,
                                      const ContactList& contacts) {
  graph_.clear();
  for (std::uint32_t number = 1; number < bodies.count(); ++number)
    graph_.add_body();
  const auto is_pushed = [&](BodyRef body) {
    return !body.is_standing() && bodies.side(body.number()).is_dynamic();
  };
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    const bool a = is_pushed(contact.a), b = is_pushed(contact.b);
    graph_.add(a ? contact.a.number() : 0, a, b ? contact.b.number() : 0, b,
               kind_of(scene.manifolds[contact.manifold]));
  });
}

void ConstraintLayout::build(const ContactScene& scene, const SolverBodies& bodies,
                             const ContactList& contacts, Parallel& parallel) {
  color_contacts(scene, bodies, contacts);
  block_count_ = 0;
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    ranges_[color] = {block_count_, blocks_for(graph_.count(color))};
    auto first = static_cast<std::uint32_t>(block_count_ * k_block_lanes);
    for (std::size_t kind = 0; kind < k_constraint_kinds; ++kind) {
      first_lanes_[color][kind] = first;
      first += graph_.count(color, kind);
    }
    block_count_ += ranges_[color].count;
  }
  LKS_ASSERT(is_reserved(contacts_, lane_count()));
  if (contacts_.size() < lane_count()) contacts_.resize(lane_count());
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    const std::size_t begin = ranges_[color].first, end = begin + ranges_[color].count;
    for (std::size_t i = begin * k_block_lanes + graph_.count(color); i < end * k_block_lanes; ++i)
      contacts_[i] = {k_no_contact};
  }
  parallel.for_each({contacts.size(), k_contact_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                      for (std::uint32_t i = first; i < end; ++i)
                        contacts_[lane_of({i}).value] = {i};
                    });
}

}  // namespace lockstone
