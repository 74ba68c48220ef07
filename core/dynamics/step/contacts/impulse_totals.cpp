#include "core/dynamics/step/contacts/impulse_totals.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/contact/contact_prepare.h"
#include "core/dynamics/direct/contact_phases.h"
#include "core/geometry/distance/manifold_checks.h"

namespace lockstone {
namespace {

// The contact of a record, or the number of contacts.
ContactId contact_of(std::uint32_t record, const ContactList& contacts) {
  std::uint32_t first = 0, end = contacts.size();
  while (first < end) {
    const std::uint32_t middle = first + (end - first) / 2;
    if (contacts[ContactId{middle}].record < record)
      first = middle + 1;
    else
      end = middle;
  }
  LKS_ASSERT(first <= contacts.size());
  const bool is_there = first < contacts.size() && contacts[ContactId{first}].record == record;
  return ContactId{is_there ? first : contacts.size()};
}

}  // namespace

ImpulseTotals::ImpulseTotals(std::size_t capacity) : capacity_(capacity) {
  entries_.reserve(capacity);
}

void ImpulseTotals::begin(std::span<const WatchedContact> watched, const ContactList& contacts,
                          const ContactConstraints& constraints,
                          std::span<const ProximalContact> converged) {
  entries_.clear();
  LKS_ASSERT(is_reserved(entries_, capacity_));
  for (const WatchedContact& each : watched) {
    const ContactId contact = contact_of(each.record, contacts);
    if (contact.value == contacts.size()) continue;
    const ContactLane place = constraints.layout().lane_of(contact);
    if (constraints.approach_of(place) <= each.hit_speed.raw) continue;
    if (is_full()) break;
    LKS_ASSERT(entries_.empty() || entries_.back().contact < contact);
    Entry& entry = entries_.emplace_back();
    entry.contact = contact;
    entry.place = place;
    entry.total.record = each.record;
  }
  if (entries_.empty()) return;
  for (const ProximalContact& each : converged)
    if (Entry* entry = find(each.id)) entry->converged = &each;
}

ImpulseTotals::Entry* ImpulseTotals::find(ContactId contact) {
  LKS_ASSERT(std::ranges::is_sorted(entries_, {}, &Entry::contact));
  const auto found = std::ranges::lower_bound(entries_, contact, {}, &Entry::contact);
  return found != entries_.end() && found->contact == contact ? &*found : nullptr;
}

ImpulseTotals::Impulses ImpulseTotals::impulses_of(const Entry& entry, const ContactRun& run) {
  const lanes::ManifoldBlock& block = run.blocks[entry.place.block()];
  LKS_ASSERT(entry.place.lane() < lanes::k_block_lanes);
  Impulses impulses{};
  for (std::size_t i = 0; i < impulses.size(); ++i)
    impulses[i] = low_word(block.points[i].impulse[entry.place.lane()]);
  return impulses;
}

// A substep begins with the impulses of the one before, so each one's impulses are all that it
// gives.
void ImpulseTotals::add(const ContactRun& run, Entry& entry) {
  const lanes::ManifoldBlock& block = run.blocks[entry.place.block()];
  const std::size_t lane = entry.place.lane();
  entry.last = impulses_of(entry, run);
  for (std::size_t i = 0; i < entry.last.size(); ++i) {
    LKS_ASSERT(entry.last[i] >= 0);
    entry.total.points[i] += entry.last[i];
  }
  const std::int64_t word = entry.converged == nullptr
                                ? block.friction[lane]
                                : contact_phases::friction_word(*entry.converged);
  Vec3<SolverVelocity> friction;
  across(block, lane, word, friction);
  for (int i = 0; i < 3; ++i)
    entry.total.friction[static_cast<std::size_t>(i)] += friction[i].raw;
}

void ImpulseTotals::note(const ContactRun& run) {
  for (Entry& entry : entries_)
    if (entry.converged == nullptr || !entry.converged->is_whole) add(run, entry);
}

void ImpulseTotals::note(const ContactRun& run, ContactId contact) {
  if (Entry* entry = find(contact)) add(run, *entry);
}

void ImpulseTotals::end(const ContactRun& run) {
  for (Entry& entry : entries_) {
    LKS_ASSERT(entry.place.block() < run.blocks.size());
    const Impulses now = impulses_of(entry, run);
    for (std::size_t i = 0; i < now.size(); ++i)
      entry.total.points[i] += now[i] - entry.last[i];
  }
}

// A ball has one point.
void ImpulseTotals::add_impact(ContactId contact, const Vec3<Velocity>& jump,
                               const Vec3<Unit>& normal) {
  constexpr int k_down = Velocity::frac_bits - SolverVelocity::frac_bits;
  Entry* entry = find(contact);
  if (entry == nullptr) return;
  LKS_ASSERT(geometry::is_unit(normal));
  const Velocity along =
      times(jump.x, normal.x) + times(jump.y, normal.y) + times(jump.z, normal.z);
  entry->total.points[0] += raw::round_shift(along.raw, k_down);
  for (int i = 0; i < 3; ++i) {
    entry->total.friction[static_cast<std::size_t>(i)] +=
        raw::round_shift((jump[i] - times(along, normal[i])).raw, k_down);
  }
}

}  // namespace lockstone
