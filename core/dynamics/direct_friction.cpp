// Friction that carries: solved at once with the normals of its group.

#include <algorithm>

#include "core/dynamics/direct_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::ManifoldBlock;
using lanes::scalar::pack;

// What bears a greater part of its load by friction leans: 2^-3.
constexpr int k_leaning_shift = 3;

// What slides faster is left to the sweeps, Q50: 1/16 m/s.
constexpr std::int64_t k_sliding_speed = std::int64_t{1} << (lanes::k_velocity_bits - 4);

// |friction| > push/8; Q20.
bool leans_on_friction(const ManifoldBlock& block, std::size_t lane, std::int64_t push) {
  const std::int64_t t = low_word(block.friction[lane]), b = high_word(block.friction[lane]);
  const std::uint64_t size = static_cast<std::uint64_t>(t * t) + static_cast<std::uint64_t>(b * b);
  return (UInt128{0, size} << (2 * k_leaning_shift)) >
         multiply_wide(static_cast<std::uint64_t>(push), static_cast<std::uint64_t>(push));
}

// |gain| · 0.99 > |n·gain|: the normal is tilted by 1/8 or more.
bool is_tilted(const ManifoldBlock& block, std::size_t lane,
               const std::array<std::int64_t, 3>& gain) {
  const RawVec3 n = normal_of(block, lane);
  ProductSum along;
  std::uint64_t size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t g =
        std::clamp<std::int64_t>(gain[i], -(std::int64_t{1} << 38), std::int64_t{1} << 38);
    along.add(n[i], g);
    const std::int64_t small = raw::round_shift(g, 10);
    size += static_cast<std::uint64_t>(small * small);
  }
  const std::int64_t a = along.rounded(40);
  const auto square = static_cast<std::uint64_t>(a * a);
  return size - size / 64 > square;
}

}  // namespace

// Σ of its points, as the tick began.
std::int64_t DirectContacts::push_of(const ContactRun& run, const Link& link) {
  std::int64_t push = 0;
  for (const ManifoldBlock::Point& point : run.blocks[link.block()].points)
    push += low_word(point.impulse[link.lane()]);
  return push;
}

// Neither pushes nor has a point nearer than this, Q24.
bool DirectContacts::is_apart(const ContactRun& run, const Link& link, std::int64_t near) {
  const ManifoldBlock& block = run.blocks[link.block()];
  const std::size_t lane = link.lane();
  const std::array<std::int64_t, lanes::k_block_points> masses = masses_of(block, lane);
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (masses[i] != 0 && high_word(block.points[i].separation[lane]) <= near) return false;
  return push_of(run, link) == 0;
}

// Whether a contact in `order_` leans on friction, or is new, and so steep that it will.
bool DirectContacts::leans(const ContactRun& run) const {
  return std::ranges::any_of(order_, [&](std::uint32_t index) {
    const Link& link = links_[index];
    const ManifoldBlock& block = run.blocks[link.block()];
    const std::size_t lane = link.lane();
    const std::int64_t push = push_of(run, link);
    if (push != 0) return leans_on_friction(block, lane, push);
    return !is_apart(run, link, run.rules.skin) &&
           is_tilted(block, lane, run.bodies[link.a != 0 ? link.a : link.b].gain);
  });
}

// Rows of two tangents, and of the twist where the points have any radius.
void DirectContacts::fill_tie(const ContactRun& run, const Contact& contact, Tie& tie) {
  const ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  tie.coefficient = high_word(block.share[lane]);
  tie.radius = high_word(block.twist[lane]);
  tie.count = tie.radius == 0 ? 2 : 3;
  const std::int64_t scale = block.scale[lane];
  const RawVec3 turn = mixed(contact.normal, tie.radius, {}, 0);
  tie.rows[0].linear = contact.tangent;
  tie.rows[1].linear = contact.binormal;
  for (std::size_t i = 0; i < 2; ++i) {
    tie.rows[i].angular_a = turned(low_words(block.arm, lane), tie.rows[i].linear, 0, {});
    tie.rows[i].angular_b = turned(high_words(block.arm, lane), tie.rows[i].linear, 0, {});
  }
  tie.rows[2].angular_a = turned({}, {}, low_word(scale), turn);
  tie.rows[2].angular_b = turned({}, {}, high_word(scale), turn);
  const std::int64_t impulses[] = {low_word(block.friction[lane]), high_word(block.friction[lane]),
                                   low_word(block.twist[lane])};
  for (std::size_t i = 0; i < 3; ++i) {
    tie.rows[i].impulse = impulses[i] * (std::int64_t{1} << k_row_more_bits);
    find_responses(run, contact, tie.rows[i]);
  }
}

