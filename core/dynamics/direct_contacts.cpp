// Which contacts are solved at once.

#include <algorithm>

#include "core/dynamics/direct_words.h"
#include "core/dynamics/mass_share.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::ManifoldBlock;

// What is a tenth of its pair's mass, or less, is light beside the other.
constexpr std::int32_t k_light_share = (1 << 30) / 10;

// What hangs together with a light body may have so many contacts, or with a loaded one; a system.
constexpr std::size_t k_most_of_light = 32;
constexpr std::size_t k_most_of_loaded = 128;
constexpr std::size_t k_most_of_group = 160;

// All systems of a world.
constexpr std::size_t k_most_contacts = 1024;

// Where friction carries, what is farther apart is left to the sweeps, Q24: 1 mm.
constexpr std::int64_t k_most_apart = (std::int64_t{1} << 24) / 1000;

// The share of the other end's inverse mass is light beside this one's.
bool is_heavy_beside(const DirectContacts::Link& link, std::uint32_t body) {
  const std::int32_t other = link.a == body ? link.share_b : (1 << 30) - link.share_b;
  return other <= k_light_share;
}

}  // namespace

DirectContacts::DirectContacts(std::size_t body_capacity, std::size_t pushed_capacity,
                               std::size_t contact_capacity)
    : by_body_(body_capacity, contact_capacity),
      factors_{JointFactor(std::min(contact_capacity, k_most_contacts)),
               JointFactor(std::min(contact_capacity, k_most_contacts))} {
  const std::size_t most = std::min(contact_capacity, k_most_contacts) + k_most_of_loaded;
  links_.reserve(contact_capacity);
  left_out_.reserve(body_capacity);
  marks_.reserve(body_capacity + 1);
  link_marks_.reserve(contact_capacity);
  queue_.reserve(pushed_capacity + 1);
  chosen_.reserve(contact_capacity);
  order_.reserve(contact_capacity);
  place_.reserve(contact_capacity);
  holds_.reserve(std::min(contact_capacity, k_most_of_group));
  bodies_.reserve(2 * most);
  gains_.reserve(2 * most);
  gain_place_.reserve(body_capacity + 1);
  contacts_.reserve(most);
  ties_.reserve(most);
  groups_.reserve(most);
}

void DirectContacts::clear() {
  links_.clear();
  left_out_.clear();
  contacts_.clear();
  bodies_.clear();
  gains_.clear();
  ties_.clear();
  groups_.clear();
  for (JointFactor& factor : factors_)
    factor.clear();
}

bool DirectContacts::is_uneven(std::int32_t share_b) {
  const std::int32_t share_a = (1 << 30) - share_b;
  const std::int32_t least = std::min(share_a, share_b);
  return least > 0 && least <= k_light_share;
}

// Whether gravity and forces push the heavy body towards the light one: n·gain, Q32.
bool DirectContacts::is_pressed(const ContactRun& run, const Link& link, bool heavy_is_b) const {
  const ManifoldBlock& block = run.blocks[link.block()];
  const std::size_t lane = link.lane();
  const RawVec3 n = normal_of(block, lane);
  const SolverBody& heavy = run.bodies[heavy_is_b ? link.b : link.a];
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(n[i], heavy_is_b ? -heavy.gain[i] : heavy.gain[i]);
  const std::int64_t most = heavy.greatest_gain();
  return most > 0 && sum.rounded(30) > most / 4;
}

void DirectContacts::plan(const ContactRun& run) {
  marks_.assign(run.bodies.size(), Mark::none);
  link_marks_.assign(links_.size(), Mark::none);
  place_.assign(links_.size(), 0);
  gain_place_.resize(run.bodies.size());
  chosen_.clear();
  by_body_.assign(std::span<const Link>(links_), run.bodies.size());
  for (const std::uint32_t body : left_out_)
    marks_[body] = Mark::dropped;
  for (const Link& link : links_) {
    if (!is_uneven(link.share_b)) continue;
    const bool heavy_is_b = link.share_b <= k_light_share;
    if (is_pressed(run, link, heavy_is_b)) gather(heavy_is_b ? link.a : link.b, k_most_of_light);
  }
  for (const Link& link : links_)
    if (link.is_loaded) gather(link.share_b >= 1 << 29 ? link.b : link.a, k_most_of_loaded);
  order_.clear();
  for (const std::uint32_t index : chosen_)
    if (link_marks_[index] == Mark::chosen) plan_group(run, index);
}

// All contacts of a light body, and of what holds it up, as far as that is not heavy beside it.
void DirectContacts::gather(std::uint32_t light, std::size_t most) {
  if (marks_[light] != Mark::none) return;
  const std::size_t first = chosen_.size();
  queue_.assign(1, light);
  marks_[light] = Mark::chosen;
  if (gather_all(first, most)) return;
  for (const std::uint32_t body : queue_)
    marks_[body] = Mark::dropped;
  drop(first);
}

bool DirectContacts::gather_all(std::size_t first, std::size_t most) {
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (!gather_body(queue_[i])) return false;
    if (chosen_.size() - first > most) return false;
  }
  return chosen_.size() <= k_most_contacts;
}

bool DirectContacts::gather_body(std::uint32_t body) {
  for (const std::uint32_t index : by_body_.at(body)) {
    const Link& link = links_[index];
    if (link_marks_[index] == Mark::none) {
      link_marks_[index] = Mark::chosen;
      chosen_.push_back(index);
    }
    const std::uint32_t other = link.a == body ? link.b : link.a;
    if (other == 0) continue;
    if (marks_[other] == Mark::dropped) return false;
    if (marks_[other] == Mark::chosen || is_heavy_beside(link, body)) continue;
    marks_[other] = Mark::chosen;
    queue_.push_back(other);
  }
  return true;
}

