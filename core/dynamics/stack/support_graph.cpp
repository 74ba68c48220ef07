#include "core/dynamics/stack/support_graph.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/contact/block_words.h"

namespace lockstone {
namespace {

// Bodies that are worth a worker.
constexpr std::uint32_t k_descent_grain = 4;

// n·gain beside the greatest component of the gain: a contact holds a body up where the body's side
// of the normal points more than an eighth against it.
int against(const RawVec3& normal, const SolverBody& body) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(normal[i], body.gain[i]);
  const std::int64_t along = sum.rounded(30), most = body.greatest_gain();
  if (along < -most / 8) return -1;
  return along > most / 8 ? 1 : 0;
}

}  // namespace

SupportGraph::SupportGraph(std::size_t body_capacity, std::size_t contact_capacity)
    : by_body_(body_capacity, contact_capacity) {
  links_.reserve(contact_capacity);
  upper_.reserve(contact_capacity);
  is_supported_.reserve(body_capacity + 1);
  carried_.reserve(body_capacity + 1);
  order_.reserve(body_capacity + 1);
  propagated_.reserve(contact_capacity);
  round_begins_.reserve(body_capacity + 1);
  rounds_.reserve(body_capacity + 1);
}

std::uint32_t SupportGraph::lower_of(std::uint32_t link) const {
  return upper_[link] == links_[link].b ? links_[link].a : links_[link].b;
}

void SupportGraph::find_uppers(const ContactRun& run) {
  by_body_.assign(std::span<const SupportLink>(links_), run.bodies.size());
  LKS_ASSERT(is_reserved(upper_, links_.size()));
  upper_.assign(links_.size(), 0);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const SupportLink& link = links_[i];
    const RawVec3 normal = normal_of(run.blocks[link.block()], link.lane());
    if (link.b != 0 && against(normal, run.bodies[link.b]) < 0)
      upper_[i] = link.b;
    else if (link.a != 0 && against(normal, run.bodies[link.a]) > 0)
      upper_[i] = link.a;
  }
}

// From the top down, beginning with bodies that carry no other. Bodies that carry each other in a
// ring are left out.
void SupportGraph::find_order() {
  carried_.assign(is_supported_.size(), 0);
  for (std::uint32_t i = 0; i < links_.size(); ++i)
    if (rests(i)) ++carried_[lower_of(i)];
  order_.clear();
  const auto add = [&](std::uint32_t body) {
    if (is_supported_[body] == 0 || carried_[body] != 0) return;
    is_supported_[body] = k_visited;
    order_.push_back(body);
  };
  for (std::uint32_t body = 1; body < is_supported_.size(); ++body)
    add(body);
  round_begins_.clear();
  rounds_.clear();
  for (std::size_t begin = 0, end = order_.size(); begin < end; begin = end, end = order_.size()) {
    round_begins_.push_back(static_cast<std::uint32_t>(begin));
    rounds_.push_back({static_cast<std::uint32_t>(end - begin), k_descent_grain});
    for (std::size_t i = begin; i < end; ++i) {
      for (const std::uint32_t link : by_body_.at(order_[i])) {
        const std::uint32_t lower = upper_[link] == order_[i] ? lower_of(link) : 0;
        if (lower == 0) continue;
        LKS_ASSERT(carried_[lower] != 0);
        --carried_[lower];
        add(lower);
      }
    }
  }
}

void SupportGraph::add_propagated(std::uint32_t body, lanes::BodyVelocity& row) const {
  for (const std::uint32_t link : by_body_.at(body))
    if (upper_[link] != 0 && upper_[link] != body) propagated_[link].add_to(row);
}

}  // namespace lockstone