// From here on the sweeps leave its friction alone; but for moving surfaces, and for what slides.
void DirectContacts::tie(const ContactRun& run, Contact& contact) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  if (!block.is_plain(lane) && (block.drive[lane] != 0 || low_word(block.turn[lane]) != 0)) return;
  Tie tie;
  fill_tie(run, contact, tie);
  const auto slides = [&](const ContactRow& row) {
    const std::int64_t speed = read_row(run, contact, row);
    return speed > k_sliding_speed || speed < -k_sliding_speed;
  };
  if (slides(tie.rows[0]) || slides(tie.rows[1]) || slips(contact, tie)) return;
  tie.words = {block.tangent_mass[0][lane], block.tangent_mass[1][lane],
               high_word(block.twist_row[1][lane])};
  block.friction[lane] = 0;
  block.twist[lane] = pack(0, tie.radius);
  block.tangent_mass[0][lane] = block.tangent_mass[1][lane] = 0;
  block.twist_row[1][lane] = pack(block.twist_row[1][lane], 0);
  ties_.push_back(tie);
  contact.tie = static_cast<std::uint32_t>(ties_.size());
}

// Its friction is the sweeps' again.
void DirectContacts::release(const ContactRun& run, Contact& contact) {
  if (contact.tie == 0) return;
  const Tie& tie = ties_[contact.tie - 1];
  store_tie(run, contact, tie);
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  block.tangent_mass[0][lane] = tie.words[0];
  block.tangent_mass[1][lane] = tie.words[1];
  block.twist_row[1][lane] = pack(block.twist_row[1][lane], tie.words[2]);
  contact.tie = 0;
}

void DirectContacts::store_tie(const ContactRun& run, const Contact& contact, const Tie& tie) {
  ManifoldBlock& block = run.blocks[contact.block()];
  const std::size_t lane = contact.lane();
  std::array<std::int64_t, 3> seen{};
  for (std::size_t i = 0; i < 3; ++i)
    seen[i] = std::clamp<std::int64_t>(raw::round_shift(tie.rows[i].impulse, k_row_more_bits),
                                       -lanes::k_most_impulse, lanes::k_most_impulse);
  block.friction[lane] = pack(seen[0], seen[1]);
  block.twist[lane] = pack(seen[2], high_word(block.twist[lane]));
}

void DirectContacts::store(const ContactRun& run) const {
  for (const Contact& contact : contacts_)
    if (contact.tie != 0) store_tie(run, contact, ties_[contact.tie - 1]);
}

// Whether ties are rows of the system.
void DirectContacts::hold_ties(Group& group, bool holds) {
  group.holds = holds;
  for (const Contact& contact : contacts_of(group))
    if (contact.tie != 0) ties_[contact.tie - 1].holds = holds;
}

// False where no point pushes, so that nothing can hold.
bool DirectContacts::read_tie(const ContactRun& run, const Contact& contact) {
  Tie& tie = ties_[contact.tie - 1];
  for (std::size_t i = 0; i < tie.count; ++i) {
    tie.rows[i].change = 0;
    tie.rows[i].speed =
        std::clamp(read_row(run, contact, tie.rows[i]), -k_direct_bound, k_direct_bound);
  }
  return contact.active != 0 ||
         std::ranges::all_of(tie.rows, [](const ContactRow& row) { return row.impulse == 0; });
}

bool DirectContacts::is_stuck(const Contact& contact) const {
  if (!is_tied(contact)) return true;
  const Tie& tie = ties_[contact.tie - 1];
  const auto is_slow = [](const ContactRow& row) {
    return row.speed >= -k_direct_slow && row.speed <= k_direct_slow;
  };
  return std::ranges::all_of(std::span(tie.rows).first(tie.count), is_slow);
}

// Whether what was solved leaves the sphere |(Pt, Pb, Ptwist)| ≤ μ·ΣP.
bool DirectContacts::slips(const Contact& contact, const Tie& tie) {
  std::int64_t push = 0;
  for (std::size_t i = 0; i < contact.count; ++i)
    push += contact.points[i].impulse + contact.points[i].change;
  const std::int64_t limit = product_rounded(push, tie.coefficient, 30);
  ProductSum beyond;
  beyond.subtract(limit, limit);
  for (std::size_t i = 0; i < tie.count; ++i) {
    const std::int64_t part = tie.rows[i].impulse + tie.rows[i].change;
    beyond.add(part, part);
  }
  return beyond.rounded(30) > 0;
}

// Answers whether any slipped: the sweeps hold these at their limit, and the rest is solved again.
bool DirectContacts::release_slipping(const ContactRun& run, Group& group) {
  bool any = false;
  for (Contact& contact : contacts_of(group)) {
    if (!is_tied(contact) || !slips(contact, ties_[contact.tie - 1])) continue;
    release(run, contact);
    any = true;
  }
  return any;
}

}  // namespace lockstone