void DirectContacts::drop(std::size_t first) {
  for (std::size_t i = first; i < chosen_.size(); ++i)
    link_marks_[chosen_[i]] = Mark::none;
  chosen_.resize(first);
}

// Whether two of those in `order_` push against each other from what nothing moves: rigid contacts
// would do so without end.
bool DirectContacts::is_squeezed(const ContactRun& run) {
  constexpr std::int64_t k_against = -(std::int64_t{1} << 57);  // cosine of -1/8, Q60
  holds_.clear();
  for (const std::uint32_t index : order_) {
    const Link& link = links_[index];
    if (link.a != 0 && link.b != 0) continue;
    const ManifoldBlock& block = run.blocks[link.block()];
    const std::size_t lane = link.lane();
    const bool pushes = std::ranges::any_of(block.points, [lane](const ManifoldBlock::Point& p) {
      return low_word(p.impulse[lane]) != 0;
    });
    if (!pushes) continue;
    RawVec3 hold = normal_of(block, lane);
    if (link.b == 0) hold = negated(hold);
    for (const RawVec3& other : holds_)
      if (hold[0] * other[0] + hold[1] * other[1] + hold[2] * other[2] < k_against) return true;
    holds_.push_back(hold);
  }
  return false;
}

// What hangs together with a contact through chosen ones, breadth first: backwards, each contact of
// a tree comes after those beyond it, so that elimination fills nothing in.
void DirectContacts::plan_group(const ContactRun& run, std::uint32_t root) {
  Group group;
  group.first = static_cast<std::uint32_t>(contacts_.size());
  order_.assign(1, root);
  link_marks_[root] = Mark::dropped;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    for (const std::uint32_t body : {links_[order_[i]].a, links_[order_[i]].b}) {
      if (body == 0) continue;
      for (const std::uint32_t index : by_body_.at(body)) {
        if (link_marks_[index] != Mark::chosen) continue;
        link_marks_[index] = Mark::dropped;
        order_.push_back(index);
      }
    }
  }
  group.leans = leans(run);
  if (group.leans) {
    std::erase_if(order_,
                  [&](std::uint32_t index) { return is_apart(run, links_[index], k_most_apart); });
    group.is_new = std::ranges::none_of(
        order_, [&](std::uint32_t index) { return push_of(run, links_[index]) != 0; });
  }
  group.count = static_cast<std::uint32_t>(order_.size());
  if (group.count == 0 || group.count > k_most_of_group || is_squeezed(run)) return;
  std::reverse(order_.begin(), order_.end());
  for (std::uint32_t k = 0; k < group.count; ++k) {
    place_[order_[k]] = k + 1;
    const Link& link = links_[order_[k]];
    contacts_.push_back({{link}, link.row_a, link.row_b});
  }
  if (!plan_factor(group)) return contacts_.resize(group.first);
  for (Contact& contact : contacts_of(group))
    take_over(run, contact);
  list_bodies(run, group);
  groups_.push_back(group);
}

// From here on the sweeps leave its normal impulses alone: they only do its friction.
void DirectContacts::take_over(const ContactRun& run, Contact& contact) {
  find_masses(run, contact);
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  block.soft[lane] = low_word(block.soft[lane]) + (std::int64_t{1} << 62);
  block.rest[lane] = 0;
  block.mass_01[lane] = block.mass_23[lane] = 0;
  block.common[lane] -= contact.common_mass;
}

// Its bodies, and what impulses are believed: bodies at rest that are alike cannot ask for more.
void DirectContacts::list_bodies(const ContactRun& run, Group& group) {
  constexpr std::int64_t k_most_of_uneven = std::int64_t{1} << 44;  // 4096 m/s, Q32
  std::int64_t fastest = 0;
  const bool is_alike = std::ranges::none_of(
      order_, [&](std::uint32_t index) { return is_uneven(links_[index].share_b); });
  group.first_body = static_cast<std::uint32_t>(bodies_.size());
  for (const Contact& contact : contacts_of(group)) {
    for (const std::uint32_t body : {contact.a, contact.b}) {
      if (body == 0 || marks_[body] == Mark::listed) continue;
      marks_[body] = Mark::listed;
      gain_place_[body] = static_cast<std::uint32_t>(bodies_.size());
      bodies_.push_back(body);
      for (const std::int64_t gain : run.bodies[body].gain)
        fastest = std::max({fastest, gain, -gain});
    }
  }
  gains_.resize(bodies_.size());
  const std::int64_t each = 8 * std::min(fastest, std::int64_t{1} << 38) + (std::int64_t{1} << 30);
  group.most = is_alike ? group.count * each + (std::int64_t{1} << 33) : k_most_of_uneven;
  group.body_count = static_cast<std::uint32_t>(bodies_.size()) - group.first_body;
}

bool DirectContacts::plan_factor(Group& group) {
  const auto neighbours = [&](std::uint32_t k, const auto& emit) {
    const Contact& contact = contacts_[group.first + k];
    for (const std::uint32_t body : {contact.a, contact.b}) {
      if (body == 0) continue;
      for (const std::uint32_t other : by_body_.at(body))
        if (place_[other] != 0) emit(place_[other] - 1);
    }
  };
  const auto plan = [&](std::size_t which, bool leans) {
    const auto rows = [leans](std::uint32_t) -> std::uint32_t {
      return static_cast<std::uint32_t>(leans ? k_factor_rows : lanes::k_block_points);
    };
    const bool fits =
        factors_[which].plan(group.count, neighbours, rows, leans ? k_factor_rows : k_joint_axes);
    group.columns[which] = factors_[which].first();
    return fits;
  };
  if (group.leans && plan(0, true)) return plan(1, false);
  group.leans = false;
  return plan(0, false);
}

}  // namespace lockstone
